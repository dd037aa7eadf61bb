//! Forces over masses: what a method asks for accelerations.

use super::{Dynamics, Linear};
use crate::custom::CustomColumns;
use crate::force::{Attributes, Force, Inertia, Needs, State, Steady, Then};
use crate::index::{BarnesHut, ListMemory};
use crate::observe::{Observer, Phase};
use crate::report::Effort;
use crate::rows::each_row_with;
use crate::scene::Scene;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Inertia that look at all others for less than it takes to make an index and to look up all in it.
const FEW: usize = 64;

/// The scene's forces over the masses, from row `first` on.
pub(crate) struct Field<'a> {
    pub(crate) scene: &'a Scene<'a>,
    pub(crate) attributes: &'a Attributes<'a>,
    /// Columns of a user's own.
    pub(crate) custom: CustomColumns<'a>,
    /// The parts of the state that the forces need to find there, and memory for them.
    pub(crate) needs: Needs,
    pub(crate) tree: &'a mut [u32],
    pub(crate) near: &'a mut [u32],
    /// Lists of neighbours, where there is memory for them.
    pub(crate) lists: Option<ListMemory<'a>>,
    pub(crate) first: usize,
    pub(crate) effort: Effort,
    pub(crate) observer: &'a mut dyn Observer,
}

impl Field<'_> {
    /// Calls `then` with the state as forces see it, trees and index made.
    pub(crate) fn with_state(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: Then<'_>) {
        self.effort.evaluations += u64::from(!position.is_empty());
        let state = self.attributes.state(self.custom, time, [position, velocity]);
        match self.needs.mass_tree.or(self.needs.charge_tree) {
            Some(trees) if position.len() >= BarnesHut::FEWEST => (trees.0)(self, &state, then),
            _ => self.with_near(&state, then),
        }
    }

    /// Calls `then` with neighbours, where anybody asks for them.
    pub(crate) fn with_near(&mut self, state: &State<'_>, then: Then<'_>) {
        // A few newborn look at all others: an index would be made for them alone.
        let are_few = self.first > 0 && state.position.len() - self.first <= FEW;
        let looks = self.needs.reach > 0.0 && !are_few;
        match self.needs.lists.filter(|_| looks) {
            Some(lists) => (lists.0)(self, state, then),
            None => {
                self.effort.all_pairs += u64::from(looks);
                then(state);
            }
        }
    }
}

impl<'a> Field<'a> {
    /// What one pass over the columns works out, if the forces are no more, and the columns for it.
    fn steady(&self, len: usize) -> Option<(Steady, Inertia<'a>)> {
        Some((self.scene.steady()?, self.attributes.inertia(self.first..len)))
    }
}

impl Dynamics for Field<'_> {
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]) {
        let rows = self.first..position.len();
        let (forces, inverse_mass) = (self.scene.forces, &self.attributes.inverse_mass[rows.clone()]);
        if let Some((steady, columns)) = self.steady(position.len()) {
            self.effort.evaluations += u64::from(!position.is_empty());
            return steady.accelerate(columns, &velocity[rows], acceleration);
        }
        self.with_state(time, position, velocity, &mut |state| add_all(forces, state, rows.clone(), acceleration));
        divide_by_masses(acceleration, inverse_mass);
    }

    fn linearise(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: &mut dyn FnMut(&Linear<'_>)) {
        let (forces, inverse_mass) = (self.scene.forces, &self.attributes.inverse_mass[..position.len()]);
        self.with_state(time, position, velocity, &mut |state| then(&Linear::about(state, forces, inverse_mass)));
    }

    fn reached(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3]) {
        let state = self.attributes.state(self.custom, time, [position, velocity]);
        self.observer.after(Phase::Advance, &state);
    }
}

/// Makes accelerations of forces. Apart, so that compilers know that the columns are two, and make vectors of them.
#[inline(never)]
fn divide_by_masses(forces: &mut [Vec3], inverse_mass: &[f32]) {
    each_row_with(forces, Vec3::ZERO, inverse_mass, |force, _, inverse| {
        // A fixed particle stays so under a force that is beyond an f32.
        if inverse == 0.0 { 0.0 } else { force * inverse }
    });
}

/// The forces on some rows, those of springs behind the others.
#[cfg_attr(target_os = "none", inline(never))]
fn add_all(forces: &dyn Force, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
    total.fill(Vec3::ZERO);
    add_up(forces, state, rows.clone(), total);
    if let Some(springs) = state.springs.force() {
        add_up(springs, state, rows, total);
    }
}

/// Inertia that are worth a thread's while.
#[cfg(feature = "rayon")]
const SHARE: usize = 2048;

/// Adds the forces on some rows, on all threads of the pool that this one belongs to, each with its share of the rows.
fn add_up(forces: &dyn Force, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
    #[cfg(feature = "rayon")]
    if rayon::current_thread_index().is_some() && can_be_divided(state) && rows.len() >= 2 * SHARE {
        return add_up_side_by_side(forces, state, rows, total, rayon::current_num_threads());
    }
    forces.add_to(state, rows, total);
}

/// Tells whether a part of the rows costs no more than its share: trees divide themselves, and an index would be asked
/// for all.
#[cfg(feature = "rayon")]
fn can_be_divided(state: &State<'_>) -> bool {
    state.near.can_be_divided() && state.mass_tree.is_none() && state.charge_tree.is_none()
}

/// The same by so many threads.
#[cfg(feature = "rayon")]
fn add_up_side_by_side(forces: &dyn Force, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3], threads: usize) {
    let parts = threads.min(rows.len() / SHARE);
    if parts < 2 {
        return forces.add_to(state, rows, total);
    }
    let len = rows.len() * (parts / 2) / parts;
    let (front, back) = total.split_at_mut(len);
    let middle = rows.start + len;
    rayon::join(
        || add_up_side_by_side(forces, state, rows.start..middle, front, parts / 2),
        || add_up_side_by_side(forces, state, middle..rows.end, back, parts - parts / 2),
    );
}
