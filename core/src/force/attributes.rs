//! The attributes of particles besides places and velocities, as a step hands them to forces and constraints.

use super::{Inertia, State};
use crate::custom::CustomColumns;
use crate::memory::InCommon;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// The attributes of particles besides places and velocities: one entry a row.
#[derive(Clone, Copy)]
pub(crate) struct Attributes<'a> {
    /// All that forces see of them.
    pub(crate) lives: State<'a>,
    pub(crate) inverse_mass: &'a [f32],
    pub(crate) elasticity: &'a [f32],
    /// What all are known to have in common.
    pub(crate) common: &'a InCommon,
}

impl<'a> Attributes<'a> {
    /// The first rows somewhere, at some time, with columns of a user's own.
    pub(crate) fn state<'s>(&self, custom: CustomColumns<'s>, time: Time, [x, v]: [&'s [Vec3]; 2]) -> State<'s>
    where
        'a: 's,
    {
        self.lives.moved_with(custom, time, [x, v])
    }

    /// Columns of a user's own as they are now: where constraints may change them, those that are lent for it.
    pub(crate) fn custom<'s>(&self, kept: &'s [u32], capacity: usize) -> CustomColumns<'s>
    where
        'a: 's,
    {
        let custom = self.lives.custom;
        if kept.is_empty() { custom } else { CustomColumns::kept(custom.list(), kept, capacity, capacity) }
    }

    /// The columns that tell how some rows fall.
    pub(crate) fn inertia(&self, rows: Range<usize>) -> Inertia<'a> {
        let Self { lives, inverse_mass, common, .. } = *self;
        let [mass, drag, inverse_mass] = [lives.mass, lives.drag, inverse_mass].map(|column| &column[rows.clone()]);
        Inertia { mass, drag, inverse_mass, common: common.inertia() }
    }

    /// Those of some rows.
    pub(crate) fn rows(&self, rows: Range<usize>) -> Self {
        Self {
            inverse_mass: &self.inverse_mass[rows.clone()],
            elasticity: &self.elasticity[rows.clone()],
            lives: self.lives.attributes_of(rows),
            common: self.common,
        }
    }
}
