//! The structures by name.

use super::cells;
use super::sorted::Sorted;
use super::{
    Brute, Bsp, Bvh, Cost, Facts, Grid, Hash, Kd, Neighbour, Octree, Quadtree, Room, SpatialIndex, Stats, TooSmall,
};
use crate::named::by_name;
use core::ops::Range;
use glam::Vec3;

/// Declares the structures that have a name.
macro_rules! structures {
    ($($(#[$doc:meta])* $structure:ident = $name:literal, $words:expr;)+) => {
        /// A structure by its name, as files and the command line say it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum Structure {
            $($(#[$doc])* #[cfg_attr(feature = "serde", serde(rename = $name))] $structure,)+
        }

        impl Structure {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$structure),+];

            /// Its name.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$structure => $name,)+ }
            }

            /// Words of memory, four bytes each, that it takes for so many points; `usize::MAX` where it takes more.
            #[must_use]
            pub const fn words(self, points: usize) -> usize {
                match self { $(Self::$structure => $words(points),)+ }
            }

            /// An empty index in so much memory.
            #[must_use]
            pub fn index(self, memory: &mut [u32]) -> AnyIndex<'_> {
                self.in_room(memory, None)
            }

            /// An empty index of a box from `low` on with these sides \[m\], whose opposite faces are one.
            #[must_use]
            pub fn periodic(self, memory: &mut [u32], low: Vec3, sides: Vec3) -> AnyIndex<'_> {
                self.in_room(memory, Some(&Room::new(low, sides)))
            }

            /// An empty index of a room, or of all of space.
            #[must_use]
            pub fn in_room<'m>(self, memory: &'m mut [u32], room: Option<&Room>) -> AnyIndex<'m> {
                match self { $(Self::$structure => AnyIndex::$structure($structure::in_room(memory, room)),)+ }
            }
        }

        /// An index whose structure is chosen at run time.
        #[derive(Debug)]
        pub enum AnyIndex<'m> {
            $($(#[$doc])* $structure($structure<'m>),)+
        }

        impl<'m> AnyIndex<'m> {
            fn get(&self) -> &dyn SpatialIndex {
                match self { $(Self::$structure(index) => index,)+ }
            }
            fn get_mut(&mut self) -> &mut (dyn SpatialIndex + 'm) {
                match self { $(Self::$structure(index) => index,)+ }
            }
        }
    };
}

structures! {
    /// No structure: every point is looked at.
    Brute = "brute", Sorted::words;
    /// Cells of one size in a bounded box.
    Grid = "grid", cells::words;
    /// Cells of one size in all of space.
    Hash = "hash", cells::words;
    /// Squares cut into quarters, for planar data.
    Quadtree = "quadtree", Quadtree::words;
    /// Cubes cut into eighths.
    Octree = "octree", Octree::words;
    /// Boxes halved across their longest side.
    Kd = "kd", Kd::words;
    /// Parts cut by planes of any orientation.
    Bsp = "bsp", Bsp::words;
    /// Boxes cut where their parts become small.
    Bvh = "bvh", Bvh::words;
}

impl SpatialIndex for AnyIndex<'_> {
    fn build(&mut self, points: &[Vec3], reach: f32) -> Result<(), TooSmall> {
        self.get_mut().build(points, reach)
    }
    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.get_mut().refit(points)
    }
    fn facts(&self) -> Option<Facts> {
        self.get().facts()
    }
    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        self.get_mut().take_up(facts, points, row_of)
    }
    fn stats(&self) -> Stats {
        self.get().stats()
    }
    fn order(&self) -> &[u32] {
        self.get().order()
    }
    fn parts(&self, visit: &mut dyn FnMut(Range<usize>)) {
        self.get().parts(visit);
    }
    fn count(&self, center: Vec3, radius: f32) -> Cost {
        self.get().count(center, radius)
    }
    fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
        self.get().within(center, radius, visit)
    }
    fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
        self.get().nearest(center, radius, found)
    }
    fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
        self.get().counts(radius, counts)
    }
    fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        self.get().neighbours(radius, visit)
    }
    fn in_order(&self, places: Range<usize>, radius: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
        self.get().in_order(places, radius, visit)
    }
    fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        self.get().pairs(radius, visit)
    }
    fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost {
        self.get().all_nearest(radius, found, visit)
    }
}

by_name!(Structure, UnknownStructure, "structure");
