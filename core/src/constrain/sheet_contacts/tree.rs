//! Boxes around the ways of triangles, in a tree that their order at rest makes: what is near in the material is near in space.

use super::rest::{BLOCK, Face};
use crate::math::{largest, max};
use crate::memory::take;
use glam::Vec3;
use wide::f32x4;

/// The rounding of places and ways at the most, as a share of the largest coordinate.
pub(super) const ROUNDING: f32 = 5e-7;

/// Boxes around something at the beginning of a way and in its end, each with a number behind it that does not count.
///
/// Ways are straight, so what is apart along an axis at both ends, on the same side, is so all the way: what goes along together is told apart
/// however far it goes.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Bounds {
    low: [[f32; 4]; 2],
    high: [[f32; 4]; 2],
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: [[f32::INFINITY; 4]; 2], high: [[f32::NEG_INFINITY; 4]; 2] };

    /// So far around the way of a place; that has to be sound.
    fn around(from: Vec3, to: Vec3, reach: f32) -> Self {
        let reach = reach + ROUNDING * max(largest(from), largest(to));
        let corner = |place: Vec3| [place.x, place.y, place.z, 0.0];
        Self { low: [corner(from - reach), corner(to - reach)], high: [corner(from + reach), corner(to + reach)] }
    }

    fn is_empty(&self) -> bool {
        !(self.low[0][0] <= self.high[0][0])
    }

    #[inline(always)]
    pub(super) fn and(&self, other: &Self) -> Self {
        let low = |end: usize| f32x4::new(self.low[end]).fast_min(f32x4::new(other.low[end])).to_array();
        let high = |end: usize| f32x4::new(self.high[end]).fast_max(f32x4::new(other.high[end])).to_array();
        Self { low: [low(0), low(1)], high: [high(0), high(1)] }
    }

    #[inline(always)]
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let above = |a: &Self, b: &Self| {
            let end = |end: usize| f32x4::new(a.low[end]).simd_gt(f32x4::new(b.high[end]));
            end(0) & end(1)
        };
        (above(self, other) | above(other, self)).to_bitmask() & 7 == 0
    }
}

/// Where particles are at the beginning and in the end.
#[derive(Clone, Copy)]
pub(super) struct Ways<'m> {
    pub(super) from: &'m [Vec3],
    pub(super) to: &'m [Vec3],
}

/// A perfect binary tree of boxes over blocks of triangles: the children of node i are 2 i and 2 i + 1, the root is 1.
pub(super) struct Tree<'m> {
    /// Boxes around the ways of particles, wider than these, and of triangles, and by how much they are wider.
    corners: &'m mut [Bounds],
    reach: &'m mut [f32],
    faces: &'m mut [Bounds],
    nodes: &'m mut [Bounds],
    /// How far each triangle has left the way that is expected of it \[m\]: infinitely far, if it is to be visited with all others.
    strays: &'m mut [f32],
    /// 1 for each node with such a triangle.
    marks: &'m mut [u32],
    blocks: usize,
}

/// Blocks that so many triangles make.
fn blocks(triangles: usize) -> usize {
    triangles.div_ceil(BLOCK).next_power_of_two()
}

/// The words that it takes for so many particles and triangles.
pub(super) fn words([particles, triangles]: [usize; 2]) -> usize {
    let marked = triangles.saturating_add(blocks(triangles).saturating_mul(2));
    marked.saturating_mul(WORDS + 1).saturating_add(particles.saturating_mul(WORDS + 1))
}

/// Words of a box.
const WORDS: usize = size_of::<Bounds>() / 4;

impl<'m> Tree<'m> {
    /// An undefined one.
    pub(super) fn of(rest: &mut &'m mut [u32], [particles, triangles]: [usize; 2]) -> Self {
        let blocks = blocks(triangles);
        let mut boxes = |count: usize| bytemuck::cast_slice_mut(take(rest, count * WORDS));
        let [corners, faces, nodes] = [boxes(particles), boxes(triangles), boxes(2 * blocks)];
        let [reach, strays] = [particles, triangles].map(|count| bytemuck::cast_slice_mut(take(rest, count)));
        Self { corners, reach, faces, nodes, strays, marks: take(rest, 2 * blocks), blocks }
    }

    /// The boxes around the ways of particles.
    pub(super) fn corners(&self) -> &[Bounds] {
        self.corners
    }

    /// The box around a triangle's way, wider as it was fit.
    pub(super) fn face(&self, face: usize) -> &Bounds {
        &self.faces[face]
    }

    /// How far triangles have left the ways that are expected of them \[m\].
    pub(super) fn strays(&self) -> &[f32] {
        self.strays
    }

    /// Notes how far triangles have left the ways that are expected of them, infinitely far if they are to be visited with all others; returns how many
    /// these are.
    pub(super) fn mark(&mut self, faces: &[Face], stray: impl Fn(&Face) -> f32) -> usize {
        let mut count = 0;
        self.marks.fill(0);
        for (number, (far, face)) in self.strays.iter_mut().zip(faces).enumerate() {
            *far = stray(face);
            let is_astray = *far == f32::INFINITY;
            count += usize::from(is_astray);
            self.marks[self.blocks + number / BLOCK] |= u32::from(is_astray);
        }
        if count > 0 {
            for node in (1..self.blocks).rev() {
                self.marks[node] = self.marks[2 * node] | self.marks[2 * node + 1];
            }
        }
        count
    }

    /// Puts boxes around the ways of all particles, wider by what `reach` says of any of their triangles, and around those of triangles. A
    /// triangle with a corner that is not sound is in none.
    pub(super) fn fit(&mut self, faces: &[Face], ways: Ways<'_>, reach: impl Fn(&Face) -> f32) {
        self.reach.fill(0.0);
        for face in faces {
            let reach = reach(face);
            for corner in face.corners {
                if let Some(far) = self.reach.get_mut(corner as usize) {
                    *far = max(reach, *far);
                }
            }
        }
        let ends = ways.from.iter().zip(ways.to);
        for ((bounds, &reach), (&from, &to)) in self.corners.iter_mut().zip(&*self.reach).zip(ends) {
            let sound = from.is_finite() && to.is_finite();
            *bounds = if sound { Bounds::around(from, to, reach) } else { Bounds::EMPTY };
        }
        for (bounds, face) in self.faces.iter_mut().zip(faces) {
            let [a, b, c] = face.corners;
            let corner = |corner: u32| self.corners.get(corner as usize).filter(|bounds| !bounds.is_empty());
            *bounds = match (corner(a), corner(b), corner(c)) {
                (Some(a), Some(b), Some(c)) => a.and(b).and(c),
                _ => Bounds::EMPTY,
            };
        }
        let (inner, leaves) = self.nodes.split_at_mut(self.blocks);
        leaves.fill(Bounds::EMPTY);
        for (leaf, faces) in leaves.iter_mut().zip(self.faces.chunks(BLOCK)) {
            *leaf = faces.iter().fold(Bounds::EMPTY, |sum, bounds| sum.and(bounds));
        }
        for node in (1..inner.len()).rev() {
            self.nodes[node] = self.nodes[2 * node].and(&self.nodes[2 * node + 1]);
        }
    }

    /// Visits every two triangles whose boxes overlap, once: all, or those of which one is marked.
    pub(super) fn pairs(&self, all: bool, mut visit: impl FnMut(usize, usize)) {
        // Both of two are of one level; each level leaves three of four behind at the most.
        let mut open = [[0usize; 2]; 4 * usize::BITS as usize];
        let mut count = 1;
        open[0] = [1, 1];
        let push = |open: &mut [[usize; 2]], count: &mut usize, pair: [usize; 2]| {
            let counts = all || self.marks[pair[0]] | self.marks[pair[1]] != 0;
            if counts && (pair[0] == pair[1] || self.nodes[pair[0]].overlaps(&self.nodes[pair[1]])) {
                open[*count] = pair;
                *count += 1;
            }
        };
        while count > 0 {
            count -= 1;
            let [a, b] = open[count];
            if a >= self.blocks {
                self.within([a - self.blocks, b - self.blocks], |i, j| {
                    if all || self.strays[i] == f32::INFINITY || self.strays[j] == f32::INFINITY {
                        visit(i, j);
                    }
                });
                continue;
            }
            if a != b {
                push(&mut open, &mut count, [2 * a + 1, 2 * b]);
            }
            for pair in [[2 * a, 2 * b + 1], [2 * a + 1, 2 * b + 1], [2 * a, 2 * b]] {
                push(&mut open, &mut count, pair);
            }
        }
    }

    /// Visits the triangles of two blocks whose boxes overlap; of two blocks, only those that are near the other one at all.
    fn within(&self, [a, b]: [usize; 2], mut visit: impl FnMut(usize, usize)) {
        let all = |block: usize| (block * BLOCK).min(self.faces.len())..((block + 1) * BLOCK).min(self.faces.len());
        if a == b {
            for i in all(a) {
                for j in i + 1..all(a).end {
                    if self.faces[i].overlaps(&self.faces[j]) {
                        visit(i, j);
                    }
                }
            }
            return;
        }
        let (of_a, of_b) = (&self.nodes[self.blocks + a], &self.nodes[self.blocks + b]);
        let near_a = all(b).fold(0_u32, |near, j| near | u32::from(self.faces[j].overlaps(of_a)) << (j - b * BLOCK));
        for i in all(a).filter(|&i| near_a != 0 && self.faces[i].overlaps(of_b)) {
            for j in all(b).filter(|&j| near_a >> (j - b * BLOCK) & 1 != 0) {
                if self.faces[i].overlaps(&self.faces[j]) {
                    visit(i, j);
                }
            }
        }
    }
}
