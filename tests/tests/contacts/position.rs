//! Heaps: contacts held by moving balls apart.

use pointmass::force::Friction;
use pointmass::index::Structure;
use pointmass::shape::{Cuboid, Plane};
use pointmass::{
    ContactMaterial, Contacts, Gravity, Measures, Method, MutualGravity, Particle, Rope, Scene, Spring, Time, Vec3,
};
use pointmass_tests::{G, Random, f64s, gap, methods, run, started};

/// Hard balls in as many sub-steps as a heap asks for.
const HEAP: Scene<'_> = Scene { substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

fn ball(y: f32) -> Particle {
    Particle { position: Vec3::Y * y, radius: 0.1, elasticity: 0.0, ..Particle::REST }
}

#[test]
fn a_soft_floor_gives_way_by_the_same_however_many_sub_steps() {
    for (mass, compliance) in [(1.0, 1e-3), (0.2, 2e-3), (5.0, 4e-4)] {
        let start = [Particle { mass, ..ball(0.1) }];
        let want = f64::from(mass) * G * f64::from(compliance);
        for substeps in [5, 10, 20] {
            let (forces, constraints) = (&Gravity::EARTH, &Contacts { compliance });
            let scene = Scene { start: &start, forces, colliders: &GROUND, substeps, constraints, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 1);
            run(&mut system, &scene, 1.0 / 60.0, 600);
            let sunk = 0.1 - f64s(system.particles().position[0])[1];
            assert!((sunk / want - 1.0).abs() < 0.03, "{substeps} sub-steps: {sunk}, {want}");
        }
    }
}

/// The weight above each contact of a stack decides how far it gives way, by every method.
#[test]
fn soft_balls_sink_by_their_weight_whatever_the_method() {
    let mut round = 0;
    for (mass, compliance) in [(1.0f32, 1e-3f32), (0.2, 2e-3), (0.1, 1e-3), (10.0, 1e-5)] {
        let sinks = f64::from(mass) * G * f64::from(compliance);
        for (count, substeps, most) in [(1, 1, 0.01), (1, 5, 0.01), (1, 12, 0.01), (3, 5, 0.1), (3, 12, 0.02)] {
            round += 1;
            for method in methods(round) {
                let start: Vec<_> = (0..count).map(|i| Particle { mass, ..ball(0.1 + 0.2 * i as f32) }).collect();
                let (forces, constraints) = (&Gravity::EARTH, &Contacts { compliance });
                let parts = Scene { start: &start, forces, colliders: &GROUND, constraints, ..Scene::EMPTY };
                let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                let mut system = started(&scene, count, 1);
                run(&mut system, &scene, 1.0 / 60.0, 1200);
                let mut below = -0.1;
                for (row, x) in system.particles().position.iter().enumerate() {
                    let share = (0.2 - (f64s(*x)[1] - below)) / (sinks * (count - row) as f64);
                    assert!((share - 1.0).abs() < most, "{method}, {mass} kg, {substeps}: {row} of {count} by {share}");
                    below = f64s(*x)[1];
                }
                let speed = system.particles().velocity.iter().fold(0.0f32, |most, v| most.max(v.length()));
                assert!(speed < 2e-4, "{method}, {mass} kg, {substeps} sub-steps: {speed} m/s");
            }
        }
    }
}

/// Balls of many masses that draw each other together, with a rope and springs among them: what two do to each other is no weight, nor is what is left of it
/// in rounding, by which a rope's balls differ that go on as a rigid body.
#[test]
fn momentum_stays_where_forces_are_their_own() {
    for seed in 55..70 {
        for (substeps, method) in [(12, Method::Verlet), (1, Method::Rk4), (5, Method::Symplectic)] {
            keeps_its_momentum(seed, substeps, method);
        }
    }
}

fn keeps_its_momentum(seed: u64, substeps: u32, method: Method) {
    let mut random = Random::new(seed);
    let start: Vec<Particle> = (0..27)
        .map(|i| Particle {
            position: Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32) * 0.22 + random.vector(0.01),
            velocity: random.vector(0.5),
            mass: random.magnitude(0.01, 1.0),
            ..ball(0.0)
        })
        .collect();
    let forces = MutualGravity { constant: 1.0, softening: 0.05, ..MutualGravity::NEWTON };
    let rope = Rope::rigid([0u32, 1, 2, 5, 4], [0.22]);
    let constraints = (&rope, Contacts::HARD);
    let springs = [Spring::new([9, 26], 0.3, 50.0).damped(0.1)];
    let parts = Scene { start: &start, forces: &forces, springs: &springs, ..Scene::EMPTY };
    let scene = Scene { constraints: &constraints, substeps, integrator: method.integrator(), ..parts };
    let mut system = started(&scene, start.len(), 1);
    let before = Measures::of(&system, &scene).momentum;
    run(&mut system, &scene, 1.0 / 60.0, 120);
    let lost = gap(before, Measures::of(&system, &scene).momentum);
    let mass: f32 = start.iter().map(|p| p.mass).sum();
    assert!(system.totals().contacts > 100);
    assert!(lost < 2e-5 * f64::from(mass), "{method} in {substeps}: {lost} of {mass} kg");
}

#[test]
fn a_bounce_gives_back_its_share_of_the_speed() {
    for elasticity in [0.3, 0.5, 0.8, 1.0] {
        let start = [Particle { elasticity, ..ball(1.1) }];
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &GROUND, ..HEAP };
        let mut system = started(&scene, 1, 1);
        let (mut lowest, mut apex, mut hit) = (f32::INFINITY, 0.0_f32, false);
        for frame in 1..=240 {
            system.step(&scene, Time::frame(frame, 240) - system.time());
            let (y, v) = (system.particles().position[0].y - 0.1, system.particles().velocity[0].y);
            lowest = lowest.min(y);
            hit |= v > 0.0;
            if hit {
                apex = apex.max(y);
            }
        }
        let share = apex.sqrt();
        assert!(hit && (share / elasticity - 1.0).abs() < 0.02, "{elasticity}: {share}");
        assert!(lowest > -0.01, "{lowest}");
    }
}

#[test]
fn two_balls_bounce_off_each_other_with_their_share_of_the_speed() {
    for elasticity in [0.0, 0.5, 1.0] {
        let at = |x: f32, v: f32, mass: f32| Particle {
            position: Vec3::X * x,
            velocity: Vec3::X * v,
            elasticity,
            mass,
            ..ball(0.0)
        };
        let start = [at(-0.5, 2.0, 1.0), at(0.5, -1.0, 3.0)];
        let scene = Scene { start: &start, substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 1);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        let [a, b] = [0, 1].map(|row| f64s(system.particles().velocity[row])[0]);
        assert!(((b - a) / 3.0 - f64::from(elasticity)).abs() < 0.02, "{elasticity}: {a} {b}");
        assert!((a + 3.0 * b + 1.0).abs() < 1e-5, "{a} {b}");
    }
}

#[test]
fn what_slides_stops_after_its_way() {
    for kinetic in [0.2, 0.4, 0.8] {
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: kinetic, kinetic }) }];
        let start = [Particle { velocity: Vec3::X * 3.0, material: Some(0), ..ball(0.1) }];
        let forces = &Gravity::EARTH;
        let scene = Scene { start: &start, materials: &materials, forces, colliders: &GROUND, ..HEAP };
        let mut system = started(&scene, 1, 1);
        run(&mut system, &scene, 1.0 / 60.0, 120);
        let want = 9.0 / (2.0 * f64::from(kinetic) * G);
        let way = f64s(system.particles().position[0])[0];
        assert!((way / want - 1.0).abs() < 0.03, "{kinetic}: {way}, {want}");
        let v = system.particles().velocity[0];
        assert!(v.length() < 1e-3, "{v}");
    }
}

#[test]
fn momentum_of_free_balls_is_conserved() {
    let mut random = Random::new(61);
    let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.5, kinetic: 0.4 }) }];
    let start: Vec<Particle> = (0..125)
        .map(|i| {
            let place = Vec3::new((i % 5) as f32, (i / 5 % 5) as f32, (i / 25) as f32) - 2.0;
            Particle {
                position: place,
                velocity: random.direction() - place * 2.0,
                radius: random.between(0.2, 0.45),
                mass: random.magnitude(0.1, 10.0),
                elasticity: random.unit(),
                material: Some(0),
                ..Particle::REST
            }
        })
        .collect();
    let scene =
        Scene { start: &start, materials: &materials, substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    let momentum = |mass: &[f32], velocity: &[Vec3]| -> [f64; 3] {
        core::array::from_fn(|axis| mass.iter().zip(velocity).map(|(&m, &v)| f64::from(m) * f64s(v)[axis]).sum())
    };
    let before = momentum(system.particles().mass, system.particles().velocity);
    run(&mut system, &scene, 1.0 / 60.0, 60);
    let after = momentum(system.particles().mass, system.particles().velocity);
    let contacts = system.totals().contacts;
    assert!(contacts > 1000);
    // Each is answered in some passes, and each of them rounds velocities of up to 10 m/s.
    let bound = 10.0 * 10.0 * f64::from(f32::EPSILON) * (contacts as f64 * 10.0).sqrt();
    for axis in 0..3 {
        let error = (after[axis] - before[axis]).abs();
        assert!(error < bound, "{error} of {bound}");
    }
}

#[test]
fn what_overlaps_at_rest_is_parted_without_a_bang() {
    for apart in [0.0, 1e-6, 0.05, 0.15] {
        let start = [ball(0.0), Particle { mass: 4.0, elasticity: 0.9, ..ball(apart) }];
        let scene = Scene { start: &start, substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 1);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        let p = system.particles();
        let gap = p.position[0].distance(p.position[1]) - 0.2;
        assert!(gap > -2e-4, "{apart}: {gap}");
        for v in p.velocity {
            assert!(v.length() < 1e-3, "{apart}: {v}");
        }
    }
}

#[test]
fn a_heap_settles_and_keeps_its_room() {
    const RADIUS: f32 = 0.05;
    let mut random = Random::new(62);
    let start: Vec<Particle> = (0..500)
        .map(|i| Particle {
            position: Vec3::new((i % 7) as f32 + 0.5, (i / 49) as f32 + 0.6, (i / 7 % 7) as f32 + 0.5) * (2.1 * RADIUS)
                + random.vector(0.04 * RADIUS),
            radius: RADIUS,
            elasticity: 0.2,
            material: Some(0),
            ..Particle::REST
        })
        .collect();
    let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.4, kinetic: 0.3 }) }];
    let room = Cuboid { min: Vec3::ZERO, max: Vec3::new(14.8, 200.0, 14.8) * RADIUS };
    let scene = Scene {
        start: &start,
        materials: &materials,
        forces: &Gravity::EARTH,
        colliders: &room,
        substeps: 12,
        constraints: &Contacts::HARD,
        index: &Structure::Grid,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, start.len(), 1);
    run(&mut system, &scene, 1.0 / 60.0, 180);
    let p = system.particles();
    let (mut overlap, mut touching) = (0.0_f32, 0);
    for a in 0..p.position.len() {
        for b in 0..a {
            let deep = 2.0 * RADIUS - p.position[a].distance(p.position[b]);
            overlap = overlap.max(deep);
            touching += usize::from(deep > -1e-3 * RADIUS);
        }
        let inside = p.position[a].cmpge(room.min + 0.97 * RADIUS).all();
        assert!(inside && p.position[a].cmple(room.max - 0.97 * RADIUS).all(), "{}", p.position[a]);
    }
    let speed = p.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    println!("overlap {:.4} of a radius, {touching} touch, fastest {speed}", overlap / RADIUS);
    assert!(touching > 500, "{touching}");
    assert!(overlap < 0.02 * RADIUS, "{overlap}");
    assert!(speed < 0.25, "{speed}");
    assert_eq!(system.totals().caps.contacts, 0);
}

#[test]
fn newborns_owe_nothing_to_who_had_their_row() {
    // The first is pressed onto the ground and dies; one born into its row falls freely beside a ceiling's edge.
    let heavy = Particle { lifetime: 0.25, ..ball(0.1) };
    let emitter = |radius: f32| pointmass::Emitter {
        speed: pointmass::Varied::exactly(3.0),
        direction: Some(Vec3::NEG_Y),
        radius: pointmass::Varied::exactly(radius),
        elasticity: pointmass::Varied::exactly(1.0),
        burst: Some(pointmass::emit::Burst { count: 1, at: 0.51, every: 9.0 }),
        ..pointmass::Emitter::new(pointmass_tests::point(Vec3::Y * 0.15), 0.0)
    };
    let emitters = emitter(0.1);
    let newborn = |start: &[Particle]| {
        let forces = &Gravity::EARTH;
        let scene = Scene { start, forces, emitters: &emitters, colliders: &GROUND, ..HEAP };
        let mut system = started(&scene, 1, 1);
        let mut after = None;
        for _ in 0..6 {
            system.step(&scene, Time::from_seconds(0.1));
            if system.totals().born == 1 {
                after = Some((system.particles().position[0], system.particles().velocity[0]));
            }
        }
        after.expect("one was born")
    };
    assert_eq!(newborn(&[heavy]), newborn(&[]));
}
