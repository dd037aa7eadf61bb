//! What is near a region: runs of slots, and those that a group of points remembers.

use super::domain::Image;
use super::search::Partition;
use super::sorted::LANES;
use crate::math::{self, high as high_of, max};
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

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

/// How many points share one way through the structure at most.
const GROUP: usize = 64;
/// How many runs they remember; if there are more, each point goes its own way.
const RUNS: usize = 128;

/// What is near a group of points.
pub(super) struct Near {
    pub(super) group: Range<usize>,
    /// The square within which all is known; negative if nothing is.
    pub(super) square: f32,
    len: usize,
    pub(super) full: bool,
    /// Whether all runs have one image and one frame.
    alike: bool,
    /// The frame of the group, and its points in it.
    home: u32,
    pub(super) turned: [Vec3; GROUP],
    slots: [[u32; 2]; RUNS],
    /// The image and the frame in which its box is.
    views: [(Image, u32); RUNS],
    low: [[f32; RUNS + LANES]; 3],
    high: [[f32; RUNS + LANES]; 3],
}

impl Near {
    pub(super) fn new() -> Self {
        Self {
            group: 0..0,
            square: -1.0,
            len: 0,
            full: false,
            alike: true,
            home: 0,
            turned: [Vec3::ZERO; GROUP],
            slots: [[0; 2]; RUNS],
            views: [(Image::Itself, 0); RUNS],
            low: [[0.0; RUNS + LANES]; 3],
            high: [[0.0; RUNS + LANES]; 3],
        }
    }

    /// Forgets everything, for a group with its points in a frame and a square to look within.
    pub(super) fn begin(&mut self, group: Range<usize>, home: u32, square: f32) {
        (self.group, self.home, self.square) = (group, home, square);
        (self.len, self.full, self.alike) = (0, false, true);
    }

    /// Remembers a run; false if there is no room.
    #[inline(always)]
    pub(super) fn push(&mut self, run: Run, image: Image) -> bool {
        if self.len == RUNS {
            self.full = true;
            return false;
        }
        let at = self.len;
        self.slots[at] = [run.slots.start as u32, run.slots.end as u32];
        self.views[at] = (image, run.frame);
        self.alike &= self.views[at] == self.views[0];
        for axis in 0..3 {
            // Points are moved against the image when they are held against the box; the slack is more than what
            // rounding may take from them.
            let slack = math::largest(image.moved()) * 1e-6;
            self.low[axis][at] = run.low[axis] - slack;
            self.high[axis][at] = run.high[axis] + slack;
        }
        self.len += 1;
        true
    }

    /// Visits what of it is within a distance of a point, with the square of the distance to its box.
    #[inline(always)]
    pub(super) fn each<P: Partition>(
        &self,
        partition: &P,
        boxed: bool,
        (slot, center): (usize, Vec3),
        square: f32,
        mut visit: impl FnMut(f32, Range<usize>, Image),
    ) {
        let mut go = |at: usize, square: f32| {
            let [start, end] = self.slots[at];
            visit(square, start as usize..end as usize, self.views[at].0);
        };
        if !boxed {
            return (0..self.len).for_each(|at| go(at, 0.0));
        }
        let mut start = 0;
        while start < self.len {
            // All that is seen alike at once.
            let view = self.views[start];
            let mut end = self.len;
            if !self.alike {
                end = (start..self.len).find(|&at| self.views[at] != view).unwrap_or(end);
            }
            let center = if view.0 == Image::Itself { center } else { center - view.0.moved() };
            let center = match view {
                _ if !P::TURNS => center,
                (Image::Itself, frame) if frame == self.home && frame != 0 => self.turned[slot - self.group.start],
                (_, frame) => partition.turn(frame, center),
            };
            let center = center.to_array().map(f32x8::splat);
            for first in (start..end).step_by(LANES) {
                let squares = self.squares(first, center);
                let mut hits = squares.simd_le(f32x8::splat(square)).to_bitmask();
                hits &= (1u32 << (end - first).min(LANES)) - 1;
                let squares = squares.to_array();
                while hits != 0 {
                    let lane = hits.trailing_zeros() as usize;
                    go(first + lane, squares[lane]);
                    hits &= hits - 1;
                }
            }
            start = end;
        }
    }

    /// The squares of the distances from a point to eight boxes.
    #[inline(always)]
    fn squares(&self, first: usize, center: [f32x8; 3]) -> f32x8 {
        let gap = |axis: usize| {
            let side = |column: &[[f32; RUNS + LANES]; 3]| {
                f32x8::new(*column[axis][first..].first_chunk().unwrap_or(&[0.0; LANES]))
            };
            let (above, below) = (side(&self.low) - center[axis], center[axis] - side(&self.high));
            above.fast_max(below).fast_max(f32x8::ZERO)
        };
        let [x, y, z] = [gap(0), gap(1), gap(2)];
        x * x + y * y + z * z
    }
}

/// A run in pieces of at most `GROUP`.
pub(super) fn chunks(slots: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let end = slots.end;
    slots.step_by(GROUP).map(move |start| start..(start + GROUP).min(end))
}
