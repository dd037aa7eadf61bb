//! Hard balls at rest on balls.

use pointmass::force::Friction;
use pointmass::{ContactMaterial, Gravity, Meetings, Method, Particle, Scene, Vec3};
use pointmass_tests::{run, started};

/// A ball that lies on a fixed one, where that slopes by so many degrees.
fn perched(degrees: f32, mu: f32, method: Method, rate: f64, seconds: f64) -> (Vec3, Vec3) {
    let materials = [ContactMaterial { elasticity: Some(0.0), friction: Some(Friction { static_: mu, kinetic: mu }) }];
    let ball = Particle { radius: 0.5, elasticity: 0.0, material: Some(0), ..Particle::REST };
    let (sin, cos) = degrees.to_radians().sin_cos();
    let start = [Particle { fixed: true, ..ball }, Particle { position: Vec3::new(0.6 * sin, cos, 0.8 * sin), ..ball }];
    let (forces, meetings, integrator) = (&Gravity::EARTH, Meetings::IMPULSE, method.integrator());
    let scene = Scene { start: &start, forces, meetings, materials: &materials, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 1);
    run(&mut system, &scene, 1.0 / rate, (rate * seconds) as u32);
    (system.particles().position[1] - start[1].position, system.particles().velocity[1])
}

#[test]
fn what_friction_can_hold_stays() {
    for method in [Method::Symplectic, Method::Midpoint, Method::Verlet, Method::Rk4, Method::Adaptive] {
        for rate in [10.0, 60.0, 240.0] {
            for (degrees, mu) in [(0.0, 0.5), (0.8, 0.5), (10.0, 0.3), (30.0, 0.7)] {
                let (way, velocity) = perched(degrees, mu, method, rate, 10.0);
                let still = way.length() < 2e-5 && velocity.length() < 1e-5;
                assert!(still, "{method}, {rate}/s, {degrees} degrees: crept by {way}, at {velocity}");
            }
        }
    }
}

#[test]
fn what_friction_cannot_hold_slides() {
    for method in [Method::Symplectic, Method::Verlet, Method::Rk4] {
        for (degrees, mu) in [(10.0f32, 0.15), (30.0, 0.5)] {
            let (way, _) = perched(degrees, mu, method, 240.0, 0.25);
            let (sin, cos) = degrees.to_radians().sin_cos();
            // At first with g (sin α − µ cos α); it gets steeper.
            let least = 0.5 * 9.80665 * (sin - mu * cos) * 0.0625;
            assert!(way.length() > 0.95 * least && way.length() < 2.5 * least, "{method}, {degrees}: {way}, {least}");
        }
    }
}
