//! An infinite plane.

use super::ball::leaning;
use super::{Aabb, Affine, Collider, Contact, Crease, Face, Hit, Mapped, Segment, Spot, Surface};
use crate::math::{clamp, dot, largest, max, minus, plus, scaled, unit};
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
    fn moves(&self) -> bool {
        false
    }

    // It has one surface.
    fn crease(&self, _: Vec3, _: f32, _: Time, _: Option<Vec3>) -> Option<Crease> {
        None
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let side = |point: Vec3| dot(self.normal, point - self.point);
        // A ball smaller than rounding is a point. The normal is brought to unit length only for who meets it.
        // Chips are spared the code for who does not.
        let is_point = !cfg!(one_by_one) && !(segment.radius > segment.slack(largest(self.point)));
        if is_point && passage(side(segment.from), side(segment.to)).is_none() {
            return None;
        }
        self.face().first_hit(segment)
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.face().contacts(center, reach, at, visit);
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let (middle, half) = (scaled(plus(bounds.min, bounds.max), 0.5), scaled(minus(bounds.max, bounds.min), 0.5));
        let distance = dot(self.normal, minus(middle, self.point)).abs();
        let room = 8.0 * f32::EPSILON * (largest(bounds.min) + largest(bounds.max) + largest(self.point));
        // The distance of an endless box is no number.
        !(distance > dot(self.normal.abs(), plus(half, Vec3::splat(room))))
    }

    #[cfg(not(target_os = "none"))]
    fn facing(&self, bounds: &Aabb) -> super::Facing {
        if self.may_touch(bounds) { super::Facing::Face(self.face()) } else { super::Facing::Nothing }
    }

    // Chips do not ask, and the table of a plane's functions would have it linked.
    #[cfg(not(target_os = "none"))]
    fn mark_near(&self, hulls: &super::Hulls, marks: &mut super::Marks) {
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
    /// It for many who ask.
    #[cfg_attr(one_by_one, inline(never))]
    fn face(&self) -> Face {
        Face::new(self.point, self.normal)
    }
}

impl Collider for Face {
    fn moves(&self) -> bool {
        false
    }

    // It has one surface.
    fn crease(&self, _: Vec3, _: f32, _: Time, _: Option<Vec3>) -> Option<Crease> {
        None
    }

    #[cfg_attr(not(one_by_one), inline(always))]
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let slack = segment.slack(self.size());
        let center = passed(self, segment);
        // A ball smaller than rounding is a point.
        let ball = if segment.radius > slack { touched(self, segment) } else { None };
        let Passage { time, is_from_below } = match (ball, center) {
            (Some(ball), Some(center)) if !(center.time < ball.time) => ball,
            (ball, center) => center.or(ball)?,
        };
        let [.., unit] = self.vectors();
        let normal = if is_from_below { -unit } else { unit };
        Some(Hit { material: self.material(), ..Hit::new(time, normal, slack) })
    }

    #[cfg_attr(not(one_by_one), inline(always))]
    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let [point, _, unit] = self.vectors();
        let distance = dot(unit, minus(center, point));
        let toward = if distance < 0.0 { -unit } else { unit };
        if let Some(contact) = leaning(center, scaled(unit, distance), toward, [reach, self.size()]) {
            visit(&Contact { material: self.material(), ..contact });
        }
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let [point, normal, _] = self.vectors();
        Plane { point, normal }.may_touch(bounds)
    }
}

/// When a path meets a face, and whether it comes from where the normal does not point to.
#[derive(Clone, Copy)]
struct Passage {
    time: f32,
    is_from_below: bool,
}

/// When a ball first touches a face. One that overlaps it touches at once if it moves nearer, else never.
#[cfg_attr(not(one_by_one), inline(always))]
fn touched(face: &Face, segment: &Segment) -> Option<Passage> {
    let [point, _, unit] = face.vectors();
    let (start, rise) = (dot(unit, minus(segment.from, point)), dot(unit, segment.step()));
    let is_from_below = start < 0.0;
    let (room, closing) = (start.abs() - segment.radius, if is_from_below { rise } else { -rise });
    let time = max(room, 0.0) / closing;
    (closing > 0.0 && time <= 1.0).then_some(Passage { time, is_from_below })
}

/// When a path's centre meets a face.
#[cfg_attr(not(one_by_one), inline(always))]
fn passed(face: &Face, segment: &Segment) -> Option<Passage> {
    let [point, normal, _] = face.vectors();
    // Which side, and when, does not depend on the normal's length.
    let side = |x: Vec3| dot(normal, minus(x, point));
    passage(side(segment.from), side(segment.to))
}

/// When a path with signed distances `before` and `after` to a plane meets it. A point on the plane is on the side its normal points to:
/// it can leave that way freely, and lie there.
#[inline]
fn passage(before: f32, after: f32) -> Option<Passage> {
    let is_from_below = before < 0.0;
    let passes = if is_from_below { after >= 0.0 } else { after <= 0.0 && before > after };
    // The share is no number where distances are not finite, and clamps to zero.
    let time = clamp(before / (before - after), 0.0, 1.0);
    passes.then_some(Passage { time, is_from_below })
}

/// The same, and the normal on the side that the path comes from.
#[inline]
pub(super) fn crossing(normal: Vec3, before: f32, after: f32) -> Option<(f32, Vec3)> {
    passage(before, after).map(|Passage { time, is_from_below }| (time, if is_from_below { -normal } else { normal }))
}
