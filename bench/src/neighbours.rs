//! Soft balls in a box, each with some 30 neighbours within reach.

use crate::cloud;
use pointmass::force::{PowerLaw, Weight};
use pointmass::{Particle, Radial, Time};

/// How far they feel each other \[m\].
pub const REACH: f32 = 0.1;
/// The length of a step.
pub const STEP: Time = Time::from_ticks(1 << 24);
/// The share of the reach that they go in a step by themselves.
pub const WAY: f32 = 0.01;

/// The force by which they part.
#[must_use]
pub const fn repulsion() -> Radial<PowerLaw> {
    Radial(PowerLaw { strength: -1e-3, exponent: 2, softening: 0.05, reach: REACH, weight: Weight::Mass })
}

/// So many at random places in a cube, of which each goes about `way` of the reach in a step.
#[must_use]
pub fn balls(count: usize, way: f32) -> Vec<Particle> {
    let volume = count as f64 * 4.0 / 3.0 * std::f64::consts::PI * f64::from(REACH).powi(3) / 30.0;
    let (side, speed) = (volume.cbrt() as f32, way * REACH / STEP.seconds());
    let mut places = cloud(count as u32);
    for Particle { position, velocity, .. } in &mut places {
        (*position, *velocity) = (*position * (0.5 * side), *velocity * speed);
    }
    places
}
