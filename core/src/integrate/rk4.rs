//! The classical Runge-Kutta method.

use super::{Dynamics, Integrator, Motion, add_scaled, advance_by};
use crate::time::Time;

/// The classical Runge-Kutta method of fourth order.
///
/// Order 4, four evaluations; stable for h |λ| ≤ 2.785 on the real axis and h ω ≤ 2√2 for an undamped oscillation,
/// which it damps slightly. The choice where accuracy counts: springs, orbits, whatever is smooth.
///
/// For x' = v its stages fold into x += h v + h²/6 (a₁ + a₂ + a₃) and v += h/6 (a₁ + 2a₂ + 2a₃ + a₄).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

impl Integrator for Rk4 {
    fn columns(&self) -> usize {
        3
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
        let Motion { position: x, velocity: v, start: [x0, v0], work, .. } = motion;
        let [a, sum_x, sum_v] = work.take();
        let h = step.seconds();

        world.accelerations(time, x, v, a);
        sum_x.copy_from_slice(a);
        sum_v.copy_from_slice(a);
        advance_by(x, x0, 0.5 * h, v0);
        advance_by(v, v0, 0.5 * h, a);

        for next in [0.5 * h, h] {
            world.accelerations(time + step.half(), x, v, a);
            add_scaled(sum_x, 1.0, a);
            add_scaled(sum_v, 2.0, a);
            advance_by(x, x0, next, v);
            advance_by(v, v0, next, a);
        }

        world.accelerations(time + step, x, v, a);
        add_scaled(sum_v, 1.0, a);
        for ((x, &x0), (&v0, &s)) in x.iter_mut().zip(x0).zip(v0.iter().zip(sum_x.iter())) {
            *x = x0 + (v0 + s * (h / 6.0)) * h;
        }
        advance_by(v, v0, h / 6.0, sum_v);
    }
}
