//! Other libraries as contenders.

use super::contender::{Answer, Build, Contender, Effort, Question, Scratch, tie};
use super::peers::Peer;
use super::workload::Workload;
use crate::outcome::Outcome;
use pointmass::Vec3;
use pointmass::index::Cost;
use std::hint::black_box;

/// A library, and how many points it was built from.
pub(crate) struct Foreign {
    peer: Box<dyn Peer>,
    points: usize,
}

impl Foreign {
    pub(crate) fn new(peer: Box<dyn Peer>) -> Self {
        Self { peer, points: 0 }
    }

    pub(crate) fn name(&self) -> &'static str {
        self.peer.name()
    }
}

impl Contender for &mut Foreign {
    fn is_exact(&self) -> bool {
        false
    }

    fn build(&mut self, points: &[Vec3], reach: f32) -> Outcome {
        self.points = points.len();
        self.peer.build(bytemuck::cast_slice(points), reach);
        Ok(())
    }

    fn follow(&mut self, points: &[Vec3], reach: f32) -> Outcome {
        self.build(points, reach)
    }

    fn built(&self) -> Build {
        let bytes_each = self.peer.bytes().map(|bytes| bytes as f64 / self.points.max(1) as f64);
        Build { bytes_each, ..Build::default() }
    }

    /// Libraries do not say what they computed, so costs are none of theirs.
    fn run(&mut self, query: Workload, question: &Question<'_>, scratch: &mut Scratch) -> Option<Option<Cost>> {
        let (peer, radius) = (&mut self.peer, question.radius);
        let has_answered = match query {
            Workload::Within => black_box(peer.lists(radius)).is_some(),
            Workload::Pairs => {
                let mut see = |a, b| {
                    black_box((a, b));
                };
                black_box(peer.pairs(radius, &mut see)).is_some()
            }
            Workload::Nearest => {
                scratch.distances.clear();
                let has_answered = peer.nearest(question.k, &mut scratch.distances);
                black_box(&scratch.distances);
                has_answered
            }
            _ => {
                let has_answered = peer.counts(radius, &mut scratch.counts);
                black_box(&scratch.counts);
                has_answered
            }
        };
        has_answered.then_some(None)
    }

    fn answer(&mut self, query: Workload, question: &Question<'_>) -> Option<Answer> {
        let (peer, radius, n) = (&mut self.peer, question.radius, question.points.len());
        match query {
            Workload::Within => peer.lists(radius).map(Answer::Total),
            Workload::Pairs => {
                let mut links = vec![0; n];
                peer.pairs(radius, &mut |a, b| tie(&mut links, a, b))?;
                Some(Answer::Links(links))
            }
            Workload::Nearest => {
                let mut found = Vec::new();
                if !peer.nearest(question.k, &mut found) {
                    return None;
                }
                // A point of few has no more than all others.
                let mut distances = vec![f32::INFINITY; n * question.k];
                let each = found.len() / n.max(1);
                for (to, from) in distances.chunks_mut(question.k).zip(found.chunks(each.max(1))) {
                    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
                }
                Some(Answer::Distances(distances))
            }
            _ => {
                let mut counts = vec![0; n];
                peer.counts(radius, &mut counts).then_some(Answer::Counts(counts))
            }
        }
    }

    fn effort(&mut self, _: Workload, _: &Question<'_>, _: &[usize]) -> Option<Effort> {
        None
    }
}
