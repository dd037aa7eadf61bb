//! Numbers or vectors side by side, eight or twice as many, in whatever registers the machine turns out to have.
//!
//! They go through the same operations in the same order, each correctly rounded, and so the same bits. A kernel is compiled
//! for each kind of registers; functions that it calls have to be spread over it for that.

use super::LANES;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};
use wide::f32x4;

/// Numbers side by side: eight, or twice as many. A mask has all bits of a lane set, or none.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
{
    /// The eights that they consist of, and the number of these.
    type Part: Eight;
    const PARTS: usize;
    /// Columns whose eights are made one after the other.
    fn of_parts<const N: usize>(self, part: impl FnMut(Self::Part, usize) -> [Self::Part; N]) -> [Self; N];
    /// One of the eights.
    fn part(self, nth: usize) -> Self::Part;
    /// One number in all of them.
    fn all(self, x: f32) -> Self;
    fn abs(self) -> Self;
    /// Correctly rounded.
    fn sqrt(self) -> Self;
    fn simd_eq(self, other: Self) -> Self;
    fn simd_lt(self, other: Self) -> Self;
    fn simd_le(self, other: Self) -> Self;
    fn simd_gt(self, other: Self) -> Self;
    fn simd_ge(self, other: Self) -> Self;
    /// The first of two where this mask says so, else the second.
    fn select(self, a: Self, b: Self) -> Self;
    /// The smaller of two, and the larger; either, or none, where one is no number.
    fn least(self, other: Self) -> Self;
    fn most(self, other: Self) -> Self;
    /// The larger of two numbers, and the smaller: the second where they are equal, or either is no number.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        self.simd_gt(other).select(self, other)
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        self.simd_lt(other).select(self, other)
    }
    /// The largest of numbers none of which is below zero; anything, where one is no number.
    #[inline(always)]
    fn largest_lane(self) -> f32 {
        let mut largest = self.part(0);
        for nth in 1..Self::PARTS {
            largest = largest.most(self.part(nth));
        }
        let [a, b, c, d, e, f, g, h] = largest.to_array();
        let most = crate::math::max;
        most(most(most(a, e), most(b, f)), most(most(c, g), most(d, h)))
    }
    /// A bit for each lane of this mask.
    fn to_bitmask(self) -> u32;

    /// Tells whether this mask holds for any.
    #[inline(always)]
    fn any(self) -> bool {
        self.to_bitmask() != 0
    }
}

/// Eight numbers side by side.
pub(crate) trait Eight: Lanes<Part = Self> {
    /// These, in registers as those that `self` is in.
    fn of(self, lanes: [f32; LANES]) -> Self;
    fn to_array(self) -> [f32; LANES];
    /// Each three times, one after the other.
    #[inline(always)]
    fn thrice(self) -> [Self; 3] {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        [self.of([a, a, a, b, b, b, c, c]), self.of([c, d, d, d, e, e, e, f]), self.of([f, f, g, g, g, h, h, h])]
    }
    /// Eight vectors coordinate by coordinate; the last number of each does not count.
    #[inline(always)]
    fn columns_of(self, vectors: [[f32; 4]; LANES]) -> [Self; 3] {
        let [x, y, z, _] = self.quads_of(vectors);
        [x, y, z]
    }
    /// Eight rows of four numbers as columns.
    #[inline(always)]
    fn quads_of(self, rows: [[f32; 4]; LANES]) -> [Self; 4] {
        let four = |i: usize| f32x4::new(rows[i]);
        let [a, b, c, d] = f32x4::transpose([four(0), four(1), four(2), four(3)]);
        let [e, f, g, h] = f32x4::transpose([four(4), four(5), four(6), four(7)]);
        let both = |low: f32x4, high: f32x4| self.of(bytemuck::cast([low, high]));
        [both(a, e), both(b, f), both(c, g), both(d, h)]
    }
    /// The same turned round: one vector after the other, each with some number behind it.
    #[inline(always)]
    fn vectors_of([x, y, z]: [Self; 3]) -> [[f32; 4]; LANES] {
        let halves = |lanes: Self| bytemuck::cast::<[f32; LANES], [f32x4; 2]>(lanes.to_array());
        let ([a, e], [b, f], [c, g]) = (halves(x), halves(y), halves(z));
        bytemuck::cast([f32x4::transpose([a, b, c, c]), f32x4::transpose([e, f, g, g])])
    }
    /// Four columns turned round: eight rows of four numbers.
    #[inline(always)]
    fn rows_of([x, y, z, w]: [Self; 4]) -> [[f32; 4]; LANES] {
        let halves = |lanes: Self| bytemuck::cast::<[f32; LANES], [f32x4; 2]>(lanes.to_array());
        let ([a, e], [b, f], [c, g], [d, h]) = (halves(x), halves(y), halves(z), halves(w));
        bytemuck::cast([f32x4::transpose([a, b, c, d]), f32x4::transpose([e, f, g, h])])
    }
    /// Four columns in which lanes whose bits are set come first, in their order, and how many these are; behind them is anything.
    #[inline(always)]
    fn squeezed(columns: [Self; 4], hits: u32) -> ([Self; 4], usize) {
        let ([x, ..], mut rows, mut len) = (columns, [[0.0; 4]; LANES], 0);
        for (lane, row) in Self::rows_of(columns).into_iter().enumerate() {
            // Written whether it is a hit or not, and then written over, so that there is no branch to guess.
            rows[len % LANES] = row;
            len += (hits >> lane & 1) as usize;
        }
        (x.quads_of(rows), len)
    }
}

/// Arithmetic that registers of any kind can do.
pub(crate) trait Kernel {
    type Output;
    /// Does it in such registers as `like` is in.
    fn run<F: Eight>(self, like: F) -> Self::Output;
}

/// The same that twice as many numbers can go through at once where registers hold them.
pub(crate) trait BroadKernel {
    type Output;
    fn run<F: Lanes>(self, like: F) -> Self::Output;
}

/// The larger of two numbers, as [`crate::math::max`] has it.
#[inline(always)]
pub(crate) fn max<F: Lanes>(a: F, b: F) -> F {
    a.greater(b)
}

/// The smaller of two numbers, as [`crate::math::min`] has it.
#[inline(always)]
pub(crate) fn min<F: Lanes>(a: F, b: F) -> F {
    a.lesser(b)
}

/// Numbers with their signs turned round, those of zeros as well.
#[inline(always)]
pub(crate) fn negated<F: Lanes>(x: F) -> F {
    x ^ x.all(-0.0)
}

/// Lanes for which a mask does not hold.
#[inline(always)]
pub(crate) fn not<F: Lanes>(mask: F) -> F {
    mask ^ mask.all(f32::from_bits(u32::MAX))
}

/// As many as the target has for sure: two registers, or four numbers and four, or eight.
impl Lanes for wide::f32x8 {
    type Part = Self;
    const PARTS: usize = 1;
    #[inline(always)]
    fn of_parts<const N: usize>(self, mut part: impl FnMut(Self, usize) -> [Self; N]) -> [Self; N] {
        part(self, 0)
    }
    #[inline(always)]
    fn part(self, _: usize) -> Self {
        self
    }
    #[inline(always)]
    fn all(self, x: f32) -> Self {
        Self::splat(x)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        super::sqrt(self)
    }
    #[inline(always)]
    fn simd_eq(self, other: Self) -> Self {
        Self::simd_eq(self, other)
    }
    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self {
        Self::simd_lt(self, other)
    }
    #[inline(always)]
    fn simd_le(self, other: Self) -> Self {
        Self::simd_le(self, other)
    }
    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self {
        Self::simd_gt(self, other)
    }
    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self {
        Self::simd_ge(self, other)
    }
    #[inline(always)]
    fn select(self, a: Self, b: Self) -> Self {
        ((a ^ b) & self) ^ b
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.fast_min(other)
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.fast_max(other)
    }
    #[inline(always)]
    fn to_bitmask(self) -> u32 {
        Self::to_bitmask(self)
    }
}

impl Eight for wide::f32x8 {
    #[inline(always)]
    fn of(self, lanes: [f32; LANES]) -> Self {
        Self::new(lanes)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        Self::to_array(self)
    }
    #[cfg(target_feature = "simd128")]
    #[inline(always)]
    fn thrice(self) -> [Self; 3] {
        super::thrice::thrice(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{One, PARTS, run, run_broad};

    /// Everything that can be done with two times eight numbers.
    #[derive(Clone, Copy)]
    struct Everything([[f32; LANES]; 2]);

    impl Kernel for Everything {
        type Output = ([[f32; LANES]; 31], u32);
        #[inline(always)]
        fn run<F: Eight>(self, like: F) -> Self::Output {
            let [a, b] = self.0.map(|lanes| like.of(lanes));
            let ([c, d, e], mask) = (a.thrice(), a.simd_lt(b));
            let rows = F::vectors_of([a, b, c]);
            let [x, y, z] = like.columns_of(rows.map(|[x, y, z, _]| [z, x, y, 0.0]));
            let row = |axis: usize| like.of(rows.map(|row| row[axis]));
            let [.., w] = like.quads_of(rows.map(|[x, y, z, _]| [x, y, x, z]));
            let [p, q, r, s] = like.quads_of(F::rows_of([a, b, c, d]));
            let made = [
                a + b,
                a - b,
                a * b,
                a / b,
                a & b,
                a | b,
                a ^ b,
                a.abs(),
                a.sqrt(),
                negated(a),
                not(mask).select(a, b),
                max(a, b),
                min(a, b),
                like.all(1.0) & (a.simd_eq(b) | a.simd_le(b)),
                like.all(1.0) & (a.simd_gt(b) ^ a.simd_ge(b)),
                c,
                d,
                e,
                mask.select(a, b) - like.all(0.5),
                like,
                x,
                y,
                z,
                row(0),
                row(1),
                row(2),
                w,
                p,
                q,
                r,
                s,
            ];
            (made.map(Eight::to_array), mask.to_bitmask())
        }
    }

    #[test]
    fn all_registers_give_the_same_bits() {
        let numbers = [0.0, -0.0, 1.5, -2.25, 1e-40, f32::MAX, f32::INFINITY, f32::NAN, -1e30, 0.1, 3.0];
        for i in 0..121 {
            let lanes = [0, 1].map(|k| core::array::from_fn(|lane| numbers[(i / [1, 11][k] + lane) % 11]));
            let (one, other) = (run(Everything(lanes)), Everything(lanes).run(wide::f32x8::ZERO));
            let same = |one: [f32; LANES], other: [f32; LANES]| one.map(f32::to_bits) == other.map(f32::to_bits);
            assert!(same(one.0[21], one.0[23]) && same(one.0[22], one.0[24]) && same(one.0[20], one.0[25]));
            let alone = Everything(lanes).run(One(0.0));
            // What one lane does.
            for nth in (0..15).chain([18]) {
                let (a, b) = (one.0[nth][0], alone.0[nth][0]);
                assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(), "{nth} of {lanes:?}: {a} {b}");
            }
            assert!(same(one.0[26], one.0[25]) && same(one.0[23], lanes[0]) && same(one.0[24], lanes[1]));
            assert!(same(one.0[27], lanes[0]) && same(one.0[28], lanes[1]));
            assert!(same(one.0[29], one.0[15]) && same(one.0[30], one.0[16]));
            assert_eq!(one.1, other.1);
            for (nth, (a, b)) in one.0.iter().flatten().zip(other.0.iter().flatten()).enumerate() {
                assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(), "{nth} of {lanes:?}: {a} {b}");
            }
        }
    }

    /// What can be done with any number of numbers, with two times sixteen.
    #[derive(Clone, Copy, Debug)]
    struct Twice([[[f32; LANES]; 2]; PARTS]);

    impl BroadKernel for Twice {
        type Output = [([[f32; LANES]; 19], u32, f32); PARTS];
        #[inline(always)]
        fn run<F: Lanes>(self, like: F) -> Self::Output {
            let mut done = [([[0.0; LANES]; 19], 0, 0.0); PARTS];
            for first in (0..PARTS).step_by(F::PARTS) {
                let [a, b] = like.of_parts(|like, nth| self.0[first + nth].map(|lanes| like.of(lanes)));
                let mask = a.simd_lt(b);
                let made = [
                    a + b,
                    a - b,
                    a * b,
                    a / b,
                    a & b,
                    a | b,
                    a ^ b,
                    a.abs(),
                    a.sqrt(),
                    not(mask).select(a, b),
                    max(a, b),
                    min(a, b),
                    like.all(1.0) & (a.simd_eq(b) | a.simd_le(b)),
                    like.all(1.0) & (a.simd_gt(b) ^ a.simd_ge(b)),
                    mask & a.least(b),
                    mask & a.most(b),
                    crate::lanes::mask_of(like, mask.to_bitmask()) ^ mask,
                    negated(b),
                    like,
                ];
                let largest = (like.all(2.0) & mask).largest_lane();
                for (nth, (parts, bits, most)) in done[first..][..F::PARTS].iter_mut().enumerate() {
                    *parts = made.map(|lanes| lanes.part(nth).to_array());
                    (*bits, *most) = (mask.to_bitmask() >> (LANES * nth) & 255, largest);
                }
            }
            done
        }
    }

    #[test]
    fn twice_as_many_at_once_give_the_same_bits() {
        let numbers = [0.0, -0.0, 1.5, -2.25, 1e-40, f32::MAX, f32::INFINITY, f32::NAN, -1e30, 0.1, 3.0];
        for i in 0..121 {
            let lanes =
                |part: usize, k: usize| core::array::from_fn(|lane| numbers[(i / [1, 11][k] + lane + 3 * part) % 11]);
            let twice = Twice(core::array::from_fn(|part| [lanes(part, 0), lanes(part, 1)]));
            let (at_once, apart) = (run_broad(twice), BroadKernel::run(twice, wide::f32x8::ZERO));
            let largest = apart.iter().fold(0.0, |most, part| crate::math::max(most, part.2));
            for (one, other) in at_once.iter().zip(&apart) {
                assert!(one.2 == other.2 || one.2 == largest);
                assert_eq!(one.1, other.1);
                for (nth, (a, b)) in one.0.iter().flatten().zip(other.0.iter().flatten()).enumerate() {
                    assert!(a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(), "{nth} of {twice:?}: {a} {b}");
                }
            }
        }
    }

    struct Squeeze([[f32; LANES]; 4], u32);

    impl Kernel for Squeeze {
        type Output = ([[f32; LANES]; 4], usize);
        #[inline(always)]
        fn run<F: Eight>(self, like: F) -> Self::Output {
            let (columns, len) = F::squeezed(self.0.map(|lanes| like.of(lanes)), self.1);
            (columns.map(Eight::to_array), len)
        }
    }

    #[test]
    fn hits_come_first_and_in_their_order_in_all_registers() {
        let columns = [0, 8, 16, 24].map(|first| core::array::from_fn(|lane| f32::from_bits(first + lane as u32)));
        for hits in 0..256 {
            let lanes = (0..LANES).filter(|lane| hits >> lane & 1 == 1);
            for (found, len) in [run(Squeeze(columns, hits)), Squeeze(columns, hits).run(wide::f32x8::ZERO)] {
                assert_eq!(len, lanes.clone().count());
                for (column, found) in columns.iter().zip(found) {
                    assert!(
                        found[..len]
                            .iter()
                            .copied()
                            .map(f32::to_bits)
                            .eq(lanes.clone().map(|lane| column[lane].to_bits()))
                    );
                }
            }
        }
    }
}
