//! An embedded Runge-Kutta pair.

use super::{Dynamics, Integrator, Motion, TICK, advance_by, cut};
use crate::math::{cbrt, clamp, largest, max};
use crate::time::Time;
use glam::Vec3;

/// Bogacki and Shampine's pair of orders 3 and 2 ("A 3(2) pair of Runge-Kutta formulas", Appl. Math. Lett. 2, 1989): the
/// difference of both is the error of the step, which is made as long as the tolerance allows.
///
/// Order 3, three evaluations a step (the last one is the next step's first). Stable for h |λ| ≤ 2.51 on the real axis and
/// h ω ≤ 1.73 for an undamped oscillation. The choice where nobody knows which step is right: smooth forces, no collisions
/// or few. Steps end where the system's step ends, so nothing has to be interpolated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Embedded {
    /// The error that a step may make \[m\], in positions, and in velocities times the step.
    pub tolerance: f32,
    /// The smallest step, at least a tick of time: it is taken whatever its error, and counted.
    pub smallest: Time,
    /// The largest number of steps that may be tried in one step of the system. The rest is taken at once then, and
    /// counted.
    pub attempts: u32,
}

impl Embedded {
    /// 0.1 mm, a microsecond, ten thousand attempts.
    pub const USUAL: Self = Self { tolerance: 1e-4, smallest: Time::from_ticks(4295), attempts: 10_000 };
}

impl Default for Embedded {
    fn default() -> Self {
        Self::USUAL
    }
}

impl Integrator for Embedded {
    fn columns(&self) -> usize {
        6
    }

    fn lead(&self) -> f32 {
        0.5
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, work, hint, effort, .. } = motion;
        let [x0, v0, a1, a2, a3, a4] = work.take();
        let (mut now, end) = (time, time + step);
        let smallest = self.smallest.max(TICK);
        let mut h = if *hint == Time::ZERO { step } else { *hint };
        world.accelerations(now, x, v, a1);
        let mut tries = 0;
        while now < end {
            tries += 1;
            let last = tries >= self.attempts;
            let taken = if last { end - now } else { cut(h, end - now) };
            x0.copy_from_slice(x);
            v0.copy_from_slice(v);
            let stages = Stages { x0, v0, a1, a2: &mut *a2, a3: &mut *a3, a4: &mut *a4 };
            let error = stages.advance([&mut *x, &mut *v], now, taken, world);
            let fine = error <= self.tolerance;
            let proposed = Time::from_seconds(taken.seconds() * growth(error / self.tolerance)).max(smallest);
            if fine || last || taken <= smallest {
                effort.accepted += 1;
                effort.capped += u64::from(!fine);
                now = now + taken;
                a1.copy_from_slice(a4);
                world.reached(now, x, v);
                // A step that was cut at the end says nothing against a longer one.
                h = if taken < h { h.max(proposed) } else { proposed };
            } else {
                effort.rejected += 1;
                x.copy_from_slice(x0);
                v.copy_from_slice(v0);
                h = proposed;
            }
        }
        *hint = h;
    }
}

/// By how much the next step may be longer: the error goes with the third power of the step. (Hairer, Nørsett, Wanner,
/// "Solving Ordinary Differential Equations I", II.4.)
fn growth(ratio: f32) -> f32 {
    if ratio < f32::INFINITY { clamp(0.9 / cbrt(max(ratio, 1e-6)), 0.2, 5.0) } else { 0.2 }
}

/// Where a step begins, and the accelerations at its four stages; the first is given.
struct Stages<'a> {
    x0: &'a [Vec3],
    v0: &'a [Vec3],
    a1: &'a [Vec3],
    a2: &'a mut [Vec3],
    a3: &'a mut [Vec3],
    a4: &'a mut [Vec3],
}

impl Stages<'_> {
    /// Moves everything by `step`, finds the acceleration there, and returns the error. For x' = v the velocities of the
    /// stages fold into sums of accelerations.
    fn advance(self, [x, v]: [&mut [Vec3]; 2], now: Time, step: Time, world: &mut dyn Dynamics) -> f32 {
        let Self { x0, v0, a1, a2, a3, a4 } = self;
        let (h, hh) = (step.seconds(), step.seconds() * step.seconds());
        advance_by(x, x0, 0.5 * h, v0);
        advance_by(v, v0, 0.5 * h, a1);
        world.accelerations(now + step.half(), x, v, a2);
        // The velocity of the second stage carries positions to the third.
        advance_by(x, x0, 0.75 * h, v);
        advance_by(v, v0, 0.75 * h, a2);
        world.accelerations(now + step.half() + step.half().half(), x, v, a3);
        for i in 0..x.len() {
            x[i] = x0[i] + v0[i] * h + (a1[i] * (1.0 / 6.0) + a2[i] * (1.0 / 3.0)) * hh;
            v[i] = v0[i] + (a1[i] * (2.0 / 9.0) + a2[i] * (1.0 / 3.0) + a3[i] * (4.0 / 9.0)) * h;
        }
        world.accelerations(now + step, x, v, a4);
        let mut most = 0.0;
        for i in 0..x.len() {
            let ex = a1[i] * (1.0 / 72.0) + a2[i] * (1.0 / 24.0) - a3[i] * (1.0 / 18.0);
            let ev = a1[i] * (-5.0 / 72.0) + a2[i] * (1.0 / 12.0) + a3[i] * (1.0 / 9.0) - a4[i] * (1.0 / 8.0);
            // The largest coordinate may overlook one that is not a number.
            let finite = ex.is_finite() && ev.is_finite();
            let gap = if finite { hh * max(largest(ex), largest(ev)) } else { f32::INFINITY };
            // A particle that is beyond all numbers from the beginning is so whatever the step.
            let sound = x0[i].is_finite() && v0[i].is_finite() && a1[i].is_finite();
            if sound && !(gap <= most) {
                most = gap;
            }
        }
        most
    }
}
