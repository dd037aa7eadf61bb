//! What colliders answer: where a path hits them, where a ball leans on them, where they take what rests on them.

use glam::{Mat3, Vec3};

/// Where a segment meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The fraction of the segment that is free, in [0, 1].
    pub time: f32,
    /// Unit normal of the surface, on the side that the segment comes from.
    pub normal: Vec3,
    /// How far from the computed point the surface may really be \[m\]: a few units in the last place of the
    /// coordinates involved, never an absolute epsilon.
    pub slack: f32,
    /// How the surface itself moves there \[m/s\].
    pub velocity: Vec3,
    /// Number of its material in the scene, if it has one.
    pub material: Option<u16>,
    /// Which triangle of a mesh; zero for what has but one part.
    pub face: u32,
}

impl Hit {
    /// A hit on something at rest and of no material.
    #[inline]
    #[must_use]
    pub const fn new(time: f32, normal: Vec3, slack: f32) -> Self {
        Self { time, normal, slack, velocity: Vec3::ZERO, material: None, face: 0 }
    }
}

/// A place of a surface near a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The place \[m\].
    pub point: Vec3,
    /// Unit vector from there toward the ball's centre.
    pub normal: Vec3,
    /// How far the centre is \[m\].
    pub distance: f32,
    /// How far from the computed place the surface may really be \[m\], as for a [`Hit`].
    pub slack: f32,
    /// How the surface itself moves there \[m/s\].
    pub velocity: Vec3,
    /// Number of its material in the scene, if it has one.
    pub material: Option<u16>,
    /// Which triangle of a mesh; zero for what has but one part.
    pub face: u32,
}

/// Where what moves takes a particle that rests on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ride {
    /// Where the particle is in the end \[m\].
    pub place: Vec3,
    /// How it moves in the beginning and in the end \[m/s\]: as what takes it along does at its centre, since it does not spin.
    pub velocity: [Vec3; 2],
    /// How that changes in the beginning \[m/s²\].
    pub acceleration: Vec3,
    /// How it turns in the beginning and in the end \[rad/s\].
    pub spin: [Vec3; 2],
    /// How it has turned meanwhile.
    pub turn: Mat3,
}

impl Ride {
    /// How the velocity changes in the beginning of what goes along so fast \[m/s\] and keeps that way, as seen from what takes it along \[m/s²\]: by that of
    /// Coriolis as well.
    pub(crate) fn acceleration_of(&self, slip: Vec3) -> Vec3 {
        self.acceleration + 2.0 * self.spin[0].cross(slip)
    }

    /// Where what goes along by a way \[m\], as that leads in the beginning, and so fast at last \[m/s\], is in the end, and its velocity.
    pub(crate) fn after(&self, way: Vec3, slip: Vec3) -> (Vec3, Vec3) {
        let [.., velocity] = self.velocity;
        let way = self.turn * way;
        (self.place + way, velocity + self.spin[1].cross(way) + self.turn * slip)
    }
}

/// The earlier of two hits, the first where they tie.
pub(crate) fn earlier(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(x), Some(y)) => Some(if y.time < x.time { y } else { x }),
        (a, b) => a.or(b),
    }
}
