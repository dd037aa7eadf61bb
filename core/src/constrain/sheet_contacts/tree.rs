//! Boxes around the ways of triangles, in a tree that their order at rest makes: what is near in the material is near in space.

use super::rest::{BLOCK, Face};
use crate::math::{high, largest, low, max};
use crate::memory::take;
use glam::Vec3;

/// The rounding of places and ways at the most, as a share of the largest coordinate.
pub(super) const ROUNDING: f32 = 5e-7;

/// A box, empty or along a way.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn is_empty(&self) -> bool {
        !(self.low.x <= self.high.x)
    }

    pub(super) fn with(self, place: Vec3) -> Self {
        Self { low: low(place, self.low), high: high(place, self.high) }
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self { low: low(other.low, self.low), high: high(other.high, self.high) }
    }

    pub(super) fn wider(self, by: f32) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (self.low, self.high);
        let (c, d) = (other.low, other.high);
        a.x <= d.x && c.x <= b.x && a.y <= d.y && c.y <= b.y && a.z <= d.z && c.z <= b.z
    }
}

/// Where particles are at the beginning and in the end, the way of all of them together being left out.
#[derive(Clone, Copy)]
pub(super) struct Ways<'m> {
    pub(super) from: &'m [Vec3],
    pub(super) to: &'m [Vec3],
    pub(super) drift: Vec3,
}

/// A perfect binary tree of boxes over blocks of triangles: the children of node i are 2 i and 2 i + 1, the root is 1.
pub(super) struct Tree<'m> {
    /// Boxes around the ways of particles, but for that of all together, and around those of triangles, which are wider.
    corners: &'m mut [Bounds],
    faces: &'m mut [Bounds],
    nodes: &'m mut [Bounds],
    /// 1 for each triangle, and for each node, that is to be visited with all others.
    marks: [&'m mut [u32]; 2],
    blocks: usize,
}

/// Blocks that so many triangles make.
fn blocks(triangles: usize) -> usize {
    triangles.div_ceil(BLOCK).next_power_of_two()
}

/// The words that it takes for so many particles and triangles.
pub(super) fn words([particles, triangles]: [usize; 2]) -> usize {
    let marked = triangles.saturating_add(blocks(triangles).saturating_mul(2));
    marked.saturating_mul(WORDS + 1).saturating_add(particles.saturating_mul(WORDS))
}

/// Words of a box.
const WORDS: usize = size_of::<Bounds>() / 4;

impl<'m> Tree<'m> {
    /// An undefined one.
    pub(super) fn of(rest: &mut &'m mut [u32], [particles, triangles]: [usize; 2]) -> Self {
        let blocks = blocks(triangles);
        let mut boxes = |count: usize| bytemuck::cast_slice_mut(take(rest, count * WORDS));
        let [corners, faces, nodes] = [boxes(particles), boxes(triangles), boxes(2 * blocks)];
        Self { corners, faces, nodes, marks: [take(rest, triangles), take(rest, 2 * blocks)], blocks }
    }

    /// The boxes around the ways of particles.
    pub(super) fn corners(&self) -> &[Bounds] {
        self.corners
    }

    /// Marks some triangles, to be visited with all others; returns how many.
    pub(super) fn mark(&mut self, faces: &[Face], is_marked: impl Fn(&Face) -> bool) -> usize {
        let [triangles, nodes] = &mut self.marks;
        let mut count = 0;
        nodes.fill(0);
        for (number, (mark, face)) in triangles.iter_mut().zip(faces).enumerate() {
            *mark = u32::from(is_marked(face));
            count += *mark as usize;
            nodes[self.blocks + number / BLOCK] |= *mark;
        }
        if count > 0 {
            for node in (1..self.blocks).rev() {
                nodes[node] = nodes[2 * node] | nodes[2 * node + 1];
            }
        }
        count
    }

    /// Puts boxes around the ways of all triangles, wider by what `reach` says of each. A triangle without a sound corner is in none.
    pub(super) fn fit(&mut self, faces: &[Face], ways: Ways<'_>, reach: impl Fn(&Face) -> f32) {
        for (bounds, (&from, &to)) in self.corners.iter_mut().zip(ways.from.iter().zip(ways.to)) {
            let sound = from.is_finite() && to.is_finite();
            *bounds = Bounds::EMPTY;
            if sound {
                let size = max(max(largest(from), largest(to)), largest(ways.drift));
                *bounds = bounds.with(from).with(to - ways.drift).wider(ROUNDING * size);
            }
        }
        for (bounds, face) in self.faces.iter_mut().zip(faces) {
            let [a, b, c] = face.corners;
            let corner = |corner: u32| self.corners.get(corner as usize).filter(|bounds| !bounds.is_empty());
            *bounds = match (corner(a), corner(b), corner(c)) {
                (Some(a), Some(b), Some(c)) => a.and(*b).and(*c).wider(reach(face)),
                _ => Bounds::EMPTY,
            };
        }
        let (inner, leaves) = self.nodes.split_at_mut(self.blocks);
        leaves.fill(Bounds::EMPTY);
        for (leaf, faces) in leaves.iter_mut().zip(self.faces.chunks(BLOCK)) {
            *leaf = faces.iter().fold(Bounds::EMPTY, |sum, &bounds| sum.and(bounds));
        }
        for node in (1..inner.len()).rev() {
            self.nodes[node] = self.nodes[2 * node].and(self.nodes[2 * node + 1]);
        }
    }

    /// Visits every two triangles whose boxes overlap, once: all, or those of which one is marked.
    pub(super) fn pairs(&self, all: bool, mut visit: impl FnMut(usize, usize)) {
        let [triangles, nodes] = &self.marks;
        // Both of two are of one level; each level leaves three of four behind at the most.
        let mut open = [[0usize; 2]; 4 * usize::BITS as usize];
        let mut count = 1;
        open[0] = [1, 1];
        let push = |open: &mut [[usize; 2]], count: &mut usize, pair: [usize; 2]| {
            let counts = all || nodes[pair[0]] | nodes[pair[1]] != 0;
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
                    if all || triangles[i] | triangles[j] != 0 {
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

    /// Visits the triangles of two blocks whose boxes overlap.
    fn within(&self, [a, b]: [usize; 2], mut visit: impl FnMut(usize, usize)) {
        let all = |block: usize| (block * BLOCK).min(self.faces.len())..((block + 1) * BLOCK).min(self.faces.len());
        for i in all(a) {
            for j in all(b) {
                if (a != b || i < j) && self.faces[i].overlaps(&self.faces[j]) {
                    visit(i, j);
                }
            }
        }
    }
}
