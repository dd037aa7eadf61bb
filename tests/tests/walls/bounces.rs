//! How points and balls bounce and come to rest.

use pointmass::shape::{Collider, Cuboid, Plane};
use pointmass::{Constraint, ContactMaterial, Distance, Gravity, Meetings, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{G, f64s, gap, often, run, started};

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

#[test]
fn points_and_balls_bounce_as_zeno_says_and_rest() {
    for radius in [0.0f32, 0.1, 1.0] {
        let start =
            [Particle { position: Vec3::new(0.5, 1.0 + radius, -0.25), radius, elasticity: 0.8, ..Particle::REST }];
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &FLOOR, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        let (mut bounces, mut impact, mut apex, mut static_) = (0, (2.0 / G).sqrt(), 1.0, None);
        for i in 1..=64 * 60 {
            let report = system.step(&scene, Time::frame(i, 60) - system.time());
            let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
            let (y, v) = (f64::from(x.y) - f64::from(radius), f64::from(v.y));
            assert!(y > -1e-6, "{radius}: {y} below the floor");
            if report.hits == 1 && bounces < 8 {
                // How fast it left the ground, by its energy; and so when.
                let up = (v * v + 2.0 * G * y).sqrt();
                let at = system.time().seconds_f64() - (up - v) / G;
                (bounces, apex) = (bounces + 1, apex * 0.64);
                let height = up * up / (2.0 * G);
                assert!((at - impact).abs() < 1e-3, "{radius}: impact {bounces} at {at}, not {impact}");
                assert!((height - apex).abs() < 1e-3, "{radius}: apex {bounces} at {height}, not {apex}");
                impact += 2.0 * (2.0 * apex / G).sqrt();
            }
            // Zeno's sum is 4.0644068 s; then it lies still for a minute.
            if i == 246 {
                static_ = Some(x);
                assert!(y < 1e-3, "{radius}: at {y}");
            }
            if let Some(rest) = static_ {
                assert!(gap(f64s(x), f64s(rest)) < 1e-5 && v.abs() < 1e-3, "{radius}: {x} {v} after {i} frames");
            }
        }
        assert_eq!((bounces, system.totals().caps.bounces), (8, 0));
    }
}

#[test]
fn in_a_unit_cube_points_and_balls_unfold_to_triangle_waves() {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    for radius in [0.0f32, 0.05, 0.25] {
        let position = Vec3::new(0.3, 0.6, 0.4);
        let velocity = Vec3::new(3.1, -2.7, 5.3);
        let start = [Particle { position, velocity, radius, elasticity: 1.0, ..Particle::REST }];
        let scene = Scene { start: &start, colliders: &unit, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        // The centre has the cube less the radius all round.
        let (low, wide) = (f64::from(radius), 1.0 - 2.0 * f64::from(radius));
        let wave = |x: f64| low + wide * ((x - low) / wide - 2.0 * ((x - low) / wide / 2.0).round()).abs();
        let mut frames = 0;
        while system.totals().hits < often(10_000) as u64 {
            frames += 1;
            system.step(&scene, Time::frame(frames, 60) - system.time());
            let (t, hits) = (system.time().seconds_f64(), system.totals().hits as f64);
            let p = system.particles();
            assert_eq!(p.velocity[0].abs(), velocity.abs(), "the speed is the same to the bit");
            let unfolded: [f64; 3] = core::array::from_fn(|k| f64s(position)[k] + f64s(velocity)[k] * t);
            // Every bounce sets off by at most 2e-6 m, and every frame rounds by half an ulp of 1 m.
            let off = gap(f64s(p.position[0]), unfolded.map(wave));
            assert!(off < 3e-6 * hits + 6e-8 * frames as f64 + 1e-6, "{radius}: {off} after {hits} bounces");
        }
        assert_eq!(system.totals().caps.bounces, 0);
    }
}

#[test]
fn balls_in_a_box_never_end_in_its_walls() {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let mut random = pointmass_tests::Random::new(81);
    let start: Vec<Particle> = (0..often(2000))
        .map(|_| {
            let radius = random.magnitude(1e-3, 0.2);
            let position = Vec3::splat(0.5) + random.vector(0.49 - radius);
            Particle { position, velocity: random.vector(8.0), radius, elasticity: random.unit(), ..Particle::REST }
        })
        .collect();
    let integrator = Method::Verlet.integrator();
    let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &unit, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    for i in 1..=180 {
        system.step(&scene, Time::frame(i, 60) - system.time());
        let p = system.particles();
        for (row, &x) in p.position.iter().enumerate() {
            let apart = (x - p.radius[row]).min(1.0 - x - p.radius[row]).min_element();
            assert!(apart > -1e-6, "{row}: {apart}");
        }
    }
}

/// An elasticity below zero had turned velocities into what they hit, and places into no numbers.
#[test]
fn elasticities_below_zero_are_none() {
    let chest = Cuboid { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let colliders: [&dyn Collider; 2] = [&FLOOR, &chest];
    for (i, &method) in Method::ALL.iter().enumerate() {
        for (radius, pull) in
            [(0.0, Gravity::EARTH), (0.1, Gravity::EARTH), (0.0, Gravity { acceleration: Vec3::ZERO })]
        {
            let materials = [ContactMaterial { elasticity: (i % 3 > 0).then_some(0.5), friction: None }];
            let rod = Distance::rod([0, 1], 0.37);
            let bonds: [&dyn Constraint; 2] = [&(), &rod];
            let [none, below] = [0.0, -0.4].map(|elasticity| {
                let start = [0.0f32, 1.0, 2.0, 3.0].map(|at| Particle {
                    position: Vec3::new(0.2 * at - 0.3, 0.5 + 0.1 * at, 0.1 * at),
                    velocity: Vec3::new(0.3 * at, -3.0 - at, 0.5),
                    radius,
                    // Some are below zero by more than others.
                    elasticity: elasticity * (1.0 + at),
                    material: Some(0),
                    ..Particle::REST
                });
                let parts = Scene { start: &start, forces: &pull, colliders: colliders[i % 2], ..Scene::EMPTY };
                let parts = Scene { materials: &materials, constraints: bonds[i / 3 % 2], ..parts };
                let scene = Scene {
                    integrator: method.integrator(),
                    meetings: [Meetings::Through, Meetings::IMPULSE][i / 2 % 2],
                    ..parts
                };
                let mut system = started(&scene, start.len(), 0);
                run(&mut system, &scene, 1.0 / 60.0, 90);
                assert_eq!((system.len(), system.totals().died.nonfinite), (4, 0), "{method} {radius}");
                system.particles().position.to_vec()
            });
            assert_eq!(none, below, "{method} {radius}");
        }
    }
}
