//! Step doubling.

use super::{Dynamics, Integrator, Motion, TICK, Work, cut, difference};
use crate::report::Effort;
use crate::time::Time;
use glam::Vec3;

/// Step doubling around another method, the lecture's adaptive step: one step of h is compared with two of h/2, and if
/// they differ too much h is halved and tried again.
///
/// The order and the stability of the method inside, three times its cost. Unlike the lecture's, the error is that of
/// velocities as well, times h: a spring at its rest length looks at rest by its positions alone. A step that errs by less
/// than a fortieth of the tolerance is doubled for the next time (a method of order 4 errs by 32 times as much then). Use it
/// where a scene is calm for long and wild at times, around whatever method suits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive<I> {
    /// The method inside.
    pub inner: I,
    /// How far the two may differ \[m\].
    pub tolerance: f32,
    /// The smallest step of h, at least a tick of time: it is taken whatever its error, and counted.
    pub smallest: Time,
    /// The largest number of steps of h that may be tried in one step of the system. The rest is taken at once then,
    /// and counted.
    pub attempts: u32,
}

impl<I> Adaptive<I> {
    /// Around a method, with the usual settings: 0.1 mm, a microsecond, ten thousand attempts.
    #[must_use]
    pub const fn around(inner: I) -> Self {
        Self { inner, tolerance: 1e-4, smallest: Time::from_ticks(4295), attempts: 10_000 }
    }
}

/// The state where an inner step begins, and a copy to compare with.
struct Marks<'a> {
    from: [&'a mut [Vec3]; 2],
    whole: [&'a mut [Vec3]; 2],
    half: [&'a mut [Vec3]; 2],
}

impl<I: Integrator> Integrator for Adaptive<I> {
    fn columns(&self) -> usize {
        self.inner.columns().saturating_add(6)
    }

    fn lead(&self) -> f32 {
        self.inner.lead()
    }

    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, work, hint, effort, .. } = motion;
        let ([x0, v0, xa, va, xh, vh], mut work) = work.split();
        let mut marks = Marks { from: [x0, v0], whole: [xa, va], half: [xh, vh] };
        let (mut now, end) = (time, time + step);
        let smallest = self.smallest.max(TICK);
        let mut h = if *hint == Time::ZERO { step } else { *hint };
        for _ in 0..self.attempts {
            if now >= end {
                break;
            }
            let taken = cut(h, end - now);
            let error = self.double([&mut *x, &mut *v], &mut marks, [now, taken], &mut work, world, effort);
            let fine = error <= self.tolerance;
            if fine || taken <= smallest {
                effort.accepted += 1;
                effort.capped += u64::from(!fine);
                now = now + taken;
                world.reached(now, x, v);
                if taken >= h && error * 40.0 < self.tolerance {
                    h = h + h;
                }
            } else {
                effort.rejected += 1;
                copy(&marks.from, [&mut *x, &mut *v]);
                h = taken.half().max(smallest);
            }
        }
        if now < end {
            effort.capped += 1;
            copy(&[&mut *x, &mut *v], marks.from.each_mut().map(|mark| &mut **mark));
            self.inner_step([x, v], &marks.from, [now, end - now], &mut work, world, effort);
        }
        *hint = h;
    }
}

impl<I: Integrator> Adaptive<I> {
    /// Leaves `at` behind two half steps, and returns how far a whole one would be from there.
    fn double(
        &self,
        [x, v]: [&mut [Vec3]; 2],
        marks: &mut Marks<'_>,
        [now, step]: [Time; 2],
        work: &mut Work<'_>,
        world: &mut dyn Dynamics,
        effort: &mut Effort,
    ) -> f32 {
        let Marks { from, whole, half } = marks;
        let first = step.half();
        copy(&[&mut *x, &mut *v], from.each_mut().map(|mark| &mut **mark));
        self.inner_step([&mut *x, &mut *v], from, [now, step], work, world, effort);
        copy(&[&mut *x, &mut *v], whole.each_mut().map(|mark| &mut **mark));
        copy(from, [&mut *x, &mut *v]);
        self.inner_step([&mut *x, &mut *v], from, [now, first], work, world, effort);
        copy(&[&mut *x, &mut *v], half.each_mut().map(|mark| &mut **mark));
        self.inner_step([&mut *x, &mut *v], half, [now + first, step - first], work, world, effort);
        let apart = |sound: &dyn Fn(usize) -> bool| difference([whole[0], whole[1]], [x, v], step.seconds(), sound);
        let error = apart(&|_| true);
        if error < f32::INFINITY {
            return error;
        }
        // A particle that is beyond all numbers from the beginning is so whatever the step, and counts for nothing.
        world.accelerations(now, from[0], from[1], half[0]);
        apart(&|row| [&from[0][row], &from[1][row], &half[0][row]].iter().all(|v| v.is_finite()))
    }

    fn inner_step(
        &self,
        [position, velocity]: [&mut [Vec3]; 2],
        start: &[&mut [Vec3]; 2],
        [now, step]: [Time; 2],
        work: &mut Work<'_>,
        world: &mut dyn Dynamics,
        effort: &mut Effort,
    ) {
        let start = [&*start[0], &*start[1]];
        let hint = &mut Time::default();
        self.inner.advance(Motion { position, velocity, start, work: work.again(), hint, effort }, now, step, world);
    }
}

fn copy(from: &[&mut [Vec3]; 2], to: [&mut [Vec3]; 2]) {
    for (from, to) in from.iter().zip(to) {
        to.copy_from_slice(from);
    }
}
