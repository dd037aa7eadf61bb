//! `pointmass compare --queries ray`: which partition finds the first triangle hit soonest.
//!
//! `surface` brings the meshes, `query` draws the segments, `tracer` is who takes part, `bench` asks them and holds the
//! clock, once `verify` has held their answers against every triangle.

mod bench;
mod made;
mod query;
mod surface;
#[cfg(test)]
mod tests;
mod tracer;
mod verify;

pub use made::Made;
pub use query::Query;
pub use surface::Surface;

use super::args::Compare;
use super::peers::RayPeer;
use super::study::Case;
use crate::outcome::{Failure, Outcome};
use crate::report::words::thousands;
use bench::Bench;
use pointmass::rays::Structure;
use tracer::Entrant;

/// Verifies and measures everything.
pub(super) fn cases(args: &Compare, peers: Vec<Box<dyn RayPeer>>) -> Outcome<Vec<Case>> {
    let mut entrants = entrants(args)?;
    entrants.extend(peers.into_iter().map(Entrant::Peer));
    let surfaces = surface::surfaces(args)?;
    let mut bench = Bench::new(args, &mut entrants, surfaces.len());
    surfaces.iter().map(|surface| bench.case(surface)).collect()
}

/// Our structures that take part, in the order of every table.
fn entrants(args: &Compare) -> Outcome<Vec<Entrant>> {
    let asked = &args.structures.0;
    let is_all = asked.len() == pointmass::index::Structure::ALL.len();
    let of_rays = |name: &str| Structure::ALL.iter().copied().find(|structure| structure.name() == name);
    let mut entrants = Vec::new();
    for structure in asked {
        match of_rays(structure.name()) {
            Some(structure) => entrants.push(Entrant::Own(structure)),
            None if is_all => {}
            None => {
                let all: Vec<_> = Structure::ALL.iter().map(|structure| structure.name()).collect();
                let (name, all) = (structure.name(), all.join(", "));
                return Err(Failure::new(format!(
                    "--structures {name}: sorts points alone; of triangles there are {all}"
                )));
            }
        }
    }
    Ok(entrants)
}

/// The method by which meshes are compared.
pub(super) fn method() -> Vec<String> {
    let (sample, part) = (thousands(verify::FEWEST), verify::MOST_UNLIKE * 100.0);
    vec![
        format!(
            "Verification comes first: who gives a wrong answer ends the comparison. Of every segment, all structures have to \
             find the identical hit, fraction, normal and triangle to the last bit, and the same as by looking at every \
             triangle: of {sample} random segments at the least, and of more where triangles are few. Other libraries round in \
             their own way: a first hit counts as another if one hits and the other misses, or if the fractions differ by \
             more than {}. They are counted, and more than {part} % of them end the comparison.",
            verify::FRACTIONS
        ),
        "Short segments are steps of particles near the surface: each begins within a step of a random place of it, evenly \
         in a ball, and goes a step in a random direction. Sorted are the same in the order of a Morton curve through their \
         beginnings, as particles are that are kept sorted. Long segments join two random places on the sphere around the \
         mesh's box. Balls go the short steps."
            .into(),
        "Everybody takes a turn in every round, another one first each time, so that what else the machine does hits all \
         alike. A turn builds anew and asks all queries, one after the other by one thread. Looking at every triangle takes \
         long, so brute force is asked the first of the segments only; the table says how many."
            .into(),
        "Boxes are nodes or cells that were looked at, by brute force the triangles' own; triangles are those whose own box the segment meets \
         and which were therefore tested. Depth is the levels below the root, fullest the most triangles in a leaf or cell, and crowded the \
         leaves left larger than they should be for want of memory. Bytes are what a structure needs once it is built, the \
         mesh itself not included; libraries that keep triangles in their own form include that."
            .into(),
    ]
}
