//! Loops over whole columns, written so that compilers make vectors of them.
//!
//! A column of `Vec3` is a flat list of numbers with period three. Where every number is treated alike the flat list
//! does; where each row has a factor of its own, four rows and their four factors make blocks of twelve.

mod fall;

pub(crate) use fall::{Accelerate, Extents, Fall, Leap};

use crate::lanes::widest;
use crate::math::{along, max, scaled};
use glam::Vec3;

/// True if there may be vectors: chips without an operating system, which are spared the code, and programs without optimisation work number by
/// number.
pub(crate) const BLOCKS: bool = !cfg!(one_by_one);

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
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline)]
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
fn each_row(total: &mut [Vec3], vector: &[Vec3], factor: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
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
fn each_row_with(total: &mut [Vec3], vector: Vec3, factor: &[f32], f: impl Fn(f32, f32, f32) -> f32) {
    let ((t, t_rest), (k, k_rest)) = (total.as_chunks_mut(), factor.as_chunks());
    for (total, factor) in t.iter_mut().zip(k) {
        block(total, &[vector; 4], factor, &f);
    }
    for (total, &factor) in t_rest.iter_mut().zip(k_rest) {
        one(total, vector, factor, &f);
    }
}

/// `total` += `vector` × `by`(`factor`), row by row.
#[inline(always)]
pub(crate) fn add_each(total: &mut [Vec3], vector: &[Vec3], factor: &[f32], by: impl Fn(f32) -> f32) {
    if BLOCKS {
        return each_row(total, vector, factor, |total, v, k| total + v * by(k));
    }
    for ((total, &v), &k) in total.iter_mut().zip(vector).zip(factor) {
        *total = along(*total, v, by(k));
    }
}

/// `total` += `vector` × `factor`, row by row.
#[inline(always)]
pub(crate) fn add_one(total: &mut [Vec3], vector: Vec3, factor: &[f32]) {
    if BLOCKS {
        return each_row_with(total, vector, factor, |total, v, k| total + v * k);
    }
    for (total, &k) in total.iter_mut().zip(factor) {
        *total = along(*total, vector, k);
    }
}

/// `column` × `factor`, row by row; zero where that is zero, whatever is there.
#[inline(always)]
pub(crate) fn scale_each(column: &mut [Vec3], factor: &[f32]) {
    if BLOCKS {
        return each_row_with(column, Vec3::ZERO, factor, |x, _, k| if k == 0.0 { 0.0 } else { x * k });
    }
    for (x, &k) in column.iter_mut().zip(factor) {
        *x = if k == 0.0 { Vec3::ZERO } else { scaled(*x, k) };
    }
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
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline)]
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
            assert_eq!(farthest_of_finite(&good_ones, &good_ones), (if n > 0 { 1e30 } else { 0.0 }, BLOCKS));
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
