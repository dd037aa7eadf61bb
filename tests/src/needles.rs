//! Closed meshes with needles: thin plates, wedges, fans, slivers on boxes and round bodies, wherever and however large.

use crate::{Random, icosahedron};
use pointmass::{Mat3, Vec3};

/// A closed mesh: each edge belongs to two triangles.
#[derive(Clone, Debug)]
pub struct Closed {
    /// The name of what it was made from.
    pub name: &'static str,
    /// Corners \[m\].
    pub vertices: Vec<Vec3>,
    /// Triangles, in any order of their corners.
    pub triangles: Vec<[u32; 3]>,
    /// A unit in the last place of its largest coordinate \[m\].
    pub ulp: f32,
    /// How large it is \[m\].
    pub size: f32,
}

fn cuboid() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let vertices = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (vertices, quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A triangle drawn out along z.
fn wedge() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let profile = [(-0.5, 0.0), (0.5, 0.5), (0.5, -0.5)];
    let vertices = [-0.5, 0.5].into_iter().flat_map(|z| profile.map(|(x, y)| Vec3::new(x, y, z))).collect();
    let sides = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
    (vertices, [[0, 2, 1], [3, 4, 5]].into_iter().chain(sides).collect())
}

/// Two apices over a rim, some of whose corners are next to each other: needles around a vertex.
fn fan(random: &mut Random) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut angles = vec![];
    for i in 0..3 + (random.word() % 6) as u32 {
        let angle = (i as f32 + random.between(0.1, 0.5)) / 9.0;
        angles.extend([angle, angle + random.magnitude(1e-6, 0.3) / 9.0]);
    }
    let rim = angles.iter().map(|turn| {
        let (sin, cos) = (turn * core::f32::consts::TAU).sin_cos();
        Vec3::new(cos * 0.5, 0.0, sin * 0.5)
    });
    let vertices = [Vec3::Y * 0.5, Vec3::Y * -0.5].into_iter().chain(rim).collect();
    let count = angles.len() as u32;
    let around = |i: u32| [[0, 2 + (i + 1) % count, 2 + i], [1, 2 + i, 2 + (i + 1) % count]];
    (vertices, (0..count).flat_map(around).collect())
}

/// Cuts an edge at a place that may be next to its end, and both triangles there.
fn cut_edge(vertices: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, random: &mut Random) {
    let t = triangles[random.word() as usize % triangles.len()];
    let (from, to, new) = (t[0], t[1], vertices.len() as u32);
    vertices.push(vertices[from as usize].lerp(vertices[to as usize], random.magnitude(1e-6, 0.5)));
    for i in 0..triangles.len() {
        let corners = triangles[i];
        if corners.contains(&from) && corners.contains(&to) {
            let with = |old: u32| corners.map(|corner| if corner == old { new } else { corner });
            triangles[i] = with(from);
            triangles.push(with(to));
        }
    }
}

/// Puts a corner into a triangle, perhaps next to an edge: a sliver nearly without height.
fn cut_face(vertices: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>, random: &mut Random) {
    let at = random.word() as usize % triangles.len();
    let ([a, b, c], new) = (triangles[at], vertices.len() as u32);
    let edge = vertices[a as usize].lerp(vertices[b as usize], random.between(0.01, 0.99));
    vertices.push(edge.lerp(vertices[c as usize], random.magnitude(1e-6, 0.5)));
    triangles[at] = [a, b, new];
    triangles.extend([[b, c, new], [c, a, new]]);
}

/// One of them, down to a thickness of 16 units in the last place of its coordinates and an aspect of 1e-6.
pub fn closed(random: &mut Random) -> Closed {
    let (name, (mut vertices, mut triangles)) = match random.word() % 4 {
        0 => ("plate", cuboid()),
        1 => ("wedge", wedge()),
        2 => ("fan", fan(random)),
        _ => ("icosahedron", icosahedron()),
    };
    for _ in 0..random.word() % 8 {
        if random.unit() < 0.5 {
            cut_edge(&mut vertices, &mut triangles, random);
        } else {
            cut_face(&mut vertices, &mut triangles, random);
        }
    }
    let turns = random.unit() < 0.7;
    let turn = if turns { Mat3::from_axis_angle(random.direction(), random.between(0.0, 6.0)) } else { Mat3::IDENTITY };
    let size = if random.unit() < 0.1 { random.magnitude(1e-12, 1e12) } else { random.magnitude(1e-2, 1e2) };
    let away = if random.unit() < 0.5 { 0.0 } else { random.magnitude(1.0, 1e3) };
    let offset = random.direction() * (size * away);
    let reach = (0.5 * size + offset.abs().max_element()).max(size);
    let ulp = reach.next_up() - reach;
    // Flattened along one axis, and narrowed along another.
    let thick = random.magnitude(16.0 * ulp / size, 1.0).min(1.0);
    let wide = if random.unit() < 0.5 { 1.0 } else { random.magnitude(thick.max(1e-6), 1.0) };
    let squash = match random.word() % 3 {
        0 => Vec3::new(1.0, thick, wide),
        1 => Vec3::new(thick, wide, 1.0),
        _ => Vec3::new(wide, 1.0, thick),
    };
    vertices.iter_mut().for_each(|v| *v = offset + turn * (*v * squash) * size);
    // In which order the corners are is to mean nothing.
    let flips = random.unit() < 0.3;
    for t in &mut triangles {
        t.rotate_left(random.word() as usize % 3);
        if flips && random.unit() < 0.5 {
            t.swap(0, 1);
        }
    }
    Closed { name, vertices, triangles, ulp, size }
}
