//! The trait of all indices.

use super::{Cost, Facts, Neighbour, Stats, TooSmall};
use core::ops::Range;
use glam::Vec3;

/// Points sorted in space, to be asked what is near.
///
/// Rows are the positions of points in the slice the index was built from. Rows that are not finite are left out and
/// counted in [`Stats::skipped`]. A negative or undefined radius finds nothing.
///
/// Every row that an index hands out, and every place in [`order`](Self::order), has to be below `points.len()` of the last `build` or `refit`. Steps
/// pass over rows that there are not; what else they make of an index that is wrong about who is near is bounded, but nothing is counted.
pub trait SpatialIndex: Sync {
    /// Sorts `points` in. `reach` \[m\] is the radius that most queries will have; grids make their cells as large,
    /// trees do not need it. Zero: choose by the density.
    ///
    /// # Errors
    /// If the memory is too small for so many points; the index is then empty.
    fn build(&mut self, points: &[Vec3], reach: f32) -> Result<(), TooSmall>;

    /// Follows the same points to where they are now: cheaper than building where the structure allows it, as exact,
    /// and slower to ask the farther they have gone. Another number of sound points makes it build.
    ///
    /// # Errors
    /// As `build`.
    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall>;

    /// What it knows beside what lies in its memory; nothing, the default, if it cannot be taken up again.
    fn facts(&self) -> Option<Facts> {
        None
    }

    /// Goes on with the index of these [`facts`](Self::facts) that has been built, by the same structure, in the same memory, which nobody has written to
    /// since. Each of its points becomes that of the row of `points` which `row_of` finds for its row, two never the same; those for which
    /// it finds none, or a point that is not finite, are struck out. Tells whether the index is then one of `points`, where they are, all of them: else it
    /// is good for nothing until it is built.
    ///
    /// An index need not be able to: then particles are sorted in anew by all who ask who is near.
    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        let _ = (facts, points, row_of);
        false
    }

    /// Tells how large the structure has become.
    fn stats(&self) -> Stats;

    /// The rows of all points in the structure's order: near in space is near in this list. Work in this order is kind
    /// to caches.
    fn order(&self) -> &[u32];

    /// Visits the parts into which space is divided, cells or leaves, as ranges of places of [`SpatialIndex::order`], each place in one of
    /// them. All points are one part where an index does not say.
    fn parts(&self, visit: &mut dyn FnMut(Range<usize>)) {
        visit(0..self.order().len());
    }

    /// Counts the points within `radius` of `center`.
    fn count(&self, center: Vec3, radius: f32) -> Cost;

    /// Visits all rows within `radius` of `center`, in runs.
    fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost;

    /// Finds the `found.len()` points nearest to `center` that lie within `radius` (infinite: no limit), the nearest
    /// first, of equally near ones the lower row. [`Cost::found`] says how many there are.
    fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost;

    /// Counts for every row the others within `radius`, into `counts` by row; rows without a sound point get zero.
    fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost;

    /// Visits every row with the others within `radius`, in runs; all runs of a row follow each other, and rows come
    /// in the structure's order. Rows without neighbours are not visited.
    fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost;

    /// Visits the points at some places of [`SpatialIndex::order`], each once and in this order, with the places of all others within
    /// `radius` in ascending order of their rows; true if all have been visited. Lists of neighbours are made of that, where there are threads by
    /// several at once.
    ///
    /// An index need not be able to, nor to the end: the built-in ones are not where a point has more than a thousand, nor beyond
    /// half of a periodic box, nor on chips. Then neighbours are looked up anew whenever they are asked for.
    fn in_order(&self, places: Range<usize>, radius: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
        let _ = (places, radius, visit);
        false
    }

    /// Visits every two rows within `radius` of each other once: a row with a run of others.
    fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost;

    /// Visits every row with its nearest others, as many as `found` has room for, within `radius`, as `nearest` does.
    fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost;
}
