//! The same answers from all.

use super::meshes;
use core::ops::ControlFlow;
use pointmass::Time;
use pointmass::Vec3;
use pointmass::rays::{Index, Structure, Visitor};
use pointmass::shape::{Aabb, Collider, Contact, Hit, Mesh, MeshBuf, Segment, Surface};
use pointmass_tests::{Random, often};

/// A segment of one of many kinds at a mesh.
pub(crate) fn segment(mesh: &MeshBuf, random: &mut Random, i: usize) -> Segment {
    let bounds = mesh.bounds();
    let size = if mesh.triangles().is_empty() { 1.0 } else { 2.0 * bounds.radius() };
    let corner = |random: &mut Random| match mesh.triangles() {
        [] => Vec3::ZERO,
        all => {
            let triangle = all[random.word() as usize % all.len()];
            mesh.vertices()[triangle[random.word() as usize % 3] as usize]
        }
    };
    let on = |random: &mut Random| {
        let [a, b] = [corner(random), corner(random)];
        a + (b - a) * random.unit()
    };
    let surface = |random: &mut Random| mesh.sample([random.unit(), random.unit(), random.unit()]).point;
    let axis = |random: &mut Random| {
        let sign = if random.unit() < 0.5 { 1.0 } else { -1.0 };
        Vec3::AXES[random.word() as usize % 3] * sign
    };
    let way = random.direction() * size * random.magnitude(1e-3, 3.0);
    let (from, to) = match i % 10 {
        // Long and short, from anywhere.
        0 => (bounds.center() + random.direction() * size, bounds.center() + random.vector(size)),
        1 | 2 => {
            let from = surface(random) + random.vector(0.02 * size);
            (from, from + random.vector(0.02 * size))
        }
        // Parallel to an axis, through corners, from corners, along edges.
        3 => {
            let (at, way) = (surface(random), axis(random) * size * random.unit());
            (at - way, at + way)
        }
        4 => {
            let (at, way) = (corner(random), axis(random) * size);
            (at - way, at + way)
        }
        5 => {
            let at = corner(random);
            (at - way, at + way)
        }
        6 => (on(random), on(random)),
        7 => (corner(random), corner(random)),
        // From the surface, and to it.
        8 => {
            let at = surface(random);
            (at, at + way)
        }
        _ => {
            let at = surface(random);
            (at + way, at)
        }
    };
    let radius = if i % 30 < 10 { random.magnitude(1e-4, 0.1) * size } else { 0.0 };
    Segment { radius, ..Segment::new(from, to) }
}

pub(crate) fn bits(hit: Option<Hit>) -> Option<[u32; 6]> {
    hit.map(|hit| {
        let [x, y, z] = hit.normal.to_array().map(f32::to_bits);
        [hit.time.to_bits(), x, y, z, hit.slack.to_bits(), hit.face]
    })
}

/// The words of a structure of a mesh.
pub(crate) fn built(structure: Structure, mesh: &Mesh<'_>, words: usize) -> Vec<u32> {
    let mut memory = vec![0xDEAD_BEEF; words];
    let index = structure.build(mesh, &mut memory).expect("there is room");
    index.words().to_vec()
}

#[test]
fn every_structure_finds_what_brute_force_finds() {
    for (name, mesh) in meshes::all() {
        let view = mesh.view();
        let words: Vec<Vec<u32>> = Structure::ALL
            .iter()
            .map(|structure| built(*structure, &view, structure.words(mesh.triangles().len())))
            .collect();
        let mut random = Random::new(7);
        let mut hits = 0;
        for i in 0..often(1500) {
            let path = segment(&mesh, &mut random, i);
            let expected = Index::BRUTE.first_hit(&view, &path);
            hits += usize::from(expected.is_some());
            for (structure, words) in Structure::ALL.iter().zip(&words) {
                let index = Index::new(words).expect("they are as they were built");
                let found = index.first_hit(&view, &path);
                assert_eq!(bits(found), bits(expected), "{structure} of {name}, {i}: {path:?} {found:?} {expected:?}");
            }
        }
        assert!(name == "none" || hits > often(1500) / 20, "{name}: {hits}");
    }
}

#[test]
fn every_structure_finds_what_is_near_in_the_same_order() {
    for (name, mesh) in meshes::all() {
        let view = mesh.view();
        let size = if mesh.triangles().is_empty() { 1.0 } else { mesh.bounds().radius() };
        let mut random = Random::new(8);
        for structure in Structure::ALL {
            let words = built(*structure, &view, structure.words(mesh.triangles().len()));
            let index = Index::new(&words).expect("they are as they were built");
            let indexed = view.with_index(index).expect("it is of this mesh");
            for i in 0..often(60) {
                let at = mesh.sample([random.unit(), random.unit(), random.unit()]).point;
                // Sometimes most of it, which is more than is gathered at once.
                let reach = size * random.magnitude(1e-4, if i % 10 == 0 { 3.0 } else { 0.1 });
                let center = at + random.vector(reach);
                let bounds = Aabb { min: center - reach, max: center + reach };
                let near = |index: &Index<'_>| {
                    let mut found = vec![];
                    index.near(&view, &bounds, &mut |piece| found.push(piece));
                    found
                };
                let expected = near(&Index::BRUTE);
                assert!(expected.is_sorted());
                assert_eq!(near(&index), expected, "{structure} of {name}");
                let leant_on = |mesh: &Mesh<'_>| {
                    let mut found: Vec<Contact> = vec![];
                    mesh.contacts(center, reach, Time::ZERO, &mut |contact| found.push(*contact));
                    found
                };
                assert_eq!(leant_on(&indexed), leant_on(&view), "{structure} of {name}");
            }
        }
    }
}

/// A half-space, what has been found there, and how much is enough.
struct Beyond(Vec3, f32, Vec<usize>, usize);

impl Visitor for Beyond {
    fn enters(&mut self, Aabb { min, max }: &Aabb) -> bool {
        let most = |axis: usize| (self.0[axis] * min[axis]).max(self.0[axis] * max[axis]);
        most(0) + most(1) + most(2) >= self.1
    }

    fn visit(&mut self, piece: usize) -> ControlFlow<()> {
        self.2.push(piece);
        if self.2.len() < self.3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

#[test]
fn every_structure_shows_all_that_is_beyond_a_plane() {
    for (name, mesh) in meshes::all() {
        let view = mesh.view();
        let mut random = Random::new(9);
        for structure in Structure::ALL {
            let words = built(*structure, &view, structure.words(mesh.triangles().len()));
            let index = Index::new(&words).expect("they are as they were built");
            for _ in 0..often(60) {
                let (normal, at) = (random.direction(), mesh.sample([random.unit(), random.unit(), random.unit()]));
                let found = |index: &Index<'_>, enough: usize| {
                    let mut beyond = Beyond(normal, normal.dot(at.point), vec![], enough);
                    let cost = index.visit(&view, &mut beyond);
                    assert_eq!(cost.tests, beyond.2.len() as u64);
                    beyond.2
                };
                let all = found(&index, usize::MAX);
                if !all.is_empty() {
                    let enough = 1 + random.word() as usize % all.len();
                    assert_eq!(found(&index, enough), all[..enough], "{structure} of {name} breaks off");
                }
                let sorted = |mut found: Vec<usize>| {
                    found.sort_unstable();
                    found.dedup();
                    found
                };
                assert_eq!(sorted(all), sorted(found(&Index::BRUTE, usize::MAX)), "{structure} of {name}");
            }
        }
    }
}

#[test]
fn what_moves_nowhere_or_is_no_number_hits_nothing() {
    let mesh = meshes::sphere(8, 0.1);
    let view = mesh.view();
    let on = mesh.vertices()[20];
    let (nan, inf) = (Vec3::new(0.0, f32::NAN, 0.0), Vec3::new(f32::INFINITY, 0.0, 0.0));
    for structure in Structure::ALL {
        let words = built(*structure, &view, structure.words(mesh.triangles().len()));
        let index = Index::new(&words).expect("they are as they were built");
        for (from, to) in
            [(on, on), (Vec3::ZERO, nan), (nan, Vec3::X), (Vec3::ZERO, inf), (inf, Vec3::ZERO), (-inf, inf)]
        {
            for radius in [0.0, 0.1, f32::NAN, f32::INFINITY] {
                let path = Segment { radius, ..Segment::new(from, to) };
                assert_eq!(index.first_hit(&view, &path), None, "{structure}: {path:?}");
            }
        }
        let out = Segment::new(Vec3::ZERO, Vec3::splat(1e5));
        assert!(index.first_hit(&view, &out).is_some(), "{structure}");
    }
}

#[test]
fn the_lowest_of_several_hits_at_once_wins() {
    let mesh = meshes::pile(100);
    let path = Segment::new(Vec3::ZERO, Vec3::ONE);
    for structure in Structure::ALL {
        let words = built(*structure, &mesh.view(), structure.words(100));
        let hit = Index::new(&words).expect("sound").first_hit(&mesh.view(), &path).expect("it goes through");
        assert_eq!(hit.face, 0, "{structure}");
    }
}

#[test]
fn a_tiny_and_a_huge_sphere_are_hit_where_they_should_be() {
    for scale in [1e-20, 1.0, 1e20] {
        let mesh = meshes::scaled(&meshes::sphere(24, 0.0), scale).indexed(Structure::Bvh);
        let mut random = Random::new(3);
        for _ in 0..often(1000) {
            let way = random.direction();
            for radius in [0.0, 0.25] {
                let path = Segment { radius: radius * scale, ..Segment::new(way * (3.0 * scale), -way * scale) };
                let hit = mesh.first_hit(&path).expect("it goes in");
                // From 3 to −1, to 1 + radius; flat sides are a little inside.
                let expected = (2.0 - radius) / 4.0;
                assert!((hit.time - expected).abs() < 0.005, "{scale} {radius}: {}", hit.time);
                assert!(hit.normal.dot(way) > 0.99, "{scale}: {}", hit.normal);
            }
        }
    }
}
