//! A point and a triangle, or two edges, that may come near each other, and what becomes of them in a sub-step: that depends on these
//! two alone, however they were found.

use super::closest::{Closest, Kind, Meeting};
use super::contact::Contact;
use super::rest::{Face, Rest};
use super::tree::Bounds;
use crate::math::{high, length, low, max, min};
use glam::Vec3;

/// How much of the distance between two each may go before it has to be looked again: less than half of it.
pub(super) const SHARE: f32 = 0.45;
/// Two that come so near to each other, as a share of their thickness, have come together.
const NEAR: f32 = 0.1;
/// The share of a gap that is missing that a sub-step gives back.
const RECOVERY: f32 = 0.2;
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

    /// Visits the corners of one triangle with the other, and the edges of one with those of the other, as far as they are their own,
    /// have no corner in common, and the boxes around their corners' ways are within `reach`.
    #[inline(always)]
    pub(super) fn all(
        faces: &[Face],
        [i, j]: [usize; 2],
        ways: &[Bounds],
        reach: f32,
        mut visit: impl FnMut(Self, [u32; 4]),
    ) {
        let [one, other] = [&faces[i], &faces[j]];
        let ([a, b, c], [p, q, r]) = (one.corners, other.corners);
        let way = |corner: u32| ways[corner as usize];
        let [a, b, c, p, q, r] = [way(a), way(b), way(c), way(p), way(q), way(r)];
        let [first, second] = [a.and(b).and(c).wider(reach), p.and(q).and(r).wider(reach)];
        Self::points(i, one, [a, b, c], (j, other, &second), &mut visit);
        Self::points(j, other, [p, q, r], (i, one, &first), &mut visit);
        let edges = [p.and(q), q.and(r), r.and(p)];
        for (k, edge) in [a.and(b), b.and(c), c.and(a)].into_iter().enumerate() {
            if !(one.owns_edge(k) && edge.overlaps(&second)) {
                continue;
            }
            let ([p, q], around) = (one.edge(k), edge.wider(reach));
            for (l, edge) in edges.iter().enumerate().filter(|&(l, _)| other.owns_edge(l)) {
                let [r, s] = other.edge(l);
                let strangers = p != r && p != s && q != r && q != s;
                if strangers && edge.overlaps(&around) {
                    visit(Self { first: (4 * i + k) as u32, second: (4 * j + l) as u32 }, [p, q, r, s]);
                }
            }
        }
    }

    /// Visits the corners of one triangle that come near the other.
    #[inline(always)]
    fn points(
        i: usize,
        of: &Face,
        ways: [Bounds; 3],
        (j, with, around): (usize, &Face, &Bounds),
        visit: &mut impl FnMut(Self, [u32; 4]),
    ) {
        let [p, q, r] = with.corners;
        for (k, way) in ways.iter().enumerate().filter(|&(k, _)| of.owns_corner(k)) {
            let corner = of.corners[k];
            if corner != p && corner != q && corner != r && way.overlaps(around) {
                visit(Self { first: (4 * i + k) as u32, second: 4 * j as u32 + WHOLE }, [corner, p, q, r]);
            }
        }
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

    /// How far apart two are kept: in one sheet no farther than half of what they are at rest.
    pub(super) fn wanted(&self, kind: Kind, corners: [u32; 4]) -> f32 {
        let (sheet, thickness) = (|corner: u32| self.sheet[corner as usize], self.thickness(kind, corners));
        if sheet(corners[0]) != sheet(corners[kind.split()]) {
            return thickness;
        }
        min(0.5 * length(Closest::of(kind, seen(self.places, corners)).gap), thickness)
    }

    /// How far two are looked for that are kept so far apart: nobody is pushed farther than half of the rest before it is looked again.
    pub(super) fn reach(&self, wanted: f32) -> f32 {
        wanted + 2.0 * self.facts.budget
    }
}

/// Looks at pairs, and lists what comes of them.
pub(super) struct Look<'m, 'r> {
    pub(super) rest: &'m Rest<'r>,
    pub(super) from: &'m [Vec3],
    pub(super) now: &'m [Vec3],
    /// How far each may be pushed from where it is.
    pub(super) room: &'m mut [f32],
    pub(super) contacts: &'m mut [Contact],
    /// The number of contacts, and of those that found no room.
    pub(super) count: usize,
    pub(super) lost: u64,
    /// The number of pairs that would pass each other.
    pub(super) meetings: u32,
}

impl Look<'_, '_> {
    /// Looks at two of which it is not known how far apart they are kept.
    pub(super) fn at(&mut self, pair: Pair, corners: [u32; 4]) {
        let (kind, rest) = (pair.kind(), self.rest);
        let ends = [seen(self.from, corners), seen(self.now, corners)];
        if !are_apart(kind, &ends, rest.reach(rest.thickness(kind, corners))) {
            self.meet(pair, corners, &ends, rest.wanted(kind, corners));
        }
    }

    /// Looks at two that are kept so far apart.
    pub(super) fn with(&mut self, pair: Pair, wanted: f32) {
        let corners = pair.corners(self.rest.faces);
        let ends = [seen(self.from, corners), seen(self.now, corners)];
        self.meet(pair, corners, &ends, wanted);
    }

    fn meet(&mut self, pair: Pair, corners: [u32; 4], ends: &[[Vec3; 4]; 2], wanted: f32) {
        let (kind, reach) = (pair.kind(), self.rest.reach(wanted));
        if are_apart(kind, ends, reach) {
            return;
        }
        let near = NEAR * max(wanted, self.rest.facts.budget);
        let Some(meeting) = Meeting::of(kind, ends, reach, near) else { return };
        let Meeting { closest, distance: [begun, ended], meets } = meeting;
        if !meets && ended >= reach {
            return;
        }
        for corner in corners {
            let room = &mut self.room[corner as usize];
            *room = min(SHARE * ended, *room);
        }
        self.meetings += u32::from(meets);
        if !meets && !is_own(kind, &closest.weights, &self.rest.faces[pair.faces()[1]]) {
            return;
        }
        let normal = closest.gap / length(closest.gap);
        if !normal.is_finite() {
            return;
        }
        let Some(place) = self.contacts.get_mut(self.count) else {
            self.lost += 1;
            return;
        };
        self.count += 1;
        let recovery = RECOVERY * max(wanted - begun, 0.0);
        let target = if begun < wanted { begun + recovery } else { wanted };
        let (split, weights, meets) = (kind.split() as u32, closest.weights, u32::from(meets));
        let (touch, tangent) = (bytemuck::Zeroable::zeroed(), bytemuck::Zeroable::zeroed());
        *place = Contact { corners, split, weights, normal, target, recovery, meets, touch, tangent };
    }
}

/// Tells whether the nearest place is the triangle's own: where others share it, they are as near, and one of them does for all. Edges
/// touch where they cross; at their ends points do.
fn is_own(kind: Kind, weights: &[f32; 4], with: &Face) -> bool {
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
