//! `pointmass compare`: which spatial partition suits which points and queries.
//!
//! `source` brings the points, `contender` those who take part, `bench` asks them: `verify` holds their answers against an exhaustive search,
//! `measure` holds the clock; `study` is what it came to, which `advice` puts into words and `table`, `sheet`, `chart` and
//! `page` tell.

mod advice;
mod bench;
mod chart;
mod contender;
mod distribution;
mod machine;
mod measure;
mod page;
#[cfg(feature = "peers")]
mod peer;
pub mod points;
mod radius;
mod sample;
mod sheet;
mod source;
pub(crate) mod statistics;
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

use crate::formats::{StudyFormat, json};
use crate::whole::Outs;
use crate::words::{command, digits, thousands};
use crate::{Failure, Outcome, args, print};
use bench::Bench;
use contender::Entrant;

/// Compares as the arguments say. Files are written whole, at the end, or not at all.
///
/// # Errors
/// If the points cannot be used, a contender gives a wrong answer, or a file cannot be written.
pub fn compare(args: &args::Compare) -> Outcome {
    let mut entrants = entrants(args)?;
    let read = args.points.iter().map(|(path, _)| path).chain(&args.scene);
    let outs = Outs::create(&args.out, read)?;
    let study = study(args, &mut entrants)?;
    outs.write(|format| match format {
        StudyFormat::Csv => sheet::csv(&study),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => page::html(&study),
        StudyFormat::Svg => chart::all(&study),
    })?;
    print(&table::text(&study, args.detail))
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
        let (name, n, found) = (&case.points, thousands(case.n), case.neighbours);
        if let Some(wanted) = wanted.filter(|wanted| (found - wanted).abs() > 0.2 * wanted) {
            let [wanted, found] = [wanted, found].map(digits);
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
