//! Other libraries as tracers.

use super::super::contender::Build;
use super::super::peers::RayPeer;
use super::super::workload::Workload;
use super::query::Query;
use super::tracer::{Answers, Tracer};
use pointmass::rays::Cost;

/// A library that has been built, and of how many triangles.
pub(super) struct Foreign<'a> {
    pub(super) peer: &'a dyn RayPeer,
    pub(super) triangles: usize,
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
