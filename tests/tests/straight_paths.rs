//! Straight paths: nothing passes, bounces are those of curved paths but for the step's order, and what rests stays.

#[path = "../firmware/src/jet.rs"]
mod jet;

use pointmass::force::Friction;
use pointmass::shape::{Collider, Disc, Plane};
use pointmass::{
    Attention, ContactMaterial, Emitter, Gravity, Method, Observer, Particle, Paths, Phase, Scene, Time, Varied, Vec3,
};
use pointmass_tests::solids::{extent, inside, solids};
use pointmass_tests::{G, Random, f64s, often, run, started};

#[test]
fn a_small_program_has_its_bits_on_every_target() {
    jet::run(&mut jet::Memory::new()).expect("the bits that firmware/src/jet.rs expects");
}

#[test]
fn nothing_gets_out_of_a_closed_surface() {
    let mut random = Random::new(31);
    for solid in solids() {
        let forces = Gravity { acceleration: random.vector(20.0) };
        let base = Scene { colliders: &*solid.collider, forces: &forces, paths: Paths::STRAIGHT, ..Scene::EMPTY };
        let mut hits = 0;
        for _ in 0..often(20_000) / 1000 {
            let fly = |_| {
                let position = inside(&solid, &mut random);
                let corner = solid.corners[random.word() as usize % solid.corners.len()];
                let aim =
                    if random.unit() < 0.5 { random.direction() } else { (corner - position).normalize_or(Vec3::Y) };
                let velocity = aim * (random.magnitude(1e-5, 30.0) * extent(&solid) * 64.0);
                Particle { position, velocity, elasticity: random.unit(), ..Particle::REST }
            };
            let start: Vec<Particle> = (0..1000).map(fly).collect();
            let scene = Scene { start: &start, ..base };
            let mut system = started(&scene, start.len(), 0);
            for step in 1..=6 {
                system.step(&scene, Time::from_ticks(1 << 26));
                for (row, &x) in system.particles().position.iter().enumerate() {
                    let out = -(solid.depth)(f64s(x));
                    assert!(
                        out <= 4e-6 * f64::from(solid.size),
                        "{}: {step}, {:?} to {x}, {out} m out",
                        solid.name,
                        start[row]
                    );
                }
            }
            hits += system.totals().hits;
        }
        assert!(hits > 0, "{}", solid.name);
    }
}

/// A floor through a place, tilted by an angle about z \[rad\].
fn floor(point: Vec3, tilt: f32) -> Plane {
    Plane { point, normal: Vec3::new(tilt.sin(), tilt.cos(), 0.0) }
}

#[test]
fn bounces_are_those_of_curved_paths_within_the_step_squared() {
    let mut random = Random::new(32);
    let drop = |_| Particle {
        position: random.vector(1.0) + Vec3::Y * 2.0,
        velocity: random.vector(2.0),
        elasticity: random.between(0.5, 1.0),
        ..Particle::REST
    };
    let start: Vec<Particle> = (0..200).map(drop).collect();
    let ground = floor(Vec3::ZERO, 0.1);
    for method in [Method::Verlet, Method::Midpoint, Method::Rk4] {
        let integrator = method.integrator();
        let base = Scene {
            start: &start,
            forces: &Gravity::EARTH,
            colliders: &ground,
            integrator: &integrator,
            ..Scene::EMPTY
        };
        for steps in [50_u32, 100, 400] {
            let h = 1.5 / f64::from(steps);
            let [curved, straight] = [Paths::CURVED, Paths::STRAIGHT].map(|paths| {
                let scene = Scene { paths, ..base };
                let mut system = started(&scene, start.len(), 1);
                run(&mut system, &scene, h, steps);
                assert!(system.totals().hits > 200);
                system.particles().position.to_vec()
            });
            let gap = curved.iter().zip(&straight).map(|(a, b)| (*a - *b).length()).fold(0.0, f32::max);
            // Some four bounces, in each of which the place is g h²/8 off at the most.
            assert!(f64::from(gap) < 10.0 * G * h * h, "{method} {steps}: {gap}");
        }
    }
}

#[test]
fn what_rests_stays_and_what_slides_obeys_coulomb() {
    const RUBBER: Friction = Friction { static_: 0.5, kinetic: 0.4 };
    let materials = [ContactMaterial { elasticity: None, friction: Some(RUBBER) }];
    for method in Method::ALL.iter().filter(|&&method| method != Method::Euler) {
        for (home, tilt) in [(Vec3::ZERO, 0.0), (Vec3::new(30.0, -20.0, 5.0), 0.3), (Vec3::Z, 0.7)] {
            let (integrator, ground) = (method.integrator(), floor(home, tilt));
            let start =
                [Particle { position: home + Vec3::Y * 0.2, elasticity: 0.3, material: Some(0), ..Particle::REST }];
            let scene = Scene {
                start: &start,
                forces: &Gravity::EARTH,
                colliders: &ground,
                materials: &materials,
                paths: Paths::STRAIGHT,
                integrator: &integrator,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 1, 1);
            run(&mut system, &scene, 1.0 / 120.0, 360);
            let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
            run(&mut system, &scene, 1.0 / 120.0, 480);
            let (y, w) = (system.particles().position[0], system.particles().velocity[0]);
            if f64::from(tilt).tan() < f64::from(RUBBER.kinetic) {
                assert_eq!([x, v, w], [y, Vec3::ZERO, Vec3::ZERO], "{method} {tilt}");
            } else {
                let (sin, cos) = f64::from(tilt).sin_cos();
                let expected = G * (sin - f64::from(RUBBER.kinetic) * cos);
                let gained = f64::from(w.length() - v.length());
                assert!((gained - expected).abs() < 0.02 * expected, "{method}: {gained}, not {expected}");
            }
            assert!(ground.normal.dot(y - home) >= 0.0);
        }
    }
}

#[test]
fn births_leave_the_surface_that_they_lie_on() {
    let mut random = Random::new(33);
    for _ in 0..often(40) {
        let ground = floor(random.vector(100.0), random.between(-1.0, 1.0));
        let normal = ground.normal.normalize();
        let source = Disc { center: ground.point, normal, radius: 2.0 };
        let speed = Varied { mean: 2.0, half_width: 1.9 };
        let emitter = Emitter { speed, ..Emitter::new(source, random.between(100.0, 1000.0)) };
        let scene = Scene {
            emitters: &emitter,
            forces: &Gravity::EARTH,
            colliders: &ground,
            paths: Paths::STRAIGHT,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 1000, 3);
        for _ in 0..60 {
            system.step(&scene, Time::frame(1, 60));
            let below = |x: &&Vec3| normal.dot(**x - ground.point) < -3e-5;
            assert_eq!(system.particles().position.iter().find(below), None);
        }
        assert!(system.totals().born > 50 && system.totals().hits > 0);
    }
}

/// Looks at all phases.
struct Watch(u32);

impl Observer for Watch {
    fn attention(&self) -> Attention {
        Attention::Phases
    }
    fn after(&mut self, _: Phase, _: &pointmass::force::State<'_>) {
        self.0 += 1;
    }
}

#[test]
fn sinks_take_bounds_are_counted_and_who_looks_on_changes_nothing() {
    let start: Vec<Particle> = (0..3000)
        .map(|i| Particle { position: Vec3::new(i as f32 * 1e-3, 0.5, 0.0), velocity: Vec3::X * 3.0, ..Particle::REST })
        .collect();
    let (ground, wall) = (floor(Vec3::ZERO, 0.05), Plane { point: Vec3::X * 3.5, normal: Vec3::NEG_X });
    let sinks: &dyn Collider = &wall;
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: &ground,
        sinks,
        paths: Paths::STRAIGHT,
        ..Scene::EMPTY
    };
    let (mut alone, mut seen, mut watch) = (started(&scene, 3000, 1), started(&scene, 3000, 1), Watch(0));
    for _ in 0..60 {
        alone.step(&scene, Time::frame(1, 60));
        seen.step_observed(&scene, Time::frame(1, 60), &mut watch);
        assert_eq!(alone.hash(), seen.hash());
        assert!(alone.particles().position.iter().all(|x| x.x <= 3.5));
    }
    assert!(watch.0 > 0 && alone.totals().died.sink > 1000 && alone.totals().hits > 1000);

    // A thousand bounces a step between two planes are more than are followed.
    let slit = (floor(Vec3::ZERO, 0.0), floor(Vec3::Y * 1e-3, 0.0));
    let fast = [Particle { position: Vec3::Y * 5e-4, velocity: Vec3::Y * 60.0, elasticity: 1.0, ..Particle::REST }];
    let scene = Scene { start: &fast, colliders: &slit, paths: Paths::STRAIGHT, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 1);
    let report = system.step(&scene, Time::frame(1, 60));
    assert_eq!([report.hits, report.caps.bounces], [u64::from(scene.max_bounces), 1]);
    assert!((0.0..=1e-3).contains(&system.particles().position[0].y));
}
