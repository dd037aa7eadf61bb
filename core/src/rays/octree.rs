//! The octree: cubes cut into eighths, and the pieces with them.

use super::entries::Entries;
use super::split::{Part, Split};
use crate::math::max;
use crate::shape::Aabb;

/// An octree (Meagher 1982): three cuts through the middle of a cube make the eight children of its node. Pieces that
/// reach into several of them are listed in each, with what is left of their boxes there.
pub(super) struct Eighths;

impl Split for Eighths {
    const CUTS: bool = true;
    const LEAF: usize = 16;
    const ROUNDS: u32 = 3;
    /// The cube, or what the cuts since have left of it.
    type Cell = Aabb;

    fn root(&self, bounds: &Aabb) -> Aabb {
        let half = (bounds.max * 0.5 - bounds.min * 0.5) * 1.000_001;
        let half = max(half.x, max(half.y, half.z));
        let middle = bounds.max * 0.5 + bounds.min * 0.5;
        Aabb { min: middle - half, max: middle + half }
    }

    fn cut(&self, part: &Part<Aabb>, entries: &mut Entries<'_>, _: f32) -> Option<[Part<Aabb>; 2]> {
        let (axis, cell) = (part.cuts as usize % 3, part.cell);
        let plane = 0.5 * cell.min[axis] + 0.5 * cell.max[axis];
        let [below, above] = entries.sides(part.range.clone(), axis, plane);
        // Where more than half would be listed twice, cubes are smaller than pieces.
        if !(cell.min[axis] < plane && plane < cell.max[axis]) || 2 * (below + above) > 3 * part.range.len() {
            return None;
        }
        let cut = entries.cut(part.range.clone(), axis, plane)?;
        let half = |range, max: bool| {
            let mut cell = cell;
            if max {
                cell.min[axis] = plane;
            } else {
                cell.max[axis] = plane;
            }
            Part::new(range, cell, part.cuts + 1, entries)
        };
        let [below, above] = cut;
        Some([half(below, false), half(above, true)])
    }
}
