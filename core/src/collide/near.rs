//! Whom a flat face may touch: all rows of a tile are held against it, and most are far from it.

use crate::lanes::{Eight, Kernel, LANES, run, turned, widest};
use crate::math::{largest, max, min};
use crate::rows::{Extents, farthest, filled, largest_of};
use crate::shape::{Aabb, Face};
use core::ops::Range;
use core::slice;
use glam::Vec3;
use wide::f32x4;

/// Rows that are held against a face at once.
pub(super) const BLOCK: usize = 1280;

/// A bit for each row of a block.
pub(super) type Marks = [u8; BLOCK / LANES];

/// Those who may touch a face, and those of them who may lie on it as well: others are too far from it when the step begins.
pub(super) struct Near {
    pub(super) touching: Marks,
    pub(super) lying: Marks,
}

/// Balls on cubics: places and velocities at both ends, so many seconds apart.
#[derive(Clone, Copy)]
pub(super) struct Balls<'a> {
    pub(super) ends: [&'a [Vec3]; 4],
    pub(super) radius: &'a [f32],
    /// What these are, if it is known to be one number.
    pub(super) common: Option<f32>,
    pub(super) time: f32,
}

/// Some of them, and how large the numbers of their paths are.
#[derive(Clone, Copy)]
pub(super) struct Block<'a> {
    balls: Balls<'a>,
    /// The vectors between which velocities change \[m/s\], where that is known.
    change: Option<[Vec3; 2]>,
    /// The largest number of the control points, and of the radii; or more, but what is no number does not count.
    largest: f32,
    radius: f32,
}

/// Balls beside a plane across an axis: whoever's coordinate stays beyond a side of this is far. If they are not `BENT`, their control
/// points are no farther beyond than that.
struct Slab<'a, const AXIS: usize, const BENT: bool> {
    balls: Balls<'a>,
    sides: [f32; 2],
}

impl<'a> Balls<'a> {
    /// No more than a block of them, which have `reached` so far, where that is known.
    #[inline]
    pub(super) fn block(&self, rows: Range<usize>, reached: Option<Extents>) -> Block<'a> {
        let Self { ends, radius, common, time } = *self;
        let balls = Self { ends: ends.map(|column| &column[rows.clone()]), radius: &radius[rows], common, time };
        let third = balls.third();
        let radius = largest_of(common.as_ref().map_or(balls.radius, slice::from_ref));
        match reached {
            // Where they are, no coordinate is beyond `place`. They began no farther from there than the way at the largest speed, and
            // a control point is a third of that way from its end.
            Some(Extents { place, speed, change }) => {
                Block { balls, change: Some(change), largest: place + (time + third) * speed, radius }
            }
            None => {
                let [x0, v0, x1, v1] = balls.ends.map(farthest);
                let largest = max(x0 + third * v0, x1 + third * v1);
                Block { balls, change: None, largest, radius }
            }
        }
    }

    /// A third of the time, by which control points are away from the ends.
    fn third(&self) -> f32 {
        self.time * (1.0 / 3.0)
    }

    /// The answers for eight after the other, side by side.
    #[inline(always)]
    fn marks(&self, near: impl Fn([&[Vec3; LANES]; 4], &[f32; LANES]) -> [u8; 2]) -> Near {
        let mut marks = Near { touching: [0; BLOCK / LANES], lying: [0; BLOCK / LANES] };
        let places = marks.touching.iter_mut().zip(&mut marks.lying);
        let [(x0, x0_rest), (v0, v0_rest), (x1, x1_rest), (v1, v1_rest)] = self.ends.map(<[Vec3]>::as_chunks);
        let (radius, radius_rest) = self.radius.as_chunks();
        let columns = x0.iter().zip(v0).zip(x1.iter().zip(v1)).zip(radius);
        for ((touching, lying), (((x0, v0), (x1, v1)), radius)) in places.zip(columns) {
            [*touching, *lying] = near([x0, v0, x1, v1], radius);
        }
        if !radius_rest.is_empty() {
            let (x0, v0, x1, v1) = (filled(x0_rest), filled(v0_rest), filled(x1_rest), filled(v1_rest));
            // There are fewer rows than eight.
            let are_there = !(u8::MAX << radius_rest.len());
            let last = near([&x0, &v0, &x1, &v1], &filled(radius_rest)).map(|marks| marks & are_there);
            for (marks, last) in [&mut marks.touching, &mut marks.lying].into_iter().zip(last) {
                marks[radius.len()..].iter_mut().take(1).for_each(|mark| *mark = last);
            }
        }
        marks
    }
}

impl Block<'_> {
    /// A mask of those that may touch the face, as far as boxes around their paths tell: never fewer than
    /// [`Plane::may_touch`](crate::shape::Plane) would name, nor than lie on it.
    #[inline(never)]
    pub(super) fn near(&self, face: &Face) -> Near {
        let balls = self.balls;
        let ([point, _, unit], third) = (face.vectors(), balls.third());
        // No number of the paths is larger, of those that are finite: others are followed nowhere.
        let largest = self.largest + face.size() + self.radius;
        let room = self.radius + largest * (128.0 * f32::EPSILON);
        let sides = |axis: usize| [point[axis] - room, point[axis] + room];
        match unit.abs().to_array() {
            _ if !(largest < 1e37) => balls.marks(|_, _| [u8::MAX; 2]),
            [1.0, 0.0, 0.0] => self.beside::<0>(sides(0)),
            [0.0, 1.0, 0.0] => self.beside::<1>(sides(1)),
            [0.0, 0.0, 1.0] => self.beside::<2>(sides(2)),
            _ => widest(
                #[inline(always)]
                || balls.marks(|ends, radius| [near(face, ends, radius, third); 2]),
            ),
        }
    }

    /// The same of a plane across an axis, or what lies between two of them.
    fn beside<const AXIS: usize>(&self, sides: [f32; 2]) -> Near {
        let balls = self.balls;
        let Some([least, most]) = self.change else { return run(Slab::<AXIS, true> { balls, sides }) };
        let third = balls.third();
        let sides = [sides[0] + third * min(least[AXIS], 0.0), sides[1] + third * max(most[AXIS], 0.0)];
        run(Slab::<AXIS, false> { balls, sides })
    }

    /// A mask of those that may touch a box, as far as the axis tells that it is thinnest along.
    #[inline(never)]
    pub(super) fn near_box(&self, bounds: &Aabb) -> Marks {
        let Self { balls, radius, .. } = *self;
        let largest = self.largest + largest(bounds.min) + largest(bounds.max) + radius;
        let room = radius + largest * (256.0 * f32::EPSILON);
        let extent = bounds.max - bounds.min;
        let sides = |axis: usize| [bounds.min[axis] - room, bounds.max[axis] + room];
        let marks = match extent.min_element() {
            _ if !(largest < 1e37) => balls.marks(|_, _| [u8::MAX; 2]),
            least if least == extent.x => self.beside::<0>(sides(0)),
            least if least == extent.y => self.beside::<1>(sides(1)),
            _ => self.beside::<2>(sides(2)),
        };
        marks.touching
    }

    /// Tells whether all of them are points.
    pub(super) fn are_points(&self) -> bool {
        self.radius == 0.0
    }

    /// How much any number of their velocities changes at the most \[m/s\], where that is known, and what rounding may come to among things
    /// as far from the origin as `size` \[m\].
    pub(super) fn limits(&self, size: f32) -> (Option<f32>, f32) {
        let change = self.change.map(|[least, most]| max(largest(least), largest(most)));
        (change, (self.largest + self.radius + size) * (512.0 * f32::EPSILON))
    }
}

impl<const AXIS: usize, const BENT: bool> Kernel for Slab<'_, AXIS, BENT> {
    type Output = Near;

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Near {
        let (third, [low, high]) = (like.all(self.balls.third()), [like.all(self.sides[0]), like.all(self.sides[1])]);
        self.balls.marks(
            #[inline(always)]
            |[x0, v0, x1, v1], _| {
                let (x0, x1) = (coordinate::<F, AXIS>(like, x0), coordinate::<F, AXIS>(like, x1));
                let (mut least, mut most) = (x0.least(x1), x0.most(x1));
                if BENT {
                    let a = x0 + coordinate::<F, AXIS>(like, v0) * third;
                    let b = x1 - coordinate::<F, AXIS>(like, v1) * third;
                    (least, most) = (least.least(a).least(b), most.most(a).most(b));
                }
                // Who lies on a floor begins no higher than this; who is below it is held to lie until that is looked at closer.
                let (is_near, is_low) = (most.simd_ge(low), x0.simd_le(high));
                let rows = const { &rows_of_bits(AXIS) };
                let touching = is_near & least.simd_le(high);
                let lying = touching & is_low;
                [rows[touching.to_bitmask() as usize % 256], rows[lying.to_bitmask() as usize % 256]]
            },
        )
    }
}

/// One coordinate of eight vectors: of all their numbers, eight by eight, those in each lane that are such. The vectors are in an order
/// that comes of it.
#[inline(always)]
fn coordinate<F: Eight, const AXIS: usize>(like: F, vectors: &[Vec3; LANES]) -> F {
    let [a, b, c]: &[[f32; LANES]; 3] = bytemuck::cast_ref(vectors);
    let [of_b, of_c] = const { [lanes_of(AXIS, 1), lanes_of(AXIS, 2)] };
    like.of(of_c).select(like.of(*c), like.of(of_b).select(like.of(*b), like.of(*a)))
}

/// The lanes of one of three blocks of numbers that are such coordinates, as a mask.
const fn lanes_of(axis: usize, block: usize) -> [f32; LANES] {
    let (mut mask, mut lane) = ([0.0; LANES], 0);
    while lane < LANES {
        if (LANES * block + lane) % 3 == axis {
            mask[lane] = f32::from_bits(u32::MAX);
        }
        lane += 1;
    }
    mask
}

/// The bits of eight rows in their own order, for those in the order of such coordinates.
const fn rows_of_bits(axis: usize) -> [u8; 256] {
    let (mut table, mut number) = ([0; 256], 0);
    while number < 3 * LANES {
        let (row, lane, mut bits) = (number / 3, number % LANES, 0);
        while bits < 256 && number % 3 == axis {
            if bits >> lane & 1 != 0 {
                table[bits] |= 1 << row;
            }
            bits += 1;
        }
        number += 1;
    }
    table
}

/// The same of eight balls on paths between these places and velocities, past any face.
#[inline(always)]
fn near(face: &Face, [x0, v0, x1, v1]: [&[Vec3; LANES]; 4], radius: &[f32; LANES], third: f32) -> u8 {
    let half = |i: usize| {
        let of = |column: &[Vec3; LANES]| [column[4 * i], column[4 * i + 1], column[4 * i + 2], column[4 * i + 3]];
        let radius = [radius[4 * i], radius[4 * i + 1], radius[4 * i + 2], radius[4 * i + 3]];
        near_four(face, [&of(x0), &of(v0), &of(x1), &of(v1)], &radius, third)
    };
    half(0) | half(1) << 4
}

/// A bit for each of the balls on four paths between these places and velocities: set, if it may touch a face.
#[inline(always)]
fn near_four(face: &Face, [x0, v0, x1, v1]: [&[Vec3; 4]; 4], radius: &[f32; 4], third: f32) -> u8 {
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
