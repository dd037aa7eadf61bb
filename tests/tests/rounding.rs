//! Steps too short for where particles are: what rounding swallows is counted.

use pointmass::shape::Plane;
use pointmass::{Contacts, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{run, started};

/// Counts the steps, of `n` of `h` \[s\], that rounding swallows of a particle that begins so.
fn stalled(start: Particle, method: Method, h: f64, n: u32) -> u64 {
    let start = [start];
    let scene = Scene { start: &start, integrator: &method, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 1);
    run(&mut system, &scene, h, n);
    system.totals().caps.stalled
}

#[test]
fn steps_too_short_for_their_place_are_counted_with_every_method() {
    for &method in Method::ALL {
        for (x, v, h) in [(1000.0, 1.0, 2e-5), (-1000.0, 1.0, 2e-5), (2e5, -2.0, 1e-3), (1e7, 1.0, 1.0 / 60.0)] {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let start = Particle {
                    position: axis * x,
                    velocity: axis * v + Vec3::splat(0.5) * (1.0 - axis),
                    ..Particle::REST
                };
                assert_eq!(stalled(start, method, h, 100), 100, "{method}: {x} m, {v} m/s, {h} s along {axis}");
            }
        }
    }
}

#[test]
fn steps_that_lead_on_and_particles_at_rest_are_not() {
    for &method in Method::ALL {
        for (x, v, h) in [(1000.0, 1.0, 1e-3), (1000.0, 0.0, 2e-5), (10.0, 1.0, 2e-5), (1000.0, 1e-4, 1.0 / 60.0)] {
            let start = Particle { position: Vec3::X * x, velocity: Vec3::X * v, ..Particle::REST };
            assert_eq!(stalled(start, method, h, 100), 0, "{method}: {x} m, {v} m/s, {h} s");
        }
    }
}

#[test]
fn a_fall_from_far_up_in_tiny_steps_is_counted_until_it_is_fast_enough() {
    let start = [Particle { position: Vec3::Y * 1000.0, ..Particle::REST }];
    for &method in Method::ALL {
        let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator: &method, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 1);
        let h = 1.0 / (60.0 * 1024.0);
        run(&mut system, &scene, h, 61_440);
        // Half the distance of two numbers below 1000 m a step is 1.875 m/s, which the fall reaches after 0.191 s; below
        // 8 mm/s it counts for nothing.
        let want = (1.875 - 1.0 / 128.0) / 9.80665 / h;
        let stalled = system.totals().caps.stalled as f64;
        assert!((stalled / want - 1.0).abs() < 0.01, "{method}: {stalled}, {want}");
    }
}

#[test]
fn sub_steps_of_contacts_and_of_methods_count_as_such() {
    // A step of 1 ms leads on at 1000 m; a hundredth of it does not.
    let start = [Particle { position: Vec3::X * 1000.0, velocity: Vec3::X, radius: 0.1, ..Particle::REST }];
    for (substeps, want) in [(1, 0), (100, 10)] {
        let scene = Scene { start: &start, substeps, constraints: &Contacts::HARD, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 1);
        for _ in 0..10 {
            system.step(&scene, Time::from_seconds(1e-3));
        }
        assert_eq!(system.totals().caps.stalled, want, "{substeps}");
    }
}

#[test]
fn what_rests_on_the_ground_does_not_stall() {
    let by_position = Scene { substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
    for (touching, height) in [(Scene::EMPTY, 0.0), (by_position, 9.0)] {
        let ground = Plane { point: Vec3::Y * height, normal: Vec3::Y };
        let start = [Particle { position: Vec3::Y * (height + 0.1), radius: 0.1, elasticity: 0.0, ..Particle::REST }];
        for &method in Method::ALL {
            let integrator = &method;
            let forces = &Gravity::EARTH;
            let scene = Scene { start: &start, forces, colliders: &ground, integrator, ..touching };
            let mut system = started(&scene, 1, 1);
            run(&mut system, &scene, 1e-4, 2000);
            let stalled = system.totals().caps.stalled;
            // Until it has come to touch it falls by less than its place can tell.
            assert!(stalled <= 20, "{method} at {height} m: {stalled}");
        }
    }
}
