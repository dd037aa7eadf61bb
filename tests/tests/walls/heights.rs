//! Height fields: as the mesh of their triangles, but faster.

use pointmass::shape::{BadHeights, Collider, HeightField, MeshBuf, Segment, Surface};
use pointmass::{Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, often, run, started};

const COLUMNS: usize = 17;
const ROWS: usize = 12;

/// Hills, and a few cliffs.
fn hills(random: &mut Random) -> Vec<f32> {
    (0..COLUMNS * ROWS)
        .map(|k| {
            let (i, j) = ((k % COLUMNS) as f32, (k / COLUMNS) as f32);
            (i * 0.7).sin() * (j * 0.5).cos() + if random.unit() < 0.1 { 2.0 } else { 0.2 * random.unit() }
        })
        .collect()
}

fn mesh(field: &HeightField<'_>) -> MeshBuf {
    let [columns, rows] = field.size();
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for j in 0..rows - 1 {
        for i in 0..columns - 1 {
            for triangle in field.triangles(i, j) {
                let first = vertices.len() as u32;
                vertices.extend(triangle.corners);
                triangles.push([first, first + 1, first + 2]);
            }
        }
    }
    MeshBuf::new(vertices, triangles).expect("all of it is finite")
}

/// A place around the field.
fn place(random: &mut Random, field: &HeightField<'_>) -> Vec3 {
    let size = field.bounds().max - field.bounds().min;
    field.bounds().center() + size * 1.3 * random.vector(0.5) + random.vector(1.0)
}

#[test]
fn a_height_field_is_the_mesh_of_its_triangles() {
    let mut random = Random::new(111);
    let heights = hills(&mut random);
    for (origin, spacing) in [(Vec3::new(-4.0, 0.5, -3.0), 0.5), (Vec3::new(100.0, -20.0, 7.0), 3.0)] {
        let field = HeightField::new(origin, spacing, COLUMNS, &heights).expect("it is full and finite");
        let mesh = mesh(&field);
        assert_eq!(field.bounds(), mesh.bounds());
        assert!((field.area() / mesh.area() - 1.0).abs() < 1e-5);
        let mut hits = 0;
        for i in 0..often(20_000) {
            let (from, mut to) = (place(&mut random, &field), place(&mut random, &field));
            if i % 3 == 0 {
                // At a vertex, or straight down.
                let at = field.vertex(random.word() as usize % COLUMNS, random.word() as usize % ROWS);
                to = at + (at - from) * random.unit();
            } else if i % 17 == 0 {
                to = Vec3::new(from.x, -100.0, from.z);
            }
            let radius = if random.unit() < 0.5 { 0.0 } else { spacing * random.magnitude(1e-2, 1.0) };
            let segment = Segment { radius, ..Segment::new(from, to) };
            let (a, b) = (field.first_hit(&segment), mesh.first_hit(&segment));
            assert_eq!(a, b, "{segment:?}");
            hits += usize::from(a.is_some());
            if i % 10 == 0 {
                let (a, b) = (field.nearest(from) - from, mesh.nearest(from) - from);
                assert_eq!(a.length(), b.length(), "{from}");
                let mut nearest = f32::INFINITY;
                field.contacts(from, spacing, Time::ZERO, &mut |contact| nearest = nearest.min(contact.distance));
                let expected = if a.length() <= spacing { a.length() } else { f32::INFINITY };
                assert!(nearest == expected || (nearest - expected).abs() < 1e-5 * (1.0 + from.length()), "{from}");
            }
        }
        assert!(hits > often(3000), "{hits}");
    }
}

#[test]
fn births_on_a_height_field_are_even_by_area() {
    // A steep cell among flat ones: its share is that of its area.
    let heights = [0.0, 0.0, 5.0, 0.0, 0.0, 5.0];
    let field = HeightField::new(Vec3::ZERO, 1.0, 3, &heights).expect("it is full and finite");
    let mut random = Random::new(112);
    let n = often(100_000);
    let steep = (0..n)
        .filter(|_| {
            let spot = field.sample([random.unit(), random.unit(), random.unit()]);
            assert!((field.nearest(spot.point) - spot.point).length() < 1e-5);
            spot.point.x > 1.0
        })
        .count();
    let share = 26f64.sqrt() / (1.0 + 26f64.sqrt());
    let off = steep as f64 / n as f64 - share;
    assert!(off.abs() < 4.0 * (share * (1.0 - share) / n as f64).sqrt(), "{off}");
}

#[test]
fn nothing_falls_through_the_ground() {
    let mut random = Random::new(113);
    let heights = hills(&mut random);
    let field = HeightField::new(Vec3::new(-4.0, 0.0, -3.0), 0.5, COLUMNS, &heights).expect("it is full and finite");
    let start: Vec<Particle> = (0..often(20_000))
        .map(|i| {
            let radius = if i % 2 == 0 { 0.0 } else { random.magnitude(1e-3, 0.1) };
            // Over a vertex, an edge or anywhere.
            let (u, v) = (random.between(-3.5, 3.5), random.between(-2.5, 2.0));
            let snap = |x: f32| (x * 2.0).round() / 2.0;
            let (x, z) = (if i % 3 == 0 { snap(u) } else { u }, if i % 5 < 2 { snap(v) } else { v });
            let velocity = Vec3::NEG_Y * random.magnitude(1.0, 1e4);
            let position = Vec3::new(x, 5.0, z);
            Particle { position, velocity, radius, elasticity: random.unit() * 0.01, ..Particle::REST }
        })
        .collect();
    let scene = Scene { start: &start, colliders: &field, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, 1);
    let p = system.particles();
    for (row, particle) in start.iter().enumerate() {
        let (end, fell) = (p.position[row], p.velocity[row]);
        if fell == particle.velocity {
            assert!(end.y > -1.2, "{particle:?} is at {end}");
        }
        // Above its own place still, which a line straight down finds from there.
        let down = Segment::new(end + Vec3::Y * 1e-4, Vec3::new(end.x, -100.0, end.z));
        let is_over = field.first_hit(&down).is_some();
        let beside = end.x.abs() > 3.99 || end.z < -2.99 || end.z > 2.49;
        assert!(is_over || beside, "{particle:?} is at {end} with {fell}");
    }
}

#[test]
fn bad_heights_are_refused() {
    let bad = |columns, heights: &[f32], spacing| HeightField::new(Vec3::ZERO, spacing, columns, heights).err();
    assert_eq!(bad(2, &[0.0; 4], 1.0), None);
    for (columns, n) in [(0, 4), (1, 4), (2, 5), (4, 4), (2, 0)] {
        assert_eq!(bad(columns, &vec![0.0; n], 1.0), Some(BadHeights::Grid));
    }
    assert_eq!(bad(2, &[0.0, 0.0, f32::NAN, 0.0], 1.0), Some(BadHeights::Height { index: 2 }));
    for spacing in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(bad(2, &[0.0; 4], spacing), Some(BadHeights::Spacing));
    }
}

#[test]
fn cells_beyond_a_field_are_level_at_zero() {
    let heights = [0.5; 9];
    let field = HeightField::new(Vec3::Y, 2.0, 3, &heights).expect("it is sound");
    for far in [3, usize::MAX] {
        let [column, row] = [far as f32 * 2.0; 2];
        assert_eq!(field.vertex(far, far), Vec3::new(column, 1.0, row));
        let corners = field.triangles(far, far).map(|triangle| triangle.corners);
        assert!(corners.as_flattened().iter().all(|corner| corner.y == 1.0), "{corners:?}");
    }
}
