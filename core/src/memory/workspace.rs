//! A system with its memory at hand: every phase of a step works on it, and particles are put into it.

use super::in_common::InCommon;
use super::{Size, Slices, Words};
use crate::index::Listed;
use crate::particles::{Full, Id, Particle, Start};
use crate::reap::PendingDeath;
use crate::report::Report;
use crate::rng::Stream;
use crate::rows::are_finite;
use crate::time::Time;
use glam::Vec3;

/// True if there may be a cache that a few rows fit into: chips without an operating system are spared the code, and programs without optimisation
/// the stack of its kernels.
pub(crate) const TILED: bool = !cfg!(one_by_one);

/// The number, instead of an emitter's, of those that are put in without one.
const NO_EMITTER: u32 = u32::MAX;

/// A system with its memory at hand: every algorithm works on it, and it is generic over nothing.
#[derive(Debug)]
pub(crate) struct Workspace<'a> {
    pub(crate) memory: &'a mut Slices<'a>,
    /// The number of particles that fit.
    pub(crate) capacity: usize,
    pub(crate) status: &'a mut Status,
}

/// All of a system's state that is not a column.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Status {
    /// Rows in use.
    pub(crate) len: usize,
    /// Slots ever used.
    pub(crate) slots: usize,
    /// The first free slot plus one; zero: none.
    pub(crate) free: u32,
    /// Particles taken in so far.
    pub(crate) taken: u32,
    /// Particles of the scene's start that found room.
    pub(crate) start: u32,
    /// The name of the list of springs that are sorted by their ends; zero: none are.
    pub(crate) springs: u32,
    /// Particles put in without an emitter so far, those that found no room included.
    pub(crate) given: u32,
    /// True if a scene has had reapers, so that keys decide what becomes of particles.
    pub(crate) is_reaped: bool,
    /// True if nothing else has been put into the memory for the index of a state.
    pub(crate) is_indexed: bool,
    /// Emitters that the scene had then.
    pub(crate) emitters: usize,
    /// Lists of neighbours, and how many particles have come and gone, which ends them.
    pub(crate) listed: Listed,
    pub(crate) changes: u32,
    /// The words that the scene keeps of particles.
    pub(crate) kept: Words,
    pub(crate) time: Time,
    /// What all are known to have in common.
    pub(crate) common: InCommon,
    /// How long before the end of all time the first of them dies of age, or sooner: an empty system is nothing but zeros.
    pub(crate) ends_before_never: Time,
    /// The step that an integrator which chooses its own goes on with.
    pub(crate) hint: Time,
    pub(crate) seed: u64,
    pub(crate) totals: Report,
}

impl Status {
    pub(crate) const NEW: Self = Self {
        len: 0,
        slots: 0,
        free: 0,
        taken: 0,
        start: 0,
        springs: 0,
        given: 0,
        is_reaped: false,
        is_indexed: false,
        emitters: 0,
        listed: Listed::NONE,
        changes: 0,
        kept: Words::NONE,
        time: Time::ZERO,
        common: InCommon::UNKNOWN,
        ends_before_never: Time::ZERO,
        hint: Time::ZERO,
        seed: 0,
        totals: Report::NOTHING,
    };

    /// Forgets everything. Apart: spread over its caller, it would be copied from a chip's flash, part by part.
    #[inline(never)]
    pub(crate) fn begin(&mut self, seed: u64) {
        *self = Self::NEW;
        self.seed = seed;
    }

    /// An instant before which nobody dies of age.
    pub(crate) fn next_end(&self) -> Time {
        Time::NEVER - self.ends_before_never
    }

    /// Somebody dies of age at an instant.
    pub(crate) fn ends_at(&mut self, dies: Time) {
        self.ends_before_never = self.ends_before_never.max(Time::NEVER - dies);
    }

    /// Forgets who has died, and knows when these do.
    pub(crate) fn end_at(&mut self, dies: &[Time]) {
        self.ends_before_never = Time::NEVER - dies.iter().fold(Time::NEVER, |first, &dies| first.min(dies));
    }
}

impl<'a> Workspace<'a> {
    /// On memory that a system lives in.
    pub(crate) fn on(memory: &'a mut Slices<'a>, status: &'a mut Status) -> Self {
        Self { capacity: memory.capacity(), memory, status }
    }
}

impl Workspace<'_> {
    /// How much memory there is.
    pub(crate) fn size(&self) -> Size {
        let Slices { emitter_states, incident, work, kept, .. } = &*self.memory;
        Size::of(self.capacity, [emitter_states.len(), incident.len(), work.len(), kept.len()])
    }

    pub(crate) fn len(&self) -> usize {
        self.status.len
    }

    pub(crate) fn seed(&self) -> u64 {
        self.status.seed
    }

    pub(crate) fn is_full(&self) -> bool {
        self.status.len >= self.capacity()
    }

    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Puts a particle in that no emitter brings. Its random numbers are those of the number in which it was put in.
    pub(crate) fn put(&mut self, particle: &Particle, born: Time) -> Result<Id, Full> {
        let number = self.status.given;
        self.status.given = number.wrapping_add(1);
        let start = Start::of(particle, born);
        self.spawn(particle, &start, Stream::new(self.status.seed, NO_EMITTER, number).name())
    }

    /// Puts a particle into the next row that is like another but for how it begins; `key` is what its random numbers are drawn by as long
    /// as it lives.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn spawn(&mut self, like: &Particle, start: &Start, key: u32) -> Result<Id, Full> {
        if self.is_full() {
            return Err(Full);
        }
        let (m, capacity, status) = (&mut self.memory, self.capacity, &mut *self.status);
        let row = status.len;
        if m.give(row, like).is_err() {
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
        m.position[row] = start.position;
        // A particle with a number that cannot be used is taken out at the step's end, whichever number it is. Any
        // lifetime can be used: one that is no number or beyond all is for ever.
        let velocity = if like.fixed { Vec3::ZERO } else { start.velocity };
        let is_usable = are_finite(&[start.position, start.velocity]) && like.is_usable();
        m.velocity[row] = if is_usable { velocity } else { Vec3::NAN };
        m.born[row] = start.born;
        let dies = death(start.born, start.lifetime);
        m.dies[row] = dies;
        if TILED {
            status.ends_at(dies);
            status.common.add([m.mass[row], m.drag[row], m.inverse_mass[row], m.radius[row], m.elasticity[row]]);
        }
        m.pending_death[row] = PendingDeath::Lives;
        (0..status.kept.per_row).for_each(|number| m.kept[number * capacity + row] = 0);
        status.len += 1;
        status.changes = status.changes.wrapping_add(1);
        status.taken = serial.wrapping_add(1);
        Ok(Id { slot, serial })
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
