//! How large structures are, and how much work they take.

/// The work that a query took: the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Nodes or cells that were looked at.
    pub visits: u64,
    /// Pieces whose own box the path meets, and which were therefore asked.
    pub tests: u64,
}

impl core::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.visits += other.visits;
        self.tests += other.tests;
    }
}

/// The size of a structure that has been built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Pieces in it.
    pub pieces: usize,
    /// Pieces left out because their boxes are not finite: nothing hits them.
    pub skipped: usize,
    /// How often pieces are listed: more than once each where cells cut them.
    pub references: usize,
    /// Nodes or cells.
    pub nodes: usize,
    /// Levels below the root.
    pub depth: usize,
    /// The most pieces in a leaf or cell.
    pub fullest: usize,
    /// Leaves larger than they should be, or how many times cells had to grow by a quarter, for want of memory.
    pub crowded: usize,
    /// Bytes in use once it is built; building takes more, see [`Structure::words`](super::Structure::words).
    pub bytes: usize,
}

/// The memory is too small for so many pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooSmall {
    /// Words that were lent.
    pub words: usize,
    /// Words that are needed at least.
    pub needed: usize,
}

impl core::fmt::Display for TooSmall {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "the index needs at least {} words of memory, not {}", self.needed, self.words)
    }
}

impl core::error::Error for TooSmall {}
