//! Walls that turn: what slides along one is driven as that turns, and what is in a room of several stays in it.

use pointmass::force::Friction;
use pointmass::motion::{Motion, Script};
use pointmass::shape::{Aabb, Collider, Cuboid, Mesh, Moving, Plane, Scenery, Shape, Surface, Triangle};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Vec3};
use pointmass_tests::{Random, often, run, started};

const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// As seen from a smooth wall that turns at ω about an axis along it, y'' = ω² y: y is how far along the wall from the foot of the axis. Coriolis's force presses it on
/// to the wall as long as it goes the right way.
#[test]
fn what_slides_along_a_smooth_wall_that_turns_is_driven_outward() {
    let (mut random, mut failures, mut slid) = (Random::new(71), vec![], 0);
    for round in 0..often(600) {
        let method = Method::ALL[round % Method::ALL.len()];
        let rate = [24.0, 60.0, 77.0, 240.0][round % 4];
        let scale = [1.0f32, 0.1, 10.0][round % 3];
        // A frame of its own: the wall is at `across` = −1 from the axis, and turns from there to where the particle goes.
        let (axis, turns) = (random.direction(), random.between(0.05, 0.35));
        let across = axis.any_orthonormal_vector();
        let along = axis.cross(across);
        let pivot = random.vector(2.0) * scale;
        let drift = if random.unit() < 0.5 { random.vector(1.0) * scale } else { Vec3::ZERO };
        let motion = Motion { pivot, axis, spin: turns, drift, ..Motion::STILL };
        let wall = Plane { point: pivot - across * scale, normal: across };
        let collider = Moving::new(wall, &EVERYWHERE, motion);
        let omega = core::f64::consts::TAU * f64::from(turns);
        let radius = if random.unit() < 0.5 { 0.05 * scale } else { 0.0 };
        let (y, speed) = (-f64::from(random.between(0.0, 0.5)), -f64::from(random.between(0.5, 3.0)));
        let from = across * (radius - scale * (1.0 - 1e-5)) + along * (y as f32 * scale);
        let start = [Particle {
            position: pivot + from,
            velocity: (axis * omega as f32).cross(from) + drift + along * (speed as f32 * scale),
            radius,
            elasticity: 0.0,
            ..Particle::REST
        }];
        let integrator = method.integrator();
        let scene = Scene { start: &start, colliders: &collider, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        let steps = (rate * 0.8) as u32;
        run(&mut system, &scene, 1.0 / rate, steps);
        let t = f64::from(steps) / rate;
        let (sin, cos) = (omega * t).sin_cos();
        let now = system.particles().position[0] - pivot - drift * t as f32;
        let local = [now.dot(across), now.dot(along)].map(|x| f64::from(x / scale));
        let [x, at] = [cos * local[0] + sin * local[1], cos * local[1] - sin * local[0]];
        let right = y * (omega * t).cosh() + speed / omega * (omega * t).sinh();
        let off = [x + 1.0 - f64::from(radius / scale), at / right - 1.0];
        slid += 1;
        // Paths are held to a tenth of a millimetre; beside a wall they are of first order where they have been set off from it.
        if !(off[0].abs() < 1e-3 + 2e-4 / f64::from(scale) && off[1].abs() < 0.01 + 0.5 / rate) {
            failures.push(format!("{method} {rate} {scale} {omega:.2} {radius}: {off:?}"));
        }
    }
    assert!(failures.is_empty(), "{} of {slid} {failures:#?}", failures.len());
}

/// The walls of a room from −1 to 1 that is put somewhere: planes, plates or triangles.
fn room(kind: usize, center: Vec3) -> Vec<Shape<Mesh<'static>>> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let faces = axes.into_iter().flat_map(|axis| [axis, -axis]);
    faces
        .flat_map(|out| {
            let (u, v) = (Vec3::new(out.y, out.z, out.x), Vec3::new(out.z, out.x, out.y));
            let (at, corner) = (center + out, |a: f32, b: f32| center + out + u * a + v * b);
            match kind {
                0 => vec![Shape::Plane(Plane { point: at, normal: out })],
                1 => {
                    let (p, q) = (at - (u + v) * 1.1, at + (u + v) * 1.1 + out * 0.001);
                    vec![Shape::Box(Cuboid { min: p.min(q), max: p.max(q) })]
                }
                _ => {
                    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
                    vec![
                        Shape::Triangle(Triangle { corners: [a, b, c] }),
                        Shape::Triangle(Triangle { corners: [a, c, d] }),
                    ]
                }
            }
        })
        .collect()
}

#[test]
fn what_is_in_a_room_of_walls_that_move_as_one_stays_in_it() {
    let (mut random, mut escaped) = (Random::new(72), vec![]);
    for round in 0..often(300) {
        let method = [Method::Rk4, Method::Verlet, Method::Symplectic, Method::Embedded][round % 4];
        let h = [1.0 / 24.0, 1.0 / 60.0, 0.013][round % 3];
        let center = if random.unit() < 0.3 { Vec3::X * 50.0 } else { Vec3::ZERO };
        let motion = Motion {
            pivot: center + Vec3::Y * random.between(-1.0, 1.0),
            axis: random.direction(),
            spin: [0.0, 0.3, 1.0, 2.0][random.word() as usize % 4],
            drift: random.vector(2.0),
            swing: random.vector(0.5),
            frequency: (random.word() % 2) as f32,
            ..Motion::STILL
        };
        let walls = room(random.word() as usize % 3, center);
        let moving = walls.iter().map(|wall| Moving::new(wall.clone(), &wall.bounds(), motion));
        let list: Vec<_> = moving.collect();
        let scenery = Scenery::new(list.iter().map(|wall| (wall.clone(), wall.reach())).collect());
        let colliders: &dyn Collider = if round % 2 == 0 { &list } else { &scenery };
        let radius = [0.0, 0.0, 0.05, 0.2][random.word() as usize % 4];
        let mu = [0.0, 0.5][random.word() as usize % 2];
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }];
        let start: Vec<_> = (0..30)
            .map(|_| Particle {
                position: center + random.vector(0.5),
                velocity: random.vector(8.0),
                radius,
                elasticity: random.unit(),
                material: Some(0),
                ..Particle::REST
            })
            .collect();
        let integrator = method.integrator();
        let parts = Scene { start: &start, forces: &Gravity::EARTH, colliders, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { integrator, max_bounces: 1000, ..parts };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, h, (2.0 / h) as u32);
        let frame = motion.frame(system.time());
        let slack = 0.005 + 5e-5 * center.x;
        let inside = |x: &&Vec3| (frame.local(**x) - center).abs().max_element() + radius < 1.0 + slack;
        let there = system.particles().position;
        let inside = there.iter().filter(inside).count();
        if inside < start.len() {
            escaped.push(format!("{} in {round}: {method} {h:.4} {radius} {mu} {motion:?}", start.len() - inside));
        }
    }
    assert!(escaped.is_empty(), "{} {escaped:#?}", escaped.len());
}
