//! Workloads are what is measured.

use clap::ValueEnum;
use serde::Serialize;

/// A workload that is measured: building, or what is asked of a structure once it is built: of points from `Count` on, of a mesh from
/// `Short` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Workload {
    /// Sorting the points or triangles in
    #[value(skip)]
    Build,
    /// Following the points after all have moved a little
    #[value(skip)]
    Refit,
    /// How many others every point has within the radius
    Count,
    /// Which others every point has within the radius
    Within,
    /// The nearest others of every point
    Nearest,
    /// Every two points within the radius of each other, once
    Pairs,
    /// Following points that moved a little, and counting: a step of a simulation
    Moving,
    /// Which triangle of a mesh a segment hits first: short, sorted and long segments, and short ones of balls
    Ray,
    /// First hits of short segments: steps of particles near the surface
    #[value(skip)]
    Short,
    /// First hits of the same in an order in which neighbours follow each other
    #[value(skip)]
    Sorted,
    /// First hits of segments across the whole mesh
    #[value(skip)]
    Long,
    /// First hits of the short segments by balls
    #[value(skip)]
    Balls,
}

impl Workload {
    /// The queries of points if nobody says.
    pub const OF_POINTS: [Self; 5] = [Self::Count, Self::Within, Self::Nearest, Self::Pairs, Self::Moving];

    /// All that is asked of a mesh.
    pub const OF_MESHES: [Self; 4] = [Self::Short, Self::Sorted, Self::Long, Self::Balls];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.told()[0]
    }

    /// Its description for those who read a report.
    #[must_use]
    pub fn describe(self) -> &'static str {
        self.told()[1]
    }

    fn told(self) -> [&'static str; 2] {
        match self {
            Self::Build => ["build", "sort everything in"],
            Self::Refit => ["refit", "follow all points after a small move"],
            Self::Count => ["count", "count the others within the radius of every point"],
            Self::Within => ["within", "list the others within the radius of every point"],
            Self::Nearest => ["nearest", "find the nearest others of every point"],
            Self::Pairs => ["pairs", "visit every two points within the radius of each other once"],
            Self::Moving => ["moving", "follow all points after a small move, then count: a step of a simulation"],
            Self::Ray => ["ray", "find the first triangle that segments hit"],
            Self::Short => ["short", "find the first triangle that steps near the surface hit, in no order"],
            Self::Sorted => ["sorted", "the same steps, in the order of a Morton curve through their beginnings"],
            Self::Long => ["long", "find the first triangle that segments across the whole mesh hit"],
            Self::Balls => ["balls", "the short steps in no order, of balls instead of points"],
        }
    }

    /// Whether it asks something of a structure that has been built.
    #[must_use]
    pub fn is_query(self) -> bool {
        !matches!(self, Self::Build | Self::Refit)
    }
}
