//! One triangle, and the arithmetic that meshes share with it.

use super::ball::{Filled, approach, gap_to_line, leaning};
use super::exact::{Lattice, cross, volume};
use super::plane::crossing;
use super::sliver::Sliver;
use super::{Aabb, Affine, Collider, Contact, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface, earlier};
use crate::math::{clamp, high, largest, length, max, min, power_to_one, sqrt, unit};
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
        // The triangle is scaled to about one, so that no product is beyond an `f32`.
        let scale = power_to_one(size(self));
        let [a, b, c] = self.corners.map(|corner| corner * scale);
        0.5 * length((b - a).cross(c - a)) / scale / scale
    }

    fn sample(&self, u: [f32; 3]) -> Spot {
        let [a, b, c] = self.corners;
        let s = sqrt(u[1]);
        Spot { point: a * (1.0 - s) + b * (s * (1.0 - u[2])) + c * (s * u[2]), normal: unit(self.normal().0) }
    }

    /// Ericson, "Real-Time Collision Detection", 5.1.5.
    fn nearest(&self, p: Vec3) -> Vec3 {
        let (normal, is_plain) = self.normal();
        if !is_plain {
            return p - Sliver::new(self.corners, normal).gap(p);
        }
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
    fn moves(&self) -> bool {
        false
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.bounds().with_slack().overlaps(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        hulls.near_box(&self.bounds(), marks);
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let sides = Sides::rounded(self.corners, segment);
        if !(segment.radius > 0.0) && sides.is_sure_miss() {
            return None;
        }
        let reach = max(size(self), max(max(largest(segment.from), largest(segment.to)), segment.radius));
        if (SMALL..LARGE).contains(&reach) {
            return self.met(segment, sides);
        }
        // Products of several lengths are beyond all numbers: everything is brought to about one, which keeps all digits.
        let scale = power_to_one(reach);
        let (from, to, radius) = (segment.from * scale, segment.to * scale, segment.radius * scale);
        let near = self.scaled(scale);
        let segment = Segment { from, to, radius, ..*segment };
        let hit = near.met(&segment, Sides::rounded(near.corners, &segment))?;
        Some(Hit { slack: hit.slack / scale, ..hit })
    }

    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        self.contact(center, reach, 0).iter().for_each(visit);
    }
}

impl Mapped for Triangle {
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

/// By how much of its permanent a determinant of three differences may be wrong (Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997: 7 half units and a little), and by how much
/// products too small for all digits may be.
const ROUNDING: f32 = 4.0 * f32::EPSILON;
const UNDERFLOW: f32 = 8.0 * f32::MIN_POSITIVE;

/// The multiple of the usual slack beyond which a hit's place, if it may be so wrong, is computed without error.
const ROUGH: f32 = 4.0;

/// On which sides of a triangle's plane the ends of a path lie: the products of its normal with the ways there.
struct Sides {
    normal: Vec3,
    before: f32,
    after: f32,
    /// How wrong those products may be.
    doubt: f32,
    /// The largest offset of an end from a corner \[m\].
    far: f32,
}

impl Sides {
    #[inline(always)]
    fn rounded([a, b, c]: [Vec3; 3], segment: &Segment) -> Self {
        let (x, y, from, to) = (b - a, c - a, segment.from - a, segment.to - a);
        let normal = x.cross(y);
        let ends = high(from.abs(), to.abs());
        let doubt = permanent(x, y).dot(ends) * ROUNDING + UNDERFLOW;
        Self { normal, before: normal.dot(from), after: normal.dot(to), doubt, far: largest(ends) }
    }

    #[cold]
    #[inline(never)]
    fn exact([a, b, c]: [Vec3; 3], segment: &Segment) -> Self {
        let lattice = Lattice::new([a, b, c, segment.from, segment.to]);
        let normal = cross(lattice.way(0, 1), lattice.way(0, 2));
        let [before, after] = [3, 4].map(|end| volume(normal, lattice.way(0, end)));
        Self { normal: lattice.direction(normal), before, after, doubt: 0.0, far: 0.0 }
    }

    /// Tells whether the signs of both are surely right.
    #[inline(always)]
    fn is_sure(&self) -> bool {
        min(self.before.abs(), self.after.abs()) > self.doubt
    }

    /// Tells whether both ends surely lie on one side, whatever the scale: products beyond an `f32` make the doubt
    /// infinite, and it covers what underflows for ends that are no farther than this.
    #[inline(always)]
    fn is_sure_miss(&self) -> bool {
        self.is_sure() && (self.before > 0.0) == (self.after > 0.0) && self.far < LARGE
    }

    /// How far from the plane's true place along a path they tell that it is met \[m\].
    #[inline(always)]
    fn error(&self, segment: &Segment) -> f32 {
        self.doubt * length(segment.step()) / (self.before - self.after).abs()
    }
}

/// The vector product with all its products counted as above zero.
#[inline(always)]
fn permanent(x: Vec3, y: Vec3) -> Vec3 {
    let [x, y] = [x.abs(), y.abs()];
    Vec3::new(x.y * y.z + x.z * y.y, x.z * y.x + x.x * y.z, x.x * y.y + x.y * y.x)
}

impl Triangle {
    /// The place of it that a ball leans on, if there is one; the triangle of a mesh has a number.
    pub(super) fn contact(&self, center: Vec3, reach: f32, face: u32) -> Option<Contact> {
        let (across, is_plain) = self.normal();
        let gap = if is_plain { self.gap(center) } else { Sliver::new(self.corners, across).gap(center) };
        let normal = if gap == Vec3::ZERO { unit(across) } else { unit(gap) };
        Some(Contact { face, ..leaning(center, gap, normal, [reach, size(self)])? })
    }

    /// The same, so many times as large.
    pub(super) fn scaled(&self, scale: f32) -> Self {
        Self { corners: self.corners.map(|corner| corner * scale) }
    }

    /// A vector along its normal, of no particular length, and whether rounding is so small against it that it may be
    /// computed as usual: in a sliver nearly nothing is left of the difference of two products.
    #[inline]
    pub(super) fn normal(&self) -> (Vec3, bool) {
        let [a, b, c] = self.corners;
        let (x, y) = (b - a, c - a);
        let (normal, most) = (x.cross(y), permanent(x, y));
        if 64.0 * normal.dot(normal) > most.dot(most) { (normal, true) } else { (self.exact_normal(), false) }
    }

    #[cold]
    #[inline(never)]
    fn exact_normal(&self) -> Vec3 {
        let lattice = Lattice::new(self.corners);
        unit(lattice.direction(cross(lattice.way(0, 1), lattice.way(0, 2))))
    }

    /// Where the path of a point or a ball first meets it.
    #[inline]
    fn met(&self, segment: &Segment, sides: Sides) -> Option<Hit> {
        let center = self.crossed(segment, sides);
        if segment.radius > 0.0 { self.met_by_ball(segment, center) } else { center }
    }

    /// Where the path of a ball, or of a point, first meets it from either side; `center` is where its middle does.
    #[inline]
    fn met_by_ball(&self, segment: &Segment, center: Option<Hit>) -> Option<Hit> {
        let [a, ..] = self.corners;
        let slack = segment.slack(size(self));
        if !(segment.radius > slack) {
            return center;
        }
        // Most triangles are out of reach of the ball all along.
        let (normal, is_plain) = self.normal();
        let (before, after) = (normal.dot(segment.from - a), normal.dot(segment.to - a));
        let reach = segment.radius + slack;
        let far = reach * reach * normal.dot(normal);
        if before * after > 0.0 && before * before > far && after * after > far {
            return center;
        }
        let ball = if is_plain {
            approach(self, segment, slack)
        } else {
            approach(&Sliver::new(self.corners, normal), segment, slack)
        };
        earlier(ball, center)
    }

    /// Where the path of a point crosses it.
    ///
    /// Which sides its ends lie on and what it passes inside are told without error: of all triangles of a closed mesh,
    /// however thin, one is crossed by whatever gets in.
    fn crossed(&self, segment: &Segment, mut sides: Sides) -> Option<Hit> {
        if !sides.is_sure() {
            sides = Sides::exact(self.corners, segment);
        }
        let (time, normal) = crossing(sides.normal, sides.before, sides.after)?;
        if !self.is_passed(segment) {
            return None;
        }
        let (slack, error) = (segment.slack(size(self)), sides.error(segment));
        if !(error <= ROUGH * slack) {
            let sides = Sides::exact(self.corners, segment);
            let (time, normal) = crossing(sides.normal, sides.before, sides.after)?;
            return Some(Hit::new(time, unit(normal), slack));
        }
        Some(Hit::new(time, unit(normal), max(error, slack)))
    }

    /// Tells whether the line through a segment passes inside, edges included.
    ///
    /// The corners are shorn along the line into a plane, where an edge function is a difference of two products
    /// (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).
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
            (offset[x] - shear_x * offset[z], offset[y] - shear_y * offset[z], offset[z].abs())
        };
        let [(ax, ay, az), (bx, by, bz), (cx, cy, cz)] = self.corners.map(shorn);
        let sides = [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax];
        // A shorn coordinate is off by 2 half units of its own and 6 of what was shorn off, an edge function by four
        // times that and 4 half units of products, of the largest of each.
        let wide = [ax, ay, bx, by, cx, cy].into_iter().fold(0.0, |most, x| max(x.abs(), most));
        let doubt = f32::EPSILON * wide * (8.0 * wide + 16.0 * max(az, max(bz, cz))) + UNDERFLOW;
        let (left, right) = (sides.iter().any(|&side| side > doubt), sides.iter().any(|&side| side < -doubt));
        let is_sure = (left && right) || sides.iter().all(|side| side.abs() > doubt);
        if is_sure { left != right } else { self.is_passed_exactly(segment) }
    }

    #[cold]
    #[inline(never)]
    fn is_passed_exactly(&self, segment: &Segment) -> bool {
        let [a, b, c] = self.corners;
        let lattice = Lattice::new([segment.from, segment.to, a, b, c]);
        let [a, b, c] = [2, 3, 4].map(|corner| lattice.way(0, corner));
        let sides = [(c, b), (a, c), (b, a)].map(|(p, q)| volume(cross(p, q), lattice.way(0, 1)));
        sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
    }
}
