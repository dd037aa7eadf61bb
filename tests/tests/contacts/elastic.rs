//! Hard balls without loss keep their energy for minutes, in any gravity.

use pointmass::shape::{Capsule, Collider, Cylinder, Plane, Sphere};
use pointmass::{Contacts, Gravity, Meetings, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{G, f64s, is_run, run, started};

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

/// What a ball has along `up` above where it comes to rest [J/kg], after each of so many steps.
fn energies(scene: &Scene<'_>, [up, rest]: [Vec3; 2], gravity: f32, h: f64, steps: u32) -> Vec<f32> {
    let mut system = started(scene, scene.start.len(), 1);
    let last = scene.start.len() - 1;
    let mut energy = |i: u32| {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        let all = system.particles();
        0.5 * all.velocity[last].length_squared() + gravity * (all.position[last] - rest).dot(up)
    };
    (0..=steps).map(&mut energy).collect()
}

/// Contacts by position find a ball deep in the floor, and faster than it came there by what gravity has done since: a bounce gives back the elasticity's share of
/// what it came with, and no more, however long the sub-steps are.
#[test]
fn by_position_each_bounce_gives_back_the_share_of_its_elasticity() {
    let mut cases = 0;
    for up in [Vec3::Y, Vec3::new(0.6, 0.0, -0.8), Vec3::new(2.0, 3.0, -6.0) / 7.0] {
        for (elasticity, gravity, radius) in [(1.0, 9.8, 0.1), (0.8, 1.62, 0.4), (0.5, 24.8, 0.1)] {
            for (rate, substeps) in [(24.0, 1), (24.0, 4), (60.0, 1), (60.0, 12), (144.0, 2)] {
                for method in [Method::Midpoint, Method::Verlet, Method::Rk4, Method::Embedded] {
                    for is_ball in [false, true] {
                        if !is_run(&mut cases) {
                            continue;
                        }
                        let floor = Plane { point: Vec3::ONE, normal: up };
                        let ball = |high: f32| Particle {
                            position: Vec3::ONE + up * high,
                            radius,
                            elasticity,
                            ..Particle::REST
                        };
                        let below = Particle { fixed: true, ..ball(-radius) };
                        let start = [below, ball(1.0 + radius)];
                        let colliders: &dyn Collider = if is_ball { &() } else { &floor };
                        let scene = Scene {
                            start: if is_ball { &start } else { &start[1..] },
                            forces: &Gravity { acceleration: -up * gravity },
                            constraints: &Contacts::HARD,
                            integrator: method.integrator(),
                            colliders,
                            substeps,
                            ..Scene::EMPTY
                        };
                        let rest = Vec3::ONE + up * radius;
                        let all = energies(&scene, [up, rest], gravity, 1.0 / rate, (8.0 * rate) as u32);
                        let case =
                            format!("{elasticity}, {rate}/{substeps}, {method}, {gravity} along {up}, {is_ball}");
                        // From as fast on two bounces may be in one step.
                        let least = 0.5 * (2.0 * gravity / rate as f32).powi(2);
                        let mut bounces = 0;
                        for (one, next) in all.iter().zip(&all[1..]).take_while(|(_, next)| **next > least) {
                            let share = next / one;
                            let square = elasticity * elasticity;
                            bounces += u32::from((share - 1.0).abs() > 1e-3);
                            // Off a ball it goes ever more askew.
                            if is_ball && bounces > 3 {
                                break;
                            }
                            let is_kept = (share - 1.0).abs() < 1e-3 || (share / square - 1.0).abs() < 2e-3;
                            assert!(is_kept, "{case}: {next} of {one}");
                        }
                        assert!(bounces > 0 || elasticity == 1.0, "{case}: {all:?}");
                        assert!((all[0] / gravity - 1.0).abs() < 1e-5, "{case}");
                    }
                }
            }
        }
    }
}

/// What bounces off scenery that curves does so along one normal, that of where it touches it: off two it would gain or lose by how much they differ, by each
/// hit.
#[test]
fn by_position_what_curves_neither_gives_nor_takes() {
    let mut cases = 0;
    let bowl = Sphere { center: Vec3::ONE, radius: 1.0 };
    let dome = Sphere { center: Vec3::ONE, radius: 0.3 };
    let pipe = Capsule { from: Vec3::ONE - Vec3::Z, to: Vec3::ONE + Vec3::Z, radius: 0.8 };
    let pin = Cylinder { center: Vec3::ONE, radius: 0.05, height: 4.0 };
    let (inside, above) = (Vec3::new(0.3, 0.2, -0.1), Vec3::new(0.15, 1.5, 0.05));
    let aside = Vec3::new(0.05, 0.0, 0.9);
    let all: [(&str, &dyn Collider, Vec3, Vec3); 5] = [
        ("a bowl", &bowl, inside, Vec3::new(2.0, 1.0, -1.5)),
        ("a bowl from rest", &bowl, inside, Vec3::ZERO),
        ("a pipe", &pipe, inside, Vec3::new(-1.0, 0.0, 2.0)),
        ("a dome", &dome, above, Vec3::new(0.1, -2.0, 0.0)),
        ("a pin", &pin, aside, Vec3::new(0.0, 1.0, -3.0)),
    ];
    for (name, colliders, from, velocity) in all {
        for gravity in [0.0, 9.8] {
            for (rate, substeps) in [(60.0, 1), (60.0, 4), (60.0, 12), (144.0, 2)] {
                for method in [Method::Midpoint, Method::Verlet, Method::Rk4, Method::Embedded] {
                    for radius in [0.02, 0.1, 0.2] {
                        if !is_run(&mut cases) || gravity == 0.0 && velocity == Vec3::ZERO {
                            continue;
                        }
                        let ball = Particle {
                            position: Vec3::ONE + from,
                            velocity,
                            radius,
                            elasticity: 1.0,
                            ..Particle::REST
                        };
                        let scene = Scene {
                            start: &[ball],
                            forces: &Gravity { acceleration: Vec3::NEG_Y * gravity },
                            constraints: &Contacts::HARD,
                            integrator: method.integrator(),
                            colliders,
                            substeps,
                            ..Scene::EMPTY
                        };
                        let all = energies(&scene, [Vec3::Y, Vec3::ZERO], gravity, 1.0 / rate, (4.0 * rate) as u32);
                        let (least, most) =
                            (all.iter().copied().fold(all[0], f32::min), all.iter().copied().fold(all[0], f32::max));
                        let spread = (most - least) / all[0];
                        let case = format!("{name}, {radius}, {gravity}, {rate}/{substeps}, {method}");
                        assert!(spread < 0.01, "{case}: from {least} to {most} of {}", all[0]);
                    }
                }
            }
        }
    }
}

/// A row of balls that touch hands a blow on from one end to the other in a sub-step, however long it is and whichever end is numbered first.
#[test]
fn a_blow_goes_through_a_row_of_any_length() {
    let speed = 3.0;
    for count in [3, 63, 66, 100, 300] {
        for (is_numbered_back, substeps) in [(false, 1), (true, 1), (false, 12), (true, 12)] {
            let ball = |i: usize| Particle {
                position: Vec3::X * (0.2 * i as f32 * (1.0 - 1e-5)),
                radius: 0.1,
                elasticity: 1.0,
                ..Particle::REST
            };
            let mut start: Vec<_> = (0..count).map(ball).collect();
            start.push(Particle { position: Vec3::X * -0.21, velocity: Vec3::X * speed, ..ball(0) });
            if is_numbered_back {
                start.reverse();
            }
            let scene = Scene { start: &start, substeps, constraints: &Contacts::HARD, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 1);
            run(&mut system, &scene, 1.0 / 60.0, 3);
            let there = system.particles();
            let left = energy(there.mass, there.position, there.velocity, 0.0) / (0.5 * f64::from(speed * speed));
            let what = format!("{count} balls, {is_numbered_back}, {substeps} sub-steps");
            assert!((left - 1.0).abs() < 5e-3, "{what}: {left} of its energy is left");
            assert_eq!(system.totals().effort.capped, 0, "{what}");
        }
    }
}
