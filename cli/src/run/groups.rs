//! How far the forces that take far groups as one are from the sums over all pairs.

use crate::world::World;
use pointmass::index::{BarnesHut, Opening};
use pointmass::{Coulomb, ForceKind, MutualGravity};
use serde::Serialize;

/// Particles at which the sums are held against each other, about so many.
const SAMPLED: usize = 1000;

/// The error of one force at one instant, as a share of the force on each particle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct GroupError {
    /// The force.
    pub(crate) force: &'static str,
    /// Its opening angle.
    pub(crate) theta: f32,
    /// Root mean square.
    pub(crate) rms: f64,
    /// The largest.
    pub(crate) largest: f64,
    /// Particles that were looked at.
    pub(crate) particles: usize,
}

/// The name of a force and how it takes far groups as one, if it does.
fn opening(force: &ForceKind) -> Option<(&'static str, Opening)> {
    let (name, law) = match *force {
        ForceKind::MutualGravity(MutualGravity { theta, softening, quadrupole, .. }) => {
            ("mutual_gravity", Opening { theta, softening, quadrupole })
        }
        ForceKind::Coulomb(Coulomb { theta, softening, quadrupole, .. }) => {
            ("coulomb", Opening { theta, softening, quadrupole })
        }
        _ => return None,
    };
    (law.theta > 0.0).then_some((name, law))
}

/// Tells whether a force of the scene takes far groups as one.
pub(super) fn are_taken(world: &World) -> bool {
    world.model.forces.0.iter().any(|force| opening(force).is_some())
}

/// The errors of all forces of the scene that have an opening angle, over the particles as they are.
pub(crate) fn errors(world: &World) -> Vec<GroupError> {
    let particles = world.system.particles();
    let mut memory = vec![0; BarnesHut::words(particles.position.len())];
    let error = |force: &ForceKind| {
        let (name, law) = opening(force)?;
        let weights = if let ForceKind::Coulomb(_) = force { particles.charge } else { particles.mass };
        let tree = BarnesHut::over(&mut memory, particles.position, weights)?;
        let stride = (particles.position.len() / SAMPLED).max(1);
        let error = tree.error(law, stride);
        let particles = particles.position.len().div_ceil(stride);
        Some(GroupError { force: name, theta: law.theta, rms: error.rms, largest: error.largest, particles })
    };
    world.model.forces.0.iter().filter_map(error).collect()
}
