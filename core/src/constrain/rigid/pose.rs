//! Where eight bodies are and how they move, side by side.

use super::body::Body;
use super::fours::fours;
use crate::lanes::{Eight, LANES, Row, Vectors};
use core::mem::offset_of;

/// The inverses of the inertias of those of a pack over their masses in the world \[1/m²\].
pub(super) type Inverse = [[Row; 3]; 3];

/// How bodies move, while impulses change that.
#[derive(Clone, Copy)]
pub(super) struct Motion<F> {
    pub(super) inverse_mass: F,
    pub(super) velocity: Vectors<F>,
    pub(super) omega: Vectors<F>,
    pub(super) inverse: [Vectors<F>; 3],
}

/// Where the words of a body are that are read in one go.
const MOTION: usize = offset_of!(Body, inverse_mass) / 4;

impl<F: Eight> Motion<F> {
    #[inline(always)]
    pub(super) fn of(like: F, bodies: &[&Body; LANES]) -> Self {
        let [inverse_mass, x, y, z] = fours(like, bodies, MOTION);
        let [_, _, _, p] = fours(like, bodies, MOTION + 4);
        let [q, r, xx, xy] = fours(like, bodies, MOTION + 8);
        let [xz, yx, yy, yz] = fours(like, bodies, MOTION + 12);
        let [zx, zy, zz, _] = fours(like, bodies, MOTION + 16);
        Self {
            inverse_mass,
            velocity: Vectors([x, y, z]),
            omega: Vectors([p, q, r]),
            inverse: [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])],
        }
    }

    /// The change of their spins by an angular impulse over the mass.
    #[inline(always)]
    pub(super) fn turned_by(&self, Vectors([x, y, z]): Vectors<F>) -> Vectors<F> {
        let [a, b, c] = self.inverse;
        a * x + b * y + c * z
    }

    #[inline(always)]
    pub(super) fn at(&self, arm: Vectors<F>) -> Vectors<F> {
        self.velocity + self.omega.cross(arm)
    }

    /// The inverses of their inertias, as passes want them.
    #[inline(always)]
    pub(super) fn inverse(&self) -> Inverse {
        let [a, b, c] = self.inverse;
        [a.saved(), b.saved(), c.saved()]
    }
}

/// Where bodies are, and how they move.
#[derive(Clone, Copy)]
pub(super) struct Pose<F> {
    pub(super) motion: Motion<F>,
    pub(super) center: Vectors<F>,
    rest: Vectors<F>,
    rotation: [Vectors<F>; 3],
    /// How they moved when the sub-step began.
    before: [Vectors<F>; 2],
}

impl<F: Eight> Pose<F> {
    #[inline(always)]
    pub(super) fn of(like: F, bodies: &[&Body; LANES]) -> Self {
        let [_, _, _, a] = fours(like, bodies, MOTION + 16);
        let [b, c, i, j] = fours(like, bodies, MOTION + 20);
        let [k, xx, xy, xz] = fours(like, bodies, MOTION + 24);
        let [yx, yy, yz, zx] = fours(like, bodies, MOTION + 28);
        let [zy, zz, x, y] = fours(like, bodies, MOTION + 32);
        let [z, p, q, r] = fours(like, bodies, MOTION + 36);
        Self {
            motion: Motion::of(like, bodies),
            center: Vectors([a, b, c]),
            rest: Vectors([i, j, k]),
            rotation: [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])],
            before: [Vectors([x, y, z]), Vectors([p, q, r])],
        }
    }

    /// Those parts of their frames that are in the world.
    #[inline(always)]
    pub(super) fn turned(&self, Vectors([x, y, z]): Vectors<F>) -> Vectors<F> {
        let [a, b, c] = self.rotation;
        a * x + b * y + c * z
    }

    /// Those parts of the world that are in their frames.
    #[inline(always)]
    pub(super) fn turned_back(&self, v: Vectors<F>) -> Vectors<F> {
        let [a, b, c] = self.rotation;
        Vectors([a.dot(v), b.dot(v), c.dot(v)])
    }

    /// From their centres to a place in their frames.
    #[inline(always)]
    pub(super) fn arm(&self, place: Vectors<F>) -> Vectors<F> {
        self.turned(place - self.rest)
    }

    /// The place in the world of a place in their frames.
    #[inline(always)]
    pub(super) fn point(&self, place: Vectors<F>) -> Vectors<F> {
        self.center + self.arm(place)
    }

    #[inline(always)]
    pub(super) fn at_before(&self, arm: Vectors<F>) -> Vectors<F> {
        let [velocity, omega] = self.before;
        velocity + omega.cross(arm)
    }

    /// How much faster they have become since.
    #[inline(always)]
    pub(super) fn gained(&self) -> F {
        (self.motion.velocity - self.before[0]).length()
    }
}
