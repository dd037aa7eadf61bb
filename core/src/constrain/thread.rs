//! The directions of threads in triangles of sheets.

use crate::math::{dot, length, max};
use glam::Vec3;

/// The unit vectors along warp and weft in the plane of a triangle with these edges; none if it is degenerate.
pub(super) fn warp_and_weft([e, f]: [Vec3; 2], warp: Vec3) -> Option<[Vec3; 2]> {
    let normal = e.cross(f);
    let size = length(normal);
    // A triangle narrower than a millionth of its length has no plane.
    if !(size > 1e-6 * max(dot(e, e), dot(f, f)) && size < f32::INFINITY) {
        return None;
    }
    let normal = normal / size;
    let flat = |v: Vec3| v - normal * dot(normal, v);
    let (thread, edge) = (flat(warp), flat(e));
    let along = if dot(thread, thread) > 1e-6 * dot(warp, warp) { thread } else { edge };
    let u = along / length(along);
    u.is_finite().then(|| [u, normal.cross(u)])
}
