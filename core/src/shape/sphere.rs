//! The surface of a sphere.

#[cfg(feature = "alloc")]
use super::Solid;
use super::ball::{Filled, circle_span, leave_circle};
use super::convex::{Convex, Hollow, Span, convex_collider};
use super::{Aabb, Affine, Collider, Segment, Spot, Surface};
use crate::math::{largest, length, max, sin_cos_turns, sqrt, unit};
use core::f32::consts::PI;
use glam::Vec3;

/// The surface of a sphere, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sphere {
    /// Its middle \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub center: Vec3,
    /// Its radius \[m\].
    pub radius: f32,
}

impl Surface for Sphere {
    fn area(&self) -> f32 {
        4.0 * PI * self.radius * self.radius
    }

    /// Archimedes: the height of a uniform point is uniform.
    fn sample(&self, u: [f32; 3]) -> Spot {
        let y = 1.0 - 2.0 * u[0];
        let r = sqrt(max(1.0 - y * y, 0.0));
        let (sin, cos) = sin_cos_turns(u[1]);
        let normal = Vec3::new(r * cos, y, r * sin);
        Spot { point: self.center + normal * self.radius, normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        self.center + if offset == Vec3::ZERO { Vec3::Y } else { unit(offset) } * self.radius
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }

    fn is_inside(&self, point: Vec3) -> bool {
        self.contains(point)
    }
}

impl Convex for Sphere {
    fn contains(&self, point: Vec3) -> bool {
        let offset = point - self.center;
        offset.dot(offset) < self.radius * self.radius
    }

    fn span(&self, from: Vec3, step: Vec3) -> Option<Span> {
        let offset = from - self.center;
        let (enter, leave) = circle_span(offset, step, self.radius)?;
        let normal = |t: f32| unit(offset + step * t);
        Some(Span { enter, leave, enter_normal: normal(enter), leave_normal: normal(leave) })
    }

    fn normal_by(&self, point: Vec3) -> Vec3 {
        unit(point - self.center)
    }

    fn reach(&self) -> f32 {
        largest(self.center) + self.radius
    }
}

impl Filled for Sphere {
    fn gap(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        unit(offset) * max(length(offset) - self.radius, 0.0)
    }
}

impl Hollow for Sphere {
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)> {
        leave_circle(segment.from - self.center, segment.step(), max(self.radius - segment.radius, 0.0))
    }

    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32)) {
        let offset = point - self.center;
        let inward = if offset == Vec3::ZERO { Vec3::NEG_Y } else { -unit(offset) };
        visit(inward, self.radius - length(offset));
    }

    /// Not of an ellipsoid.
    fn stretched(&self, _: &Affine, _: &mut dyn FnMut(u32, &dyn Collider)) {}
}
convex_collider!(Sphere, |sphere| Solid::Sphere { center: sphere.center, radius: sphere.radius });
