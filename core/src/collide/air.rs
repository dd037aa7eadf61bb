//! Forces that brake are others after a hit.
//!
//! The mean acceleration of a path up to a hit is that of its own velocities. What goes on from there with another is driven by what forces
//! make of that: they are asked at both, for the one particle alone, and the rest of the step is that much off. So bounces have the second
//! order of the methods, as far as forces look at nothing but a particle's own row.

use super::path::Path;
use super::tile::Obstacles;
use crate::force::{Attributes, Force, State, Steady};
use crate::math::{along, dot, is_zero, max, minus, plus, scaled};
use crate::rows::BLOCKS;
use crate::time::Time;
use core::slice::from_ref;
use glam::Vec3;

/// The forces of a scene, which may depend on velocities, and on nothing of other particles.
#[derive(Clone, Copy)]
pub(super) struct Air<'a> {
    forces: &'a dyn Force,
    /// A steady acceleration and linear drag, if that is all.
    pub(super) steady: Option<Steady>,
}

/// One particle in the air.
#[derive(Clone, Copy)]
pub(super) struct Braked<'a> {
    forces: &'a dyn Force,
    attributes: &'a Attributes<'a>,
    row: usize,
}

/// Where and when a path goes on, for how long \[s\], and how fast.
pub(super) struct Onward {
    pub(super) place: Vec3,
    pub(super) now: Time,
    pub(super) rest: f32,
    pub(super) velocity: Vec3,
}

impl<'a> Air<'a> {
    /// The air that these are in, if there is any.
    pub(super) fn around(obstacles: &Obstacles<'a>) -> Option<Self> {
        let forces = obstacles.forces;
        let steady = if BLOCKS { forces.steady() } else { None };
        let may_brake = steady.is_none_or(|steady| steady.drags);
        (may_brake && forces.is_local()).then_some(Self { forces, steady })
    }

    /// The particle in a row of these.
    pub(super) fn braking(self, attributes: &'a Attributes<'a>, row: usize) -> Braked<'a> {
        Braked { forces: self.forces, attributes, row }
    }
}

impl Braked<'_> {
    /// The mean acceleration in the rest of a step, for which the mean up to then is known, of a path that goes on with another velocity
    /// than its own.
    ///
    /// For forces that are linear in the velocity it leaves the velocity that 1 + z + z²/2 + z³/6 in place of the exponential of z, the rest times
    /// the rate at which they brake, would leave: it comes to that at which they hold each other the balance, however strong they are, and never
    /// passes it.
    #[inline(never)]
    pub(super) fn acceleration(&self, path: &Path, mean: Vec3, onward: &Onward) -> Vec3 {
        let Self { forces, attributes, row } = *self;
        let Onward { place, now: time, rest, velocity } = *onward;
        let inverse_mass = attributes.inverse_mass[row];
        let mut state = attributes.lives.attributes_of(row..row + 1);
        state.time = time;
        let alone = |velocity: Vec3| {
            let mut total = [Vec3::ZERO];
            let state = State { position: from_ref(&place), velocity: from_ref(&velocity), ..state };
            forces.add_to(&state, 0..1, &mut total);
            scaled(total[0], inverse_mass)
        };
        let before = alone(path.mean_velocity());
        let jump = minus(alone(velocity), before);
        let first = plus(mean, jump);
        let square = dot(first, first);
        if is_zero(jump) {
            return mean;
        }
        let again = plus(mean, minus(alone(along(velocity, first, 0.5 * rest)), before));
        let change = minus(again, first);
        let solved = along(first, change, damping(max(-2.0 * dot(change, first) / square, 0.0)));
        // Where a force is beyond an f32 nothing is known of it.
        if solved.is_finite() { solved } else { mean }
    }
}

/// How much of the change that half a rest of `z` makes in an acceleration, to the first order in that, goes into its mean of the whole rest.
fn damping(z: f32) -> f32 {
    (1.0 + z * (2.0 / 3.0 + z * (1.0 / 3.0))) / (1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0))))
}
