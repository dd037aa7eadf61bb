//! Frames: the axes of boxes that are turned against those of the coordinates.

use super::domain::around;
use super::region::Region;
use crate::math;
use glam::{Mat3, Vec3};

/// Right-handed frames, by their axes. The first, number zero, is that of the coordinates.
#[derive(Debug, Default)]
pub struct Frames<'m> {
    axes: &'m mut [[f32; 9]],
    len: usize,
    /// More than a turned coordinate of any point is wrong by.
    slack: f32,
}

impl<'m> Frames<'m> {
    /// None yet, in memory for so many.
    pub(super) fn new(axes: &'m mut [u32]) -> Self {
        Self { axes: bytemuck::cast_slice_mut(axes), len: 0, slack: 0.0 }
    }

    /// The number of frames.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Forgets them all.
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Says in which box all points are.
    pub(super) fn hold(&mut self, low: Vec3, high: Vec3) {
        self.slack = ERROR * math::max(math::largest(low), math::largest(high));
    }

    /// How many there are, and their slack.
    pub(super) fn facts(&self) -> [u32; 2] {
        [self.len as u32, self.slack.to_bits()]
    }

    /// Goes on from such facts.
    pub(super) fn restore(&mut self, [len, slack]: [u32; 2]) {
        (self.len, self.slack) = (len as usize, f32::from_bits(slack));
    }

    /// Adds one, and returns its number, if there is room.
    pub(super) fn add(&mut self, axes: Mat3) -> Option<u32> {
        *self.axes.get_mut(self.len)? = axes.to_cols_array();
        self.len += 1;
        Some(self.len as u32)
    }

    /// The axes of a frame, unless it is that of the coordinates.
    #[inline(always)]
    fn axes(&self, frame: u32) -> Option<[Vec3; 3]> {
        let &[a, b, c, d, e, f, g, h, i] = self.axes.get((frame as usize).checked_sub(1)?)?;
        Some([Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)])
    }

    /// A frame's axis.
    pub(super) fn axis(&self, frame: u32, axis: usize) -> Vec3 {
        self.axes(frame).unwrap_or(Vec3::AXES)[axis]
    }

    /// A point's coordinates in a frame.
    #[inline(always)]
    pub(super) fn turn(&self, frame: u32, point: Vec3) -> Vec3 {
        self.axes(frame).map_or(point, |[x, y, z]| Vec3::new(x.dot(point), y.dot(point), z.dot(point)))
    }

    /// A box in a frame that holds what a region holds, moved.
    pub(super) fn turn_region(&self, frame: u32, region: &Region, moved: Vec3) -> [Vec3; 2] {
        let slack = ERROR * (math::largest(region.low) + math::largest(region.high) + math::largest(moved));
        let (home, [low, high]) = region.home;
        let (center, half) = if frame == home {
            ((low + high) * 0.5 + self.turn(frame, moved), (high - low) * 0.5)
        } else {
            let half = (region.high - region.low) * 0.5;
            let reach = |axis: usize| self.axis(frame, axis).abs().dot(half);
            let center = self.turn(frame, (region.low + region.high) * 0.5 + moved);
            (center, Vec3::new(reach(0), reach(1), reach(2)))
        };
        [center - half - slack, center + half + slack]
    }

    /// The box around some points in a frame.
    pub(super) fn bounds(&self, frame: u32, points: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
        let [low, high] = around(points.map(|point| self.turn(frame, point)));
        [low - self.slack, high + self.slack]
    }
}

/// A turned coordinate is wrong by less than this times the largest coordinate: three products, two sums, and axes that
/// are unit vectors within some units in the last place.
const ERROR: f32 = 4e-6;
