//! Velocity Verlet.

use super::{Dynamics, Integrator, Motion, add_scaled};
use crate::time::Time;

/// Velocity Verlet: x += h v + h²/2 a, then v += h/2 (a + a') with a' found at the new place.
///
/// Order 2, two evaluations; the energy of an oscillation stays bounded for h ω ≤ 2. Orbits and undamped springs over
/// long times. Forces that depend on velocity are given v + h a for the second evaluation, which keeps order 2,
/// but no longer the energy: a force across the velocity (magnetic, Coriolis) feeds it in slowly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verlet;

impl Integrator for Verlet {
    fn columns(&self) -> usize {
        2
    }

    fn is_local(&self) -> bool {
        true
    }

    fn lead(&self) -> f32 {
        0.5
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, work, .. } = motion;
        let [a, b] = work.take();
        let h = step.seconds();
        world.accelerations(time, x, v, a);
        for ((x, v), &a) in x.iter_mut().zip(v.iter_mut()).zip(a.iter()) {
            *x += (*v + a * (0.5 * h)) * h;
            *v += a * h;
        }
        world.accelerations(time + step, x, v, b);
        // v now holds v₀ + h a; what is missing to v₀ + h/2 (a + b) is h/2 (b − a).
        for (b, &a) in b.iter_mut().zip(a.iter()) {
            *b -= a;
        }
        add_scaled(v, 0.5 * h, b);
    }
}
