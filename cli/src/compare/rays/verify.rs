//! Verification before measurement: who is wrong is not timed.
//!
//! One structure says what is expected of the others, and looking at every triangle judges it on a sample of segments.

use super::super::sample::sample;
use super::query::Query;
use super::tracer::{Answers, Tracer};
use crate::outcome::{Failure, Outcome};
use crate::report::words::thousands;
use pointmass::shape::{Collider, Hit, Mesh, Segment};

/// About how many triangles are tested for a kind of segments, and of how many segments at the least.
const TESTS: usize = 40_000_000;
pub(crate) const FEWEST: usize = 100;
/// By how much the fraction of a segment that is free may differ in another library.
pub(crate) const FRACTIONS: f32 = 1e-3;
/// Which part of its first hits may differ by more.
pub(crate) const MOST_UNLIKE: f64 = 0.01;

/// The first hits that everybody has to find, by query.
pub(crate) struct Expected(Vec<Vec<Option<Hit>>>);

impl Expected {
    /// By what one structure says of the first so many segments, a sample of which are held against every triangle; of
    /// how many.
    pub(crate) fn by(
        (leader, name): (&dyn Tracer, &str),
        mesh: Mesh<'_>,
        queries: &[Query],
        asked: usize,
        seed: u64,
    ) -> Outcome<(Self, usize)> {
        let mut all = Vec::new();
        let judged = sampled(mesh.triangles().len()).min(asked);
        for query in queries {
            let mut answers = Answers::default();
            leader.trace(query, asked, &mut answers);
            for row in sample(answers.exact.len(), judged, seed) {
                let expected = mesh.first_hit(&query.segments[row]);
                if bits(expected) != bits(answers.exact[row]) {
                    return Err(wrong(name, query, row, expected, answers.exact[row]));
                }
            }
            all.push(answers.exact);
        }
        Ok((Self(all), judged))
    }

    /// Which part of the segments of a query hit.
    pub(crate) fn hits(&self, query: usize) -> f64 {
        let all = &self.0[query];
        all.iter().flatten().count() as f64 / all.len().max(1) as f64
    }

    /// Holds the answers to the first so many segments of each query against these.
    pub(crate) fn check(&self, tracer: &dyn Tracer, name: &str, queries: &[Query], asked: usize) -> Outcome {
        let mut answers = Answers::default();
        for (query, all) in queries.iter().zip(&self.0) {
            tracer.trace(query, asked, &mut answers);
            let unlike = all.iter().zip(&answers.exact).position(|(a, b)| bits(*a) != bits(*b));
            if let Some(row) = unlike {
                return Err(wrong(name, query, row, all[row], answers.exact[row]));
            }
        }
        Ok(())
    }

    /// How many of another library's first hits differ by more than rounding.
    pub(crate) fn unlike(&self, tracer: &dyn Tracer, name: &str, queries: &[Query]) -> Outcome<usize> {
        let (mut answers, mut sum) = (Answers::default(), 0);
        for (query, all) in queries.iter().zip(&self.0) {
            if !tracer.trace(query, all.len(), &mut answers) {
                continue;
            }
            let is_unlike = |(a, b): (&Option<Hit>, &Option<(f32, u32)>)| match (a, b) {
                (Some(a), Some((time, _))) => !((a.time - time).abs() <= FRACTIONS),
                (a, b) => a.is_some() || b.is_some(),
            };
            let unlike = all.iter().zip(&answers.rounded).filter(|pair| is_unlike(*pair)).count();
            if unlike as f64 > 2.0 + MOST_UNLIKE * all.len() as f64 {
                let (query, unlike, all) = (query.workload.name(), thousands(unlike), thousands(all.len()));
                return Err(Failure::new(format!(
                    "{name} gives wrong answers to {query}: {unlike} of {all} first hits differ by more than rounding; \
                     nothing was measured; please report this with the mesh and the command"
                )));
            }
            sum += unlike;
        }
        Ok(sum)
    }
}

/// How many segments of a kind are held against every one of so many triangles.
fn sampled(triangles: usize) -> usize {
    (TESTS / triangles.max(1)).max(FEWEST)
}

fn bits(hit: Option<Hit>) -> Option<([u32; 5], u32)> {
    hit.map(|Hit { time, normal, slack, face, .. }| {
        ([time, normal.x, normal.y, normal.z, slack].map(f32::to_bits), face)
    })
}

fn wrong(name: &str, query: &Query, row: usize, expected: Option<Hit>, found: Option<Hit>) -> Failure {
    let told = |hit: Option<Hit>| {
        hit.map_or("no hit".into(), |hit| format!("triangle {} at the fraction {:?}", hit.face, hit.time))
    };
    let Segment { from, to, radius, .. } = query.segments[row];
    let (kind, all, expected, found) =
        (query.workload.name(), thousands(query.segments.len()), told(expected), told(found));
    Failure::new(format!(
        "{name} gives a wrong answer to {kind}, segment {row} of {all}, from {from:?} to {to:?}, radius {radius:?}: expected \
         {expected}, found {found}; nothing was measured; please report this with the mesh and the command"
    ))
}
