//! Progress of a comparison.

use crate::progress::Progress;

/// Progress of the whole comparison; a unit of work is a point that an entrant goes through once.
pub(crate) struct Gauge {
    progress: Progress,
    /// Units of the cases after this one.
    ahead: u64,
    /// The case that is measured.
    pub(crate) title: String,
}

impl Gauge {
    /// A gauge of so much work.
    pub(crate) fn new(ahead: u64) -> Self {
        Self { progress: Progress::of_work(ahead), ahead, title: String::new() }
    }

    /// A case begins, of which so much was expected.
    pub(crate) fn begin(&mut self, title: String, expected: u64) {
        self.title = title;
        self.ahead = self.ahead.saturating_sub(expected);
    }

    /// So many units further, and so many left in this case.
    pub(crate) fn step(&mut self, units: u64, left: u64, doing: &str) {
        self.progress.work(units, left + self.ahead, &format!("{}: {doing}", self.title));
    }
}
