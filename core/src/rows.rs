//! Loops over whole columns, written so that compilers make vectors of them.
//!
//! A column of `Vec3` is a flat list of numbers with period three. Where every number is treated alike the flat list
//! does; where each row has a factor of its own, four rows and their four factors make blocks of twelve.

use crate::lanes::{Eight, Kernel, not, widest};
use crate::math::max;
use glam::Vec3;

/// True if there may be vectors: chips without an operating system are spared the code, and work number by number.
pub(crate) const BLOCKS: bool = !cfg!(target_os = "none");

/// `out` = `base` + `h` × `rate`, row by row.
#[inline]
pub(crate) fn advance_by(out: &mut [Vec3], base: &[Vec3], h: f32, rate: &[Vec3]) {
    let (out, base, rate) = (flat_mut(out), flat(base), flat(rate));
    widest(
        #[inline(always)]
        || {
            for ((out, &base), &rate) in out.iter_mut().zip(base).zip(rate) {
                *out = base + rate * h;
            }
        },
    );
}

/// `sum` += `h` × `rate`, row by row.
#[inline]
pub(crate) fn add_scaled(sum: &mut [Vec3], h: f32, rate: &[Vec3]) {
    let (sum, rate) = (flat_mut(sum), flat(rate));
    widest(
        #[inline(always)]
        || {
            for (sum, &rate) in sum.iter_mut().zip(rate) {
                *sum += rate * h;
            }
        },
    );
}

/// `total` = `f`(`total`, `vector`, `factor`), number by number, `factor` being that of the row.
#[inline(always)]
pub(crate) fn each_row(total: &mut [Vec3], vector: &[Vec3], factor: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
    if !BLOCKS {
        return total.iter_mut().zip(vector).zip(factor).for_each(|((total, v), &k)| one(total, *v, k, &f));
    }
    let ((t, t_rest), (v, v_rest), (k, k_rest)) = (total.as_chunks_mut(), vector.as_chunks(), factor.as_chunks());
    for ((total, vector), factor) in t.iter_mut().zip(v).zip(k) {
        block(total, vector, factor, &f);
    }
    for ((total, vector), &factor) in t_rest.iter_mut().zip(v_rest).zip(k_rest) {
        one(total, *vector, factor, &f);
    }
}

/// The same with one vector for all rows.
#[inline(always)]
pub(crate) fn each_row_with(total: &mut [Vec3], vector: Vec3, factor: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
    if !BLOCKS {
        return total.iter_mut().zip(factor).for_each(|(total, &k)| one(total, vector, k, &f));
    }
    let ((t, t_rest), (k, k_rest)) = (total.as_chunks_mut(), factor.as_chunks());
    for (total, factor) in t.iter_mut().zip(k) {
        block(total, &[vector; 4], factor, &f);
    }
    for (total, &factor) in t_rest.iter_mut().zip(k_rest) {
        one(total, vector, factor, &f);
    }
}

/// What makes rows fall, each braked by its own drag.
#[derive(Clone, Copy)]
pub(crate) struct Fall<'a, const FALLS: bool, const DRAGS: bool> {
    pub(crate) g: Vec3,
    pub(crate) mass: &'a [f32],
    pub(crate) drag: &'a [f32],
    pub(crate) inverse_mass: &'a [f32],
}

/// Finds their accelerations.
pub(crate) struct Accelerate<'a, const FALLS: bool, const DRAGS: bool> {
    pub(crate) fall: Fall<'a, FALLS, DRAGS>,
    pub(crate) velocity: &'a [Vec3],
    pub(crate) acceleration: &'a mut [Vec3],
}

/// Moves their places and velocities by a step of `h` \[s\] of an Euler method: the symplectic one goes by the new velocity.
pub(crate) struct Leap<'a, const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> {
    pub(crate) fall: Fall<'a, FALLS, DRAGS>,
    pub(crate) ends: [&'a mut [Vec3]; 2],
    pub(crate) h: f32,
}

impl<const FALLS: bool, const DRAGS: bool> Kernel for Accelerate<'_, FALLS, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { fall, velocity, acceleration } = self;
        let (g, (factors, factors_rest)) = (fall.numbers(like), fall.eights());
        let ((out, out_rest), (v, v_rest)) = (acceleration.as_chunks_mut(), velocity.as_chunks());
        for ((out, v), factors) in out.iter_mut().zip(v).zip(factors) {
            *out = stored(Fall::<FALLS, DRAGS>::of(g, loaded(like, v), factors));
        }
        if !out_rest.is_empty() {
            let last: [Vec3; 8] =
                stored(Fall::<FALLS, DRAGS>::of(g, loaded(like, &filled(v_rest)), factors_rest.each_ref()));
            out_rest.copy_from_slice(&last[..out_rest.len()]);
        }
    }
}

impl<const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> Kernel for Leap<'_, FALLS, DRAGS, SYMPLECTIC> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { fall, ends: [position, velocity], h } = self;
        let (g, (factors, factors_rest), h) = (fall.numbers(like), fall.eights(), like.all(h));
        let ((x, x_rest), (v, v_rest)) = (position.as_chunks_mut(), velocity.as_chunks_mut());
        for ((x, v), factors) in x.iter_mut().zip(v).zip(factors) {
            Self::eight(g, [x, v], factors, h);
        }
        if !x_rest.is_empty() {
            let [mut x, mut v] = [filled(x_rest), filled(v_rest)];
            Self::eight(g, [&mut x, &mut v], factors_rest.each_ref(), h);
            x_rest.copy_from_slice(&x[..x_rest.len()]);
            v_rest.copy_from_slice(&v[..v_rest.len()]);
        }
    }
}

impl<const FALLS: bool, const DRAGS: bool, const SYMPLECTIC: bool> Leap<'_, FALLS, DRAGS, SYMPLECTIC> {
    #[inline(always)]
    fn eight<F: Eight>(g: [F; 3], [x, v]: [&mut [Vec3; 8]; 2], factors: [&[f32; 8]; 3], h: F) {
        let [from, before] = [loaded(h, x), loaded(h, v)];
        let rate = Fall::<FALLS, DRAGS>::of(g, before, factors);
        let (mut to, mut after) = (from, before);
        for i in 0..3 {
            after[i] = before[i] + rate[i] * h;
            to[i] = from[i] + if SYMPLECTIC { after[i] } else { before[i] } * h;
        }
        [*x, *v] = [stored(to), stored(after)];
    }
}

/// Eight factors of each kind.
type Factors<'a> = [&'a [f32; 8]; 3];

impl<'a, const FALLS: bool, const DRAGS: bool> Fall<'a, FALLS, DRAGS> {
    /// The steady acceleration, number by number, as those of rows follow one another.
    #[inline(always)]
    fn numbers<F: Eight>(&self, like: F) -> [F; 3] {
        loaded(like, &[self.g; 8])
    }

    /// The factors of eight rows after the other, and of what rows are left.
    #[inline(always)]
    fn eights(&self) -> (impl Iterator<Item = Factors<'a>> + use<'a, FALLS, DRAGS>, [[f32; 8]; 3]) {
        let [(m, m_rest), (k, k_rest), (inverse, inverse_rest)] =
            [self.mass.as_chunks(), self.drag.as_chunks(), self.inverse_mass.as_chunks()];
        let eights = m.iter().zip(k).zip(inverse).map(
            #[inline(always)]
            |((m, k), inverse)| [m, k, inverse],
        );
        (eights, [filled(m_rest), filled(k_rest), filled(inverse_rest)])
    }

    /// The sum of forces over the mass, for eight rows: number by number, as they follow one another. What is fixed stays so under a
    /// force beyond an f32.
    #[inline(always)]
    fn of<F: Eight>(g: [F; 3], v: [F; 3], factors: Factors<'_>) -> [F; 3] {
        let (like, zero) = (g[0], g[0].all(0.0));
        let [m, k, inverse] =
            [like.of(*factors[0]).thrice(), like.of(*factors[1]).thrice(), like.of(*factors[2]).thrice()];
        let mut rate = v;
        for i in 0..3 {
            let mut force = zero;
            if FALLS {
                force = force + g[i] * m[i];
            }
            if DRAGS {
                force = force - v[i] * k[i];
            }
            rate[i] = (force * inverse[i]) & not(inverse[i].simd_eq(zero));
        }
        rate
    }
}

/// Eight vectors, number by number, in registers.
#[inline(always)]
fn loaded<F: Eight>(like: F, vectors: &[Vec3; 8]) -> [F; 3] {
    let [a, b, c]: [[f32; 8]; 3] = bytemuck::cast(*vectors);
    [like.of(a), like.of(b), like.of(c)]
}

/// The same back.
#[inline(always)]
fn stored<F: Eight>([a, b, c]: [F; 3]) -> [Vec3; 8] {
    bytemuck::cast([a.to_array(), b.to_array(), c.to_array()])
}

/// So many of which the last ones are nothing.
pub(crate) fn filled<T: Copy + Default, const N: usize>(rest: &[T]) -> [T; N] {
    core::array::from_fn(|i| rest.get(i).copied().unwrap_or_default())
}

#[inline(always)]
fn block(total: &mut [Vec3; 4], vector: &[Vec3; 4], k: &[f32; 4], f: &impl Fn(f32, f32, f32) -> f32) {
    let factor = [k[0], k[0], k[0], k[1], k[1], k[1], k[2], k[2], k[2], k[3], k[3], k[3]];
    let (total, vector): (&mut [f32; 12], &[f32; 12]) = (bytemuck::cast_mut(total), bytemuck::cast_ref(vector));
    for i in 0..12 {
        total[i] = f(total[i], vector[i], factor[i]);
    }
}

#[inline(always)]
fn one(total: &mut Vec3, vector: Vec3, factor: f32, f: &impl Fn(f32, f32, f32) -> f32) {
    *total = Vec3::new(f(total.x, vector.x, factor), f(total.y, vector.y, factor), f(total.z, vector.z, factor));
}

/// The largest number of a column, whatever its sign; what is no number does not count.
#[inline]
pub(crate) fn farthest(column: &[Vec3]) -> f32 {
    largest_of(flat(column))
}

/// The same of numbers.
#[inline]
pub(crate) fn largest_of(numbers: &[f32]) -> f32 {
    let farther = |most, x: &f32| max(x.abs(), most);
    if !BLOCKS {
        return numbers.iter().fold(0.0, farther);
    }
    let (blocks, rest) = numbers.as_chunks::<16>();
    let most = widest(
        #[inline(always)]
        || {
            let mut most = [0.0; 16];
            for block in blocks {
                for (most, x) in most.iter_mut().zip(block) {
                    *most = max(x.abs(), *most);
                }
            }
            core::array::from_fn::<f32, 8, _>(|i| max(most[i], most[i + 8]))
        },
    );
    rest.iter().fold(most.into_iter().fold(0.0, max), farther)
}

/// The same, and whether all numbers of it and of another column are finite for sure: in one pass, as what is not makes a sum that
/// is not. A sum may be so without, and where there are no vectors nothing is sure.
#[inline]
pub(crate) fn farthest_of_finite(column: &[Vec3], other: &[Vec3]) -> (f32, bool) {
    if !BLOCKS {
        return (farthest(column), false);
    }
    let ((x, x_rest), (v, v_rest)) = (flat(column).as_chunks::<16>(), flat(other).as_chunks::<16>());
    let (most, sum) = widest(
        #[inline(always)]
        || {
            let (mut most, mut sum) = ([0.0; 16], [0.0; 16]);
            for (x, v) in x.iter().zip(v) {
                for i in 0..16 {
                    most[i] = max(x[i].abs(), most[i]);
                    sum[i] += x[i] + v[i];
                }
            }
            (most, sum)
        },
    );
    let farthest = x_rest.iter().fold(most.into_iter().fold(0.0, max), |most, x| max(x.abs(), most));
    (farthest, sum.iter().chain(x_rest).chain(v_rest).fold(0.0, |nought, x| nought + x * 0.0) == 0.0)
}

/// Tells whether every number is finite. The exponent of those that are not is all ones, so that one more carries into
/// the sign.
#[cfg_attr(target_os = "none", inline(never))]
#[cfg_attr(not(target_os = "none"), inline)]
pub(crate) fn are_finite(column: &[Vec3]) -> bool {
    let carried = |any: u32, x: &f32| any | ((x.to_bits() & 0x7FFF_FFFF) + 0x0080_0000);
    flat(column).iter().fold(0, carried) >> 31 == 0
}

#[inline(always)]
pub(crate) fn flat(column: &[Vec3]) -> &[f32] {
    bytemuck::cast_slice(column)
}

#[inline(always)]
fn flat_mut(column: &mut [Vec3]) -> &mut [f32] {
    bytemuck::cast_slice_mut(column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_that_is_not_finite_is_seen_wherever_it_is() {
        for n in 0..40 {
            let mut column = std::vec![Vec3::new(f32::MAX, -f32::MAX, -0.0); n];
            let good_ones = std::vec![Vec3::new(-1.5, 0.0, 1e30); n];
            assert_eq!(farthest_of_finite(&good_ones, &good_ones), (if n > 0 { 1e30 } else { 0.0 }, true));
            assert!(are_finite(&column));
            assert_eq!(farthest(&column), if n > 0 { f32::MAX } else { 0.0 });
            for (i, bad) in (0..3 * n).zip([f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().cycle())
            {
                let good = core::mem::replace(&mut column[i / 3][i % 3], bad);
                assert!(!are_finite(&column), "{bad} at {i} of {n}");
                for (one, other) in [(&column, &good_ones), (&good_ones, &column)] {
                    assert_eq!(farthest_of_finite(one, other), (farthest(one), false), "{bad} at {i} of {n}");
                }
                assert_eq!(farthest(&column) == f32::INFINITY, bad.is_infinite());
                column[i / 3][i % 3] = good;
            }
        }
    }

    #[test]
    fn blocks_and_rest_are_treated_alike() {
        for n in 0..11 {
            let vector: std::vec::Vec<Vec3> = (0..n).map(|i| Vec3::new(i as f32, 0.5, -(i as f32))).collect();
            let factor: std::vec::Vec<f32> = (0..n).map(|i| 1.0 + i as f32).collect();
            let mut total = std::vec![Vec3::ONE; n];
            each_row(&mut total, &vector, &factor, |t, v, k| t + v * k);
            for i in 0..n {
                assert_eq!(total[i], Vec3::ONE + vector[i] * factor[i]);
            }
        }
    }
}
