//! Vectors side by side, as many as numbers are.

use super::{Eight, LANES, Lanes, max, negated};
use glam::Vec3;

/// Vectors side by side. Sums and products are taken in glam's order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vectors<F>(pub(crate) [F; 3]);

impl<F: Lanes> Vectors<F> {
    /// One of the eights.
    #[inline(always)]
    pub(crate) fn part(self, nth: usize) -> Vectors<F::Part> {
        let [x, y, z] = self.0;
        Vectors([x.part(nth), y.part(nth), z.part(nth)])
    }

    /// One in every lane, as many as there are of others.
    #[inline(always)]
    pub(crate) fn splat(like: F, v: Vec3) -> Self {
        Self([like.all(v.x), like.all(v.y), like.all(v.z)])
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> F {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        (x * a) + (y * b) + (z * c)
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([y * c - b * z, z * a - c * x, x * b - a * y])
    }

    #[inline(always)]
    pub(crate) fn length(self) -> F {
        self.dot(self).sqrt()
    }

    /// The magnitude of the largest coordinate.
    #[inline(always)]
    pub(crate) fn largest(self) -> F {
        let [x, y, z] = self.0;
        max(max(x.abs(), y.abs()), z.abs())
    }

    /// As [`crate::math::unit`].
    #[inline(always)]
    pub(crate) fn unit(self) -> Self {
        let largest = self.largest();
        let has_one = largest.simd_gt(largest.all(0.0)) & largest.simd_lt(largest.all(f32::INFINITY));
        let scaled = self / largest;
        (scaled / scaled.length()).masked(has_one)
    }

    /// The first of two where a mask says so, else the second.
    #[inline(always)]
    pub(crate) fn select(mask: F, a: Self, b: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (a.0, b.0);
        Self([mask.select(ax, bx), mask.select(ay, by), mask.select(az, bz)])
    }

    /// Those that are zero.
    #[inline(always)]
    pub(crate) fn is_zero(self) -> F {
        let ([x, y, z], zero) = (self.0, self.0[0].all(0.0));
        x.simd_eq(zero) & y.simd_eq(zero) & z.simd_eq(zero)
    }

    /// Zero where a mask does not hold.
    #[inline(always)]
    pub(crate) fn masked(self, mask: F) -> Self {
        let [x, y, z] = self.0;
        Self([x & mask, y & mask, z & mask])
    }
}

impl<F: Eight> Vectors<F> {
    /// Those of eight rows before the `last`, which are read with what the rows behind them begin with.
    #[inline(always)]
    pub(crate) fn gather(like: F, column: &[Vec3], last: usize, rows: &[usize; LANES]) -> Self {
        let (column, next) = (&column[..last], &column[1..][..last]);
        let mut vectors = [[0.0; 4]; LANES];
        for (vector, &row) in vectors.iter_mut().zip(rows) {
            *vector = [column[row].x, column[row].y, column[row].z, next[row].x];
        }
        Self(like.columns_of(vectors))
    }

    /// One after the other, each with some number behind it.
    #[inline(always)]
    pub(crate) fn rows(self) -> [[f32; 4]; LANES] {
        F::vectors_of(self.0)
    }
}

/// The vectors of corners; none, if one is missing or the last.
#[inline(always)]
pub(crate) fn gathered<F: Eight, const N: usize>(
    like: F,
    column: &[Vec3],
    corners: &[[u32; N]; LANES],
) -> Option<[Vectors<F>; N]> {
    let last = column.len().checked_sub(1)?;
    let mut most = 0;
    for of in corners {
        for &corner in of {
            most = most.max(corner);
        }
    }
    if most as usize >= last {
        return None;
    }
    let mut all = [Vectors([like.all(0.0); 3]); N];
    for (i, vectors) in all.iter_mut().enumerate() {
        let mut rows = [0; LANES];
        for (row, of) in rows.iter_mut().zip(corners) {
            *row = of[i] as usize;
        }
        *vectors = Vectors::gather(like, column, last, &rows);
    }
    Some(all)
}

impl<F: Lanes> core::ops::Add for Vectors<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x + a, y + b, z + c])
    }
}

impl<F: Lanes> core::ops::Sub for Vectors<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        Self([x - a, y - b, z - c])
    }
}

impl<F: Lanes> core::ops::Mul<F> for Vectors<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        let [x, y, z] = self.0;
        Self([x * factor, y * factor, z * factor])
    }
}

impl<F: Lanes> core::ops::Div<F> for Vectors<F> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: F) -> Self {
        let [x, y, z] = self.0;
        Self([x / divisor, y / divisor, z / divisor])
    }
}

impl<F: Lanes> core::ops::Neg for Vectors<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [x, y, z] = self.0;
        Self([negated(x), negated(y), negated(z)])
    }
}
