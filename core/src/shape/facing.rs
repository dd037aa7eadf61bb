//! What of a collider is near: nothing, one flat face that stands still, or more than that.

use super::ball::lean;
use super::plane::crossing;
use super::{Aabb, Collider, Contact, Hit, Plane, Segment, earlier};
use crate::math::{dot, largest, max, unit};
use crate::time::Time;
use glam::Vec3;

/// What of a collider a path inside a box can meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Facing {
    /// Nothing.
    #[default]
    Nothing,
    /// One flat face, which is met as the collider itself would be, to the bit.
    Face(Face),
    /// Anything.
    Several,
}

impl Facing {
    /// What two colliders together are.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, one) | (one, Self::Nothing) => one,
            _ => Self::Several,
        }
    }

    /// The same, of the scene's material with this number.
    #[must_use]
    pub fn made_of(self, material: Option<u16>) -> Self {
        match self {
            Self::Face(face) => Self::Face(Face { material, ..face }),
            other => other,
        }
    }
}

/// A plane that stands still, ready for many who ask: what runs over floors and walls most of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    plane: Plane,
    /// Its normal at unit length, and the largest of its point's coordinates.
    unit: Vec3,
    size: f32,
    material: Option<u16>,
}

impl Face {
    /// A plane, of no material.
    #[must_use]
    pub fn new(plane: Plane) -> Self {
        Self { plane, unit: unit(plane.normal), size: largest(plane.point), material: None }
    }

    /// A point of it, its normal as given, and that at unit length.
    #[must_use]
    pub(crate) const fn vectors(&self) -> [Vec3; 3] {
        [self.plane.point, self.plane.normal, self.unit]
    }

    /// The largest of its point's coordinates.
    #[must_use]
    pub(crate) const fn size(&self) -> f32 {
        self.size
    }

    /// The number of its material in the scene, if it has one.
    #[must_use]
    pub(crate) const fn material(&self) -> Option<u16> {
        self.material
    }

    /// When a ball first touches it. One that overlaps it touches at once if it moves nearer, else never.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn touched(&self, segment: &Segment, slack: f32) -> Option<Hit> {
        let start = dot(self.unit, segment.from - self.plane.point);
        let normal = if start < 0.0 { -self.unit } else { self.unit };
        let (room, closing) = (start.abs() - segment.radius, -dot(normal, segment.step()));
        let time = max(room, 0.0) / closing;
        (closing > 0.0 && time <= 1.0).then(|| Hit::new(time, normal, slack))
    }

    /// Where a path's centre meets it, and the normal on the side that it comes from.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn passed(&self, segment: &Segment, slack: f32) -> Option<Hit> {
        // Which side, and when, does not depend on the normal's length.
        let side = |point: Vec3| dot(self.plane.normal, point - self.plane.point);
        crossing(self.unit, side(segment.from), side(segment.to)).map(|(time, normal)| Hit::new(time, normal, slack))
    }
}

impl Collider for Face {
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let slack = segment.slack(self.size);
        let center = self.passed(segment, slack);
        // What is smaller than rounding is a point.
        let hit = if segment.radius > slack { earlier(self.touched(segment, slack), center) } else { center };
        hit.map(|hit| Hit { material: self.material, ..hit })
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let distance = dot(self.unit, center - self.plane.point);
        let toward = if distance < 0.0 { -self.unit } else { self.unit };
        let made = &mut |contact: &Contact| visit(&Contact { material: self.material, ..*contact });
        lean(center, self.unit * distance, toward, [reach, self.size], made);
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.plane.may_touch(bounds)
    }
}
