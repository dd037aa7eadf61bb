//! `pointmass compare`: which spatial partition suits which points and queries.
//!
//! `source` brings the points, `contender` those who take part, `bench` asks them: `verify` holds their answers against an exhaustive search,
//! `measure` holds the clock; `study` is what it came to, which `advice` puts into words and `table`, `sheet`, `chart` and
//! `page` tell.

mod advice;
mod bench;
pub(crate) mod chart;
mod contender;
mod distribution;
mod machine;
mod measure;
pub(crate) mod page;
#[cfg(feature = "peers")]
mod peer;
pub mod points;
mod radius;
mod sample;
mod sheet;
mod source;
mod statistics;
mod stopwatch;
mod study;
mod table;
#[cfg(test)]
mod tests;
mod verify;
mod workload;

pub use contender::Build;
pub use distribution::Distribution;
pub use machine::Machine;
pub use study::{Advice, Case, Contestant, Crossover, Figure, Growth, Study};
pub use workload::Workload;

use crate::formats::StudyFormat;
use crate::whole::WholeFile;
use crate::{Failure, Outcome, args, print};
use bench::Bench;
use contender::Entrant;
use std::io::Write;
use std::path::Path;

/// Compares as the arguments say. Files are written whole, at the end, or not at all.
///
/// # Errors
/// If the points cannot be used, a contender gives a wrong answer, or a file cannot be written.
pub fn compare(args: &args::Compare) -> Outcome {
    let mut entrants = entrants(args)?;
    spare_the_points(args)?;
    let outs = args.out.iter().map(|(path, format)| Ok((WholeFile::create(path)?, *format)));
    let outs = outs.collect::<Outcome<Vec<_>>>()?;
    let study = study(args, &mut entrants)?;
    write(outs, &study)?;
    print(&table::text(&study, args.detail))
}

/// Refuses to write over what is read.
fn spare_the_points(args: &args::Compare) -> Outcome {
    let read = args.points.iter().map(|(path, _)| path).chain(&args.scene).filter_map(|path| path.canonicalize().ok());
    let read: Vec<_> = read.collect();
    let is_read = |path: &Path| path.canonicalize().is_ok_and(|path| read.contains(&path));
    match args.out.iter().find(|(path, _)| is_read(path)) {
        Some((path, _)) => {
            Err(Failure::new(format!("{}: is read, so it cannot be written; choose another --out", path.display())))
        }
        None => Ok(()),
    }
}

/// Those who take part, in the order of every table.
fn entrants(args: &args::Compare) -> Outcome<Vec<Entrant>> {
    #[cfg_attr(not(feature = "peers"), expect(unused_mut, reason = "peers join"))]
    let mut entrants: Vec<_> = args.structures.0.iter().map(|structure| Entrant::Own(*structure)).collect();
    #[cfg(feature = "peers")]
    if args.peers {
        entrants.extend(peer::all().into_iter().map(Entrant::Peer));
    }
    if args.peers && !cfg!(feature = "peers") {
        return Err(Failure::new(
            "this program was built without other libraries; for --peers, run `cargo run --release --features peers -- \
             compare --peers`",
        ));
    }
    Ok(entrants)
}

/// Verifies and measures everything.
fn study(args: &args::Compare, entrants: &mut [Entrant]) -> Outcome<Study> {
    let (sources, sizes) = source::sources(args)?;
    let points = sizes.iter().sum::<usize>() * sources.len();
    let mut bench = Bench::new(args, queries(args), entrants, points);
    let mut cases = Vec::new();
    for source in &sources {
        for &n in &sizes {
            cases.push(bench.case(source, n)?);
        }
    }
    bench.finish();
    Ok(Study {
        version: env!("CARGO_PKG_VERSION").into(),
        command: command(std::env::args()),
        machine: Machine::this(),
        seed: args.seed.unwrap_or(1),
        k: usize::from(args.k),
        growth: study::growths(&cases),
        crossovers: study::crossovers(&cases),
        advice: advice::advise(&cases),
        notes: notes(&cases, args.radius.is_none().then_some(args.neighbours)),
        cases,
    })
}

/// What is asked, each once.
fn queries(args: &args::Compare) -> Vec<Workload> {
    let mut queries = args.queries.clone();
    queries.sort_unstable();
    queries.dedup();
    queries
}

/// What a reader should know before believing any of it.
fn notes(cases: &[Case], wanted: Option<f64>) -> Vec<String> {
    let mut notes = Vec::new();
    for case in cases {
        let (name, n, found) = (&case.points, advice::thousands(case.n), case.neighbours);
        if let Some(wanted) = wanted.filter(|wanted| (found - wanted).abs() > 0.2 * wanted) {
            let [wanted, found] = [wanted, found].map(advice::digits);
            notes.push(format!(
                "{name}, {n} points: there is no radius with {wanted} others within it on average; {found} is the closest"
            ));
        }
        let spreads = case.contestants.iter().flat_map(|one| &one.figures).map(|figure| figure.spread);
        let usual = 100.0 * statistics::Summary::of(&spreads.collect::<Vec<_>>()).median;
        if usual > 10.0 {
            notes.push(format!(
                "{name}, {n} points: the machine was busy, samples usually spread by {usual:.0} %; try again with --repeat 31"
            ));
        }
    }
    if cases.iter().any(|case| case.rounds < 5) {
        notes.push("of fewer than 5 rounds, spreads say little; believe no small differences".into());
    }
    notes.push(format!("times are {}", stopwatch::SHOWS));
    if cfg!(debug_assertions) {
        notes.push(
            "this program was built without optimisation, so its times mean nothing; use cargo run --release".into(),
        );
    }
    notes
}

/// What was typed, as a shell takes it.
fn command(args: impl Iterator<Item = String>) -> String {
    let plain =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "-_=.,/:+%@".contains(c));
    let quoted =
        args.skip(1).map(|word| if plain(&word) { word } else { format!("'{}'", word.replace('\'', r"'\''")) });
    std::iter::once("pointmass".to_string()).chain(quoted).collect::<Vec<_>>().join(" ")
}

/// Writes all files, and then gives them their names.
fn write(mut outs: Vec<(WholeFile, StudyFormat)>, study: &Study) -> Outcome {
    for (file, format) in &mut outs {
        let text = match format {
            StudyFormat::Csv => sheet::csv(study)?,
            StudyFormat::Json => {
                let mut text = serde_json::to_string_pretty(study).map_err(|error| Failure::new(error.to_string()))?;
                text.push('\n');
                text
            }
            StudyFormat::Html => page::html(study)?,
            StudyFormat::Svg => chart::all(study)?,
        };
        let written = file.write_all(text.as_bytes());
        written.map_err(|error| Failure::io(file.path(), &error))?;
    }
    outs.into_iter().try_for_each(|(file, _)| file.complete())
}
