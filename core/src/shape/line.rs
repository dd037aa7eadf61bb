//! A straight line.

use super::ball::{Filled, approach, gap_to_line, lean_on};
use super::{Aabb, Affine, Collider, Contact, Hit, Mapped, Segment, Spot, Surface};
use crate::math::{clamp, frame, length, max, sin_cos_turns, unit};
use crate::time::Time;
use glam::Vec3;

/// How near a path must come to a line, which has no area, to touch it \[m\]; more where coordinates are coarser.
const TOUCH: f32 = 1e-5;

/// A straight line between two points; births leave it perpendicularly, in all directions alike.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Line {
    /// One end \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub from: Vec3,
    /// The other end \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub to: Vec3,
}

impl Surface for Line {
    fn area(&self) -> f32 {
        length(self.to - self.from)
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let along = self.to - self.from;
        let (a, b) = frame(if along == Vec3::ZERO { Vec3::Y } else { unit(along) });
        let (sin, cos) = sin_cos_turns(u[1]);
        Spot { point: self.from + along * u[0], normal: a * cos + b * sin }
    }

    fn nearest(&self, point: Vec3) -> Vec3 {
        let along = self.to - self.from;
        let square = along.dot(along);
        let t = if square > 0.0 { clamp((point - self.from).dot(along) / square, 0.0, 1.0) } else { 0.0 };
        self.from + along * t
    }

    fn bounds(&self) -> Aabb {
        Aabb::around([self.from, self.to])
    }
}

impl Collider for Line {
    fn moves(&self) -> bool {
        false
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let Aabb { min, max } = self.bounds();
        Aabb { min: min - TOUCH, max: max + TOUCH }.overlaps(bounds)
    }

    /// Finds the nearest approach of a point, if it comes within 10 µm (or a few units in the last place, where those
    /// are more); for a ball larger than that, the place where it first touches.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let slack = segment.slack(crate::math::largest(self.from));
        let touch = max(TOUCH, slack);
        if segment.radius > touch {
            return approach(self, segment, slack);
        }
        let time = nearest_approach(segment, self);
        let point = segment.at(time);
        let gap = length(point - self.nearest(point));
        let before = segment.from - self.nearest(segment.from);
        // A path that starts on the line only leaves it.
        (gap <= touch && gap < length(before)).then(|| Hit::new(time, unit(before), touch))
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        lean_on(self, center, [reach, crate::math::largest(self.from)], visit);
    }
}

impl Mapped for Line {
    fn image(&self, map: &Affine, _: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        visit(0, &Self { from: map.point(self.from), to: map.point(self.to) });
    }
}

impl Filled for Line {
    fn gap(&self, point: Vec3) -> Vec3 {
        gap_to_line(point, self.from, self.to - self.from)
    }
}

/// The fraction of `segment` at which it is nearest to `line` (Ericson, "Real-Time Collision Detection", 5.1.9).
fn nearest_approach(segment: &Segment, line: &Line) -> f32 {
    let (d1, d2, r) = (segment.step(), line.to - line.from, segment.from - line.from);
    let (a, e, f) = (d1.dot(d1), d2.dot(d2), d2.dot(r));
    if a == 0.0 {
        return 0.0;
    }
    let c = d1.dot(r);
    if e == 0.0 {
        return clamp(-c / a, 0.0, 1.0);
    }
    let b = d1.dot(d2);
    let denominator = a * e - b * b;
    let s = if denominator > 0.0 { clamp((b * f - c * e) / denominator, 0.0, 1.0) } else { 0.0 };
    let t = (b * s + f) / e;
    if t < 0.0 {
        clamp(-c / a, 0.0, 1.0)
    } else if t > 1.0 {
        clamp((b - c) / a, 0.0, 1.0)
    } else {
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Line = Line { from: Vec3::new(-1.0, 0.0, 0.0), to: Vec3::new(1.0, 0.0, 0.0) };

    #[test]
    fn a_path_through_the_line_touches_it() {
        let hit = X.first_hit(&Segment::new(Vec3::new(0.3, 1.0, 0.5), Vec3::new(0.3, -3.0, -1.5)));
        assert!((hit.expect("it crosses").time - 0.25).abs() < 1e-6);
        assert_eq!(X.first_hit(&Segment::new(Vec3::new(0.3, 1.0, 0.01), Vec3::new(0.3, -1.0, 0.01))), None);
        assert_eq!(X.first_hit(&Segment::new(Vec3::new(1.1, 1.0, 0.0), Vec3::new(1.1, -1.0, 0.0))), None);
        assert_eq!(X.first_hit(&Segment::new(Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 1.0, 0.0))), None);
    }

    #[test]
    fn births_leave_at_right_angles() {
        for i in 0..100 {
            let spot = X.sample([i as f32 / 100.0, i as f32 * 0.618 % 1.0, 0.0]);
            assert!(spot.normal.x.abs() < 1e-6 && (spot.normal.length() - 1.0).abs() < 1e-6);
            assert!((spot.point.x - (-1.0 + 0.02 * i as f32)).abs() < 1e-6);
        }
    }
}
