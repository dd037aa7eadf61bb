//! A sub-step's sweep, as it is handed to whatever answers the meetings.

use super::tile_sweep::each_by_itself;
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::step::Workspace;
use crate::time::Time;

/// A sub-step whose particles have been moved and are now to be held against colliders, sinks and each other.
pub(crate) struct Passage<'p, 'v> {
    pub(crate) workspace: &'p mut Workspace<'v>,
    pub(crate) scene: &'p Scene<'p>,
    /// Those from this row on are newborn.
    pub(crate) old: usize,
    /// When it began, and how long it takes.
    pub(crate) now: Time,
    pub(crate) dt: Time,
    pub(crate) report: &'p mut Report,
    pub(crate) observer: &'p mut dyn Observer,
}

impl Passage<'_, '_> {
    /// Sends all past each other.
    #[inline(never)]
    pub(super) fn each_by_itself(self) {
        let Self { workspace, scene, old, now, dt, report, observer } = self;
        let (rows, capacity) = (0..workspace.len(), workspace.capacity());
        each_by_itself(&mut workspace.tile(scene, [now, dt], old, rows, capacity), report, observer);
    }
}
