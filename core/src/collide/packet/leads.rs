//! By how much methods lead particles beyond parabolas along a face, as `Lead` has it.

use super::paths::Cubics;
use crate::lanes::{Lanes, Vectors, not};

/// That of paths side by side.
#[derive(Clone, Copy)]
pub(super) struct Leads<F> {
    /// Those that are led at all.
    are: F,
    way: Vectors<F>,
    acceleration: Vectors<F>,
}

impl<F: Lanes> Leads<F> {
    /// Those of paths that take so long and meet a face after fractions of their times.
    #[inline(always)]
    pub(super) fn of(cubics: &Cubics<F>, time: F, s: F, normal: Vectors<F>) -> Self {
        let (all, excess) = (|x| s.all(x), cubics.excess);
        let are = not(excess.is_zero() | cubics.lag());
        let is_smooth = cubics.are_smooth();
        let (excess, left) = (excess - normal * excess.dot(normal), all(1.0) - s);
        let share = is_smooth.select(left * left * left, left * left * (all(1.0) + all(2.0) * s));
        let acceleration = (excess * (all(-6.0) * s / (time * time))).masked(is_smooth);
        Self { are, way: excess * share, acceleration }
    }

    /// Accelerations in the rests of paths whose means are these.
    #[inline(always)]
    pub(super) fn onward(&self, mean: Vectors<F>) -> Vectors<F> {
        Vectors::select(self.are, mean + self.acceleration, mean)
    }

    /// The ends of parabolas, led beyond them.
    #[inline(always)]
    pub(super) fn beyond(&self, end: Vectors<F>) -> Vectors<F> {
        Vectors::select(self.are, end + self.way, end)
    }

    /// The same of those who slide, whose velocities change so much without and with friction.
    #[inline(always)]
    pub(super) fn slid(&self, end: Vectors<F>, free: Vectors<F>, braked: Vectors<F>) -> Vectors<F> {
        let square = free.dot(free);
        let goes = not(braked.is_zero()) & square.simd_gt(square.all(0.0));
        let way = self.way + (braked - free) * (self.way.dot(free) / square);
        Vectors::select(self.are & goes, end + way, end)
    }
}
