//! The step itself: every algorithm works on a `View`, a system with its memory at hand.

use crate::collide::{Lists, Passage, Stage};
use crate::emit::Births;
use crate::force::{Force, Grow, Needs, Spring, Springs, State, spring};
use crate::index::{BarnesHut, SpatialIndex};
use crate::integrate::{Dynamics, Linear, Motion, Work};
use crate::observe::{Observer, Phase};
use crate::particles::{Full, Id, Particle, WHITE};
use crate::report::Report;
use crate::retire::{Fate, retire};
use crate::rows::each_row_with;
use crate::scene::Scene;
use crate::stall;
use crate::storage::{Slices, Storage};
use crate::time::Time;
use glam::Vec3;

/// A system with its memory at hand: every algorithm works on it, and it is generic over nothing.
#[derive(Debug)]
pub(crate) struct View<'a> {
    pub(crate) memory: Slices<'a>,
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
    /// Emitters that the scene had then.
    pub(crate) emitters: usize,
    pub(crate) time: Time,
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
        emitters: 0,
        time: Time::ZERO,
        hint: Time::ZERO,
        seed: 0,
        totals: Report::NOTHING,
    };
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

    pub(crate) fn start(&mut self, scene: &Scene<'_>) {
        self.memory.tallies.fill(Default::default());
        self.status.emitters = scene.emitters.count();
        let mut report = Report::default();
        for particle in scene.start {
            match self.spawn(particle, Time::ZERO) {
                Ok(_) => report.initial += 1,
                Err(Full) => report.refused = report.refused.saturating_add(1),
            }
        }
        self.status.start = self.status.taken;
        spring::sort_by_ends(scene.springs, self.memory.last_spring, self.memory.incident);
        let lost = |s: &&Spring| s.ends.iter().any(|&end| end >= self.status.start);
        report.caps.springs = scene.springs.iter().filter(lost).count() as u64;
        self.status.totals = report;
    }

    /// The whole of a step: create, update, collide, delete.
    pub(crate) fn step(&mut self, scene: &Scene<'_>, dt: Time, report: &mut Report, observer: &mut dyn Observer) {
        let end = self.status.time + dt;
        observer.after(Phase::Begin, &self.state(scene));
        let old = self.create(scene, end, report, observer);
        observer.after(Phase::Create, &self.state(scene));
        self.update(scene, old, dt, report, observer);
        self.status.time = end;
        observer.after(Phase::Move, &self.state(scene));
        if scene.springs.iter().any(|spring| spring.breaks_at.is_some()) {
            self.snap(scene, report);
            observer.after(Phase::Snap, &self.state(scene));
        }
        if scene.is_swept() {
            let (report, observer) = (&mut *report, &mut *observer);
            scene.contacts.follow(Passage { view: &mut *self, scene, old, dt, end, report, observer });
        }
        observer.after(Phase::Collide, &self.state(scene));
        // The steps that were made of this one: sub-steps of contacts, and those that a method chose.
        let steps = u64::from(scene.contacts.substeps()).max(report.effort.accepted);
        let len = self.len();
        let h = dt.seconds() / steps as f32;
        report.caps.stalled += stall::count(&self.memory.position[..len], &self.memory.velocity[..len], h);
        let before = report.died.total();
        retire(self, scene.springs, end, report, observer);
        if report.died.total() > before || report.born + report.hits + report.contacts + report.broken > 0 {
            self.status.hint = Time::ZERO;
        }
        observer.after(Phase::Delete, &self.state(scene));
    }

    /// The particles as forces see them.
    fn state<'s>(&'s self, scene: &Scene<'s>) -> State<'s> {
        self.memory.columns().state(scene.springs, self.status)
    }

    /// Lets the emitters emit, and returns how many particles there were before.
    fn create(&mut self, scene: &Scene<'_>, end: Time, report: &mut Report, observer: &mut dyn Observer) -> usize {
        let (old, now) = (self.status.len, self.status.time);
        let view = View { memory: self.memory.slices(), status: self.status };
        scene.emitters.emit(now, end, &mut Births { view, report, observer, end, next: 0 });
        old
    }

    /// Moves the `old` particles by the integrator. The newborn fly on from their places of birth with the acceleration
    /// they have there at the step's beginning; they act on the old from the next step on.
    fn update(&mut self, scene: &Scene<'_>, old: usize, dt: Time, report: &mut Report, observer: &mut dyn Observer) {
        let (len, now) = (self.status.len, self.status.time);
        let capacity = self.capacity();
        let Slices {
            position,
            velocity,
            radius,
            mass,
            inverse_mass,
            drag,
            charge,
            elasticity,
            material,
            born,
            serial,
            row_of,
            last_spring,
            incident,
            work,
            ..
        } = self.memory.slices();
        let needs = scene.forces.needs();
        let (start, rest) = work.split_at_mut(if scene.needs_start() { 2 * capacity } else { 0 });
        let (held, rest) = rest.split_at_mut(scene.contacts.held(scene.index) * capacity);
        let (tree, rest) = rest.split_at_mut((needs.tree_columns() * capacity).min(rest.len()));
        let near_columns = needs.columns(scene.index) - needs.tree_columns();
        let (near, rest) = rest.split_at_mut((near_columns * capacity).min(rest.len()));
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
        let mut field = Field {
            scene,
            radius,
            mass,
            inverse_mass,
            drag,
            charge,
            springs,
            needs,
            tree: bytemuck::cast_slice_mut(tree),
            near: bytemuck::cast_slice_mut(near),
            first: old,
            evaluations: 0,
            observer,
        };

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
        let contacts = scene.contacts;
        let pieces = contacts.substeps();
        let (position, velocity) = (&mut position[..old], &mut velocity[..old]);
        let mut stage = Stage {
            scene,
            held,
            lists: Lists::default(),
            position,
            velocity,
            radius,
            inverse_mass,
            elasticity,
            material,
            now,
            h: dt,
            dt,
            pieces,
            piece: 0,
            report,
        };
        for piece in 0..pieces {
            let end = now + dt.part(piece + 1, pieces);
            (stage.piece, stage.h) = (piece, end - stage.now);
            contacts.gather(&mut stage, bytemuck::cast_slice_mut(rest));
            let start = match contacts.begin(stage.held, stage.position, stage.velocity) {
                Some(start) => start,
                None if scene.needs_start() => [&start_x[..old], &start_v[..old]],
                None => [&[][..]; 2],
            };
            let (hint, effort) = (&mut self.status.hint, &mut stage.report.effort);
            let work = Work { memory: rest, stride: capacity, len: old };
            let motion = Motion { position: stage.position, velocity: stage.velocity, start, work, hint, effort };
            scene.integrator.advance(motion, stage.now, stage.h, &mut field);
            contacts.project(&mut stage);
            stage.now = end;
        }
        report.effort.evaluations += field.evaluations;
    }

    /// Breaks the springs that are stretched too far.
    fn snap(&mut self, scene: &Scene<'_>, report: &mut Report) {
        for (number, spring) in scene.springs.iter().enumerate() {
            if spring.breaks_at.is_some() && spring.is_overstretched(number, &self.state(scene)) {
                let Slices { last_spring, incident, .. } = self.memory.slices();
                spring::mark_broken(number, spring, last_spring, incident);
                report.broken += 1;
            }
        }
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
        // Who has a number that cannot be used is taken out at the step's end, whichever it is. Any lifetime can be: one
        // that is no number or beyond all is for ever.
        let is_sound = Particle { lifetime: 0.0, ..*particle }.is_sound();
        let velocity = if particle.fixed { Vec3::ZERO } else { particle.velocity };
        m.velocity[row] = if is_sound { velocity } else { Vec3::NAN };
        m.radius[row] = particle.radius;
        m.mass[row] = particle.mass;
        m.inverse_mass[row] = if particle.fixed { 0.0 } else { 1.0 / particle.mass };
        m.drag[row] = particle.drag;
        m.charge[row] = particle.charge;
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
    radius: &'a [f32],
    mass: &'a [f32],
    inverse_mass: &'a [f32],
    drag: &'a [f32],
    charge: &'a [f32],
    springs: Springs<'a>,
    /// What the forces need to find, and memory for it.
    needs: Needs,
    tree: &'a mut [u32],
    near: &'a mut [u32],
    first: usize,
    evaluations: u64,
    observer: &'a mut dyn Observer,
}

impl<'a> Field<'a> {
    /// The state as it is, without trees and index.
    fn state<'s>(&self, time: Time, position: &'s [Vec3], velocity: &'s [Vec3]) -> State<'s>
    where
        'a: 's,
    {
        let len = position.len();
        let (radius, mass) = (&self.radius[..len], &self.mass[..len]);
        let (drag, charge, springs) = (&self.drag[..len], &self.charge[..len], self.springs);
        let (mass_tree, charge_tree, near) = (None, None, None);
        State { time, position, velocity, radius, mass, drag, charge, springs, mass_tree, charge_tree, near }
    }

    /// Calls `then` with the state as forces see it, trees and index made.
    fn with_state(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: &mut dyn FnMut(&State<'_>)) {
        self.evaluations += u64::from(!position.is_empty());
        let state = self.state(time, position, velocity);
        if self.needs.tree_columns() > 0 && position.len() >= BarnesHut::FEWEST {
            self.with_trees(&state, then);
        } else {
            self.with_neighbours(&state, then);
        }
    }

    /// Apart, so that whoever needs no trees has no room for them on the stack.
    #[inline(never)]
    fn with_trees(&mut self, state: &State<'_>, then: &mut dyn FnMut(&State<'_>)) {
        // No more memory than these particles call for: more would make other nodes, and so other bits.
        let words = 3 * BarnesHut::COLUMNS * state.position.len();
        let memory = core::mem::take(&mut self.tree);
        let first = if self.needs.mass_tree.is_some() { words.min(memory.len()) } else { 0 };
        let (of_mass, of_charge) = memory.split_at_mut(first);
        let second = words.min(of_charge.len());
        let grown = |grow: Option<Grow>, memory, weights| grow?(memory, state.position, weights);
        let mass_tree = grown(self.needs.mass_tree, of_mass, state.mass);
        let charge_tree = grown(self.needs.charge_tree, &mut of_charge[..second], state.charge);
        let (mass_tree, charge_tree) = (mass_tree.as_ref(), charge_tree.as_ref());
        self.with_neighbours(&State { mass_tree, charge_tree, ..*state }, then);
        self.tree = memory;
    }

    fn with_neighbours(&mut self, state: &State<'_>, then: &mut dyn FnMut(&State<'_>)) {
        let reach = self.needs.reach;
        if !(reach > 0.0) {
            return then(state);
        }
        let words = (3 * self.scene.index.columns() * state.position.len()).min(self.near.len());
        let then = &mut |near: Option<&dyn SpatialIndex>| then(&State { near, ..*state });
        self.scene.index.arrange(&mut self.near[..words], state.position, reach, then);
    }
}

impl Dynamics for Field<'_> {
    fn accelerations(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], acceleration: &mut [Vec3]) {
        let rows = self.first..position.len();
        let (forces, inverse_mass) = (self.scene.forces, &self.inverse_mass[rows.clone()]);
        self.with_state(time, position, velocity, &mut |state| {
            acceleration.fill(Vec3::ZERO);
            forces.add_to(state, rows.clone(), acceleration);
            state.springs.add_to(state, rows.clone(), acceleration);
        });
        each_row_with(acceleration, Vec3::ZERO, inverse_mass, |force, _, inverse| {
            // What is fixed stays so under a force that is beyond an f32.
            if inverse == 0.0 { 0.0 } else { force * inverse }
        });
    }

    fn linearise(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: &mut dyn FnMut(&Linear<'_>)) {
        let (forces, inverse_mass) = (self.scene.forces, &self.inverse_mass[..position.len()]);
        self.with_state(time, position, velocity, &mut |state| {
            then(&Linear { forces: &(forces, state.springs), state: *state, inverse_mass });
        });
    }

    fn reached(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3]) {
        let state = self.state(time, position, velocity);
        self.observer.after(Phase::Advance, &state);
    }
}
