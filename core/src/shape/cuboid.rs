//! The surface of an axis-aligned box.

use super::convex::{Convex, Span, convex_collider};
use super::{Aabb, Spot, Surface};
use crate::math::{largest, max};
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
convex_collider!(Cuboid);
