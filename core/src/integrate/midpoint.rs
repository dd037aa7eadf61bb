//! The midpoint method.

use super::{Dynamics, Integrator, Motion, add_scaled, advance_by};
use crate::time::Time;

/// The midpoint method: half an Euler step to (t + h/2), then a whole step with the slope found there.
///
/// Order 2, two evaluations. On the real axis stable for h |λ| ≤ 2; an undamped oscillation grows at any step, slowly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Midpoint;

impl Integrator for Midpoint {
    fn columns(&self) -> usize {
        1
    }

    fn needs_start(&self) -> bool {
        true
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, start: [x0, v0], work } = motion;
        let [a] = work.take();
        let h = step.seconds();
        world.accelerations(time, x, v, a);
        add_scaled(x, 0.5 * h, v0);
        add_scaled(v, 0.5 * h, a);
        world.accelerations(time + step.half(), x, v, a);
        advance_by(x, x0, h, v);
        advance_by(v, v0, h, a);
    }
}
