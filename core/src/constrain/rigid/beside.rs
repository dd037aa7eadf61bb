//! How boxes are apart: by separating axes, eight times two of them side by side.

use super::body::Body;
use super::boxes::{Oriented, facing};
use super::facets::{Apart, By, FACES_FIRST, PARALLEL};
use super::fours::fours;
use super::manifold::Manifold;
use crate::lanes::{ABREAST, Eight, Kernel, LANES, Row, Vectors, load, min, not, saved};
use crate::math::length;
use bytemuck::Zeroable;
use core::mem::offset_of;

/// Two boxes each, so many times as go side by side at the most.
pub(super) struct Beside<'a> {
    pub(super) bodies: &'a [Body],
    /// The numbers of each two.
    pub(super) pairs: &'a [[u32; 2]],
    /// How far apart they are at the most \[m\]: how far others are is not told.
    pub(super) bound: Row,
}

/// How they are apart.
pub(super) struct Gaps {
    /// How far \[m\].
    gap: Row,
    /// The number of the axis: those of three faces of the first, three of the second, then of each edge of the first with each of the second.
    by: Row,
    /// A bit for each two of which that is told.
    near: u32,
}

impl Gaps {
    /// Tells whether two are as near as was asked for.
    pub(super) fn is_near(&self, lane: usize) -> bool {
        self.near >> lane & 1 != 0
    }

    /// How far two are apart \[m\]; none: farther than was asked for.
    pub(super) fn gap(&self, lane: usize) -> Option<f32> {
        self.gap.get(lane).copied().filter(|_| self.is_near(lane))
    }

    /// By which of their features two are apart.
    pub(super) fn apart(&self, lane: usize, [a, b]: [&Oriented; 2]) -> Apart {
        let number = self.by[lane] as usize;
        let (axis, by) = match number {
            0..3 => (a.axes.col(number), By::Face(0, number)),
            3..6 => (b.axes.col(number - 3), By::Face(1, number - 3)),
            _ => {
                let (i, j) = ((number - 6) / 3 % 3, number % 3);
                let cross = a.axes.col(i).cross(b.axes.col(j));
                (cross * (1.0 / length(cross)), By::Edges(i, j))
            }
        };
        Apart { gap: self.gap[lane], normal: facing(axis, b.middle - a.middle), by }
    }
}

impl Kernel for Beside<'_> {
    type Output = Gaps;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Gaps {
        let nobody = Body::zeroed();
        let mut all = [[&nobody; LANES]; 2];
        for (lane, numbers) in self.pairs.iter().enumerate().take(ABREAST) {
            for side in 0..2 {
                all[side][lane] = self.bodies.get(numbers[side] as usize).unwrap_or(&nobody);
            }
        }
        Two::of([Boxes::of(like, &all[0]), Boxes::of(like, &all[1])]).apart(load(like, &self.bound))
    }
}

/// The words of a body that are read in fours.
const CENTER: usize = offset_of!(Body, center) / 4;
const WHIRL: usize = offset_of!(Body, whirl) / 4;
const HALF: usize = offset_of!(Body, half) / 4;

/// How far pairs may go against each other in a sub-step of `h` \[s\]: those with some numbers, as many as go side by side at the most \[m\].
pub(super) struct Ways<'a> {
    pub(super) bodies: &'a [Body],
    pub(super) pairs: &'a [Manifold],
    pub(super) numbers: &'a [u32],
    pub(super) h: f32,
}

impl Kernel for Ways<'_> {
    type Output = Row;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Row {
        let nobody = Body::zeroed();
        let (mut first, mut second) = ([&nobody; LANES], [&nobody; LANES]);
        for (lane, &number) in self.numbers.iter().enumerate().take(ABREAST) {
            let Some(pair) = self.pairs.get(number as usize) else { continue };
            first[lane] = self.bodies.get(pair.bodies[0] as usize).unwrap_or(&nobody);
            second[lane] = self.bodies.get(pair.bodies[1] as usize).unwrap_or(&nobody);
        }
        let ([whirl, _, a, b], [c, ..]) = (fours(like, &first, WHIRL), fours(like, &first, WHIRL + 4));
        let ([other, _, x, y], [z, ..]) = (fours(like, &second, WHIRL), fours(like, &second, WHIRL + 4));
        let apart = Vectors([a, b, c]) - Vectors([x, y, z]);
        saved((apart.length() + whirl + other) * like.all(self.h))
    }
}

/// Eight boxes.
struct Boxes<F> {
    middle: Vectors<F>,
    axes: [Vectors<F>; 3],
    half: [F; 3],
}

impl<F: Eight> Boxes<F> {
    #[inline(always)]
    fn of(like: F, bodies: &[&Body; LANES]) -> Self {
        let [a, b, c, i] = fours(like, bodies, CENTER);
        let [j, k, xx, xy] = fours(like, bodies, CENTER + 4);
        let [xz, yx, yy, yz] = fours(like, bodies, CENTER + 8);
        let [zx, zy, zz, _] = fours(like, bodies, CENTER + 12);
        let [l, m, n, _] = fours(like, bodies, HALF);
        let axes = [Vectors([xx, xy, xz]), Vectors([yx, yy, yz]), Vectors([zx, zy, zz])];
        Self { middle: Vectors([a, b, c]) - (axes[0] * i + axes[1] * j + axes[2] * k), axes, half: [l, m, n] }
    }
}

/// Eight times two boxes as the first sees the second.
struct Two<F> {
    /// Half the sides of each \[m\].
    half: [[F; 3]; 2],
    /// The way from the middle of the first to that of the second, along the sides of each \[m\].
    way: [[F; 3]; 2],
    /// How far each side's direction of the first goes along each of the second, and the same without signs.
    cos: [[F; 3]; 3],
    steep: [[F; 3]; 3],
}

/// How far they are apart across the axis that is the best so far, and its number.
struct Best<F> {
    most: F,
    by: F,
    /// What an axis of edges has to come up to.
    least: F,
    /// Where no axis has been beyond the bound.
    near: F,
}

impl<F: Eight> Two<F> {
    #[inline(always)]
    fn of([a, b]: [Boxes<F>; 2]) -> Self {
        // Closures over arrays would not be spread over their callers.
        let (way, ([u, v, w], [x, y, z])) = (b.middle - a.middle, (a.axes, b.axes));
        let cos = [[u.dot(x), u.dot(y), u.dot(z)], [v.dot(x), v.dot(y), v.dot(z)], [w.dot(x), w.dot(y), w.dot(z)]];
        let steep = [
            [cos[0][0].abs(), cos[0][1].abs(), cos[0][2].abs()],
            [cos[1][0].abs(), cos[1][1].abs(), cos[1][2].abs()],
            [cos[2][0].abs(), cos[2][1].abs(), cos[2][2].abs()],
        ];
        let way = [[way.dot(u), way.dot(v), way.dot(w)], [way.dot(x), way.dot(y), way.dot(z)]];
        Self { half: [a.half, b.half], way, cos, steep }
    }

    /// How they are apart, none where that is more than a bound (Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996).
    #[inline(always)]
    fn apart(&self, bound: F) -> Gaps {
        let [[x, y, z], [l, m, n]] = self.half;
        let (least, other, zero) = (min(x, min(y, z)), min(l, min(m, n)), bound.all(0.0));
        let all = not(zero);
        let mut best = Best { most: bound.all(f32::NEG_INFINITY), by: zero, least: zero, near: all };
        for axis in 0..3 {
            self.across_face(0, axis, bound, &mut best);
        }
        for axis in 0..3 {
            self.across_face(1, axis, bound, &mut best);
        }
        best.least = best.most + bound.all(FACES_FIRST) * min(least, other);
        for i in 0..3 {
            for j in 0..3 {
                self.across_edges(i, j, bound, &mut best);
            }
        }
        Gaps { gap: saved(best.most), by: saved(best.by), near: best.near.to_bitmask() }
    }

    /// Looks how far they are apart across a face of the first, or of the second.
    #[inline(always)]
    fn across_face(&self, side: usize, axis: usize, bound: F, best: &mut Best<F>) {
        let ([x, y, z], steep) = (self.half[1 - side], &self.steep);
        let reach = if side == 0 {
            x * steep[axis][0] + y * steep[axis][1] + z * steep[axis][2]
        } else {
            x * steep[0][axis] + y * steep[1][axis] + z * steep[2][axis]
        };
        let gap = self.way[side][axis].abs() - self.half[side][axis] - reach;
        best.near = best.near & gap.simd_le(bound);
        let is_better = gap.simd_gt(best.most);
        best.most = is_better.select(gap, best.most);
        best.by = is_better.select(bound.all((3 * side + axis) as f32), best.by);
    }

    /// Looks how far they are apart across an edge of each, unless these are parallel, or that is below zero and not more than `least`.
    #[inline(always)]
    fn across_edges(&self, i: usize, j: usize, bound: F, best: &mut Best<F>) {
        let ([half, other], [p, q], [k, l]) = (self.half, [(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        let (cos, steep, way) = (&self.cos, &self.steep, self.way[0]);
        let reach = half[p] * steep[q][j] + half[q] * steep[p][j] + other[k] * steep[i][l] + other[l] * steep[i][k];
        let gap = (way[q] * cos[p][j] - way[p] * cos[q][j]).abs() - reach;
        let square = cos[p][j] * cos[p][j] + cos[q][j] * cos[q][j];
        // The sine is one at the most.
        let is_above = gap.simd_gt(best.least) | gap.simd_gt(bound.all(0.0));
        let counts = square.simd_gt(bound.all(PARALLEL)) & is_above;
        let gap = gap / square.sqrt();
        best.near = best.near & (not(counts) | gap.simd_le(bound));
        let is_better = counts & gap.simd_gt(best.least);
        best.least = is_better.select(gap, best.least);
        best.most = is_better.select(gap, best.most);
        best.by = is_better.select(bound.all((6 + 3 * i + j) as f32), best.by);
    }
}
