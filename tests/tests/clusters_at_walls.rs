//! Clusters that keep their shape where they meet the scenery, and each other: they lie, slide and bounce as rigid bodies do.

use crate::clusters::{CUBE, DOWN, bent, corners, cross};
use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Contacts, Gravity, Measures, Method, Particle, Scene, ShapeMatching, Time, Vec3};
use pointmass_tests::{Random, f64s, often, run, started};

/// A box of points on a slope: it stays where friction can hold it, and slides down as a block does where not. What it may turn over by is left out by
/// a low one.
#[test]
fn a_box_of_points_lies_and_slides_as_a_block_does() {
    for method in Method::ALL {
        for (degrees, mu, substeps, size) in [
            (20.0f32, 0.5f32, 5, 1.0f32),
            (20.0, 0.2, 10, 0.05),
            (35.0, 0.3, 20, 10.0),
            (10.0, 0.0, 5, 1.0),
            (5.0, 0.2, 1, 1.0),
        ] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (up, down) = (Vec3::new(sin, cos, 0.0), Vec3::new(cos, -sin, 0.0));
            let part = Particle { material: Some(0), elasticity: 0.0, ..Particle::REST };
            // A little above it: rounding might begin with corners on the other side.
            let mut start = corners(Vec3::ZERO, Vec3::new(0.4, 0.05, 0.3), Vec3::ZERO, Vec3::ZERO, part);
            for particle in &mut start {
                let Vec3 { x, y, z } = particle.position * size;
                particle.position = down * x + up * (y + 0.0501 * size) + Vec3::Z * z;
            }
            let body = ShapeMatching::rigid(CUBE);
            let materials =
                [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }];
            let slope = Plane { point: Vec3::ZERO, normal: up };
            let scene = Scene {
                start: &start,
                forces: &Gravity { acceleration: Vec3::NEG_Y * (9.81 * size) },
                colliders: &slope,
                materials: &materials,
                constraints: &body,
                substeps,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 8, 0);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            let way = start.iter().zip(system.particles().position).map(|(p, x)| (*x - p.position) / size);
            let mean = way.clone().sum::<Vec3>() / 8.0;
            let right = 0.5 * 9.81 * (sin - mu * cos).max(0.0);
            let name = format!("{method}, {degrees}°, {mu}, {substeps}, {size} m");
            let step = 9.81 * sin / 60.0 / substeps as f32;
            assert!((mean.dot(down) - right).abs() < 0.01 * right + step + 1e-4, "{name}: {mean} for {right}");
            let most = way.clone().map(|way| (way - mean).length()).fold(0.0, f32::max);
            assert!(most < 1e-3, "{name}: it turns by {most}");
            assert!(mean.dot(up).abs() < 1e-3, "{name}: {}", mean.dot(up));
        }
    }
}

/// A jelly on a slope lies where friction can hold it, when it has come to rest, and slides down as fast as a block where not.
#[test]
fn a_soft_box_of_points_lies_and_slides_as_a_block_does() {
    for (degrees, mu, substeps, method) in [
        (15.0f32, 0.5f32, 10, Method::Symplectic),
        (15.0, 0.5, 20, Method::Verlet),
        (25.0, 0.2, 10, Method::Symplectic),
        (25.0, 0.2, 20, Method::Rk4),
        (10.0, 0.0, 5, Method::Midpoint),
    ] {
        for (compliance, damping) in [(1e-3f32, 5.0f32), (1e-4, 20.0), (1e-3, 0.0)] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (up, down) = (Vec3::new(sin, cos, 0.0), Vec3::new(cos, -sin, 0.0));
            let part = Particle { material: Some(0), mass: 0.1, elasticity: 0.0, ..Particle::REST };
            let mut start = corners(Vec3::ZERO, Vec3::new(0.4, 0.05, 0.3), Vec3::ZERO, Vec3::ZERO, part);
            for particle in &mut start {
                let Vec3 { x, y, z } = particle.position;
                particle.position = down * x + up * (y + 0.0501) + Vec3::Z * z;
            }
            let body = ShapeMatching { compliance, damping, ..ShapeMatching::rigid(CUBE) };
            let friction = Some(Friction { static_: mu, kinetic: mu });
            let materials = [ContactMaterial { elasticity: None, friction }];
            let slope = Plane { point: Vec3::ZERO, normal: up };
            let scene = Scene {
                start: &start,
                forces: &DOWN,
                colliders: &slope,
                materials: &materials,
                constraints: &body,
                substeps,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 8, 0);
            let mean = |x: &[Vec3]| x.iter().sum::<Vec3>().dot(down) / 8.0;
            // It sags to begin with.
            for frame in 1..=120 {
                system.step_to(&scene, Time::frame(frame, 60));
            }
            let (begun, speed) = (mean(system.particles().position), mean(system.particles().velocity));
            for frame in 121..=180 {
                system.step_to(&scene, Time::frame(frame, 60));
            }
            let way = mean(system.particles().position) - begun;
            let right = speed + 0.5 * 9.81 * (sin - mu * cos).max(0.0);
            let name = format!("{degrees}°, {mu}, {substeps}, {method}, {compliance} m/N, {damping}");
            // An undamped one goes on to swing about its feet.
            let swings = if damping == 0.0 { 0.03 } else { 0.0 };
            assert!((way - right).abs() < 0.02 * right + 1e-3 + swings, "{name}: {way} for {right}");
            let clear = system.particles().position.iter().map(|x| x.dot(up)).fold(f32::INFINITY, f32::min);
            assert!(clear > -1e-3, "{name}: {clear}");
        }
    }
}

/// A box of points that falls on a corner, an edge or a side bounces as a rigid body does: by an impulse e + 1 times that which would stop the corner.
#[test]
fn a_box_of_points_bounces_as_a_rigid_body_does() {
    let mut random = Random::new(23);
    for number in 0..often(60) {
        let half = Vec3::new(random.between(0.05, 0.3), random.between(0.05, 0.3), random.between(0.05, 0.3));
        let elasticity = [0.0f32, 0.5, 1.0][number % 3];
        let part = Particle { elasticity, ..Particle::REST };
        // Far from other corners' heights: a single one meets the ground.
        let tilt = random.direction() * random.between(0.4, 0.8);
        let turn = |v: Vec3| {
            let (axis, angle) = (tilt.normalize(), tilt.length());
            v * angle.cos() + axis.cross(v) * angle.sin() + axis * (axis.dot(v) * (1.0 - angle.cos()))
        };
        let mut start = corners(Vec3::ZERO, half, Vec3::ZERO, Vec3::ZERO, part);
        let (velocity, omega) = (Vec3::new(random.between(-1.0, 1.0), -2.0, 0.5), random.vector(1.0));
        for particle in &mut start {
            let r = turn(particle.position);
            (particle.position, particle.velocity) = (r, velocity + omega.cross(r));
        }
        let mut heights: Vec<f32> = start.iter().map(|p| p.position.y).collect();
        heights.sort_by(f32::total_cmp);
        if heights[1] - heights[0] < 0.05 {
            continue;
        }
        let lift = 0.01 - heights[0];
        start.iter_mut().for_each(|p| p.position.y += lift);
        let lowest = *start.iter().min_by(|a, b| a.position.y.total_cmp(&b.position.y)).expect("eight");
        let body = ShapeMatching::rigid(CUBE);
        let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        for (method, substeps) in [(Method::Symplectic, 40), (Method::Verlet, 20), (Method::Rk4, 40)] {
            let scene = Scene {
                start: &start,
                colliders: &ground,
                constraints: &body,
                substeps,
                integrator: method.integrator(),
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 8, 0);
            let before = Measures::of(&system, &scene);
            run(&mut system, &scene, 1.0 / 60.0, 1);
            let after = Measures::of(&system, &scene);
            // What it is pushed by tells how much: J = ΔP, and the corner leaves e times as fast as it came.
            let impulse = after.momentum[1] - before.momentum[1];
            let r = f64s(lowest.position - Vec3::Y * lift);
            let inertia = start.iter().fold([[0.0; 3]; 3], |mut sum, p| {
                let r = f64s(p.position - Vec3::Y * lift);
                let square: f64 = r.iter().map(|a| a * a).sum();
                for (i, row) in sum.iter_mut().enumerate() {
                    for (j, cell) in row.iter_mut().enumerate() {
                        *cell += if i == j { square } else { 0.0 } - r[i] * r[j];
                    }
                }
                sum
            });
            let lever = cross(r, [0.0, 1.0, 0.0]);
            let turned = solved(inertia, lever);
            let weight = 1.0 / 8.0 + (0..3).map(|k| lever[k] * turned[k]).sum::<f64>();
            let came = f64::from(lowest.velocity.y);
            let right = -(1.0 + f64::from(elasticity)) * came / weight;
            let name = format!("{number}: {half}, e {elasticity}, {method}, {substeps}");
            assert!((impulse / right - 1.0).abs() < 0.03, "{name}: {impulse} for {right}");
            assert!(after.energy.kinetic < before.energy.kinetic * (1.0 + 1e-4), "{name}");
            assert!((after.momentum[0] - before.momentum[0]).abs() < 1e-3, "{name}: it is smooth");
            assert!(bent(&start, system.particles().position) < 1e-4, "{name}");
        }
    }
}

/// Clusters that are thrown into the corner of a room get no energy there, none of them gets through, and what is rough comes to rest.
#[test]
fn clusters_thrown_into_a_corner_gain_nothing_and_stay_in_the_room() {
    let room = [Vec3::X, Vec3::Y, Vec3::Z].map(|normal| Plane { point: Vec3::ZERO, normal });
    let mut random = Random::new(31);
    for number in 0..often(48) {
        let (rough, elasticity) = (number % 2 == 1, [0.0f32, 0.3, 0.8, 1.0][number / 2 % 4]);
        let radius = [0.0f32, 0.02][number / 8 % 2];
        let part = Particle { elasticity, radius, mass: 0.1, material: Some(0), ..Particle::REST };
        let half = Vec3::new(random.between(0.02, 0.2), random.between(0.02, 0.2), random.between(0.02, 0.2));
        let velocity = Vec3::new(-3.0, random.between(-2.0, 2.0), -2.5);
        let mut start = corners(Vec3::new(0.6, 0.7, 0.6), half, random.vector(8.0), velocity, part);
        if number % 3 == 0 {
            start.truncate(5);
        }
        let body = match number / 4 % 3 {
            0 => ShapeMatching {
                compliance: 1e-4,
                damping: 2.0,
                ..ShapeMatching::rigid((0..start.len() as u32).collect())
            },
            _ => ShapeMatching::rigid((0..start.len() as u32).collect::<Vec<_>>()),
        };
        let share = if rough { 0.5 } else { 0.0 };
        let friction = Some(Friction { static_: share, kinetic: share });
        let materials = [ContactMaterial { elasticity: None, friction }];
        let (method, substeps) = [(Method::Symplectic, 10), (Method::Verlet, 5), (Method::Rk4, 20)][number % 3];
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: &room,
            materials: &materials,
            constraints: &body,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let has = |m: Measures| m.energy.kinetic + m.energy.potential;
        let begun = has(Measures::of(&system, &scene));
        let name = format!("{number}: {half}, e {elasticity}, {share}, {method}, {substeps}, {} m/N", body.compliance);
        for frame in 1..=600 {
            system.step_to(&scene, Time::frame(frame, 60));
            let now = has(Measures::of(&system, &scene));
            // Symplectic shows a potential of before or after half a sub-step's fall.
            assert!(now < 1.02 * begun, "{name}, frame {frame}: {now} J of {begun}");
            for x in system.particles().position {
                assert!(x.min_element() > radius - 2e-3, "{name}, frame {frame}: {x}");
            }
        }
        let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 0.02 || !rough || elasticity > 0.5, "{name}: {fastest} m/s");
    }
}

/// Nothing drives clusters in a box of smooth or rough walls: no blow gives them energy, however uneven they are, and however elastic.
#[test]
fn no_blow_gives_a_cluster_energy() {
    let walls = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z]
        .map(|normal| Plane { point: normal * -0.5, normal });
    let mut random = Random::new(37);
    for number in 0..often(36) {
        let (elasticity, share) = ([1.0f32, 0.8][number % 2], [0.0f32, 0.3, 0.8][number / 2 % 3]);
        let part = Particle { elasticity, material: Some(0), ..Particle::REST };
        let (velocity, omega) = (random.vector(3.0), random.vector(9.0));
        let along = random.direction() * 0.5;
        let place = |i: u32| match number / 6 % 3 {
            // A rod, a plate, and a heap of points.
            0 => along * (i as f32 / 9.0 - 0.5),
            1 => Vec3::new((i % 3) as f32 - 1.0, (i / 3) as f32 - 1.5, 0.0) * 0.15,
            _ => along * (i as f32 / 20.0) + Vec3::new((i * 7 % 5) as f32, (i * 3 % 4) as f32, (i % 3) as f32) * 0.06,
        };
        let start: Vec<Particle> = (0..10)
            .map(|i| {
                let r = place(i);
                Particle { position: r - place(4) * 0.5, velocity: velocity + omega.cross(r), ..part }
            })
            .collect();
        let body = ShapeMatching::rigid((0..10).collect::<Vec<u32>>());
        let friction = Some(Friction { static_: share, kinetic: share });
        let materials = [ContactMaterial { elasticity: None, friction }];
        let (method, substeps) = [(Method::Symplectic, 10), (Method::Verlet, 5), (Method::Rk4, 20)][number % 3];
        let scene = Scene {
            start: &start,
            colliders: &walls,
            materials: &materials,
            constraints: &body,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 10, 0);
        let mut before = Measures::of(&system, &scene).energy.kinetic;
        let name = format!("{number}: e {elasticity}, {share}, {method}, {substeps}");
        for frame in 1..=600 {
            system.step_to(&scene, Time::frame(frame, 60));
            let now = Measures::of(&system, &scene).energy.kinetic;
            assert!(now < 1.001 * before, "{name}, frame {frame}: {now} J of {before}");
            before = now;
        }
        let out = system.particles().position.iter().map(|x| x.abs().max_element()).fold(0.0, f32::max);
        assert!(out < 0.502, "{name}: {out}");
    }
}

/// What turns about a fixed place is not turned far by a wall that hardly has a lever, nor by one that it has begun in.
#[test]
fn a_wall_without_a_lever_moves_no_pivot() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for (aside, deep) in [(0.0f32, 0.005f32), (1e-4, 0.005), (1e-3, 0.005), (1e-4, 1e-4), (0.2, 0.002)] {
        let bob = Particle { position: Vec3::new(aside, 0.01 - deep, 0.0), radius: 0.01, ..Particle::REST };
        let hook = Particle { position: Vec3::Y, fixed: true, ..Particle::REST };
        let start = [hook, bob];
        let body = ShapeMatching::rigid([0, 1]);
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: &ground,
            constraints: &body,
            substeps: 10,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 1.0 / 60.0, 1);
        let way = system.particles().position[1].distance(start[1].position);
        assert!(way < 0.05, "{aside} aside, {deep} deep: {way} m");
    }
}

/// Two bodies that share a particle are two: their balls meet. Those of each do not, though they overlap.
#[test]
fn clusters_that_share_a_particle_are_two() {
    let at = |angle: f32, r: f32, turns: f32| {
        let place = Vec3::new(angle.cos(), angle.sin(), 0.0) * r;
        Particle { position: place, velocity: Vec3::Z.cross(place) * turns, radius: 0.06, ..Particle::REST }
    };
    let start = [at(0.0, 0.0, 0.0), at(0.0, 0.9, 1.0), at(0.0, 1.0, 1.0), at(0.5, 0.9, -1.0), at(0.5, 1.0, -1.0)];
    let bodies = [ShapeMatching::rigid([0, 1, 2]), ShapeMatching::rigid([0, 3, 4])];
    let constraints = (bodies, Contacts::HARD);
    let scene = Scene { start: &start, constraints: &constraints, substeps: 20, ..Scene::EMPTY };
    let mut system = started(&scene, 5, 0);
    for frame in 1..=60 {
        system.step_to(&scene, Time::frame(frame, 60));
        let x = system.particles().position;
        for (a, b) in [(1, 3), (2, 4)] {
            assert!(x[a].distance(x[b]) > 0.1, "frame {frame}: {a} and {b}");
        }
        for (a, b) in [(1, 2), (3, 4)] {
            assert!((x[a].distance(x[b]) - 0.1).abs() < 0.01, "frame {frame}: {a} and {b}");
        }
    }
}

/// What hardly gives way bounces as what does not.
#[test]
fn a_cluster_that_is_almost_rigid_bounces_as_a_rigid_one() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let part = Particle { elasticity: 0.9, ..Particle::REST };
    let start = corners(Vec3::Y * 0.12, Vec3::splat(0.1), Vec3::ZERO, Vec3::NEG_Y * 2.0, part);
    let rebound = |compliance: f32| {
        let body = ShapeMatching { compliance, ..ShapeMatching::rigid(CUBE) };
        let scene = Scene { start: &start, colliders: &ground, constraints: &body, substeps: 20, ..Scene::EMPTY };
        let mut system = started(&scene, 8, 0);
        run(&mut system, &scene, 1.0 / 60.0, 2);
        system.particles().velocity.iter().map(|v| v.y).sum::<f32>() / 8.0
    };
    let [rigid, soft] = [0.0, 1e-10].map(rebound);
    assert!((rigid - 1.8).abs() < 0.02 && (soft - 1.8).abs() < 0.04, "{rigid} {soft} m/s");
}

/// A box that begins in a floor and in a wall is brought out of both without being thrown.
#[test]
fn who_begins_in_a_corner_is_not_thrown_out() {
    let faces = [Vec3::Y, Vec3::X].map(|normal| Plane { point: Vec3::ZERO, normal });
    let start = corners(
        Vec3::new(0.1 - 0.01, 0.1 - 0.015, 0.0),
        Vec3::splat(0.1),
        Vec3::ZERO,
        Vec3::ZERO,
        Particle { radius: 0.02, ..Particle::REST },
    );
    let start: Vec<Particle> =
        start.iter().map(|p| Particle { position: p.position + Vec3::new(0.02, 0.02, 0.0), ..*p }).collect();
    let body = ShapeMatching::rigid(CUBE);
    let scene = Scene { start: &start, colliders: &faces, constraints: &body, substeps: 20, ..Scene::EMPTY };
    let mut system = started(&scene, 8, 0);
    run(&mut system, &scene, 1.0 / 60.0, 30);
    for (x, v) in system.particles().position.iter().zip(system.particles().velocity) {
        assert!(v.length() < 0.02, "{x}: {v}");
        assert!(x.x > 0.019 && x.y > 0.019, "{x}");
    }
}

/// x of A x = b, by Cramer's rule.
fn solved(a: [[f64; 3]; 3], b: [f64; 3]) -> [f64; 3] {
    let determinant = |[x, y, z]: [[f64; 3]; 3]| (0..3).map(|k| x[k] * cross(y, z)[k]).sum::<f64>();
    // Symmetric: its rows are its columns.
    [0, 1, 2].map(|k| {
        let mut with = a;
        with[k] = b;
        determinant(with) / determinant(a)
    })
}
