//! The state of the world and its one verb: `step` creates, moves, collides and deletes.

use crate::collide::collide;
use crate::emit::{Births, Emit};
use crate::force::{Force, Spring, Springs, State, spring};
use crate::hash::Fnv;
use crate::integrate::{Dynamics, Integrator, Motion, Symplectic, Work};
use crate::particles::{Full, Id, Particle, WHITE};
use crate::report::Report;
use crate::retire::{Fate, retire};
use crate::rows::each_row_with;
use crate::shape::Collider;
use crate::storage::{Columns, Size, Slices, Storage};
use crate::time::Time;
use glam::Vec3;

/// What the world does: immutable while it runs. Lists are closed under composition, so each field is one thing.
///
/// ```
/// use pointmass::{Drag, Gravity, Scene};
/// let scene = Scene { forces: &(Gravity::EARTH, Drag {}), ..Scene::EMPTY };
/// ```
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The particles it begins with.
    pub start: &'a [Particle],
    /// Springs between them.
    pub springs: &'a [Spring],
    /// What brings further particles into the world.
    pub emitters: &'a dyn Emit,
    /// What acts on particles, springs aside.
    pub forces: &'a dyn Force,
    /// What they bounce off.
    pub colliders: &'a dyn Collider,
    /// What they vanish at.
    pub sinks: &'a dyn Collider,
    /// How they are moved.
    pub integrator: &'a dyn Integrator,
}

impl core::fmt::Debug for Scene<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Scene").field("size", &self.size()).finish_non_exhaustive()
    }
}

impl Scene<'_> {
    /// Nothing at all, moved by symplectic Euler.
    pub const EMPTY: Scene<'static> = Scene {
        start: &[],
        springs: &[],
        emitters: &(),
        forces: &(),
        colliders: &(),
        sinks: &(),
        integrator: &Symplectic,
    };

    /// Vectors that a step needs to work with for each particle.
    #[must_use]
    pub fn columns(&self) -> usize {
        let start = if self.needs_start() { 2 } else { 0 };
        // Newborns need one column for their acceleration, whatever the method.
        start + self.integrator.columns().max(1)
    }

    /// The least memory it runs in; `particles` is what it begins with.
    #[must_use]
    pub fn size(&self) -> Size {
        Size {
            particles: self.start.len(),
            emitters: self.emitters.count(),
            springs: self.springs.len(),
            columns: self.columns(),
        }
    }

    /// Whether paths are to be followed through space.
    fn is_swept(&self) -> bool {
        !(self.colliders.is_empty() && self.sinks.is_empty())
    }

    fn needs_start(&self) -> bool {
        self.integrator.needs_start() || self.is_swept()
    }

    /// Whether a step can be made in memory of size `have`: all but the particles must fit.
    fn fits(&self, have: Size) -> bool {
        let need = self.size();
        need.emitters <= have.emitters && need.springs <= have.springs && need.columns <= have.columns
    }
}

/// A scene needs more memory than the system has, particles aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unfit {
    /// What the scene needs.
    pub need: Size,
    /// What there is.
    pub have: Size,
}

impl core::fmt::Display for Unfit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { need, have } = self;
        write!(
            f,
            "the scene needs {} emitters, {} springs and {} columns, the system has {}, {} and {}",
            need.emitters, need.springs, need.columns, have.emitters, have.springs, have.columns
        )
    }
}

impl core::error::Error for Unfit {}

/// The state that a scene acts on, in memory of its owner's choice. An empty one is all zeros.
#[derive(Clone, Debug)]
pub struct System<B> {
    memory: B,
    status: Status,
}

/// All of a system's state that is not a column.
#[derive(Clone, Copy, Debug, Default)]
struct Status {
    /// Rows in use.
    len: usize,
    /// Slots ever used.
    slots: usize,
    /// The first free slot plus one; zero: none.
    free: u32,
    /// Particles taken in so far.
    taken: u32,
    /// Particles of the scene's start that found room.
    start: u32,
    /// Emitters that the scene had then.
    emitters: usize,
    time: Time,
    seed: u64,
    totals: Report,
}

impl Status {
    const NEW: Self = Self {
        len: 0,
        slots: 0,
        free: 0,
        taken: 0,
        start: 0,
        emitters: 0,
        time: Time::ZERO,
        seed: 0,
        totals: Report::NOTHING,
    };
}

impl<B> System<B> {
    /// An empty system in fresh memory.
    pub const fn with(memory: B) -> Self {
        Self { memory, status: Status::NEW }
    }

    /// Particles alive.
    pub const fn len(&self) -> usize {
        self.status.len
    }

    /// Whether no particle is alive.
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

    /// What happened since `start`.
    pub const fn totals(&self) -> &Report {
        &self.status.totals
    }
}

impl<B: Storage> System<B> {
    /// Forgets everything and puts in what `scene` begins with.
    ///
    /// # Errors
    /// If the memory has not enough emitters, springs or columns for the scene; nothing is put in then. Particles
    /// beyond the capacity are refused and counted.
    pub fn start(&mut self, scene: &Scene<'_>, seed: u64) -> Result<(), Unfit> {
        self.status = Status { seed, ..Status::NEW };
        let (need, have) = (scene.size(), self.memory.columns().size());
        if !scene.fits(have) {
            return Err(Unfit { need, have });
        }
        self.view().start(scene);
        Ok(())
    }

    /// Moves the world on by `dt`. It cannot fail, does not panic, and its work is bounded; whatever a bound cut
    /// short is counted in the report.
    pub fn step(&mut self, scene: &Scene<'_>, dt: Time) -> Report {
        let mut report = Report::default();
        if scene.fits(self.memory.columns().size()) {
            self.view().step(scene, dt, &mut report);
        } else {
            report.caps.unfit = 1;
        }
        self.status.totals += report;
        report
    }

    /// Puts a particle in now.
    ///
    /// # Errors
    /// If there is no room; that is counted.
    pub fn spawn(&mut self, particle: &Particle) -> Result<Id, Full> {
        let now = self.status.time;
        let given = self.view().spawn(particle, now);
        match given {
            Ok(_) => self.status.totals.born += 1,
            Err(Full) => self.status.totals.refused += 1,
        }
        given
    }

    /// Takes a particle out, and says whether it was alive. Counted as a death by chance.
    pub fn remove(&mut self, id: Id) -> bool {
        let Some(row) = self.row(id) else { return false };
        let mut report = Report::default();
        report.died.chance = 1;
        self.view().remove(row, &[], &mut report);
        self.status.totals += report;
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

    /// How many particles fit.
    pub fn capacity(&self) -> usize {
        self.memory.columns().capacity()
    }

    /// The living, one entry a row in every column by row.
    pub fn particles(&self) -> Columns<'_> {
        self.memory.columns().living(self.status.len)
    }

    /// The particles as forces see them.
    pub fn state<'a>(&'a self, scene: &Scene<'a>) -> State<'a> {
        let Columns { position, velocity, mass, drag, serial, row_of, last_spring, incident, .. } = self.particles();
        let springs =
            Springs { springs: scene.springs, start: self.status.start, serial, row_of, last_spring, incident };
        State { time: self.status.time, position, velocity, mass, drag, springs }
    }

    /// A fingerprint of time, counters, and every column in the order of ids: equal on all targets for equal states.
    pub fn hash(&self) -> u64 {
        let mut hash = Fnv::new();
        let Status { time, seed, taken, emitters, totals, .. } = self.status;
        hash.long(time.ticks());
        hash.long(seed);
        hash.word(taken);
        for counter in totals.counters() {
            hash.long(counter);
        }
        let columns = self.particles();
        for tally in columns.tallies.iter().take(emitters) {
            hash.word(tally.serial);
            hash.long(tally.phase);
        }
        for slot in 0..self.status.slots {
            let row = columns.row_of[slot] as usize;
            if columns.slot.get(row) == Some(&(slot as u32)) {
                columns.hash_row(row, &mut hash);
            }
        }
        hash.finish()
    }

    fn view(&mut self) -> View<'_> {
        View { memory: self.memory.slices(), status: &mut self.status }
    }
}

impl<'a> Columns<'a> {
    /// The columns by row, cut to the rows in use.
    fn living(self, len: usize) -> Self {
        Self {
            position: &self.position[..len],
            velocity: &self.velocity[..len],
            mass: &self.mass[..len],
            inverse_mass: &self.inverse_mass[..len],
            drag: &self.drag[..len],
            elasticity: &self.elasticity[..len],
            born: &self.born[..len],
            dies: &self.dies[..len],
            color: &self.color[..len],
            material: &self.material[..len],
            fate: &self.fate[..len],
            serial: &self.serial[..len],
            slot: &self.slot[..len],
            ..self
        }
    }

    fn hash_row(&self, row: usize, hash: &mut Fnv) {
        hash.word(self.slot[row]);
        hash.word(self.serial[row]);
        for vector in [self.position[row], self.velocity[row]] {
            vector.to_array().into_iter().for_each(|x| hash.float(x));
        }
        for x in [self.mass[row], self.inverse_mass[row], self.drag[row], self.elasticity[row]] {
            hash.float(x);
        }
        hash.long(self.born[row].ticks());
        hash.long(self.dies[row].ticks());
        hash.bytes(&self.color[row]);
        hash.word(u32::from(self.material[row]));
    }
}

/// A system with its memory at hand: every algorithm works on it, and it is generic over nothing.
#[derive(Debug)]
pub(crate) struct View<'a> {
    pub(crate) memory: Slices<'a>,
    status: &'a mut Status,
}

impl View<'_> {
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
        self.memory.columns().capacity()
    }

    fn start(&mut self, scene: &Scene<'_>) {
        self.memory.tallies.fill(Default::default());
        self.status.emitters = scene.emitters.count();
        let mut report = Report::default();
        for particle in scene.start {
            match self.spawn(particle, Time::ZERO) {
                Ok(_) => report.initial += 1,
                Err(Full) => report.refused += 1,
            }
        }
        self.status.start = self.status.taken;
        spring::sort_by_ends(scene.springs, self.memory.last_spring, self.memory.incident);
        let lost = |s: &&Spring| s.ends.iter().any(|&end| end >= self.status.start);
        report.caps.springs = scene.springs.iter().filter(lost).count() as u64;
        self.status.totals = report;
    }

    /// The whole of a step: create, update, collide, delete.
    fn step(&mut self, scene: &Scene<'_>, dt: Time, report: &mut Report) {
        let end = self.status.time + dt;
        let old = self.create(scene, end, report);
        self.update(scene, old, dt);
        if scene.is_swept() {
            collide(self, scene, dt, end, report);
        }
        retire(self, scene.springs, end, report);
        self.status.time = end;
    }

    /// Lets the emitters emit, and returns how many particles there were before.
    fn create(&mut self, scene: &Scene<'_>, end: Time, report: &mut Report) -> usize {
        let (old, now) = (self.status.len, self.status.time);
        let view = View { memory: self.memory.slices(), status: self.status };
        scene.emitters.emit(now, end, &mut Births { view, report, next: 0 });
        old
    }

    /// Moves the `old` particles by the integrator. The newborn fly on from their birth with the acceleration they
    /// have there, and act on others from the next step on.
    fn update(&mut self, scene: &Scene<'_>, old: usize, dt: Time) {
        let (len, now) = (self.status.len, self.status.time);
        let capacity = self.capacity();
        let Slices {
            position,
            velocity,
            mass,
            inverse_mass,
            drag,
            born,
            serial,
            row_of,
            last_spring,
            incident,
            work,
            ..
        } = self.memory.slices();
        let (start, rest) = work.split_at_mut(if scene.needs_start() { 2 * capacity } else { 0 });
        let (start_x, start_v) = start.split_at_mut(start.len() / 2);
        if scene.needs_start() {
            start_x[..len].copy_from_slice(&position[..len]);
            start_v[..len].copy_from_slice(&velocity[..len]);
        }
        let springs = Springs {
            springs: scene.springs,
            start: self.status.start,
            serial: &serial[..len],
            row_of,
            last_spring,
            incident,
        };
        let mut field = Field { scene, mass, inverse_mass, drag, springs, first: old };

        let newborn = old..len;
        if !newborn.is_empty() {
            let a = &mut rest[..newborn.len()];
            field.accelerations(now, &position[..len], &velocity[..len], a);
            for (row, &a) in newborn.zip(a.iter()) {
                let flight = (now + dt - born[row]).seconds();
                position[row] += (velocity[row] + a * (0.5 * flight)) * flight;
                velocity[row] += a * flight;
            }
        }

        field.first = 0;
        field.springs.serial = &serial[..old];
        let start = if scene.needs_start() { [&start_x[..old], &start_v[..old]] } else { [&[][..]; 2] };
        let work = Work { memory: rest, stride: capacity, len: old };
        let motion = Motion { position: &mut position[..old], velocity: &mut velocity[..old], start, work };
        scene.integrator.advance(motion, now, dt, &mut field);
    }

    /// Puts a particle into the next row.
    pub(crate) fn spawn(&mut self, particle: &Particle, born: Time) -> Result<Id, Full> {
        if self.is_full() {
            return Err(Full);
        }
        let (m, status) = (&mut self.memory, &mut *self.status);
        let row = status.len;
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
        m.position[row] = particle.position;
        m.velocity[row] = if particle.fixed { Vec3::ZERO } else { particle.velocity };
        m.mass[row] = particle.mass;
        m.inverse_mass[row] = if particle.fixed { 0.0 } else { 1.0 / particle.mass };
        m.drag[row] = particle.drag;
        m.elasticity[row] = particle.elasticity;
        m.born[row] = born;
        m.dies[row] = death(born, particle.lifetime);
        m.color[row] = particle.color.unwrap_or(WHITE);
        m.material[row] = particle.material.map_or(0, |number| number.saturating_add(1));
        m.fate[row] = Fate::Lives;
        status.len += 1;
        status.taken = serial.wrapping_add(1);
        Ok(Id { slot, serial })
    }

    /// Takes the particle in `row` out; the last row fills the gap.
    pub(crate) fn remove(&mut self, row: usize, springs: &[Spring], report: &mut Report) {
        let len = self.status.len;
        let last = len - 1;
        let Slices { serial, row_of, last_spring, incident, .. } = self.memory.slices();
        let table =
            Springs { springs, start: self.status.start, serial: &serial[..len], row_of, last_spring, incident };
        report.caps.springs += table.held_by(row);

        let slot = self.memory.slot[row];
        if row != last {
            self.memory.move_row(last, row);
            self.memory.row_of[self.memory.slot[row] as usize] = row as u32;
        }
        self.memory.row_of[slot as usize] = self.status.free;
        self.status.free = slot + 1;
        self.status.len = last;
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

/// The scene's forces over the masses, from row `first` on.
struct Field<'a> {
    scene: &'a Scene<'a>,
    mass: &'a [f32],
    inverse_mass: &'a [f32],
    drag: &'a [f32],
    springs: Springs<'a>,
    first: usize,
}

impl Dynamics for Field<'_> {
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]) {
        let len = position.len();
        let rows = self.first..len;
        let (mass, drag, springs) = (&self.mass[..len], &self.drag[..len], self.springs);
        let state = State { time, position, velocity, mass, drag, springs };
        acceleration.fill(Vec3::ZERO);
        self.scene.forces.add_to(&state, rows.clone(), acceleration);
        springs.add_to(&state, rows.clone(), acceleration);
        each_row_with(acceleration, Vec3::ZERO, &self.inverse_mass[rows], |force, _, inverse| force * inverse);
    }
}
