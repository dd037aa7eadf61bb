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

/// The errors of all forces of the scene that have an opening angle, over the particles as they are.
pub(crate) fn errors(world: &World) -> Vec<GroupError> {
    let particles = world.system.particles();
    let mut memory = vec![0; BarnesHut::words(particles.position.len())];
    let mut measured = |force: &'static str, law: Opening, weights: &[f32]| {
        let tree = BarnesHut::over(&mut memory, particles.position, weights).filter(|_| law.theta > 0.0)?;
        let stride = (particles.position.len() / SAMPLED).max(1);
        let error = tree.error(law, stride);
        let particles = particles.position.len().div_ceil(stride);
        Some(GroupError { force, theta: law.theta, rms: error.rms, largest: error.largest, particles })
    };
    let forces = world.model.forces.0.iter();
    let error = |force: &ForceKind| match *force {
        ForceKind::MutualGravity(MutualGravity { theta, softening, quadrupole, .. }) => {
            measured("mutual_gravity", Opening { theta, softening, quadrupole }, particles.mass)
        }
        ForceKind::Coulomb(Coulomb { theta, softening, quadrupole, .. }) => {
            measured("coulomb", Opening { theta, softening, quadrupole }, particles.charge)
        }
        _ => None,
    };
    forces.filter_map(error).collect()
}
