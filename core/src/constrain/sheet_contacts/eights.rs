//! Pairs of a kind side by side, eight or as many as registers hold, by the operations of one in their order, and so the same bits.

use super::closest::Kind;
use crate::lanes::{self, LANES, Lanes, Vectors, gathered, max, min, negated};
use glam::Vec3;

/// The places of so many times four corners as seen from the first, which is left out.
pub(super) type Seen<F> = [Vectors<F>; 3];

/// As [`super::pair::seen`], of as many eights as there are at once. None: a corner is the last of all, behind which nothing can be read.
#[inline(always)]
pub(super) fn seen<F: Lanes>(like: F, of: &[Vec3], corners: &[[[u32; 4]; LANES]]) -> Option<Seen<F>> {
    let mut are_there = true;
    let [ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz] = like.of_parts(
        #[inline(always)]
        |like, nth| match gathered(like, of, &corners[nth]) {
            Some([Vectors([ax, ay, az]), Vectors([bx, by, bz]), Vectors([cx, cy, cz]), Vectors([dx, dy, dz])]) => {
                [ax, ay, az, bx, by, bz, cx, cy, cz, dx, dy, dz]
            }
            None => {
                are_there = false;
                [like; 12]
            }
        },
    );
    let [a, b, c, d] = [[ax, ay, az], [bx, by, bz], [cx, cy, cz], [dx, dy, dz]].map(Vectors);
    are_there.then_some([b - a, c - a, d - a])
}

/// As [`super::closest::Closest`].
#[derive(Clone, Copy)]
pub(super) struct Closest<F> {
    pub(super) weights: [F; 4],
    pub(super) gap: Vectors<F>,
}

impl<F: Lanes> Closest<F> {
    #[inline(always)]
    pub(super) fn of(kind: Kind, all: Seen<F>) -> Self {
        match kind {
            Kind::PointTriangle => Self::point_triangle(all),
            Kind::EdgeEdge => Self::edge_edge(all),
        }
    }

    #[inline(always)]
    fn new(weights: [F; 4], [b, c, d]: Seen<F>) -> Self {
        let [p, q, r, s] = weights;
        Self { weights, gap: none(p) + b * q + c * r + d * s }
    }

    #[inline(always)]
    fn point_triangle([a, b, c]: Seen<F>) -> Self {
        let normal = (b - a).cross(c - a);
        let square = normal.dot(normal);
        let (zero, one) = (square.all(0.0), square.all(1.0));
        let parts = [normal.dot(b.cross(c)), normal.dot(c.cross(a)), normal.dot(a.cross(b))];
        let is_over = square.simd_gt(zero) & parts[0].simd_gt(zero) & parts[1].simd_gt(zero) & parts[2].simd_gt(zero);
        let sum = parts[0] + parts[1] + parts[2];
        let [u, v, w] = [parts[0] / sum, parts[1] / sum, parts[2] / sum];
        let over = Self::new([one, negated(u), negated(v), negated(w)], [a, b, c]);
        let [s, t, u] = [along(a, b), along(b, c), along(c, a)];
        let first = Self::new([one, s - one, negated(s), zero], [a, b, c]);
        let second = Self::new([one, zero, t - one, negated(t)], [a, b, c]);
        let third = Self::new([one, negated(u), zero, u - one], [a, b, c]);
        Self::select(is_over, over, first.or(second).or(third))
    }

    #[inline(always)]
    fn edge_edge([b, c, d]: Seen<F>) -> Self {
        let a = none(b.0[0]);
        let (e, f, way) = (b - a, d - c, a - c);
        let (ee, ff, ef) = (e.dot(e), f.dot(f), e.dot(f));
        let (ew, fw) = (e.dot(way), f.dot(way));
        let determinant = ee * ff - ef * ef;
        let (zero, one) = (ee.all(0.0), ee.all(1.0));
        let (s, t) = ((ef * fw - ff * ew) / determinant, (ee * fw - ef * ew) / determinant);
        let is_within = s.simd_gt(zero) & s.simd_lt(one) & t.simd_gt(zero) & t.simd_lt(one);
        let crosses = determinant.simd_gt(ee.all(1e-6) * ee * ff) & is_within;
        let over = Self::new([one - s, s, t - one, negated(t)], [b, c, d]);
        let [p, q] = [along(c - a, d - a), along(c - b, d - b)];
        let [r, s] = [along(a - c, b - c), along(a - d, b - d)];
        let first = Self::new([one, zero, p - one, negated(p)], [b, c, d]);
        let second = Self::new([zero, one, q - one, negated(q)], [b, c, d]);
        let third = Self::new([one - r, r, negated(one), zero], [b, c, d]);
        let fourth = Self::new([one - s, s, zero, negated(one)], [b, c, d]);
        Self::select(crosses, over, first.or(second).or(third.or(fourth)))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self::select(other.gap.dot(other.gap).simd_lt(self.gap.dot(self.gap)), other, self)
    }

    #[inline(always)]
    fn select(mask: F, this: Self, other: Self) -> Self {
        let ([a, b, c, d], [p, q, r, s]) = (this.weights, other.weights);
        let weights = [mask.select(a, p), mask.select(b, q), mask.select(c, r), mask.select(d, s)];
        Self { weights, gap: Vectors::select(mask, this.gap, other.gap) }
    }
}

#[inline(always)]
fn none<F: Lanes>(like: F) -> Vectors<F> {
    Vectors([like.all(0.0); 3])
}

#[inline(always)]
fn along<F: Lanes>(a: Vectors<F>, b: Vectors<F>) -> F {
    let e = b - a;
    let far = negated(a.dot(e)) / e.dot(e);
    min(far, far.all(1.0)) & far.simd_gt(far.all(0.0))
}

/// As [`super::closest::apart`].
#[inline(always)]
pub(super) fn apart<F: Lanes>(kind: Kind, [b, c, d]: &Seen<F>, direction: Vectors<F>) -> F {
    let [b, c, d] = [b.dot(direction), c.dot(direction), d.dot(direction)];
    let a = b.all(0.0);
    match kind {
        Kind::PointTriangle => a - max(max(b, c), d),
        Kind::EdgeEdge => min(a, b) - max(c, d),
    }
}

/// Bounds on how far they are apart at both ends, found at first glance.
#[derive(Clone, Copy)]
pub(super) struct Gaps<F> {
    boxes: F,
    middles: [F; 2],
}

impl<F: Lanes> Gaps<F> {
    #[inline(always)]
    pub(super) fn of(kind: Kind, ends: &[Seen<F>; 2]) -> Self {
        Self { boxes: gap_of_boxes(kind, ends), middles: gap_of_middles(kind, ends) }
    }

    /// The same where the direction between their middles does not count unless a mask says so.
    #[inline(always)]
    pub(super) fn masked(self, mask: F) -> Self {
        let [far, way] = self.middles;
        Self { middles: [far & mask, way], ..self }
    }

    /// Those that neither boxes keep farther than one reach apart nor the direction between their middles farther than another one.
    #[inline(always)]
    pub(super) fn left(&self, reach: F, least: F) -> F {
        let [far, way] = self.middles;
        lanes::not(self.boxes.simd_gt(reach) | far.simd_gt(least * least * way))
    }
}

/// How far they are apart along an axis, on the same side at both ends (as [`super::pair::are_apart`]).
#[inline(always)]
fn gap_of_boxes<F: Lanes>(kind: Kind, ends: &[Seen<F>; 2]) -> F {
    let mut most = ends[0][0].0[0].all(f32::NEG_INFINITY);
    for axis in 0..3 {
        let (above, below) = gaps(kind, &ends[0], axis);
        let (still_above, still_below) = gaps(kind, &ends[1], axis);
        most = max(max(min(above, still_above), min(below, still_below)), most);
    }
    most
}

/// How far the first is above the second along an axis, and below it.
#[inline(always)]
fn gaps<F: Lanes>(kind: Kind, of: &Seen<F>, axis: usize) -> (F, F) {
    let [b, c, d] = [of[0].0[axis], of[1].0[axis], of[2].0[axis]];
    let a = b.all(0.0);
    match kind {
        Kind::PointTriangle => (a - max(max(b, c), d), min(min(b, c), d) - a),
        Kind::EdgeEdge => (min(a, b) - max(c, d), min(c, d) - max(a, b)),
    }
}

/// The square of how far they stay apart along the way between their middles, some times over, and the square of that way.
#[inline(always)]
fn gap_of_middles<F: Lanes>(kind: Kind, ends: &[Seen<F>; 2]) -> [F; 2] {
    let [b, c, d] = ends[0];
    let way = match kind {
        Kind::PointTriangle => -(b + c + d),
        Kind::EdgeEdge => b - (c + d),
    };
    let far = min(apart(kind, &ends[0], way), apart(kind, &ends[1], way));
    [(far * far) & far.simd_gt(far.all(0.0)), way.dot(way)]
}

/// The square of how far any corner of the one goes as seen from any of the other (as in [`super::closest::Meeting`]).
#[inline(always)]
pub(super) fn fastest<F: Lanes>(kind: Kind, ends: &[Seen<F>; 2]) -> F {
    let [b, c, d] = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1], ends[1][2] - ends[0][2]];
    match kind {
        Kind::PointTriangle => max(max(b.dot(b), c.dot(c)), d.dot(d)),
        Kind::EdgeEdge => {
            let (e, f) = (b - c, b - d);
            max(max(c.dot(c), d.dot(d)), max(e.dot(e), f.dot(f)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::closest;
    use super::*;
    use crate::lanes::{BroadKernel, Eight, PARTS};

    struct All<'a>(Kind, &'a [Vec3], [[[u32; 4]; LANES]; PARTS]);

    impl BroadKernel for All<'_> {
        type Output = [[[[f32; 4]; LANES]; 2]; PARTS];
        #[inline(always)]
        fn run<F: Lanes>(self, like: F) -> Self::Output {
            let mut all = Self::Output::default();
            for first in (0..PARTS).step_by(F::PARTS) {
                let of = Closest::of(self.0, seen(like, self.1, &self.2[first..]).expect("none is the last"));
                for (nth, all) in all[first..].iter_mut().enumerate().take(F::PARTS) {
                    let weights = of.weights.map(|weight| weight.part(nth));
                    *all = [Eight::rows_of(weights), of.gap.part(nth).rows()];
                }
            }
            all
        }
    }

    #[test]
    fn side_by_side_they_have_the_nearest_places_of_one() {
        // Places on a coarse grid are often in a line, in a plane, or the same.
        let mut state = 1u32;
        let mut next = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % most
        };
        for round in 0..2000 {
            let grid = [2, 3, 5, 1000][round % 4];
            let places: [Vec3; 65] =
                core::array::from_fn(|_| Vec3::from([0; 3].map(|_| next(grid) as f32 / grid as f32 - 0.3)));
            let lanes =
                |part: usize| core::array::from_fn(|lane| [0, 1, 2, 3].map(|k| (4 * (LANES * part + lane) + k) as u32));
            let corners = core::array::from_fn(lanes);
            for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
                let all = lanes::run_broad(All(kind, &places, corners));
                let all = all.iter().flat_map(|[weights, gaps]| weights.iter().zip(gaps));
                for (&corners, (&weights, &[x, y, z, _])) in corners.as_flattened().iter().zip(all) {
                    let one = closest::Closest::of(kind, super::super::pair::seen(&places, corners));
                    let bits = |all: [f32; 4]| all.map(f32::to_bits);
                    assert_eq!(bits(weights), bits(one.weights), "{corners:?} of {places:?}");
                    assert_eq!(bits([x, y, z, 0.0]), bits([one.gap.x, one.gap.y, one.gap.z, 0.0]));
                }
            }
        }
    }
}
