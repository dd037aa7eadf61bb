//! What is measured.

use clap::ValueEnum;
use serde::Serialize;

/// What is measured: building, or what is asked of a structure once it is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Workload {
    /// Sorting the points in
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
}

impl Workload {
    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Build => "build",
            Self::Refit => "refit",
            Self::Count => "count",
            Self::Within => "within",
            Self::Nearest => "nearest",
            Self::Pairs => "pairs",
            Self::Moving => "moving",
        }
    }

    /// What it is, for those who read a report.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Build => "sort all points in",
            Self::Refit => "follow all points after a small move",
            Self::Count => "count the others within the radius of every point",
            Self::Within => "list the others within the radius of every point",
            Self::Nearest => "find the nearest others of every point",
            Self::Pairs => "visit every two points within the radius of each other once",
            Self::Moving => "follow all points after a small move, then count: a step of a simulation",
        }
    }

    /// Whether it asks something of a structure that has been built.
    #[must_use]
    pub fn is_query(self) -> bool {
        !matches!(self, Self::Build | Self::Refit)
    }
}
