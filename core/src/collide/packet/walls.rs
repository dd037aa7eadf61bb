//! A flat face before paths side by side.

use super::hits::{Hits, Seats, Segments, Walls};
use crate::lanes::{Lanes, Vectors};
use crate::shape::Face;

impl<F: Lanes> Walls<F> for Face {
    #[inline(always)]
    fn face(&self) -> Option<&Face> {
        Some(self)
    }

    #[inline(always)]
    fn first_hits<const POINTS: bool>(&self, piece: &Segments<F>, radius: F) -> Hits<F> {
        piece.first_hits::<POINTS>(self, radius)
    }

    #[inline(always)]
    fn seats(&self, place: Vectors<F>, reach: F) -> Seats<F> {
        let (like, [point, _, unit]) = (reach, self.vectors());
        let (point, unit) = (Vectors::splat(like, point), Vectors::splat(like, unit));
        let away = unit.dot(place - point);
        let normal = Vectors::select(away.simd_lt(like.all(0.0)), -unit, unit);
        let distance = (unit * away).dot(normal);
        let slack = slack(place, distance, like.all(self.size()));
        Seats { are: distance.simd_le(reach), normal, distance, slack, unclear: like.all(0.0) }
    }
}

/// Bounds on the rounding of distances between places and surfaces of such extents.
#[inline(always)]
pub(super) fn slack<F: Lanes>(place: Vectors<F>, distance: F, size: F) -> F {
    size.all(4.0 * f32::EPSILON) * (place.largest() + distance + size)
}
