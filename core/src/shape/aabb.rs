//! Axis-aligned boxes.

use crate::math::{high, largest, low, max};
use glam::Vec3;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least coordinates \[m\].
    pub min: Vec3,
    /// Greatest coordinates \[m\].
    pub max: Vec3,
}

impl Aabb {
    /// Nothing: joining it with anything gives that.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box around points.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The box around two boxes.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box with as much room around it as the rounding of its largest coordinate may need.
    #[must_use]
    pub fn with_slack(self) -> Self {
        let room = 8.0 * f32::EPSILON * max(largest(self.min), largest(self.max));
        self.grown(room)
    }

    /// The box that reaches farther by so much on all sides \[m\].
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(crate) fn grown(self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Tells whether the two share a point, rounding errors of a few units in the last place allowed for.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let room = 8.0 * f32::EPSILON;
        let (low, high) = (high(self.min, other.min), low(self.max, other.max));
        low.x - room * low.x.abs() <= high.x + room * high.x.abs()
            && low.y - room * low.y.abs() <= high.y + room * high.y.abs()
            && low.z - room * low.z.abs() <= high.z + room * high.z.abs()
    }

    /// The middle \[m\].
    #[must_use]
    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Half the diagonal \[m\].
    #[must_use]
    pub fn radius(&self) -> f32 {
        crate::math::length(self.max - self.min) * 0.5
    }
}
