//! Which points are near: one trait, eight ways to organise space, the same answers from all.
//!
//! An index sorts a copy of the points so that what is near in space is near in memory, and answers from that copy. It
//! lives in a slice of words that the caller lends it, allocates nothing, and takes no more points than the slice has
//! room for. Every answer is exact: two points are within `radius` of each other if, in `f32`,
//! `dx² + dy² + dz² ≤ radius²`, added in this order, whichever structure is asked, so that all give the same. Points
//! whose coordinates are all below 1e-9 or some above 1e18 are scaled by a power of two first, so that their squares fit;
//! one point so far off makes all distances below 1e-19 of its own count as zero.
//!
//! In a periodic box a radius of half its shortest side and more looks at every point.
//!
//! ```
//! use pointmass::Vec3;
//! use pointmass::index::{Grid, SpatialIndex, Structure};
//!
//! let points = [Vec3::ZERO, Vec3::X, Vec3::new(0.1, 0.0, 0.0)];
//! let mut memory = [0; Structure::Grid.words(3)];
//! let mut grid = Grid::new(&mut memory);
//! grid.build(&points, 0.5)?;
//! let mut pairs = Vec::new();
//! grid.pairs(0.5, &mut |row, others| pairs.extend(others.iter().map(|&other| (row.min(other), row.max(other)))));
//! assert_eq!(pairs, [(0, 2)]);
//! # Ok::<(), pointmass::index::TooSmall>(())
//! ```
//!
//! Whatever works through all points (`counts`, `neighbours`, `pairs`, `all_nearest`) is several times faster than as many
//! single queries, since near points share their way through the structure.

mod barnes_hut;
mod brute;
mod bsp;
mod bvh;
mod cells;
mod choice;
mod domain;
mod frames;
mod grid;
mod hash;
mod kd;
mod listing;
mod lists;
mod near;
mod nearby;
mod nearest;
mod neighbours;
mod octree;
mod ordered;
mod partition;
mod region;
mod room;
mod search;
mod sorted;
mod split;
mod structure;
mod tree;

#[cfg(feature = "std")]
pub use barnes_hut::FieldError;
pub use barnes_hut::{BarnesHut, Opening};
pub use brute::Brute;
pub use bsp::Bsp;
pub(crate) use bsp::principal_axes;
pub use bvh::Bvh;
pub use choice::{InGrid, InKd, IndexChoice, Periodic};
pub use grid::Grid;
pub use hash::Hash;
pub use kd::Kd;
pub(crate) use listing::{Found, Search, find};
pub(crate) use lists::{ListMemory, Listed};
pub use nearby::Nearby;
pub use nearest::Neighbour;
pub use neighbours::Neighbours;
pub use octree::{Octree, Quadtree};
pub use room::Room;
pub(crate) use room::{between, image_beside, wrapped_in};
pub use structure::{AnyIndex, Structure, UnknownStructure};
pub use tree::Tree;

use core::ops::Range;
use glam::Vec3;

/// Points sorted in space, to be asked what is near.
///
/// Rows are the positions of points in the slice the index was built from. Rows that are not finite are left out and
/// counted in [`Stats::skipped`]. A negative or undefined radius finds nothing.
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

/// The work that a query took: the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes or rows of cells that were looked at.
    pub visits: u64,
    /// Distances between points that were computed.
    pub tests: u64,
    /// Points found, or pairs, or neighbours over all rows.
    pub found: u64,
}

impl core::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.visits += other.visits;
        self.tests += other.tests;
        self.found += other.found;
    }
}

/// The size of an index that has been built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Points in it.
    pub points: usize,
    /// Rows left out because they are not finite.
    pub skipped: usize,
    /// Nodes or cells.
    pub nodes: usize,
    /// Levels below the root.
    pub depth: usize,
    /// The most points in a leaf or cell.
    pub fullest: usize,
    /// Leaves larger than they should be, or how many times cells had to grow by a quarter, for want of memory.
    pub crowded: usize,
    /// Bytes in use, the copy of the points and what building takes among them.
    pub bytes: usize,
}

/// The memory of an index is too small for the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooSmall {
    /// Points that were to be sorted in.
    pub points: usize,
    /// Points that there is room for.
    pub room: usize,
}

impl core::fmt::Display for TooSmall {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "the index has room for {} points, not for {}", self.room, self.points)
    }
}

impl core::error::Error for TooSmall {}

/// Makes an index in open space or in a periodic box, by its `in_domain`.
macro_rules! constructors {
    () => {
        /// An empty one in so much memory, see [`Structure::words`](super::Structure::words).
        #[must_use]
        pub fn new(memory: &'m mut [u32]) -> Self {
            Self::in_domain(memory, Domain::OPEN)
        }

        /// An empty one in a box from `low` on with these sides \[m\], whose opposite faces are one. Sides that are zero
        /// are open; points outside are wrapped in.
        #[must_use]
        pub fn periodic(memory: &'m mut [u32], low: Vec3, sides: Vec3) -> Self {
            Self::in_domain(memory, Domain::of(crate::index::Room::new(low, sides)))
        }

        /// An empty one in a room, or in all of space.
        #[must_use]
        pub fn in_room(memory: &'m mut [u32], room: Option<&crate::index::Room>) -> Self {
            Self::in_domain(memory, room.map_or(Domain::OPEN, |room| Domain::of(*room)))
        }
    };
}
use constructors;

/// Answers a trait's queries by a partition.
macro_rules! answers {
    () => {
        fn order(&self) -> &[u32] {
            self.sorted().order()
        }
        fn parts(&self, visit: &mut dyn FnMut(core::ops::Range<usize>)) {
            self.groups(&mut |slots: core::ops::Range<usize>, _| visit(slots));
        }
        fn count(&self, center: Vec3, radius: f32) -> Cost {
            Search(self).count(center, radius)
        }
        fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
            Search(self).within(center, radius, visit)
        }
        fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
            Search(self).nearest(center, radius, found)
        }
        fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
            Search(self).counts(radius, counts)
        }
        fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
            Search(self).neighbours(radius, visit)
        }
        fn in_order(&self, places: core::ops::Range<usize>, radius: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
            // A chip has no room for lists, nor on its stack for what it takes to make them.
            !cfg!(target_os = "none") && Search(self).in_order(places, radius, visit)
        }
        fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
            Search(self).pairs(radius, visit)
        }
        fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost {
            Search(self).all_nearest(radius, found, visit)
        }
    };
}
use answers;
