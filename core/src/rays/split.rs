//! How a tree divides pieces: the one thing in which the trees differ.

use super::entries::{Entries, Hull};
use crate::shape::Aabb;
use core::ops::Range;

/// A part of the pieces on its way into a node.
#[derive(Clone)]
pub(super) struct Part<C> {
    /// Its entries.
    pub(super) range: Range<usize>,
    /// The box around them.
    pub(super) hull: Hull,
    /// The value that the structure hands down.
    pub(super) cell: C,
    /// How often it has been cut on the way from its node.
    pub(super) cuts: u32,
}

/// How a tree cuts a part in two.
pub(super) trait Split {
    /// True if planes cut pieces, which are then listed on both sides.
    const CUTS: bool;
    /// Pieces in a leaf, at most: those that are not cut are as many as a node has lanes for.
    const LEAF: usize = super::tree::WIDE;
    /// The structure's rule wants so many cuts from a node to its child; zero: whatever gives the smallest boxes.
    const ROUNDS: u32 = 0;
    /// The value handed down from part to part.
    type Cell: Clone;

    /// That of all pieces.
    fn root(&self, bounds: &Aabb) -> Self::Cell;

    /// Two parts, neither larger than the whole; or none, if that does not pay. `scale` makes the root's longest side
    /// about one.
    fn cut(&self, part: &Part<Self::Cell>, entries: &mut Entries<'_>, scale: f32) -> Option<[Part<Self::Cell>; 2]>;
}

impl<C: Clone> Part<C> {
    /// Entries with a cell.
    pub(super) fn new(range: Range<usize>, cell: C, cuts: u32, entries: &Entries<'_>) -> Self {
        Self { hull: entries.hull(range.clone()), range, cell, cuts }
    }

    /// Divides it at an entry.
    pub(super) fn at(&self, middle: usize, entries: &Entries<'_>) -> [Self; 2] {
        let part = |range| Self::new(range, self.cell.clone(), self.cuts + 1, entries);
        [part(self.range.start..middle), part(middle..self.range.end)]
    }
}

/// The axis along which a box is longest.
pub(super) fn longest(bounds: &Aabb) -> usize {
    let side = bounds.max * 0.5 - bounds.min * 0.5;
    let axis = if side.y > side.x { 1 } else { 0 };
    if side.z > side[axis] { 2 } else { axis }
}
