//! How much forces brake particles as a scene starts that brake the more the faster these or the air about them is, or the more are around them.

use super::net::wide;
use super::world::MOST;
use crate::stall::gravity;
use pointmass::force::{Aerodynamics, CylinderDrag, Flow, FlowKind};
use pointmass::scene::Model;
use pointmass::{Emitter, ForceKind, Particle, Time, Vec3, Viscosity};

/// The instants at which winds are looked at, and the time between them \[s\].
const INSTANTS: u64 = 17;
const APART: f64 = 0.5;

/// The braking of a scene's start.
pub(crate) struct Onset {
    /// The coefficient of all drag that grows with the square of the speed \[kg/m\].
    quadratic: f64,
    /// The uniform acceleration of all \[m/s²\].
    gravity: f64,
    /// How much its neighbours, and the air about what it is a corner or an end of, brake each particle of the start \[kg/s\].
    around: Vec<f64>,
}

impl Onset {
    pub(crate) fn of(model: &Model) -> Self {
        let square =
            |force: &ForceKind| if let ForceKind::QuadraticDrag(drag) = force { drag.coefficient } else { 0.0 };
        Self {
            quadratic: model.forces.0.iter().map(|force| f64::from(square(force).max(0.0))).sum(),
            gravity: wide(gravity(model)).norm(),
            around: crowd(model).into_iter().zip(air(model)).map(|(crowd, air)| crowd + air).collect(),
        }
    }

    /// Nothing of it, for what has to hold as long as a scene runs.
    pub(crate) fn none() -> Self {
        Self { quadratic: 0.0, gravity: 0.0, around: Vec::new() }
    }

    /// How much particle `number` of the start is braked that weighs `mass` \[kg\] where it is lightest \[kg/s\].
    pub(crate) fn of_particle(&self, number: usize, particle: &Particle, mass: f64) -> f64 {
        let around = self.around.get(number).copied().unwrap_or(0.0);
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
    let mut sums = vec![0.0; model.particles.len()];
    let particles = &model.particles[..model.particles.len().min(MOST)];
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

/// How much the air brakes each corner of a surface and each end of a segment at the most, in the winds of the first seconds, from wherever these
/// come \[kg/s\]: how forces grow with speeds, which where drag grows with the square of the speed is twice what it has for each metre a second.
fn air(model: &Model) -> Vec<f64> {
    let mut most = vec![0.0; model.particles.len()];
    let blows = |force: &ForceKind| matches!(force, ForceKind::Aerodynamics(_) | ForceKind::CylinderDrag(_));
    if !model.forces.0.iter().any(blows) {
        return most;
    }
    for instant in 0..INSTANTS {
        let time = Time::from_seconds_f64(instant as f64 * APART);
        let mut sums = vec![0.0; most.len()];
        for force in &model.forces.0 {
            match force {
                ForceKind::Aerodynamics(air) => brake_corners(air, model, time, &mut sums),
                ForceKind::CylinderDrag(air) => brake_ends(air, model, time, &mut sums),
                _ => {}
            }
        }
        most.iter_mut().zip(sums).for_each(|(most, sum)| *most = sum.max(*most));
    }
    most
}

/// The speed of the air about some particles, as the mean of them sees it \[m/s\].
fn wind(field: &Vec<FlowKind>, about: &[&Particle], time: Time) -> f64 {
    let mean = |of: fn(&Particle) -> Vec3| about.iter().map(|particle| of(particle)).sum::<Vec3>() / about.len() as f32;
    let (place, velocity) = (mean(|particle| particle.position), mean(|particle| particle.velocity));
    wide(field.velocity(place, time) - velocity).norm()
}

/// Each corner bears a third of what a triangle feels, ρ A |u| C for each metre a second at the most.
fn brake_corners(air: &Aerodynamics<Vec<[u32; 3]>, Vec<FlowKind>>, model: &Model, time: Time, sums: &mut [f64]) {
    let coefficient = f64::from(air.drag.max(air.friction).max(air.lift.abs()));
    for corners in &air.triangles {
        let [a, b, c] = corners.map(|corner| &model.particles[corner as usize]);
        let double = wide(b.position - a.position).cross(&wide(c.position - a.position)).norm();
        let brake = 0.5 * double * f64::from(air.density) * wind(&air.field, &[a, b, c], time) * coefficient;
        corners.iter().for_each(|&corner| sums[corner as usize] += brake / 3.0);
    }
}

/// Each end bears half of what a segment feels.
fn brake_ends(air: &CylinderDrag<Vec<[u32; 2]>, Vec<FlowKind>>, model: &Model, time: Time, sums: &mut [f64]) {
    for ends in &air.segments {
        let [a, b] = ends.map(|end| &model.particles[end as usize]);
        let half = 0.5 * wide(b.position - a.position).norm();
        for (&end, particle) in ends.iter().zip([a, b]) {
            let brake = air.across(wind(&air.field, &[particle], time) as f32);
            sums[end as usize] += 2.0 * f64::from(brake) * half;
        }
    }
}

/// How much two particles drag each other along \[kg/s\].
fn weight(viscosity: &Viscosity, a: &Particle, b: &Particle) -> f64 {
    let share = 1.0 - (wide(a.position) - wide(b.position)).norm() / f64::from(viscosity.reach);
    let weight = f64::from(viscosity.coefficient) * f64::from(a.mass) * f64::from(b.mass) * share;
    if share > 0.0 { weight.max(0.0) } else { 0.0 }
}
