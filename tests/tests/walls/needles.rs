//! Closed meshes with needles: nothing gets in, and hits lie on the surface within their slack.

use pointmass::rays::Structure;
use pointmass::shape::{Collider, MeshBuf, Segment, Triangle};
use pointmass::{Gravity, Heap, Method, Particle, Scene, Size, System, Time, Vec3};
use pointmass_tests::needles::{Closed, closed};
use pointmass_tests::surfaces::to_triangle;
use pointmass_tests::{Random, f64s};
use robust::{Coord3D, orient3d};

/// The number of flights that a mesh sees at once.
const FLEET: usize = 250;

fn coord(v: Vec3) -> Coord3D<f64> {
    let [x, y, z] = f64s(v);
    Coord3D { x, y, z }
}

/// Tells whether a point lies inside, by how often a way out crosses the surface, without any rounding; nothing, if it
/// lies on the surface.
fn is_inside(mesh: &Closed, point: Vec3, random: &mut Random) -> Option<bool> {
    let (low, high) = bounds(mesh);
    if point.cmplt(low).any() || point.cmpgt(high).any() {
        return Some(false);
    }
    'way: loop {
        let out = (low + high) * 0.5 + random.direction() * ((high - low).length() * 3.0 + mesh.size);
        let [from, to] = [point, out].map(coord);
        let mut crossed = false;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| coord(mesh.vertices[i as usize]));
            let (before, after) = (orient3d(a, b, c, from), orient3d(a, b, c, to));
            // Corners that rounding has brought onto a line enclose nothing.
            if before * after > 0.0 || (before == 0.0 && after == 0.0) {
                continue;
            }
            let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| orient3d(from, to, p, q));
            if edges.iter().any(|&e| e > 0.0) && edges.iter().any(|&e| e < 0.0) {
                continue;
            }
            if before == 0.0 {
                return None;
            }
            if edges.contains(&0.0) {
                continue 'way;
            }
            crossed = !crossed;
        }
        return Some(crossed);
    }
}

fn bounds(mesh: &Closed) -> (Vec3, Vec3) {
    let ends = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    mesh.vertices.iter().fold(ends, |(low, high), &v| (low.min(v), high.max(v)))
}

/// A place at a corner, on an edge or in a face, on it or beside it.
fn aim(mesh: &Closed, random: &mut Random) -> Vec3 {
    let t = mesh.triangles[random.word() as usize % mesh.triangles.len()].map(|i| mesh.vertices[i as usize]);
    let target = match random.word() % 4 {
        0 => t[0],
        1 => t[0].lerp(t[1], random.unit()),
        2 => t[0].lerp(t[1], random.unit()).lerp(t[2], random.magnitude(1e-6, 1.0)),
        _ => t[2].lerp(t[0].lerp(t[1], random.unit()), random.magnitude(1e-6, 1.0)),
    };
    target + random.vector(1.0) * (mesh.ulp * [0.0, 1.0, 20.0][random.word() as usize % 3])
}

/// From outside toward a place of the surface, to end before it, at it, or anywhere behind it, at once or by and by.
fn flight(mesh: &Closed, random: &mut Random) -> Particle {
    loop {
        let (target, way) = (aim(mesh, random), random.direction());
        let from = target - way * (mesh.size * random.magnitude(1e-4, 10.0));
        let over = match random.word() % 3 {
            0 => 0.0,
            1 => mesh.ulp * random.between(-20.0, 40.0),
            _ => mesh.size * random.magnitude(1e-5, 10.0),
        };
        let steps = [64.0, 64.0, 30.0, 1e4][random.word() as usize % 4];
        let velocity = (target + way * over - from) * steps;
        let radius = if random.unit() < 0.7 { 0.0 } else { mesh.size * random.magnitude(1e-5, 0.1) };
        // A flight that begins on the surface may leave it to the side of the normal, wherever that points.
        if is_inside(mesh, from, random) == Some(false) {
            return Particle { position: from, velocity, radius, elasticity: random.unit(), ..Particle::REST };
        }
    }
}

/// Sends flights at meshes; returns how many of them ever came to be inside, and how many hits there were.
fn storm(flights: usize, seed: u64) -> (usize, u64) {
    let mut random = Random::new(seed);
    let (mut inside, mut hits) = (0, 0);
    for i in 0..flights / FLEET {
        let closed = closed(&mut random);
        let structure = Structure::ALL[i % Structure::ALL.len()];
        let mesh = MeshBuf::new(closed.vertices.clone(), closed.triangles.clone()).expect("it is a mesh");
        let mesh = mesh.indexed(structure);
        let start: Vec<Particle> = (0..FLEET).map(|_| flight(&closed, &mut random)).collect();
        let gravity = Gravity { acceleration: random.vector(closed.size * 10.0) };
        let integrator = Method::ALL[random.word() as usize % Method::ALL.len()].integrator();
        let scene = Scene { start: &start, forces: &gravity, colliders: &mesh, integrator, ..Scene::EMPTY };
        let mut memory = Heap::new(Size { particles: FLEET, ..scene.size() });
        let mut system = System::with(&mut memory);
        system.start(&scene, 0).expect("the memory is made for the scene");
        for step in 1..=4 {
            system.step(&scene, Time::from_ticks(1 << 26));
            for (row, &x) in system.particles().position.iter().enumerate() {
                if is_inside(&closed, x, &mut random) == Some(true) {
                    inside += 1;
                    println!("{} of {} m, {structure}, step {step}: {:?} at {x}", closed.name, closed.size, start[row]);
                    break;
                }
            }
        }
        hits += system.totals().hits;
    }
    (inside, hits)
}

#[test]
fn nothing_gets_into_meshes_with_needles() {
    let (inside, hits) = storm(if cfg!(debug_assertions) { 5_000 } else { 50_000 }, 81);
    assert_eq!(inside, 0);
    assert!(hits > 3_000, "{hits}");
}

#[test]
#[ignore = "long: a million flights, in release"]
fn nothing_of_a_million_gets_into_meshes_with_needles() {
    let (inside, hits) = storm(1_000_000, 82);
    assert_eq!(inside, 0);
    assert!(hits > 600_000, "{hits}");
}

#[test]
fn hits_on_needles_lie_on_the_surface_within_their_slack_whatever_the_order_of_corners() {
    let mut random = Random::new(83);
    let (mut met, mut worst) = (0, 0.0f64);
    for _ in 0..400 {
        let closed = closed(&mut random);
        let turned = |by: usize| {
            let turn = |t: &[u32; 3]| core::array::from_fn(|i| t[(i + by) % 3]);
            let triangles = closed.triangles.iter().map(turn).collect();
            MeshBuf::new(closed.vertices.clone(), triangles).expect("it is a mesh")
        };
        let meshes = [0, 1, 2].map(turned);
        for _ in 0..100 {
            let Particle { position, velocity, .. } = flight(&closed, &mut random);
            let segment = Segment::new(position, position + velocity / 30.0);
            let hits = meshes.each_ref().map(|mesh| mesh.first_hit(&segment));
            assert_eq!(hits[0].is_some(), hits[1].is_some());
            assert_eq!(hits[0].is_some(), hits[2].is_some());
            for hit in hits.into_iter().flatten() {
                let t = closed.triangles[hit.face as usize].map(|i| f64s(closed.vertices[i as usize]));
                let off = to_triangle(f64s(segment.at(hit.time)), t);
                met += 1;
                worst = worst.max(off / f64::from(hit.slack));
                assert!(off <= f64::from(hit.slack), "{off} of {} at {segment:?}, {t:?}", hit.slack);
            }
        }
    }
    println!("{met} hits, at worst {worst} of their slack");
    assert!(met > 30_000, "{met}");
}

/// Tells whether a path meets a triangle, without any rounding.
fn is_met(corners: [Vec3; 3], segment: &Segment) -> bool {
    let ([a, b, c], [from, to]) = (corners.map(coord), [segment.from, segment.to].map(coord));
    // Shewchuk's sign is that of what lies below.
    let (before, after) = (-orient3d(a, b, c, from), -orient3d(a, b, c, to));
    let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| orient3d(from, to, p, q));
    let passes = edges.iter().all(|&e| e >= 0.0) || edges.iter().all(|&e| e <= 0.0);
    passes && ((before >= 0.0 && after <= 0.0 && before != after) || (before < 0.0 && after >= 0.0))
}

#[test]
fn a_triangle_is_hit_exactly_where_a_path_meets_it() {
    let (mut random, mut met) = (Random::new(84), 0);
    for _ in 0..400 {
        let closed = closed(&mut random);
        for _ in 0..100 {
            let Particle { position, velocity, .. } = flight(&closed, &mut random);
            let segment = Segment::new(position, position + velocity / 64.0);
            for t in &closed.triangles {
                let corners = t.map(|i| closed.vertices[i as usize]);
                let hit = Triangle { corners }.first_hit(&segment);
                let expected = is_met(corners, &segment);
                assert_eq!(hit.is_some(), expected, "{corners:?} {segment:?} {hit:?}");
                met += u32::from(expected);
            }
        }
    }
    assert!(met > 10_000, "{met}");
}
