//! One triangle, and the arithmetic that meshes share with it.

use super::plane::crossing;
use super::{Aabb, Collider, Hit, Segment, Spot, Surface};
use crate::math::{clamp, largest, length, max, sqrt, unit};
use glam::Vec3;

/// A flat triangle, hit from both sides; seen from where its corners run counter-clockwise, its normal points here.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Triangle {
    /// Its corners \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[[f32; 3]; 3]"))]
    pub corners: [Vec3; 3],
}

impl Surface for Triangle {
    fn area(&self) -> f32 {
        let [a, b, c] = self.corners;
        0.5 * length((b - a).cross(c - a))
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let [a, b, c] = self.corners;
        let s = sqrt(u[1]);
        Spot { point: a * (1.0 - s) + b * (s * (1.0 - u[2])) + c * (s * u[2]), normal: unit((b - a).cross(c - a)) }
    }

    /// Ericson, "Real-Time Collision Detection", 5.1.5.
    fn nearest(&self, p: Vec3) -> Vec3 {
        let [a, b, c] = self.corners;
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return a;
        }
        let bp = p - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return b;
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return a + ab * clamp(d1 / (d1 - d3), 0.0, 1.0);
        }
        let cp = p - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return c;
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return a + ac * clamp(d2 / (d2 - d6), 0.0, 1.0);
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            return b + (c - b) * clamp((d4 - d3) / ((d4 - d3) + (d5 - d6)), 0.0, 1.0);
        }
        let sum = 1.0 / (va + vb + vc);
        a + ab * (vb * sum) + ac * (vc * sum)
    }

    fn bounds(&self) -> Aabb {
        Aabb::around(self.corners)
    }
}

impl Collider for Triangle {
    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.bounds().overlaps(bounds)
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let [a, b, c] = self.corners;
        let normal = (b - a).cross(c - a);
        let (time, normal) = crossing(normal, normal.dot(segment.from - a), normal.dot(segment.to - a))?;
        // The line passes inside if it goes round all three edges the same way. A cross product changes only its sign
        // when its factors change places, so the two triangles at an edge never both say no.
        let step = segment.step();
        let (p, q, r) = (a - segment.from, b - segment.from, c - segment.from);
        let (u, v, w) = (step.dot(q.cross(r)), step.dot(r.cross(p)), step.dot(p.cross(q)));
        let inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
        let size = max(largest(a), max(largest(b), largest(c)));
        inside.then(|| Hit { time, normal: unit(normal), slack: segment.slack(size) })
    }
}
