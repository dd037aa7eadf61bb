//! What is gathered from the corners of triangles and folds, and spread over them.

use glam::Vec3;

/// The vectors of four corners, if there are all. Where one is missing nothing acts: see `linearise`.
#[cfg_attr(not(one_by_one), inline(always))]
pub(super) fn all_at(vectors: &[Vec3], [a, b, c, d]: [u32; 4]) -> Option<[Vec3; 4]> {
    let at = |corner: u32| vectors.get(corner as usize);
    let (Some(&a), Some(&b), Some(&c), Some(&d)) = (at(a), at(b), at(c), at(d)) else { return None };
    Some([a, b, c, d])
}

/// Adds forces on the second and third corner of a triangle, and against them on the first.
#[cfg_attr(not(one_by_one), inline(always))]
pub(super) fn add_pair(total: &mut [Vec3], corners: [u32; 3], [p, q]: [Vec3; 2]) {
    add_all(total, corners, [-(p + q), p, q]);
}

/// Adds forces on corners.
#[cfg_attr(not(one_by_one), inline(always))]
pub(super) fn add_all<const N: usize>(total: &mut [Vec3], corners: [u32; N], forces: [Vec3; N]) {
    for (corner, force) in corners.into_iter().zip(forces) {
        if let Some(total) = total.get_mut(corner as usize) {
            *total += force;
        }
    }
}
