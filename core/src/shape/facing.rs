//! The parts of a collider that are near: nothing, one flat face that stands still, or more than that.

use crate::math::{largest, unit};
use glam::Vec3;

/// The parts of a collider that a path inside a box can meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Facing {
    /// Nothing.
    #[default]
    Nothing,
    /// One flat face, which is met as the collider itself would be, to the bit.
    Face(Face),
    /// Anything.
    Several,
}

impl Facing {
    /// The parts of two colliders together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, one) | (one, Self::Nothing) => one,
            _ => Self::Several,
        }
    }

    /// The same, of the scene's material with this number.
    #[must_use]
    pub fn made_of(self, material: Option<u16>) -> Self {
        match self {
            Self::Face(face) => Self::Face(Face { material, ..face }),
            other => other,
        }
    }
}

/// A plane that stands still, ready for many who ask: what runs over floors and walls most of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    point: Vec3,
    normal: Vec3,
    /// Its normal at unit length, and the largest of its point's coordinates.
    unit: Vec3,
    size: f32,
    material: Option<u16>,
}

impl Face {
    /// The plane through a point \[m\] with a normal of any length but zero, of no material.
    #[must_use]
    pub fn new(point: Vec3, normal: Vec3) -> Self {
        Self { point, normal, unit: unit(normal), size: largest(point), material: None }
    }

    /// A point of it, its normal as given, and that at unit length.
    #[must_use]
    pub(crate) const fn vectors(&self) -> [Vec3; 3] {
        [self.point, self.normal, self.unit]
    }

    /// The largest of its point's coordinates.
    #[must_use]
    pub(crate) const fn size(&self) -> f32 {
        self.size
    }

    /// The number of its material in the scene, if it has one.
    #[must_use]
    pub(crate) const fn material(&self) -> Option<u16> {
        self.material
    }
}
