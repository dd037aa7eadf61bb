//! Loads of particles: constraints lay something on them, and others solve for them with that.

use super::Bodies;
use core::cmp::max;
use glam::Vec3;

/// The values of [`Load::solved`](super::load::Load) for a particle that is solved for with others, and for one that bears what is laid on it there.
const JOINED: u32 = 1;
const BEARS: u32 = 2;

impl Bodies<'_> {
    /// Says as a sub-step is prepared that a constraint bears what is laid on a particle: it solves for the particle with [that](Self::load), and
    /// says when it [takes both up](Self::take_up) and [puts them down](Self::put_down).
    pub fn bear(&mut self, row: usize) {
        if let Some(load) = self.loads.get_mut(row) {
            load.solved = BEARS;
        }
    }

    /// Says as a sub-step is prepared that a constraint solves for a particle and many others at once, without what is laid on it. A rigid [`Tie`](super::Tie)
    /// to a particle of another such constraint lays neither on the other.
    pub fn join(&mut self, row: usize) {
        if let Some(load) = self.loads.get_mut(row) {
            load.solved = max(load.solved, JOINED);
        }
    }

    /// Moves a particle that is held to where its velocity leads, so that what hangs still shows no speed: a constraint answers forces by what they do
    /// in a whole sub-step, as a method of first order shows it, and methods of higher order go half as far.
    pub(crate) fn catch_up(&mut self, row: usize) {
        let lead = self.lead(row, self.substep.seconds());
        if lead.is_finite() {
            self.position[row] -= lead;
        }
        if let Some(load) = self.loads.get_mut(row) {
            load.caught_up = 1;
        }
    }

    /// Bears all that is laid on particles by their place in the scene's start.
    pub(super) fn bear_all(&mut self, particles: &[u32]) {
        self.each_of(particles, Self::bear);
    }

    /// Joins all particles of such places in the scene's start, as [`join`](Self::join) does one.
    pub(super) fn join_all(&mut self, particles: &[u32]) {
        self.each_of(particles, Self::join);
    }

    fn each_of(&mut self, particles: &[u32], then: fn(&mut Self, usize)) {
        let particles = if self.loads.is_empty() { &[] } else { particles };
        for &particle in particles {
            if let Some(row) = self.row_of_start(particle) {
                then(self, row);
            }
        }
    }

    /// Tells whether what is laid on a particle is borne.
    #[must_use]
    pub fn is_borne(&self, row: usize) -> bool {
        self.loads.get(row).is_some_and(|load| load.solved == BEARS)
    }

    /// Tells whether a constraint solves for a particle and many others at once, with what is laid on it or without.
    #[must_use]
    pub fn is_joined(&self, row: usize) -> bool {
        self.loads.get(row).is_some_and(|load| load.solved > 0)
    }

    /// Says as a sub-step is prepared that one more constraint holds a particle, or the body of which it is the first, to others.
    pub fn hold(&mut self, row: usize) {
        if let Some(load) = self.loads.get_mut(row) {
            load.holders += 1;
        }
    }

    /// The number of constraints that hold a particle, or the body of which it is the first: each bears its part.
    #[must_use]
    pub fn holders(&self, row: usize) -> u32 {
        self.loads.get(row).map_or(1, |load| load.holders.max(1))
    }

    /// Lays something on a particle as a sub-step begins, so heavy \[kg\] and so far beside it as that began \[m\]: infinitely heavy, if nothing moves it.
    pub fn lay_on(&mut self, row: usize, mass: f32, beside: Vec3) {
        if let Some(load) = self.loads.get_mut(row).filter(|_| mass > 0.0) {
            load.mass += mass;
            load.moment += if mass < f32::INFINITY && beside.is_finite() { beside * mass } else { Vec3::ZERO };
        }
    }

    /// How heavy what is laid on a particle is \[kg\].
    #[must_use]
    pub fn load(&self, row: usize) -> f32 {
        self.loads.get(row).map_or(0.0, |load| load.mass)
    }

    /// The moment of what is laid on a particle about it, as the sub-step began \[kg m\].
    #[must_use]
    pub fn load_moment(&self, row: usize) -> Vec3 {
        self.loads.get(row).map_or(Vec3::ZERO, |load| load.moment)
    }

    /// The inverse mass of a particle with all that is laid on it \[1/kg\]; zero in a row that there is not.
    #[must_use]
    pub fn laden_inverse(&self, row: usize) -> f32 {
        let (inverse, load) = (self.inverse_mass.get(row).copied().unwrap_or(0.0), self.load(row));
        if load > 0.0 && inverse > 0.0 { inverse / (1.0 + inverse * load) } else { inverse }
    }

    /// Says that a particle is about to be moved with what is laid on it.
    pub fn take_up(&mut self, row: usize) {
        let (Some(&x), Some(&v)) = (self.position.get(row), self.velocity.get(row)) else { return };
        let now = [x, v];
        if let Some(load) = self.loads.get_mut(row).filter(|load| load.mass > 0.0) {
            load.by = [load.by[0] - now[0], load.by[1] - now[1]];
        }
    }

    /// Says that it has been: whoever has laid that on the particle gives it the impulse.
    pub fn put_down(&mut self, row: usize) {
        let (Some(&x), Some(&v)) = (self.position.get(row), self.velocity.get(row)) else { return };
        let now = [x, v];
        if let Some(load) = self.loads.get_mut(row).filter(|load| load.mass > 0.0) {
            let by = [load.by[0] + now[0], load.by[1] + now[1]];
            load.by = if by.iter().all(|by| by.is_finite()) { by } else { [Vec3::ZERO; 2] };
        }
    }

    /// Tells whether a particle has been moved to where its velocity leads, as it is held: what is laid on it then has to be as well.
    pub(super) fn is_caught_up(&self, row: usize) -> bool {
        self.loads.get(row).is_some_and(|load| load.caught_up > 0)
    }

    /// How far a particle has been moved with what is laid on it \[m\], and how much faster \[m/s\].
    #[must_use]
    pub fn borne(&self, row: usize) -> [Vec3; 2] {
        self.loads.get(row).map_or([Vec3::ZERO; 2], |load| load.by)
    }
}
