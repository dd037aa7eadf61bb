//! Whom a flat face may touch: all rows of a tile are held against it, and most are far from it.

use crate::lanes::{turned, widest};
use crate::math::max;
use crate::rows::{farthest, filled};
use crate::shape::Face;
use core::ops::Range;
use glam::Vec3;
use wide::f32x4;

/// Rows that are held against a face at once.
pub(super) const BLOCK: usize = 256;

/// A bit for each row of a block, 32 in a word.
pub(super) type Marks = [u32; BLOCK / 32];

/// Balls on cubics: places and velocities at both ends, so many seconds apart.
#[derive(Clone, Copy)]
pub(super) struct Balls<'a> {
    pub(super) ends: [&'a [Vec3]; 4],
    pub(super) radius: &'a [f32],
    pub(super) time: f32,
}

/// A plane across an axis: who is beyond a side of it is far.
struct Slab {
    low: f32,
    high: f32,
    third: f32,
}

impl Balls<'_> {
    fn rows(&self, rows: Range<usize>) -> Self {
        let Self { ends, radius, time } = *self;
        Self { ends: ends.map(|column| &column[rows.clone()]), radius: &radius[rows], time }
    }

    /// Who of no more than a block of them may touch the face, as far as boxes around their paths tell: never fewer than
    /// [`Plane::may_touch`](crate::shape::Plane) would name, nor than lie on it.
    #[inline(never)]
    pub(super) fn near(&self, rows: Range<usize>, face: &Face) -> Marks {
        let balls = self.rows(rows);
        let [point, _, unit] = face.vectors();
        // No number of the paths is larger, of those that are finite: others are followed nowhere.
        let [x0, v0, x1, v1] = balls.ends.map(farthest);
        let third = balls.time * (1.0 / 3.0);
        let largest = max(x0 + third * v0, x1 + third * v1) + face.size();
        let room =
            (largest + balls.radius.iter().fold(0.0, |most, &radius| max(radius, most))) * (128.0 * f32::EPSILON);
        let slab = |axis: usize| Slab { low: point[axis] - room, high: point[axis] + room, third };
        match unit.abs().to_array() {
            _ if !(largest < 1e37) => balls.marks(|_, _| 15),
            [1.0, 0.0, 0.0] => balls.marks(
                #[inline(always)]
                |ends, radius| slab(0).near::<0>(ends, radius),
            ),
            [0.0, 1.0, 0.0] => balls.marks(
                #[inline(always)]
                |ends, radius| slab(1).near::<1>(ends, radius),
            ),
            [0.0, 0.0, 1.0] => balls.marks(
                #[inline(always)]
                |ends, radius| slab(2).near::<2>(ends, radius),
            ),
            _ => balls.marks(
                #[inline(always)]
                |ends, radius| near(face, ends, radius, third),
            ),
        }
    }

    /// What is told of four after the other, side by side.
    #[inline(always)]
    fn marks(&self, near: impl Fn([&[Vec3; 4]; 4], &[f32; 4]) -> u8) -> Marks {
        let mut marks = [0; BLOCK / 32];
        let [(x0, x0_rest), (v0, v0_rest), (x1, x1_rest), (v1, v1_rest)] = self.ends.map(<[Vec3]>::as_chunks::<4>);
        let (radius, radius_rest) = self.radius.as_chunks();
        let mut put = |i: usize, four: u8| marks[i / 8 % (BLOCK / 32)] |= u32::from(four) << (4 * (i % 8));
        widest(
            #[inline(always)]
            || {
                let columns = x0.iter().zip(v0).zip(x1.iter().zip(v1)).zip(radius);
                for (i, (((x0, v0), (x1, v1)), radius)) in columns.enumerate() {
                    put(i, near([x0, v0, x1, v1], radius));
                }
            },
        );
        if !x0_rest.is_empty() {
            let [x0, v0, x1, v1] = [x0_rest, v0_rest, x1_rest, v1_rest].map(filled);
            let last = near([&x0, &v0, &x1, &v1], &filled(radius_rest));
            put(self.radius.len() / 4, last & ((1 << x0_rest.len()) - 1));
        }
        marks
    }
}

impl Slab {
    /// Who of balls on four paths may touch it: their other coordinates do not count.
    #[inline(always)]
    fn near<const AXIS: usize>(&self, ends: [&[Vec3; 4]; 4], radius: &[f32; 4]) -> u8 {
        let [x0, v0, x1, v1] = ends.map(coordinate::<AXIS>);
        let (a, b) = (x0 + v0 * self.third, x1 - v1 * self.third);
        let low = x0.fast_min(x1).fast_min(a.fast_min(b));
        let high = x0.fast_max(x1).fast_max(a.fast_max(b));
        let gap = (low - self.high).fast_max(self.low - high);
        !(gap.simd_gt(f32x4::new(*radius)).to_bitmask() as u8) & 15
    }
}

/// One coordinate of four vectors.
#[inline(always)]
fn coordinate<const AXIS: usize>(vectors: &[Vec3; 4]) -> f32x4 {
    let flat: &[[f32; 4]; 3] = bytemuck::cast_ref(vectors);
    let flat = flat.map(|four| f32x4::new(four).to_array());
    let of = |i: usize| flat[(3 * i + AXIS) / 4][(3 * i + AXIS) % 4];
    f32x4::new([of(0), of(1), of(2), of(3)])
}

/// Who of balls on four paths between these places and velocities may touch a face: a bit each.
#[inline(always)]
fn near(face: &Face, [x0, v0, x1, v1]: [&[Vec3; 4]; 4], radius: &[f32; 4], third: f32) -> u8 {
    let (x0, v0, x1, v1) = (turned(x0), turned(v0), turned(x1), turned(v1));
    let [point, _, unit] = face.vectors();
    let span = |axis: usize| {
        let (a, b) = (x0[axis] + v0[axis] * third, x1[axis] - v1[axis] * third);
        let low = x0[axis].fast_min(x1[axis]).fast_min(a.fast_min(b));
        (low, x0[axis].fast_max(x1[axis]).fast_max(a.fast_max(b)))
    };
    let ((ax, bx), (ay, by), (az, bz)) = (span(0), span(1), span(2));
    // Twice the distance of the middle, and twice how far the corners are from it.
    let middle = (ax + bx) * unit.x + (ay + by) * unit.y + (az + bz) * unit.z - 2.0 * unit.dot(point);
    let half = (bx - ax) * unit.x.abs() + (by - ay) * unit.y.abs() + (bz - az) * unit.z.abs();
    let far = |low: f32x4, high: f32x4| high.fast_max(-low);
    let largest = far(ax, bx).fast_max(far(ay, by)).fast_max(far(az, bz)) + face.size();
    // A box around a ball reaches by less than twice the radius farther along a normal.
    let radius = f32x4::new(*radius);
    let room = radius + radius + (largest + radius) * (128.0 * f32::EPSILON);
    // What is no number is near, and what is so far away that sums may not be any.
    let is_far = middle.abs().simd_gt(half + room + room) & largest.simd_lt(f32x4::splat(1e37));
    !(is_far.to_bitmask() as u8) & 15
}
