//! Energy, momentum and angular momentum, in double precision: for reports, not for the step.

use crate::force::{Entry, Force};
use crate::memory::Storage;
use crate::scene::Scene;
use crate::system::System;

/// The energy and momentum of a system, all its particles taken together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Measures {
    /// Energy \[J\].
    pub energy: Energy,
    /// Σ m v \[kg m/s\]; particles that are fixed have none.
    pub momentum: [f64; 3],
    /// Σ m x × v about the origin \[kg m²/s\].
    pub angular_momentum: [f64; 3],
}

/// Energy \[J\], of all particles together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Energy {
    /// Σ m v² / 2.
    pub kinetic: f64,
    /// The potential energy of all forces that have one, and of the springs.
    pub potential: f64,
}

impl Energy {
    /// Kinetic and potential.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
}

impl Measures {
    /// Measures a system. Costs as much as one evaluation of the forces, in double precision.
    pub fn of<B: Storage>(system: &System<B>, scene: &Scene<'_>) -> Self {
        let state = system.state(scene);
        let mut sum = Self::default();
        for ((x, v), &m) in state.position.iter().zip(state.velocity).zip(state.mass) {
            let (x, v, m) = (x.to_array().map(f64::from), v.to_array().map(f64::from), f64::from(m));
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                sum.energy.kinetic += 0.5 * m * v[i] * v[i];
                sum.momentum[i] += m * v[i];
                sum.angular_momentum[i] += m * (x[j] * v[k] - x[k] * v[j]);
            }
        }
        sum.energy.potential = scene.forces.energy(&state) + state.springs.energy(&state);
        sum
    }

    /// Energy and power of every force by its name, that of the springs last.
    pub fn by_force<B: Storage>(system: &System<B>, scene: &Scene<'_>) -> std::vec::Vec<Entry> {
        let state = system.state(scene);
        let mut entries = std::vec::Vec::new();
        scene.forces.account(&state, &mut |entry| entries.push(entry));
        if !scene.springs.list().is_empty() {
            state.springs.account(&state, &mut |entry| entries.push(entry));
        }
        entries
    }
}
