//! The state of the world and its one verb, `step`.

use crate::custom::{CustomColumns, CustomColumnsMut};
use crate::force::{self, State};
use crate::hash::Fnv;
use crate::memory::{Columns, Layout, Status, Storage, Workspace};
use crate::observe::Observer;
use crate::particles::{Full, Id, Particle};
use crate::report::Report;
use crate::scene::{InsufficientMemory, Scene};
use crate::time::Time;

/// The state that a scene acts on, in memory of its owner's choice. An empty one is all zeros.
///
/// A clone is a snapshot: it goes on to the same bits. `clone_from` goes back to one in the memory that there is.
#[derive(Debug)]
pub struct System<B> {
    memory: B,
    status: Status,
}

impl<B: Clone> Clone for System<B> {
    fn clone(&self) -> Self {
        Self { memory: self.memory.clone(), status: self.status }
    }

    fn clone_from(&mut self, other: &Self) {
        self.memory.clone_from(&other.memory);
        self.status = other.status;
    }
}

#[cfg(feature = "alloc")]
impl System<crate::memory::Heap> {
    /// A clone.
    ///
    /// # Errors
    /// If there is not enough memory for it.
    pub fn try_clone(&self) -> Result<Self, alloc::collections::TryReserveError> {
        Ok(Self { memory: self.memory.try_clone()?, status: self.status })
    }
}

impl<B> System<B> {
    /// An empty system in fresh memory.
    pub const fn with(memory: B) -> Self {
        Self { memory, status: Status::NEW }
    }

    /// The memory it lives in; rows beyond the living hold nothing of meaning.
    pub const fn memory(&self) -> &B {
        &self.memory
    }

    /// Particles alive.
    pub const fn len(&self) -> usize {
        self.status.len
    }

    /// Tells whether no particle is alive.
    pub const fn is_empty(&self) -> bool {
        self.status.len == 0
    }

    /// The instant it has reached.
    pub const fn time(&self) -> Time {
        self.status.time
    }

    /// The seed of all its randomness.
    pub const fn seed(&self) -> u64 {
        self.status.seed
    }

    /// The report of what happened since `start`.
    pub const fn totals(&self) -> &Report {
        &self.status.totals
    }
}

impl<B: Storage> System<B> {
    /// Forgets everything and puts in what `scene` begins with. Whoever has a number that cannot be used is taken out as the next step ends, as with
    /// [`spawn`](Self::spawn).
    ///
    /// # Errors
    /// If the memory has not enough emitters, springs or columns for the scene, or holds an attribute for all particles alike that
    /// the scene needs of each; nothing is put in then. Particles
    /// beyond the capacity are refused and counted.
    pub fn start(&mut self, scene: &Scene<'_>, seed: u64) -> Result<(), InsufficientMemory> {
        self.status.begin(seed);
        let mut memory = self.memory.slices();
        let mut workspace = Workspace::on(&mut memory, &mut self.status);
        let layout = workspace.layout(scene);
        let differs = workspace.differs(scene);
        if differs.is_some() || !workspace.fits(scene, &layout) {
            let have = workspace.size();
            return Err(InsufficientMemory { need: scene.size_for(have.particles), have, differs });
        }
        workspace.start(scene, &layout);
        Ok(())
    }

    /// Moves the world on by `dt`; in no time nobody moves, and only reapers and what writes columns are asked. It cannot fail, does not panic, and its work is bounded; whatever a bound cut
    /// short is counted in the report.
    ///
    /// A step for which there is not enough memory is not made: the state, and [`time`](Self::time) with it, stay as they are, which
    /// [`Caps::insufficient_memory`](crate::Caps::insufficient_memory) counts. No step leads beyond [`Time::NEVER`]: one that would ends there, and one that begins there is one in no
    /// time, uncounted. So a loop until an instant has to look whether time has gone on.
    ///
    /// It works in the memory that the system has, and on the stack, of which most programs have far more than enough; on small chips
    /// it is worth measuring (the crate's front page says how much some scenes take).
    pub fn step(&mut self, scene: &Scene<'_>, dt: Time) -> Report {
        self.step_observed(scene, dt, &mut ())
    }

    /// Moves the world on, in one step, to an instant; not back, and not at all where it is there.
    ///
    /// Stepping to [`Time::frame`] after frame drifts by nothing, however long. As with [`step`](Self::step), time stays where it is if there is not
    /// enough memory.
    pub fn step_to(&mut self, scene: &Scene<'_>, instant: Time) -> Report {
        self.step_to_observed(scene, instant, &mut ())
    }

    /// [`step_to`](Self::step_to), while somebody watches.
    pub fn step_to_observed(&mut self, scene: &Scene<'_>, instant: Time, observer: &mut dyn Observer) -> Report {
        let now = self.status.time;
        if instant > now { self.step_observed(scene, instant - now, observer) } else { Report::default() }
    }

    /// [`step`](Self::step), while somebody watches.
    pub fn step_observed(&mut self, scene: &Scene<'_>, dt: Time, observer: &mut dyn Observer) -> Report {
        let mut report = Report::default();
        self.status.emitters = self.status.emitters.max(scene.emitters.count());
        self.status.is_reaped |= !scene.reapers.is_empty();
        let mut memory = self.memory.slices();
        let mut workspace = Workspace::on(&mut memory, &mut self.status);
        let layout = workspace.layout(scene);
        if workspace.fits(scene, &layout) && workspace.lacks(scene).is_none() {
            workspace.status.kept = layout.kept_words();
            report.caps.springs = workspace.take_up_springs(scene);
            let old = workspace.create(scene, &scene.backdrop(), &layout, dt, &mut report, observer);
            let mut memory = self.memory.slices();
            let mut workspace = Workspace::on(&mut memory, &mut self.status);
            workspace.step(scene, &layout, old, dt, &mut report, observer);
        } else {
            report.caps.insufficient_memory = 1;
        }
        self.status.totals.take_in(&report);
        report
    }

    /// Puts a particle in now; what it has in columns of a user's own is zero.
    ///
    /// One with a number that cannot be used is taken in, its velocity being no number, and out as the next step ends, counted in `died.nonfinite`: where any
    /// but its lifetime is not finite, its mass is not above zero (of a fixed one: negative), or its radius is negative.
    ///
    /// # Errors
    /// If there is no room; that is counted.
    pub fn spawn(&mut self, particle: &Particle) -> Result<Id, Full> {
        let now = self.status.time;
        self.status.hint = Time::ZERO;
        let given = Workspace::on(&mut self.memory.slices(), &mut self.status).put(particle, now);
        let totals = &mut self.status.totals;
        match given {
            Ok(_) => totals.born = totals.born.saturating_add(1),
            Err(Full) => totals.refused = totals.refused.saturating_add(1),
        }
        given
    }

    /// Takes a particle out, and says whether it was alive. Counted in `died.other`.
    pub fn remove(&mut self, scene: &Scene<'_>, id: Id) -> bool {
        let Some(row) = self.row(id) else { return false };
        let mut report = Report::default();
        report.died.other = 1;
        self.status.hint = Time::ZERO;
        Workspace::on(&mut self.memory.slices(), &mut self.status).remove(&[row as u32], scene.springs, &mut report);
        self.status.totals.take_in(&report);
        true
    }

    /// The row in which a particle is now, if it lives. Rows change when particles die.
    pub fn row(&self, id: Id) -> Option<usize> {
        let columns = self.particles();
        let row = *columns.row_of.get(id.slot as usize)? as usize;
        (columns.serial.get(row) == Some(&id.serial) && columns.slot.get(row) == Some(&id.slot)).then_some(row)
    }

    /// The id of the particle in a row.
    pub fn id(&self, row: usize) -> Option<Id> {
        let columns = self.particles();
        Some(Id { slot: *columns.slot.get(row)?, serial: *columns.serial.get(row)? })
    }

    /// The number of particles that fit.
    pub fn capacity(&self) -> usize {
        self.memory.columns().capacity()
    }

    /// The living, one entry a row in every column by row.
    pub fn particles(&self) -> Columns<'_> {
        self.memory.columns().living(self.status.len)
    }

    /// The particles as forces see them.
    pub fn state<'a>(&'a self, scene: &Scene<'a>) -> State<'a> {
        self.memory.columns().state(&scene.backdrop(), &self.status)
    }

    /// Columns of a user's own, one entry a row: those that `scene` lists.
    pub fn custom<'a>(&'a self, scene: &Scene<'a>) -> CustomColumns<'a> {
        CustomColumns::of(scene.custom, self.memory.columns(), self.status.len)
    }

    /// The same, for writing.
    pub fn custom_mut<'a>(&'a mut self, scene: &Scene<'a>) -> CustomColumnsMut<'a> {
        let (capacity, len) = (self.capacity(), self.status.len);
        let (values, _) = Layout::of(scene.plan(), capacity).kept(self.memory.slices().kept);
        CustomColumnsMut::new(scene.custom, values, capacity, len)
    }

    /// A fingerprint of time, counters, and every column in the order of ids (keys once a scene has had reapers, which die
    /// by them; a user's own, and what constraints keep): equal on all targets for equal states. The
    /// order of rows and of free slots, which decides how sums round and which ids come next, is not in it.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::new();
        let Status { time, seed, taken, given, is_reaped, emitters, kept, totals, .. } = self.status;
        let capacity = self.capacity();
        hash.long(time.ticks());
        hash.long(seed);
        hash.word(taken);
        for counter in totals.counters() {
            hash.long(counter);
        }
        if totals.died.other > 0 {
            hash.long(totals.died.other);
        }
        if is_reaped {
            hash.word(given);
        }
        let columns = self.particles();
        for emitter in columns.emitter_states.iter().take(emitters) {
            hash.word(emitter.serial);
            hash.long(emitter.phase);
        }
        hash.long(self.status.hint.ticks());
        for &spring in columns.incident.iter().filter(|&&spring| force::is_broken(spring)) {
            hash.word(spring);
        }
        for slot in 0..self.status.slots {
            let row = columns.row_of[slot] as usize;
            if columns.slot.get(row) == Some(&(slot as u32)) {
                columns.hash_row(row, &mut hash);
                // Where nothing dies by them keys decide nothing.
                if is_reaped {
                    hash.word(columns.key[row]);
                }
                (0..kept.per_row).for_each(|number| hash.word(columns.kept[number * capacity + row]));
            }
        }
        let besides = columns.kept.get(kept.per_row * capacity..).unwrap_or(&[]);
        besides.iter().take(kept.fixed).for_each(|&word| hash.word(word));
        hash.finish()
    }
}

impl Columns<'_> {
    fn hash_row(&self, row: usize, hash: &mut Fnv) {
        hash.word(self.slot[row]);
        hash.word(self.serial[row]);
        for vector in [self.position[row], self.velocity[row]] {
            vector.to_array().into_iter().for_each(|x| hash.float(x));
        }
        let (mass, inverse, radius) = (self.mass[row], self.inverse_mass[row], self.radius[row]);
        for x in [radius, mass, inverse, self.drag[row], self.charge[row], self.elasticity[row]] {
            hash.float(x);
        }
        hash.long(self.born[row].ticks());
        hash.long(self.dies[row].ticks());
        hash.bytes(&self.color[row]);
        hash.word(u32::from(self.material[row]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Inline;

    #[test]
    fn what_is_counted_stops_at_the_largest_number() {
        let (mut system, scene) = (System::with(Inline::<1, 0, 0, 4>::new()), Scene::EMPTY);
        system.start(&scene, 1).expect("nothing is asked for");
        system.status.totals.refused = u64::MAX;
        system.status.totals.born = u64::MAX;
        assert!(system.spawn(&Particle::default()).is_ok());
        assert!(system.spawn(&Particle::default()).is_err());
        system.step(&scene, Time::from_ticks(1));
        assert_eq!([system.status.totals.born, system.status.totals.refused], [u64::MAX; 2]);
    }
}
