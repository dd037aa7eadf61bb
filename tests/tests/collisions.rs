//! Collisions: mirrors, bouncing balls, and that nothing gets through anything.

use pointmass::shape::{
    Affine, Collider, Cone, Cuboid, Cylinder, Disc, MeshBuf, Placed, Plane, Segment, Sphere, Surface,
};
use pointmass::{Emitter, Gravity, Mat3, Method, Particle, Scene, System, Time, Varied, Vec3};
use pointmass_tests::{Form, G, Random, f64s, gap, icosahedron, often, run, started};

const FLOOR: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

/// A closed convex solid.
struct Solid {
    name: String,
    collider: Box<dyn Collider>,
    /// How deep a point lies inside \[m\], in double precision; below zero outside.
    depth: Box<dyn Fn([f64; 3]) -> f64>,
    /// Vertices, points of edges and rims, an apex.
    corners: Vec<Vec3>,
    middle: Vec3,
    /// The largest coordinate \[m\]: what rounding goes by.
    size: f32,
}

/// Depth below planes through `point` with outward `normal`.
fn below(x: [f64; 3], point: [f64; 3], normal: [f64; 3]) -> f64 {
    let length = gap(normal, [0.0; 3]);
    (0..3).map(|i| (point[i] - x[i]) * normal[i]).sum::<f64>() / length
}

fn depth_in_box(x: [f64; 3], b: Cuboid) -> f64 {
    let (min, max) = (f64s(b.min), f64s(b.max));
    (0..3).map(|i| (x[i] - min[i]).min(max[i] - x[i])).fold(f64::INFINITY, f64::min)
}

/// Points on the edges of a box, its vertices among them.
fn edges_of(b: Cuboid) -> Vec<Vec3> {
    let mut points = vec![];
    for i in 0..5 {
        for j in 0..5 {
            for k in 0..5 {
                let ends = [i, j, k].iter().filter(|&&n| n % 4 == 0).count();
                if ends >= 2 {
                    points.push(b.min + (b.max - b.min) * Vec3::new(i as f32, j as f32, k as f32) / 4.0);
                }
            }
        }
    }
    points
}

/// Points on a circle about the y axis.
fn rim(center: Vec3, radius: f32) -> impl Iterator<Item = Vec3> {
    (0..24).map(move |i| center + Vec3::new((i as f32 * 0.2618).cos(), 0.0, (i as f32 * 0.2618).sin()) * radius)
}

fn mesh(map: impl Fn(Vec3) -> Vec3, name: &str) -> Solid {
    let (vertices, triangles) = icosahedron();
    let vertices: Vec<Vec3> = vertices.into_iter().map(map).collect();
    let faces: Vec<_> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| vertices[i as usize]);
            let ([_, e, f], a) = ([a, b - a, c - a].map(f64s), f64s(a));
            (a, core::array::from_fn(|i| e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3]))
        })
        .collect();
    let mut corners = vertices.clone();
    for t in &triangles {
        let [a, b, c] = t.map(|i| vertices[i as usize]);
        corners.extend([a.midpoint(b), b.lerp(c, 0.3), c.lerp(a, 0.9)]);
    }
    let middle = vertices.iter().sum::<Vec3>() / 12.0;
    let size = vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f32::max);
    let collider = MeshBuf::new(vertices, triangles).expect("an icosahedron is a mesh");
    Solid {
        name: name.to_owned(),
        collider: Box::new(collider),
        depth: Box::new(move |x| faces.iter().map(|&(p, n)| below(x, p, n)).fold(f64::INFINITY, f64::min)),
        corners,
        middle,
        size,
    }
}

fn cuboid(b: Cuboid, name: &str) -> Solid {
    Solid {
        name: name.to_owned(),
        collider: Box::new(b),
        depth: Box::new(move |x| depth_in_box(x, b)),
        corners: edges_of(b),
        middle: (b.min + b.max) * 0.5,
        size: b.min.abs().max(b.max.abs()).max_element(),
    }
}

fn placed(linear: Mat3, shift: Vec3, name: &str) -> Solid {
    let b = Cuboid { min: Vec3::new(-0.5, -0.7, -0.3), max: Vec3::new(0.5, 0.4, 0.6) };
    let map = Affine { linear, shift };
    // In double precision: the world's faces, each through the image of a corner, along the rows of the inverse.
    let back = map.inverse().expect("it does not flatten").linear.transpose();
    let [low, high] = [b.min, b.max].map(|corner| f64s(map.point(corner)));
    let normals = [back.x_axis, back.y_axis, back.z_axis].map(f64s);
    let corners: Vec<Vec3> = edges_of(b).into_iter().map(|p| map.point(p)).collect();
    Solid {
        name: name.to_owned(),
        collider: Box::new(Placed::new(b, map).expect("it does not flatten")),
        depth: Box::new(move |x| {
            let walls = normals.iter().map(|n| below(x, high, *n).min(below(x, low, n.map(|n| -n))));
            walls.fold(f64::INFINITY, f64::min)
        }),
        size: corners.iter().map(|v| v.abs().max_element()).fold(0.0, f32::max),
        corners,
        middle: map.point((b.min + b.max) * 0.5),
    }
}

fn solids() -> Vec<Solid> {
    let center = Vec3::new(0.3, -0.2, 0.5);
    let c = f64s(center);
    let about = move |x: [f64; 3]| ((x[0] - c[0]).hypot(x[2] - c[2]), x[1] - c[1]);
    let sphere = Sphere { center, radius: 0.75 };
    let cylinder = Cylinder { center, radius: 0.5, height: 1.5 };
    let cone = Cone { center, radius: 0.75, height: 1.25 };
    let turn = Mat3::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
    let shear = Mat3::from_cols(Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.8, 1.0, 0.1), Vec3::new(-0.3, 0.4, 0.7));
    let flat = Mat3::from_diagonal(Vec3::new(3.0, 0.05, 0.3));
    vec![
        Solid {
            name: "sphere".into(),
            collider: Box::new(sphere),
            depth: Box::new(move |x| 0.75 - gap(x, c)),
            corners: rim(center, 0.75).collect(),
            middle: center,
            size: 1.25,
        },
        Solid {
            name: "cylinder".into(),
            collider: Box::new(cylinder),
            depth: Box::new(move |x| (0.5 - about(x).0).min(0.75 - about(x).1.abs())),
            corners: rim(center + Vec3::Y * 0.75, 0.5).chain(rim(center - Vec3::Y * 0.75, 0.5)).collect(),
            middle: center,
            size: 1.0,
        },
        Solid {
            name: "cone".into(),
            collider: Box::new(cone),
            depth: Box::new(move |x| {
                let (r, y) = about(x);
                ((0.75 * (0.625 - y) - 1.25 * r) / 0.75f64.hypot(1.25)).min(y + 0.625)
            }),
            corners: rim(center - Vec3::Y * 0.625, 0.75).chain([center + Vec3::Y * 0.625; 24]).collect(),
            middle: center - Vec3::Y * 0.2,
            size: 1.25,
        },
        cuboid(Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.2) }, "box"),
        cuboid(Cuboid { min: Vec3::splat(1000.0), max: Vec3::new(1001.0, 1002.0, 1000.5) }, "distant box"),
        mesh(|v| v, "icosahedron"),
        mesh(|v| Vec3::new(0.3 * v.x + 0.5, v.y - 0.4 * v.x, 2.0 * v.z + 30.0), "squashed icosahedron"),
        placed(turn, center, "turned box"),
        placed(shear, center, "sheared box"),
        placed(shear * flat * turn, Vec3::new(5.0, -3.0, 2.0), "flattened, turned and sheared box"),
        placed(turn * 100.0, Vec3::ZERO, "large turned box"),
        placed(shear * 0.01, Vec3::ZERO, "small sheared box"),
    ]
}

/// Steps of this many metres a frame, from crawling to crossing many times over.
fn pace(random: &mut Random, size: f32) -> f32 {
    random.magnitude(1e-5, 30.0) * size
}

/// A point inside, by trial.
fn inside(solid: &Solid, random: &mut Random) -> Vec3 {
    loop {
        let corner = solid.corners[random.word() as usize % solid.corners.len()];
        let other = solid.corners[random.word() as usize % solid.corners.len()];
        let point = solid.middle.lerp(corner.lerp(other, random.unit()), random.unit() * 0.999);
        if (solid.depth)(f64s(point)) > 1e-4 * f64::from(extent(solid)) {
            return point;
        }
    }
}

/// How large it is \[m\], wherever it lies.
fn extent(solid: &Solid) -> f32 {
    solid.corners.iter().map(|&c| c.distance(solid.middle)).fold(0.0, f32::max)
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
        let (flights, at_once) = (often(100_000), 1000);
        let mut escaped = (0, 0.0f64, String::new());
        for _ in 0..flights / at_once / 4 {
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
        let (flights, at_once) = (often(100_000), 1000);
        let mut wrong = (0, String::new());
        for _ in 0..flights / at_once {
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
                let x = if i % 4 == 0 { z } else { random.between(-2.0, 2.0) };
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
            if i % 100 > 0 {
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
                // The path is followed along chords below it that stray by 1e-4 m at the most, so that every impact may
                // come so much too high: with 0.64 of what was before, 2.8e-4 m in all, and 2.8e-4 m / √(2 g apex) of
                // the time of flight.
                apex *= 0.64;
                let height = up * up / (2.0 * G);
                assert!((at - impact).abs() < 2e-3, "{method}: impact {bounces} at {at}, not {impact}");
                assert!((height - apex).abs() < 2.8e-4, "{method}: apex {bounces} at {height}, not {apex}");
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
    let cases: [(&str, &dyn Collider, Vec3, Vec3); 11] = [
        ("sphere", &sphere, Vec3::X * 3.0, Vec3::X),
        ("sphere", &sphere, Vec3::new(1.0, 0.0, -2.0), Vec3::NEG_Z),
        ("box", &cuboid, Vec3::new(1.0, 0.25, 0.5), Vec3::X),
        ("corner of a box", &cuboid, Vec3::ONE, Vec3::ONE),
        ("cylinder", &cylinder, Vec3::new(1.0, 0.5, 0.0), Vec3::X),
        ("cap", &cylinder, Vec3::new(0.25, -1.0, 0.0), Vec3::NEG_Y),
        ("base", &cone, Vec3::new(0.25, -1.0, 0.0), Vec3::NEG_Y),
        ("apex", &cone, Vec3::Y, Vec3::Y),
        ("disc", &disc, Vec3::X * 0.5, Vec3::Y),
        ("disc from below", &disc, Vec3::X * 0.5, Vec3::NEG_Y),
        ("plane", &FLOOR, Vec3::ZERO, Vec3::NEG_Y),
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
fn births_on_a_surface_do_not_hit_it_as_they_leave() {
    let center = Vec3::new(0.3, 0.1, -0.7);
    let shapes = [
        ("sphere", Form::Sphere(Sphere { center, radius: 0.7 })),
        ("box", Form::Box(Cuboid { min: Vec3::splat(0.1), max: Vec3::splat(0.7) })),
        ("cylinder", Form::Cylinder(Cylinder { center, radius: 0.7, height: 0.9 })),
        ("cone", Form::Cone(Cone { center, radius: 0.7, height: 0.9 })),
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
        let mut memory = pointmass::Heap::new(pointmass::Size { particles: 1, ..scene.size() });
        let mut taken = 0;
        for _ in 0..often(5000) {
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
                let last = pointmass::Storage::columns(&memory).position[0];
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
        assert!(taken > often(1500), "{}: {taken}", solid.name);
    }
}

#[test]
fn surfaces_take_what_crosses_them_too() {
    // Of open surfaces: a disc and a sheet take exactly what crosses them, by where a line in f64 crosses.
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
    let scene = Scene { start: &start, colliders: &wedge, ..Scene::EMPTY };
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
fn a_hit_turns_the_normal_speed_alone() {
    let mut random = Random::new(27);
    for solid in solids().into_iter().take(6) {
        for _ in 0..often(2000) {
            let elasticity = random.unit();
            let target = inside(&solid, &mut random);
            let way = random.direction();
            let position = target + way * 3.0 * extent(&solid);
            let velocity = -way * 4.0 * extent(&solid);
            let Some(hit) = solid.collider.first_hit(&Segment { from: position, to: position + velocity }) else {
                panic!("{}: {position} misses {target}", solid.name)
            };
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
            // And on it goes for the time that is left. It is set off by a few slacks of at most 2e-6 of the size; a
            // normal's rounding counts as far as it goes.
            let place = position + velocity * hit.time + expected * (1.0 - hit.time);
            let off = (p.position[0] - place).length();
            assert!(off < 2e-5 * (solid.size + velocity.length()), "{}: {off}", solid.name);
        }
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
