//! The forces against closed forms, conservation laws, and sums in double precision.

mod charge;
mod cylinders;
mod files;
mod laws;
mod near;
mod pressure;
mod slopes;
mod sums;
mod wind;

use pointmass::{Force, Heap, MutualGravity, Particle, Scene, Sink, System, Time, Vec3};
use pointmass_tests::{Form, Random, f64s, gap, started};

const UNIT: MutualGravity = MutualGravity { constant: 1.0, softening: 0.0, ..MutualGravity::NEWTON };

/// The lecture's sink, about the origin.
fn sink(shape: Form) -> Sink<pointmass::shape::Mesh<'static>> {
    Sink { shape, group: None, intensity: 10.0, ca: 1.0, la: 0.5, qa: 0.25, softening: 0.0 }
}

/// The forces \[N\] on all particles of a system.
fn forces(system: &System<Heap>, scene: &Scene<'_>, force: &dyn Force) -> Vec<Vec3> {
    let mut total = vec![Vec3::ZERO; system.len()];
    force.add_to(&system.state(scene), 0..system.len(), &mut total);
    total
}

/// A cloud with some coincident particles and a fixed one.
fn cloud(n: usize) -> Vec<Particle> {
    let mut random = Random::new(4);
    let mut start: Vec<Particle> = (0..n)
        .map(|_| Particle {
            position: random.vector(1.0),
            velocity: random.vector(0.5),
            mass: random.magnitude(0.1, 10.0),
            drag: random.unit(),
            ..Particle::REST
        })
        .collect();
    start[n / 2].position = start[0].position;
    start[n - 1].fixed = true;
    start
}

/// The time at which the distance between the first two particles falls to `distance`.
fn time_to(scene: &Scene<'_>, h: f64, distance: f64) -> f64 {
    let mut system = started(scene, scene.start.len(), 0);
    for i in 1..100_000 {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        let p = system.particles();
        let d = gap(f64s(p.position[0]), f64s(p.position[1]));
        if d <= distance {
            // Back to the crossing at the present speed: within a step, so its square is what is left out.
            return system.time().seconds_f64() - (distance - d) / gap(f64s(p.velocity[0]), f64s(p.velocity[1]));
        }
    }
    f64::INFINITY
}
