//! Edges of sheets while these are kept apart: what is pushed takes along what it hangs on.

use super::lists::{Kept, Work};
use super::rest::{Edge, Rest};
use crate::math::{dot, max, sqrt};
use glam::Vec3;

/// Lists the edges of all triangles, each once, in the order of these.
pub(super) fn list(rest: &Rest<'_>, kept: &mut Kept<'_>) {
    let own = rest.faces.iter().flat_map(|face| (0..3).filter(|&i| face.owns_edge(i)).map(|i| face.edge(i)));
    let mut count = 0;
    for (edge, ends) in kept.edges.iter_mut().zip(own) {
        let [a, b] = ends.map(|end| rest.places[end as usize]);
        *edge = Edge { ends, least: dot(b - a, b - a) };
        count += 1;
    }
    kept.counts.edges = count;
}

/// Shortens the edges that pushes have made longer than both they were before and they are at rest, by equal and opposite pushes.
pub(super) fn hold(kept: &Kept<'_>, work: &mut Work<'_>) {
    for &Edge { ends, least } in &kept.edges[..kept.counts.edges as usize] {
        let [a, b] = ends.map(|end| end as usize);
        let pushed = work.moved[b] - work.moved[a];
        if pushed == Vec3::ZERO {
            continue;
        }
        // What is not there has no place, and so no length.
        let way = work.now[b] - work.now[a];
        let before = way - pushed;
        // Squares tell of most that they are no longer, which roots, being in the same order, would as well.
        let (square, most) = (dot(way, way), max(dot(before, before), least));
        let ease = kept.weight[a] + kept.weight[b];
        if !(square > most) || !(ease > 0.0) {
            continue;
        }
        let (far, most) = (sqrt(square), sqrt(most));
        if !(far > most) {
            continue;
        }
        let by = way * ((far - most) / (far * ease));
        work.shift(a, by * kept.weight[a]);
        work.shift(b, by * -kept.weight[b]);
    }
}
