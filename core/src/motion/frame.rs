//! Where what moves has been brought, and how it moves there.

use crate::shape::{Aabb, Affine};
use glam::{Mat3, Vec3};

/// Where a script has brought everything at an instant, and how it moves there: x is at turn (x − pivot) + place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// A rotation.
    pub turn: Mat3,
    /// The point about which it turns, where it was before it moved \[m\].
    pub pivot: Vec3,
    /// The same point where it is now \[m\].
    pub place: Vec3,
    /// The velocity of that point \[m/s\].
    pub velocity: Vec3,
    /// Its acceleration \[m/s²\].
    pub acceleration: Vec3,
    /// The angular velocity \[rad/s\].
    pub spin: Vec3,
    /// The angular acceleration \[rad/s²\].
    pub spin_up: Vec3,
    /// The largest acceleration of that point in the time about the instant \[m/s²\]: how straight its way is.
    pub bend: f32,
}

/// The box without bounds.
pub(crate) const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

impl Frame {
    /// That of what stands still.
    pub const STILL: Self = Self {
        turn: Mat3::IDENTITY,
        pivot: Vec3::ZERO,
        place: Vec3::ZERO,
        velocity: Vec3::ZERO,
        acceleration: Vec3::ZERO,
        spin: Vec3::ZERO,
        spin_up: Vec3::ZERO,
        bend: 0.0,
    };

    /// The place that a point of the world has in the frame \[m\].
    #[must_use]
    pub fn local(&self, point: Vec3) -> Vec3 {
        self.turn.transpose() * (point - self.place) + self.pivot
    }

    /// The place in the world of a point in the frame \[m\].
    #[must_use]
    pub fn world(&self, point: Vec3) -> Vec3 {
        self.turn * (point - self.pivot) + self.place
    }

    /// The velocity of whatever the frame has at a point of the world \[m/s\].
    #[must_use]
    pub fn velocity_at(&self, point: Vec3) -> Vec3 {
        self.spin.cross(point - self.place) + self.velocity
    }

    /// The acceleration of whatever the frame has at a point of the world \[m/s²\].
    #[must_use]
    pub fn acceleration_at(&self, point: Vec3) -> Vec3 {
        let arm = point - self.place;
        self.spin.cross(self.spin.cross(arm)) + self.spin_up.cross(arm) + self.acceleration
    }

    /// The same as a transform.
    #[must_use]
    pub fn affine(&self) -> Affine {
        Affine { linear: self.turn, shift: self.place - self.turn * self.pivot }
    }
}
