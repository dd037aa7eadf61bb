//! One triangle, and the arithmetic that meshes share with it.

use super::ball::{self, Filled, gap_to_line};
use super::plane::crossing;
use super::{Aabb, Affine, Collider, Contact, Hit, Segment, Spot, Surface};
use crate::math::{clamp, largest, length, max, power_to_one, sqrt, unit};
use crate::time::Time;
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
        let reach = max(size(self), max(max(largest(segment.from), largest(segment.to)), segment.radius));
        if (SMALL..LARGE).contains(&reach) {
            return self.met(segment);
        }
        // Products of several lengths are beyond all numbers: everything is brought to about one, which keeps all digits.
        let scale = power_to_one(reach);
        let (from, to, radius) = (segment.from * scale, segment.to * scale, segment.radius * scale);
        let near = Self { corners: self.corners.map(|corner| corner * scale) };
        let hit = near.met(&Segment { from, to, radius, ..*segment })?;
        Some(Hit { slack: hit.slack / scale, ..hit })
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let [a, b, c] = self.corners;
        let gap = self.gap(center);
        let normal = if gap == Vec3::ZERO { unit((b - a).cross(c - a)) } else { unit(gap) };
        ball::lean(center, gap, normal, reach, visit);
    }

    fn image(&self, map: &Affine, _: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        visit(0, &Self { corners: self.corners.map(|corner| map.point(corner)) });
    }
}

impl Filled for Triangle {
    /// As `nearest`; beside its inside it goes by the normal, which keeps the digits of small gaps.
    fn gap(&self, p: Vec3) -> Vec3 {
        let [a, b, c] = self.corners;
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let (d1, d2) = (ab.dot(ap), ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return ap;
        }
        let bp = p - b;
        let (d3, d4) = (ab.dot(bp), ac.dot(bp));
        if d3 >= 0.0 && d4 <= d3 {
            return bp;
        }
        if d1 * d4 - d3 * d2 <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return gap_to_line(p, a, ab);
        }
        let cp = p - c;
        let (d5, d6) = (ab.dot(cp), ac.dot(cp));
        if d6 >= 0.0 && d5 <= d6 {
            return cp;
        }
        if d5 * d2 - d1 * d6 <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return gap_to_line(p, a, ac);
        }
        if d3 * d6 - d5 * d4 <= 0.0 && d4 >= d3 && d5 >= d6 {
            return gap_to_line(p, b, c - b);
        }
        let normal = ab.cross(ac);
        normal * (normal.dot(ap) / normal.dot(normal))
    }
}

/// How far it reaches from the origin \[m\].
pub(super) fn size(triangle: &Triangle) -> f32 {
    let [a, b, c] = triangle.corners;
    max(largest(a), max(largest(b), largest(c)))
}

/// Coordinates between which the products that are formed here are numbers \[m\].
const SMALL: f32 = 1e-6;
const LARGE: f32 = 1e6;

impl Triangle {
    /// Where the path of a point or a ball first meets it.
    #[inline]
    fn met(&self, segment: &Segment) -> Option<Hit> {
        let center = self.crossed(segment);
        if segment.radius > 0.0 { ball::on_triangle(self, segment, center) } else { center }
    }

    /// Where the path of a point crosses it.
    fn crossed(&self, segment: &Segment) -> Option<Hit> {
        let [a, b, c] = self.corners;
        let normal = (b - a).cross(c - a);
        let (before, after) = (normal.dot(segment.from - a), normal.dot(segment.to - a));
        let slack = segment.slack(size(self));
        // A path toward the plane that ends within rounding of it has met it. Else one that ends beside an edge could
        // be judged to pass one triangle there and, by its continuation, the other.
        let met = after * after <= slack * slack * normal.dot(normal) && before.abs() > after.abs();
        let (time, normal) = crossing(normal, before, if met { 0.0 } else { after })?;
        self.is_passed(segment).then(|| Hit::new(time, unit(normal), slack))
    }

    /// Whether the line through a segment passes inside, edges included (Woop, Benthin, Wald, "Watertight Ray/Triangle
    /// Intersection", JCGT 2013).
    ///
    /// The corners are shorn along the line into a plane, where an edge function is a difference of two products: its
    /// sign is never wrong, and for the other triangle at the edge it is just the opposite.
    fn is_passed(&self, segment: &Segment) -> bool {
        let step = segment.step();
        let size = step.abs();
        let (z, x, y) = if size.x > size.y && size.x > size.z {
            (0, 1, 2)
        } else if size.y > size.z {
            (1, 2, 0)
        } else {
            (2, 0, 1)
        };
        let (shear_x, shear_y) = (step[x] / step[z], step[y] / step[z]);
        let shorn = |corner: Vec3| {
            let offset = corner - segment.from;
            (offset[x] - shear_x * offset[z], offset[y] - shear_y * offset[z])
        };
        let [(ax, ay), (bx, by), (cx, cy)] = self.corners.map(shorn);
        let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0)
    }
}
