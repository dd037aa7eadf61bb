//! The nearest place of all pieces, the same whatever the structure.

use super::{Cost, Pieces};
use crate::math::{high, low};
use crate::shape::Aabb;
use glam::Vec3;

/// The nearest place so far; of several as near that of the lowest number.
pub(crate) struct Closest<'a, P: ?Sized, F> {
    pub(super) pieces: &'a P,
    pub(crate) point: Vec3,
    /// The nearest place of a piece.
    place: F,
    /// The square of its distance \[m²\].
    pub(crate) square: f32,
    number: usize,
    found: Option<Vec3>,
    pub(super) cost: Cost,
}

impl<'a, P: Pieces + ?Sized, F: Fn(usize) -> Vec3> Closest<'a, P, F> {
    pub(crate) fn new(pieces: &'a P, point: Vec3, place: F) -> Self {
        let (square, number, found, cost) = (f32::INFINITY, usize::MAX, None, Cost::default());
        Self { pieces, point, place, square, number, found, cost }
    }

    /// Asks a piece, whose answer is held in its own box: so it is never nearer than any box around that.
    pub(crate) fn ask(&mut self, piece: usize) {
        let bounds = self.pieces.box_of(piece);
        if !(bounds.min.is_finite() && bounds.max.is_finite()) || square_to(self.point, &bounds) > self.square {
            return;
        }
        self.cost.tests += 1;
        let place = high(low((self.place)(piece), bounds.max), bounds.min);
        let way = place - self.point;
        let square = way.dot(way);
        if square < self.square || (square == self.square && piece < self.number) {
            (self.square, self.number, self.found) = (square, piece, Some(place));
        }
    }

    pub(crate) fn found(self) -> (Option<Vec3>, Cost) {
        (self.found, self.cost)
    }
}

/// The square of the distance from a point to a box, never more than to a place inside: the same operations, which
/// rounding keeps in order.
#[inline(always)]
pub(crate) fn square_to(point: Vec3, bounds: &Aabb) -> f32 {
    let gap = high(high(bounds.min - point, point - bounds.max), Vec3::ZERO);
    gap.dot(gap)
}
