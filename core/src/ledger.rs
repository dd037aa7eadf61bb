//! The ledger: where energy went, in double precision.

use crate::force::{Entry, Force, State};
use crate::memory::Storage;
use crate::observe::{Impact, Observer, Phase, Sliding};
use crate::scene::Scene;
use crate::system::System;
use crate::time::Time;
use glam::Vec3;
use std::vec::Vec;

/// Keeps account of a system's energy while it is watched: hand it to [`System::step_observed`].
///
/// Energy that comes and goes by a cause is booked under it; the rest is the remainder, the error of the method and of
/// rounding. The work of a force is its power integrated over the step by Simpson's rule along the cubic through both
/// ends, which is of order 4: where steps are so long that this errs, the remainder shows it. Every sub-step costs about
/// four evaluations of all energies and powers.
///
/// ```
/// use pointmass::{Drag, Gravity, Heap, Ledger, Particle, Rk4, Scene, System, Time};
///
/// let start = [Particle { drag: 0.5, ..Particle::REST }];
/// let scene = Scene { start: &start, forces: &(Gravity::EARTH, Drag {}), integrator: &Rk4, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let mut ledger = Ledger::new(&system, &scene);
/// for _ in 0..60 {
///     system.step_observed(&scene, Time::frame(1, 60), &mut ledger);
/// }
/// let lost = ledger.books().work("drag");
/// assert!(lost < -10.0 && ledger.books().remainder.abs() < 1e-4);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ledger<'a> {
    scene: Scene<'a>,
    books: Books,
    /// The energy at the last look.
    energy: f64,
    /// Particles there were when the step began.
    old: usize,
    /// The old, as they were when last seen on their way through the step, and the power of each force then.
    from: Snapshot,
    powers: Vec<Entry>,
    /// The energy that hits and friction have taken since the last phase, and the work of scenery that moves.
    struck: [f64; 3],
    /// The energy of the newborn when they were last seen on their way through the step.
    newborn: f64,
}

/// The old particles at an instant.
#[derive(Clone, Debug, Default)]
struct Snapshot {
    time: Time,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
}

/// Energy \[J\] by cause: above zero what came in, below zero what was lost.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Books {
    /// Kinetic and potential energy when the books were opened.
    pub opening: f64,
    /// That of the newborn, at the end of the step in which they were born; and that of the mass which materials let come and go.
    pub emission: f64,
    /// The work of forces that are not the slope of an energy, by name.
    pub work: Vec<(&'static str, f64)>,
    /// Lost in hits by elasticities below one.
    pub restitution: f64,
    /// Lost by dry friction on colliders and, by [`Impulse`](crate::Impulse), of particles on each other: in hits and while
    /// they slide.
    pub friction: f64,
    /// Taken and given by constraints, contacts by position among them: restitution, friction, and what they store
    /// while they give way.
    pub constraints: f64,
    /// The work of scenery that moves on what it hits, lifts and drags along.
    pub scenery: f64,
    /// Set free, or taken along, by springs that broke.
    pub breaking: f64,
    /// Gone with particles that died.
    pub deletion: f64,
    /// Brought in or taken out between steps, by the program's own hand.
    pub outside: f64,
    /// The error of the method and of rounding.
    pub remainder: f64,
    /// Kinetic and potential energy now.
    pub closing: f64,
}

impl Books {
    /// The work of the forces of this name.
    #[must_use]
    pub fn work(&self, name: &str) -> f64 {
        self.work.iter().filter(|(found, _)| *found == name).map(|(_, work)| work).sum()
    }

    /// Everything that came in, the remainder included: closing − opening, up to rounding.
    #[must_use]
    pub fn total(&self) -> f64 {
        let work: f64 = self.work.iter().map(|(_, work)| work).sum();
        let causes = self.emission + self.restitution + self.friction + self.constraints + self.scenery;
        let causes = causes + self.breaking + self.deletion;
        work + causes + self.outside + self.remainder
    }

    /// Energy that changed hands: the scale for the remainder.
    #[must_use]
    pub fn turnover(&self) -> f64 {
        let work: f64 = self.work.iter().map(|(_, work)| work.abs()).sum();
        let Self { emission, restitution, friction, constraints, scenery, breaking, deletion, outside, .. } = *self;
        let others = [emission, restitution, friction, constraints, scenery, breaking, deletion, outside];
        work + others.iter().map(|x| x.abs()).sum::<f64>()
    }

    fn add_work(&mut self, name: &'static str, work: f64) {
        match self.work.iter_mut().find(|(found, _)| *found == name) {
            Some((_, sum)) => *sum += work,
            None => self.work.push((name, work)),
        }
    }
}

/// Kinetic energy and that of all forces \[J\].
pub(crate) fn energy(scene: &Scene<'_>, state: &State<'_>) -> f64 {
    kinetic(state) + scene.forces.energy(state) + state.springs.energy(state)
}

/// Σ m v² / 2 \[J\].
pub(crate) fn kinetic(state: &State<'_>) -> f64 {
    state.velocity.iter().zip(state.mass).map(|(v, &m)| 0.5 * f64::from(m) * square(*v)).sum()
}

fn square(v: Vec3) -> f64 {
    v.to_array().iter().map(|&x| f64::from(x) * f64::from(x)).sum()
}

impl<'a> Ledger<'a> {
    /// Opens the books on a system as it is now.
    pub fn new<B: Storage>(system: &System<B>, scene: &Scene<'a>) -> Self {
        let energy = energy(scene, &system.state(scene));
        let books = Books { opening: energy, closing: energy, ..Books::default() };
        Self {
            scene: *scene,
            books,
            energy,
            old: system.len(),
            from: Snapshot::default(),
            powers: Vec::new(),
            struck: [0.0; 3],
            newborn: 0.0,
        }
    }

    /// The books so far.
    #[must_use]
    pub fn books(&self) -> &Books {
        &self.books
    }

    /// The change of the energy since the last look. While a particle is beyond all numbers it is not looked at: that
    /// goes at the end of the step, and takes its energy with it.
    fn change(&mut self, state: &State<'_>) -> f64 {
        let now = energy(&self.scene, state);
        if !now.is_finite() {
            return 0.0;
        }
        now - core::mem::replace(&mut self.energy, now)
    }

    fn strike(&mut self, changes: [f64; 3]) {
        // One beyond all numbers goes at the end of the step, and takes its energy with it.
        if changes.iter().all(|change| change.is_finite()) {
            self.struck.iter_mut().zip(changes).for_each(|(sum, change)| *sum += change);
        }
    }

    fn powers(&self, state: &State<'_>) -> Vec<Entry> {
        let mut entries = Vec::new();
        let mut keep = |entry: Entry| entries.push(entry);
        self.scene.forces.account(state, &mut keep);
        state.springs.account(state, &mut keep);
        entries
    }

    /// Begins the way of the old through a step.
    fn depart(&mut self, state: &State<'_>) {
        self.old = state.position.len();
        self.from.set(state);
        self.powers = self.powers(state);
    }

    /// Begins the way of the old through a sub-step that may follow.
    fn go_on(&mut self, state: &State<'_>) {
        let old = first(state, self.old);
        if old.position.len() < state.position.len() {
            let newborn = self.energy - energy(&self.scene, &old);
            self.newborn = if newborn.is_finite() { newborn } else { 0.0 };
        }
        self.from.set(&old);
        self.powers = self.powers(&old);
    }

    /// Takes what the newborn have back out of what emission has given: it brings in all that they have when they have flown on.
    fn set_newborn_aside(&mut self) {
        let newborn = core::mem::take(&mut self.newborn);
        self.energy -= newborn;
        self.books.emission -= newborn;
    }

    /// Books the work that forces have done on the way here.
    fn arrive(&mut self, state: &State<'_>) {
        let h = (state.time - self.from.time).seconds_f64();
        if h > 0.0 {
            let middle = self.from.middle(state, h as f32);
            let half = self.powers(&middle.state(state));
            let last = self.powers(state);
            for ((first, half), last) in self.powers.iter().zip(&half).zip(&last) {
                let work = h / 6.0 * (first.power + 4.0 * half.power + last.power);
                let acts = first.power != 0.0 || half.power != 0.0 || last.power != 0.0;
                if acts && work.is_finite() {
                    self.books.add_work(first.name, work);
                    self.books.remainder -= work;
                }
            }
            self.from.set(state);
            self.powers = last;
        }
    }
}

impl Snapshot {
    fn set(&mut self, state: &State<'_>) {
        self.time = state.time;
        self.position.clear();
        self.position.extend_from_slice(state.position);
        self.velocity.clear();
        self.velocity.extend_from_slice(state.velocity);
    }

    /// The state halfway along the cubic through both.
    fn middle(&self, to: &State<'_>, h: f32) -> Self {
        let ends = || self.position.iter().zip(&self.velocity).zip(to.position.iter().zip(to.velocity));
        Self {
            time: self.time + (to.time - self.time).half(),
            position: ends().map(|((x0, v0), (x1, v1))| (*x0 + *x1) * 0.5 + (*v0 - *v1) * (h / 8.0)).collect(),
            velocity: ends().map(|((x0, v0), (x1, v1))| (*x1 - *x0) * (1.5 / h) - (*v0 + *v1) * 0.25).collect(),
        }
    }

    /// These particles with all else as in `other`.
    fn state<'s>(&'s self, other: &State<'s>) -> State<'s> {
        other.moved(self.time, &self.position, &self.velocity)
    }
}

/// The first `len` of them.
fn first<'s>(state: &State<'s>, len: usize) -> State<'s> {
    let len = len.min(state.position.len());
    state.moved(state.time, &state.position[..len], &state.velocity[..len])
}

impl Observer for Ledger<'_> {
    fn after(&mut self, phase: Phase, state: &State<'_>) {
        match phase {
            Phase::Begin | Phase::Delete => self.newborn = 0.0,
            Phase::Advance | Phase::Project | Phase::Move => self.set_newborn_aside(),
            _ => {}
        }
        match phase {
            Phase::Begin => {
                let change = self.change(state);
                self.books.outside += change;
                self.depart(state);
            }
            // Materials have changed what the old weigh.
            Phase::Create if self.scene.materials.code().is_some() => {
                let old = first(state, self.old);
                let change = self.change(&old);
                self.books.emission += change;
                self.powers = self.powers(&old);
            }
            Phase::Create => {}
            Phase::Advance => self.arrive(state),
            Phase::Project => {
                let change = self.change(state);
                self.books.remainder += change;
            }
            Phase::Constrain => {
                let change = self.change(state);
                self.books.constraints += change;
                self.from.set(state);
                self.powers = self.powers(state);
            }
            Phase::Move => {
                let old = first(state, self.old);
                self.arrive(&old);
                let change = self.change(&old);
                self.books.remainder += change;
                let change = self.change(state);
                self.books.emission += change;
            }
            Phase::Snap => self.books.breaking += self.change(state),
            Phase::Collide => {
                let (change, struck) = (self.change(state), core::mem::take(&mut self.struck));
                let [restitution, friction, scenery] = struck;
                self.books.restitution += restitution;
                self.books.friction += friction;
                self.books.scenery += scenery;
                self.books.remainder += change - restitution - friction - scenery;
                self.go_on(state);
            }
            Phase::Age => self.books.emission += self.change(state),
            Phase::Delete => self.books.deletion += self.change(state),
        }
        self.books.closing = self.energy;
    }

    /// As seen from the surface the speed along the normal is restitution's and that along it friction's.
    fn hit(&mut self, hit: &Impact) {
        let half = 0.5 * f64::from(hit.mass);
        let [before, after] = [hit.before, hit.after].map(|v| v - hit.surface);
        let normal = |v: Vec3| dot(v, hit.normal) * dot(v, hit.normal);
        let restitution = half * (normal(after) - normal(before));
        let friction = half * (square(after) - square(before)) - restitution;
        let whole = half * (square(hit.after) - square(hit.before));
        self.strike([restitution, friction, whole - restitution - friction]);
    }

    /// Books what forces do not account for: along the surface friction, and in the world the surface's work as well.
    fn slid(&mut self, slide: &Sliding) {
        let mass = f64::from(slide.mass);
        let gained =
            |[pull, way, first, last]: [Vec3; 4]| mass * (0.5 * (square(last) - square(first)) - dot(pull, way));
        let friction = gained(slide.along);
        // The energy of its fall until it touches is given back: it was lost in the hit.
        let raised = -mass * dot(slide.world[0], slide.raised);
        self.strike([raised, friction, gained(slide.world) - friction]);
    }
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a.to_array().into_iter().zip(b.to_array()).map(|(a, b)| f64::from(a) * f64::from(b)).sum()
}
