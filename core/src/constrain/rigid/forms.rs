//! The forms of bodies for those that touch them: boxes, hulls, balls.

use super::RigidBox;
use super::body::Body;
use super::boxes;
use super::facets::{Apart, By, Edge, FACES_FIRST, Facet, Faceted, PARALLEL};
use super::hull::{CORNERS, FACES, Hull, HullEdge, HullFace, HullList, corner};
use crate::math::{dot, length, min, sqrt};
use glam::{Mat3, Vec3};

/// The form of a body.
#[derive(Clone, Copy)]
pub(super) enum Form<'a> {
    Box,
    Hull(Hull<'a>),
    /// One of several hulls that a body consists of.
    Piece(Hull<'a>),
    /// A loose particle with a radius.
    Ball,
}

/// The forms of all bodies.
#[derive(Clone, Copy)]
pub(super) struct Forms<'a> {
    pub(super) boxes: &'a [RigidBox],
    pub(super) hulls: &'a dyn HullList,
}

impl<'a> Forms<'a> {
    /// The form of a piece of the body with a number, from 1; what comes after the scene's bodies are balls.
    pub(super) fn piece(&self, number: u32, piece: u8) -> Form<'a> {
        let Some(of) = self.boxes.get((number as usize).wrapping_sub(1)) else { return Form::Ball };
        let hull = of.hull.and_then(|hull| self.hulls.hull(usize::from(hull) + usize::from(piece)));
        hull.map_or(Form::Box, if of.pieces > 1 { Form::Piece } else { Form::Hull })
    }

    /// How many pieces a body has: those of its hulls that there are.
    pub(super) fn count(&self, number: u32) -> u8 {
        let Some(of) = self.boxes.get((number as usize).wrapping_sub(1)) else { return 1 };
        let Some(first) = of.hull.filter(|_| of.pieces > 1) else { return 1 };
        let is_there = |piece: &u8| self.hulls.hull(usize::from(first) + usize::from(*piece)).is_some();
        (0..of.pieces.min(u16::from(u8::MAX)) as u8).take_while(is_there).count().max(1) as u8
    }

    /// The forms of all pieces of a body.
    pub(super) fn pieces(self, number: u32) -> impl Iterator<Item = Form<'a>> {
        (0..self.count(number)).map(move |piece| self.piece(number, piece))
    }

    /// How far out of a body a place of its frame is \[m\]: below zero inside.
    pub(super) fn gap(self, number: u32, body: &Body, place: Vec3) -> f32 {
        self.pieces(number).fold(f32::INFINITY, |least, form| min(least, form.nearest(body, place).2))
    }

    /// Tells whether both of two are boxes.
    pub(super) fn are_boxes(&self, numbers: [u32; 2]) -> bool {
        numbers.iter().all(|&number| matches!(self.piece(number, 0), Form::Box))
    }
}

impl Form<'_> {
    /// The place on its surface that is nearest to a place of a body's frame \[m\], the way out there, and how far out the place is \[m\]: below zero
    /// inside.
    pub(super) fn nearest(&self, body: &Body, place: Vec3) -> (Vec3, Vec3, f32) {
        match self {
            Self::Box => boxes::nearest(body.half, place),
            Self::Hull(hull) | Self::Piece(hull) => {
                let (on, out, far) = hull.nearest(place - hull.center);
                (on + hull.center, out, far)
            }
            Self::Ball => {
                let far = length(place);
                let out = if far > 0.0 { place * (1.0 / far) } else { Vec3::Y };
                (out * body.radius, out, far - body.radius)
            }
        }
    }

    /// The number of its corners.
    pub(super) fn corners(&self) -> usize {
        match self {
            Self::Box => 8,
            Self::Hull(hull) | Self::Piece(hull) => hull.corners.len(),
            Self::Ball => 0,
        }
    }

    /// The normal of the face that looks most in a direction, in the body's frame.
    pub(super) fn facing(&self, toward: Vec3) -> Vec3 {
        match self {
            Self::Box => {
                let (x, y, z) = (toward.x.abs(), toward.y.abs(), toward.z.abs());
                let axis = if x >= y && x >= z {
                    Vec3::X
                } else if y >= z {
                    Vec3::Y
                } else {
                    Vec3::Z
                };
                axis * axis.dot(toward).signum()
            }
            Self::Hull(hull) | Self::Piece(hull) => {
                let mut best = (toward, f32::NEG_INFINITY);
                for face in hull.faces {
                    let along = dot(face.normal, toward);
                    if along > best.1 {
                        best = (face.normal, along);
                    }
                }
                best.0
            }
            Self::Ball => toward,
        }
    }

    /// The corner of it that is farthest in a direction, in the body's frame \[m\].
    pub(super) fn farthest(&self, body: &Body, toward: Vec3) -> Vec3 {
        match self {
            Self::Box => {
                Vec3::from_array([0, 1, 2].map(|k| if toward[k] < 0.0 { -body.half[k] } else { body.half[k] }))
            }
            Self::Hull(hull) | Self::Piece(hull) => hull.farthest(toward) + hull.center,
            Self::Ball => toward * body.radius,
        }
    }

    /// Where its middle is \[m\].
    pub(super) fn middle(&self, body: &Body) -> Vec3 {
        match self {
            Self::Hull(hull) | Self::Piece(hull) => body.beside_middle(hull.center),
            Self::Box | Self::Ball => body.middle(),
        }
    }

    /// Half the sides of the box about that which holds it \[m\].
    pub(super) fn half(&self, body: &Body) -> Vec3 {
        if let Self::Piece(hull) = self { hull.half() } else { body.half }
    }

    /// A length that is small beside it \[m\].
    pub(super) fn small(&self, body: &Body) -> f32 {
        body.small_for(self.half(body))
    }

    /// One of them, in the body's frame \[m\].
    pub(super) fn corner(&self, body: &Body, number: usize) -> Vec3 {
        match self {
            Self::Hull(hull) | Self::Piece(hull) => {
                hull.corners.get(number).map_or(Vec3::ZERO, |&corner| corner + hull.center)
            }
            _ => corner(body.half, number as u32),
        }
    }
}

/// How two bodies with faces are apart, of which one is a hull. Calls `then` with that and both, for their features, unless it is more than
/// `bound` \[m\]. It takes much of the stack, of which boxes alone are spared.
#[inline(never)]
pub(super) fn with_hulls(
    [a, b]: [&Body; 2],
    forms: [Form<'_>; 2],
    bound: f32,
    then: &mut dyn FnMut(&Apart, [&dyn Faceted; 2]),
) {
    let lends = [BoxHull::of(a.half), BoxHull::of(b.half)];
    let hull = |side: usize| match forms[side] {
        Form::Hull(hull) | Form::Piece(hull) => hull,
        Form::Box | Form::Ball => lends[side].lend(),
    };
    let (a, b) = (Posed::new(a, hull(0), forms[0].half(a)), Posed::new(b, hull(1), forms[1].half(b)));
    if let Some(apart) = apart(&a, &b, bound) {
        then(&apart, [&a, &b]);
    }
}

/// A box as a hull: its corners, numbered by the signs of their coordinates, and its faces.
struct BoxHull {
    corners: [Vec3; 8],
    faces: [HullFace; 6],
}

/// The corners of a box's faces: x, −x, y, −y, z, −z.
const LOOPS: [u8; 24] = [1, 3, 7, 5, 0, 4, 6, 2, 2, 6, 7, 3, 0, 1, 5, 4, 4, 5, 7, 6, 0, 2, 3, 1];
/// The ends of a box's edges, and the faces on their left and right.
const EDGES: [HullEdge; 12] = {
    const fn edge(from: u8, to: u8, left: u8, right: u8) -> HullEdge {
        HullEdge { ends: [from, to], faces: [left, right] }
    }
    [
        edge(1, 3, 0, 5),
        edge(3, 7, 0, 2),
        edge(5, 7, 4, 0),
        edge(1, 5, 3, 0),
        edge(0, 4, 1, 3),
        edge(4, 6, 1, 4),
        edge(2, 6, 2, 1),
        edge(0, 2, 5, 1),
        edge(6, 7, 2, 4),
        edge(2, 3, 5, 2),
        edge(0, 1, 3, 5),
        edge(4, 5, 4, 3),
    ]
};

impl BoxHull {
    fn of(half: Vec3) -> Self {
        let face = |number: usize| {
            let mut normal = Vec3::ZERO;
            normal[number / 2] = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
            HullFace { normal, offset: half[number / 2], first: 4 * number as u16, count: 4 }
        };
        Self { corners: core::array::from_fn(|i| corner(half, i as u32)), faces: core::array::from_fn(face) }
    }

    fn lend(&self) -> Hull<'_> {
        Hull { center: Vec3::ZERO, corners: &self.corners, faces: &self.faces, loops: &LOOPS, edges: &EDGES }
    }
}

/// A hull that stands somewhere.
struct Posed<'a> {
    hull: Hull<'a>,
    /// Where its centroid is \[m\].
    middle: Vec3,
    axes: Mat3,
    /// Its corners as they are turned, from there \[m\].
    corners: heapless::Vec<Vec3, CORNERS>,
    /// A length of its size \[m\].
    least: f32,
}

impl<'a> Posed<'a> {
    /// `half` are half the sides of the box that holds it \[m\].
    fn new(body: &Body, hull: Hull<'a>, half: Vec3) -> Self {
        let mut corners = heapless::Vec::new();
        corners.extend(hull.corners.iter().take(CORNERS).map(|&corner| body.rotation * corner));
        let Vec3 { x, y, z } = half;
        Self { hull, middle: body.beside_middle(hull.center), axes: body.rotation, corners, least: min(x, min(y, z)) }
    }

    /// How far it reaches along a direction from its middle \[m\].
    fn reach(&self, along: Vec3) -> f32 {
        self.corners.iter().fold(f32::NEG_INFINITY, |most, &corner| crate::math::max(most, dot(along, corner)))
    }

    /// The ends of an edge, from its middle, and the normals of the faces on its left and right.
    fn edge_of(&self, edge: &HullEdge) -> ([Vec3; 2], [Vec3; 2]) {
        let corner = |number: u8| self.corners.get(usize::from(number)).copied().unwrap_or(Vec3::ZERO);
        let normal =
            |number: u8| self.hull.faces.get(usize::from(number)).map_or(Vec3::ZERO, |face| self.axes * face.normal);
        (edge.ends.map(corner), edge.faces.map(normal))
    }
}

impl Faceted for Posed<'_> {
    fn face(&self, number: usize, _: Vec3) -> Facet {
        let mut facet =
            Facet { middle: self.middle, out: Vec3::Y, sides: heapless::Vec::new(), corners: heapless::Vec::new() };
        let Some(face) = self.hull.faces.get(number) else { return facet };
        facet.out = self.axes * face.normal;
        facet.middle += facet.out * face.offset;
        let corners = self.hull.polygon(face).map(|corner| self.middle + self.axes * corner);
        facet.corners.extend(corners.take(facet.corners.capacity()));
        for (i, &from) in facet.corners.iter().enumerate() {
            let to = facet.corners[(i + 1) % facet.corners.len()];
            let _ = facet.sides.push(((to - from).cross(facet.out), from, 0.0));
        }
        facet
    }

    fn across(&self, toward: Vec3) -> usize {
        let toward = self.axes.transpose() * toward;
        let mut best = (0, f32::NEG_INFINITY);
        for (number, face) in self.hull.faces.iter().enumerate() {
            let along = dot(face.normal, toward);
            if along > best.1 {
                best = (number, along);
            }
        }
        best.0
    }

    fn edge(&self, number: usize, _: Vec3) -> Edge {
        let [from, to] = self.hull.edges.get(number).map_or([Vec3::ZERO; 2], |edge| self.edge_of(edge).0);
        let (middle, far) = ((from + to) * 0.5, length(to - from));
        Edge { middle: self.middle + middle, along: (to - from) * (1.0 / far), half: 0.5 * far }
    }
}

/// How two hulls are apart; none if that is more than `bound` \[m\] (Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013).
fn apart(a: &Posed<'_>, b: &Posed<'_>, bound: f32) -> Option<Apart> {
    let way = b.middle - a.middle;
    let mut best = Apart { gap: f32::NEG_INFINITY, normal: Vec3::Y, by: By::Face(0, 0) };
    for (side, [of, other], way) in [(0, [a, b], way), (1, [b, a], -way)] {
        for (number, face) in of.hull.faces.iter().enumerate() {
            let normal = of.axes * face.normal;
            let gap = dot(normal, way) - other.reach(-normal) - face.offset;
            if !(gap <= bound) {
                return None;
            }
            if gap > best.gap {
                let normal = if side == 0 { normal } else { -normal };
                best = Apart { gap, normal, by: By::Face(side, number) };
            }
        }
    }
    let least = best.gap + FACES_FIRST * min(a.least, b.least);
    let edges = apart_by_edges(a, b, way, least);
    match edges {
        Some(edges) if !(edges.gap <= bound) => None,
        edges => Some(edges.unwrap_or(best)),
    }
}

/// The two edges that are farthest apart across both, if that is more than `least` \[m\]: of those whose arcs on the Gauss map, the second's
/// turned round, cross each other, so that they make a face of the Minkowski difference.
#[inline(never)]
fn apart_by_edges(a: &Posed<'_>, b: &Posed<'_>, way: Vec3, mut least: f32) -> Option<Apart> {
    let mut others = heapless::Vec::<([Vec3; 2], [Vec3; 2]), { CORNERS + FACES }>::new();
    others.extend(b.hull.edges.iter().take(CORNERS + FACES).map(|edge| b.edge_of(edge)));
    let mut best = None;
    for (i, edge) in a.hull.edges.iter().enumerate() {
        let ([p, to], [left, right]) = a.edge_of(edge);
        let u = to - p;
        for (j, &([q, end], [other_left, other_right])) in others.iter().enumerate() {
            let v = end - q;
            // Signs of the volumes of three normals each; right × left of an edge is along −u, and of −b's along −v.
            let [c, d] = [dot(other_left, u), dot(other_right, u)];
            let [e, f] = [-dot(left, v), -dot(right, v)];
            if !(c * d < 0.0 && e * f < 0.0 && c * f > 0.0) {
                continue;
            }
            let cross = u.cross(v);
            let square = dot(cross, cross);
            if !(square > PARALLEL * dot(u, u) * dot(v, v)) {
                continue;
            }
            let across = cross * (1.0 / sqrt(square));
            let normal = if dot(across, p) < 0.0 { -across } else { across };
            let gap = dot(normal, way + q - p);
            if gap > least {
                least = gap;
                best = Some(Apart { gap, normal, by: By::Edges(i, j) });
            }
        }
    }
    best
}
