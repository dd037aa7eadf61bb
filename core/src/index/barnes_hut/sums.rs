//! The sums at the points of a group: what acts on them is put in lists, and added in lanes.

use super::list::{List, MOMENTS};
use super::local::{Local, Series};
use super::moments::{Moments, Opening};
use crate::index::region::Region;
use crate::index::sorted::Sorted;
use crate::lanes::{self, Pull, splat};
use glam::Vec3;
use wide::f32x8;

/// Points that share one list.
pub(super) const GROUP: usize = 64;
/// Sources that are summed at once.
const LIST: usize = 256;
/// Far nodes that are summed at once, if they act by all their moments.
const FAR: usize = 32;
/// Nodes that are added to a series at once.
const WIDE: usize = 16;

/// Between these distances weights of two and less over the third power are ordinary numbers, or too small to matter
/// beside that of one which is within the farthest: 2⁻³⁹ and 2³⁰.
const NEAREST: f32 = 1.0 / (1u64 << 39) as f32;
const FARTHEST: f32 = (1u64 << 30) as f32;

/// The law as the tree has it.
#[derive(Clone, Copy)]
pub(super) struct Law {
    pub(super) theta_squared: f32,
    /// s².
    square: f32,
    /// The scale of the tree against the points.
    pub(super) scale: f32,
    pub(super) quadrupole: bool,
    /// True if nodes have dipoles about their centres.
    signed: bool,
    /// True if softening keeps third powers of all distances within an `f32`.
    soft: bool,
}

impl Law {
    pub(super) fn new(law: Opening, points: &Sorted<'_>, signed: bool) -> Self {
        let (scale, softening) = (points.domain.length(1.0), points.domain.length(law.softening));
        let wide = points.high.distance(points.low);
        Self {
            theta_squared: law.theta * law.theta,
            square: softening * softening,
            scale,
            quadrupole: law.quadrupole,
            signed,
            soft: softening.abs() >= NEAREST && softening.abs() <= FARTHEST && wide <= FARTHEST,
        }
    }
}

/// The sums at the places of a group, and what is still to be added to them.
pub(super) struct Sums {
    law: Law,
    len: usize,
    places: [Vec3; GROUP],
    pub(super) sums: [Vec3; GROUP],
    /// x, y, z and weight of the sources to be added.
    list: List<4, LIST>,
    /// The moments of the nodes to be added.
    far: List<MOMENTS, FAR>,
}

impl Sums {
    pub(super) fn new(law: Law) -> Self {
        let none = [Vec3::ZERO; GROUP];
        Self { law, len: 0, places: none, sums: none, list: List::EMPTY, far: List::EMPTY }
    }

    pub(super) fn begin(&mut self, places: impl Iterator<Item = Vec3>) {
        self.sums = [Vec3::ZERO; GROUP];
        self.len = 0;
        for (to, place) in self.places.iter_mut().zip(places) {
            *to = place;
            self.len += 1;
        }
    }

    /// Adds some sources, given by x, y, z and weight.
    #[inline(always)]
    pub(super) fn push(&mut self, mut sources: [&[f32]; 4]) {
        while !sources[0].is_empty() {
            let n = self.list.push_run(sources);
            if self.list.is_full() {
                self.flush();
            }
            sources = sources.map(|column| &column[n..]);
        }
    }

    /// Adds a node.
    #[inline(always)]
    pub(super) fn push_far(&mut self, moments: &Moments) {
        if !self.law.quadrupole {
            let [x, y, z] = moments.center;
            self.list.push([x, y, z, moments.weight]);
            if self.list.is_full() {
                self.flush();
            }
            return;
        }
        self.far.push_all(moments, self.law.signed);
        if self.far.is_full() {
            self.flush_far();
        }
    }

    /// Adds all that is still in lists, and a series.
    pub(super) fn finish(&mut self, series: &Series) {
        self.flush();
        self.flush_far();
        let series = series.prepared();
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            *sum += series.at(*place);
        }
    }

    /// Adds the sources in the list.
    fn flush(&mut self) {
        if self.law.soft {
            self.add_list(Pull::add_softened);
        } else {
            self.add_list(Pull::add);
        }
        self.list.clear();
    }

    /// Adds the sources in the list by one of two ways to write the law.
    #[inline(never)]
    fn add_list(&mut self, add: impl Fn(&mut Pull, [f32x8; 3], [f32x8; 3], f32x8, f32x8)) {
        let (blocks, square) = (self.list.pad(), f32x8::splat(self.law.square));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut pull, place) = (Pull::default(), splat(*place));
            for block in 0..blocks {
                let [x, y, z, w] = self.list.block(block);
                add(&mut pull, place, [x, y, z], w, square);
            }
            *sum += pull.total();
        }
    }

    /// Adds the far nodes.
    fn flush_far(&mut self) {
        if self.law.signed {
            self.add_far::<true>();
        } else {
            self.add_far::<false>();
        }
        self.far.clear();
    }

    /// Adds the far nodes, with dipoles or without.
    #[inline(never)]
    fn add_far<const DIPOLE: bool>(&mut self) {
        let (blocks, square) = (self.far.pad(), f32x8::splat(self.law.square));
        for (sum, place) in self.sums.iter_mut().zip(&self.places[..self.len]) {
            let (mut total, place) = ([f32x8::ZERO; 3], splat(*place));
            for block in 0..blocks {
                add_far::<DIPOLE>(&mut total, place, self.far.block(block), square);
            }
            *sum += Vec3::from_array(total.map(lanes::total));
        }
    }
}

/// Adds the first three terms of w (R + d) / |R + d|³ in powers of d, R being the way to a node's centre and u² = R² +
/// s²: w R/u³ + D/u³ − 3 R (R·D)/u⁵ − 3 S R/u⁵ − 3/2 R tr S/u⁵ + 15/2 R (R·S R)/u⁷. Without dipoles D is zero.
#[inline(always)]
fn add_far<const DIPOLE: bool>(sum: &mut [f32x8; 3], place: [f32x8; 3], node: [f32x8; MOMENTS], square: f32x8) {
    let [x, y, z, w, xx, yy, zz, xy, yz, zx, dx, dy, dz] = node;
    let r = [x - place[0], y - place[1], z - place[2]];
    let dot = |a: [f32x8; 3], b: [f32x8; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let u2 = dot(r, r) + square;
    let inverse = (f32x8::ONE / lanes::sqrt(u2)) & u2.simd_gt(f32x8::ZERO);
    // From here on the way is a unit vector, or less by softening, and each moment is over its power of the distance.
    let (r, over) = (r.map(|r| r * inverse), inverse * inverse);
    let [xx, yy, zz, xy, yz, zx] = [xx * over, yy * over, zz * over, xy * over, yz * over, zx * over];
    let s = [xx * r[0] + xy * r[1] + zx * r[2], xy * r[0] + yy * r[1] + yz * r[2], zx * r[0] + yz * r[1] + zz * r[2]];
    let trace = xx + yy + zz;
    let mut along = w - f32x8::splat(1.5) * trace + f32x8::splat(7.5) * dot(r, s);
    let mut aside = s.map(|s| f32x8::splat(-3.0) * s);
    if DIPOLE {
        let d = [dx, dy, dz].map(|moment| moment * inverse);
        along -= f32x8::splat(3.0) * dot(r, d);
        aside = core::array::from_fn(|axis| aside[axis] + d[axis]);
    }
    for axis in 0..3 {
        sum[axis] += (r[axis] * along + aside[axis]) * over;
    }
}

/// The series of a box, and the nodes still to be added to it.
pub(super) struct Wide {
    law: Law,
    local: Local,
    /// The moments of the nodes to be added.
    list: List<MOMENTS, WIDE>,
}

impl Wide {
    pub(super) fn new(law: Law) -> Self {
        Self { law, local: Local::NONE, list: List::EMPTY }
    }

    /// Forgets everything, for another box.
    pub(super) fn begin(&mut self, region: &Region) {
        self.local = Local::within(region);
        self.list.clear();
    }

    /// Adds a node.
    #[inline(always)]
    pub(super) fn push(&mut self, moments: &Moments) {
        if self.law.quadrupole {
            self.list.push_all(moments, self.law.signed);
        } else {
            let [x, y, z] = moments.center;
            self.list.push([x, y, z, moments.weight]);
        }
        if self.list.is_full() {
            self.flush();
        }
    }

    /// The series of all nodes.
    pub(super) fn finish(&mut self) -> Series {
        self.flush();
        self.local.series()
    }

    #[inline(never)]
    fn flush(&mut self) {
        let (blocks, square) = (self.list.pad(), f32x8::splat(self.law.square));
        for block in 0..blocks {
            match (self.law.quadrupole, self.law.signed) {
                (false, _) => self.local.add(self.list.block(block), square),
                (true, false) => self.local.add_all::<false>(self.list.block(block), square),
                (true, true) => self.local.add_all::<true>(self.list.block(block), square),
            }
        }
        self.list.clear();
    }
}
