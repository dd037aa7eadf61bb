//! Forces that brake are others after a hit.
//!
//! The mean acceleration of a path up to a hit is that of its own velocities. What goes on from there with another is driven by what forces
//! make of that: they are asked at both, for the one particle alone, and the rest of the step is that much off. So bounces have the second
//! order of the methods, as far as forces look at nothing but a particle's own row.

use super::path::Path;
use super::tile::Obstacles;
use crate::force::{Attributes, Force, State, Steady};
use crate::math::{along, dot, is_zero, length, max, minus, over, plus, scaled};
use crate::rows::BLOCKS;
use crate::time::Time;
use core::slice::from_ref;
use glam::Vec3;

/// The share of a bound on speeds that rounding may add.
pub(super) const ROUNDING: f32 = 1.000_1;

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

/// Where and when a path goes on, and the mean acceleration that it has had up to then.
#[derive(Clone, Copy)]
pub(super) struct Until<'p> {
    pub(super) path: &'p Path,
    pub(super) place: Vec3,
    pub(super) now: Time,
    pub(super) acceleration: Vec3,
}

/// Accelerations of a path that goes on with another velocity: that with which it begins, and its mean in the rest of the step.
#[derive(Clone, Copy)]
pub(super) struct Onward {
    pub(super) first: Vec3,
    pub(super) mean: Vec3,
}

impl<'a> Air<'a> {
    /// The air that these are in, if there is any.
    pub(super) fn around(obstacles: &Obstacles<'a>) -> Option<Self> {
        let Obstacles { forces, materials, .. } = *obstacles;
        let steady = if BLOCKS { forces.steady() } else { None };
        let may_brake = steady.is_none_or(|steady| steady.drags);
        // What floats has one term more.
        let floats = || materials.code().is_some_and(|code| (code.floats)(materials));
        let steady = steady.filter(|_| !floats());
        (may_brake && forces.is_local()).then_some(Self { forces, steady })
    }

    /// The particle in a row of these.
    pub(super) fn braking(self, attributes: &'a Attributes<'a>, row: usize) -> Braked<'a> {
        Braked { forces: self.forces, attributes, row }
    }
}

impl Until<'_> {
    /// The accelerations, if nothing brakes.
    pub(super) fn unchanged(&self) -> Onward {
        Onward { first: self.acceleration, mean: self.acceleration }
    }
}

impl Onward {
    /// The mean of what a surface of this normal keeps from moving across it.
    pub(super) fn held(&self, normal: Vec3) -> Vec3 {
        let more = minus(self.first, self.mean);
        if is_zero(more) { self.mean } else { along(self.mean, normal, dot(more, normal)) }
    }
}

impl Braked<'_> {
    /// The accelerations with which a path goes on with this velocity.
    ///
    /// Forces that change by −z times what velocities change by in the rest leave of that what 1 / (1 + z + z²/2 + z³/6), in place of
    /// the exponential of −z, leaves: however strong they are, it comes to the velocity at which they hold each other the balance, and not beyond that.
    /// Where they would make it faster than both velocities and the acceleration so far account for, that is kept.
    #[inline(never)]
    pub(super) fn onward(&self, until: &Until<'_>, velocity: Vec3) -> Onward {
        let Self { forces, attributes, row } = *self;
        let Until { path, place, now: time, acceleration } = *until;
        let (rest, past) = ((path.during[1] - time).seconds(), path.mean_velocity());
        let inverse_mass = attributes.inverse_mass[row];
        let mut state = attributes.lives.attributes_of(row..row + 1);
        (state.time, state.position) = (time, from_ref(&place));
        let after = alone(forces, &mut state, &velocity);
        let before = alone(forces, &mut state, &past);
        let jump = minus(scaled(after, inverse_mass), scaled(before, inverse_mass));
        let change = minus(velocity, past);
        if is_zero(jump) {
            return until.unchanged();
        }
        let first = plus(acceleration, jump);
        let z = max(-dot(jump, change) / dot(change, change), 0.0) * rest;
        let mean = over(first, 1.0 / (1.0 + z * (0.5 + z * (1.0 / 6.0))) + z);
        let fastest = max(length(velocity), length(past)) + length(acceleration) * rest;
        // Neither is a force that is beyond an f32.
        let is_slow = length(along(velocity, mean, rest)) <= ROUNDING * fastest;
        if is_slow && first.is_finite() { Onward { first, mean } } else { until.unchanged() }
    }
}

/// The force on the only particle of a state at another velocity. One state does for all, as chips have little room for another.
fn alone<'s>(forces: &dyn Force, state: &mut State<'s>, velocity: &'s Vec3) -> Vec3 {
    let mut total = [Vec3::ZERO];
    state.velocity = from_ref(velocity);
    forces.add_to(state, 0..1, &mut total);
    total[0]
}
