//! Paths of particles side by side, and the polynomials that they are.

use crate::collide::path::CHORD_ERROR;
use crate::lanes::{Lanes, Vectors, max, not};

/// How far from the origin places may be together with a hundred times as far as anybody gets in a step \[m\]: their rounding, and
/// eight times that of the ways, are 20 µm then.
pub(in crate::collide) const CLOSE: f32 = 200.0;

/// Cubics side by side, as `Path`.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Paths<F> {
    pub(in crate::collide) x0: Vectors<F>,
    pub(in crate::collide) v0: Vectors<F>,
    pub(in crate::collide) x1: Vectors<F>,
    pub(in crate::collide) v1: Vectors<F>,
    /// How long they take \[s\].
    pub(in crate::collide) time: F,
}

/// The same as polynomials.
pub(super) struct Cubics<F> {
    pub(super) start: Vectors<F>,
    pub(super) coefficients: [Vectors<F>; 3],
    /// Half the change of velocity as a way, and how much farther the cubic leads.
    pub(super) bend: Vectors<F>,
    pub(super) excess: Vectors<F>,
}

impl<F: Lanes> Paths<F> {
    /// The first of two where a mask says so, else the second.
    #[inline(always)]
    pub(super) fn select(mask: F, a: Self, b: Self) -> Self {
        Self {
            x0: Vectors::select(mask, a.x0, b.x0),
            v0: Vectors::select(mask, a.v0, b.v0),
            x1: Vectors::select(mask, a.x1, b.x1),
            v1: Vectors::select(mask, a.v1, b.v1),
            time: mask.select(a.time, b.time),
        }
    }

    #[inline(always)]
    pub(super) fn acceleration(&self) -> Vectors<F> {
        (self.v1 - self.v0) / self.time
    }

    /// Those of which all numbers are finite, and their sums.
    #[inline(always)]
    pub(in crate::collide) fn are_finite(&self) -> F {
        let zero = self.time.all(0.0);
        let nought = (self.x0 + self.v0 + self.x1 + self.v1) * zero;
        let [x, y, z] = nought.0;
        (x + y + z).simd_eq(zero)
    }

    /// The same of where they lead.
    #[inline(always)]
    pub(super) fn end_finite(&self) -> F {
        let zero = self.time.all(0.0);
        let [x, y, z] = ((self.x1 + self.v1) * zero).0;
        (x + y + z).simd_eq(zero)
    }

    /// Those that one chord is near enough to for sure, if the cubic leads to their end but for rounding, and all is within
    /// [`CLOSE`]: what rounding adds to the bend is less than as much again.
    #[inline(always)]
    pub(super) fn hardly_bend(&self) -> F {
        const HALF: f32 = 2.0 * CHORD_ERROR;
        let bend = (self.v1 - self.v0) * (self.time.all(0.5) * self.time);
        bend.dot(bend).simd_le(bend.0[0].all(HALF * HALF))
    }

    #[inline(always)]
    pub(super) fn cubics(&self) -> Cubics<F> {
        let all = |x| self.time.all(x);
        let half = all(0.5) * self.time;
        let excess = (self.x1 - self.x0) - (self.v0 + self.v1) * half;
        let noticed = |axis: usize| {
            let (excess, rounding) = (excess.0[axis], self.x0.0[axis].abs() + self.x1.0[axis].abs());
            excess & not(excess.abs().simd_le(rounding * all(f32::EPSILON)))
        };
        let excess = Vectors([noticed(0), noticed(1), noticed(2)]);
        let bend = (self.v1 - self.v0) * half;
        let coefficients = [self.v0 * self.time, bend + excess * all(3.0), excess * all(-2.0)];
        Cubics { start: self.x0, coefficients, bend, excess }
    }

    /// Their velocities at fractions of their times.
    #[inline(always)]
    pub(super) fn velocity(&self, cubics: &Cubics<F>, s: F) -> Vectors<F> {
        let steady = self.v0 + (self.v1 - self.v0) * s;
        let all = |x| s.all(x);
        let share = all(6.0) * s * (all(1.0) - s) / self.time;
        Vectors::select(cubics.are_smooth(), steady + cubics.excess * share, steady)
    }
}

impl<F: Lanes> Cubics<F> {
    #[inline(always)]
    pub(super) fn at(&self, s: F) -> Vectors<F> {
        let [c1, c2, c3] = self.coefficients;
        self.start + (c1 + (c2 + c3 * s) * s) * s
    }

    /// Those that bend as the motion does: their derivatives are the velocities.
    #[inline(always)]
    pub(super) fn are_smooth(&self) -> F {
        let Self { bend, excess, .. } = *self;
        let square = bend.dot(bend);
        not(excess.is_zero()) & excess.dot(excess).simd_lt(square.all(0.0625) * square)
    }

    /// Those whose ends lag behind their velocities.
    #[inline(always)]
    pub(super) fn lag(&self) -> F {
        let bend = self.bend.dot(self.bend);
        self.excess.dot(self.bend).simd_lt(bend.all(-0.5) * bend)
    }

    /// The number of chords that stay near each, without a bound.
    #[inline(always)]
    pub(super) fn chords(&self) -> F {
        const STRAIGHT: f32 = (4.0 * CHORD_ERROR) * (4.0 * CHORD_ERROR);
        let [_, c2, c3] = self.coefficients;
        let (like, one) = (c2.0[0], c2.0[0].all(1.0));
        let all = |x| like.all(x);
        let end = c2 + c3 * all(3.0);
        let (c2, end) = (c2.dot(c2), end.dot(end));
        let bent = not(max(c2, end).simd_le(all(STRAIGHT)));
        if !bent.any() {
            return one;
        }
        let ratio = all(2.0) * max(c2.sqrt(), end.sqrt()) / all(8.0 * CHORD_ERROR);
        // What is added leaves no room for fractions, and rounds to the nearest whole number. Larger ones are more than any bound.
        let (root, shift) = (ratio.sqrt(), all(8_388_608.0));
        let nearest = (root + shift) - shift;
        let whole = nearest.simd_gt(root).select(nearest - one, nearest);
        (bent & ratio.simd_gt(one)).select(whole + one, one)
    }
}
