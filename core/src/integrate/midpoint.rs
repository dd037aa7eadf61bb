//! The midpoint method, and the lecture's slip of it.

use super::{Dynamics, Integrator, Motion, add_scaled, advance_by};
use crate::time::Time;

/// The midpoint method: half an Euler step to (t + h/2), then a whole step with the slope found there.
///
/// Order 2, two evaluations. On the real axis stable for h |λ| ≤ 2; an undamped oscillation grows at any step, slowly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Midpoint;

/// The midpoint method as the lecture prints it: the slope at the midpoint is that at time t, not t + h/2.
///
/// Order 1 where forces depend on time, else the same as [`Midpoint`]. For comparison, not for use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LectureMidpoint;

impl Integrator for Midpoint {
    fn columns(&self) -> usize {
        1
    }

    fn needs_start(&self) -> bool {
        true
    }

    fn is_local(&self) -> bool {
        true
    }

    fn lead(&self) -> f32 {
        0.5
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        advance(motion, [time, time + step.half()], step, world);
    }
}

impl Integrator for LectureMidpoint {
    fn columns(&self) -> usize {
        1
    }

    fn needs_start(&self) -> bool {
        true
    }

    fn is_local(&self) -> bool {
        true
    }

    fn lead(&self) -> f32 {
        0.5
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        advance(motion, [time; 2], step, world);
    }
}

/// A step whose two slopes are those of the given instants.
fn advance(motion: Motion<'_>, [first, second]: [Time; 2], step: Time, world: &mut dyn Dynamics) {
    let Motion { position: x, velocity: v, start: [x0, v0], work, .. } = motion;
    let [a] = work.take();
    let h = step.seconds();
    world.accelerations(first, x, v, a);
    add_scaled(x, 0.5 * h, v0);
    add_scaled(v, 0.5 * h, a);
    world.accelerations(second, x, v, a);
    advance_by(x, x0, h, v);
    advance_by(v, v0, h, a);
}
