//! What moving walls do to what they meet.

use super::tunnels::told;
use pointmass::force::Friction;
use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Collider, Cuboid, Moving, Plane, Segment, Sphere};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{G, Random, f64s, gap, often, run, started};

fn moving(cuboid: Cuboid, motion: Motion) -> Moving<Cuboid> {
    Moving::new(cuboid, &Aabb { min: cuboid.min, max: cuboid.max }, motion)
}

#[test]
fn a_motion_is_where_its_formula_says_early_and_late() {
    let mut random = Random::new(91);
    for _ in 0..often(3000) {
        let motion = Motion {
            pivot: random.vector(2.0),
            axis: random.direction(),
            spin: random.between(-20.0, 20.0),
            swing: random.vector(1.0),
            frequency: random.between(0.0, 20.0),
            phase: random.between(-1.0, 1.0),
            ..Motion::STILL
        };
        let instant = Time::from_seconds_f64(f64::from(random.magnitude(1e-3, 1e6)));
        let x = random.vector(3.0);
        let there = motion.at(instant).point(x);
        // Speeds are rounded to 2⁻³² turns a second; the formula has them as they are.
        let late = 1e-6 + 2f64.powi(-33) * 6.3 * 6.0 * instant.seconds_f64();
        assert!(gap(told(&motion, f64s(there), instant), f64s(x)) < late + 5e-6, "{motion:?} {instant:?}");
    }
}

#[test]
fn a_block_on_a_platform_is_carried() {
    let materials =
        [ContactMaterial { elasticity: Some(0.0), friction: Some(Friction { static_: 0.5, kinetic: 0.5 }) }];
    for radius in [0.0f32, 0.1] {
        let slab = Cuboid { min: Vec3::new(-50.0, -1.0, -50.0), max: Vec3::new(50.0, 0.0, 50.0) };
        let platform = moving(slab, Motion { drift: Vec3::X * 2.0, ..Motion::STILL });
        let position = Vec3::Y * radius;
        let start = [Particle { position, radius, elasticity: 0.0, material: Some(0), ..Particle::REST }];
        let integrator = Method::Verlet.integrator();
        let scene = Scene {
            start: &start,
            forces: &Gravity::EARTH,
            colliders: &platform,
            materials: &materials,
            integrator,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 1.0 / 60.0, 300);
        let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
        // It slips until it is as fast, which takes v / µg and leaves it half of that way behind.
        let behind = 2.0 * 2.0 / (2.0 * 0.5 * G);
        assert!((f64::from(x.x) - (10.0 - behind)).abs() < 0.02, "{radius}: {x}");
        assert!((v - Vec3::X * 2.0).length() < 1e-3, "{radius}: {v}");
        assert!((x.y - radius).abs() < 1e-4, "{radius}: {x}");
    }
}

#[test]
fn a_lift_carries_what_stands_on_it_up_and_down() {
    for radius in [0.0f32, 0.1] {
        // At most 2 m/s² of acceleration, less than gravity.
        let motion = Motion { swing: Vec3::Y * 0.2, frequency: 0.5, ..Motion::STILL };
        let lift = moving(Cuboid { min: Vec3::new(-1.0, -0.1, -1.0), max: Vec3::new(1.0, 0.0, 1.0) }, motion);
        let position = Vec3::Y * radius;
        let start = [Particle { position, radius, elasticity: 0.0, ..Particle::REST }];
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &lift, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        for i in 1..=600 {
            system.step(&scene, Time::frame(i, 60) - system.time());
            let height = f64::from(system.particles().position[0].y) - f64::from(radius);
            let floor = 0.2 * (core::f64::consts::PI * system.time().seconds_f64()).sin();
            assert!((-1e-4..2e-3).contains(&(height - floor)), "{radius}: {height} over {floor} after {i} frames");
        }
    }
}

#[test]
fn a_racket_gives_its_speed() {
    // A wall of 10 m/s meets a point at rest, which leaves it at (1 + e) 10 m/s.
    let motion = Motion { drift: Vec3::X * 10.0, ..Motion::STILL };
    let plane = Plane { point: Vec3::NEG_X, normal: Vec3::X };
    let racket = Moving::new(plane, &Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY }, motion);
    for radius in [0.0f32, 0.3] {
        for elasticity in [0.0f32, 0.5, 1.0] {
            let start = [Particle { radius, elasticity, ..Particle::REST }];
            let scene = Scene { start: &start, colliders: &racket, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 0);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
            let (speed, met) = (10.0 * (1.0 + elasticity), (1.0 - radius) / 10.0);
            assert!((v.x - speed).abs() < 1e-4, "{radius} {elasticity}: {v}");
            assert!((x.x - speed * (1.0 - met)).abs() < 1e-3, "{radius} {elasticity}: {x}");
        }
    }
}

#[test]
fn a_blade_hits_what_stands_still_and_where_it_is() {
    // A blade along x turns about y once a second and meets what lies on the z axis after a quarter of a turn.
    let blade = Cuboid { min: Vec3::new(0.1, -0.5, -0.01), max: Vec3::new(2.0, 0.5, 0.01) };
    let motion = Motion { spin: -1.0, ..Motion::STILL };
    let blade = moving(blade, motion);
    for (radius, elasticity) in [(0.0f32, 0.0f32), (0.0, 1.0), (0.05, 0.5)] {
        let start = [Particle { position: Vec3::Z, radius, elasticity, ..Particle::REST }];
        let scene = Scene { start: &start, colliders: &blade, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        let mut hit = None;
        for i in 1..=30 {
            let report = system.step(&scene, Time::frame(i, 120) - system.time());
            if report.hits > 0 && hit.is_none() {
                hit = Some((i, system.particles().velocity[0]));
            }
        }
        // A blade a centimetre thick to this side, and the radius, come before its middle.
        let angle = core::f64::consts::FRAC_PI_2 - f64::from(0.01 + radius).asin();
        let expected = angle / core::f64::consts::TAU;
        let (frame, v) = hit.expect("it is in the way");
        assert_eq!(frame, (expected * 120.0).ceil() as u64);
        // The place that meets it is about a metre from the axis.
        let speed = (1.0 + elasticity) * core::f32::consts::TAU;
        assert!((v.length() / speed - 1.0).abs() < 0.01, "{v}, not {speed}");
        assert!(v.x < 0.0, "{v}");
    }
}

#[test]
fn hits_and_contacts_of_moving_spheres_are_those_of_the_sphere_there() {
    let mut random = Random::new(92);
    let mut hits = 0;
    for _ in 0..often(20_000) {
        let motion = Motion {
            pivot: random.vector(1.0),
            axis: random.direction(),
            spin: random.between(-2.0, 2.0),
            swing: random.vector(0.5),
            frequency: random.between(0.0, 2.0),
            phase: random.unit(),
            drift: random.vector(0.1),
            ..Motion::STILL
        };
        let sphere = Sphere { center: random.vector(1.0), radius: random.between(0.2, 1.0) };
        let ball = Moving::new(sphere, &Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }, motion);
        let instant = Time::from_seconds(random.between(0.0, 10.0));
        let there = Sphere { center: motion.at(instant).point(sphere.center), ..sphere };
        let radius = random.magnitude(1e-2, 0.3);
        // In an instant it stands where it is.
        let (from, to) = (there.center + random.vector(2.0), there.center + random.vector(2.0));
        let segment = Segment { radius, during: [instant; 2], ..Segment::new(from, to) };
        let near = ((from - there.center).length() - sphere.radius).abs() < radius + 1e-3;
        let (a, b) = (ball.first_hit(&segment), there.first_hit(&segment));
        if let (Some(a), Some(b), false) = (a, b, near) {
            hits += 1;
            assert!((segment.at(a.time) - segment.at(b.time)).length() < 1e-3, "{a:?} {b:?}");
            // The velocity of the place: a difference quotient of the motion.
            let place = segment.at(a.time) - a.normal * radius;
            let own = f64s(place);
            let told = told(&motion, own, instant);
            let tick = Time::from_seconds(1e-3);
            let told: Vec3 = Vec3::from_array(told.map(|x| x as f32));
            let moved = motion.at(instant + tick).point(told) - motion.at(instant - tick).point(told);
            let velocity = moved / (tick.seconds() * 2.0);
            assert!((a.velocity - velocity).length() < 0.02, "{motion:?} {a:?} {velocity}");
        }
        let (mut seen, mut expected) = (vec![], vec![]);
        ball.contacts(from, 0.5, instant, &mut |c| seen.push((c.distance, c.normal)));
        there.contacts(from, 0.5, instant, &mut |c| expected.push((c.distance, c.normal)));
        if let ([a], [b]) = (&seen[..], &expected[..]) {
            assert!((a.0 - b.0).abs() < 1e-5 && (a.1 - b.1).length() < 1e-3, "{a:?} {b:?}");
        }
    }
    assert!(hits > often(2000), "{hits}");
}
