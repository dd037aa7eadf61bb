//! Who takes part: our structures over triangles, and other libraries where the program has them.

use super::super::contender::Build;
use super::super::peers::{FirstHit, RayPeer};
use super::super::stopwatch::Stopwatch;
use super::query::Query;
use crate::{Failure, Outcome};
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

/// What has been built and answers.
pub(crate) trait Tracer {
    fn built(&self) -> Build;

    /// The first hits of the first `asked` segments, what is timed; false if it has no such query.
    fn trace(&self, query: &Query, asked: usize, answers: &mut Answers) -> bool;

    /// What these took in all, if it says.
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
        Some(sum)
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
    ///
    /// # Errors
    /// If there is too little memory.
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
                let small = |small: pointmass::rays::TooSmall| Failure::new(small.to_string());
                for _ in 1..times {
                    black_box(structure.build(&mesh, &mut *memory).map_err(small)?);
                }
                let index = structure.build(&mesh, memory).map_err(small)?;
                let took = begun.elapsed() / times as u32;
                Ok((Box::new(Own { mesh, index }), took))
            }
            Self::Peer(peer) => {
                (0..times).for_each(|_| peer.build(bytemuck::cast_slice(mesh.vertices()), mesh.triangles()));
                let took = begun.elapsed() / times as u32;
                Ok((Box::new(super::foreign::Foreign { peer: &**peer, triangles: mesh.triangles().len() }), took))
            }
        }
    }
}
