//! The two Euler methods.

use super::{Drift, Dynamics, Integrator, Linearising, Motion, add_scaled};
use crate::time::Time;

/// Explicit Euler: x += h v, then v += h a, both from the step's beginning.
///
/// Order 1, one evaluation. An undamped oscillation grows at any step; with damping ratio ζ ≤ 1 it is stable for
/// h ω ≤ 2ζ. For comparison, not for use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Euler;

/// Symplectic (semi-implicit) Euler: v += h a, then x += h v with the new v.
///
/// Order 1, one evaluation, and the energy of an oscillation stays bounded for h ω ≤ 2. The cheapest method that can
/// be trusted, for forces of the place alone and drag: effects with many particles. A force across the velocity (magnetic, Coriolis)
/// feeds energy in, as with explicit Euler: take [`Rk4`](super::Rk4) there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Symplectic;

impl Integrator for Euler {
    fn columns(&self) -> usize {
        1
    }

    fn is_local(&self) -> bool {
        true
    }

    fn drift(&self) -> Option<Drift> {
        Some(Drift::Before)
    }

    fn linearising(&self) -> Option<Linearising> {
        None
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let ([a], h) = (motion.work.take(), step.seconds());
        world.accelerations(time, motion.position, motion.velocity, a);
        add_scaled(motion.position, h, motion.velocity);
        add_scaled(motion.velocity, h, a);
    }
}

impl Integrator for Symplectic {
    fn columns(&self) -> usize {
        1
    }

    fn is_local(&self) -> bool {
        true
    }

    fn drift(&self) -> Option<Drift> {
        Some(Drift::After)
    }

    fn linearising(&self) -> Option<Linearising> {
        None
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let ([a], h) = (motion.work.take(), step.seconds());
        world.accelerations(time, motion.position, motion.velocity, a);
        add_scaled(motion.velocity, h, a);
        add_scaled(motion.position, h, motion.velocity);
    }
}
