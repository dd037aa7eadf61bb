//! Which nodes are far.

use super::moments::Moments;
use super::sums::Law;
use crate::index::region::Region;
use crate::math::max;
use core::ops::Range;
use glam::Vec3;

/// The way in which a node acts on some points.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Seen {
    /// Too near to act as one.
    Near,
    /// As one, by each of them.
    ByEach,
    /// As one, and so far that a series tells what it does to all of them.
    ByAll,
}

/// Points that look at nodes.
pub(super) struct Target {
    pub(super) region: Region,
    slots: Range<usize>,
    /// The longest side of their box.
    pub(super) side: f32,
    /// The square of what is compared to the distance.
    wide: f32,
    theta_squared: f32,
}

/// A series is as good as the moments of nodes that are larger than its box by so much.
const SMOOTH: f32 = 1.5;

impl Target {
    pub(super) fn new([low, high]: [Vec3; 2], slots: Range<usize>, law: Law) -> Self {
        let region = Region::new([low, high]);
        let side = longest(high - low);
        let theta_squared = law.theta_squared;
        // However large theta is, a series is taken where it converges.
        let wide = side * side * (SMOOTH * SMOOTH) * max(theta_squared, 1.0);
        Self { region, slots, side, wide, theta_squared }
    }

    /// Tells how a node with these moments and slots acts on them.
    #[inline(always)]
    pub(super) fn sees(&self, moments: &Moments, slots: impl FnOnce() -> Range<usize>) -> Seen {
        let Moments { center, side, .. } = moments;
        let (low, high) = (self.region.low, self.region.high);
        let gap = |axis: usize| max(max(low[axis] - center[axis], center[axis] - high[axis]), 0.0);
        let [x, y, z] = [gap(0), gap(1), gap(2)];
        let far = self.theta_squared * (x * x + y * y + z * z);
        if !(side * side < far) {
            return Seen::Near;
        }
        let slots = slots();
        match slots.start < self.slots.end && self.slots.start < slots.end {
            true => Seen::Near,
            false if self.wide < far => Seen::ByAll,
            false => Seen::ByEach,
        }
    }
}

/// The longest side of a box.
pub(super) fn longest(sides: Vec3) -> f32 {
    max(sides.x, max(sides.y, sides.z))
}
