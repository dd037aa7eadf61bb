//! A box, and what may lie near it: runs of slots.

use crate::math::{high as high_of, max};
use core::ops::Range;
use glam::Vec3;

/// A box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// A frame, and the box around the same in it.
    pub(super) home: (u32, [Vec3; 2]),
}

impl Region {
    pub(super) fn point(at: Vec3) -> Self {
        Self::new([at, at])
    }

    pub(super) fn new([low, high]: [Vec3; 2]) -> Self {
        Self { low, high, home: (0, [low, high]) }
    }

    /// The square of the distance to the farthest corner of a box.
    pub(super) fn farthest_square(&self, low: Vec3, high: Vec3) -> f32 {
        let side = high_of((high - self.low).abs(), (self.high - low).abs());
        side.dot(side)
    }

    /// The square of the distance to an image of another box: at most that of any of the points inside, as they are
    /// rounded, since rounding keeps order.
    #[inline(always)]
    pub(super) fn square_to(&self, low: Vec3, high: Vec3, moved: Vec3) -> f32 {
        let gap = |axis: usize| {
            let above = low[axis] - self.high[axis] + moved[axis];
            let below = self.low[axis] - high[axis] - moved[axis];
            let gap = if above > below { above } else { below };
            if gap > 0.0 { gap } else { 0.0 }
        };
        let [x, y, z] = [gap(0), gap(1), gap(2)];
        x * x + y * y + z * z
    }
}

/// How far along an axis from `low` or `high` points may be, in an image moved by so much, that are within a radius by
/// their squares: rounding may bring in some that are a little farther, underflow all that are closer than 4e-23.
#[inline(always)]
pub(super) fn widened(radius: f32, low: f32, high: f32, moved: f32) -> f32 {
    radius + 1e-6 * max(max(radius, moved.abs()), max(low.abs(), high.abs())) + 1e-22
}

/// Slots that may hold something, and the box around their points.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) slots: Range<usize>,
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// The frame of the box; zero is that of the coordinates.
    pub(super) frame: u32,
}
