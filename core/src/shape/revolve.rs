//! Functions that the surfaces of revolution about the y axis share.

use crate::math::{clamp, sqrt};
use glam::{Vec2, Vec3};

/// The point nearest to `point` on the surface that a polygonal profile of (radius, height) sweeps about the y axis
/// through `center`.
pub(super) fn nearest(center: Vec3, point: Vec3, profile: &[Vec2]) -> Vec3 {
    let offset = point - center;
    let radius = sqrt(offset.x * offset.x + offset.z * offset.z);
    let here = Vec2::new(radius, offset.y);
    let (mut best, mut gap) = (here, f32::INFINITY);
    for ends in profile.windows(2) {
        let along = ends[1] - ends[0];
        let square = along.dot(along);
        let t = if square > 0.0 { clamp((here - ends[0]).dot(along) / square, 0.0, 1.0) } else { 0.0 };
        let candidate = ends[0] + along * t;
        let distance = (candidate - here).dot(candidate - here);
        if distance < gap {
            (best, gap) = (candidate, distance);
        }
    }
    // On the axis every direction is as near as any other.
    let (x, z) = if radius > 0.0 { (offset.x / radius, offset.z / radius) } else { (1.0, 0.0) };
    center + Vec3::new(x * best.x, best.y, z * best.x)
}
