//! Barnes and Hut's sums against those over all pairs in double precision, by themselves and as a force.

mod arithmetic;
mod file;
mod force;
mod memory;
mod sums;
mod system;

use pointmass::index::Opening;
use pointmass::{MutualGravity, Particle, Vec3};
use pointmass_tests::Random;
use pointmass_tests::fields::Charges;

/// Half of the distance between neighbouring numbers about one.
const EPSILON: f64 = 6e-8;

const fn law(theta: f32, softening: f32, quadrupole: bool) -> Opening {
    Opening { theta, softening, quadrupole }
}

/// Both kinds of moments.
const BOTH: [bool; 2] = [false, true];

const UNIT: MutualGravity = MutualGravity { constant: 1.0, softening: 0.01, theta: 0.5, quadrupole: false };

/// Particles at some points, with their weights as masses.
fn particles(charges: &Charges) -> Vec<Particle> {
    let particle = |(&position, &mass): (&Vec3, &f32)| Particle { position, mass, ..Particle::REST };
    charges.points.iter().zip(&charges.weights).map(particle).collect()
}

/// Points that come closer and closer to one place: whoever divides space needs a node or two for each of them.
fn nested(n: usize) -> Charges {
    let mut random = Random::new(1);
    let place = |i: usize| Vec3::splat(0.5) + random.direction() * 0.8f32.powi((i % 80) as i32);
    Charges { points: (0..n).map(place).collect(), weights: vec![1.0; n] }
}
