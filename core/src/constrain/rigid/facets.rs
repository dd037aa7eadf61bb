//! Where two bodies with faces and edges touch: by clipping one's face to the other's, or by the nearest points of two edges.

use super::hull::SIDES;
use crate::math::{clamp, dot, max};
use glam::Vec3;

/// The corners of a face that has been clipped to another, at the most: each side cuts off one corner and leaves two.
const CLIPPED: usize = 2 * SIDES;

/// By how much of the smaller body's size an axis of edges has to be the better one: faces hold steadier.
pub(super) const FACES_FIRST: f32 = 0.02;
/// The squared sine of an angle at which edges count as parallel.
pub(super) const PARALLEL: f32 = 1e-4;

/// The direction along which two bodies are farthest apart, or overlap least.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// How far apart they are \[m\]; below zero where they overlap.
    pub(super) gap: f32,
    /// From the first to the second.
    pub(super) normal: Vec3,
    pub(super) by: By,
}

/// The features that the direction belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) enum By {
    /// A face of the first, or of the second, by its number.
    Face(usize, usize),
    /// Edges of each, by their numbers.
    Edges(usize, usize),
}

/// A place where two bodies touch, or are about to: on the surface of each \[m\].
pub(super) type Spot = [Vec3; 2];

/// The places where two touch.
pub(super) type Spots = heapless::Vec<Spot, CLIPPED>;

/// A face of a body.
pub(super) struct Facet {
    /// A point in it \[m\].
    pub(super) middle: Vec3,
    /// The unit vector out of the body.
    pub(super) out: Vec3,
    /// A vector across each side, out of the face, a point, and how far that side is from there along the vector, times its length.
    pub(super) sides: heapless::Vec<(Vec3, Vec3, f32), SIDES>,
    /// Its corners in order \[m\].
    pub(super) corners: heapless::Vec<Vec3, SIDES>,
}

/// An edge of a body.
pub(super) struct Edge {
    /// Its middle \[m\].
    pub(super) middle: Vec3,
    /// The unit vector along it.
    pub(super) along: Vec3,
    /// Half its length \[m\].
    pub(super) half: f32,
}

/// A body with faces and edges, somewhere. A number may stand for several parallel features: of those, the one that is farthest in a direction is
/// meant.
pub(super) trait Faceted {
    /// A face.
    fn face(&self, number: usize, toward: Vec3) -> Facet;
    /// The number of the face that looks most in a direction.
    fn across(&self, toward: Vec3) -> usize;
    /// An edge.
    fn edge(&self, number: usize, toward: Vec3) -> Edge;
}

impl Apart {
    /// Adds the places where they touch, or are at most `reach` \[m\] apart, as far as there is room: for as many as clipping leaves.
    pub(super) fn touching(&self, [a, b]: [&dyn Faceted; 2], reach: f32, spots: &mut Spots) {
        let normal = self.normal;
        match self.by {
            By::Face(0, face) => clip(&a.face(face, normal), b, reach, &mut |on, off| push(spots, [on, off])),
            By::Face(_, face) => clip(&b.face(face, -normal), a, reach, &mut |on, off| push(spots, [off, on])),
            By::Edges(i, j) => {
                if self.gap <= reach {
                    push(spots, nearest_of(&a.edge(i, normal), &b.edge(j, -normal)));
                }
            }
        }
    }
}

/// There is room for as many as clipping leaves.
pub(super) fn push(spots: &mut Spots, spot: Spot) {
    let _ = spots.push(spot);
}

/// The points of two edges that are nearest to each other.
pub(super) fn nearest_of(
    &Edge { middle: p, along: u, half }: &Edge,
    &Edge { middle: q, along: v, half: other }: &Edge,
) -> Spot {
    let (way, cos) = (q - p, dot(u, v));
    let sine = max(1.0 - cos * cos, PARALLEL);
    let s = clamp((dot(u, way) - cos * dot(v, way)) / sine, -half, half);
    let t = clamp(cos * s - dot(v, way), -other, other);
    [p + u * s, q + v * t]
}

/// The middle of a spot.
pub(super) fn middle([p, q]: Spot) -> Vec3 {
    (p + q) * 0.5
}

/// Visits the places where the face of `of` that looks at a face is within `reach` of it, clipped to that: on the face, and on `of`
/// (Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17, 1974).
fn clip(face: &Facet, of: &dyn Faceted, reach: f32, visit: &mut dyn FnMut(Vec3, Vec3)) {
    let out = face.out;
    let other = of.face(of.across(-out), -out);
    let mut polygons = [const { heapless::Vec::<Vec3, CLIPPED>::new() }; 2];
    let [polygon, rest] = &mut polygons;
    let (mut polygon, mut kept) = (polygon, rest);
    polygon.extend(other.corners.iter().copied());
    for &(side, point, limit) in &face.sides {
        let beyond = |x: Vec3| dot(side, x - point) - limit;
        kept.clear();
        let last = polygon.last().copied().unwrap_or(other.middle);
        let (mut from, mut before) = (last, beyond(last));
        for &to in polygon.iter() {
            let after = beyond(to);
            if (before > 0.0) != (after > 0.0) {
                let _ = kept.push(from + (to - from) * (before / (before - after)));
            }
            if !(after > 0.0) {
                let _ = kept.push(to);
            }
            (from, before) = (to, after);
        }
        core::mem::swap(&mut polygon, &mut kept);
    }
    for &x in polygon.iter() {
        let gap = dot(out, x - face.middle);
        if gap <= reach {
            visit(x - out * gap, x);
        }
    }
}

/// The four of many spots that hold two best: the deepest, that farthest from it, that farthest from their line, and that farthest from it
/// on the other side.
pub(super) fn four(normal: Vec3, spots: &Spots) -> heapless::Vec<Spot, 4> {
    let mut chosen = heapless::Vec::new();
    if spots.len() <= 4 {
        chosen.extend(spots.iter().copied());
        return chosen;
    }
    let most = |value: &dyn Fn(&Spot) -> f32| {
        let mut best = (0, f32::NEG_INFINITY);
        for (i, spot) in spots.iter().enumerate() {
            let value = value(spot);
            if value > best.1 {
                best = (i, value);
            }
        }
        spots[best.0]
    };
    let first = most(&|[p, q]| -dot(normal, *q - *p));
    let second = most(&|[p, _]| dot(*p - first[0], *p - first[0]));
    let area = |p: Vec3| dot((second[0] - first[0]).cross(p - first[0]), normal);
    let third = most(&|[p, _]| area(*p));
    let fourth = most(&|[p, _]| -area(*p));
    for spot in [first, second, third, fourth] {
        if !chosen.contains(&spot) {
            let _ = chosen.push(spot);
        }
    }
    chosen
}
