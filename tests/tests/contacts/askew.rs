//! Balls that do not come straight at what they hit leave as the mirror at the place of their touch says.

use pointmass::shape::{Capsule, Collider, Sphere};
use pointmass::{Contacts, Method, Particle, Scene, Vec3};
use pointmass_tests::{f64s, is_run, run, started};

/// The velocity of a ball that flies along x after it has met a ball, or a rod along z, whose reach is the sum of both radii, `aside` by so much of that.
fn mirrored(speed: f64, aside: f64, elasticity: f64) -> [f64; 3] {
    let normal = [-(1.0 - aside * aside).sqrt(), aside];
    let change = -(1.0 + elasticity) * speed * normal[0];
    [speed + change * normal[0], change * normal[1], 0.0]
}

/// By position, the face of what curves is listed where the ball is when the list is made, half a radius from where it touches. It leaves by the normal there
/// all the same: within what it goes in a sub-step, as a share of how sharply both curve.
#[test]
fn by_position_the_normal_is_that_of_the_touch() {
    let mut cases = 0;
    for wide in [0.02_f32, 0.1, 1.0] {
        for (radius, scale) in [(0.1_f32, 1.0_f32), (0.03, 1.0), (0.1, 0.01), (0.1, 100.0)] {
            for aside in [-0.9_f32, -0.5, 0.0, 0.3, 0.8] {
                for elasticity in [0.0, 0.5, 1.0] {
                    for (rate, substeps) in [(60.0, 1), (60.0, 4), (60.0, 12), (144.0, 2)] {
                        for method in [Method::Euler, Method::Midpoint, Method::Verlet, Method::Rk4] {
                            for is_rod in [false, true] {
                                if !is_run(&mut cases) {
                                    continue;
                                }
                                let (reach, at) = ((wide + radius) * scale, Vec3::new(0.25, -0.5, 0.125) * scale);
                                let ball = Sphere { center: at, radius: wide * scale };
                                let along = Vec3::Z * scale;
                                let rod = Capsule { from: at - along, to: at + along, radius: wide * scale };
                                let colliders: &dyn Collider = if is_rod { &rod } else { &ball };
                                // Some ten sub-steps before the touch, at no special part of one.
                                let speed = 0.2 * (radius.min(wide) * scale) * rate as f32 * substeps as f32;
                                let ahead = (reach * (1.0 - aside * aside).sqrt()) + 2.13 * radius.min(wide) * scale;
                                let start = Particle {
                                    position: at + Vec3::new(-ahead, aside * reach, 0.0),
                                    velocity: Vec3::X * speed,
                                    radius: radius * scale,
                                    elasticity,
                                    ..Particle::REST
                                };
                                let scene = Scene {
                                    start: &[start],
                                    constraints: &Contacts::HARD,
                                    integrator: method.integrator(),
                                    colliders,
                                    substeps,
                                    ..Scene::EMPTY
                                };
                                let mut system = started(&scene, 1, 1);
                                run(&mut system, &scene, 1.0 / rate, 16 + 16 / substeps);
                                let got = f64s(system.particles().velocity[0]);
                                let want = mirrored(speed.into(), aside.into(), elasticity.into());
                                let off = got.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                                let case = format!(
                                    "{wide}, {radius} by {scale}, {aside}, {elasticity}, {rate}/{substeps}, {method}, {is_rod}"
                                );
                                assert!(off < 2e-3 * f64::from(speed), "{case}: {got:?} for {want:?}");
                            }
                        }
                    }
                }
            }
        }
    }
}
