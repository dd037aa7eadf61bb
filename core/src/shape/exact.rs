//! Determinants without rounding, for where single precision cannot tell on which side of what a point lies.

use crate::math::{clamp, high, max, power_to_one};
use glam::Vec3;

/// Points in whole numbers, each axis in a unit of its own, which no sign of a determinant depends on.
///
/// The unit is 2⁻⁵⁷ of the largest coordinate of the axis, or less: what is lost is beyond the 33rd bit below a unit in
/// the last place of that.
pub(super) struct Lattice<const N: usize> {
    points: [[i64; 3]; N],
    /// One over the units, in a unit that all axes share.
    scale: Vec3,
}

/// 2⁵⁷: coordinates have 59 bits at the most, so that sums of three products of two differences fit into 128 bits.
const WHOLE: f32 = 144_115_188_075_855_872.0;
/// 2⁻⁶⁴.
const LOW: f32 = 1.0 / 18_446_744_073_709_551_616.0;

impl<const N: usize> Lattice<N> {
    pub(super) fn new(points: [Vec3; N]) -> Self {
        let scale = points.iter().fold(Vec3::ZERO, |most, point| high(most, point.abs())).map(power_to_one);
        let whole = |x: f32| (clamp(x, -4.0, 4.0) * WHOLE) as i64;
        let points = points.map(|point| (point * scale).to_array().map(whole));
        Self { points, scale: scale / max(max(scale.x, scale.y), scale.z) }
    }

    /// The way from one of the points to another.
    pub(super) fn way(&self, from: usize, to: usize) -> [i64; 3] {
        core::array::from_fn(|axis| self.points[to][axis] - self.points[from][axis])
    }

    /// A vector product as a direction in space; its length means nothing.
    pub(super) fn direction(&self, [x, y, z]: [i128; 3]) -> Vec3 {
        Vec3::new(x as f32, y as f32, z as f32) * self.scale
    }
}

/// The vector product.
pub(super) fn cross(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    let product = |i: usize, j: usize| i128::from(a[i]) * i128::from(b[j]);
    [product(1, 2) - product(2, 1), product(2, 0) - product(0, 2), product(0, 1) - product(1, 0)]
}

/// The scalar product with a vector product: a number of the right sign, rounded once.
pub(super) fn volume(normal: [i128; 3], way: [i64; 3]) -> f32 {
    let (mut upper, mut lower) = (0, 0);
    for (n, d) in normal.into_iter().zip(way.map(i128::from)) {
        upper += (n >> 64) * d;
        lower += i128::from(n as u64) * d;
    }
    upper += lower >> 64;
    match i64::try_from(upper) {
        Ok(upper) => (i128::from(upper) << 64 | i128::from(lower as u64)) as f32 * LOW,
        Err(_) => upper as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;

    fn point(i: u32, size: f32) -> Vec3 {
        let s = Stream::new(5, 0, i);
        Vec3::new(s.units(0)[0] - 0.5, s.units(0)[1] - 0.5, s.units(1)[0] - 0.5) * size
    }

    #[test]
    fn volumes_agree_with_double_precision_where_that_can_tell() {
        for i in 0..20_000 {
            let size = [1e-38, 1e-20, 1e-3, 1.0, 1e9, 3e38][i as usize % 6];
            let [a, b, c, d] = core::array::from_fn(|k| point(4 * i + k as u32, size));
            let lattice = Lattice::new([a, b, c, d]);
            let found = volume(cross(lattice.way(0, 1), lattice.way(0, 2)), lattice.way(0, 3));
            let way = |p: Vec3| -> [f64; 3] {
                core::array::from_fn(|k| (f64::from(p[k]) - f64::from(a[k])) / f64::from(size))
            };
            let (x, y, z) = (way(b), way(c), way(d));
            let normal: [f64; 3] = core::array::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                x[i] * y[j] - x[j] * y[i]
            });
            let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
            let expected = dot(normal, z);
            assert!(expected.abs() < 1e-12 || (found > 0.0) == (expected > 0.0), "{a} {b} {c} {d}");
            let length = libm::sqrt(dot(normal, normal));
            let across = crate::math::unit(lattice.direction(cross(lattice.way(0, 1), lattice.way(0, 2))));
            for axis in 0..3 {
                assert!((f64::from(across[axis]) - normal[axis] / length).abs() < 3e-7, "{a} {b} {c}: {across}");
            }
        }
    }

    #[test]
    fn what_lies_in_a_plane_has_no_volume_and_what_is_beside_it_by_the_least_has() {
        // The third corner is the sum of the other two, the fourth point their difference: all without rounding.
        let (x, y) = (Vec3::new(3.0, 0.5, 1.25), Vec3::new(-1.0, 7.0, 2.0));
        let [a, b, c, d] = [Vec3::ONE * 64.0, Vec3::ONE * 64.0 + x, Vec3::ONE * 64.0 + y, Vec3::ONE * 64.0 + x - y];
        let of = |d: Vec3| {
            let lattice = Lattice::new([a, b, c, d]);
            volume(cross(lattice.way(0, 1), lattice.way(0, 2)), lattice.way(0, 3))
        };
        assert_eq!(of(d), 0.0);
        assert!(of(Vec3::new(d.x, d.y, d.z.next_up())) > 0.0 && of(Vec3::new(d.x, d.y, d.z.next_down())) < 0.0);
    }

    #[test]
    fn nothing_overflows() {
        let ends = [f32::MAX, f32::MIN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0, 1e-45];
        for i in 0..7_usize.pow(4) {
            let pick = |k: u32| Vec3::new(ends[i / 7_usize.pow(k) % 7], ends[(i + k as usize) % 7], ends[i % 7]);
            let lattice = Lattice::new([pick(0), pick(1), pick(2), pick(3)]);
            let found = volume(cross(lattice.way(0, 1), lattice.way(0, 2)), lattice.way(0, 3));
            assert!(found.is_finite());
        }
    }
}
