//! The nearest place of meshes and height fields, the same bits with and without what finds it fast; births on surfaces
//! whose areas are beyond an `f32`.

use pointmass::Vec3;
use pointmass::rays::{Index, Structure};
use pointmass::shape::{HeightField, HeightFieldBuf, Heights, Mesh, MeshBuf, Surface};
use pointmass_tests::needles::closed;
use pointmass_tests::{Random, icosahedron, often};

/// A place near, far or very far from something.
fn place(random: &mut Random, middle: Vec3, size: f32) -> Vec3 {
    middle + random.direction() * (size * random.magnitude(1e-3, 1e4))
}

#[test]
fn an_index_finds_the_nearest_place_to_the_bit() {
    let mut random = Random::new(91);
    for round in 0..30 {
        let (vertices, triangles) = match round % 3 {
            0 => {
                let closed = closed(&mut random);
                (closed.vertices, closed.triangles)
            }
            1 => icosahedron(),
            _ => {
                let vertices: Vec<Vec3> = (0..300).map(|_| random.vector(1.0)).collect();
                let triangles = (0..600).map(|_| [0; 3].map(|_: u32| (random.word() % 300) as u32)).collect();
                (vertices, triangles)
            }
        };
        let brute = MeshBuf::new(vertices.clone(), triangles.clone()).expect("it is a mesh");
        let bounds = brute.bounds();
        let (middle, size) = (bounds.center(), (bounds.max - bounds.min).length());
        for &structure in Structure::ALL {
            let mesh = brute.clone().indexed(structure);
            for i in 0..200 {
                let point = if i % 5 == 0 { vertices[i % vertices.len()] } else { place(&mut random, middle, size) };
                let (found, expected) = (mesh.nearest(point), brute.nearest(point));
                assert_eq!(
                    found.to_array().map(f32::to_bits),
                    expected.to_array().map(f32::to_bits),
                    "{structure} {point}"
                );
            }
        }
    }
}

#[test]
fn the_nearest_place_of_a_large_mesh_costs_little_however_far_away() {
    let mut random = Random::new(92);
    let across = 120_u32;
    let vertices: Vec<Vec3> = (0..across * across)
        .map(|i| Vec3::new((i % across) as f32, random.between(-1.0, 1.0), (i / across) as f32) * 0.1)
        .collect();
    let corner = |i: u32, j: u32| j * across + i;
    let quads = (0..across - 1).flat_map(|j| (0..across - 1).map(move |i| (i, j)));
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)];
            [[a, b, c], [c, b, d]]
        })
        .collect();
    let mesh = Mesh::new(&vertices, &triangles, &mut []).expect("it is a mesh");
    for &structure in Structure::ALL {
        let mut memory = vec![0; structure.words(triangles.len())];
        let index = structure.build(&mesh, &mut memory).expect("there is room");
        let mut tests = 0;
        let looks = often(200);
        for _ in 0..looks {
            let point = place(&mut random, Vec3::new(6.0, 0.0, 6.0), 12.0);
            let face = |i: usize| pointmass::shape::Triangle { corners: triangles[i].map(|v| vertices[v as usize]) };
            let (found, cost) = index.nearest(&mesh, point, |i| face(i).nearest(point));
            assert_eq!(found, Index::BRUTE.nearest(&mesh, point, |i| face(i).nearest(point)).0);
            tests += cost.tests;
        }
        assert!(structure == Structure::Brute || tests < looks as u64 * 600, "{structure}: {tests}");
    }
}

#[test]
fn height_fields_with_tables_answer_as_those_without() {
    let mut random = Random::new(93);
    for (columns, rows, size) in [(2, 2, 1.0), (17, 16, 3.0), (70, 41, 100.0), (33, 50, 1e-5), (5, 40, 1e18)] {
        let heights: Vec<f32> = (0..columns * rows).map(|_| random.between(-2.0, 3.0) * size).collect();
        let origin = random.vector(3.0) * size;
        let plain = HeightField::new(origin, size, columns, &heights).expect("it is full and finite");
        let (mut sums, mut blocks) = (vec![0; plain.cell_count()], vec![[0.0; 2]; plain.block_count()]);
        let tables = plain.with_sums(&mut sums).with_blocks(&mut blocks);
        let file = Heights { origin, spacing: size, columns: columns as u32, heights: heights.clone() };
        let owned = HeightFieldBuf::try_from(file).expect("it is full and finite");
        let middle = plain.bounds().center();
        for _ in 0..300 {
            let point = if size > 1e9 { random.vector(9.0) * size } else { place(&mut random, middle, size * 30.0) };
            let cells = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| (i, j)));
            let mut expected = (f32::INFINITY, plain.vertex(0, 0));
            for triangle in cells.flat_map(|(i, j)| plain.triangles(i, j)) {
                let bounds = triangle.bounds();
                let place = triangle.nearest(point).clamp(bounds.min, bounds.max);
                let square = (place - point).dot(place - point);
                if square < expected.0 {
                    expected = (square, place);
                }
            }
            for found in [plain.nearest(point), tables.nearest(point), owned.nearest(point)] {
                assert_eq!(found, expected.1, "{columns} by {rows}: {point}");
            }
            let u = [random.unit(), random.unit(), random.unit()];
            assert_eq!(plain.sample(u), tables.sample(u));
            assert_eq!(plain.sample(u), owned.sample(u));
        }
    }
}

#[test]
fn births_are_spread_by_area_though_areas_are_beyond_numbers() {
    // Three of four parts of the area belong to the second triangle.
    for size in [1e-30, 1.0, 1e19, 1e38] {
        let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [-1.5, -1.5], [-1.5, 0.5], [0.0, -1.5]];
        let vertices = vertices.map(|[x, z]| Vec3::new(x, 0.0, z) * size).to_vec();
        let mesh = MeshBuf::new(vertices, vec![[0, 1, 2], [3, 4, 5]]).expect("it is a mesh");
        let mut random = Random::new(94);
        let in_first = |spot: Vec3| spot.x >= 0.0 && spot.z >= 0.0;
        let n =
            (0..4000).filter(|_| in_first(mesh.sample([random.unit(), random.unit(), random.unit()]).point)).count();
        // Five standard deviations.
        assert!((n as f32 - 1000.0).abs() < 137.0, "{size}: {n}");
    }
    let mut random = Random::new(95);
    let heights: Vec<f32> = (0..64).map(|_| random.between(-1.0, 1.0) * 3e38).collect();
    let mut sums = [0; 49];
    let field = HeightField::new(Vec3::ZERO, 1e34, 8, &heights).expect("it is finite").with_sums(&mut sums);
    let faces: std::collections::BTreeSet<u32> = (0..2000)
        .map(|_| field.sample([random.unit(), random.unit(), random.unit()]).point)
        .inspect(|point| assert!(point.is_finite()))
        .map(|point| (point.x / 1e34) as u32 + 8 * (point.z / 1e34) as u32)
        .collect();
    assert!(faces.len() > 40 && !field.area().is_nan(), "{}", faces.len());
}
