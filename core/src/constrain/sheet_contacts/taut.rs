//! Edges of sheets while these are kept apart: what is pushed takes along what it hangs on.

use super::lists::{Kept, Work};
use super::rest::{Edge, Rest};
use crate::lanes::{self, ABREAST, Eight, Kernel, LANES, Vectors, gathered, negated, not};
use crate::math::{dot, max, sqrt};
use glam::Vec3;

/// The bit of an edge that begins a run of such as have no end in common.
const BEGINS: u32 = 1 << 31;

/// Lists the edges of all triangles, each once, in the order of these, but where they can go side by side so that who does so follow each other: an
/// edge is in the run behind the last one that has an edge with an end of it, and so each run does what its edges would do in their order.
pub(super) fn list(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>) {
    let own = || rest.faces.iter().flat_map(|face| (0..3).filter(|&i| face.owns_edge(i)).map(|i| face.edge(i)));
    let edge = |ends: [u32; 2]| {
        let [a, b] = ends.map(|end| rest.places[end as usize]);
        Edge { ends, least: dot(b - a, b - a) }
    };
    if ABREAST < LANES {
        kept.edges.iter_mut().zip(own()).for_each(|(place, ends)| *place = edge(ends));
        kept.counts.edges = own().count() as u32;
        return;
    }
    let (last, next): (&mut [u32], &mut [u32]) = (work.zone, bytemuck::cast_slice_mut(work.searched));
    // Those beyond the runs that there is room for follow them one by one.
    let most = next.len().saturating_sub(1);
    last.fill(0);
    next.fill(0);
    own().for_each(|ends| next[run(last, ends, most)] += 1);
    let mut sum = 0;
    for next in &mut *next {
        sum += core::mem::replace(next, sum);
    }
    last.fill(0);
    for ends in own() {
        let place = &mut next[run(last, ends, most)];
        kept.edges[*place as usize] = edge(ends);
        *place += 1;
    }
    // By now each run's place is where the next one begins.
    let (edges, ends) = (&mut kept.edges[..sum as usize], &next[..most]);
    for &end in ends {
        if let Some(first) = edges.get_mut(end as usize) {
            first.ends[0] |= BEGINS;
        }
    }
    let others = ends.last().map_or(0, |&end| end as usize);
    edges[others..].iter_mut().for_each(|edge| edge.ends[0] |= BEGINS);
    kept.counts.edges = sum;
}

/// The run that an edge is in: behind the last ones of both ends, but not behind so many.
fn run(last: &mut [u32], [a, b]: [u32; 2], most: usize) -> usize {
    let [a, b] = [a as usize, b as usize];
    let behind = (last[a].max(last[b]) + 1).min(most as u32);
    (last[a], last[b]) = (behind, behind);
    behind as usize
}

impl Edge {
    fn ends(self) -> [u32; 2] {
        [self.ends[0] & !BEGINS, self.ends[1]]
    }
}

/// Shortens the edges that pushes have made longer than both they were before and they are at rest, by equal and opposite pushes.
pub(super) fn hold(kept: &Kept<'_>, work: &mut Work<'_>) {
    let (edges, weight) = (&kept.edges[..kept.counts.edges as usize], &*kept.weight);
    if ABREAST < LANES {
        edges.iter().for_each(|edge| shorten(edge, weight, work));
    } else {
        lanes::run_at_length(Hold { edges, weight, work });
    }
}

/// Shortens an edge, if it has to be.
fn shorten(edge: &Edge, weight: &[f32], work: &mut Work<'_>) {
    let [a, b] = edge.ends().map(|end| end as usize);
    let pushed = work.moved[b] - work.moved[a];
    if pushed == Vec3::ZERO {
        return;
    }
    // What is not there has no place, and so no length.
    let way = work.now[b] - work.now[a];
    let before = way - pushed;
    // Squares tell of most that they are no longer, which roots, being in the same order, would as well.
    let (square, most) = (dot(way, way), max(dot(before, before), edge.least));
    let ease = weight[a] + weight[b];
    if !(square > most) || !(ease > 0.0) {
        return;
    }
    let (far, most) = (sqrt(square), sqrt(most));
    if !(far > most) {
        return;
    }
    let by = way * ((far - most) / (far * ease));
    work.shift(a, by * weight[a]);
    work.shift(b, by * -weight[b]);
}

/// All edges, those of a run eight side by side: they have no end in common.
struct Hold<'h, 'm> {
    edges: &'h [Edge],
    weight: &'h [f32],
    work: &'h mut Work<'m>,
}

impl Kernel for Hold<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { edges, weight, work } = self;
        for run in edges.chunk_by(|_, next| next.ends[0] & BEGINS == 0) {
            for some in run.chunks(LANES) {
                // In the lanes of who is missing goes the last once more, to the same end.
                let (mut eight, last) = ([some[0]; LANES], some.len() - 1);
                for (lane, edge) in eight.iter_mut().enumerate() {
                    *edge = some[lane.min(last)];
                }
                if last == 0 || shorten_eight(like, &eight, weight, work).is_none() {
                    some.iter().for_each(|edge| shorten(edge, weight, work));
                }
            }
        }
    }
}

/// As [`shorten`], of those who have no end in common. None, and nothing is done: an end is the last particle of all, behind which nothing can be read.
#[inline(always)]
fn shorten_eight<F: Eight>(like: F, eight: &[Edge; LANES], weight: &[f32], work: &mut Work<'_>) -> Option<()> {
    let (mut ends, mut numbers) = ([[0; 2]; LANES], [[0.0; LANES]; 3]);
    for (lane, edge) in eight.iter().enumerate() {
        let [a, b] = edge.ends();
        ends[lane] = [a, b];
        numbers[0][lane] = edge.least;
        numbers[1][lane] = *weight.get(a as usize)?;
        numbers[2][lane] = *weight.get(b as usize)?;
    }
    let (places, moved): ([Vectors<F>; 2], [Vectors<F>; 2]) =
        (gathered(like, work.now, &ends)?, gathered(like, work.moved, &ends)?);
    let [least, first, second] = [like.of(numbers[0]), like.of(numbers[1]), like.of(numbers[2])];
    let (way, pushed) = (places[1] - places[0], moved[1] - moved[0]);
    let before = way - pushed;
    let (square, most) = (way.dot(way), lanes::max(before.dot(before), least));
    let (ease, zero) = (first + second, like.all(0.0));
    let longer = not(pushed.is_zero()) & square.simd_gt(most) & ease.simd_gt(zero);
    if !longer.any() {
        return Some(());
    }
    let (far, most) = (square.sqrt(), most.sqrt());
    let longer = longer & far.simd_gt(most);
    let by = way * ((far - most) / (far * ease));
    let by = [by * first, by * negated(second)];
    for end in 0..2 {
        put(work.now, &ends, end, Vectors::select(longer, places[end] + by[end], places[end]));
        put(work.moved, &ends, end, Vectors::select(longer, moved[end] + by[end], moved[end]));
    }
    Some(())
}

/// Puts vectors to one end of each edge.
#[inline(always)]
fn put<F: Eight>(column: &mut [Vec3], ends: &[[u32; 2]; LANES], end: usize, all: Vectors<F>) {
    for (ends, [x, y, z, _]) in ends.iter().zip(all.rows()) {
        column[ends[end] as usize] = Vec3::new(x, y, z);
    }
}

#[cfg(test)]
mod tests {
    use super::super::lists;
    use super::*;
    use crate::rng::Stream;
    use alloc::{vec, vec::Vec};

    /// Triangles between particles of which most have been pushed, all of whose edges are their own; where edges have left them: in runs, or in
    /// the order of the triangles.
    fn held([particles, triangles]: [usize; 2], near: u32, seed: u32, in_runs: bool) -> Vec<Vec3> {
        let counts = [particles, triangles];
        let demand = lists::demand(counts);
        let [mut fixed, mut step, mut scratch] =
            [demand.kept, demand.step, demand.scratch].map(|words| vec![0u32; words.fixed]);
        let rest = Rest::of(&mut fixed, counts).expect("the memory is asked for");
        let mut kept = Kept::of(&mut step, counts).expect("the memory is asked for");
        let mut work = Work::of(&mut scratch, counts).expect("the memory is asked for");
        let units = |number: usize, draw: u32| Stream::new(seed.into(), draw, number as u32).units(0);
        for i in 0..particles {
            let ([x, y], [z, w], [u, v]) = (units(i, 0), units(i, 1), units(i, 2));
            rest.places[i] = Vec3::new(x, y, z);
            kept.weight[i] = if w < 0.1 { 0.0 } else { w };
            work.moved[i] = if u < 0.2 { Vec3::ZERO } else { Vec3::new(u, v, u * v) - 0.5 };
            work.now[i] = if v < 0.01 { Vec3::NAN } else { rest.places[i] + work.moved[i] };
        }
        for (i, face) in rest.faces.iter_mut().enumerate() {
            let [first, by] = units(i, 3);
            let first = (first * particles as f32) as u32;
            let other = |way: u32| (first + way) % particles as u32;
            let far = 1 + (by * near as f32) as u32;
            *face = bytemuck::cast([first, other(far), other(far + 1), 63]);
        }
        list(&rest, &mut kept, &mut work);
        assert_eq!(kept.counts.edges as usize, 3 * triangles);
        if in_runs {
            hold(&kept, &mut work);
        } else {
            let edges = rest.faces.iter().flat_map(|face| (0..3).map(|i| face.edge(i)));
            for ends in edges {
                let [a, b] = ends.map(|end| rest.places[end as usize]);
                shorten(&Edge { ends, least: dot(b - a, b - a) }, kept.weight, &mut work);
            }
        }
        [&*work.now, &*work.moved].concat()
    }

    #[test]
    fn edges_in_runs_do_what_they_would_one_after_the_other() {
        let bits = |vectors: Vec<Vec3>| vectors.iter().flat_map(|v| v.to_array().map(f32::to_bits)).collect::<Vec<_>>();
        for seed in 0..20 {
            // Few of many, and more than there is room for runs of: each has a corner that all others have.
            for (counts, near) in [([3, 1], 1), ([40, 60], 9), ([700, 1300], 30), ([5000, 900], 4000), ([4, 300], 2)] {
                let [runs, order] = [true, false].map(|in_runs| bits(held(counts, near, seed, in_runs)));
                assert!(runs == order, "{counts:?} of seed {seed}");
            }
        }
    }
}
