//! `pointmass compare`: which spatial partition suits which points and queries, or which mesh and rays.
//!
//! `source` brings the points, `entrant` those who take part, `bench` asks them: `verify` holds their answers against an
//! exhaustive search, `measure` holds the clock; `study` is what it came to, which `advice` puts into words and `report`,
//! `sheet` and `chart` tell. `rays` does for meshes what `source` to `measure` do for points, and leaves the rest to them.

mod advice;
mod args;
mod bench;
mod chart;
mod contender;
mod distribution;
mod entrant;
mod foreign;
mod gauge;
mod measure;
mod peers;
mod radius;
mod rays;
mod report;
mod sample;
mod sheet;
mod source;
mod stopwatch;
mod study;
#[cfg(test)]
mod tests;
mod verify;
mod workload;

pub(crate) use args::Compare;
pub use peers::{FirstHit, Peer, Peers, RayPeer};
pub use rays::{Made, Query, Surface};
pub use workload::Workload;

use crate::formats::{StudyFormat, json};
use crate::outcome::{Outcome, print};
use crate::report::origin::Origin;
use crate::report::page::Page;
use crate::report::plot;
use crate::report::terminal::Terminal;
use crate::report::words::{digits, thousands};
use crate::statistics::Summary;
use bench::Bench;
use entrant::Entrant;
use foreign::Foreign;
use pointmass_files::whole::Outs;
use study::{Case, Study, Subject};

/// Compares as the arguments say, `peers` beside our structures where they ask for it. Files are written whole, at the
/// end, or not at all.
pub(crate) fn compare(args: &Compare, peers: Peers) -> Outcome {
    let subject = args.subject()?;
    let peers = peers.asked(args.peers)?;
    let read = args.points.iter().map(|(path, _)| path).chain(&args.scene).chain(&args.mesh);
    let outs = Outs::create(&args.out, read)?;
    let study = study(args, subject, peers)?;
    outs.write(|format| match format {
        StudyFormat::Csv => sheet::sheet(&study).csv(),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => page(&study, args.detail),
        StudyFormat::Svg => plot::all(&chart::charts(&study)),
    })?;
    print(&text(&study, args.detail)?)
}

/// The comparison as a page.
fn page(study: &Study, detail: bool) -> Outcome<String> {
    Page::told("Which spatial partition?", &study.origin, |page| report::tell(study, detail, page))
}

/// The comparison for a terminal.
fn text(study: &Study, detail: bool) -> Outcome<String> {
    Terminal::told(|terminal| report::tell(study, detail, terminal))
}

/// The contenders, in the order of every table.
fn entrants(args: &Compare, peers: Vec<Box<dyn Peer>>) -> Vec<Entrant> {
    let own = args.structures.0.iter().map(|structure| Entrant::Own(*structure));
    own.chain(peers.into_iter().map(|peer| Entrant::Peer(Foreign::new(peer)))).collect()
}

/// Verifies and measures everything on points.
fn of_points(args: &Compare, peers: Vec<Box<dyn Peer>>) -> Outcome<Vec<Case>> {
    let mut entrants = entrants(args, peers);
    let (sources, sizes) = source::sources(args)?;
    let points = sizes.iter().sum::<usize>() * sources.len();
    let mut bench = Bench::new(args, args.queries(), &mut entrants, points);
    let mut cases = Vec::new();
    for source in &sources {
        for &n in &sizes {
            cases.push(bench.case(source, n)?);
        }
    }
    Ok(cases)
}

/// All that was measured, and what it comes to.
fn study(args: &Compare, subject: Subject, peers: Peers) -> Outcome<Study> {
    let cases = match subject {
        Subject::Points => of_points(args, peers.of_points)?,
        Subject::Mesh => rays::cases(args, peers.of_meshes)?,
    };
    Ok(Study {
        origin: Origin::this(),
        seed: args.seed(),
        k: args.k(),
        growth: study::growths(&cases),
        crossovers: study::crossovers(&cases),
        advice: advice::advise(&cases),
        notes: notes(&cases, args.radius.is_none().then_some(args.neighbours())),
        cases,
    })
}

/// Notes that a reader should know before believing any of it.
fn notes(cases: &[Case], wanted: Option<f64>) -> Vec<String> {
    let mut notes = Vec::new();
    for case in cases {
        let (name, n, things) = (&case.of, thousands(case.n), case.subject.things());
        let far = |(wanted, found): &(f64, f64)| (found - wanted).abs() > 0.2 * wanted;
        if let Some((wanted, found)) = wanted.zip(case.neighbours).filter(far) {
            let [wanted, found] = [wanted, found].map(digits);
            notes.push(format!(
                "{name}, {n} points: there is no radius with {wanted} others within it on average; {found} is the closest"
            ));
        }
        let spreads = case.contestants.iter().flat_map(|one| &one.figures).map(|figure| figure.spread);
        let usual = 100.0 * Summary::of(&spreads.collect::<Vec<_>>()).median;
        if usual > 10.0 {
            notes.push(format!(
                "{name}, {n} {things}: the machine was busy, samples usually spread by {usual:.0} %; try again with --repeat 31"
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
