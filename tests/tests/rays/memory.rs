//! Memory: too little of it, words from elsewhere, words of another mesh.

use super::meshes;
use super::same::{bits, built, segment};
use pointmass::Vec3;
use pointmass::rays::{Index, Structure, TooSmall, Unsound};
use pointmass::shape::{Collider, Mesh, Segment};
use pointmass_tests::{Random, often};

#[test]
fn with_little_memory_leaves_are_larger_and_answers_the_same() {
    for mesh in [meshes::sphere(20, 0.1), meshes::soup(500), meshes::pile(300)] {
        let (view, n) = (mesh.view(), mesh.triangles().len());
        let mut random = Random::new(12);
        let paths: Vec<Segment> = (0..often(300)).map(|i| segment(&mesh, &mut random, i)).collect();
        for &structure in &Structure::ALL[1..] {
            let Err(TooSmall { words: 0, needed }) = structure.build(&view, &mut []) else {
                panic!("{structure} needs no memory");
            };
            assert!(structure.build(&view, &mut vec![0; needed - 1]).is_err());
            let (mut last, mut most) = (usize::MAX, 0);
            let enough = structure.words(n);
            for words in (0..6).map(|i| needed + (enough - needed) * i / 5) {
                let mut memory = vec![7; words];
                let index = structure.build(&view, &mut memory).expect("there is room");
                let index = Index::new(index.words()).expect("sound");
                let crowd = index.stats().fullest;
                (last, most) = (last.min(crowd), most.max(crowd));
                for path in &paths {
                    let expected = bits(Index::BRUTE.first_hit(&view, path));
                    assert_eq!(bits(index.first_hit(&view, path)), expected, "{structure} in {words} words");
                }
            }
            assert!(most > 2 * last || mesh.vertices().len() == 3, "{structure}: {most} {last}");
        }
    }
}

#[test]
fn any_change_is_noticed() {
    let mesh = meshes::sphere(6, 0.1);
    let view = mesh.view();
    for &structure in Structure::ALL {
        let words = built(structure, &view, structure.words(mesh.triangles().len()));
        let mut random = Random::new(9);
        for _ in 0..often(1000) {
            let mut changed = words.clone();
            let at = random.word() as usize % words.len();
            changed[at] ^= 1 << (random.word() % 32);
            assert_eq!(Index::new(&changed), Err(Unsound), "{structure}, word {at}");
            let cut = random.word() as usize % (words.len() - 1) + 1;
            assert_eq!(Index::new(&words[..cut]), Err(Unsound), "{structure}, {cut} words");
        }
    }
    assert!(Index::new(&[]).is_ok_and(|index| index == Index::BRUTE));
}

#[test]
fn an_index_belongs_to_its_triangles() {
    let (mesh, other) = (meshes::sphere(6, 0.1), meshes::sphere(6, 0.2));
    for &structure in &Structure::ALL[1..] {
        let words = built(structure, &mesh.view(), structure.words(mesh.triangles().len()));
        let index = Index::new(&words).expect("sound");
        assert!(mesh.view().with_index(index).is_ok());
        assert_eq!(other.view().with_index(index), Err(Unsound));
        // Asked with fewer it looks at all of them.
        let triangles = &mesh.triangles()[..50];
        let fewer = Mesh::new(mesh.vertices(), triangles, &mut []).expect("a part is a mesh");
        let path = Segment::new(Vec3::ZERO, mesh.vertices()[triangles[3][0] as usize] * 2.0);
        assert_eq!(index.first_hit(&fewer, &path), Index::BRUTE.first_hit(&fewer, &path));
    }
    let owned = mesh.clone().indexed(Structure::Kd);
    assert_eq!(owned.index().structure(), Structure::Kd);
    let path = Segment::new(Vec3::ZERO, Vec3::ONE * 3.0);
    assert!(owned.first_hit(&path).is_some() && owned.first_hit(&path) == mesh.first_hit(&path));
}

/// Two triangles and what a hierarchy of them came to, as a program without a heap would keep them in flash.
const CORNERS: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.5)];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [1, 3, 2]];
static WORDS: [u32; 72] = include!("words.txt");

#[test]
fn words_may_be_a_constant() {
    let mesh = Mesh::new(&CORNERS, &TRIANGLES, &mut []).expect("it is a mesh");
    assert_eq!(built(Structure::Bvh, &mesh, Structure::Bvh.words(2)), WORDS);
    let indexed = mesh.with_index(Index::new(&WORDS).expect("sound")).expect("it is of these triangles");
    for (to, face) in
        [(Vec3::new(0.2, 0.2, -1.0), Some(0)), (Vec3::new(0.8, 0.8, -1.0), Some(1)), (Vec3::ONE * 2.0, None)]
    {
        let hit = indexed.first_hit(&Segment::new(to + Vec3::Z * 3.0, to));
        assert_eq!(hit.map(|hit| hit.face), face);
    }
}

#[test]
fn a_grid_of_the_largest_extent_is_built_in_the_least_memory() {
    for end in [f32::MAX, f32::MAX / 2.0, 1e38] {
        let vertices = [Vec3::splat(-end), Vec3::splat(end), Vec3::new(end, -end, 0.0), Vec3::ZERO];
        let triangles = [[0, 1, 2], [0, 3, 2], [1, 2, 3]];
        for vertices in [vertices, vertices.map(|v| v.max(Vec3::ZERO))] {
            let mesh = Mesh::new(&vertices, &triangles, &mut []).expect("it is a mesh");
            for words in 0..400 {
                let mut memory = vec![0; words];
                if let Ok(index) = Structure::Grid.build(&mesh, &mut memory) {
                    assert!(index.is_of(&mesh));
                }
            }
        }
    }
}
