//! Particles that lie on a surface go on along it: over edges, into walls and sinks, down slopes, by every method.

use pointmass::force::Friction;
use pointmass::shape::{Collider, Cuboid, Plane, Sphere};
use pointmass::{ContactMaterial, Drag, Gravity, Method, Observer, Particle, Scene, Spread, Varied, Vec3};
use pointmass_tests::{G, Random, emitting, is_run, run, started};

/// Where a particle is and how fast, after steps until about an instant, among colliders and sinks under gravity; none if it is gone.
fn after(
    particle: Particle,
    [colliders, sinks]: [&dyn Collider; 2],
    materials: &[ContactMaterial],
    method: Method,
    [h, end]: [f64; 2],
) -> Option<[Vec3; 2]> {
    let integrator = method.integrator();
    let start = [Particle { mass: 2.0, ..particle }];
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders,
        sinks,
        materials: &materials,
        integrator: &integrator,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, 1, 1);
    run(&mut system, &scene, h, (end / h).round() as u32);
    let state = system.state(&scene);
    Some([*state.position.first()?, *state.velocity.first()?])
}

/// How far rounding may put something from a surface there.
fn room(home: Vec3) -> f32 {
    64.0 * f32::EPSILON * (2.0 + home.abs().max_element())
}

/// Every method, coarse and fine steps, points and balls, near the origin and far from it.
fn each_way(mut then: impl FnMut(Method, f64, f32, Vec3)) {
    for &method in Method::ALL {
        for h in [1.0 / 24.0, 1.0 / 60.0, 1.0 / 144.0] {
            for (radius, home) in [(0.0, Vec3::ZERO), (0.1, Vec3::new(40.0, -30.0, 7.0))] {
                then(method, h, radius, home);
            }
        }
    }
}

#[test]
fn an_edge_lets_it_fall() {
    each_way(|method, h, radius, home| {
        // Its middle stands over the edge after a second. A ball tips over it, so it is let go of by a slight push only.
        let table = Cuboid { min: home - Vec3::new(3.0, 1.0, 3.0), max: home + Vec3::new(1.0, 0.0, 3.0) };
        let start = Particle { position: home + Vec3::Y * radius, velocity: Vec3::X, radius, ..Particle::REST };
        let [x, v] = after(start, [&table, &()], &[], method, [h, 0.875]).expect("it is on the table");
        let way = ((0.875 / h).round() * h) as f32;
        assert!(
            (x.x - home.x - way).abs() < room(home) && (x.y - home.y - radius).abs() < room(home),
            "{method} {h}: {x}"
        );
        assert!((v - Vec3::X).length() < 1e-4, "{method} {h}: {v}");
        let [x, v] = after(start, [&table, &()], &[], method, [h, 1.5]).expect("it falls");
        assert!(x.y < home.y - 0.5 && v.y < -3.0 && v.x > 0.99, "{method} {h}: {x} {v}");
        if radius == 0.0 {
            assert!(f64::from(x.y - home.y) + G * 0.125 < G * h, "{method} {h}: {x}");
        }
    });
}

#[test]
fn a_wall_turns_it_back() {
    each_way(|method, h, radius, home| {
        let floor = Plane { point: home, normal: Vec3::Y };
        let wall = Plane { point: home + Vec3::X, normal: -Vec3::X };
        let elasticity = 0.5;
        let start =
            Particle { position: home + Vec3::Y * radius, velocity: Vec3::X, radius, elasticity, ..Particle::REST };
        let [x, v] = after(start, [&(floor, wall), &()], &[], method, [h, 2.0]).expect("it is between");
        let turn = 1.0 - f64::from(radius);
        let there = turn - 0.5 * (2.0 - turn);
        assert!((f64::from(x.x - home.x) - there).abs() < f64::from(2.0 * room(home)), "{method} {h} {radius}: {x}");
        assert!((v - Vec3::X * -0.5).length() < 1e-4, "{method} {h}: {v}");
        assert!((x.y - home.y - radius).abs() < room(home), "{method} {h}: {x}");
    });
}

#[test]
fn a_sink_in_the_floor_takes_it() {
    each_way(|method, h, radius, home| {
        let floor = Plane { point: home, normal: Vec3::Y };
        let drain = Cuboid { min: home + Vec3::new(1.0, -1.0, -1.0), max: home + Vec3::new(2.0, 0.0, 1.0) };
        let ball = Sphere { center: home + Vec3::new(1.5, 0.3, 0.0), radius: 0.3 };
        let start = Particle { position: home + Vec3::Y * radius, velocity: Vec3::X, radius, ..Particle::REST };
        // A particle that lies beside the plane by rounding may pass over a sink that is flush with it, but not by what
        // stands on it.
        let sinks = (drain, ball);
        assert!(after(start, [&floor, &sinks], &[], method, [h, 0.7]).is_some(), "{method} {h}");
        assert!(after(start, [&floor, &sinks], &[], method, [h, 1.8]).is_none(), "{method} {h}");
    });
}

#[test]
fn slopes_brake_it_by_coulomb_s_law() {
    let mut random = Random::new(5);
    each_way(|method, h, radius, home| {
        let angle = f64::from(random.between(0.05, 1.2));
        let friction = Friction { static_: 0.4, kinetic: 0.3 };
        let materials = [ContactMaterial { elasticity: None, friction: Some(friction) }];
        let normal = Vec3::new(angle.sin() as f32, angle.cos() as f32, 0.0);
        let down = Vec3::new(normal.y, -normal.x, 0.0);
        let slope = Plane { point: home, normal };
        let start = Particle { position: home + normal * radius, radius, material: Some(0), ..Particle::REST };
        let [x, v] = after(start, [&slope, &()], &materials, method, [h, 0.75]).expect("it is on the slope");
        let pull = G * (angle.sin() - 0.3 * angle.cos());
        let rate = if angle.tan() > 0.4 { pull } else { 0.0 };
        let along = f64::from((x - start.position).dot(down));
        let off = (along - rate * 0.75 * 0.75 / 2.0).abs() + (f64::from(v.dot(down)) - rate * 0.75).abs();
        // The way and the speed of the first step itself depend on the method.
        assert!(off < 1e-3 + 2e-3 * along + 2.0 * rate * h * h, "{method} {h} {angle}: {off} of {along}");
        assert!((x - start.position).dot(normal).abs() < room(home), "{method} {h}: {x}");
        if rate == 0.0 {
            assert_eq!(v, Vec3::ZERO);
        }
    });
}

/// Looks on, and so makes all rows go through one phase after the other.
struct Onlooker;

impl Observer for Onlooker {}

/// Tile by tile, on several threads or all at once is the same to the bit, and is told the same.
#[test]
fn rows_a_few_at_a_time_do_as_all_at_once() {
    let floor = Plane { point: Vec3::Y * -3.0, normal: Vec3::new(0.1, 1.0, 0.0) };
    let drain = Sphere { center: Vec3::new(1.5, -3.0, 0.5), radius: 0.4 };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("three threads");
    let mut cases = 0;
    for &method in Method::ALL {
        for (rate, substeps) in [(300.0, 1), (9000.0, 1), (1100.0, 3)] {
            if !is_run(&mut cases) {
                continue;
            }
            let emitter = pointmass::Emitter {
                spread: Spread::Uniform(1.0),
                drag: Varied::exactly(0.1),
                elasticity: Varied { mean: 0.5, half_width: 0.2 },
                lifetime: Varied { mean: 1.0, half_width: 0.5 },
                ..emitting::varied(rate)
            };
            let integrator = method.integrator();
            let scene = Scene {
                emitters: &emitter,
                forces: &(Gravity::EARTH, Drag {}),
                colliders: &floor,
                sinks: &drain,
                substeps,
                integrator: &integrator,
                ..Scene::EMPTY
            };
            let [mut alone, mut seen, mut shared] = [(); 3].map(|()| started(&scene, 9000, 3));
            for _ in 0..100 {
                let dt = pointmass::Time::frame(1, 50);
                let report = alone.step(&scene, dt);
                assert_eq!(report, seen.step_observed(&scene, dt, &mut Onlooker), "{method}");
                assert_eq!(report, pool.install(|| shared.step(&scene, dt)), "{method}");
            }
            let totals = alone.totals();
            assert!(totals.hits > 100 && totals.died.total() > 100, "{totals:?}");
            assert_eq!(alone.hash(), seen.hash(), "{method}");
            assert_eq!(alone.hash(), shared.hash(), "{method}");
            assert_eq!(alone.state(&scene).position, seen.state(&scene).position);
        }
    }
}
