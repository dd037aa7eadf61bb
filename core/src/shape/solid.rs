//! Solids that are met side by side with others of their kind.

use super::Aabb;
use crate::math::{largest, max};
use glam::Vec3;

/// A solid that stands still, made of no material, and is met as it is by itself, to the bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A sphere.
    Sphere {
        /// Its middle \[m\].
        center: Vec3,
        /// Its radius \[m\].
        radius: f32,
    },
    /// A box along the axes.
    Box(Aabb),
}

impl Solid {
    /// A point that nothing meets.
    pub(crate) const NONE: Self = Self::Sphere { center: Vec3::ZERO, radius: 0.0 };

    /// The box around it.
    pub(crate) fn bounds(&self) -> Aabb {
        match *self {
            Self::Sphere { center, radius } => Aabb { min: center - radius, max: center + radius },
            Self::Box(bounds) => bounds,
        }
    }

    /// A sphere's centre and radius; of a box nothing.
    pub(crate) const fn ball(&self) -> (Vec3, f32) {
        match *self {
            Self::Sphere { center, radius } => (center, radius),
            Self::Box(_) => (Vec3::ZERO, 0.0),
        }
    }

    /// How far its surface reaches from the origin \[m\], about.
    pub(crate) fn reach(&self) -> f32 {
        match *self {
            Self::Sphere { center, radius } => largest(center) + radius,
            Self::Box(Aabb { min, max: most }) => max(largest(min), largest(most)),
        }
    }
}
