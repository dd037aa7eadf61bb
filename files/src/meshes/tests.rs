//! One cube in every format, whatever can be wrong with a file, and damaged files by the thousand.

use std::fs;
use std::path::Path;

use proptest::prelude::*;

use super::{MAX_BYTES, MeshData, load, parse};

const CORNERS: [[f32; 3]; 8] =
    [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]];
const SIDES: [[usize; 4]; 6] = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// The unit cube as (name, extension, bytes), in every format and encoding.
fn cubes() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    vec![
        ("OFF", "off", off().into_bytes()),
        ("OBJ", "OBJ", obj().into_bytes()),
        ("STL text", "stl", stl_text().into_bytes()),
        ("STL binary", "Stl", stl_binary()),
        ("PLY text", "ply", ply("ascii", |x| format!("{x} ").into_bytes(), |i| format!("{i} ").into_bytes(), b"\n")),
        ("PLY big", "PLY", ply("binary_big_endian", |x| x.to_be_bytes().to_vec(), |i| vec![i], b"")),
        ("PLY little", "ply", ply("binary_little_endian", |x| x.to_le_bytes().to_vec(), |i| vec![i], b"")),
    ]
}

fn off() -> String {
    let points = CORNERS.map(|[x, y, z]| format!("{x} {y} {z}\n")).concat();
    let sides = SIDES.map(|[a, b, c, d]| format!("4 {a} {b} {c} {d}\n")).concat();
    format!("OFF\n8 6 12\n{points}{sides}")
}

fn obj() -> String {
    let points = CORNERS.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    let sides = SIDES.map(|side| format!("f {}\n", side.map(|i| format!("{}//1", i + 1)).join(" "))).concat();
    format!("{points}vn 0 0 1\n{sides}")
}

fn facets() -> impl Iterator<Item = [[f32; 3]; 3]> {
    SIDES.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|facet| facet.map(|i| CORNERS[i]))
}

fn stl_text() -> String {
    let facet = |corners: [[f32; 3]; 3]| {
        let corners = corners.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    format!("solid cube\n{}endsolid cube\n", facets().map(facet).collect::<String>())
}

fn stl_binary() -> Vec<u8> {
    let mut bytes = [b"solid".as_slice(), &[0; 75], &12u32.to_le_bytes()].concat();
    for corners in facets() {
        bytes.extend([0; 12]);
        bytes.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn ply(encoding: &str, float: impl Fn(f32) -> Vec<u8>, byte: impl Fn(u8) -> Vec<u8>, end: &[u8]) -> Vec<u8> {
    let head = format!(
        "ply\nformat {encoding} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n\
         element face 6\nproperty list uchar uchar vertex_indices\nend_header\n"
    );
    let mut bytes = head.into_bytes();
    for point in CORNERS {
        bytes.extend(point.into_iter().flat_map(&float));
        bytes.extend(end);
    }
    for side in SIDES {
        bytes.extend(byte(4));
        bytes.extend(side.into_iter().flat_map(|index| byte(index as u8)));
        bytes.extend(end);
    }
    bytes
}

/// The triangles as points, each beginning with its smallest corner, in order.
fn triangles(mesh: &MeshData) -> Vec<[[u32; 3]; 3]> {
    let mut all: Vec<_> = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let mut corners = triangle.map(|i| mesh.vertices[i as usize].map(f32::to_bits));
            let first = (0..3).min_by_key(|i| corners[*i]).unwrap();
            corners.rotate_left(first);
            corners
        })
        .collect();
    all.sort_unstable();
    all
}

fn area(mesh: &MeshData) -> f32 {
    let side = |a: [f32; 3], b: [f32; 3]| [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let areas = mesh.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
        let (u, v) = (side(a, b), side(a, c));
        let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        cross.iter().map(|x| x * x).sum::<f32>().sqrt() / 2.0
    });
    areas.sum()
}

/// Holds a mesh against what [`MeshData`] promises, wherever it comes from.
fn assert_sound(mesh: &MeshData) {
    assert!(!mesh.triangles.is_empty());
    assert!(mesh.vertices.as_flattened().iter().all(|x| x.is_finite()));
    assert!(mesh.triangles.as_flattened().iter().all(|i| (*i as usize) < mesh.vertices.len()));
}

#[test]
fn a_cube_is_the_same_in_every_format() {
    let (_, _, off) = &cubes()[0];
    let expected = triangles(&parse("cube", "off", off).unwrap());
    assert_eq!(expected.len(), 12);
    for (name, extension, bytes) in cubes() {
        let mesh = parse(name, extension, &bytes).unwrap();
        assert_eq!(triangles(&mesh), expected, "{name}");
        assert_eq!(mesh.vertices.len(), 8, "{name}");
        assert_eq!(area(&mesh), 6.0, "{name}");
    }
}

#[test]
fn a_file_cut_anywhere_is_refused_or_sound() {
    for (name, extension, bytes) in cubes() {
        for end in 0..bytes.len() {
            match parse(name, extension, &bytes[..end]) {
                Ok(mesh) => assert_sound(&mesh),
                Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
            }
        }
        // An OBJ has neither counts nor an end; the last digits and the last line break of a text may go unnoticed.
        let missed = (0..bytes.len() - 12).filter(|end| parse(name, extension, &bytes[..*end]).is_ok()).count();
        assert!(missed == 0 || extension == "OBJ", "{name}: {missed}");
    }
}

#[test]
fn a_file_with_a_byte_changed_is_refused_or_sound() {
    for (name, extension, mut bytes) in cubes() {
        for place in 0..bytes.len() {
            let right = bytes[place];
            for wrong in [0, 1, 0x7f, 0x80, 0xff, right ^ 1, right ^ 0x80, b'\n', b' ', b'-', b'9', b'/', b'e', b'.'] {
                bytes[place] = wrong;
                if let Ok(mesh) = parse(name, extension, &bytes) {
                    assert_sound(&mesh);
                }
            }
            bytes[place] = right;
        }
    }
}

proptest! {
    #[test]
    fn a_file_with_many_bytes_changed_is_refused_or_sound(
        format in 0..7usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20),
        cut in any::<prop::sample::Index>(),
    ) {
        let (name, extension, mut bytes) = cubes().swap_remove(format);
        for (place, wrong) in changes {
            let place = place.index(bytes.len());
            bytes[place] = wrong;
        }
        bytes.truncate(bytes.len() - cut.index(bytes.len()) / 4);
        if let Ok(mesh) = parse(name, extension, &bytes) {
            assert_sound(&mesh);
        }
    }

    #[test]
    fn noise_is_refused_or_sound(
        head in "(OFF|COFF 8|ply\n|solid|v 0 0 0\nf )?",
        noise in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        for extension in ["off", "obj", "stl", "ply"] {
            if let Ok(mesh) = parse("noise", extension, &[head.as_bytes(), &noise].concat()) {
                assert_sound(&mesh);
            }
        }
    }
}

#[test]
fn a_file_is_read_by_its_extension() {
    let folder = tempfile::tempdir().unwrap();
    for (name, extension, bytes) in cubes() {
        let path = folder.path().join(format!("cube.{extension}"));
        fs::write(&path, &bytes).unwrap();
        assert_eq!(load(&path), parse(name, extension, &bytes));
    }
}

#[test]
fn files_that_are_no_meshes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let message = |path: &Path| load(path).unwrap_err().to_string();
    let path = |name: &str| folder.path().join(name);

    assert!(message(&path("missing.off")).contains("missing.off: can't be read: "));
    assert!(
        message(&path("cube.fbx"))
            .ends_with("cube.fbx: unknown extension .fbx: a mesh is one of .off, .obj, .stl, .ply, .png")
    );
    assert!(message(&path("cube")).ends_with("cube: no extension: a mesh is one of .off, .obj, .stl, .ply, .png"));

    fs::create_dir(path("folder.off")).unwrap();
    assert!(message(&path("folder.off")).ends_with("folder.off: is a directory: name a mesh file"));

    for extension in ["off", "obj", "stl", "ply"] {
        let empty = path(&format!("empty.{extension}"));
        fs::write(&empty, "").unwrap();
        assert!(message(&empty).ends_with(": is empty: expected a mesh"));
    }

    // A file with a hole takes no room on the disk.
    fs::File::create(path("huge.off")).unwrap().set_len(MAX_BYTES + 1).unwrap();
    assert!(
        message(&path("huge.off"))
            .ends_with("huge.off: has 268435457 bytes: at most 256 MiB are read; simplify the mesh")
    );
}
