//! `pointmass compare`: which spatial partition suits which points and queries, or which mesh and rays.
//!
//! `source` brings the points, `contender` those who take part, `bench` asks them: `verify` holds their answers against an exhaustive search,
//! `measure` holds the clock; `study` is what it came to, which `advice` puts into words and `table`, `sheet`, `chart` and
//! `page` tell. `rays` does for meshes what `source` to `measure` do for points, and leaves the rest to them.

mod advice;
mod bench;
mod chart;
mod contender;
mod distribution;
mod foreign;
mod machine;
mod measure;
mod page;
mod peers;
pub mod points;
mod radius;
mod rays;
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
pub use peers::{FirstHit, Peer, Peers, RayPeer};
pub use rays::{Query, Surface};
pub use study::{Advice, Case, Contestant, Crossover, Figure, Growth, Study, Subject};
pub use workload::Workload;

use crate::formats::{StudyFormat, json};
use crate::whole::Outs;
use crate::words::{command, digits, thousands};
use crate::{Failure, Outcome, args, print};
use bench::Bench;
use contender::Entrant;
use foreign::Foreign;

/// Compares as the arguments say, `peers` beside our structures where they ask for it. Files are written whole, at the
/// end, or not at all.
///
/// # Errors
/// If the points or the mesh cannot be used, a contender gives a wrong answer, or a file cannot be written.
pub fn compare(args: &args::Compare, peers: Peers) -> Outcome {
    let subject = subject(args)?;
    let peers = peers.asked(args.peers)?;
    let read = args.points.iter().map(|(path, _)| path).chain(&args.scene).chain(&args.mesh);
    let outs = Outs::create(&args.out, read)?;
    let study = study(args, subject, peers)?;
    outs.write(|format| match format {
        StudyFormat::Csv => sheet::csv(&study),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => page::html(&study),
        StudyFormat::Svg => chart::all(&study),
    })?;
    print(&table::text(&study, args.detail))
}

/// What the arguments are about.
fn subject(args: &args::Compare) -> Outcome<Subject> {
    let of_points = [
        ("--points", args.points.is_some()),
        ("--scene", args.scene.is_some()),
        ("--distribution", !args.distribution.is_empty()),
        ("--n", !args.n.is_empty()),
        ("--neighbours", args.neighbours.is_some()),
        ("--k", args.k.is_some()),
    ];
    let of_meshes = [
        ("--mesh", args.mesh.is_some()),
        ("--surface", !args.surface.is_empty()),
        ("--triangles", !args.triangles.is_empty()),
        ("--segments", args.segments.is_some()),
    ];
    let given = |options: &[(&'static str, bool)]| options.iter().find(|(_, given)| *given).map(|(name, _)| *name);
    let other = args.queries.iter().find(|query| **query != Workload::Ray).map(|query| query.name());
    let rays = args.queries.contains(&Workload::Ray);
    match (given(&of_points), given(&of_meshes), rays, other) {
        (_, _, true, Some(other)) => Err(Failure::new(format!(
            "--queries: ray is asked of a mesh, {other} of points; ask for one after the other"
        ))),
        (Some(option), _, true, _) => {
            Err(Failure::new(format!("{option} is about points: --queries ray is asked of a mesh, see --mesh")))
        }
        (_, Some(option), _, Some(other)) => {
            Err(Failure::new(format!("{option} is about a mesh: {other} is asked of points; expected --queries ray")))
        }
        (Some(points), Some(mesh), ..) => {
            Err(Failure::new(format!("{points} is about points, {mesh} about a mesh; leave one of them out")))
        }
        (_, None, false, _) => Ok(Subject::Points),
        _ => Ok(Subject::Mesh),
    }
}

/// Those who take part, in the order of every table.
fn entrants(args: &args::Compare, peers: Vec<Box<dyn Peer>>) -> Vec<Entrant> {
    let own = args.structures.0.iter().map(|structure| Entrant::Own(*structure));
    own.chain(peers.into_iter().map(|peer| Entrant::Peer(Foreign::new(peer)))).collect()
}

/// Verifies and measures everything on points.
fn of_points(args: &args::Compare, peers: Vec<Box<dyn Peer>>) -> Outcome<Vec<Case>> {
    let mut entrants = entrants(args, peers);
    let (sources, sizes) = source::sources(args)?;
    let points = sizes.iter().sum::<usize>() * sources.len();
    let mut bench = Bench::new(args, queries(args), &mut entrants, points);
    let mut cases = Vec::new();
    for source in &sources {
        for &n in &sizes {
            cases.push(bench.case(source, n)?);
        }
    }
    bench.finish();
    Ok(cases)
}

/// All that was measured, and what it comes to.
fn study(args: &args::Compare, subject: Subject, peers: Peers) -> Outcome<Study> {
    let cases = match subject {
        Subject::Points => of_points(args, peers.of_points)?,
        Subject::Mesh => rays::cases(args, peers.of_meshes)?,
    };
    Ok(Study {
        version: env!("CARGO_PKG_VERSION").into(),
        command: command(std::env::args()),
        machine: Machine::this(),
        seed: args.seed.unwrap_or(1),
        k: k(args),
        growth: study::growths(&cases),
        crossovers: study::crossovers(&cases),
        advice: advice::advise(&cases),
        notes: notes(&cases, args.radius.is_none().then_some(neighbours(args))),
        cases,
    })
}

/// How many nearest others are looked for.
fn k(args: &args::Compare) -> usize {
    usize::from(args.k.unwrap_or(8))
}

/// How many others a point shall have within the radius, on average.
fn neighbours(args: &args::Compare) -> f64 {
    args.neighbours.unwrap_or(30.0)
}

/// What is asked, each once.
fn queries(args: &args::Compare) -> Vec<Workload> {
    let mut queries = args.queries.clone();
    if queries.is_empty() {
        queries = Workload::OF_POINTS.to_vec();
    }
    queries.sort_unstable();
    queries.dedup();
    queries
}

/// What a reader should know before believing any of it.
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
        let usual = 100.0 * statistics::Summary::of(&spreads.collect::<Vec<_>>()).median;
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
