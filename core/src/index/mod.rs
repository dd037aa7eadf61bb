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
mod facts;
mod frames;
mod grid;
mod hash;
mod kd;
mod listing;
mod lists;
mod making;
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
mod spatial_index;
mod split;
mod state_index;
mod stats;
mod structure;
#[cfg(feature = "rayon")]
mod threads;
mod tree;

#[cfg(feature = "std")]
pub use barnes_hut::FieldError;
pub use barnes_hut::{BarnesHut, Opening};
pub use brute::Brute;
pub use bsp::Bsp;
pub(crate) use bsp::principal_axes;
pub use bvh::Bvh;
pub use choice::{InGrid, InKd, IndexChoice, Periodic};
pub(crate) use facts::ARE_KEPT;
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
pub use spatial_index::SpatialIndex;
pub(crate) use state_index::{Lasting, StateIndex, index_words};
pub use stats::{Cost, Facts, Stats, TooSmall};
pub use structure::{AnyIndex, Structure, UnknownStructure};
pub use tree::Tree;
