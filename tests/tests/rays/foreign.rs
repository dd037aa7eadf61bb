//! Pieces that are no triangles: an outsider's own, and a list of solids; and what is counted.

use super::meshes;
use super::same::{bits, built, segment};
use pointmass::Vec3;
use pointmass::rays::{Cost, Index, Pieces, Solids, Structure, UnknownStructure};
use pointmass::shape::{Aabb, Collider, Cuboid, Hit, Mesh, Plane, Segment, Shape, Sphere};
use pointmass_tests::{Random, often};

/// Balls that are hit from outside only, by a formula of one's own. Those without a place have no box.
struct Balls(Vec<(Vec3, f32)>);

impl Pieces for Balls {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn box_of(&self, piece: usize) -> Aabb {
        let (center, radius) = self.0[piece];
        Aabb { min: center - radius, max: center + radius }
    }

    fn hit(&self, piece: usize, segment: &Segment) -> Option<Hit> {
        let (center, radius) = self.0[piece];
        let (offset, step) = (segment.from - center, segment.step());
        let (a, b, c) = (step.dot(step), offset.dot(step), offset.dot(offset) - radius * radius);
        let root = b * b - a * c;
        let time = (-b - root.sqrt()) / a;
        let hits = root > 0.0 && (0.0..=1.0).contains(&time);
        hits.then(|| Hit { face: piece as u32, ..Hit::new(time, (offset + step * time) / radius, 0.0) })
    }
}

fn words<P: Pieces>(structure: Structure, pieces: &P) -> Vec<u32> {
    let mut memory = vec![0; structure.words(pieces.count())];
    structure.build(pieces, &mut memory).expect("there is room").words().to_vec()
}

#[test]
fn pieces_of_ones_own_are_found() {
    let mut random = Random::new(5);
    let ball = |i: usize| match i % 50 {
        0 => (Vec3::splat(f32::NAN), 0.1),
        1 => (Vec3::INFINITY, 0.1),
        _ => (random.vector(1.0), random.magnitude(1e-3, 0.2)),
    };
    let balls = Balls((0..1000).map(ball).collect());
    let all: Vec<_> = Structure::ALL.iter().map(|structure| words(*structure, &balls)).collect();
    let mut hits = 0;
    for _ in 0..often(5000) {
        let from = random.vector(1.5);
        let path = Segment::new(from, from + random.vector(0.5));
        let expected = Index::BRUTE.first_hit(&balls, &path);
        hits += usize::from(expected.is_some());
        for words in &all {
            let index = Index::new(words).expect("sound");
            assert_eq!(bits(index.first_hit(&balls, &path)), bits(expected), "{}", index.structure());
            assert_eq!(index.stats().skipped, 40);
        }
    }
    assert!(hits > often(500));
}

#[test]
fn a_list_of_solids_is_hit_as_the_list_is() {
    let mut random = Random::new(6);
    let solid = |i: usize| -> Shape<Mesh<'static>> {
        let at = random.vector(1.0);
        match i % 20 {
            0 => Shape::Plane(Plane { point: Vec3::Y * -2.0, normal: Vec3::Y }),
            1..10 => Shape::Sphere(Sphere { center: at, radius: random.magnitude(0.01, 0.2) }),
            _ => Shape::Box(Cuboid { min: at, max: at + Vec3::splat(random.magnitude(0.01, 0.2)) }),
        }
    };
    let list: Vec<_> = (0..200).map(solid).collect();
    let pieces = Solids(&list);
    let all: Vec<_> = Structure::ALL.iter().map(|structure| words(*structure, &pieces)).collect();
    let mut hits = 0;
    for i in 0..often(2000) {
        let from = random.vector(2.5);
        let radius = if i % 3 == 0 { 0.05 } else { 0.0 };
        let path = Segment { radius, ..Segment::new(from, from + random.vector(2.0)) };
        let (listed, brute) = (list.first_hit(&path), Index::BRUTE.first_hit(&pieces, &path));
        assert_eq!(listed.is_some(), brute.is_some());
        if let (Some(listed), Some(brute)) = (listed, brute) {
            hits += 1;
            assert!((listed.time - brute.time).abs() < 1e-5);
        }
        for words in &all {
            let index = Index::new(words).expect("sound");
            assert_eq!(bits(index.first_hit(&pieces, &path)), bits(brute), "{}", index.structure());
        }
    }
    assert!(hits > often(300));
}

#[test]
fn structures_look_at_little_and_say_so() {
    let mesh = meshes::sphere(40, 0.1);
    let (view, n) = (mesh.view(), mesh.triangles().len());
    let mut random = Random::new(4);
    let paths: Vec<Segment> = (0..often(1000)).map(|i| segment(&mesh, &mut random, 10 * i + 1)).collect();
    for &structure in Structure::ALL {
        let words = built(structure, &view, structure.words(n));
        let index = Index::new(&words).expect("sound");
        let stats = index.stats();
        assert_eq!((index.structure(), stats.pieces, stats.skipped, stats.crowded), (structure, n, 0, 0));
        assert_eq!(stats.bytes, 4 * words.len());
        assert!(stats.references >= n && stats.fullest > 0);
        let (mut cost, mut asked) = (Cost::default(), 0);
        for path in &paths {
            let (hit, took) = index.first_hit_counted(&view, path);
            assert_eq!(hit, index.first_hit(&view, path));
            cost += took;
            // A piece out of the way is not asked; one in several cells perhaps several times.
            let bounds = path.bounds();
            asked += (0..n).filter(|&piece| view.box_of(piece).overlaps(&bounds)).count() as u64;
        }
        let most = if structure == Structure::Grid { 12 } else { 3 };
        assert!(cost.tests > 0 && cost.tests <= most * asked, "{structure}: {cost:?}, {asked}");
        if structure != Structure::Brute {
            assert!(stats.nodes > 50 && (structure == Structure::Grid || stats.depth > 1), "{stats:?}");
            assert!(cost.visits > 0 && cost.visits < 80 * paths.len() as u64, "{structure}: {cost:?}");
        }
    }
}

#[test]
fn names_lead_to_structures() {
    for structure in Structure::ALL {
        assert_eq!(structure.to_string().parse(), Ok(*structure));
    }
    assert_eq!("hash".parse::<Structure>(), Err(UnknownStructure));
    assert_eq!(UnknownStructure.to_string(), "unknown structure; there are brute grid octree kd bsp bvh");
}
