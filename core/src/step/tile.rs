//! Rows that go through a step together: all that there are, or few enough to stay in the cache meanwhile.

use super::View;
use super::field::Attributes;
use crate::force::{Springs, State};
use crate::memory::Storage;
use crate::reap::{Fate, Lifetime, Nonfinite, Reaper, Verdicts};
use crate::rows::farthest;
use crate::scene::Scene;
use crate::stall;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Rows of a tile: enough to share the cost of the calls, few enough for the innermost cache.
pub(super) const TILE: usize = 256;

/// Rows in the middle of a step.
pub(crate) struct Tile<'a> {
    pub(crate) scene: &'a Scene<'a>,
    /// When the step begins, and how long it takes.
    pub(crate) now: Time,
    pub(crate) dt: Time,
    /// The number of the first row.
    pub(crate) first: usize,
    /// How many of the rows there were before the step; those behind are newborn.
    pub(crate) old: usize,
    pub(crate) position: &'a mut [Vec3],
    pub(crate) velocity: &'a mut [Vec3],
    pub(crate) fate: &'a mut [Fate],
    pub(crate) attributes: Attributes<'a>,
    /// Memory to work with, and for how many rows it is laid out.
    pub(crate) work: &'a mut [Vec3],
    pub(crate) capacity: usize,
}

impl Scene<'_> {
    /// Whether a step takes each row through all its phases without a look at the others, so that rows can go a few at a time.
    pub(super) fn is_local(&self) -> bool {
        let Self { springs, forces, constraints, meetings, integrator, .. } = self;
        let apart = springs.is_empty() && constraints.is_empty() && meetings.is_through();
        apart && forces.is_local() && integrator.is_local()
    }
}

impl View<'_> {
    /// Rows in a step that begins with `old` of all. Memory is laid out as for `capacity` rows.
    pub(crate) fn tile<'s>(
        &'s mut self,
        scene: &'s Scene<'s>,
        [now, dt]: [Time; 2],
        old: usize,
        rows: Range<usize>,
        capacity: usize,
    ) -> Tile<'s> {
        let m = self.memory.slices();
        let springs = Springs {
            springs: scene.springs,
            start: self.status.start,
            serial: m.serial,
            row_of: m.row_of,
            last_spring: m.last_spring,
            incident: m.incident,
        };
        let (radius, mass, drag, charge) = (&*m.radius, &*m.mass, &*m.drag, &*m.charge);
        let (born, dies, slot, key) = (&*m.born, &*m.dies, &*m.slot, &*m.key);
        let lives = State { radius, mass, drag, charge, born, dies, slot, key, springs, ..State::EMPTY };
        let attributes =
            Attributes { lives, inverse_mass: m.inverse_mass, elasticity: m.elasticity, material: m.material };
        Tile {
            scene,
            now,
            dt,
            first: rows.start,
            old: old.clamp(rows.start, rows.end) - rows.start,
            position: &mut m.position[rows.clone()],
            velocity: &mut m.velocity[rows.clone()],
            fate: &mut m.fate[rows.clone()],
            attributes: attributes.rows(rows),
            work: m.work,
            capacity,
        }
    }
}

/// The rows of a range, a tile at a time.
pub(super) fn tiles(rows: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let end = rows.end;
    rows.step_by(TILE).map(move |first| first..end.min(first + TILE))
}

impl Tile<'_> {
    /// When the step ends.
    pub(crate) fn end(&self) -> Time {
        self.now + self.dt
    }

    /// Finds out who has come to the end of its life, and who is nowhere any more. Returns how many stall in parts of a step
    /// of `h` \[s\].
    pub(super) fn judge(&mut self, h: f32) -> u64 {
        let rows = 0..self.position.len();
        let state = self.attributes.lives.moved(self.end(), self.position, self.velocity);
        let mut verdicts = Verdicts::on(self.fate);
        Lifetime.judge(&state, rows.clone(), &mut verdicts);
        Nonfinite.judge(&state, rows, &mut verdicts);
        if stall::may_be(farthest(self.position), h) { stall::count(self.position, self.velocity, h) } else { 0 }
    }
}
