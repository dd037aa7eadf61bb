//! Edges of sheets while these are kept apart: what is pushed takes along what it hangs on.

use super::lists::{Kept, NOBODY, Work};
use super::rest::Rest;
use crate::math::{length, max};
use glam::Vec3;

/// Shortens the edges that pushes have made longer than both they were before and they are at rest, by equal and opposite pushes; returns the
/// moment of these about where all were, over h.
pub(super) fn hold(rest: &Rest<'_>, kept: &Kept<'_>, work: &mut Work<'_>) -> Vec3 {
    let mut torque = Vec3::ZERO;
    for face in &*rest.faces {
        for edge in (0..3).filter(|&edge| face.owns_edge(edge)) {
            let [a, b] = face.edge(edge).map(|corner| corner as usize);
            let pushed = work.moved[b] - work.moved[a];
            let ease = kept.weight[a] + kept.weight[b];
            if pushed == Vec3::ZERO || kept.rows[a] == NOBODY || kept.rows[b] == NOBODY || !(ease > 0.0) {
                continue;
            }
            let way = work.now[b] - work.now[a];
            let (far, most) = (length(way), max(length(way - pushed), length(rest.places[b] - rest.places[a])));
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
