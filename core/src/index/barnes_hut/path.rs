//! The way from all points down to a group: what each box on it has gathered of far nodes.

use super::local::Series;
use core::ops::Range;

/// Boxes on the way, at most; from there on groups do on their own.
const LEVELS: usize = 12;
/// Nodes that boxes on the way leave to what is in them, at most; likewise.
const LEFT: usize = 1536;

/// The boxes that hold a group, from the largest on.
pub(super) struct Path {
    levels: heapless::Vec<Level, LEVELS>,
    /// Nodes that are not far from a box, or not from all in it, box by box.
    left: heapless::Vec<u32, LEFT>,
}

/// A box on the way.
struct Level {
    /// Its node, and all within.
    nodes: Range<usize>,
    /// Where the nodes that it leaves begin.
    first: usize,
    /// The series by which far nodes act in it.
    series: Series,
}

impl Path {
    /// One of so many nodes, the first of which is the root, which is far from nothing.
    pub(super) fn new(nodes: usize) -> Self {
        let mut path = Self { levels: heapless::Vec::new(), left: heapless::Vec::new() };
        let _ = path.levels.push(Level { nodes: 0..nodes, first: 0, series: Series::NONE });
        let _ = path.left.push(0);
        path
    }

    /// Goes back up to what holds a node.
    pub(super) fn leave(&mut self, node: usize) {
        while let Some(level) = self.levels.last()
            && !level.nodes.contains(&node)
        {
            self.left.truncate(level.first);
            self.levels.pop();
        }
    }

    /// The box last gone into.
    pub(super) fn node(&self) -> usize {
        self.levels.last().map_or(0, |level| level.nodes.start)
    }

    /// The series by which far nodes act in the box last gone into.
    pub(super) fn series(&self) -> &Series {
        self.levels.last().map_or(&Series::NONE, |level| &level.series)
    }

    /// Where the nodes are that it leaves.
    pub(super) fn nodes_left(&self) -> Range<usize> {
        self.levels.last().map_or(0, |level| level.first)..self.left.len()
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> usize {
        self.left[i] as usize
    }

    /// Leaves a node to what is in the box to be gone into; false if there is no room.
    #[inline(always)]
    pub(super) fn push(&mut self, node: usize) -> bool {
        self.left.push(node as u32).is_ok()
    }

    /// Tells whether there is no room for another box.
    pub(super) fn is_full(&self) -> bool {
        self.levels.is_full()
    }

    /// Forgets what has been left since.
    pub(super) fn truncate(&mut self, first: usize) {
        self.left.truncate(first);
    }

    /// Goes into a box, whose nodes left begin at a place.
    pub(super) fn enter(&mut self, nodes: Range<usize>, first: usize, series: Series) {
        let _ = self.levels.push(Level { nodes, first, series });
    }
}
