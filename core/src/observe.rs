//! Looking on while a step is made.

use crate::force::State;
use glam::Vec3;

/// Watches the phases of a step: what ledgers and recorders of events are made of. `()` looks away.
pub trait Observer {
    /// The step has come so far.
    fn after(&mut self, phase: Phase, state: &State<'_>) {
        let _ = (phase, state);
    }

    /// A particle met a collider and was answered.
    fn hit(&mut self, hit: &Impact) {
        let _ = hit;
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

/// A particle's meeting with a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The particle's row.
    pub row: usize,
    /// Its mass \[kg\].
    pub mass: f32,
    /// The surface's normal on the particle's side.
    pub normal: Vec3,
    /// Its velocity before \[m/s\].
    pub before: Vec3,
    /// Its velocity after \[m/s\].
    pub after: Vec3,
}
