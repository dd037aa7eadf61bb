//! Boxes around the paths of many particles, side by side: whom a collider cannot touch is told for all of them at once.

use super::Aabb;
use crate::math::{self, largest};
use crate::rows::flat;
use glam::Vec3;

/// Boxes around the paths of [`Hulls::MANY`] particles, coordinate by coordinate.
#[derive(Clone, Debug)]
pub struct Hulls {
    min: Sides,
    max: Sides,
    /// How much wider all of them are: by the largest radius, and by what rounding may come to.
    room: f32,
    /// The largest of their coordinates.
    largest: f32,
}

/// One coordinate after the other, of all boxes.
type Sides = [[f32; Hulls::MANY]; 3];

/// The numbers of four vectors.
type Four = [f32; 12];

/// Which of [`Hulls::MANY`] particles something holds for: all bits of its number are set, or none.
pub type Marks = [u32; Hulls::MANY];

impl Hulls {
    /// Their number: on hosts enough to share the cost of a call, on bare metal few, as they lie on the stack.
    pub const MANY: usize = if cfg!(target_os = "none") { 8 } else { 32 };

    /// Those around balls on the cubics with these places and velocities at both ends, so many seconds apart: of their
    /// Bézier control points. Only the first [`Hulls::MANY`] of all columns count; what is missing is at the origin.
    #[must_use]
    pub fn of_paths(ends: [&[Vec3]; 4], radius: &[f32], seconds: f32) -> Self {
        let (mut min, mut max) = ([[0.0; Self::MANY]; 3], [[0.0; Self::MANY]; 3]);
        let (mut farthest, third) = ([0.0; 12], seconds * (1.0 / 3.0));
        let [x0, v0, x1, v1] = ends.map(|column| flat(&column[..column.len().min(Self::MANY)]));
        let mut add = |k: usize, ends: [&Four; 4]| {
            let (low, high) = spans(ends, third);
            for i in 0..12 {
                // Of what is no number the one before is kept.
                farthest[i] = math::max(math::max(-low[i], high[i]), farthest[i]);
            }
            put(&mut min, k, &low);
            put(&mut max, k, &high);
        };
        let ((x0, x0_rest), (v0, v0_rest)) = (x0.as_chunks(), v0.as_chunks());
        let ((x1, x1_rest), (v1, v1_rest)) = (x1.as_chunks(), v1.as_chunks());
        let x0_whole = x0.len();
        for (k, ((x0, v0), (x1, v1))) in x0.iter().zip(v0).zip(x1.iter().zip(v1)).enumerate() {
            add(k, [x0, v0, x1, v1]);
        }
        if !x0_rest.is_empty() {
            let [x0, v0, x1, v1] = [x0_rest, v0_rest, x1_rest, v1_rest].map(padded);
            add(x0_whole, [&x0, &v0, &x1, &v1]);
        }
        let radius = radius.iter().fold(0.0, |most, &radius| math::max(radius, most));
        let largest = farthest.into_iter().fold(0.0, math::max) + radius;
        Self { min, max, room: radius + 16.0 * f32::EPSILON * largest, largest }
    }

    /// One of them; what is missing is at the origin.
    #[must_use]
    pub fn get(&self, i: usize) -> Aabb {
        let corner = |sides: &Sides| Vec3::from_array(sides.map(|side| side.get(i).copied().unwrap_or(0.0)));
        Aabb { min: corner(&self.min) - self.room, max: corner(&self.max) + self.room }
    }

    /// Marks those that a box may share a point with, and what lies on it: by so much as it is set off by rounding.
    pub fn near_box(&self, bounds: &Aabb, marks: &mut Marks) {
        let room = self.room + (32.0 * f32::EPSILON) * (largest(bounds.min) + largest(bounds.max));
        let (from, to) = (bounds.min - room, bounds.max + room);
        for (i, mark) in marks.iter_mut().enumerate() {
            let meets = |axis: usize| (self.min[axis][i] <= to[axis]) & (self.max[axis][i] >= from[axis]);
            *mark |= u32::from(meets(0) & meets(1) & meets(2)).wrapping_neg();
        }
    }

    /// Marks those that a plane through a point may touch, of a normal of any length.
    pub fn near_plane(&self, point: Vec3, normal: Vec3, marks: &mut Marks) {
        let (n, reach) = (normal, normal.abs());
        let rounding = (32.0 * f32::EPSILON) * (self.largest + largest(point));
        let room = (reach.x + reach.y + reach.z) * (self.room + rounding);
        let through = n.dot(point);
        let [[ax, ay, az], [bx, by, bz]] = [&self.min, &self.max];
        for (i, mark) in marks.iter_mut().enumerate() {
            // Twice the distance of the middle, and twice how far the corners are from it.
            let middle = n.x * (ax[i] + bx[i]) + n.y * (ay[i] + by[i]) + n.z * (az[i] + bz[i]);
            let half = reach.x * (bx[i] - ax[i]) + reach.y * (by[i] - ay[i]) + reach.z * (bz[i] - az[i]);
            *mark |= u32::from(!((middle - 2.0 * through).abs() > half + 2.0 * room)).wrapping_neg();
        }
    }
}

/// With zeros after what is there.
fn padded(rest: &[f32]) -> Four {
    let mut four = [0.0; 12];
    four.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
    four
}

/// The least and the greatest numbers of the control points of four cubics.
#[inline(always)]
fn spans([x0, v0, x1, v1]: [&Four; 4], third: f32) -> (Four, Four) {
    let (mut low, mut high) = ([0.0; 12], [0.0; 12]);
    for i in 0..12 {
        let (a, b) = (x0[i] + v0[i] * third, x1[i] - v1[i] * third);
        low[i] = math::min(math::min(x0[i], x1[i]), math::min(a, b));
        high[i] = math::max(math::max(x0[i], x1[i]), math::max(a, b));
    }
    (low, high)
}

/// Puts four vectors to their place, coordinate by coordinate.
#[inline(always)]
fn put(sides: &mut Sides, k: usize, four: &Four) {
    for (axis, side) in sides.iter_mut().enumerate() {
        side[4 * k..4 * k + 4].copy_from_slice(&[four[axis], four[axis + 3], four[axis + 6], four[axis + 9]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;
    use crate::shape::{Collider, Cuboid, Plane, Sphere};

    #[test]
    fn what_is_missing_is_at_the_origin() {
        let hulls = Hulls::of_paths([&[Vec3::ONE; 2]; 4], &[0.5; 2], 0.0);
        assert!(hulls.get(1).min.x > 0.49 && hulls.get(1).max.x > 1.49);
        for missing in [2, Hulls::MANY - 1, Hulls::MANY, usize::MAX] {
            let Aabb { min, max } = hulls.get(missing);
            assert!(min == -max && max.x > 0.5 && max.x < 0.51, "{missing}");
        }
    }

    /// Whatever may touch by itself is marked among others, wherever it is and however many they are.
    #[test]
    fn no_path_that_may_touch_is_passed_by() {
        let (mut marked, mut all) = (0, 0);
        for trial in 0..600_u32 {
            let units = |i: u32| Stream::new(5, trial, i).units(0).map(|u| 2.0 * u - 1.0);
            let vector = |i: u32| Vec3::new(units(i)[0], units(i)[1], units(i + 1)[0]);
            let len = (trial % 37) as usize;
            let (far, scale) = ([0.0, 3.0, 1e5][trial as usize % 3], [1e-3, 1.0, 50.0][trial as usize / 3 % 3]);
            let column =
                |k: u32| -> std::vec::Vec<Vec3> { (0..len as u32).map(|i| vector(7 * i + k) * scale).collect() };
            let (x0, v0, v1) = (column(0), column(2), column(4));
            let x0: std::vec::Vec<_> = x0.iter().map(|x| *x + Vec3::X * far).collect();
            let x1: std::vec::Vec<_> = x0.iter().zip(&v0).map(|(x, v)| *x + *v * 0.1).collect();
            let radius = std::vec![[0.0, 0.1 * scale][trial as usize % 2]; len];
            let hulls = Hulls::of_paths([&x0, &v0, &x1, &v1], &radius, 0.1);
            let plane = Plane { point: vector(90) + Vec3::X * far, normal: vector(93) };
            let (ball, room) = (Sphere { center: plane.point, radius: 0.3 * scale }, Vec3::splat(0.2 * scale));
            let cuboid = Cuboid { min: plane.point - room, max: plane.point + room };
            for collider in [&plane as &dyn Collider, &ball, &cuboid, &(plane, ball)] {
                let mut marks = [0; Hulls::MANY];
                collider.mark_near(&hulls, &mut marks);
                for (i, mark) in marks.iter().enumerate().take(len) {
                    let ends = [x0[i], x1[i], x0[i] + v0[i] * (0.1 / 3.0), x1[i] - v1[i] * (0.1 / 3.0)];
                    let exact = Aabb::around(ends);
                    let hull = Aabb { min: exact.min - radius[i], max: exact.max + radius[i] };
                    assert!(*mark == u32::MAX || !collider.may_touch(&hull.with_slack()), "{trial}, {i}");
                    (marked, all) = (marked + usize::from(*mark != 0), all + 1);
                }
            }
        }
        // Most are passed by, or it would be no use.
        assert!(marked * 2 < all && marked > 500, "{marked} of {all}");
    }
}
