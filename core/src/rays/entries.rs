//! The boxes of the pieces while they are sorted into a tree.

use crate::math;
use crate::shape::Aabb;
use core::ops::Range;
use glam::Vec3;
use wide::f32x4;

/// The box of a piece, or what a cell has left of it.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Entry {
    pub(super) low: [f32; 3],
    pub(super) piece: u32,
    pub(super) high: [f32; 3],
    pub(super) spare: u32,
}

/// Words of an entry.
pub(super) const ENTRY: usize = size_of::<Entry>() / 4;

impl Entry {
    pub(super) fn new(bounds: &Aabb, piece: usize) -> Self {
        Self { low: bounds.min.to_array(), piece: piece as u32, high: bounds.max.to_array(), spare: 0 }
    }

    /// The box.
    pub(super) fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::from_array(self.low), max: Vec3::from_array(self.high) }
    }

    /// Its middle along an axis.
    #[inline(always)]
    pub(super) fn middle(&self, axis: usize) -> f32 {
        0.5 * self.low[axis] + 0.5 * self.high[axis]
    }

    /// Its middle.
    #[inline(always)]
    pub(super) fn center(&self) -> Vec3 {
        Vec3::from_array(self.low) * 0.5 + Vec3::from_array(self.high) * 0.5
    }
}

/// A box that grows; its fourth numbers mean nothing.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    low: f32x4,
    high: f32x4,
}

impl Hull {
    pub(super) const EMPTY: Self =
        Self { low: f32x4::new([f32::INFINITY; 4]), high: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub(super) fn add(&mut self, entry: &Entry) {
        // The words beside the planes go along as numbers that mean nothing.
        let [low, high] = bytemuck::cast::<Entry, [f32x4; 2]>(*entry);
        (self.low, self.high) = (low.fast_min(self.low), high.fast_max(self.high));
    }

    #[inline(always)]
    pub(super) fn add_point(&mut self, point: f32x4) {
        (self.low, self.high) = (point.fast_min(self.low), point.fast_max(self.high));
    }

    #[inline(always)]
    pub(super) fn join(self, other: Self) -> Self {
        Self { low: other.low.fast_min(self.low), high: other.high.fast_max(self.high) }
    }

    pub(super) fn bounds(self) -> Aabb {
        Aabb { min: Vec3::from_slice(&self.low.to_array()), max: Vec3::from_slice(&self.high.to_array()) }
    }

    /// Half of its surface, in units in which the root's longest side is about one.
    pub(super) fn area(self, scale: f32) -> f32 {
        area(&self.bounds(), scale)
    }
}

/// Half of a box's surface; zero of an empty one.
pub(super) fn area(bounds: &Aabb, scale: f32) -> f32 {
    let side = bounds.max * scale - bounds.min * scale;
    if side.x >= 0.0 { side.x * side.y + side.y * side.z + side.z * side.x } else { 0.0 }
}

/// Entries in one list that ends where room for copies begins.
#[derive(Debug)]
pub(super) struct Entries<'m> {
    all: &'m mut [Entry],
    /// The number of entries in use; copies of pieces that are cut go behind them.
    pub(super) len: usize,
}

impl<'m> Entries<'m> {
    pub(super) fn new(all: &'m mut [Entry]) -> Self {
        Self { all, len: 0 }
    }

    pub(super) fn push(&mut self, entry: Entry) {
        if let Some(slot) = self.all.get_mut(self.len) {
            *slot = entry;
            self.len += 1;
        }
    }

    pub(super) fn of(&self, range: Range<usize>) -> &[Entry] {
        &self.all[range]
    }

    pub(super) fn of_mut(&mut self, range: Range<usize>) -> &mut [Entry] {
        &mut self.all[range]
    }

    /// The box around some of them.
    pub(super) fn hull(&self, range: Range<usize>) -> Hull {
        let mut hull = Hull::EMPTY;
        self.all[range].iter().for_each(|entry| hull.add(entry));
        hull
    }

    /// Brings those that are `below` before the others, and returns where those begin.
    #[inline(always)]
    pub(super) fn part(&mut self, range: Range<usize>, below: impl Fn(&Entry) -> bool) -> usize {
        let entries = &mut self.all[range.clone()];
        let mut n = 0;
        for i in 0..entries.len() {
            // Both are written whether they change places or not: no branch to mispredict.
            let lower = below(&entries[i]);
            entries.swap(i, n);
            n += usize::from(lower);
        }
        range.start + n
    }

    /// Counts the entries that lie below a plane across an axis at least in part, and those above.
    pub(super) fn sides(&self, range: Range<usize>, axis: usize, plane: f32) -> [usize; 2] {
        let entries = &self.all[range];
        let below = entries.iter().filter(|entry| entry.low[axis] < plane).count();
        let above = entries.iter().filter(|entry| is_above(entry, axis, plane)).count();
        [below, above]
    }

    /// Cuts some at a plane: what is below stays in front, what is above is copied to the end of the list, and what
    /// is both becomes two. Nothing, if there is no room.
    pub(super) fn cut(&mut self, range: Range<usize>, axis: usize, plane: f32) -> Option<[Range<usize>; 2]> {
        let [_, above] = self.sides(range.clone(), axis, plane);
        let (top, end) = (self.len, self.len + above);
        if end > self.all.len() {
            return None;
        }
        let mut at = top;
        for i in range.clone() {
            let mut entry = self.all[i];
            if is_above(&entry, axis, plane) {
                entry.low[axis] = math::max(plane, entry.low[axis]);
                self.all[at] = entry;
                at += 1;
            }
        }
        let middle = self.part(range.clone(), |entry| entry.low[axis] < plane);
        for entry in &mut self.all[range.start..middle] {
            entry.high[axis] = math::min(plane, entry.high[axis]);
        }
        self.len = end;
        Some([range.start..middle, top..end])
    }
}

/// Tells whether a part of it is above a plane, or all of it lies in the plane.
#[inline(always)]
fn is_above(entry: &Entry, axis: usize, plane: f32) -> bool {
    entry.high[axis] > plane || !(entry.low[axis] < plane)
}
