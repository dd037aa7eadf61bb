//! An infinite plane.

use super::{Aabb, Affine, Collider, Contact, Face, Facing, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface};
use crate::math::{clamp, dot, largest, unit};
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
        let side = |point: Vec3| dot(self.normal, point - self.point);
        // What is smaller than rounding is a point. The normal is brought to unit length only for who meets it.
        // Chips are spared the code for who does not.
        let is_point = !cfg!(target_os = "none") && !(segment.radius > segment.slack(largest(self.point)));
        if is_point && crossing(self.normal, side(segment.from), side(segment.to)).is_none() {
            return None;
        }
        Face::new(*self).first_hit(segment)
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        Face::new(*self).contacts(center, reach, at, visit);
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let (middle, half) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min) * 0.5);
        let distance = dot(self.normal, middle - self.point).abs();
        let room = (bounds.min.abs() + bounds.max.abs() + self.point.abs()) * (8.0 * f32::EPSILON);
        // Of what is endless the distance is no number.
        !(distance > dot(self.normal.abs(), half + room))
    }

    fn facing(&self, bounds: &Aabb) -> Facing {
        if self.may_touch(bounds) { Facing::Face(Face::new(*self)) } else { Facing::Nothing }
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
