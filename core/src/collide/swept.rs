//! A sub-step's sweep, as it is handed to whatever answers the meetings.

use super::paths::Paths;
use super::tile::Tile;
use crate::index::IndexChoice;
use crate::observe::Observer;
use crate::report::Report;

/// A sub-step whose particles have been moved and are now to be held against colliders, sinks and each other.
pub(crate) struct Swept<'p, 't> {
    /// All rows.
    pub(crate) tile: &'p mut Tile<'t>,
    /// How those go that meet no others.
    pub(crate) paths: Paths,
    /// The index by which those are found who may meet.
    pub(crate) index: &'p dyn IndexChoice,
    pub(crate) report: &'p mut Report,
    pub(crate) observer: &'p mut dyn Observer,
}

impl Swept<'_, '_> {
    /// Sends all past each other.
    #[inline(never)]
    pub(super) fn each_by_itself(self) {
        self.paths.follow(self.tile, self.report, self.observer);
    }
}
