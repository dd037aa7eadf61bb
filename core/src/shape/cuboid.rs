//! The surface of an axis-aligned box.

#[cfg(feature = "alloc")]
use super::Solid;
use super::ball::{Filled, leave_span};
use super::convex::{Convex, Hollow, Span, convex_collider};
use super::{Aabb, Affine, Collider, Placed, Segment, Spot, Surface, Triangle};
use crate::math::{high, largest, max};
use glam::Vec3;

/// The surface of an axis-aligned box, hit from both sides; the corners may be given in any order.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cuboid {
    /// One corner \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub min: Vec3,
    /// The opposite corner \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub max: Vec3,
}

impl Surface for Cuboid {
    fn area(&self) -> f32 {
        let faces = self.faces();
        2.0 * (faces.x + faces.y + faces.z)
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let Aabb { min, max } = self.bounds();
        let faces = self.faces();
        let target = u[0] * (faces.x + faces.y + faces.z);
        // Which pair of faces, and where in its share the number fell: the lower or the upper half.
        let (axis, rest, share) = if target < faces.x {
            (0, target, faces.x)
        } else if target - faces.x < faces.y {
            (1, target - faces.x, faces.y)
        } else {
            (2, target - faces.x - faces.y, faces.z)
        };
        let upper = rest >= share * 0.5;
        let size = max - min;
        let mut point = min;
        let mut normal = Vec3::ZERO;
        point[axis] = if upper { max[axis] } else { min[axis] };
        normal[axis] = if upper { 1.0 } else { -1.0 };
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        point[i] += size[i] * u[1];
        point[j] += size[j] * u[2];
        Spot { point, normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let Aabb { min, max } = self.bounds();
        let mut nearest = point.max(min).min(max);
        if nearest != point {
            return nearest;
        }
        // Inside: go to the nearest face.
        let (mut gap, mut axis, mut face) = (f32::INFINITY, 0, 0.0);
        for i in 0..3 {
            for side in [min[i], max[i]] {
                if (point[i] - side).abs() < gap {
                    (gap, axis, face) = ((point[i] - side).abs(), i, side);
                }
            }
        }
        nearest[axis] = face;
        nearest
    }

    fn bounds(&self) -> Aabb {
        Aabb::around([self.min, self.max])
    }

    fn is_inside(&self, point: Vec3) -> bool {
        self.contains(point)
    }
}

impl Cuboid {
    /// Area of the faces across x, y and z \[m²\].
    fn faces(&self) -> Vec3 {
        let size = (self.max - self.min).abs();
        Vec3::new(size.y * size.z, size.z * size.x, size.x * size.y)
    }
}

impl Convex for Cuboid {
    fn contains(&self, point: Vec3) -> bool {
        let Aabb { min, max } = self.bounds();
        point.cmpgt(min).all() && point.cmplt(max).all()
    }

    fn span(&self, from: Vec3, step: Vec3) -> Option<Span> {
        let Aabb { min, max } = self.bounds();
        Span::slab(from.x, step.x, min.x, max.x, Vec3::X)?
            .and(Span::slab(from.y, step.y, min.y, max.y, Vec3::Y)?)?
            .and(Span::slab(from.z, step.z, min.z, max.z, Vec3::Z)?)
    }

    fn reach(&self) -> f32 {
        max(largest(self.min), largest(self.max))
    }
}

impl Filled for Cuboid {
    fn gap(&self, point: Vec3) -> Vec3 {
        let Aabb { min, max } = self.bounds();
        high(point - max, Vec3::ZERO) - high(min - point, Vec3::ZERO)
    }
}

impl Hollow for Cuboid {
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)> {
        let (Aabb { min, max }, r) = (self.bounds(), segment.radius);
        let (from, step) = (segment.from, segment.step());
        let mut best = None;
        for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            let leave = leave_span(from[axis], step[axis], [min[axis] + r, max[axis] - r]);
            best = super::ball::first(best, leave.map(|(time, way)| (time, unit * -way)));
        }
        best
    }

    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32)) {
        let Aabb { min, max } = self.bounds();
        for (axis, unit) in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().enumerate() {
            visit(unit, point[axis] - min[axis]);
            visit(-unit, max[axis] - point[axis]);
        }
    }

    /// A box, if its edges stay at right angles; else the twelve triangles of a sheared one.
    fn stretched(&self, map: &Affine, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        if let Some((scale, turn)) = map.stretch() {
            let cuboid = Self { min: self.min * scale, max: self.max * scale };
            Placed::new(cuboid, turn).iter().for_each(|placed| visit(0, placed));
            return;
        }
        let Aabb { min, max } = self.bounds();
        for axis in 0..3 {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            for side in [min, max] {
                let corner = |u: Vec3, v: Vec3| {
                    let mut corner = side;
                    (corner[i], corner[j]) = (u[i], v[j]);
                    map.point(corner)
                };
                let [a, b, c, d] = [corner(min, min), corner(max, min), corner(max, max), corner(min, max)];
                visit(0, &Triangle { corners: [a, b, c] });
                visit(0, &Triangle { corners: [a, c, d] });
            }
        }
    }
}
convex_collider!(Cuboid, |cuboid| Solid::Box(cuboid.bounds()));
