//! The octree, and for planar data the quadtree: every cube is cut into halves along all of its axes.

use super::frames::Frames;
use super::sorted::Entry;
use super::split::{CHILDREN, Split, partition};
use super::tree::Tree;
use crate::math::max;
use glam::Vec3;

/// An octree (Meagher 1980). Its cells are cubes, which is what sums over far groups want.
pub type Octree<'m> = Tree<'m, Cubes<3>>;

/// A quadtree (Finkel and Bentley 1974) over the two axes along which the points extend most.
pub type Quadtree<'m> = Tree<'m, Cubes<2>>;

/// Splits cubes at their centres along some of the axes.
#[derive(Clone, Copy, Debug)]
pub struct Cubes<const AXES: usize> {
    axes: [usize; AXES],
}

impl<const AXES: usize> Default for Cubes<AXES> {
    fn default() -> Self {
        Self { axes: core::array::from_fn(|axis| axis) }
    }
}

/// A cube.
#[derive(Clone, Copy, Debug)]
pub struct Cube {
    low: Vec3,
    half: f32,
}

impl Cube {
    fn middle(&self, axis: usize) -> f32 {
        self.low[axis] + self.half
    }

    /// One of the parts it is cut into.
    fn part(&self, axis: usize, upper: bool) -> Self {
        let mut low = self.low;
        if upper {
            low[axis] = self.middle(axis);
        }
        Self { low, half: self.half }
    }
}

impl<const AXES: usize> Split for Cubes<AXES> {
    const LEAF: usize = 32;
    const BYTES: usize = 8;
    type Cell = Cube;

    fn root(&mut self, low: Vec3, high: Vec3) -> Cube {
        let sides = (high - low).to_array();
        let mut axes = [0, 1, 2];
        axes.sort_unstable_by(|&a, &b| sides[b].total_cmp(&sides[a]).then(a.cmp(&b)));
        self.axes.copy_from_slice(&axes[..AXES]);
        self.axes.sort_unstable();
        Cube { low, half: 0.5 * max(sides[0], max(sides[1], sides[2])) }
    }

    fn split(
        &self,
        mut cube: Cube,
        [low, high]: [Vec3; 2],
        entries: &mut [Entry],
        _: &Frames<'_>,
        children: &mut heapless::Vec<(usize, Cube), CHILDREN>,
    ) {
        // Down to where the points part.
        while self.axes.iter().all(|&axis| (low[axis] >= cube.middle(axis)) == (high[axis] >= cube.middle(axis))) {
            if !(cube.half > 0.0) {
                return;
            }
            for axis in self.axes {
                cube = cube.part(axis, low[axis] >= cube.middle(axis));
            }
            cube.half *= 0.5;
        }
        self.halve(cube, AXES, 0, entries, children);
    }
}

impl<const AXES: usize> Cubes<AXES> {
    /// Cuts along the last axis, each half along the one before, and so on; `first` entries come before these.
    fn halve(
        &self,
        cube: Cube,
        axes: usize,
        first: usize,
        entries: &mut [Entry],
        children: &mut heapless::Vec<(usize, Cube), CHILDREN>,
    ) {
        if entries.is_empty() {
            return;
        }
        let Some(axes) = axes.checked_sub(1) else {
            let _ = children.push((first + entries.len(), Cube { half: 0.5 * cube.half, ..cube }));
            return;
        };
        let (axis, middle) = (self.axes[axes], cube.middle(self.axes[axes]));
        let n = partition(entries, |entry| entry.x[axis] < middle);
        let (below, above) = entries.split_at_mut(n);
        self.halve(cube.part(axis, false), axes, first, below, children);
        self.halve(cube.part(axis, true), axes, first + n, above, children);
    }
}
