//! Ends of a rope that are joined to something else, which does not give way alike in all directions.

use crate::math::aside;
use glam::{Mat3, Vec3};

/// How heavy a place on a body is that an end is joined to, in each direction.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Held {
    /// The impulse by how far it moves the place \[kg\]; zero, if nothing moves it.
    pub(in super::super) mass: Mat3,
    /// How far an impulse moves the place and the end together \[1/kg\].
    pub(in super::super) inverse: Mat3,
}

impl Held {
    /// Tells whether nothing moves it.
    pub(super) fn is_fixed(&self) -> bool {
        self.inverse == Mat3::ZERO
    }

    /// The inverse mass that it has for an impulse one way, of which another way counts \[1/kg\].
    pub(super) fn weight(&self, [one, other]: [Vec3; 2]) -> f32 {
        one.dot(self.inverse * other) / one.dot(other)
    }

    /// The same on a face that presses it, which pushes along its normal alone.
    pub(super) fn on(self, normal: Vec3) -> Self {
        let way = self.inverse * normal;
        let [x, y, z] = (way / normal.dot(way)).to_array().map(|share| way * share);
        Self { inverse: self.inverse - Mat3::from_cols(x, y, z), ..self }
    }

    /// The speed that it gets along a face that presses it, for each of speed off that: it is not as heavy in all directions.
    pub(super) fn lean(&self, normal: Vec3) -> Vec3 {
        if self.is_fixed() {
            return Vec3::ZERO;
        }
        let way = self.inverse * normal;
        aside(way / normal.dot(way), normal)
    }
}
