//! Forces over masses: what a method asks for accelerations.

use super::{Dynamics, Linear, Linearising, Now};
#[cfg(feature = "rayon")]
use crate::division::Division;
use crate::force::{Finder, Force, SpringForce, State, Steady};
use crate::observe::{Observer, Phase};
use crate::rows::{BLOCKS, scale_each};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// The scene's forces over the masses.
pub(crate) struct Field<'a> {
    pub(crate) forces: &'a dyn Force,
    /// The sum of its springs, if there may be any.
    pub(crate) springs: Option<SpringForce>,
    /// All of that as one pass over the columns works it out, if it is no more.
    pub(crate) steady: Option<Steady>,
    /// The particles, from a row on, and what the forces need to find in their state.
    pub(crate) finder: Finder<'a>,
    pub(crate) observer: &'a mut dyn Observer,
    pub(crate) linearising: Option<Linearising>,
}

impl Dynamics for Field<'_> {
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]) {
        let Self { forces, springs, ref mut finder, .. } = *self;
        let (attributes, rows) = (finder.attributes, finder.first..position.len());
        if let Some(steady) = self.steady.filter(|_| BLOCKS) {
            finder.finding.evaluations += u32::from(!position.is_empty());
            return steady.accelerate(attributes.inertia(rows.clone()), &velocity[rows], acceleration);
        }
        let inverse_mass = &attributes.inverse_mass[rows.clone()];
        finder.with_state(time, position, velocity, &mut |state| {
            add_side_by_side(forces, springs, state, rows.clone(), acceleration);
        });
        divide_by_masses(acceleration, inverse_mass);
    }

    fn linearise(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: &mut dyn FnMut(&Linear<'_>)) {
        let Self { forces, springs, ref mut finder, linearising, .. } = *self;
        if let Some(code) = linearising {
            (code.0)(finder, forces, springs, Now { time, position, velocity }, then);
        }
    }

    fn reached(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3]) {
        let state = self.finder.attributes.state(self.finder.custom, time, [position, velocity]);
        self.observer.after(Phase::Advance, &state);
    }
}

/// Makes accelerations of forces. Apart, so that compilers know that the columns are two, and make vectors of them.
#[inline(never)]
fn divide_by_masses(forces: &mut [Vec3], inverse_mass: &[f32]) {
    // A fixed particle stays so under a force that is beyond an f32.
    scale_each(forces, inverse_mass);
}

/// The forces on some rows, those of springs behind the others.
#[cfg_attr(one_by_one, inline(never))]
fn add_all(
    forces: &dyn Force,
    springs: Option<SpringForce>,
    state: &State<'_>,
    rows: Range<usize>,
    total: &mut [Vec3],
) {
    total.fill(Vec3::ZERO);
    forces.add_to(state, rows.clone(), total);
    if let Some(force) = springs {
        force(&state.springs).add_to(state, rows, total);
    }
}

/// The same without threads.
#[cfg(not(feature = "rayon"))]
use add_all as add_side_by_side;

/// Rows that are worth a thread's while.
#[cfg(feature = "rayon")]
const SHARE: usize = 2048;

/// Tells whether a part of the rows costs no more than its share: trees divide themselves, and an index would be asked
/// for all.
#[cfg(feature = "rayon")]
fn can_be_divided(state: &State<'_>) -> bool {
    state.near.can_be_divided() && state.mass_tree.is_none() && state.charge_tree.is_none()
}

/// The forces on some rows, on all threads of the pool that this one belongs to, each with its share of the rows.
#[cfg(feature = "rayon")]
fn add_side_by_side(
    forces: &dyn Force,
    springs: Option<SpringForce>,
    state: &State<'_>,
    rows: Range<usize>,
    total: &mut [Vec3],
) {
    let parts = if can_be_divided(state) { Division::among_threads(rows.len(), SHARE).parts() } else { 1 };
    divide(&|rows, total| add_all(forces, springs, state, rows, total), rows, total, parts);
}

/// Lets so many threads fill in so many parts of the rows.
#[cfg(feature = "rayon")]
fn divide(fill: &(dyn Fn(Range<usize>, &mut [Vec3]) + Sync), rows: Range<usize>, total: &mut [Vec3], parts: usize) {
    if parts < 2 {
        return fill(rows, total);
    }
    let len = Division::new(rows.len(), parts).start(parts / 2);
    let (middle, (front, back)) = (rows.start + len, total.split_at_mut(len));
    rayon::join(
        || divide(fill, rows.start..middle, front, parts / 2),
        || divide(fill, middle..rows.end, back, parts - parts / 2),
    );
}
