//! Rows taken by the newborn and given back by the dead.

use super::{TILED, Workspace};
use crate::force::SpringList;
use crate::memory::Storage;
use crate::particles::{Full, Id, Particle};
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::rng::Stream;
use crate::time::Time;
use glam::Vec3;

/// The number, instead of an emitter's, of those that are put in without one.
const NO_EMITTER: u32 = u32::MAX;

impl Workspace<'_> {
    /// Puts a particle in that no emitter brings. Its random numbers are those of the number in which it was put in.
    pub(crate) fn put(&mut self, particle: &Particle, born: Time) -> Result<Id, Full> {
        let number = self.status.given;
        self.status.given = number.wrapping_add(1);
        self.spawn(particle, born, Stream::new(self.status.seed, NO_EMITTER, number).name())
    }

    /// Puts a particle into the next row; `key` is what its random numbers are drawn by as long as it lives.
    pub(crate) fn spawn(&mut self, particle: &Particle, born: Time, key: u32) -> Result<Id, Full> {
        if self.is_full() {
            return Err(Full);
        }
        let (m, capacity, status) = (&mut self.memory, self.capacity, &mut *self.status);
        let row = status.len;
        if m.give(row, particle).is_err() {
            return Err(Full);
        }
        let slot = if status.free > 0 {
            let slot = status.free - 1;
            status.free = m.row_of[slot as usize];
            slot
        } else {
            status.slots += 1;
            (status.slots - 1) as u32
        };
        let serial = status.taken;
        m.row_of[slot as usize] = row as u32;
        m.slot[row] = slot;
        m.serial[row] = serial;
        m.key[row] = key;
        m.position[row] = particle.position;
        // A particle with a number that cannot be used is taken out at the step's end, whichever number it is. Any
        // lifetime can be used: one that is no number or beyond all is for ever.
        let velocity = if particle.fixed { Vec3::ZERO } else { particle.velocity };
        m.velocity[row] = if particle.is_usable() { velocity } else { Vec3::NAN };
        m.born[row] = born;
        let dies = death(born, particle.lifetime);
        m.dies[row] = dies;
        if TILED {
            status.ends_at(dies);
            status.inertias.add(particle);
        }
        m.pending_death[row] = PendingDeath::Lives;
        (0..status.kept.per_row).for_each(|number| m.kept[number * capacity + row] = 0);
        status.len += 1;
        status.changes = status.changes.wrapping_add(1);
        status.taken = serial.wrapping_add(1);
        Ok(Id { slot, serial })
    }

    /// Takes the particle in `row` out; the last row fills the gap.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(crate) fn remove(&mut self, row: usize, springs: &dyn SpringList, report: &mut Report) {
        let len = self.status.len;
        let last = len - 1;
        if let Some(code) = springs.code() {
            let table = self.memory.columns().springs(springs, self.status);
            report.caps.springs += (code.held_by)(&table, row);
        }

        let slot = self.memory.slot[row];
        if row != last {
            self.memory.move_row(last, row);
            let capacity = self.capacity();
            for column in self.memory.kept.chunks_mut(capacity).take(self.status.kept.per_row) {
                column[row] = column[last];
            }
            self.memory.row_of[self.memory.slot[row] as usize] = row as u32;
        }
        self.memory.row_of[slot as usize] = self.status.free;
        self.status.free = slot + 1;
        self.status.len = last;
        self.status.changes = self.status.changes.wrapping_add(1);
    }
}

/// When a particle born at `born` dies of age. A lifetime counts as over within the rounding of its `f32` and of a
/// tick, so that one of 0.1 s ends with the sixth of sixty frames a second.
fn death(born: Time, lifetime: f32) -> Time {
    if lifetime > 0.0 {
        let ticks = Time::from_seconds(lifetime).ticks();
        born + Time::from_ticks(ticks.saturating_sub((ticks >> 24) + 1))
    } else {
        Time::NEVER
    }
}
