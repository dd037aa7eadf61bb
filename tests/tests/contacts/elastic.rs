//! Hard balls without loss keep their energy for minutes, in any gravity.

use pointmass::shape::Plane;
use pointmass::{Gravity, Meetings, Method, Particle, Scene, Vec3};
use pointmass_tests::{G, f64s, run, started};

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

/// Kinetic energy and that of height \[J\].
fn energy<'p>(mass: &'p [f32], position: &'p [Vec3], velocity: &'p [Vec3], gravity: f64) -> f64 {
    let each = mass.iter().zip(position.iter().zip(velocity));
    each.map(|(&m, (x, v))| {
        f64::from(m) * (0.5 * f64s(*v).iter().map(|v| v * v).sum::<f64>() + gravity * f64::from(x.y))
    })
    .sum()
}

fn check(name: &str, start: &[Particle], gravity: f64) {
    let forces = Gravity { acceleration: Vec3::NEG_Y * gravity as f32 };
    for (rate, share) in [(60.0, 1e-4), (7.0, 1e-3)] {
        for method in [Method::Midpoint, Method::Verlet, Method::Rk4] {
            // The lowest of three may come to rest on the floor for a seventh of a second while the others press on it.
            if start.len() == 3 && rate < 60.0 {
                continue;
            }
            let integrator = method.integrator();
            let meetings = Meetings::IMPULSE;
            let scene = Scene { start, forces: &forces, colliders: &FLOOR, meetings, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 1);
            let energy = |system: &pointmass::System<pointmass::Heap>| {
                let p = system.particles();
                energy(p.mass, p.position, p.velocity, gravity)
            };
            let before = energy(&system);
            run(&mut system, &scene, 1.0 / rate, (300.0 * rate) as u32);
            let drift = energy(&system) / before - 1.0;
            assert!(system.totals().contacts > 100, "{name}: {:?}", system.totals());
            assert!(drift.abs() < share, "{name}, {method}, {rate} steps/s: {drift} of {before} {:?}", system.totals());
        }
    }
}

#[test]
fn on_a_ball_that_is_fixed_and_on_each_other() {
    let ball = |y: f32, radius: f32, mass: f32| Particle {
        position: Vec3::new(0.5, y, -0.25),
        radius,
        mass,
        elasticity: 1.0,
        ..Particle::REST
    };
    for gravity in [G, 1.62, 24.8] {
        let fixed = Particle { fixed: true, mass: 1e-6, ..ball(0.5, 0.5, 1.0) };
        check("on a fixed ball", &[fixed, ball(2.2, 0.2, 1.0)], gravity);
        check("one over the other", &[ball(1.5, 0.3, 1.0), ball(3.0, 0.2, 0.5)], gravity);
        check("a column", &[ball(1.0, 0.2, 1.0), ball(2.0, 0.2, 2.0), ball(4.0, 0.3, 0.7)], gravity);
    }
}
