//! Rows that go through a step together, and what their paths are held against.

use super::lead::LeadCode;
use super::marks::MarkCode;
use super::path::Path;
use crate::force::{Attributes, Force};
use crate::material::{MaterialList, Mixing};
use crate::memory::{Layout, Past};
use crate::reap::PendingDeath;
use crate::rows::Extents;
use crate::shape::Collider;
use crate::time::Time;
use glam::Vec3;

/// The parts of a scene that paths are held against.
#[derive(Clone, Copy)]
pub(crate) struct Obstacles<'a> {
    pub(crate) colliders: &'a dyn Collider,
    pub(crate) sinks: &'a dyn Collider,
    pub(crate) materials: &'a dyn MaterialList,
    /// The forces that drive particles meanwhile.
    pub(crate) forces: &'a dyn Force,
    /// The function that mixes them, for straight paths, if there may be any.
    pub(crate) mixing: Option<Mixing>,
    /// How often a particle may bounce in one sub-step.
    pub(crate) max_bounces: u32,
    /// The code that leaves springs to their method along surfaces, if there are any.
    pub(crate) lead: Option<LeadCode>,
    /// The code that heeds what constraints have done, if there are any.
    pub(crate) marks: Option<MarkCode>,
}

/// Rows in the middle of a step.
pub(crate) struct Tile<'a> {
    pub(crate) obstacles: Obstacles<'a>,
    /// When the sub-step begins, and how long it takes.
    pub(crate) now: Time,
    pub(crate) dt: Time,
    /// The number of the first row.
    pub(crate) first: usize,
    /// The number of rows that there were before the step; those behind are newborn.
    pub(crate) old: usize,
    pub(crate) position: &'a mut [Vec3],
    pub(crate) velocity: &'a mut [Vec3],
    pub(crate) pending_death: &'a mut [PendingDeath],
    pub(crate) attributes: Attributes<'a>,
    /// Memory to work with, and how that is laid out.
    pub(crate) work: &'a mut [Vec3],
    pub(crate) layout: &'a Layout,
    /// True if any of them may come to the end of its life in the step.
    pub(crate) may_end: bool,
    /// How far the step has taken them, where that is known.
    pub(crate) reached: Option<Extents>,
}

impl Tile<'_> {
    /// When the sub-step ends.
    pub(crate) fn end(&self) -> Time {
        self.now + self.dt
    }

    /// A row's path through the sub-step.
    pub(super) fn path(&self, past: Past<'_>, row: usize) -> Path {
        let [x0, v0] = past.start;
        self.path_from(row, [x0[row], v0[row]])
    }

    /// The same from where it was, with the velocity that it had there.
    pub(super) fn path_from(&self, row: usize, [x0, v0]: [Vec3; 2]) -> Path {
        let (Tile { dt, attributes, .. }, end) = (self, self.end());
        // A newborn has come only part of the way.
        let start = end - (end - attributes.lives.born[row]).min(*dt);
        let (x1, v1) = (self.position[row], self.velocity[row]);
        Path { x0, v0, x1, v1, during: [start, end], pull: None }
    }

    /// Tells whether a row moves in the sub-step: it is not fixed, nor yet to be born, nor has it vanished.
    pub(super) fn is_under_way(&self, row: usize) -> bool {
        let Tile { old, now, dt, attributes, .. } = self;
        let is_still_to_come = row >= *old && attributes.lives.born[row] > *now + *dt;
        attributes.inverse_mass[row] != 0.0 && !is_still_to_come && self.pending_death[row] == PendingDeath::Lives
    }
}
