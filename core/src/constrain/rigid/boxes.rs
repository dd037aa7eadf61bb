//! How two boxes are apart: by separating axes.

use super::facets::{Apart, By, Edge, Facet, Faceted};
use crate::math::{clamp, dot, length, min, sqrt};
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

/// By how much of the smaller boxes' size an axis of edges has to be the better one: faces hold steadier.
pub(super) const FACES_FIRST: f32 = 0.02;
/// The squared sine of an angle at which edges count as parallel.
pub(super) const PARALLEL: f32 = 1e-4;

impl Oriented {
    /// How far it reaches along a direction from its middle \[m\].
    fn reach(&self, along: Vec3) -> f32 {
        let Mat3 { x_axis: x, y_axis: y, z_axis: z } = self.axes;
        self.half.x * dot(x, along).abs() + self.half.y * dot(y, along).abs() + self.half.z * dot(z, along).abs()
    }

    /// Its corner with a number from 0 to 7, from its middle along its own axes \[m\].
    pub(super) fn corner(half: Vec3, number: u32) -> Vec3 {
        let side = |bit: u32| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * Vec3::new(side(0), side(1), side(2))
    }

    pub(super) fn least(&self) -> f32 {
        min(self.half.x, min(self.half.y, self.half.z))
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

impl Faceted for Oriented {
    fn face(&self, number: usize, toward: Vec3) -> Facet {
        let out = facing(self.axes.col(number), toward);
        let (i, j) = ((number + 1) % 3, (number + 2) % 3);
        let side = |k: usize| self.axes.col(k) * self.half[k];
        let (middle, u, v) = (self.middle + out * self.half[number], side(i), side(j));
        let mut facet = Facet { middle, out, sides: heapless::Vec::new(), corners: heapless::Vec::new() };
        facet.sides.extend([u, v, -u, -v].map(|side| (side, middle, dot(side, side))));
        facet.corners.extend([middle - u - v, middle + u - v, middle + u + v, middle - u + v]);
        facet
    }

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

    fn edge(&self, number: usize, toward: Vec3) -> Edge {
        let side = |k: usize| facing(self.axes.col(k), toward) * self.half[k];
        let middle = self.middle + side((number + 1) % 3) + side((number + 2) % 3);
        Edge { middle, along: self.axes.col(number), half: self.half[number] }
    }
}

/// An axis, or its opposite, whichever looks in a direction.
fn facing(axis: Vec3, toward: Vec3) -> Vec3 {
    if dot(axis, toward) < 0.0 { -axis } else { axis }
}

/// How two boxes are apart; none if that is more than `bound` \[m\] (Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996).
pub(super) fn apart(a: &Oriented, b: &Oriented, bound: f32) -> Option<Apart> {
    let way = b.middle - a.middle;
    let mut best = Apart { gap: f32::NEG_INFINITY, normal: Vec3::Y, by: By::Face(0, 0) };
    for (side, of) in [a, b].into_iter().enumerate() {
        for axis in 0..3 {
            let normal = facing(of.axes.col(axis), way);
            let gap = dot(normal, way) - a.reach(normal) - b.reach(normal);
            if !(gap <= bound) {
                return None;
            }
            if gap > best.gap {
                best = Apart { gap, normal, by: By::Face(side, axis) };
            }
        }
    }
    let better = FACES_FIRST * min(a.least(), b.least());
    let mut least = best.gap + better;
    for i in 0..3 {
        for j in 0..3 {
            let cross = a.axes.col(i).cross(b.axes.col(j));
            let square = dot(cross, cross);
            if !(square > PARALLEL) {
                continue;
            }
            let normal = facing(cross * (1.0 / sqrt(square)), way);
            let gap = dot(normal, way) - a.reach(normal) - b.reach(normal);
            if !(gap <= bound) {
                return None;
            }
            if gap > least {
                least = gap;
                best = Apart { gap, normal, by: By::Edges(i, j) };
            }
        }
    }
    Some(best)
}
