//! Where two boxes touch: by separating axes, and by clipping one's face to the other's.

use crate::math::{clamp, dot, max, min, sqrt};
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

/// The direction along which two boxes are farthest apart, or overlap least.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// How far apart they are \[m\]; below zero where they overlap.
    pub(super) gap: f32,
    /// From the first to the second.
    normal: Vec3,
    by: By,
}

/// The features that the direction belongs to.
#[derive(Clone, Copy, Debug)]
enum By {
    /// A face across an axis of the first, or of the second.
    Face(usize, usize),
    /// Edges along an axis of each.
    Edges(usize, usize),
}

/// A place where two boxes touch, or are about to: on the surface of each \[m\].
pub(super) type Spot = [Vec3; 2];

/// How two boxes touch: the direction from the first to the second, and where.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    pub(super) normal: Vec3,
    pub(super) spots: heapless::Vec<Spot, 8>,
}

/// By how much of the smaller boxes' size an axis of edges has to be the better one: faces hold steadier.
const FACES_FIRST: f32 = 0.02;
/// The squared sine of an angle at which edges count as parallel.
const PARALLEL: f32 = 1e-4;

impl Oriented {
    /// How far it reaches along a direction from its middle \[m\].
    fn reach(&self, along: Vec3) -> f32 {
        let Mat3 { x_axis: x, y_axis: y, z_axis: z } = self.axes;
        self.half.x * dot(x, along).abs() + self.half.y * dot(y, along).abs() + self.half.z * dot(z, along).abs()
    }

    /// A face: its middle, its outward normal and, as its half sides, two vectors.
    fn face(&self, axis: usize, toward: Vec3) -> [Vec3; 4] {
        let out = facing(self.axes.col(axis), toward);
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let side = |k: usize| self.axes.col(k) * self.half[k];
        [self.middle + out * self.half[axis], out, side(i), side(j)]
    }

    /// The middle of the edge along an axis that is farthest in a direction.
    fn edge(&self, axis: usize, toward: Vec3) -> Vec3 {
        let side = |k: usize| facing(self.axes.col(k), toward) * self.half[k];
        self.middle + side((axis + 1) % 3) + side((axis + 2) % 3)
    }

    /// Its face that looks most in a direction.
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

    /// Its corner with a number from 0 to 7, from its middle along its own axes \[m\].
    pub(super) fn corner(half: Vec3, number: u32) -> Vec3 {
        let side = |bit: u32| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * Vec3::new(side(0), side(1), side(2))
    }

    fn least(&self) -> f32 {
        min(self.half.x, min(self.half.y, self.half.z))
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

impl Apart {
    /// The places where they touch, or are at most `reach` \[m\] apart.
    pub(super) fn touching(&self, a: &Oriented, b: &Oriented, reach: f32) -> Touching {
        let normal = self.normal;
        let mut spots = heapless::Vec::new();
        match self.by {
            By::Face(0, axis) => clip(&a.face(axis, normal), b, reach, &mut |on, off| push(&mut spots, [on, off])),
            By::Face(_, axis) => clip(&b.face(axis, -normal), a, reach, &mut |on, off| push(&mut spots, [off, on])),
            By::Edges(i, j) => {
                let (p, q) = (a.edge(i, normal), b.edge(j, -normal));
                if self.gap <= reach {
                    push(&mut spots, nearest([p, a.axes.col(i)], [q, b.axes.col(j)], [a.half[i], b.half[j]]));
                }
            }
        }
        Touching { normal, spots }
    }
}

/// Two convex quadrangles share eight corners at the most, for which there is room.
fn push(spots: &mut heapless::Vec<Spot, 8>, spot: Spot) {
    let _ = spots.push(spot);
}

/// The points of two edges that are nearest to each other: each given by its middle, its direction and half its length.
fn nearest([p, u]: [Vec3; 2], [q, v]: [Vec3; 2], [half, other]: [f32; 2]) -> Spot {
    let (way, cos) = (q - p, dot(u, v));
    let sine = max(1.0 - cos * cos, PARALLEL);
    let s = clamp((dot(u, way) - cos * dot(v, way)) / sine, -half, half);
    let t = clamp(cos * s - dot(v, way), -other, other);
    [p + u * s, q + v * t]
}

/// Visits the places where the face of `of` that looks at a face is within `reach` of it, clipped to that: on the face, and on `of`
/// (Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17, 1974).
fn clip(&[middle, out, u, v]: &[Vec3; 4], of: &Oriented, reach: f32, visit: &mut dyn FnMut(Vec3, Vec3)) {
    let [center, _, s, t] = of.face(of.across(out), -out);
    let mut polygon = heapless::Vec::<Vec3, 8>::new();
    polygon.extend([center - s - t, center + s - t, center + s + t, center - s + t]);
    for side in [u, v, -u, -v] {
        let beyond = |x: Vec3| dot(side, x - middle) - dot(side, side);
        let mut kept = heapless::Vec::<Vec3, 8>::new();
        let last = polygon.last().copied().unwrap_or(center);
        let (mut from, mut before) = (last, beyond(last));
        for &to in &polygon {
            let after = beyond(to);
            if (before > 0.0) != (after > 0.0) {
                let _ = kept.push(from + (to - from) * (before / (before - after)));
            }
            if !(after > 0.0) {
                let _ = kept.push(to);
            }
            (from, before) = (to, after);
        }
        polygon = kept;
    }
    for &x in &polygon {
        let gap = dot(out, x - middle);
        if gap <= reach {
            visit(x - out * gap, x);
        }
    }
}

/// The four of many spots that hold two best: the deepest, that farthest from it, that farthest from their line, and that farthest from it
/// on the other side.
pub(super) fn four(touching: &Touching) -> heapless::Vec<Spot, 4> {
    let Touching { normal, spots } = touching;
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
    let first = most(&|[p, q]| -dot(*normal, *q - *p));
    let second = most(&|[p, _]| dot(*p - first[0], *p - first[0]));
    let area = |p: Vec3| dot((second[0] - first[0]).cross(p - first[0]), *normal);
    let third = most(&|[p, _]| area(*p));
    let fourth = most(&|[p, _]| -area(*p));
    for spot in [first, second, third, fourth] {
        if !chosen.contains(&spot) {
            let _ = chosen.push(spot);
        }
    }
    chosen
}
