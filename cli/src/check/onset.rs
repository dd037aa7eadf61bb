//! How much forces brake particles as a scene starts that brake the more the faster these are, or the more are around them.

use super::net::wide;
use super::world::MOST;
use crate::stall::gravity;
use pointmass::scene::Model;
use pointmass::{Emitter, ForceKind, Particle, Viscosity};

/// The braking of a scene's start.
pub(crate) struct Onset {
    /// The coefficient of all drag that grows with the square of the speed \[kg/m\].
    quadratic: f64,
    /// The uniform acceleration of all \[m/s²\].
    gravity: f64,
    /// How much its neighbours brake each particle of the start \[kg/s\].
    crowd: Vec<f64>,
}

impl Onset {
    pub(crate) fn of(model: &Model) -> Self {
        let square =
            |force: &ForceKind| if let ForceKind::QuadraticDrag(drag) = force { drag.coefficient } else { 0.0 };
        Self {
            quadratic: model.forces.0.iter().map(|force| f64::from(square(force).max(0.0))).sum(),
            gravity: wide(gravity(model)).norm(),
            crowd: crowd(model),
        }
    }

    /// Nothing of it, for what has to hold as long as a scene runs.
    pub(crate) fn none() -> Self {
        Self { quadratic: 0.0, gravity: 0.0, crowd: Vec::new() }
    }

    /// How much particle `number` of the start is braked that weighs `mass` \[kg\] where it is lightest \[kg/s\].
    pub(crate) fn of_particle(&self, number: usize, particle: &Particle, mass: f64) -> f64 {
        let around = self.crowd.get(number).copied().unwrap_or(0.0);
        self.square(wide(particle.velocity).norm(), mass) + around
    }

    /// How much those are braked that an emitter bears \[kg/s\].
    pub(crate) fn of_born<S, M>(&self, emitter: &Emitter<S, M>, mass: f64) -> f64 {
        let speed = f64::from(emitter.speed.mean.abs() + emitter.speed.half_width.abs());
        self.square(speed + wide(emitter.velocity).norm() * f64::from(emitter.inherit.abs()), mass)
    }

    /// The slope of the drag k v², 2 k v, at the speed of the start, or that at which gravity is no more than the drag.
    fn square(&self, speed: f64, mass: f64) -> f64 {
        let falling = (mass * self.gravity / self.quadratic).sqrt();
        if self.quadratic > 0.0 { 2.0 * self.quadratic * speed.max(falling) } else { 0.0 }
    }
}

/// How much viscosity brakes each of the first few thousand particles at the most \[kg/s\]: the row sums of its matrix, in coordinates
/// scaled by the roots of the masses, which no eigenvalue exceeds.
fn crowd(model: &Model) -> Vec<f64> {
    let particles = &model.particles[..model.particles.len().min(MOST)];
    let mut sums = vec![0.0; particles.len()];
    for force in &model.forces.0 {
        let ForceKind::Viscosity(viscosity) = force else { continue };
        for (i, a) in particles.iter().enumerate() {
            for (j, b) in particles[..i].iter().enumerate() {
                let weight = weight(viscosity, a, b);
                let root = if a.fixed || b.fixed { 0.0 } else { (f64::from(a.mass) / f64::from(b.mass)).sqrt() };
                sums[i] += weight * (1.0 + root);
                sums[j] += weight * if root > 0.0 { 1.0 + 1.0 / root } else { 1.0 };
            }
        }
    }
    sums
}

/// How much two particles drag each other along \[kg/s\].
fn weight(viscosity: &Viscosity, a: &Particle, b: &Particle) -> f64 {
    let share = 1.0 - (wide(a.position) - wide(b.position)).norm() / f64::from(viscosity.reach);
    let weight = f64::from(viscosity.coefficient) * f64::from(a.mass) * f64::from(b.mass) * share;
    if share > 0.0 { weight.max(0.0) } else { 0.0 }
}
