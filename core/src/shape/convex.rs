//! First hits on closed convex solids: shapes say what is inside and where a line runs inside; the rest is here, once.

use super::ball::{Filled, approach, lean};
use super::{Affine, Collider, Contact, Hit, Segment, earlier};
use crate::math::{clamp, is_zero, unit};
use glam::Vec3;

/// A closed convex solid.
pub(super) trait Convex {
    /// Tells whether `point` lies strictly inside; a pure function of the point, so that two paths that share an end
    /// agree.
    fn contains(&self, point: Vec3) -> bool;

    /// Where the line `from` + t × `step` runs inside, if anywhere; `step` is not zero.
    fn span(&self, from: Vec3, step: Vec3) -> Option<Span>;

    /// The outward unit normal of its surface by a point that is within rounding of that, where it is smooth; else none.
    fn normal_by(&self, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }

    /// How far its surface reaches from the origin \[m\], about.
    fn reach(&self) -> f32;
}

/// The part of a line inside a solid: its ends and the outward unit normals there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) enter: f32,
    pub(super) leave: f32,
    pub(super) enter_normal: Vec3,
    pub(super) leave_normal: Vec3,
}

impl Span {
    /// The whole line.
    pub(super) const ALL: Self =
        Self { enter: f32::NEG_INFINITY, leave: f32::INFINITY, enter_normal: Vec3::ZERO, leave_normal: Vec3::ZERO };

    /// The part that two spans share, if any.
    pub(super) fn and(self, other: Self) -> Option<Self> {
        let (enter, enter_normal) =
            if other.enter > self.enter { (other.enter, other.enter_normal) } else { (self.enter, self.enter_normal) };
        let (leave, leave_normal) =
            if other.leave < self.leave { (other.leave, other.leave_normal) } else { (self.leave, self.leave_normal) };
        (enter <= leave).then_some(Self { enter, leave, enter_normal, leave_normal })
    }

    /// Where a line with coordinate `from` + t × `step` lies between `low` and `high` along `axis`.
    pub(super) fn slab(from: f32, step: f32, low: f32, high: f32, axis: Vec3) -> Option<Self> {
        if step == 0.0 {
            return (low < from && from < high).then_some(Self::ALL);
        }
        let (a, b) = ((low - from) / step, (high - from) / step);
        Some(if step > 0.0 {
            Self { enter: a, leave: b, enter_normal: -axis, leave_normal: axis }
        } else {
            Self { enter: b, leave: a, enter_normal: axis, leave_normal: -axis }
        })
    }
}

/// A closed convex solid that a ball can also be inside of.
pub(super) trait Hollow: Filled + Convex {
    /// When a ball that starts inside first touches, and the unit normal inward there. One too large to fit is free to
    /// move toward the middle only.
    fn leave(&self, segment: &Segment) -> Option<(f32, Vec3)>;

    /// Visits the walls around a point inside: the unit normal inward and the distance.
    fn walls(&self, point: Vec3, visit: &mut dyn FnMut(Vec3, f32));

    /// As `Collider::image`.
    fn stretched(&self, map: &Affine, visit: &mut dyn FnMut(u32, &dyn Collider));
}

/// The first hit of a segment on a convex solid, from outside or from inside.
///
/// Which side an end lies on is decided by `contains` alone, so that what a particle crosses it also hits, whatever
/// the rounding of the crossing's time.
pub(super) fn first_hit(solid: &impl Convex, segment: &Segment) -> Option<Hit> {
    let step = segment.step();
    let (starts_inside, ends_inside) = (solid.contains(segment.from), solid.contains(segment.to));
    if step == Vec3::ZERO || (starts_inside && ends_inside) {
        return None;
    }
    let slack = segment.slack(solid.reach());
    // A line may run within rounding of the surface, so that it seems to miss, or to be met from behind. At an apex or a rim the normal may be none:
    // then the way back has to do.
    let grazed = || match solid.normal_by(segment.from) {
        Vec3::ZERO => -unit(step),
        normal if starts_inside => -normal,
        normal => normal,
    };
    let Some(span) = solid.span(segment.from, step) else {
        return (starts_inside != ends_inside).then(|| Hit::new(0.0, grazed(), slack));
    };
    let facing = |normal: Vec3| if step.dot(normal) < 0.0 { normal } else { grazed() };
    let hit = |time, normal| Some(Hit::new(clamp(time, 0.0, 1.0), facing(normal), slack));
    match (starts_inside, ends_inside) {
        (true, _) => hit(span.leave, -span.leave_normal),
        (false, true) => hit(span.enter, span.enter_normal),
        // Straight through. A start within rounding of the surface may seem inside the span: it enters if the
        // entrance is the nearer end, and else it leaves.
        (false, false) => {
            let ahead = span.enter > 0.0 || -span.enter < span.leave;
            if ahead && span.enter <= 1.0 { hit(span.enter, span.enter_normal) } else { None }
        }
    }
}

/// The first hit of a segment on a hollow solid. Where rounding should fool the ball, its centre is still stopped.
#[inline(never)]
pub(super) fn ball_first_hit(solid: &impl Hollow, segment: &Segment) -> Option<Hit> {
    let center = first_hit(solid, segment);
    let slack = segment.slack(solid.reach());
    // A ball smaller than rounding is a point.
    if !(segment.radius > slack) {
        return center;
    }
    let ball = if solid.contains(segment.from) {
        solid.leave(segment).map(|(time, normal)| Hit::new(time, normal, slack))
    } else {
        approach(solid, segment, slack)
    };
    earlier(ball, center)
}

/// Visits the places of a hollow solid that a ball leans on.
pub(super) fn ball_contacts(solid: &impl Hollow, center: Vec3, reach: f32, visit: &mut dyn FnMut(&Contact)) {
    let all = [reach, solid.reach()];
    if solid.contains(center) {
        return solid.walls(center, &mut |normal, distance| lean(center, normal * distance, normal, all, visit));
    }
    let gap = solid.gap(center);
    let normal = if is_zero(gap) { outward(solid, center) } else { unit(gap) };
    lean(center, gap, normal, all, visit);
}

/// The normal of the face on which a point lies to the last bit, and which no gap shows.
fn outward(solid: &impl Hollow, point: Vec3) -> Vec3 {
    let mut nearest = (f32::INFINITY, Vec3::ZERO);
    solid.walls(point, &mut |normal, distance| {
        if distance < nearest.0 {
            nearest = (distance, -normal);
        }
    });
    nearest.1
}

/// Implements `Collider` for convex solids.
macro_rules! convex_collider {
    ($solid:ty $(, $as_solid:expr)?) => {
        impl crate::shape::Collider for $solid {
            fn moves(&self) -> bool {
                false
            }
            $(#[cfg(feature = "alloc")]
            fn solid(&self) -> Option<crate::shape::Solid> {
                let as_solid: fn(&Self) -> crate::shape::Solid = $as_solid;
                Some(as_solid(self))
            })?
            fn first_hit(&self, segment: &crate::shape::Segment) -> Option<crate::shape::Hit> {
                if segment.radius > 0.0 {
                    return crate::shape::convex::ball_first_hit(self, segment);
                }
                crate::shape::convex::first_hit(self, segment)
            }
            fn contacts(
                &self,
                center: glam::Vec3,
                reach: f32,
                _: crate::time::Time,
                visit: &mut dyn FnMut(&crate::shape::Contact),
            ) {
                crate::shape::convex::ball_contacts(self, center, reach, visit);
            }
            fn may_touch(&self, bounds: &crate::shape::Aabb) -> bool {
                crate::shape::Surface::bounds(self).with_slack().overlaps(bounds)
            }
            fn mark_near(&self, hulls: &crate::shape::Hulls, marks: &mut crate::shape::Marks) {
                hulls.near_box(&crate::shape::Surface::bounds(self), marks);
            }
        }
        impl crate::shape::Mapped for $solid {
            fn image(
                &self,
                map: &crate::shape::Affine,
                _: &crate::shape::Aabb,
                visit: &mut dyn FnMut(u32, &dyn crate::shape::Collider),
            ) {
                crate::shape::convex::Hollow::stretched(self, map, visit);
            }
        }
    };
}
pub(super) use convex_collider;
