//! Straight pieces of paths.

use super::Aabb;
use crate::math::{along, high, largest, low, max, minus};
use crate::time::Time;
use glam::Vec3;

/// A straight piece of a particle's path, travelled at a steady speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Its beginning \[m\].
    pub from: Vec3,
    /// Its end \[m\].
    pub to: Vec3,
    /// The radius of the ball that moves along it \[m\]; zero: a point.
    pub radius: f32,
    /// The instants of its beginning and its end, which only what moves itself asks for.
    pub during: [Time; 2],
}

impl Segment {
    /// The path of a point, at no particular time.
    #[inline]
    #[must_use]
    pub const fn new(from: Vec3, to: Vec3) -> Self {
        Self { from, to, radius: 0.0, during: [Time::ZERO; 2] }
    }

    /// The path of a ball that waits where it is.
    pub(crate) const fn waiting(at: Vec3, radius: f32, during: [Time; 2]) -> Self {
        Self { from: at, to: at, radius, during }
    }

    /// From one end to the other \[m\].
    #[inline]
    #[must_use]
    pub fn step(&self) -> Vec3 {
        minus(self.to, self.from)
    }

    /// The point at a fraction of it.
    #[inline]
    #[must_use]
    pub fn at(&self, time: f32) -> Vec3 {
        along(self.from, self.step(), time)
    }

    /// A box around all that the point or ball touches, with room for rounding.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let (min, max) = (low(self.from, self.to), high(self.from, self.to));
        Aabb { min: min - self.radius, max: max + self.radius }.with_slack()
    }

    /// A bound on the rounding error of a distance between it and something of extent `size` around the origin.
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline)]
    pub(crate) fn slack(&self, size: f32) -> f32 {
        Self::slack_within(max(largest(self.from), largest(self.to)), self.radius, size)
    }

    /// The same of a ball that is no farther than so from the origin.
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline)]
    pub(super) fn slack_within(far: f32, radius: f32, size: f32) -> f32 {
        4.0 * f32::EPSILON * (far + radius + size)
    }
}
