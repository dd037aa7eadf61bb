//! Nothing gets through anything: fast and slow flights at solids, sheets and sinks, half of them at edges and corners.

use core::ops::Range;
use pointmass::force::State;
use pointmass::shape::{Affine, Collider, Cuboid, Disc, MeshBuf, Placed, Plane};
use pointmass::{Force, Gravity, Heap, Mat3, Method, Particle, Scene, Size, Storage, System, Time, Vec3};
use pointmass_tests::solids::{Solid, below, extent, inside, solids};
use pointmass_tests::{Random, every, f64s, gap, often, started};

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

/// Steps of this many metres a frame, from crawling to crossing many times over.
fn pace(random: &mut Random, size: f32) -> f32 {
    random.magnitude(1e-5, 30.0) * size
}

/// A half of all flights are aimed at a corner or an edge, and start there from the middle as often as not.
fn aim(solid: &Solid, random: &mut Random, from: Vec3) -> Vec3 {
    if random.unit() < 0.5 {
        random.direction()
    } else {
        (solid.corners[random.word() as usize % solid.corners.len()] - from).normalize_or(Vec3::Y)
    }
}

#[test]
fn nothing_gets_out_of_a_closed_surface() {
    let mut random = Random::new(21);
    let mut failures = vec![];
    for solid in solids() {
        let scene = Scene { colliders: &*solid.collider, ..Scene::EMPTY };
        let (flights, at_once) = (often(500_000), 1000);
        let mut escaped = (0, 0.0f64, String::new());
        for _ in (0..flights / at_once / 4).step_by(every(3)) {
            let fly = |_| {
                let position = if random.unit() < 0.3 { solid.middle } else { inside(&solid, &mut random) };
                let velocity = aim(&solid, &mut random, position) * (pace(&mut random, extent(&solid)) * 64.0);
                Particle { position, velocity, elasticity: 1.0, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..at_once).map(fly).collect();
            let mut system = started(&Scene { start: &start, ..scene }, at_once, 0);
            for step in 1..=4 {
                system.step(&scene, Time::from_ticks(1 << 26));
                for (row, &x) in system.particles().position.iter().enumerate() {
                    // On the surface within the rounding of its coordinates.
                    let out = -(solid.depth)(f64s(x));
                    if out > 2e-6 * f64::from(solid.size) {
                        let p = start[row];
                        let story = format!("step {step}: {:?} at {:?} came to {x:?}", p.position, p.velocity);
                        escaped = (escaped.0 + 1, escaped.1.max(out), story);
                    }
                }
            }
            assert_eq!(system.len(), at_once);
        }
        if escaped.0 > 0 {
            failures.push(format!(
                "{}: {} escaped, the farthest to {} m; the last: {}",
                solid.name, escaped.0, escaped.1, escaped.2
            ));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn nothing_gets_into_a_closed_surface_and_all_that_meets_it_turns() {
    let mut random = Random::new(22);
    let mut failures = vec![];
    for solid in solids() {
        let scene = Scene { colliders: &*solid.collider, ..Scene::EMPTY };
        let (flights, at_once) = (often(500_000), 1000);
        let mut wrong = (0, String::new());
        for _ in (0..flights / at_once).step_by(every(6)) {
            let fly = |_| {
                // Towards a point inside, half of them straight through a corner or an edge.
                let target = inside(&solid, &mut random);
                let corner = solid.corners[random.word() as usize % solid.corners.len()];
                let way = if random.unit() < 0.5 { random.direction() } else { (corner - target).normalize() };
                let position = target + way * (extent(&solid) * random.between(2.0, 3.0));
                let step = pace(&mut random, extent(&solid)).max(position.distance(target));
                Particle { position, velocity: -way * step * 64.0, elasticity: 1.0, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..at_once).map(fly).collect();
            let mut system = started(&Scene { start: &start, ..scene }, at_once, 0);
            for _ in 0..3 {
                system.step(&scene, Time::from_ticks(1 << 26));
                for (row, &x) in system.particles().position.iter().enumerate() {
                    let deep = (solid.depth)(f64s(x)) > 2e-6 * f64::from(solid.size);
                    if deep || system.particles().velocity[row] == start[row].velocity {
                        let p = start[row];
                        wrong = (wrong.0 + 1, format!("{:?} at {:?} came to {x:?}", p.position, p.velocity));
                    }
                }
            }
        }
        if wrong.0 > 0 {
            failures.push(format!("{}: {} went wrong, the last: {}", solid.name, wrong.0, wrong.1));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Gravity that turns, so that what rests must slide, along edges and into corners.
struct Tumbling(f32);

impl Force for Tumbling {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let t = state.time.seconds();
        let down = Vec3::new((0.9 * t).sin(), -(0.7 * t).cos(), (1.3 * t).sin()) * self.0;
        total.iter_mut().zip(&state.mass[rows]).for_each(|(total, &mass)| *total += down * mass);
    }
}

#[test]
fn nothing_seeps_out_of_a_closed_surface_that_tumbles() {
    let mut random = Random::new(29);
    let mut failures = vec![];
    for solid in solids() {
        let force = Tumbling(10.0 * extent(&solid));
        for method in [Method::Symplectic, Method::Verlet] {
            let rest = |i: usize| {
                let elasticity = (i % 4) as f32 * 0.3;
                Particle { position: inside(&solid, &mut random), elasticity, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..often(200)).map(rest).collect();
            let (colliders, integrator) = (&*solid.collider, method.integrator());
            let scene = Scene { start: &start, forces: &force, colliders, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            for i in 1..=often(1200) {
                system.step(&scene, Time::frame(i as u64, 60) - system.time());
            }
            let p = system.particles();
            let out = |x: &&Vec3| (solid.depth)(f64s(**x)) < -2e-6 * f64::from(solid.size);
            let lost: Vec<&Vec3> = p.position.iter().filter(out).collect();
            if let Some(last) = lost.last() {
                failures.push(format!(
                    "{}, {method}: {} of {} lost, one at {last}",
                    solid.name,
                    lost.len(),
                    start.len()
                ));
            }
            assert!(system.totals().hits > 10 * start.len() as u64);
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn nothing_passes_thin_walls() {
    // A millimetre thick (a disc: not at all), with steps of up to a thousand times that, under gravity, with every
    // elasticity: what rests on it must not seep through either.
    let slab = Cuboid { min: Vec3::new(-10.0, -0.001, -10.0), max: Vec3::new(10.0, 0.0, 10.0) };
    let disc = Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 15.0 };
    let (turn, shift) = (Mat3::from_rotation_x(0.3), Vec3::new(0.0, 1.0, 0.0));
    let turned = Placed::new(slab, Affine { linear: turn, shift }).expect("it is only turned");
    let tilted = Plane { point: Vec3::Y, normal: turn * Vec3::Y };
    let skew = Disc { center: Vec3::Y, normal: turn * Vec3::Y, radius: 15.0 };
    let corners = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];
    let vertices: Vec<Vec3> = corners.iter().map(|&(x, z)| turn * Vec3::new(x, 0.0, z) + shift).collect();
    let sheet = MeshBuf::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).expect("it is a mesh");
    let walls: [(&str, &dyn Collider, Plane); 7] = [
        ("slab", &slab, FLOOR),
        ("disc", &disc, FLOOR),
        ("plane", &FLOOR, FLOOR),
        ("turned slab", &turned, tilted),
        ("tilted plane", &tilted, tilted),
        ("skew disc", &skew, tilted),
        ("sheet of two triangles", &sheet, tilted),
    ];
    let mut random = Random::new(23);
    for (name, wall, plane) in walls {
        let height = |x: Vec3| -below(f64s(x), f64s(plane.point), f64s(plane.normal));
        for &method in Method::ALL {
            let fly = |i: usize| {
                // Some exactly above the diagonal of the sheet.
                let z = random.between(-2.0, 2.0);
                let x = if i.is_multiple_of(4) { z } else { random.between(-2.0, 2.0) };
                let y = plane.normal.z * -z / plane.normal.y + plane.point.y + random.magnitude(0.01, 1.0);
                let velocity = Vec3::new(random.between(-0.2, 0.2), -random.magnitude(0.01, 60.0), 0.0);
                Particle { position: Vec3::new(x, y, z), velocity, elasticity: (i % 5) as f32 / 4.0, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..200).map(fly).collect();
            let integrator = method.integrator();
            let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: wall, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, 200, 0);
            for i in 1..=often(300) {
                system.step(&scene, Time::frame(i as u64, 60) - system.time());
                for &x in system.particles().position {
                    // Within 8 m of the middle the wall goes on; at those coordinates rounding is 1e-6 m.
                    let lost = height(x) < -2e-6 && x.x.abs() < 8.0 && x.z.abs() < 8.0;
                    assert!(!lost, "{name}, {method}, step {i}: {x} is at {}", height(x));
                }
            }
        }
    }
}

#[test]
fn what_a_sink_takes_has_touched_it_and_nothing_passes() {
    let mut random = Random::new(24);
    for solid in solids() {
        let size = f64::from(solid.size);
        let gravity = Gravity { acceleration: Vec3::new(0.0, -2.0, 0.0) * extent(&solid) };
        let scene = Scene {
            forces: &gravity,
            sinks: &*solid.collider,
            integrator: Method::Verlet.integrator(),
            ..Scene::EMPTY
        };
        let mut memory = Heap::new(Size { particles: 1, ..scene.size() });
        let mut taken = 0;
        for _ in (0..often(5000)).step_by(every(3)) {
            let way = random.direction();
            let position = solid.middle + way * extent(&solid) * random.between(1.5, 3.0);
            if (solid.depth)(f64s(position)) > -0.1 * f64::from(extent(&solid)) {
                continue;
            }
            let aside = solid.middle + random.vector(1.2 * extent(&solid));
            let target = if random.unit() < 0.7 { inside(&solid, &mut random) } else { aside };
            let velocity = (target - position) * random.magnitude(0.2, 20.0);
            let start = [Particle { position, velocity, ..Particle::REST }];
            let scene = Scene { start: &start, ..scene };
            let mut system = System::with(&mut memory);
            system.start(&scene, 0).expect("there is room");
            let mut time = 0.0;
            while time < 1.0 && !system.is_empty() {
                system.step(&scene, Time::from_ticks(1 << 26));
                time += 1.0 / 64.0;
            }
            let (dead, caps) = (system.is_empty(), system.totals().caps.chords);
            assert_eq!(system.totals().died.sink, u64::from(dead));
            // The parabola it is on.
            let g = f64s(gravity.acceleration);
            let path = |t: f64| -> [f64; 3] {
                core::array::from_fn(|k| f64s(position)[k] + f64s(velocity)[k] * t + 0.5 * g[k] * t * t)
            };
            // Chords stray by 1e-4 m at the most, and rounding by 2e-6 of the coordinates.
            let tolerance = 1e-4 + 4e-6 * size;
            if dead {
                taken += 1;
                let last = memory.columns().position[0];
                let off = (solid.depth)(f64s(last)).abs();
                assert!(off < 4e-6 * size, "{}: taken {off} m from the surface", solid.name);
                let fine = |i: u32| gap(path(time - f64::from(i) / 64e3), f64s(last));
                let beside = (0..=1000).map(fine).fold(f64::INFINITY, f64::min);
                let speed = f64::from(velocity.length()) + gap(g, [0.0; 3]);
                assert!(beside < tolerance + speed / 64e3, "{}: {beside} m off its path", solid.name);
                time -= 1.0 / 64.0;
            }
            // Until the last step, or all the time if it lives, its path lay outside.
            let deepest = (0..=400).map(|i| (solid.depth)(path(time * f64::from(i) / 400.0))).fold(-1e9, f64::max);
            assert!(caps > 0 || deepest < tolerance, "{}: it was {deepest} m inside", solid.name);
        }
        assert!(taken > often(500) / every(3), "{}: {taken}", solid.name);
    }
}

#[test]
fn surfaces_take_what_crosses_them_too() {
    // Two open surfaces, a disc and a sheet, take exactly what crosses them, by where a line in f64 crosses.
    let disc = Disc { center: Vec3::new(0.2, 0.5, -0.1), normal: Vec3::new(1.0, 2.0, -3.0), radius: 1.0 };
    let plane = (f64s(disc.center), f64s(disc.normal));
    let mut random = Random::new(25);
    let scene = Scene { sinks: &disc, ..Scene::EMPTY };
    let (mut taken, mut spared) = (0, 0);
    for _ in 0..often(20_000) {
        let (position, velocity) = (random.vector(3.0), random.vector(8.0));
        let start = [Particle { position, velocity, ..Particle::REST }];
        let mut system = started(&Scene { start: &start, ..scene }, 1, 0);
        for _ in 0..8 {
            system.step(&scene, Time::from_ticks(1 << 29));
        }
        let end: [f64; 3] = core::array::from_fn(|k| f64s(position)[k] + f64s(velocity)[k]);
        let (a, b) = (below(f64s(position), plane.0, plane.1), below(end, plane.0, plane.1));
        let t = a / (a - b);
        let cross: [f64; 3] = core::array::from_fn(|k| f64s(position)[k] + f64s(velocity)[k] * t);
        let r = gap(cross, plane.0);
        let clear = (r - 1.0).abs() > 1e-5 && a.abs() > 1e-5 && b.abs() > 1e-5;
        if clear {
            let expected = a * b < 0.0 && r < 1.0;
            assert_eq!(system.is_empty(), expected, "{position} {velocity}");
            if expected { taken += 1 } else { spared += 1 }
        }
    }
    assert!(taken > often(500) && spared > often(500));
}
