//! Balls: where one that moves first touches a shape, and where one that stands leans on it.
//!
//! The distance of a point to a convex set is a convex function of it, so along a straight path Newton's method comes
//! from afar nearer and nearer to the first contact and never past it. From inside a hollow solid the places where a
//! ball fits are the same solid, smaller by the radius, which the path leaves where the ball touches.

use super::{Contact, Hit, Segment};
use crate::math::{clamp, dot, is_zero, largest, length, max, minus, sqrt, unit};
use glam::Vec3;

/// The largest number of times that Newton's method looks again.
///
/// Each time the product of the distance that is left and the speed of approach falls to a quarter or less (both are
/// parts of what they were, and the parts sum to one at the most). So at the end the ball is within 2⁻²⁴ of its first
/// distance, or comes nearer by less than 2⁻²⁴ of its way: it touches within rounding, and that is taken for a hit.
const MAX_STEPS: u32 = 24;

/// A closed convex set, flat or solid.
pub(super) trait Filled {
    /// The way to `point` from the place of the set that is nearest to it; zero for what lies in the set.
    fn gap(&self, point: Vec3) -> Vec3;
}

/// Where a ball outside first touches a set. One that overlaps it touches at once if it moves nearer, else never.
#[inline]
pub(super) fn approach(set: &impl Filled, segment: &Segment, slack: f32) -> Option<Hit> {
    let step = segment.step();
    let mut time = 0.0;
    for looks in 0..=MAX_STEPS {
        let gap = set.gap(segment.at(time));
        let distance = length(gap);
        // Without a distance there is no direction either: NaN, which is no approach.
        let normal = gap / distance;
        let closing = -step.dot(normal);
        if !(closing > 0.0) {
            return None;
        }
        let left = distance - segment.radius;
        let next = time + left / closing;
        if left > 0.5 * slack && !(next <= 1.0) {
            return None;
        }
        if left <= 0.5 * slack || looks == MAX_STEPS {
            return Some(Hit::new(time, normal, slack));
        }
        time = next;
    }
    None
}

/// Visits the nearest place of a set, on which a ball outside leans, if it is within reach. A centre in the set has no
/// side.
pub(super) fn lean_on(set: &impl Filled, center: Vec3, reach: [f32; 2], visit: &mut dyn FnMut(&Contact)) {
    let gap = set.gap(center);
    lean(center, gap, unit(gap), reach, visit);
}

/// Visits the place that a ball leans on, if there is one.
pub(super) fn lean(center: Vec3, gap: Vec3, normal: Vec3, reach: [f32; 2], visit: &mut dyn FnMut(&Contact)) {
    leaning(center, gap, normal, reach).iter().for_each(visit);
}

/// The place `gap` before `center`, if it is within reach and there is a normal; the surface itself reaches so far from the origin.
pub(super) fn leaning(center: Vec3, gap: Vec3, normal: Vec3, [reach, size]: [f32; 2]) -> Option<Contact> {
    let distance = dot(gap, normal);
    if !(distance <= reach) || is_zero(normal) {
        return None;
    }
    let slack = Segment::slack_within(largest(center), distance, size);
    Some(Contact { point: minus(center, gap), normal, distance, slack, velocity: Vec3::ZERO, material: None, face: 0 })
}

/// When what moves from `offset` by `step` leaves the circle or sphere of `radius` about the origin, and the unit normal
/// inward there. Outside of it at first, it leaves as soon as it moves away from the origin.
pub(super) fn leave_circle(offset: Vec3, step: Vec3, radius: f32) -> Option<(f32, Vec3)> {
    let square = step.dot(step);
    if !(square > 0.0) {
        return None;
    }
    let is_out = offset.dot(offset) >= radius * radius;
    let time = if is_out && offset.dot(step) >= 0.0 {
        0.0
    } else {
        // Should it pass by the circle, it is nearest to it in the middle.
        let middle = -offset.dot(step) / square;
        max(circle_span(offset, step, radius).map_or(middle, |(_, leave)| leave), 0.0)
    };
    let there = unit(offset + step * time);
    (time <= 1.0).then_some((time, if there == Vec3::ZERO { -unit(step) } else { -there }))
}

/// When a coordinate that starts at `from` and changes by `step` leaves the span from `low` to `high`, and which way
/// it goes. Outside of it at first, it leaves as soon as it moves away; a span that is none is its middle.
#[inline]
pub(super) fn leave_span(from: f32, step: f32, [low, high]: [f32; 2]) -> Option<(f32, f32)> {
    let (low, high) = if low <= high { (low, high) } else { (0.5 * (low + high), 0.5 * (low + high)) };
    let (room, way) = if step > 0.0 { (high - from, 1.0) } else { (from - low, -1.0) };
    // A coordinate that does not change never leaves: not a number, or infinity.
    let time = max(room, 0.0) / step.abs();
    (step != 0.0 && time <= 1.0).then_some((time, way))
}

/// The earlier of two leaves.
pub(super) fn first(a: Option<(f32, Vec3)>, b: Option<(f32, Vec3)>) -> Option<(f32, Vec3)> {
    match (a, b) {
        (Some(x), Some(y)) => Some(if y.0 < x.0 { y } else { x }),
        (a, b) => a.or(b),
    }
}

/// The way to `point` from the nearest place of the straight line between two points.
#[inline]
pub(super) fn gap_to_line(point: Vec3, from: Vec3, along: Vec3) -> Vec3 {
    let (offset, square) = (point - from, along.dot(along));
    let t = if square > 0.0 { clamp(offset.dot(along) / square, 0.0, 1.0) } else { 0.0 };
    offset - along * t
}

/// Where the line `offset` + t × `step` lies within `radius` of the origin.
///
/// It measures from the point of nearest approach, which keeps its digits where the textbook's b² − 4ac loses them.
pub(super) fn circle_span(offset: Vec3, step: Vec3, radius: f32) -> Option<(f32, f32)> {
    let square = step.dot(step);
    let middle = -offset.dot(step) / square;
    let nearest = offset + step * middle;
    let rest = radius * radius - nearest.dot(nearest);
    if !(rest > 0.0) {
        return None;
    }
    let half = sqrt(rest / square);
    Some((middle - half, middle + half))
}
