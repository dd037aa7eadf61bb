//! How a tree divides points among the children of a node.

use super::frames::Frames;
use super::sorted::Entry;
use glam::Vec3;
use wide::f32x4;

/// At most so many children has a node.
pub(super) const CHILDREN: usize = 8;

/// How a tree divides points among a node's children.
pub trait Split: Default + Sync {
    /// Points in a leaf, at most.
    const LEAF: usize;
    /// Bytes of nodes for every point; the leaves become larger if that is not enough.
    const BYTES: usize;
    /// True if boxes may be turned against the axes.
    const TURNS: bool = false;
    /// The value handed down from node to node.
    type Cell: Copy;

    /// The root's.
    fn root(&mut self, low: Vec3, high: Vec3) -> Self::Cell;

    /// The frame in which a node has its box; it may choose one for the node's entries.
    fn frame(&self, cell: &mut Self::Cell, entries: &[Entry], frames: &mut Frames<'_>) -> u32 {
        let _ = (cell, entries, frames);
        0
    }

    /// Sorts the entries of a node with more points than a leaf has by the child they go to, and appends for each child
    /// that gets some where it ends, and its cell. With less than two children the node stays a leaf.
    fn split(
        &self,
        cell: Self::Cell,
        bounds: [Vec3; 2],
        entries: &mut [Entry],
        frames: &Frames<'_>,
        children: &mut heapless::Vec<(usize, Self::Cell), CHILDREN>,
    );
}

/// The box around some entries.
///
/// Among zeros of both signs the target chooses which one a corner gets, unlike in
/// [`around`](super::domain::around). No answer can tell: corners are only compared and subtracted.
pub(super) fn bounds(entries: &[Entry]) -> [Vec3; 2] {
    let (mut low, mut high) = (f32x4::splat(f32::INFINITY), f32x4::splat(f32::NEG_INFINITY));
    for entry in entries {
        // The row goes along as a fourth number that means nothing.
        let x = bytemuck::cast::<Entry, f32x4>(*entry);
        (low, high) = (x.fast_min(low), x.fast_max(high));
    }
    [low, high].map(|x| Vec3::from_slice(&x.to_array()))
}

/// Brings the entries that are `below` before the others, and returns how many they are.
#[inline(always)]
pub(super) fn partition(entries: &mut [Entry], below: impl Fn(&Entry) -> bool) -> usize {
    let mut n = 0;
    for i in 0..entries.len() {
        // Both are written whether they change places or not: no branch to mispredict.
        let lower = below(&entries[i]);
        entries.swap(i, n);
        n += usize::from(lower);
    }
    n
}
