//! Runs of slots near a group of points, which it remembers.

use super::domain::Image;
use super::partition::Partition;
use super::region::Run;
use super::sorted::LANES;
use crate::math;
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

/// The largest number of points that share one way through the structure.
pub(super) const GROUP: usize = 64;
/// The largest number of runs that they remember; if there are more, each point goes its own way.
const RUNS: usize = 128;

/// The runs near a group of points.
pub(super) struct Near {
    pub(super) group: Range<usize>,
    /// The square within which all is known; negative if nothing is.
    pub(super) square: f32,
    len: usize,
    pub(super) full: bool,
    /// True if all runs have one image and one frame.
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

    /// The runs that it remembers, and how far each is moved.
    pub(super) fn runs(&self) -> impl Iterator<Item = (Range<usize>, Vec3)> {
        let views = self.views.iter().map(|(image, _)| image.moved());
        self.slots[..self.len].iter().map(|&[start, end]| start as usize..end as usize).zip(views)
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
