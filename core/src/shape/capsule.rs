//! A capsule: all that is within a radius of a straight line.

use super::ball::{Filled, circle_span, gap_to_line, leave_circle};
use super::convex::{Convex, Hollow, Span, convex_collider};
use super::{Aabb, Affine, Collider, Segment, Spot, Surface};
use crate::math::{frame, high, largest, length, low, max, sin_cos_turns, sqrt, unit};
use core::f32::consts::PI;
use glam::Vec3;

/// The surface of a capsule, hit from both sides: a cylinder about a straight line, with half a sphere at either end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Capsule {
    /// One end of its axis, the middle of half a sphere \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub from: Vec3,
    /// The other end \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub to: Vec3,
    /// Its radius \[m\].
    pub radius: f32,
}

impl Capsule {
    fn axis(&self) -> Vec3 {
        self.to - self.from
    }

    /// The way to a point from the nearest place of the axis.
    fn offset(&self, point: Vec3) -> Vec3 {
        gap_to_line(point, self.from, self.axis())
    }

    /// The direction away from the axis; on it, one across.
    fn outward(&self, point: Vec3) -> Vec3 {
        let outward = unit(self.offset(point));
        if outward == Vec3::ZERO { frame(self.direction()).0 } else { outward }
    }

    /// The direction of the axis; without a length, up.
    fn direction(&self) -> Vec3 {
        let along = unit(self.axis());
        if along == Vec3::ZERO { Vec3::Y } else { along }
    }
}

impl Surface for Capsule {
    fn area(&self) -> f32 {
        2.0 * PI * self.radius * (length(self.axis()) + 2.0 * self.radius)
    }

    /// The ends together are a sphere, of which each place belongs to the end on its side.
    fn sample(&self, u: [f32; 3]) -> Spot {
        let (sin, cos) = sin_cos_turns(u[1]);
        let along = self.direction();
        let (right, up) = frame(along);
        // Areas over 2πr: the side its length, the ends 2r.
        let side = u[0] * (length(self.axis()) + 2.0 * self.radius) < length(self.axis());
        let (middle, normal) = if side {
            (self.from + self.axis() * u[2], right * cos + up * sin)
        } else {
            let height = 1.0 - 2.0 * u[2];
            let across = sqrt(max(1.0 - height * height, 0.0));
            let normal = along * height + (right * cos + up * sin) * across;
            (if height < 0.0 { self.from } else { self.to }, normal)
        };
        Spot { point: middle + normal * self.radius, normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        point - self.offset(point) + self.outward(point) * self.radius
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: low(self.from, self.to) - self.radius, max: high(self.from, self.to) + self.radius }
    }

    fn around(&self) -> [Vec3; 4] {
        let along = self.direction();
        let (right, up) = frame(along);
        let wide = 2.0 * self.radius;
        let corner = self.from - (along + right + up) * self.radius;
        [corner, self.axis() + along * wide, right * wide, up * wide]
    }

    fn is_inside(&self, point: Vec3) -> bool {
        self.contains(point)
    }
}

impl Convex for Capsule {
    fn contains(&self, point: Vec3) -> bool {
        let offset = self.offset(point);
        offset.dot(offset) < self.radius * self.radius
    }

    /// From the first of its parts that the line enters to the last that it leaves: they are convex together.
    fn span(&self, from: Vec3, step: Vec3) -> Option<Span> {
        let ends = [self.from, self.to].map(|end| circle_span(from - end, step, self.radius));
        let whole = ends.into_iter().chain([self.side(from, step)]).flatten();
        let (enter, leave) = whole.reduce(|(a, b), (c, d)| (if c < a { c } else { a }, max(b, d)))?;
        let normal = |time: f32| self.outward(from + step * time);
        Some(Span { enter, leave, enter_normal: normal(enter), leave_normal: normal(leave) })
    }

    fn normal_by(&self, point: Vec3) -> Vec3 {
        unit(self.offset(point))
    }

    fn reach(&self) -> f32 {
        max(largest(self.from), largest(self.to)) + self.radius
    }
}

impl Capsule {
    /// Where a line runs within the cylinder between the ends.
    fn side(&self, from: Vec3, step: Vec3) -> Option<(f32, f32)> {
        let (along, offset) = (self.direction(), from - self.from);
        let (height, rise) = (offset.dot(along), step.dot(along));
        let slab = Span::slab(height, rise, 0.0, length(self.axis()), along)?;
        let (across, beside) = (offset - along * height, step - along * rise);
        let (enter, leave) = if beside.dot(beside) > 0.0 {
            circle_span(across, beside, self.radius)?
        } else {
            (across.dot(across) < self.radius * self.radius).then_some((f32::NEG_INFINITY, f32::INFINITY))?
        };
        let (enter, leave) = (max(enter, slab.enter), if slab.leave < leave { slab.leave } else { leave });
        (enter <= leave).then_some((enter, leave))
    }
}

impl Filled for Capsule {
    fn gap(&self, point: Vec3) -> Vec3 {
        let offset = self.offset(point);
        unit(offset) * max(length(offset) - self.radius, 0.0)
    }
}

impl Hollow for Capsule {
    /// Where a ball fits is a capsule too, smaller by its radius.
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)> {
        let (from, step) = (segment.from, segment.step());
        let room = Self { radius: max(self.radius - segment.radius, 0.0), ..*self };
        let offset = self.offset(from);
        let is_out = offset.dot(offset) >= room.radius * room.radius;
        if is_out && offset.dot(step) >= 0.0 && step != Vec3::ZERO {
            return Some((0.0, -self.outward(from)));
        }
        let Some(span) = (step != Vec3::ZERO).then(|| room.span(from, step)).flatten() else {
            // It passes by where it would fit: it may go on until it is nearest to that.
            let ends = [self.from, self.to].map(|end| leave_circle(from - end, step, room.radius));
            return ends.into_iter().flatten().reduce(|a, b| if b.0 > a.0 { b } else { a });
        };
        let time = max(span.leave, 0.0);
        (time <= 1.0).then(|| (time, -self.outward(segment.at(time))))
    }

    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32)) {
        visit(-self.outward(point), self.radius - length(self.offset(point)));
    }

    /// Not with ends that are no longer round.
    fn stretched(&self, _: &Affine, _: &mut dyn FnMut(u32, &dyn Collider)) {}
}
convex_collider!(Capsule);
