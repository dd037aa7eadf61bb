//! A point and a triangle, or two edges, that may come near each other, and what becomes of them in a sub-step: that depends on these
//! two alone, however they were found.

use super::closest::{Closest, Kind};
use super::rest::{Face, Rest};
use crate::math::{high, length, low, min};
use glam::Vec3;

/// The feature that is a triangle as a whole; lesser ones are its corners or edges.
const WHOLE: u32 = 3;

/// Two features of triangles: each a triangle's number in the order of rest, times four, and a feature of it.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Pair {
    first: u32,
    second: u32,
}

impl Pair {
    pub(super) const NONE: Self = Self { first: 0, second: 0 };

    pub(super) fn kind(self) -> Kind {
        if self.second % 4 == WHOLE { Kind::PointTriangle } else { Kind::EdgeEdge }
    }

    /// The triangles that the two belong to.
    pub(super) fn faces(self) -> [usize; 2] {
        [self.first, self.second].map(|feature| (feature / 4) as usize)
    }

    pub(super) fn corners(self, faces: &[Face]) -> [u32; 4] {
        let [one, other] = self.faces().map(|face| &faces[face]);
        let [i, j] = [self.first, self.second].map(|feature| (feature % 4) as usize);
        match self.kind() {
            Kind::PointTriangle => {
                let [a, b, c] = other.corners;
                [one.corners[i], a, b, c]
            }
            Kind::EdgeEdge => {
                let ([a, b], [c, d]) = (one.edge(i), other.edge(j));
                [a, b, c, d]
            }
        }
    }

    /// A triangle's corner and another triangle.
    pub(super) fn of_point([i, corner]: [usize; 2], j: usize) -> Self {
        Self { first: (4 * i + corner) as u32, second: 4 * j as u32 + WHOLE }
    }

    /// An edge of one triangle and one of another.
    pub(super) fn of_edges([i, k]: [usize; 2], [j, l]: [usize; 2]) -> Self {
        Self { first: (4 * i + k) as u32, second: (4 * j + l) as u32 }
    }
}

/// The places of four corners as seen from the first.
pub(super) fn seen(of: &[Vec3], corners: [u32; 4]) -> [Vec3; 4] {
    let [a, b, c, d] = corners;
    let [a, b, c, d] = [of[a as usize], of[b as usize], of[c as usize], of[d as usize]];
    [Vec3::ZERO, b - a, c - a, d - a]
}

/// Tells whether two things are farther than `reach` from each other along an axis, on the same side at both ends: so they are all the way.
pub(super) fn are_apart(kind: Kind, ends: &[[Vec3; 4]; 2], reach: f32) -> bool {
    let gaps = |[a, b, c, d]: &[Vec3; 4]| match kind {
        Kind::PointTriangle => (*a - high(high(*b, *c), *d), low(low(*b, *c), *d) - *a),
        Kind::EdgeEdge => (low(*a, *b) - high(*c, *d), low(*c, *d) - high(*a, *b)),
    };
    let [(above, below), (still_above, still_below)] = [gaps(&ends[0]), gaps(&ends[1])];
    let gap = high(low(above, still_above), low(below, still_below));
    gap.x > reach || gap.y > reach || gap.z > reach
}

impl Rest<'_> {
    /// The thickness that two things keep between them, as far as nothing of one sheet says otherwise.
    pub(super) fn thickness(&self, kind: Kind, corners: [u32; 4]) -> f32 {
        self.half[corners[0] as usize] + self.half[corners[kind.split()] as usize]
    }

    pub(super) fn are_of_one_sheet(&self, kind: Kind, corners: [u32; 4]) -> bool {
        self.sheet[corners[0] as usize] == self.sheet[corners[kind.split()] as usize]
    }

    /// How far apart two are kept: in one sheet no farther than half of what they are at rest.
    pub(super) fn wanted(&self, kind: Kind, corners: [u32; 4]) -> f32 {
        let thickness = self.thickness(kind, corners);
        if !self.are_of_one_sheet(kind, corners) {
            return thickness;
        }
        min(0.5 * length(Closest::of(kind, seen(self.places, corners)).gap), thickness)
    }

    /// How far two are looked for that are kept so far apart: nobody is pushed farther than half of the rest before it is looked again.
    pub(super) fn reach(&self, wanted: f32) -> f32 {
        wanted + 2.0 * self.facts.budget
    }
}

/// Tells whether the nearest place is the triangle's own: where others share it, they are as near, and one of them does for all. Edges
/// touch where they cross; at their ends points do.
pub(super) fn is_own(kind: Kind, weights: &[f32; 4], with: &Face) -> bool {
    let [_, a, b, c] = weights.map(|weight| weight != 0.0);
    match (kind, [a, b, c]) {
        (Kind::EdgeEdge, [a, b, c]) => weights[0] != 0.0 && a && b && c,
        (_, [true, false, false]) => with.owns_corner(0),
        (_, [false, true, false]) => with.owns_corner(1),
        (_, [false, false, true]) => with.owns_corner(2),
        (_, [true, true, false]) => with.owns_edge(0),
        (_, [false, true, true]) => with.owns_edge(1),
        (_, [true, false, true]) => with.owns_edge(2),
        _ => true,
    }
}
