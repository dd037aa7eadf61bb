//! A cylinder about the y axis.

use super::ball::{Filled, circle_span, first, leave_circle, leave_span};
use super::convex::{Convex, Hollow, Span, convex_collider};
use super::{Aabb, Affine, Collider, Placed, Segment, Spot, Surface, revolve};
use crate::math::{largest, length, max, sin_cos_turns, sqrt, unit};
use core::f32::consts::PI;
use glam::{Vec2, Vec3};

/// A cylinder about the y axis with its two caps, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cylinder {
    /// The middle of its axis \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub center: Vec3,
    /// Its radius \[m\].
    pub radius: f32,
    /// Its height \[m\].
    pub height: f32,
}

impl Surface for Cylinder {
    fn area(&self) -> f32 {
        2.0 * PI * self.radius * (self.radius + self.height)
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let (sin, cos) = sin_cos_turns(u[1]);
        let around = Vec3::new(cos, 0.0, sin);
        // Areas over 2πr: the side h, each cap r / 2.
        let target = u[0] * (self.height + self.radius);
        let half = 0.5 * self.height;
        let (offset, normal) = if target < self.height {
            (around * self.radius + Vec3::Y * (self.height * u[2] - half), around)
        } else {
            let up = if target - self.height < 0.5 * self.radius { Vec3::NEG_Y } else { Vec3::Y };
            (around * (self.radius * sqrt(u[2])) + up * half, up)
        };
        Spot { point: self.center + offset, normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let (r, h) = (self.radius, 0.5 * self.height);
        revolve::nearest(
            self.center,
            point,
            &[Vec2::new(0.0, -h), Vec2::new(r, -h), Vec2::new(r, h), Vec2::new(0.0, h)],
        )
    }

    fn bounds(&self) -> Aabb {
        let reach = Vec3::new(self.radius, 0.5 * self.height, self.radius);
        Aabb { min: self.center - reach, max: self.center + reach }
    }

    fn is_inside(&self, point: Vec3) -> bool {
        self.contains(point)
    }
}

impl Convex for Cylinder {
    fn contains(&self, point: Vec3) -> bool {
        let o = point - self.center;
        o.x * o.x + o.z * o.z < self.radius * self.radius && o.y.abs() < 0.5 * self.height
    }

    fn span(&self, from: Vec3, step: Vec3) -> Option<Span> {
        let offset = from - self.center;
        let half = 0.5 * self.height;
        let slab = Span::slab(offset.y, step.y, -half, half, Vec3::Y)?;
        let (offset, step) = (flat(offset), flat(step));
        if step == Vec3::ZERO {
            return (offset.dot(offset) < self.radius * self.radius).then_some(slab);
        }
        let (enter, leave) = circle_span(offset, step, self.radius)?;
        let normal = |t: f32| unit(offset + step * t);
        slab.and(Span { enter, leave, enter_normal: normal(enter), leave_normal: normal(leave) })
    }

    fn normal_by(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        let (side, above) = (flat(offset), offset.y.abs() - 0.5 * self.height);
        if length(side) - self.radius >= above {
            unit(side)
        } else {
            Vec3::new(0.0, if offset.y < 0.0 { -1.0 } else { 1.0 }, 0.0)
        }
    }

    fn reach(&self) -> f32 {
        largest(self.center) + self.radius + self.height
    }
}

impl Filled for Cylinder {
    fn gap(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        let (side, half) = (flat(offset), 0.5 * self.height);
        let above = max(offset.y.abs() - half, 0.0);
        let beside = max(length(side) - self.radius, 0.0);
        unit(side) * beside + Vec3::Y * if offset.y < 0.0 { -above } else { above }
    }
}

impl Hollow for Cylinder {
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)> {
        let (offset, step) = (segment.from - self.center, segment.step());
        let half = 0.5 * self.height - segment.radius;
        let caps = leave_span(offset.y, step.y, [-half, half]).map(|(time, way)| (time, Vec3::Y * -way));
        first(caps, leave_circle(flat(offset), flat(step), max(self.radius - segment.radius, 0.0)))
    }

    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32)) {
        let offset = point - self.center;
        let (side, half) = (flat(offset), 0.5 * self.height);
        visit(if side == Vec3::ZERO { Vec3::X } else { -unit(side) }, self.radius - length(side));
        visit(Vec3::Y, half + offset.y);
        visit(Vec3::NEG_Y, half - offset.y);
    }

    /// One that stays round and upright on its base, taller or flatter.
    fn stretched(&self, map: &Affine, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        let Some((scale, turn)) = map.stretch().filter(|_| map.keeps_bases()) else { return };
        let round = Self { center: self.center * scale, radius: self.radius * scale.x, height: self.height * scale.y };
        Placed::new(round, turn).iter().for_each(|placed| visit(0, placed));
    }
}
convex_collider!(Cylinder);

/// Without its height.
fn flat(v: Vec3) -> Vec3 {
    Vec3::new(v.x, 0.0, v.z)
}
