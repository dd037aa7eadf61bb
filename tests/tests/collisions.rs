//! Collisions: mirrors, bouncing balls, and what counts as a hit.

use pointmass::shape::{Capsule, Collider, Cone, Cuboid, Cylinder, Disc, Plane, Segment, Sphere, Surface, Triangle};
use pointmass::{Emitter, Gravity, Method, Particle, Scene, Time, Varied, Vec3};
use pointmass_tests::solids::{extent, inside, solids};
use pointmass_tests::{Form, G, Random, f64s, gap, often, point, run, started};

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

#[test]
fn a_point_in_a_box_unfolds_to_a_triangle_wave() {
    let unit = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let triangle = |x: f64| (x - 2.0 * (x / 2.0).round()).abs();
    for v in [Vec3::new(3.1, -2.7, 5.3), Vec3::new(0.31, 0.03, -0.17), Vec3::new(-100.0, 77.0, 19.0)] {
        let start = [Particle { position: Vec3::new(0.3, 0.6, 0.1), velocity: v, elasticity: 1.0, ..Particle::REST }];
        let scene = Scene { start: &start, colliders: &unit, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        for i in 1..=often(30_000) {
            let report = system.step(&scene, Time::frame(i as u64, 60) - system.time());
            assert_eq!(report.caps.bounces, 0);
            if !i.is_multiple_of(100) {
                continue;
            }
            let (t, hits) = (system.time().seconds_f64(), system.totals().hits as f64);
            let p = system.particles();
            assert_eq!(p.velocity[0].abs(), v.abs(), "the speed is the same to the bit");
            let unfolded: [f64; 3] = core::array::from_fn(|k| f64s(start[0].position)[k] + f64s(v)[k] * t);
            // Every bounce sets off by at most 2e-6 m (twice the slack), every frame rounds by half an ulp of 1 m.
            let off = gap(f64s(p.position[0]), unfolded.map(triangle));
            let tolerance = 2e-6 * hits + 6e-8 * i as f64 + 1e-6;
            assert!(off < tolerance, "{off} after {hits} bounces");
            if unfolded.iter().all(|x| (x - x.round()).abs() > tolerance) {
                let crossings: f64 = unfolded.iter().map(|x| x.floor().abs()).sum();
                assert_eq!(hits, crossings);
            }
        }
    }
}

#[test]
fn a_bouncing_ball() {
    let start = [Particle { position: Vec3::new(0.5, 1.0, -0.25), elasticity: 0.8, ..Particle::REST }];
    for method in [Method::Midpoint, Method::Verlet, Method::Rk4] {
        let integrator = method.integrator();
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &FLOOR, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        let (mut bounces, mut impact, mut apex) = (0, (2.0 / G).sqrt(), 1.0);
        for i in 1..=64 * 60 {
            let report = system.step(&scene, Time::frame(i, 60) - system.time());
            let (x, v) = (system.particles().position[0], system.particles().velocity[0]);
            assert_eq!((x.x, x.z), (0.5, -0.25));
            let (y, v) = (f64::from(x.y), f64::from(v.y));
            assert!(y >= 0.0);
            if report.hits == 1 && bounces < 10 {
                // How fast it left the ground, by its energy; and so when.
                let up = (v * v + 2.0 * G * y).sqrt();
                let at = system.time().seconds_f64() - (up - v) / G;
                bounces += 1;
                // It is set off by 2e-6 m at the most, without the energy of that, and rests at rounding.
                apex *= 0.64;
                let height = up * up / (2.0 * G);
                assert!((at - impact).abs() < 2e-5, "{method}: impact {bounces} at {at}, not {impact}");
                assert!((height - apex).abs() < 2e-6, "{method}: apex {bounces} at {height}, not {apex}");
                impact += 2.0 * (2.0 * apex / G).sqrt();
            }
            // Zeno's sum: it comes to rest at 4.06 s.
            if i > 270 {
                assert!(y < 1e-5 && v.abs() < 1e-3, "{method}: at {y} with {v} after {i} frames");
            }
        }
        assert_eq!(bounces, 10);
        assert_eq!(system.totals().caps.bounces, 0);
    }
}

#[test]
fn one_that_lies_on_a_surface_and_leaves_does_not_hit_it() {
    // Places on surfaces that an f32 holds exactly, and the way out.
    let sphere = Sphere { center: Vec3::X, radius: 2.0 };
    let cuboid = Cuboid { min: Vec3::NEG_ONE, max: Vec3::ONE };
    let cylinder = Cylinder { center: Vec3::ZERO, radius: 1.0, height: 2.0 };
    let cone = Cone { center: Vec3::ZERO, radius: 1.0, height: 2.0 };
    let disc = Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 1.0 };
    let cases: [(&str, &dyn Collider, Vec3, Vec3); 10] = [
        ("sphere", &sphere, Vec3::X * 3.0, Vec3::X),
        ("sphere", &sphere, Vec3::new(1.0, 0.0, -2.0), Vec3::NEG_Z),
        ("box", &cuboid, Vec3::new(1.0, 0.25, 0.5), Vec3::X),
        ("corner of a box", &cuboid, Vec3::ONE, Vec3::ONE),
        ("cylinder", &cylinder, Vec3::new(1.0, 0.5, 0.0), Vec3::X),
        ("cap", &cylinder, Vec3::new(0.25, -1.0, 0.0), Vec3::NEG_Y),
        ("base", &cone, Vec3::new(0.25, -1.0, 0.0), Vec3::NEG_Y),
        ("apex", &cone, Vec3::Y, Vec3::Y),
        ("disc", &disc, Vec3::X * 0.5, Vec3::Y),
        ("plane", &FLOOR, Vec3::ZERO, Vec3::Y),
    ];
    for (name, collider, position, way) in cases {
        let start = [Particle { position, velocity: way, ..Particle::REST }];
        let scene = Scene { start: &start, colliders: collider, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 1.0 / 64.0, 64);
        assert_eq!(system.totals().hits, 0, "{name}");
        assert!((system.particles().position[0] - position - way).length() < 1e-5, "{name}");
    }
}

#[test]
fn what_lies_on_an_open_surface_is_on_the_side_of_its_normal() {
    let triangle =
        Triangle { corners: [Vec3::ZERO, Vec3::Z, Vec3::X].map(|corner| corner * 9.0 - 2.0 * (Vec3::X + Vec3::Z)) };
    let disc = Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 1.0 };
    let surfaces: [&dyn Collider; 3] = [&FLOOR, &disc, &triangle];
    for colliders in surfaces {
        let start = [Particle::REST];
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 1.0 / 64.0, 64);
        let y = system.particles().position[0].y;
        assert!((0.0..1e-5).contains(&y), "it lay on the surface, and is now at {y}");
    }
}

#[test]
fn what_begins_a_hair_above_the_floor_stays_above() {
    // Particles of the start, that lie nearer to the floor than rounding can be sure of at their coordinates.
    for x in [0.0, 1.0, 100.0] {
        for gap in [1e-9, 1e-8, 1e-7, 1e-6, 1e-5] {
            for v in [0.0, -1e-3, -1.0, -100.0] {
                let velocity = Vec3::Y * v;
                let start =
                    [Particle { position: Vec3::new(x, gap, 0.0), velocity, elasticity: 0.0, ..Particle::REST }];
                let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &FLOOR, ..Scene::EMPTY };
                let mut system = started(&scene, 1, 0);
                run(&mut system, &scene, 1.0 / 60.0, 60);
                let y = system.particles().position[0].y;
                assert!(y >= 0.0, "from {gap} with {v} at x = {x} to {y}");
            }
        }
    }
}

#[test]
fn births_on_a_surface_do_not_hit_it_as_they_leave() {
    let center = Vec3::new(0.3, 0.1, -0.7);
    let shapes = [
        ("sphere", Form::Sphere(Sphere { center, radius: 0.7 })),
        ("box", Form::Box(Cuboid { min: Vec3::splat(0.1), max: Vec3::splat(0.7) })),
        ("cylinder", Form::Cylinder(Cylinder { center, radius: 0.7, height: 0.9 })),
        ("cone", Form::Cone(Cone { center, radius: 0.7, height: 0.9 })),
        ("capsule", Form::Capsule(Capsule { from: center, to: Vec3::new(0.9, 0.5, 0.2), radius: 0.7 })),
        ("disc", Form::Circle(Disc { center, normal: Vec3::new(1.0, 2.0, -3.0), radius: 0.7 })),
    ];
    let mut hits = vec![];
    for (name, shape) in shapes {
        let emitter = Emitter { speed: Varied::exactly(2.0), ..Emitter::new(shape.clone(), 1000.0) };
        let scene = Scene { emitters: &emitter, colliders: &shape, ..Scene::EMPTY };
        let mut system = started(&scene, 1000, 0);
        run(&mut system, &scene, 0.1, 10);
        if system.totals().hits > 0 {
            hits.push((name, system.totals().hits));
        }
    }
    assert!(hits.is_empty(), "of 1000 births each: {hits:?}");
}

#[test]
fn whichever_comes_first_counts() {
    let wall = |x: f32| Plane { point: Vec3::X * x, normal: Vec3::X };
    let start = [Particle { velocity: Vec3::X * 10.0, ..Particle::REST }];
    // Collider, sink, whether it dies: within one step, and within several.
    for (collider, sink, dies) in [(1.0, 2.0, false), (2.0, 1.0, true), (1.0, 1.0, true), (1.0, 1.0001, false)] {
        for steps in [1, 7, 60] {
            let (collider, sink) = (wall(collider), wall(sink));
            let scene = Scene { start: &start, colliders: &collider, sinks: &sink, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 0);
            run(&mut system, &scene, 1.0 / f64::from(steps), steps);
            assert_eq!(system.is_empty(), dies, "{collider:?} {sink:?}");
            assert_eq!((system.totals().hits, system.totals().died.sink), (u64::from(!dies), u64::from(dies)));
        }
    }
}

#[test]
fn a_tight_wedge_reaches_the_cap_and_holds() {
    // Two planes at two degrees to each other; the particle is driven between them.
    let (s, c) = 0.0349f32.sin_cos();
    let wedge = (FLOOR, Plane { point: Vec3::ZERO, normal: Vec3::new(-s, c, 0.0) });
    let mut random = Random::new(26);
    let start: Vec<Particle> = (0..often(1000))
        .map(|i| {
            let x = random.between(0.5, 1.0);
            let position = Vec3::new(x, x * 0.0174, 0.0);
            let velocity = Vec3::new(-random.magnitude(0.1, 100.0), random.between(-1.0, 1.0), 0.0);
            Particle { position, velocity, elasticity: [1.0, 0.5, 0.0][i % 3], ..Particle::REST }
        })
        .collect();
    let scene = Scene { start: &start, colliders: &wedge, max_bounces: 8, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    for i in 1..=60 {
        let report = system.step(&scene, Time::frame(i, 60) - system.time());
        assert!(report.hits <= 8 * start.len() as u64, "the work of a step is bounded");
        for x in system.particles().position {
            let above = f64::from(x.x) * f64::from(s) - f64::from(x.y) * f64::from(c);
            assert!(f64::from(x.y) > -1e-6 && above > -1e-6, "{x} is outside the wedge");
        }
    }
    assert!(system.totals().caps.bounces > 0);
}

#[test]
fn the_fixed_are_left_alone() {
    let start = [Particle { position: Vec3::Y * 0.5, velocity: Vec3::NEG_Y * 100.0, fixed: true, ..Particle::REST }; 2];
    let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
    let (colliders, sinks) = ((FLOOR, ball), Sphere { center: Vec3::Y * 0.5, radius: 1e-3 });
    for &method in Method::ALL {
        let (forces, integrator) = (&Gravity::EARTH, method.integrator());
        let scene = Scene { start: &start, forces, colliders: &colliders, sinks: &sinks, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 0.1, 20);
        assert_eq!(system.particles().position, [Vec3::Y * 0.5; 2]);
        assert_eq!(system.particles().velocity, [Vec3::ZERO; 2]);
        assert_eq!((system.totals().hits, system.totals().died.total()), (0, 0));
    }
}

#[test]
fn newborns_bounce_in_the_step_of_their_birth() {
    // One step of 0.9 s with births all through it, falling from 1 m: some have bounced by then, some not.
    let emitter = Emitter { elasticity: Varied::exactly(0.8), ..Emitter::new(point(Vec3::Y), 40.0) };
    let scene = Scene { emitters: &emitter, forces: &Gravity::EARTH, colliders: &FLOOR, ..Scene::EMPTY };
    let mut system = started(&scene, 40, 0);
    let report = system.step(&scene, Time::from_seconds(0.9));
    let p = system.particles();
    let (fall, mut bounced) = ((2.0 / G).sqrt(), 0);
    for i in 0..system.len() {
        let t = 0.9 - p.born[i].seconds_f64();
        let (y, v) = if t < fall {
            (1.0 - 0.5 * G * t * t, -G * t)
        } else {
            bounced += 1;
            let (up, rest) = (0.8 * G * fall, t - fall);
            (up * rest - 0.5 * G * rest * rest, up - G * rest)
        };
        // Hits lie on the path itself, whatever its chords; the set-off of 2e-6 m turns into time at 4 m/s.
        assert!((f64::from(p.position[i].y) - y).abs() < 1e-5, "age {t}: {} for {y}", p.position[i].y);
        assert!((f64::from(p.velocity[i].y) - v).abs() < 1e-5, "age {t}: {} for {v}", p.velocity[i].y);
    }
    assert_eq!((system.len() as u64, report.hits), (35, bounced));
    assert!(bounced > 10);
}

#[test]
fn a_hit_turns_the_normal_speed_alone() {
    let mut random = Random::new(27);
    for solid in solids() {
        let mut straight = 0;
        for _ in 0..often(2000) {
            let elasticity = random.unit();
            let target = inside(&solid, &mut random);
            let way = random.direction();
            let position = target + way * 3.0 * extent(&solid);
            let velocity = -way * 4.0 * extent(&solid);
            let Some(hit) = solid.collider.first_hit(&Segment::new(position, position + velocity)) else {
                panic!("{}: {position} misses {target}", solid.name)
            };
            // Along its normal the depth falls by just as much, unless an edge is near.
            let h = 0.02 * (solid.depth)(f64s(solid.middle)) as f32;
            let depth = |by: f32| (solid.depth)(f64s(position + velocity * hit.time + hit.normal * by)) / f64::from(h);
            if (depth(-h) - 1.0).abs() < 0.05 {
                assert!((depth(h) + 1.0).abs() < 0.05, "{}: {hit:?}", solid.name);
                straight += 1;
            }
            let start = [Particle { position, velocity, elasticity, ..Particle::REST }];
            let scene = Scene { start: &start, colliders: &*solid.collider, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 0);
            system.step(&scene, Time::SECOND);
            if system.totals().hits != 1 {
                continue;
            }
            let incoming = velocity.dot(hit.normal);
            let expected = velocity - hit.normal * (1.0 + elasticity) * incoming;
            let p = system.particles();
            assert!((p.velocity[0] - expected).length() < 1e-5 * velocity.length(), "{}", solid.name);
            // And on it goes for the time that is left, set off by a few slacks, more where an edge is near; a normal's
            // rounding counts as far as it goes.
            let place = position + velocity * hit.time + expected * (1.0 - hit.time);
            let off = (p.position[0] - place).length();
            assert!(off < 60.0 * hit.slack + 1e-5 * (solid.size + velocity.length()), "{}: {off}", solid.name);
        }
        assert!(straight > often(1000), "{}: {straight}", solid.name);
    }
}

#[test]
fn nearest_points_are_as_near_as_the_solid_is_deep() {
    // The sphere, box and cylinder measure depth exactly, so that `nearest` has an oracle in double precision.
    let center = Vec3::new(0.3, -0.2, 0.5);
    let shapes = [
        Form::Sphere(Sphere { center, radius: 0.75 }),
        Form::Cylinder(Cylinder { center, radius: 0.5, height: 1.5 }),
        Form::Cone(Cone { center, radius: 0.75, height: 1.25 }),
        Form::Box(Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.2) }),
    ];
    let mut random = Random::new(28);
    for (shape, solid) in shapes.iter().zip(solids()) {
        for _ in 0..often(20_000) {
            let point = solid.middle + random.vector(1.0);
            let depth = (solid.depth)(f64s(point));
            let distance = gap(f64s(shape.nearest(point)), f64s(point));
            // Outside, beyond edges and corners, it is farther than the deepest violated wall.
            assert!(distance > depth.abs() - 1e-6, "{}: {distance}, {depth}", solid.name);
            assert!(depth < 0.0 || (distance - depth).abs() < 1e-6, "{}: {distance}, {depth}", solid.name);
            assert!((solid.depth)(f64s(shape.nearest(point))).abs() < 1e-6, "{}", solid.name);
        }
    }
}
