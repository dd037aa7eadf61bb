//! A rigid body as a scene says it: its particles, and the box or hulls that they are in.

use super::hull::{Hull, corner};
use crate::constrain::turn::Turn;
use crate::math::sqrt;
use crate::particles::Particle;
use glam::{Mat3, Vec3};

/// The most pieces that a body may have.
const PIECES: u16 = 255;

/// A rigid body: some particles, and the box or hull they are in, or several hulls that are its pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBox {
    /// The first of its particles, by its place in the scene's start, and their number: the next ones are the others.
    pub first: u32,
    /// How many there are.
    pub count: u32,
    /// Half the sides of the box \[m\]; of the box about the middle that holds its hulls.
    pub half: Vec3,
    /// The middle of the box, or the centroid of the hull, at the scene's start; of several hulls where the frame is in which they are told
    /// \[m\].
    pub center: Vec3,
    /// How it is turned then: a quaternion x, y, z, w of any length but zero.
    pub turn: [f32; 4],
    /// The number of its hull among those of [`RigidBodies::hulls`](super::RigidBodies::hulls); none: it is a box, as it is where there is no such hull.
    pub hull: Option<u16>,
    /// How many hulls it consists of, that one and those that follow, from 1 to 255: so it need not be convex. Pieces may touch and overlap.
    pub pieces: u16,
}

impl RigidBox {
    /// An upright box of eight particles, `first` and those that follow.
    #[must_use]
    pub const fn new(half: Vec3, center: Vec3, first: u32) -> Self {
        Self { first, count: 8, half, center, turn: [0.0, 0.0, 0.0, 1.0], hull: None, pieces: 1 }
    }

    /// An upright body of eight particles that is the hull with a number.
    #[must_use]
    pub fn with_hull(hull: &Hull<'_>, number: u16, center: Vec3, first: u32) -> Self {
        Self { hull: Some(number), ..Self::new(hull.half(), center, first) }
    }

    /// How it is turned at the scene's start.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        Turn(self.turn).on(Vec3::ZERO).matrix()
    }

    /// Eight particles that are together as heavy as `whole`, and move as it does, with the inertia of a solid box: M (a² + b²) / 3 about an
    /// axis across half sides a and b.
    #[must_use]
    pub fn solid(&self, whole: Particle) -> [Particle; 8] {
        let half = self.half * sqrt(1.0 / 3.0);
        self.at(core::array::from_fn(|i| corner(half, i as u32)), whole)
    }

    /// The same of a solid hull.
    #[must_use]
    pub fn solid_hull(&self, hull: &Hull<'_>, whole: Particle) -> [Particle; 8] {
        self.at(hull.particles(), whole)
    }

    /// Eight equal particles at places in its frame.
    pub(super) fn at(&self, places: [Vec3; 8], whole: Particle) -> [Particle; 8] {
        let turn = self.rotation();
        places.map(|place| Particle { position: self.center + turn * place, mass: whole.mass * 0.125, ..whole })
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let above_zero = |x: f32| x > 0.0 && x < f32::INFINITY;
        let square = self.turn.iter().map(|x| x * x).sum::<f32>();
        let faults = [
            (self.count == 0, "count", "has to be one or more"),
            (!self.half.to_array().into_iter().all(above_zero), "half", "has to be above zero, in m"),
            (!self.center.is_finite(), "center", "has to be finite"),
            (!(1..=PIECES).contains(&self.pieces), "pieces", "has to be from 1 to 255"),
            (!above_zero(square), "turn", "has to be a quaternion x, y, z, w that is not zero"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }
}
