//! An infinite plane.

use super::ball::lean;
use super::{Aabb, Affine, Collider, Contact, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface, earlier};
use crate::math::{clamp, dot, largest, max, unit};
use crate::time::Time;
use glam::Vec3;

/// An infinite plane, hit from both sides. It cannot give birth: all of `sample` is its point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Plane {
    /// A point of it \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub point: Vec3,
    /// Its normal, of any length but zero.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub normal: Vec3,
}

impl Surface for Plane {
    fn area(&self) -> f32 {
        f32::INFINITY
    }

    fn sample(&self, _: [f32; 3]) -> Spot {
        Spot { point: self.point, normal: unit(self.normal) }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let normal = unit(self.normal);
        point - normal * dot(normal, point - self.point)
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY }
    }
}

impl Collider for Plane {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        // Which side, and when, does not depend on the normal's length.
        let side = |point: Vec3| dot(self.normal, point - self.point);
        let slack = segment.slack(largest(self.point));
        let center = crossing(self.normal, side(segment.from), side(segment.to));
        let center = center.map(|(time, normal)| Hit::new(time, unit(normal), slack));
        // What is smaller than rounding is a point.
        if segment.radius > slack { earlier(self.touched(segment, slack), center) } else { center }
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let normal = unit(self.normal);
        let distance = dot(normal, center - self.point);
        let toward = if distance < 0.0 { -normal } else { normal };
        lean(center, normal * distance, toward, [reach, largest(self.point)], visit);
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let (middle, half) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min) * 0.5);
        let distance = dot(self.normal, middle - self.point).abs();
        let room = (bounds.min.abs() + bounds.max.abs() + self.point.abs()) * (8.0 * f32::EPSILON);
        distance <= dot(self.normal.abs(), half + room)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        hulls.near_plane(self.point, self.normal, marks);
    }
}

impl Mapped for Plane {
    fn image(&self, map: &Affine, _: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        if let Some(back) = map.inverse() {
            visit(0, &Self { point: map.point(self.point), normal: unit(back.linear.transpose() * self.normal) });
        }
    }
}

impl Plane {
    /// Where a ball first touches it. One that overlaps it touches at once if it moves nearer, else never.
    fn touched(&self, segment: &Segment, slack: f32) -> Option<Hit> {
        let normal = unit(self.normal);
        let start = dot(normal, segment.from - self.point);
        let normal = if start < 0.0 { -normal } else { normal };
        let (room, closing) = (start.abs() - segment.radius, -dot(normal, segment.step()));
        let time = max(room, 0.0) / closing;
        (closing > 0.0 && time <= 1.0).then(|| Hit::new(time, normal, slack))
    }
}

/// When a path with signed distances `before` and `after` to a plane meets it, and the normal on the side it comes
/// from. A point on the plane is on the side its normal points to: it can leave that way freely, and lie there.
#[inline]
pub(super) fn crossing(normal: Vec3, before: f32, after: f32) -> Option<(f32, Vec3)> {
    // Of distances that are not finite the share is no number, which clamps to zero.
    let time = clamp(before / (before - after), 0.0, 1.0);
    if before >= 0.0 && after <= 0.0 && before > after {
        Some((time, normal))
    } else if before < 0.0 && after >= 0.0 {
        Some((time, -normal))
    } else {
        None
    }
}
