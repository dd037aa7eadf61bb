//! The nearest places of a point and a triangle, and of two edges; and what happens between them as they move straight on.

use crate::math::{dot, length, max, min, sqrt};
use glam::Vec3;

/// The corners of two simple things: a point and a triangle, or two edges. The first so many of the four are those of the first one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    PointTriangle,
    EdgeEdge,
}

impl Kind {
    /// The number of the four corners that belong to the first.
    pub(super) const fn split(self) -> usize {
        match self {
            Self::PointTriangle => 1,
            Self::EdgeEdge => 2,
        }
    }
}

/// The nearest places of two things.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    /// The shares of the corners in these places: those of the first thing add up to 1, those of the second to −1.
    pub(super) weights: [f32; 4],
    /// The way from the second thing's place to the first one's \[m\].
    pub(super) gap: Vec3,
}

impl Closest {
    pub(super) fn of(kind: Kind, [a, b, c, d]: [Vec3; 4]) -> Self {
        match kind {
            Kind::PointTriangle => Self::point_triangle([b - a, c - a, d - a]),
            Kind::EdgeEdge => Self::edge_edge([a, b, c, d]),
        }
    }

    fn new(weights: [f32; 4], [a, b, c, d]: [Vec3; 4]) -> Self {
        let [p, q, r, s] = weights;
        Self { weights, gap: a * p + b * q + c * r + d * s }
    }

    /// The point is the origin. Inside the triangle's prism the nearest place is the foot of its normal, else it lies on an edge; so
    /// it does where the triangle has no normal.
    fn point_triangle([a, b, c]: [Vec3; 3]) -> Self {
        let normal = (b - a).cross(c - a);
        let square = dot(normal, normal);
        let parts = [dot(normal, b.cross(c)), dot(normal, c.cross(a)), dot(normal, a.cross(b))];
        let all = [Vec3::ZERO, a, b, c];
        if square > 0.0 && parts.iter().all(|&part| part > 0.0) {
            let [u, v, w] = parts.map(|part| part / (parts[0] + parts[1] + parts[2]));
            return Self::new([1.0, -u, -v, -w], all);
        }
        let [s, t, u] = [along(a, b), along(b, c), along(c, a)];
        let edges = [[s - 1.0, -s, 0.0], [0.0, t - 1.0, -t], [-u, 0.0, u - 1.0]];
        let [first, second, third] = edges.map(|[a, b, c]| Self::new([1.0, a, b, c], all));
        first.or(second).or(third)
    }

    /// By the common normal where that meets both, else from one of the four ends.
    fn edge_edge(all: [Vec3; 4]) -> Self {
        let [a, b, c, d] = all;
        let (e, f, way) = (b - a, d - c, a - c);
        let (ee, ff, ef) = (dot(e, e), dot(f, f), dot(e, f));
        let (ew, fw) = (dot(e, way), dot(f, way));
        let determinant = ee * ff - ef * ef;
        // Edges within a thousandth of parallel have no crossing that single precision can tell.
        if determinant > 1e-6 * ee * ff {
            let (s, t) = ((ef * fw - ff * ew) / determinant, (ee * fw - ef * ew) / determinant);
            if s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
                return Self::new([1.0 - s, s, t - 1.0, -t], all);
            }
        }
        let [p, q] = [along(c - a, d - a), along(c - b, d - b)];
        let [r, s] = [along(a - c, b - c), along(a - d, b - d)];
        let ends = [[1.0, 0.0, p - 1.0, -p], [0.0, 1.0, q - 1.0, -q], [1.0 - r, r, -1.0, 0.0], [1.0 - s, s, 0.0, -1.0]];
        let [first, second, third, fourth] = ends.map(|weights| Self::new(weights, all));
        first.or(second).or(third.or(fourth))
    }

    /// The nearer of both, the first where they are equally near.
    fn or(self, other: Self) -> Self {
        if dot(other.gap, other.gap) < dot(self.gap, self.gap) { other } else { self }
    }
}

/// How far along an edge the place nearest to the origin is, as a share of it.
fn along(a: Vec3, b: Vec3) -> f32 {
    let e = b - a;
    let far = -dot(a, e) / dot(e, e);
    // An edge without length has one place.
    if far > 0.0 { min(far, 1.0) } else { 0.0 }
}

/// How far apart two things are along a direction, from the second to the first \[m\].
pub(super) fn apart(kind: Kind, [a, b, c, d]: &[Vec3; 4], direction: Vec3) -> f32 {
    let [a, b, c, d] = [dot(*a, direction), dot(*b, direction), dot(*c, direction), dot(*d, direction)];
    match kind {
        Kind::PointTriangle => a - max(max(b, c), d),
        Kind::EdgeEdge => min(a, b) - max(c, d),
    }
}

/// Two things that come near each other.
#[derive(Clone, Copy)]
pub(super) struct Meeting {
    /// Their nearest places, in the end or as they come together.
    pub(super) closest: Closest,
    /// How far apart they are at the beginning and in the end \[m\].
    pub(super) distance: [f32; 2],
    /// True if they come together on the way, or in the end.
    pub(super) meets: bool,
}

/// Steps along the way at the most: as many as it takes past each other at a distance of which the way is 50 times as long.
const STEPS: u32 = 64;
/// How far one may go in a sub-step, as seen from all, as a multiple of how far it may be pushed between searches: so far no two can be followed in
/// vain that are as far apart as they are looked for.
pub(super) const FARTHEST: f32 = 50.0;
/// A share of a distance that is more than its rounding.
pub(super) const MARGIN: f32 = 1e-3;

/// Tells whether the direction between the middles of two things keeps them farther than `reach` apart all the way, as it does of most that are
/// neighbours in a sheet.
pub(super) fn parts(kind: Kind, ends: &[[Vec3; 4]; 2], reach: f32) -> bool {
    let [a, b, c, d] = ends[0];
    let way = match kind {
        Kind::PointTriangle => a * 3.0 - (b + c + d),
        Kind::EdgeEdge => (a + b) - (c + d),
    };
    let far = min(apart(kind, &ends[0], way), apart(kind, &ends[1], way));
    far > 0.0 && far * far > reach * reach * dot(way, way)
}

/// The square of how far any corner of the one goes as seen from any of the other \[m²\].
pub(super) fn fastest(kind: Kind, ends: &[[Vec3; 4]; 2]) -> f32 {
    let ways: [Vec3; 4] = core::array::from_fn(|i| ends[1][i] - ends[0][i]);
    let (first, second) = ways.split_at(kind.split());
    let all = first.iter().flat_map(|&a| second.iter().map(move |&b| a - b));
    all.fold(0.0, |most, way| max(dot(way, way), most))
}

impl Meeting {
    /// The encounter of two things whose corners go straight from the first places to the second ones, in which their first
    /// corner counts as the origin. None: they never come within `reach`, or nothing can be said of them since they begin in one place.
    ///
    /// A direction in which they are apart at both ends keeps them apart all the way. Without one, they are followed by steps within which
    /// they cannot come together (conservative advancement), until they are within `near`.
    pub(super) fn of(kind: Kind, ends: &[[Vec3; 4]; 2], reach: f32, near: f32) -> Option<Self> {
        let first = Closest::of(kind, ends[0]);
        let begun = length(first.gap);
        if !(begun > 0.0 && begun < f32::INFINITY) || apart(kind, &ends[1], first.gap / begun) >= reach {
            return None;
        }
        let closest = Closest::of(kind, ends[1]);
        let ended = length(closest.gap);
        let distance = [begun, ended];
        let near = min(near, 0.5 * begun);
        if ended > near && apart(kind, &ends[0], closest.gap / ended) > 0.0 {
            return Some(Self { closest, distance, meets: false });
        }
        let speed = sqrt(fastest(kind, ends));
        let (mut time, mut left, mut last) = (0.0, begun, first);
        for _ in 0..STEPS {
            time += (left - 0.5 * near) / speed;
            if !(time < 1.0) {
                let meets = !(ended > near);
                return Some(Self { closest: if meets { last } else { closest }, distance, meets });
            }
            let at = core::array::from_fn(|i| ends[0][i] + (ends[1][i] - ends[0][i]) * time);
            let now = Closest::of(kind, at);
            left = length(now.gap);
            if !(left > 0.0) {
                break;
            }
            last = now;
            if left <= near {
                break;
            }
        }
        Some(Self { closest: last, distance, meets: true })
    }
}
