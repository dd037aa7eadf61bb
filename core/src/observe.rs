//! Looking on while a step is made.

use crate::force::State;
use crate::particles::Id;
use crate::retire::Cause;
use crate::time::Time;
use glam::Vec3;

/// Watches the phases of a step: what ledgers and recorders of events are made of. `()` looks away.
pub trait Observer {
    /// The step has come so far.
    fn after(&mut self, phase: Phase, state: &State<'_>) {
        let _ = (phase, state);
    }

    /// A particle met a collider or another particle, and was answered.
    fn hit(&mut self, hit: &Impact) {
        let _ = hit;
    }

    /// A particle was born.
    fn born(&mut self, birth: &Passing) {
        let _ = birth;
    }

    /// A particle dies.
    fn died(&mut self, death: &Passing, cause: Cause) {
        let _ = (death, cause);
    }

    /// So many births up to an instant found no room.
    fn refused(&mut self, count: u64, time: Time) {
        let _ = (count, time);
    }
}

impl Observer for () {}

/// Where in a step one is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing has been done yet.
    Begin,
    /// Emitters have emitted; the newborn are where and when they were born.
    Create,
    /// The integrator has moved the old so far on its way through the step. The newborn have not moved yet.
    Advance,
    /// The integrator has moved the old to the step's end, and the newborn have flown there.
    Move,
    /// Springs that were stretched too far have broken.
    Snap,
    /// All have been held against colliders and sinks.
    Collide,
    /// Those whose time has come are gone.
    Delete,
}

/// A particle's meeting with a collider or with another particle; that of two particles is told of both, unless one of
/// them is fixed: nothing happens to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The particle.
    pub id: Id,
    /// Its row, during this step.
    pub row: usize,
    /// The particle it met; none: a collider.
    pub other: Option<Id>,
    /// Its mass \[kg\].
    pub mass: f32,
    /// Where its middle was \[m\].
    pub place: Vec3,
    /// Normal of the other's surface, toward the particle.
    pub normal: Vec3,
    /// The speed at which the two came together along it \[m/s\].
    pub closing: f32,
    /// Its velocity before \[m/s\].
    pub before: Vec3,
    /// Its velocity after \[m/s\].
    pub after: Vec3,
    /// The instant.
    pub time: Time,
}

/// A particle that has just been born, or is just about to be removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing {
    /// The particle.
    pub id: Id,
    /// Where \[m\].
    pub place: Vec3,
    /// Its velocity \[m/s\].
    pub velocity: Vec3,
    /// Its birth, or the end of the step in which it died.
    pub time: Time,
}
