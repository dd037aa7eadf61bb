//! Pieces that can stand in the way, by numbers.

use crate::math::{largest, max};
use crate::shape::{Aabb, Collider, Hit, Segment, Surface};

/// Things with boxes that a path may meet, numbered from zero: triangles, or any solids.
///
/// All answers have to be pure functions of what is asked; numbers from `count` on are never asked for.
pub trait Pieces: Sync {
    /// The number of pieces.
    fn count(&self) -> usize;

    /// The box around one \[m\]; nothing hits a piece whose box is not finite.
    fn box_of(&self, piece: usize) -> Aabb;

    /// Where a segment first meets one.
    fn hit(&self, piece: usize, segment: &Segment) -> Option<Hit>;

    /// The largest coordinate of all boxes \[m\], on which depends how much room rounding needs.
    fn reach(&self) -> f32 {
        let reach = |bounds: Aabb| max(largest(bounds.min), largest(bounds.max));
        (0..self.count()).map(|piece| reach(self.box_of(piece))).filter(|reach| reach.is_finite()).fold(0.0, max)
    }
}

/// A list of solids as pieces, each with its box. Boxes without an end become as large as numbers do.
#[derive(Clone, Copy, Debug)]
pub struct Solids<'a, C>(pub &'a [C]);

impl<C: Collider + Surface> Pieces for Solids<'_, C> {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn box_of(&self, piece: usize) -> Aabb {
        let bounds = self.0.get(piece).map_or(Aabb::EMPTY, Surface::bounds);
        Aabb { min: bounds.min.map(held), max: bounds.max.map(held) }
    }

    fn hit(&self, piece: usize, segment: &Segment) -> Option<Hit> {
        self.0.get(piece)?.first_hit(segment)
    }
}

fn held(x: f32) -> f32 {
    crate::math::clamp(x, f32::MIN, f32::MAX)
}
