//! The meshes that structures are held against brute force on.

use pointmass::Vec3;
use pointmass::shape::MeshBuf;
use pointmass_tests::Random;
use std::f32::consts::TAU;

fn mesh(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> MeshBuf {
    MeshBuf::new(vertices, triangles).expect("it is a mesh")
}

/// A surface over a rectangle of `u` × `v` quadrilaterals.
fn sheet([u, v]: [u32; 2], place: impl Fn(f32, f32) -> Vec3) -> MeshBuf {
    let vertices = (0..=u).flat_map(|i| (0..=v).map(move |j| (i as f32 / u as f32, j as f32 / v as f32)));
    let corner = |i: u32, j: u32| i * (v + 1) + j;
    let quads = (0..u).flat_map(|i| (0..v).map(move |j| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    mesh(vertices.map(|(s, t)| place(s, t)).collect(), triangles.collect())
}

/// A sphere with bumps, of about `2 n²` triangles.
pub(crate) fn sphere(n: u32, bumps: f32) -> MeshBuf {
    sheet([2 * n, n], |s, t| {
        let (a, b) = (s * TAU, t * TAU / 2.0);
        let r = 1.0 + bumps * (7.0 * a).sin() * (9.0 * b).sin() * b.sin();
        Vec3::new(b.sin() * a.cos(), b.cos(), b.sin() * a.sin()) * r
    })
}

pub(crate) fn cube() -> MeshBuf {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32);
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    mesh((0..8).map(corner).collect(), triangles.collect())
}

pub(crate) fn terrain(n: u32) -> MeshBuf {
    sheet([n, n], |s, t| Vec3::new(s, 0.05 * ((19.0 * s).sin() + (23.0 * t + s).cos()), t))
}

pub(crate) fn knot(n: u32) -> MeshBuf {
    sheet([8 * n, n], |s, t| {
        let (a, b) = (s * TAU, t * TAU);
        let center = Vec3::new(a.sin() + 2.0 * (2.0 * a).sin(), a.cos() - 2.0 * (2.0 * a).cos(), -(3.0 * a).sin());
        let out = Vec3::new((3.0 * a).sin(), (3.0 * a).cos(), 0.0);
        center + (out * b.cos() + Vec3::Z * b.sin()) * 0.3
    })
}

/// Triangles of all sizes anywhere, some of them degenerate, some there twice.
pub(crate) fn soup(n: u32) -> MeshBuf {
    let mut random = Random::new(41);
    let mut vertices = vec![];
    for i in 0..n {
        let at = random.vector(2.0);
        let size = random.magnitude(1e-3, 0.5);
        let [a, b, c] = [at, at + random.vector(size), at + random.vector(size)];
        vertices.extend(match i % 10 {
            0 => [a, a, a],
            1 => [a, b, a.midpoint(b)],
            2 => [a, b, Vec3::new(c.x, a.y, b.z)],
            3 if i > 30 => {
                let twin = random.word() as usize % (i as usize) * 3;
                [vertices[twin], vertices[twin + 1], vertices[twin + 2]]
            }
            _ => [a, b, c],
        });
    }
    mesh(vertices, (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// Long and thin triangles about one point.
pub(crate) fn fan(n: u32) -> MeshBuf {
    let rim = (0..=n).map(|i| {
        let a = i as f32 / n as f32 * TAU;
        Vec3::new(10.0 * a.cos(), 0.1 * (5.0 * a).sin(), 10.0 * a.sin())
    });
    mesh(std::iter::once(Vec3::ZERO).chain(rim).collect(), (1..=n).map(|i| [0, i, i + 1]).collect())
}

/// Many triangles in one plane across an axis.
pub(crate) fn plate(n: u32) -> MeshBuf {
    sheet([n, n], |s, t| Vec3::new(s, 0.25, t))
}

/// The same triangle many times.
pub(crate) fn pile(n: u32) -> MeshBuf {
    mesh(vec![Vec3::X, Vec3::Y, Vec3::Z], vec![[0, 1, 2]; n as usize])
}

/// The same, larger or smaller.
pub(crate) fn scaled(mesh: &MeshBuf, scale: f32) -> MeshBuf {
    let vertices = mesh.vertices().iter().map(|&v| v * scale).collect();
    MeshBuf::new(vertices, mesh.triangles().to_vec()).expect("it is a mesh")
}

/// All of them, by their names.
pub(crate) fn all() -> Vec<(&'static str, MeshBuf)> {
    let none = mesh(vec![], vec![]);
    vec![
        ("cube", cube()),
        ("sphere", sphere(24, 0.1)),
        ("terrain", terrain(24)),
        ("knot", knot(12)),
        ("soup", soup(700)),
        ("fan", fan(300)),
        ("plate", plate(20)),
        ("pile", pile(100)),
        ("tiny", scaled(&sphere(12, 0.1), 1e-20)),
        ("huge", scaled(&sphere(12, 0.1), 1e20)),
        ("far", {
            let sphere = sphere(12, 0.1);
            let vertices = sphere.vertices().iter().map(|&v| v + Vec3::new(1e4, -3e4, 500.0)).collect();
            mesh(vertices, sphere.triangles().to_vec())
        }),
        ("one", mesh(vec![Vec3::X, Vec3::Y, Vec3::Z], vec![[0, 1, 2]])),
        ("none", none),
    ]
}
