//! Eight numbers side by side, and the inverse square law on them.
//!
//! The number of lanes and the order in which they are added are part of every sum's definition: they decide how it
//! rounds, and so they are the same on every target, whatever its registers hold.

use glam::Vec3;
use wide::f32x8;

/// How many there are.
pub(crate) const LANES: usize = 8;

/// Where a lane that stands for nothing is put, without weight: so far that whatever is divided by its distance is zero,
/// and so near that its square is a number.
pub(crate) const NOWHERE: f32 = 1e19;

/// Square roots, correctly rounded on every target.
#[inline(always)]
pub(crate) fn sqrt(x: f32x8) -> f32x8 {
    if cfg!(any(target_feature = "sse2", target_feature = "simd128")) {
        x.sqrt()
    } else {
        f32x8::new(x.to_array().map(crate::math::sqrt))
    }
}

/// The sum of all lanes, as a tree.
#[inline(always)]
pub(crate) fn total(lanes: f32x8) -> f32 {
    let s = lanes.to_array();
    ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))
}

/// Σ a · b over two columns.
pub(crate) fn dot(a: &[Vec3], b: &[Vec3]) -> f32 {
    let (a, b): (&[f32], &[f32]) = (bytemuck::cast_slice(a), bytemuck::cast_slice(b));
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let sum = a.iter().zip(b).fold(f32x8::ZERO, |sum, (a, b)| sum + f32x8::new(*a) * f32x8::new(*b));
    a_rest.iter().zip(b_rest).fold(total(sum), |sum, (a, b)| sum + a * b)
}

/// A vector in every lane.
#[inline(always)]
pub(crate) fn splat(v: Vec3) -> [f32x8; 3] {
    v.to_array().map(f32x8::splat)
}

/// Σ w d⃗ / (d² + s²)^{3/2}, eight sums side by side.
#[derive(Clone, Copy, Default)]
pub(crate) struct Pull([f32x8; 3]);

impl Pull {
    /// Adds what eight sources at `x` with the weights `w` do at `place`; `square` is s². Sources at the place itself
    /// do nothing.
    #[inline(always)]
    pub(crate) fn add(&mut self, place: [f32x8; 3], x: [f32x8; 3], w: f32x8, square: f32x8) {
        let d = [x[0] - place[0], x[1] - place[1], x[2] - place[2]];
        let d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        // No power of the distance above the second is formed: the third would leave an f32 within the solar system.
        let inverse = (f32x8::ONE / sqrt(d2 + square)) & d2.simd_gt(f32x8::ZERO);
        let strength = w * inverse * inverse;
        for (sum, d) in self.0.iter_mut().zip(d) {
            *sum += strength * (d * inverse);
        }
    }

    /// The same where no third power of a softened distance leaves the range of an `f32`, and s² is not zero.
    #[inline(always)]
    pub(crate) fn add_softened(&mut self, place: [f32x8; 3], x: [f32x8; 3], w: f32x8, square: f32x8) {
        let d = [x[0] - place[0], x[1] - place[1], x[2] - place[2]];
        let u2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + square;
        let strength = w / (u2 * sqrt(u2));
        for (sum, d) in self.0.iter_mut().zip(d) {
            *sum += strength * d;
        }
    }

    /// The sum.
    #[inline(always)]
    pub(crate) fn total(self) -> Vec3 {
        Vec3::from_array(self.0.map(total))
    }
}

/// The first of two where a mask says so, else the second.
#[inline(always)]
pub(crate) fn select(mask: f32x8, a: f32x8, b: f32x8) -> f32x8 {
    ((a ^ b) & mask) ^ b
}

/// The larger of two numbers, as [`crate::math::max`] has it.
#[inline(always)]
pub(crate) fn max(a: f32x8, b: f32x8) -> f32x8 {
    select(a.simd_gt(b), a, b)
}

/// The smaller of two numbers, as [`crate::math::min`] has it.
#[inline(always)]
pub(crate) fn min(a: f32x8, b: f32x8) -> f32x8 {
    select(a.simd_lt(b), a, b)
}

/// Numbers with their signs turned round, those of zeros as well.
#[inline(always)]
pub(crate) fn negated(x: f32x8) -> f32x8 {
    x ^ f32x8::splat(-0.0)
}

/// Lanes for which a mask does not hold.
#[inline(always)]
pub(crate) fn not(mask: f32x8) -> f32x8 {
    mask ^ f32x8::splat(f32::from_bits(u32::MAX))
}

/// Eight vectors side by side. Sums and products are taken in glam's order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vectors(pub(crate) [f32x8; 3]);

impl Vectors {
    /// One in every lane.
    #[inline(always)]
    pub(crate) fn splat(v: Vec3) -> Self {
        Self(splat(v))
    }

    /// Those of eight rows.
    #[inline(always)]
    pub(crate) fn gather(column: &[Vec3], rows: &[usize; LANES]) -> Self {
        let (mut x, mut y, mut z) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for (i, &row) in rows.iter().enumerate() {
            let v = column[row];
            (x[i], y[i], z[i]) = (v.x, v.y, v.z);
        }
        Self([f32x8::new(x), f32x8::new(y), f32x8::new(z)])
    }

    /// One coordinate of all after the other.
    #[inline(always)]
    pub(crate) fn columns(self) -> [[f32; LANES]; 3] {
        let [x, y, z] = self.0;
        [x.to_array(), y.to_array(), z.to_array()]
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> f32x8 {
        let ([x, y, z], [a, b, c]) = (self.0, other.0);
        (x * a) + (y * b) + (z * c)
    }

    #[inline(always)]
    pub(crate) fn length(self) -> f32x8 {
        sqrt(self.dot(self))
    }

    /// The magnitude of the largest coordinate.
    #[inline(always)]
    pub(crate) fn largest(self) -> f32x8 {
        let [x, y, z] = self.0.map(f32x8::abs);
        max(max(x, y), z)
    }

    /// As [`crate::math::unit`].
    #[inline(always)]
    pub(crate) fn unit(self) -> Self {
        let largest = self.largest();
        let has_one = largest.simd_gt(f32x8::ZERO) & largest.simd_lt(f32x8::splat(f32::INFINITY));
        let scaled = self / largest;
        (scaled / scaled.length()).masked(has_one)
    }

    /// The first of two where a mask says so, else the second.
    #[inline(always)]
    pub(crate) fn select(mask: f32x8, a: Self, b: Self) -> Self {
        Self(core::array::from_fn(|axis| select(mask, a.0[axis], b.0[axis])))
    }

    /// Zero where a mask does not hold.
    #[inline(always)]
    pub(crate) fn masked(self, mask: f32x8) -> Self {
        Self(self.0.map(|x| x & mask))
    }
}

impl core::ops::Add for Vectors {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|axis| self.0[axis] + other.0[axis]))
    }
}

impl core::ops::Sub for Vectors {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(core::array::from_fn(|axis| self.0[axis] - other.0[axis]))
    }
}

impl core::ops::Mul<f32x8> for Vectors {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f32x8) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl core::ops::Div<f32x8> for Vectors {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: f32x8) -> Self {
        Self(self.0.map(|x| x / divisor))
    }
}

impl core::ops::Neg for Vectors {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(negated))
    }
}
