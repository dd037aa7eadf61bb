//! A cluster as a whole: where it is, how it moves, and how it answers pushes.

use crate::constrain::Bodies;
use crate::constrain::turn::{about, solve_thin};
use crate::constrain::walls::Whole;
use crate::math::dot;
use glam::{Mat3, Vec3};

/// A particle of a cluster.
pub(super) struct Member {
    pub(super) row: usize,
    /// Its place in the shape.
    pub(super) place: Vec3,
    pub(super) fixed: bool,
}

/// How a cluster is held by those that are fixed.
#[derive(Clone, Copy)]
pub(super) enum Hold {
    /// It can turn about its centre.
    Free,
    /// It can turn about an axis, which itself turns so fast \[rad/s\].
    About { axis: Vec3, omega: Vec3 },
    /// It turns with those that are fixed \[rad/s\].
    Fast { omega: Vec3 },
}

/// A cluster as a whole.
pub(super) struct Body {
    /// The place of its first particle, from which all others are told: far from the world's origin differences are exact.
    pub(super) origin: Vec3,
    /// The mass of all that move \[kg\], the number of those that are fixed, and how these hold it.
    pub(super) mass: f32,
    pub(super) fixed: u32,
    pub(super) hold: Hold,
    /// The centre: of mass, or of those that are fixed; its place in the shape, and its velocity.
    pub(super) center: Vec3,
    pub(super) rest: Vec3,
    pub(super) drift: Vec3,
}

impl Body {
    /// Where a particle is, from the centre.
    pub(super) fn place(&self, bodies: &Bodies<'_>, row: usize) -> Vec3 {
        bodies.position[row] - self.origin - self.center
    }

    /// The energy of its motion over its mass \[J/kg\], for so much angular momentum.
    pub(super) fn energy(&self, spin: Vec3, spread: Mat3) -> f32 {
        let drift = if self.fixed > 0 { 0.0 } else { dot(self.drift, self.drift) };
        0.5 * (drift + dot(spin, solve_thin(spread, spin)))
    }

    /// How it answers a push at a particle, of which all bear a share, by the sum of r rᵀ over the mass.
    pub(super) fn whole(&self, spread: Mat3, share: f32) -> Whole {
        let inverse = match self.hold {
            Hold::Free => [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| solve_thin(spread, axis)),
            Hold::About { axis, .. } => {
                let [x, y, z] = axis.to_array().map(|part| about(axis, spread, axis * part));
                [axis * x, axis * y, axis * z]
            }
            Hold::Fast { .. } => [Vec3::ZERO; 3],
        };
        let rate = 1.0 / self.mass;
        let [x, y, z] = inverse.map(|column| column * rate);
        let inverse_mass = if self.fixed > 0 { 0.0 } else { rate };
        Whole {
            origin: self.origin,
            center: self.center,
            inverse_mass,
            inverse_inertia: Mat3::from_cols(x, y, z),
            share,
        }
    }

    /// What it weighs in rotations, a share of the mass.
    pub(super) fn weight(&self, bodies: &Bodies<'_>, member: &Member) -> f32 {
        if member.fixed { 0.0 } else { bodies.mass[member.row] / self.mass }
    }
}
