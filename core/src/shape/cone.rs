//! A cone about the y axis.

use super::ball::{Filled, first, leave_span};
use super::convex::{Convex, Hollow, Span, convex_collider};
use super::{Aabb, Affine, Collider, Placed, Segment, Spot, Surface, revolve};
use crate::math::{clamp, largest, max, min, sin_cos_turns, sqrt, unit};
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

    fn is_inside(&self, point: Vec3) -> bool {
        self.contains(point)
    }
}

impl Cone {
    /// From the rim to the apex \[m\].
    fn slant(&self) -> f32 {
        sqrt(self.radius * self.radius + self.height * self.height)
    }

    /// Where the line runs inside the infinite cone below the apex, `offset` being measured from the apex.
    ///
    /// It is solved from the place on the line that is nearest to the apex, with heights scaled so that the cone is as wide as high: where the line
    /// grazes the mantle close to the apex, little cancels, from however far off it comes.
    fn mantle(&self, offset: Vec3, step: Vec3) -> Option<Span> {
        let k = self.radius / self.height;
        let product = |a: Vec3, b: Vec3| a.x * b.x + a.z * b.z - k * k * a.y * b.y;
        let along = |a: Vec3| a.x * step.x + a.z * step.z + k * k * a.y * step.y;
        let middle = -along(offset) / along(step);
        let middle = if middle.is_finite() { middle } else { 0.0 };
        let nearest = offset + step * middle;
        let (a, b, c) = (product(step, step), product(nearest, step), product(nearest, nearest));
        let square = b * b - a * c;
        // A line steeper than the mantle cannot miss it, though rounding may say so near the apex.
        let square = if a < 0.0 { max(square, f32::MIN_POSITIVE) } else { square };
        let below = |t: f32| nearest.y + step.y * t < 0.0;
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
            let p = nearest + step * t;
            unit(Vec3::new(p.x, -k * k * p.y, p.z))
        };
        let at = |t: f32| if t.is_finite() { normal(t) } else { Vec3::ZERO };
        Some(Span { enter: middle + near, leave: middle + far, enter_normal: at(near), leave_normal: at(far) })
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

    fn normal_by(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        let ((around, out), below) = (polar(offset), -0.5 * self.height - offset.y);
        let normal = (around * self.height + Vec3::Y * self.radius) / self.slant();
        let beside = ((out - self.radius) * self.height - below * self.radius) / self.slant();
        match () {
            () if below > beside => Vec3::NEG_Y,
            () if around == Vec3::ZERO => Vec3::ZERO,
            () => normal,
        }
    }

    fn reach(&self) -> f32 {
        largest(self.center) + self.radius + self.height
    }
}

impl Filled for Cone {
    fn gap(&self, point: Vec3) -> Vec3 {
        let offset = point - self.center;
        let (around, out) = polar(offset);
        let (r, half) = (self.radius, 0.5 * self.height);
        // In the plane of the axis, measured from the rim: the way along the mantle, and off it.
        let rim = Vec2::new(out - r, offset.y + half);
        let along = Vec2::new(-r, self.height) / self.slant();
        let (way, off) = (rim.dot(along), rim.x * along.y - rim.y * along.x);
        if off <= 0.0 && rim.y >= 0.0 {
            return Vec3::ZERO;
        }
        let on_mantle = 0.0 < way && way < self.slant();
        let to_mantle =
            if on_mantle { Vec2::new(along.y, -along.x) * off } else { rim - along * clamp(way, 0.0, self.slant()) };
        let to_base = Vec2::new(max(rim.x, 0.0), rim.y);
        let nearest = if to_base.dot(to_base) < to_mantle.dot(to_mantle) { to_base } else { to_mantle };
        around * nearest.x + Vec3::Y * nearest.y
    }
}

impl Hollow for Cone {
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)> {
        let (offset, step) = (segment.from - self.center, segment.step());
        let (half, slant) = (0.5 * self.height, self.slant());
        // One larger than the largest that fits is held where that would be.
        let r = min(segment.radius, self.radius * self.height / (self.radius + slant));
        let base = leave_span(offset.y, step.y, [r - half, f32::INFINITY]).map(|(time, way)| (time, Vec3::Y * -way));
        let apex = Vec3::Y * (half - r * (slant / self.radius));
        first(base, self.leave_mantle(offset - apex, step))
    }

    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32)) {
        let offset = point - self.center;
        visit(self.inward(offset), self.depth(offset - Vec3::Y * (0.5 * self.height)));
        visit(Vec3::Y, 0.5 * self.height + offset.y);
    }

    /// One that stays round and upright on its base, taller or flatter.
    fn stretched(&self, map: &Affine, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        let Some((scale, turn)) = map.stretch().filter(|_| map.keeps_bases()) else { return };
        let round = Self { center: self.center * scale, radius: self.radius * scale.x, height: self.height * scale.y };
        Placed::new(round, turn).iter().for_each(|placed| visit(0, placed));
    }
}
convex_collider!(Cone);

impl Cone {
    /// How deep a point lies below the mantle \[m\], measured from the apex.
    fn depth(&self, offset: Vec3) -> f32 {
        -(polar(offset).1 * self.height + offset.y * self.radius) / self.slant()
    }

    /// The unit normal of the mantle, inward, beside a point measured from the axis.
    fn inward(&self, offset: Vec3) -> Vec3 {
        -unit(polar(offset).0 * self.height + Vec3::Y * self.radius)
    }

    /// When what moves from `offset` by `step`, measured from the apex, comes out of the mantle. Outside of it at first,
    /// it does so as soon as it moves away.
    fn leave_mantle(&self, offset: Vec3, step: Vec3) -> Option<(f32, Vec3)> {
        let inward = self.inward(offset);
        if self.depth(offset) <= 0.0 {
            if step.dot(inward) <= 0.0 {
                return Some((0.0, inward));
            }
            // Should it pass by without ever fitting, it may as long as it does not get in deeper.
            if self.mantle(offset, step).is_none_or(|span| span.leave < 0.0) {
                return (self.depth(offset + step) < self.depth(offset)).then_some((0.0, inward));
            }
        }
        let time = max(self.mantle(offset, step)?.leave, 0.0);
        (time <= 1.0).then(|| (time, self.inward(offset + step * time)))
    }
}

/// The unit vector away from the y axis, and the distance to it.
fn polar(offset: Vec3) -> (Vec3, f32) {
    let side = Vec3::new(offset.x, 0.0, offset.z);
    let out = sqrt(side.dot(side));
    (if out > 0.0 { side / out } else { Vec3::X }, out)
}
