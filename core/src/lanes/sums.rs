//! Sums over lanes and columns, and the inverse square law.

use super::LANES;
use glam::Vec3;
use wide::{f32x4, f32x8};

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
    [f32x8::splat(v.x), f32x8::splat(v.y), f32x8::splat(v.z)]
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

/// Four vectors, coordinate by coordinate.
#[inline(always)]
pub(crate) fn turned(vectors: &[Vec3; 4]) -> [f32x4; 3] {
    let flat: &[f32; 12] = bytemuck::cast_ref(vectors);
    // Four numbers from where each vector begins on: the last one is not its own.
    let at = |i: usize| f32x4::new(*flat[i..].first_chunk().unwrap_or(&[flat[9], flat[10], flat[11], 0.0]));
    let [x, y, z, _] = f32x4::transpose([at(0), at(3), at(6), at(9)]);
    [x, y, z]
}
