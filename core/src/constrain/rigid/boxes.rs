//! Boxes: their faces, edges and corners.

use super::body::Body;
use super::facets::{Apart, By, Edge, Spots, nearest_of, push};
use crate::math::{clamp, dot, length};
use glam::{Mat3, Vec3};

/// A box that stands anywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oriented {
    /// Its middle \[m\].
    pub(super) middle: Vec3,
    /// The directions of its sides.
    pub(super) axes: Mat3,
    /// Half its sides \[m\].
    pub(super) half: Vec3,
}

impl Oriented {
    /// That of a body.
    pub(super) fn of(body: &Body) -> Self {
        Self { middle: body.middle(), axes: body.rotation, half: body.half }
    }
}

/// The place on the surface of a box of these half sides about the origin that is nearest to a place \[m\], the way out there, and how far out the
/// place is \[m\]: below zero inside.
pub(super) fn nearest(half: Vec3, place: Vec3) -> (Vec3, Vec3, f32) {
    let held = Vec3::from_array([0, 1, 2].map(|k| clamp(place[k], -half[k], half[k])));
    let away = held - place;
    let distance = length(away);
    if distance > 0.0 {
        return (held, away * (-1.0 / distance), distance);
    }
    let depth = [0, 1, 2].map(|k| half[k] - place[k].abs());
    let axis = if depth[0] <= depth[1] && depth[0] <= depth[2] {
        0
    } else if depth[1] <= depth[2] {
        1
    } else {
        2
    };
    let side = if place[axis] < 0.0 { -1.0 } else { 1.0 };
    let (mut on, mut normal) = (held, Vec3::ZERO);
    (on[axis], normal[axis]) = (side * half[axis], side);
    (on, normal, -depth[axis])
}

/// A face of a box: a point in its middle, the way out, and from the middle to two of its sides \[m\].
struct Side {
    middle: Vec3,
    out: Vec3,
    across: [Vec3; 2],
}

impl Oriented {
    /// The one of two opposite faces that looks more in a direction.
    fn side(&self, number: usize, toward: Vec3) -> Side {
        let out = facing(self.axes.col(number), toward);
        let side = |k: usize| self.axes.col(k) * self.half[k];
        let across = [side((number + 1) % 3), side((number + 2) % 3)];
        Side { middle: self.middle + out * self.half[number], out, across }
    }

    /// The number of the face that looks most in a direction, or of the opposite one.
    fn across(&self, toward: Vec3) -> usize {
        let [x, y, z] = [0, 1, 2].map(|k| dot(self.axes.col(k), toward).abs());
        if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        }
    }

    /// The one of four parallel edges that is farthest in a direction.
    fn edge(&self, number: usize, toward: Vec3) -> Edge {
        let side = |k: usize| facing(self.axes.col(k), toward) * self.half[k];
        let middle = self.middle + side((number + 1) % 3) + side((number + 2) % 3);
        Edge { middle, along: self.axes.col(number), half: self.half[number] }
    }
}

/// The corners of a face that has been clipped to another: each of four sides adds one at the most.
const CLIPPED: usize = 8;

/// Adds the places where two boxes touch that are apart in a way, or are at most `reach` \[m\] apart: what [`Apart::touching`] does with any two.
pub(super) fn touching([a, b]: [&Oriented; 2], apart: &Apart, reach: f32, spots: &mut Spots) {
    let normal = apart.normal;
    match apart.by {
        By::Face(0, face) => clip([a, b], (face, normal), reach, &mut |on, off| push(spots, [on, off])),
        By::Face(_, face) => clip([b, a], (face, -normal), reach, &mut |on, off| push(spots, [off, on])),
        By::Edges(i, j) => {
            if apart.gap <= reach {
                push(spots, nearest_of(&a.edge(i, normal), &b.edge(j, -normal)));
            }
        }
    }
}

/// Visits the places where the face of a box that looks at a face of another is within `reach` \[m\] of it, clipped to that.
#[inline(always)]
fn clip([one, other]: [&Oriented; 2], (number, toward): (usize, Vec3), reach: f32, visit: &mut impl FnMut(Vec3, Vec3)) {
    let Side { middle, out, across: [u, v] } = one.side(number, toward);
    let Side { middle: m, across: [p, q], .. } = other.side(other.across(-out), -out);
    let mut polygon = heapless::Vec::<Vec3, CLIPPED>::new();
    polygon.extend([m - p - q, m + p - q, m + p + q, m - p + q]);
    for side in [u, v, -u, -v] {
        let limit = dot(side, side);
        cut(&mut polygon, |x| dot(side, x - middle) - limit);
    }
    for &x in &polygon {
        let gap = dot(out, x - middle);
        if gap <= reach {
            visit(x - out * gap, x);
        }
    }
}

/// Cuts off a polygon what is beyond a plane.
#[inline(always)]
fn cut(polygon: &mut heapless::Vec<Vec3, CLIPPED>, beyond: impl Fn(Vec3) -> f32) {
    let mut far = [0.0; CLIPPED];
    for (far, &x) in far.iter_mut().zip(&*polygon) {
        *far = beyond(x);
    }
    if !far.iter().any(|&far| far > 0.0) {
        return;
    }
    let (all, len) = (polygon.clone(), polygon.len());
    polygon.clear();
    for (i, (&to, &after)) in all.iter().zip(&far).enumerate() {
        let last = if i > 0 { i - 1 } else { len - 1 };
        let (from, before) = (all[last], far[last]);
        if (before > 0.0) != (after > 0.0) {
            let _ = polygon.push(from + (to - from) * (before / (before - after)));
        }
        if !(after > 0.0) {
            let _ = polygon.push(to);
        }
    }
}

/// An axis, or its opposite, whichever looks in a direction.
pub(super) fn facing(axis: Vec3, toward: Vec3) -> Vec3 {
    if dot(axis, toward) < 0.0 { -axis } else { axis }
}
