//! Walls that turn: what slides along one is driven as that turns, and what is in a room of several stays in it.

use pointmass::force::Friction;
use pointmass::motion::{Motion, Script};
use pointmass::shape::{Aabb, Collider, Cuboid, Hit, Mesh, Moving, Plane, Scenery, Segment, Shape, Surface, Triangle};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, every, often, run, started};

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
        if !(off[0].abs() < 1e-3 + 2e-4 / f64::from(scale) && off[1].abs() < 0.012 + 0.5 / rate) {
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
    // Hits on walls that turn are the dearest of all.
    let rounds = if cfg!(debug_assertions) { 6 } else { 150 };
    for round in 0..rounds {
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
            .step_by(every(3))
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

/// Whom one thing takes along the others hold, in whatever order they are listed: two that move, one that moves beside one that stands still, and one of a user's own that
/// says nothing but when it is hit.
#[test]
fn what_is_carried_by_one_is_held_by_the_others() {
    struct Own(Plane);
    impl Collider for Own {
        fn first_hit(&self, segment: &Segment) -> Option<Hit> {
            self.0.first_hit(segment)
        }
    }
    let moving = |plane, drift| Moving::new(plane, &EVERYWHERE, Motion { drift, ..Motion::STILL });
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let wall = Plane { point: Vec3::X, normal: Vec3::X };
    let (lift, piston, belt) =
        (moving(floor, Vec3::Y), moving(wall, Vec3::NEG_X), moving(floor, Vec3::new(1.0, 1.0, 0.0)));
    let during = [Time::ZERO, Time::from_seconds(0.1)];
    for radius in [0.0, 0.05] {
        let from = Vec3::new(0.95 - radius, 0.001 + radius, 0.3);
        let wanted = [Vec3::new(0.9 - radius, 0.1 + radius, 0.3), Vec3::new(1.0 - radius, 0.1 + radius, 0.3)];
        let pairs: [([&dyn Collider; 2], Vec3); 3] =
            [([&lift, &piston], wanted[0]), ([&belt, &wall], wanted[1]), ([&belt, &Own(wall)], wanted[1])];
        for (pair, want) in pairs {
            for pair in [pair, [pair[1], pair[0]]] {
                let there = [pair.carry(from, radius, during), (pair[0], pair[1]).carry(from, radius, during)];
                for there in there {
                    // On the side that it has been on, and no farther away than what it was away from it.
                    let off = there - want;
                    assert!(off.x <= 0.0 && off.y >= 0.0 && off.length() < 0.06, "{there}, not {want}");
                }
            }
        }
    }
}

/// Friction that brakes what a turning wall has been pressed by leaves it to go: it had been driven along by a force that presses no more.
#[test]
fn what_friction_brakes_on_a_wall_that_turns_away_is_not_driven_along() {
    let wall = Plane { point: Vec3::X, normal: Vec3::X };
    let collider = Moving::new(wall, &EVERYWHERE, Motion { axis: Vec3::Z, spin: 0.5, ..Motion::STILL });
    for (mu, y) in [(20.0, 0.3f32), (2.0, 0.05), (5.0, 0.2)] {
        for &method in Method::ALL {
            let friction = Some(Friction { static_: mu, kinetic: mu });
            let materials = [ContactMaterial { elasticity: None, friction }];
            let omega = Vec3::Z * core::f32::consts::PI;
            let from = Vec3::new(1.0 + 1e-5, y, 0.0);
            let start = [Particle {
                position: from,
                velocity: Vec3::X * -3.0,
                elasticity: 0.0,
                material: Some(0),
                ..Particle::REST
            }];
            let parts = Scene { start: &start, colliders: &collider, materials: &materials, ..Scene::EMPTY };
            let scene = Scene { integrator: method.integrator(), ..parts };
            let mut system = started(&scene, 1, 0);
            run(&mut system, &scene, 1.0 / 60.0, 1);
            let there = system.particles();
            let slip = there.velocity[0] - omega.cross(there.position[0]);
            assert!(slip.length() < 0.2, "{method} {mu} {y}: {slip}");
        }
    }
}

/// A blade that turns fast strikes what it sweeps over as it does in shorter steps, if it turns by less than a quarter in one; and if by several turns, it strikes.
#[test]
fn what_turns_fast_strikes_no_otherwise_in_long_steps() {
    let blade = Cuboid { min: Vec3::new(-1.0, -0.1, -0.01), max: Vec3::new(1.0, 0.1, 0.01) };
    let mut random = Random::new(5);
    let around = |_: usize| {
        let out = Vec3::new(random.between(-1.0, 1.0), random.between(-0.09, 0.09), random.between(-1.0, 1.0));
        Particle { position: out, elasticity: 0.5, ..Particle::REST }
    };
    let is_beside =
        |particle: &Particle| particle.position.z.abs() > 0.05 && particle.position.with_y(0.0).length() < 0.95;
    let start: Vec<_> = (0..600).map(around).filter(is_beside).collect();
    for turns in [3.0f32, 7.0, 12.0, 480.0] {
        let motion = Motion { axis: Vec3::Y, spin: turns, ..Motion::STILL };
        let collider = Moving::new(blade, &blade.bounds(), motion);
        let scene = Scene { start: &start, colliders: &collider, max_bounces: 64, ..Scene::EMPTY };
        let after = |steps: u32| {
            let mut system = started(&scene, start.len(), 0);
            for step in 1..=steps {
                system.step_to(&scene, Time::frame(step.into(), 60 * steps));
            }
            let fast: Vec<f64> = system.particles().velocity.iter().map(|v| f64::from(v.length())).collect();
            (fast.iter().map(|v| v * v).sum::<f64>(), fast.into_iter().fold(0.0, f64::max), system.totals().hits)
        };
        let (long, short) = (after(1), after(400));
        let is_like = (long.0 / short.0 - 1.0).abs() < 2e-3 && (long.1 / short.1 - 1.0).abs() < 0.01;
        assert!(long.2 > 30 && (is_like || turns > 15.0), "{turns}/s: {long:?}, in short steps {short:?}");
    }
}
