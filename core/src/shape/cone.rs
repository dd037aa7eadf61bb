//! A cone about the y axis.

use super::convex::{Convex, Span, convex_collider};
use super::{Aabb, Spot, Surface, revolve};
use crate::math::{largest, max, sin_cos_turns, sqrt, unit};
use core::f32::consts::PI;
use glam::{Vec2, Vec3};

/// A cone about the y axis with its base below and its apex above, hit from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cone {
    /// The middle of its axis \[m\]: the base lies half the height below, the apex half the height above.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub center: Vec3,
    /// The radius of its base \[m\].
    pub radius: f32,
    /// Its height \[m\].
    pub height: f32,
}

impl Surface for Cone {
    fn area(&self) -> f32 {
        PI * self.radius * (self.radius + self.slant())
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let (sin, cos) = sin_cos_turns(u[1]);
        let around = Vec3::new(cos, 0.0, sin);
        // Both the base and the mantle grow with the square of the distance from their middle.
        let out = sqrt(u[2]);
        let half = 0.5 * self.height;
        let (y, normal) = if u[0] * (self.radius + self.slant()) < self.radius {
            (-half, Vec3::NEG_Y)
        } else {
            (half - self.height * out, unit(around * self.height + Vec3::Y * self.radius))
        };
        Spot { point: self.center + around * (self.radius * out) + Vec3::Y * y, normal }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let (r, h) = (self.radius, 0.5 * self.height);
        revolve::nearest(self.center, point, &[Vec2::new(0.0, -h), Vec2::new(r, -h), Vec2::new(0.0, h)])
    }

    fn bounds(&self) -> Aabb {
        let reach = Vec3::new(self.radius, 0.5 * self.height, self.radius);
        Aabb { min: self.center - reach, max: self.center + reach }
    }
}

impl Cone {
    /// From the rim to the apex \[m\].
    fn slant(&self) -> f32 {
        sqrt(self.radius * self.radius + self.height * self.height)
    }

    /// Where the line runs inside the infinite cone below the apex, `offset` being measured from the apex.
    fn mantle(&self, offset: Vec3, step: Vec3) -> Option<Span> {
        let k = self.radius / self.height;
        let product = |a: Vec3, b: Vec3| a.x * b.x + a.z * b.z - k * k * a.y * b.y;
        let (a, b, c) = (product(step, step), product(offset, step), product(offset, offset));
        let square = b * b - a * c;
        // A line steeper than the mantle cannot miss it, though rounding may say so near the apex.
        let square = if a < 0.0 { max(square, f32::MIN_POSITIVE) } else { square };
        let below = |t: f32| offset.y + step.y * t < 0.0;
        let (near, far) = if !(square > 0.0) {
            return None;
        } else if a == 0.0 {
            // Parallel to the mantle: one crossing.
            let t = -0.5 * c / b;
            if b > 0.0 { (f32::NEG_INFINITY, t) } else { (t, f32::INFINITY) }
        } else {
            // The form of the roots that subtracts nothing from its like.
            let q = -(b + if b < 0.0 { -sqrt(square) } else { sqrt(square) });
            let (s, t) = (q / a, if q == 0.0 { 0.0 } else { c / q });
            let (s, t) = if s < t { (s, t) } else { (t, s) };
            if a > 0.0 {
                // Steeper than the mantle's complement: in one nappe between the roots.
                if !below(0.5 * (s + t)) {
                    return None;
                }
                (s, t)
            } else if step.y < 0.0 {
                (t, f32::INFINITY)
            } else {
                (f32::NEG_INFINITY, s)
            }
        };
        let normal = |t: f32| {
            let p = offset + step * t;
            unit(Vec3::new(p.x, -k * k * p.y, p.z))
        };
        let at = |t: f32| if t.is_finite() { normal(t) } else { Vec3::ZERO };
        Some(Span { enter: near, leave: far, enter_normal: at(near), leave_normal: at(far) })
    }
}

impl Convex for Cone {
    fn contains(&self, point: Vec3) -> bool {
        let o = point - self.center;
        let half = 0.5 * self.height;
        let r = self.radius * ((half - o.y) / self.height);
        o.y.abs() < half && o.x * o.x + o.z * o.z < r * r
    }

    fn span(&self, from: Vec3, step: Vec3) -> Option<Span> {
        let half = 0.5 * self.height;
        let offset = from - self.center;
        let slab = Span::slab(offset.y, step.y, -half, half, Vec3::Y)?;
        slab.and(self.mantle(offset - Vec3::Y * half, step)?)
    }

    fn reach(&self) -> f32 {
        largest(self.center) + self.radius + self.height
    }
}
convex_collider!(Cone);
