//! A triangle so narrow that its normal needs more digits than single precision has.

use super::ball::{Filled, gap_to_line};
use glam::Vec3;

/// A triangle with its normal, rounded once.
pub(super) struct Sliver {
    corners: [Vec3; 3],
    /// Unit normal, or zero if the corners lie on a line.
    normal: Vec3,
}

impl Sliver {
    pub(super) fn new(corners: [Vec3; 3], normal: Vec3) -> Self {
        Self { corners, normal }
    }
}

impl Filled for Sliver {
    /// By the normal beside its inside, else that to the nearest of its edges.
    fn gap(&self, point: Vec3) -> Vec3 {
        let [a, b, c] = self.corners;
        let edges = [(a, b - a), (b, c - b), (c, a - c)];
        let is_inside = |&(from, along): &(Vec3, Vec3)| self.normal.cross(along).dot(point - from) > 0.0;
        if edges.iter().all(is_inside) {
            return self.normal * self.normal.dot(point - a);
        }
        let [first, rest @ ..] = edges.map(|(from, along)| gap_to_line(point, from, along));
        rest.into_iter().fold(first, |best, gap| if gap.dot(gap) < best.dot(best) { gap } else { best })
    }
}
