//! The sums at the points of a group: what acts on them is put in lists, and added in lanes.

use super::barnes_hut::{Moments, Opening};
use super::sorted::{LANES, Sorted};
use crate::lanes::{NOWHERE, Pull, splat};
use glam::Vec3;
use wide::f32x8;

/// Points that share one list.
pub(super) const GROUP: usize = 64;
/// Sources that are summed at once.
const LIST: usize = 512;
/// Far nodes that are summed at once, if they act by all their moments.
const FAR: usize = 128;

/// The sums at the places of a group, and what is still to be added to them.
pub(super) struct Sums {
    pub(super) theta_squared: f32,
    softening_squared: f32,
    /// That of the tree against the points.
    pub(super) scale: f32,
    quadrupole: bool,
    len: usize,
    places: [Vec3; GROUP],
    pub(super) sums: [Vec3; GROUP],
    /// x, y, z and weight of the sources to be added.
    list: Columns<4, LIST>,
    /// The moments of the nodes to be added.
    far: Columns<13, FAR>,
}

/// Some columns of numbers, to be read in lanes.
struct Columns<const COLUMNS: usize, const ROWS: usize> {
    columns: [[f32; ROWS]; COLUMNS],
    len: usize,
}

impl<const COLUMNS: usize, const ROWS: usize> Columns<COLUMNS, ROWS> {
    const EMPTY: Self = Self { columns: [[0.0; ROWS]; COLUMNS], len: 0 };

    #[inline(always)]
    fn push(&mut self, row: [f32; COLUMNS]) {
        for (column, x) in self.columns.iter_mut().zip(row) {
            column[self.len] = x;
        }
        self.len += 1;
    }

    /// Fills the last block up with what has no weight; returns how many blocks there are.
    fn pad(&mut self) -> usize {
        while !self.len.is_multiple_of(LANES) {
            self.push(core::array::from_fn(|column| if column < 3 { NOWHERE } else { 0.0 }));
        }
        self.len / LANES
    }

    #[inline(always)]
    fn block(&self, block: usize) -> [f32x8; COLUMNS] {
        core::array::from_fn(|column| f32x8::new(self.columns[column].as_chunks().0[block]))
    }
}

impl Sums {
    pub(super) fn new(law: Opening, points: &Sorted<'_>) -> Self {
        let (scale, softening) = (points.domain.length(1.0), points.domain.length(law.softening));
        Self {
            theta_squared: law.theta * law.theta,
            softening_squared: softening * softening,
            scale,
            quadrupole: law.quadrupole,
            len: 0,
            places: [Vec3::ZERO; GROUP],
            sums: [Vec3::ZERO; GROUP],
            list: Columns::EMPTY,
            far: Columns::EMPTY,
        }
    }

    pub(super) fn begin(&mut self, places: impl Iterator<Item = Vec3>) {
        self.sums = [Vec3::ZERO; GROUP];
        self.len = 0;
        for (to, place) in self.places.iter_mut().zip(places) {
            *to = place;
            self.len += 1;
        }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, at: Vec3, weight: f32) {
        self.list.push([at.x, at.y, at.z, weight]);
        if self.list.len == LIST {
            self.flush();
        }
    }

    #[inline(always)]
    pub(super) fn push_far(&mut self, moments: &Moments) {
        if !self.quadrupole {
            return self.push(Vec3::from_array(moments.center), moments.weight);
        }
        let ([x, y, z], [dx, dy, dz]) = (moments.center, moments.dipole);
        let [xx, yy, zz, xy, yz, zx] = moments.second;
        self.far.push([x, y, z, moments.weight, dx, dy, dz, xx, yy, zz, xy, yz, zx]);
        if self.far.len == FAR {
            self.flush_far();
        }
    }

    /// Adds the sources in the list.
    pub(super) fn flush(&mut self) {
        let (blocks, square) = (self.list.pad(), f32x8::splat(self.softening_squared));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut pull, place) = (Pull::default(), splat(*place));
            for block in 0..blocks {
                let [x, y, z, w] = self.list.block(block);
                pull.add(place, [x, y, z], w, square);
            }
            *sum += pull.total();
        }
        self.list.len = 0;
    }

    /// Adds the far nodes.
    pub(super) fn flush_far(&mut self) {
        let (blocks, square) = (self.far.pad(), f32x8::splat(self.softening_squared));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut total, place) = ([f32x8::ZERO; 3], splat(*place));
            for block in 0..blocks {
                add_far(&mut total, place, self.far.block(block), square);
            }
            *sum += Vec3::from_array(total.map(crate::lanes::total));
        }
        self.far.len = 0;
    }
}

/// Adds the first three terms of w (R + d) / |R + d|³ in powers of d, R being the way to a node's centre and u² = R² +
/// s²: w R/u³ + D/u³ − 3 R (R·D)/u⁵ − 3 S R/u⁵ − 3/2 R tr S/u⁵ + 15/2 R (R·S R)/u⁷.
#[inline(always)]
fn add_far(sum: &mut [f32x8; 3], place: [f32x8; 3], node: [f32x8; 13], square: f32x8) {
    let [x, y, z, w, dx, dy, dz, xx, yy, zz, xy, yz, zx] = node;
    let r = [x - place[0], y - place[1], z - place[2]];
    let dot = |a: [f32x8; 3], b: [f32x8; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let u2 = dot(r, r) + square;
    let inverse = (f32x8::ONE / crate::lanes::sqrt(u2)) & u2.simd_gt(f32x8::ZERO);
    // From here on the way is a unit vector, or less by softening, and each moment is over its power of the distance.
    let r = r.map(|r| r * inverse);
    let over = |moment: f32x8| moment * inverse;
    let [xx, yy, zz, xy, yz, zx] = [xx, yy, zz, xy, yz, zx].map(|moment| over(over(moment)));
    let d = [over(dx), over(dy), over(dz)];
    let s = [xx * r[0] + xy * r[1] + zx * r[2], xy * r[0] + yy * r[1] + yz * r[2], zx * r[0] + yz * r[1] + zz * r[2]];
    let trace = xx + yy + zz;
    let along = w - f32x8::splat(3.0) * dot(r, d) - f32x8::splat(1.5) * trace + f32x8::splat(7.5) * dot(r, s);
    for axis in 0..3 {
        sum[axis] += over(over(r[axis] * along + d[axis] - f32x8::splat(3.0) * s[axis]));
    }
}
