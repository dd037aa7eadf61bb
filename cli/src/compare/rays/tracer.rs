//! Who takes part: our structures over triangles, and other libraries where the program has them.

use super::super::contender::Build;
use super::super::peers::{FirstHit, RayPeer};
use super::super::stopwatch::Stopwatch;
use super::super::workload::Workload;
use super::query::Query;
use crate::outcome::Outcome;
use pointmass::rays::{Cost, Index, Structure};
use pointmass::shape::{Hit, Mesh};
use std::hint::black_box;
use std::time::Duration;

/// First hits, in the order of the segments.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    /// By our structures.
    pub(crate) exact: Vec<Option<Hit>>,
    /// By others, which round in their own way: the fraction of the segment that is free, and the triangle.
    pub(crate) rounded: Vec<FirstHit>,
}

/// A structure that has been built and answers.
pub(crate) trait Tracer {
    fn built(&self) -> Build;

    /// The first hits of the first `asked` segments, what is timed; false if it has no such query.
    fn trace(&self, query: &Query, asked: usize, answers: &mut Answers) -> bool;

    /// The work that these took in all, if it says.
    fn cost(&self, query: &Query, asked: usize) -> Option<Cost>;
}

/// One of our structures.
pub(crate) struct Own<'a> {
    pub(crate) mesh: Mesh<'a>,
    pub(crate) index: Index<'a>,
}

impl Tracer for Own<'_> {
    fn built(&self) -> Build {
        let stats = self.index.stats();
        Build {
            nodes: Some(stats.nodes),
            depth: Some(stats.depth),
            fullest: Some(stats.fullest),
            crowded: Some(stats.crowded),
            bytes_each: Some(stats.bytes as f64 / stats.pieces.max(1) as f64),
        }
    }

    fn trace(&self, query: &Query, asked: usize, answers: &mut Answers) -> bool {
        answers.exact.clear();
        let segments = query.segments.iter().take(asked);
        answers.exact.extend(segments.map(|segment| self.index.first_hit(&self.mesh, segment)));
        true
    }

    fn cost(&self, query: &Query, asked: usize) -> Option<Cost> {
        let mut sum = Cost::default();
        for segment in query.segments.iter().take(asked) {
            sum += self.index.first_hit_counted(&self.mesh, segment).1;
        }
        // Where there are no nodes, the boxes that are looked at are those of all triangles.
        if self.index.structure() == Structure::Brute {
            sum.visits += (asked.min(query.segments.len()) * self.mesh.triangles().len()) as u64;
        }
        Some(sum)
    }
}

/// A library that has been built, and of how many triangles.
struct Foreign<'a> {
    peer: &'a dyn RayPeer,
    triangles: usize,
}

impl Tracer for Foreign<'_> {
    fn built(&self) -> Build {
        Build { bytes_each: Some(self.peer.bytes() as f64 / self.triangles.max(1) as f64), ..Build::default() }
    }

    fn trace(&self, query: &Query, asked: usize, answers: &mut Answers) -> bool {
        if query.workload == Workload::Balls {
            return false;
        }
        let asked = asked.min(query.ends.len());
        answers.rounded.resize(asked, None);
        self.peer.first_hits(&query.ends[..asked], &mut answers.rounded);
        true
    }

    /// Libraries do not say.
    fn cost(&self, _: &Query, _: usize) -> Option<Cost> {
        None
    }
}

/// Who may take part.
pub(crate) enum Entrant {
    Own(Structure),
    Peer(Box<dyn RayPeer>),
}

impl Entrant {
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Own(structure) => structure.name(),
            Self::Peer(peer) => peer.name(),
        }
    }

    /// Whether it is one of our structures.
    pub(crate) fn is_own(&self) -> bool {
        matches!(self, Self::Own(_))
    }

    /// Whether it looks at every triangle.
    pub(crate) fn is_brute(&self) -> bool {
        matches!(self, Self::Own(Structure::Brute))
    }

    /// Words of memory it has to be lent.
    pub(crate) fn words(&self, triangles: usize) -> usize {
        match self {
            Self::Own(structure) => structure.words(triangles),
            Self::Peer(_) => 0,
        }
    }

    /// Builds so many times; what was built last, and what one of them took.
    pub(crate) fn build<'a>(
        &'a mut self,
        mesh: Mesh<'a>,
        memory: &'a mut [u32],
        times: usize,
    ) -> Outcome<(Box<dyn Tracer + 'a>, Duration)> {
        let begun = Stopwatch::start();
        match self {
            Self::Own(structure) => {
                let words = structure.words(mesh.triangles().len()).min(memory.len());
                let memory = &mut memory[..words];
                for _ in 1..times {
                    black_box(structure.build(&mesh, &mut *memory)?);
                }
                let index = structure.build(&mesh, memory)?;
                let took = begun.elapsed() / times as u32;
                Ok((Box::new(Own { mesh, index }), took))
            }
            Self::Peer(peer) => {
                (0..times).for_each(|_| peer.build(bytemuck::cast_slice(mesh.vertices()), mesh.triangles()));
                let took = begun.elapsed() / times as u32;
                Ok((Box::new(Foreign { peer: &**peer, triangles: mesh.triangles().len() }), took))
            }
        }
    }
}
