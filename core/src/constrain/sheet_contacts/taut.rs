//! Edges of sheets while these are kept apart: what is pushed takes along what it hangs on.

use super::lists::{Kept, NOBODY, Work};
use super::rest::Rest;
use crate::math::{dot, max, sqrt};
use glam::Vec3;

/// Shortens the edges that pushes have made longer than both they were before and they are at rest, by equal and opposite pushes; returns the
/// moment of these about where all were, over h.
pub(super) fn hold(rest: &Rest<'_>, kept: &Kept<'_>, work: &mut Work<'_>) -> Vec3 {
    let mut torque = Vec3::ZERO;
    for face in &*rest.faces {
        let moved = face.corners.map(|corner| work.moved[corner as usize]);
        if moved == [Vec3::ZERO; 3] {
            continue;
        }
        for edge in (0..3).filter(|&edge| face.owns_edge(edge)) {
            let [a, b] = face.edge(edge).map(|corner| corner as usize);
            let pushed = work.moved[b] - work.moved[a];
            if pushed == Vec3::ZERO {
                continue;
            }
            let way = work.now[b] - work.now[a];
            let (before, least) = (way - pushed, rest.places[b] - rest.places[a]);
            // Squares tell of most that they are no longer, which roots, being in the same order, would as well.
            let (square, most) = (dot(way, way), max(dot(before, before), dot(least, least)));
            let ease = kept.weight[a] + kept.weight[b];
            if !(square > most) || kept.rows[a] == NOBODY || kept.rows[b] == NOBODY || !(ease > 0.0) {
                continue;
            }
            let (far, most) = (sqrt(square), sqrt(most));
            if !(far > most) {
                continue;
            }
            let by = way * ((far - most) / (far * ease));
            work.shift(a, by * kept.weight[a]);
            work.shift(b, by * -kept.weight[b]);
            torque += (work.arm[a] - work.arm[b]).cross(by);
        }
    }
    torque
}
