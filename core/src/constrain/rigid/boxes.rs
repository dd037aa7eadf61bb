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

/// Two boxes as the first sees the second.
struct Beside {
    /// Half the sides of each \[m\].
    half: [[f32; 3]; 2],
    /// The way from the middle of the first to that of the second, along the sides of each \[m\].
    way: [[f32; 3]; 2],
    /// How far each side's direction of the first goes along each of the second, and the same without signs.
    cos: [[f32; 3]; 3],
    steep: [[f32; 3]; 3],
}

impl Beside {
    #[inline(always)]
    fn new(a: &Oriented, b: &Oriented) -> Self {
        let way = b.middle - a.middle;
        let axes = |of: &Oriented| [of.axes.x_axis, of.axes.y_axis, of.axes.z_axis];
        let (u, v) = (axes(a), axes(b));
        let (mut cos, mut steep, mut ways) = ([[0.0; 3]; 3], [[0.0; 3]; 3], [[0.0; 3]; 2]);
        for i in 0..3 {
            (ways[0][i], ways[1][i]) = (dot(way, u[i]), dot(way, v[i]));
            for j in 0..3 {
                cos[i][j] = dot(u[i], v[j]);
                steep[i][j] = cos[i][j].abs();
            }
        }
        Self { half: [a.half.to_array(), b.half.to_array()], way: ways, cos, steep }
    }

    /// How far they are apart across a face of the first, or of the second \[m\].
    #[inline(always)]
    fn across_face(&self, side: usize, axis: usize) -> f32 {
        let ([x, y, z], steep) = (self.half[1 - side], &self.steep);
        let reach = if side == 0 {
            x * steep[axis][0] + y * steep[axis][1] + z * steep[axis][2]
        } else {
            x * steep[0][axis] + y * steep[1][axis] + z * steep[2][axis]
        };
        self.way[side][axis].abs() - self.half[side][axis] - reach
    }

    /// How far they are apart across an edge of each \[m\]; none if these are parallel, or if that is below zero and not above `least`.
    #[inline(always)]
    fn across_edges(&self, i: usize, j: usize, least: f32) -> Option<f32> {
        let ([half, other], [p, q], [k, l]) = (self.half, [(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        let (cos, steep, way) = (&self.cos, &self.steep, self.way[0]);
        let reach = half[p] * steep[q][j] + half[q] * steep[p][j] + other[k] * steep[i][l] + other[l] * steep[i][k];
        let gap = (way[q] * cos[p][j] - way[p] * cos[q][j]).abs() - reach;
        let square = cos[p][j] * cos[p][j] + cos[q][j] * cos[q][j];
        // The sine is one at the most.
        (square > PARALLEL && (gap > least || gap > 0.0)).then(|| gap / sqrt(square))
    }
}

/// How two boxes are apart; none if that is more than `bound` \[m\] (Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996).
pub(super) fn apart(a: &Oriented, b: &Oriented, bound: f32) -> Option<Apart> {
    let (beside, way) = (Beside::new(a, b), b.middle - a.middle);
    let (mut most, mut by) = (f32::NEG_INFINITY, By::Face(0, 0));
    for side in 0..2 {
        for axis in 0..3 {
            let gap = beside.across_face(side, axis);
            if !(gap <= bound) {
                return None;
            }
            if gap > most {
                (most, by) = (gap, By::Face(side, axis));
            }
        }
    }
    let mut least = most + FACES_FIRST * min(a.least(), b.least());
    for i in 0..3 {
        for j in 0..3 {
            let Some(gap) = beside.across_edges(i, j, least) else { continue };
            if !(gap <= bound) {
                return None;
            }
            if gap > least {
                (least, most, by) = (gap, gap, By::Edges(i, j));
            }
        }
    }
    let axis = match by {
        By::Face(0, axis) => a.axes.col(axis),
        By::Face(_, axis) => b.axes.col(axis),
        By::Edges(i, j) => {
            let cross = a.axes.col(i).cross(b.axes.col(j));
            cross * (1.0 / length(cross))
        }
    };
    Some(Apart { gap: most, normal: facing(axis, way), by })
}
