//! A filled disc.

use super::ball::{Filled, approach, lean};
use super::plane::crossing;
use super::{Aabb, Collider, Contact, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface, earlier};
use crate::math::{along, frame, largest, length, sin_cos_turns, sqrt, unit};
use crate::time::Time;
use core::f32::consts::PI;
use glam::Vec3;

/// A filled disc, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Disc {
    /// Its middle \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub center: Vec3,
    /// Its normal, the side that births leave by, of any length but zero.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub normal: Vec3,
    /// Its radius \[m\].
    pub radius: f32,
}

impl Surface for Disc {
    fn area(&self) -> f32 {
        PI * self.radius * self.radius
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let normal = unit(self.normal);
        let (a, b) = frame(normal);
        let (sin, cos) = sin_cos_turns(u[1]);
        let r = self.radius * sqrt(u[0]);
        Spot { point: along(along(self.center, a, r * cos), b, r * sin), normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let normal = unit(self.normal);
        let offset = point - self.center;
        let flat = offset - normal * normal.dot(offset);
        let r = length(flat);
        self.center + if r > self.radius { flat * (self.radius / r) } else { flat }
    }

    fn bounds(&self) -> Aabb {
        let n = unit(self.normal);
        // A disc reaches r √(1 − nᵢ²) along axis i; the two other squares keep the digits.
        let square = n * n;
        let reach = Vec3::new(square.y + square.z, square.z + square.x, square.x + square.y);
        let reach = Vec3::new(sqrt(reach.x), sqrt(reach.y), sqrt(reach.z)) * self.radius;
        Aabb { min: self.center - reach, max: self.center + reach }
    }
}

impl Collider for Disc {
    fn moves(&self) -> bool {
        false
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.bounds().with_slack().overlaps(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        hulls.near_box(&self.bounds(), marks);
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let slack = segment.slack(largest(self.center) + self.radius);
        let center = self.crossed(segment);
        // A ball smaller than rounding is a point.
        if segment.radius > slack { earlier(approach(self, segment, slack), center) } else { center }
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let gap = self.gap(center);
        let normal = if gap == Vec3::ZERO { unit(self.normal) } else { unit(gap) };
        lean(center, gap, normal, [reach, largest(self.center) + self.radius], visit);
    }
}

impl Mapped for Disc {}

impl Filled for Disc {
    fn gap(&self, point: Vec3) -> Vec3 {
        let (normal, offset) = (unit(self.normal), point - self.center);
        let above = normal * normal.dot(offset);
        let flat = offset - above;
        let r = length(flat);
        if r > self.radius { above + flat * ((r - self.radius) / r) } else { above }
    }
}

impl Disc {
    /// Where the path of a point crosses it.
    fn crossed(&self, segment: &Segment) -> Option<Hit> {
        let normal = unit(self.normal);
        let (time, normal) =
            crossing(normal, normal.dot(segment.from - self.center), normal.dot(segment.to - self.center))?;
        let offset = segment.at(time) - self.center;
        let slack = segment.slack(largest(self.center) + self.radius);
        (offset.dot(offset) <= self.radius * self.radius).then_some(Hit::new(time, normal, slack))
    }
}
