//! Shapes as other shapes: where a transform puts them.

use super::{Affine, Capsule, Cone, Cuboid, Cylinder, Disc, Line, MeshBuf, Plane, Shape, Sphere, Triangle};
use crate::math::{high, low, unit};
use crate::rays::Structure;
use alloc::sync::Arc;
use alloc::vec::Vec;
use glam::Vec3;

/// The corners of a box's twelve triangles, counter-clockwise from outside; corner `i` is at the far end of x, y and z where
/// its bits 1, 2 and 4 are set.
const FACES: [[u32; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

impl Shape<Arc<MeshBuf>> {
    /// The shape where `map` puts it, outside staying outside; a box that is turned becomes a mesh.
    ///
    /// # Errors
    /// Why there is no such shape: what is round has to stay round, and cylinders, cones and height fields upright.
    pub fn moved(&self, map: &Affine, index: Structure) -> Result<Self, &'static str> {
        const SQUASHED: &str = "its groups squash what is round: put a mesh there";
        const TILTED: &str = "its groups tilt or squash what stands upright: put a mesh there";
        if *map == Affine::IDENTITY {
            return Ok(self.clone());
        }
        let normal = |normal: Vec3| map.inverse().map(|back| unit(back.linear.transpose() * normal));
        Ok(match self {
            Self::Line(Line { from, to }) => Self::Line(Line { from: map.point(*from), to: map.point(*to) }),
            Self::Triangle(Triangle { corners: [a, b, c] }) => {
                let corners = if mirrors(map) { [a, c, b] } else { [a, b, c] };
                Self::Triangle(Triangle { corners: corners.map(|corner| map.point(*corner)) })
            }
            Self::Plane(plane) => {
                Self::Plane(Plane { point: map.point(plane.point), normal: normal(plane.normal).ok_or(SQUASHED)? })
            }
            Self::Sphere(Sphere { center, radius }) => {
                let [scale, _] = map.scale().ok_or(SQUASHED)?;
                Self::Sphere(Sphere { center: map.point(*center), radius: radius * scale })
            }
            Self::Capsule(Capsule { from, to, radius }) => {
                let [scale, _] = map.scale().ok_or(SQUASHED)?;
                Self::Capsule(Capsule { from: map.point(*from), to: map.point(*to), radius: radius * scale })
            }
            Self::Circle(disc) => {
                let [scale, _] = map.scale().ok_or(SQUASHED)?;
                let normal = normal(disc.normal).ok_or(SQUASHED)?;
                Self::Circle(Disc { center: map.point(disc.center), normal, radius: disc.radius * scale })
            }
            Self::Box(Cuboid { min, max }) => {
                if let Some([a, b]) = keeps_axes(map).then(|| [map.point(*min), map.point(*max)]) {
                    return Ok(Self::Box(Cuboid { min: low(a, b), max: high(a, b) }));
                }
                let pick = |far: bool, axis: usize| if far { max[axis] } else { min[axis] };
                let corner = |i: u32| Vec3::new(pick(i & 1 != 0, 0), pick(i & 2 != 0, 1), pick(i & 4 != 0, 2));
                mesh((0..8).map(corner).collect(), FACES.to_vec(), map, index)?
            }
            Self::Mesh(old) => mesh(old.vertices().to_vec(), old.triangles().to_vec(), map, index)?,
            Self::Cylinder(Cylinder { center, radius, height }) => {
                let [across, up] = map.upright().ok_or(TILTED)?;
                let (radius, height) = (radius * across, height * up.abs());
                Self::Cylinder(Cylinder { center: map.point(*center), radius, height })
            }
            Self::Cone(Cone { center, radius, height }) => {
                let [across, up] = map.upright().filter(|[_, up]| *up > 0.0).ok_or(TILTED)?;
                Self::Cone(Cone { center: map.point(*center), radius: radius * across, height: height * up })
            }
            Self::HeightField(_) => return Err("a height field stands where it is, in no group"),
        })
    }
}

/// A mesh of the images of vertices.
fn mesh(
    vertices: Vec<Vec3>,
    mut triangles: Vec<[u32; 3]>,
    map: &Affine,
    index: Structure,
) -> Result<Shape<Arc<MeshBuf>>, &'static str> {
    if mirrors(map) {
        triangles.iter_mut().for_each(|[_, b, c]| core::mem::swap(b, c));
    }
    let vertices = vertices.into_iter().map(|vertex| map.point(vertex)).collect();
    let mesh =
        MeshBuf::new(vertices, triangles).map_err(|_| "its groups move it beyond the range of a 32-bit float")?;
    Ok(Shape::Mesh(Arc::new(mesh.organised(index))))
}

/// Tells whether it turns left into right.
fn mirrors(map: &Affine) -> bool {
    map.linear.determinant() < 0.0
}

/// Tells whether boxes along the axes stay so.
fn keeps_axes(map: &Affine) -> bool {
    let m = map.linear;
    [m.x_axis, m.y_axis, m.z_axis].iter().all(|column| column.to_array().iter().filter(|&&x| x != 0.0).count() == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Collider, Placed, Segment, Surface};
    use glam::Mat3;

    fn shapes() -> [Shape<Arc<MeshBuf>>; 8] {
        let (center, radius, height) = (Vec3::new(0.3, -0.2, 0.5), 0.7, 1.1);
        let corners = [center, center + Vec3::X, center + Vec3::new(0.2, 0.9, 0.4)];
        let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|corner| corner + center).to_vec();
        let mesh =
            MeshBuf::new(vertices, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].to_vec()).expect("a tetrahedron");
        [
            Shape::Triangle(Triangle { corners }),
            Shape::Plane(Plane { point: center, normal: Vec3::new(0.1, 1.0, 0.3) }),
            Shape::Sphere(Sphere { center, radius }),
            Shape::Circle(Disc { center, normal: Vec3::new(0.4, 1.0, -0.2), radius }),
            Shape::Box(Cuboid { min: center - 0.6, max: center + Vec3::new(0.4, 0.7, 0.9) }),
            Shape::Mesh(Arc::new(mesh)),
            Shape::Cylinder(Cylinder { center, radius, height }),
            Shape::Cone(Cone { center, radius, height }),
        ]
    }

    fn maps() -> [Affine; 5] {
        let turned = |m: Mat3, shift: Vec3| Affine { linear: m, shift };
        let (sin, cos) = (0.6, 0.8);
        let about_y = Mat3::from_cols(Vec3::new(cos, 0.0, -sin), Vec3::Y, Vec3::new(sin, 0.0, cos));
        let about_x = Mat3::from_cols(Vec3::X, Vec3::new(0.0, cos, sin), Vec3::new(0.0, -sin, cos));
        [
            turned(Mat3::IDENTITY, Vec3::new(3.0, 1.0, -2.0)),
            turned(about_y * 2.0, Vec3::new(-1.0, 0.0, 0.5)),
            turned(about_x * 0.5, Vec3::new(0.2, 5.0, 0.0)),
            turned(Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0)), Vec3::ZERO),
            turned(Mat3::from_diagonal(Vec3::new(2.0, 0.5, 2.0)), Vec3::Y),
        ]
    }

    #[test]
    fn a_shape_is_hit_where_the_map_puts_it() {
        let mut moved_shapes = 0;
        for shape in shapes() {
            for map in maps() {
                let Ok(moved) = shape.moved(&map, Structure::Bvh) else { continue };
                moved_shapes += 1;
                let placed = Placed::new(shape.clone(), map).expect("it can be undone");
                for i in 0..200 {
                    let u = |k: u32| ((i * 37 + k * 101) % 211) as f32 / 105.5 - 1.0;
                    let middle = map.point(Vec3::new(0.3, -0.2, 0.5));
                    let from = middle + Vec3::new(u(0), u(1), u(2)) * 4.0;
                    let segment = Segment::new(from, middle + Vec3::new(u(3), u(4), u(5)) * 0.5);
                    let hits = [moved.first_hit(&segment), placed.first_hit(&segment)];
                    let [Some(a), Some(b)] = hits else {
                        // At a rim rounding may decide.
                        continue;
                    };
                    assert!((a.time - b.time).abs() < 1e-4 && (a.normal - b.normal).length() < 1e-3, "{a:?} {b:?}");
                }
            }
        }
        assert!(moved_shapes > 30, "{moved_shapes}");
    }

    #[test]
    fn births_lie_on_the_image_and_leave_it_outward() {
        for shape in shapes().into_iter().filter(|shape| !matches!(shape, Shape::Plane(_))) {
            for map in maps() {
                let Ok(moved) = shape.moved(&map, Structure::Bvh) else { continue };
                let back = map.inverse().expect("it can be undone");
                for i in 0..100u8 {
                    let u = [0.13, 0.29, 0.61].map(|step| (f32::from(i) * step) % 1.0);
                    let spot = moved.sample(u);
                    let there = back.point(spot.point);
                    assert!((shape.nearest(there) - there).length() < 1e-5, "{shape:?} {map:?}");
                    // All of these are convex, and this lies within those that have an inside.
                    let within = map.point(Vec3::new(0.4, -0.1, 0.6));
                    let outward = (spot.point - within).dot(spot.normal) > 0.0;
                    assert!(outward || matches!(shape, Shape::Circle(_) | Shape::Triangle(_)), "{shape:?} {map:?}");
                }
            }
        }
    }

    #[test]
    fn what_would_no_longer_be_round_or_upright_is_refused() {
        let [_, _, sphere, circle, .., cylinder, cone] = shapes();
        let [_, _, tilted, _, squashed] = maps();
        for shape in [&sphere, &circle] {
            assert!(shape.moved(&squashed, Structure::Bvh).is_err());
            assert!(shape.moved(&tilted, Structure::Bvh).is_ok());
        }
        for shape in [&cylinder, &cone] {
            assert!(shape.moved(&squashed, Structure::Bvh).is_ok());
            assert!(shape.moved(&tilted, Structure::Bvh).is_err());
        }
    }
}
