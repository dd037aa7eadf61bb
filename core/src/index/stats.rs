//! How large indices are, and how much work they take.

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

/// What an index knows beside what lies in its memory, in words of its own: see [`SpatialIndex::take_up`](super::SpatialIndex::take_up).
pub type Facts = [u32; 25];
