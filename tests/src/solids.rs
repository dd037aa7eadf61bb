//! Closed convex solids, each with its depth in double precision as an oracle.

use crate::surfaces::to_line;
use crate::{Random, f64s, gap, icosahedron};
use pointmass::shape::{Affine, Capsule, Collider, Cone, Cuboid, Cylinder, MeshBuf, Placed, Sphere};
use pointmass::{Mat3, Vec3};

/// A closed convex solid.
pub struct Solid {
    /// Its name in a report.
    pub name: String,
    /// Its surface.
    pub collider: Box<dyn Collider>,
    /// How deep a point lies inside \[m\], in double precision; below zero outside.
    pub depth: Box<dyn Fn([f64; 3]) -> f64>,
    /// Vertices, points of edges and rims, an apex.
    pub corners: Vec<Vec3>,
    /// A point inside.
    pub middle: Vec3,
    /// The largest coordinate \[m\]: what rounding goes by.
    pub size: f32,
}

/// Depth below planes through `point` with outward `normal`.
#[must_use]
pub fn below(x: [f64; 3], point: [f64; 3], normal: [f64; 3]) -> f64 {
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

/// Each of the engine's, near the origin and far from it, squashed, turned and sheared.
#[must_use]
pub fn solids() -> Vec<Solid> {
    let center = Vec3::new(0.3, -0.2, 0.5);
    let c = f64s(center);
    let about = move |x: [f64; 3]| ((x[0] - c[0]).hypot(x[2] - c[2]), x[1] - c[1]);
    let sphere = Sphere { center, radius: 0.75 };
    let cylinder = Cylinder { center, radius: 0.5, height: 1.5 };
    let cone = Cone { center, radius: 0.75, height: 1.25 };
    let (one, other) = (center - Vec3::new(0.4, 0.1, 0.3), center + Vec3::new(0.4, 0.1, 0.3));
    let capsule = Capsule { from: one, to: other, radius: 0.5 };
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
        Solid {
            name: "capsule".into(),
            collider: Box::new(capsule),
            depth: Box::new(move |x| 0.5 - to_line(x, f64s(one), f64s(other))),
            corners: rim(one, 0.5).chain(rim(other, 0.5)).collect(),
            middle: center,
            size: 1.25,
        },
    ]
}

/// A point inside, by trial.
pub fn inside(solid: &Solid, random: &mut Random) -> Vec3 {
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
pub fn extent(solid: &Solid) -> f32 {
    solid.corners.iter().map(|&c| c.distance(solid.middle)).fold(0.0, f32::max)
}
