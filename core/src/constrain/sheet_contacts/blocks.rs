//! Boxes around the ways of the features of a few triangles, side by side: their own edges and, behind these, the triangles.

use super::bounds::Bounds;
use super::rest::{BLOCK, Face};
use crate::lanes::{Eight, LANES};

/// Boxes of a block, and where the triangles' begin, behind as many edges as they can have.
const BOXES: usize = 2 * LANES;
const TRIANGLES: usize = BOXES - BLOCK;
const _: () = assert!(3 * BLOCK <= TRIANGLES);

/// The features of a block of triangles, each of which has a number: four times that of its triangle in the block, and which corner or edge it is.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Block {
    /// The lower and the upper ends of boxes, eight and eight, at the beginning and in the end, along each axis.
    low: [[[[f32; LANES]; 3]; 2]; 2],
    high: [[[[f32; LANES]; 3]; 2]; 2],
    /// The edges that are its own.
    edges: [u8; TRIANGLES],
    /// A bit for each corner that is its own.
    corners: u16,
    /// A bit for each edge, by its place in `edges`, that is of a triangle that counts: with others as well that do not.
    marked: u16,
    /// A bit for each triangle that is sound, and for each of these that counts.
    faces: u8,
    counts: u8,
    /// The number of edges.
    count: u8,
    /// 1 if it is as particles are now.
    fresh: u8,
}

/// The edges, by their places in the block, and the triangles that are near something: a bit for each.
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) edges: u32,
    pub(super) faces: u32,
}

impl Near {
    pub(super) const ALL: Self = Self { edges: u32::MAX, faces: u32::MAX };
}

/// The numbers of bits.
fn each(mut bits: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let first = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (first < u32::BITS).then_some(first as usize)
    })
}

impl Block {
    /// Says that particles have moved, so that boxes are no longer around them.
    pub(super) fn fade(&mut self) {
        self.fresh = 0;
    }

    /// Puts boxes around the ways of these triangles and their own edges, unless that is done, and notes which triangles count; what is not sound has
    /// none, and no feature.
    #[inline(always)]
    pub(super) fn fit(&mut self, faces: &[Face], corners: &[Bounds], counts: impl Fn(usize) -> bool) {
        if self.fresh == 1 {
            return;
        }
        let none = [[[[f32::INFINITY; LANES]; 3]; 2]; 2];
        (self.low, self.high) = (none, [[[[f32::NEG_INFINITY; LANES]; 3]; 2]; 2]);
        (self.count, self.corners, self.fresh) = (0, 0, 1);
        (self.marked, self.faces, self.counts) = (0, 0, 0);
        for (i, face) in faces.iter().take(BLOCK).enumerate() {
            let bounds = Bounds::of_face(face, corners);
            if bounds.is_empty() {
                continue;
            }
            self.put(TRIANGLES + i, &bounds);
            let is_marked = counts(i);
            self.faces |= 1 << i;
            self.counts |= u8::from(is_marked) << i;
            for k in 0..3 {
                self.corners |= u16::from(face.owns_corner(k)) << (4 * i + k);
                if face.owns_edge(k) {
                    let place = self.count as usize;
                    let [a, b] = face.edge(k).map(|corner| &corners[corner as usize]);
                    self.put(place, &a.and(b));
                    self.edges[place] = (4 * i + k) as u8;
                    self.marked |= u16::from(is_marked) << self.count;
                    self.count += 1;
                }
            }
        }
    }

    /// Tells whether a triangle counts, and whether any does.
    pub(super) fn marks(&self, i: usize) -> bool {
        self.counts >> i & 1 != 0
    }

    pub(super) fn is_marked(&self) -> bool {
        self.counts != 0
    }

    #[inline(always)]
    fn put(&mut self, place: usize, bounds: &Bounds) {
        let (half, lane) = (place / LANES, place % LANES);
        for end in 0..2 {
            for axis in 0..3 {
                self.low[half][end][axis][lane] = bounds.low[end][axis];
                self.high[half][end][axis][lane] = bounds.high[end][axis];
            }
        }
    }

    /// A bit for each of eight boxes that overlap another.
    #[inline(always)]
    fn overlaps<F: Eight>(&self, like: F, half: usize, bounds: &Bounds) -> u32 {
        let (low, high) = (&self.low[half], &self.high[half]);
        let mut apart = like.all(0.0);
        for axis in 0..3 {
            let (mut above, mut below) = (like.all(f32::from_bits(u32::MAX)), like.all(f32::from_bits(u32::MAX)));
            for end in 0..2 {
                above = above & like.of(low[end][axis]).simd_gt(like.all(bounds.high[end][axis]));
                below = below & like.all(bounds.low[end][axis]).simd_gt(like.of(high[end][axis]));
            }
            apart = apart | above | below;
        }
        !apart.to_bitmask() & 0xff
    }

    /// A bit for each of its edges.
    fn there(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// The places of its edges of those.
    pub(super) fn edges(&self, of: Near) -> impl Iterator<Item = usize> + use<> {
        each(of.edges & self.there())
    }

    /// The number of an edge.
    pub(super) fn edge(&self, place: usize) -> usize {
        self.edges[place].into()
    }

    /// The box around an edge.
    #[inline(always)]
    pub(super) fn around(&self, place: usize) -> Bounds {
        let (half, lane) = (place / LANES, place % LANES);
        let mut around = Bounds::EMPTY;
        for end in 0..2 {
            for axis in 0..3 {
                around.low[end][axis] = self.low[half][end][axis][lane];
                around.high[end][axis] = self.high[half][end][axis][lane];
            }
        }
        around
    }

    /// Its corners.
    pub(super) fn corners(&self) -> impl Iterator<Item = usize> {
        each(self.corners.into())
    }

    /// The features whose boxes overlap another.
    #[inline(always)]
    pub(super) fn near<F: Eight>(&self, like: F, bounds: &Bounds) -> Near {
        let last = self.overlaps(like, 1, bounds);
        let edges = (self.overlaps(like, 0, bounds) | last << LANES) & self.there();
        Near { edges, faces: last >> (TRIANGLES - LANES) & u32::from(self.faces) }
    }

    /// The places of its edges of those, from one on, whose boxes overlap another: all of them, or of triangles that count.
    #[inline(always)]
    pub(super) fn near_edges<F: Eight>(
        &self,
        like: F,
        of: Near,
        all: bool,
        first: usize,
        bounds: &Bounds,
    ) -> impl Iterator<Item = usize> {
        let near = of.edges & self.there() & u32::MAX << first & if all { u32::MAX } else { self.marked.into() };
        let mut found = 0;
        if near & 0xff != 0 {
            found = self.overlaps(like, 0, bounds);
        }
        if near >> LANES != 0 {
            found |= self.overlaps(like, 1, bounds) << LANES;
        }
        each(near & found)
    }

    /// Its triangles of those whose boxes overlap another: all of them, or those that count.
    #[inline(always)]
    pub(super) fn near_faces<F: Eight>(
        &self,
        like: F,
        of: Near,
        all: bool,
        bounds: &Bounds,
    ) -> impl Iterator<Item = usize> {
        let mut near = of.faces & u32::from(if all { self.faces } else { self.counts });
        if near != 0 {
            near &= self.overlaps(like, 1, bounds) >> (TRIANGLES - LANES);
        }
        each(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{self, Kernel};
    use alloc::vec::Vec;
    use glam::Vec3;

    /// The edges, from one on, and triangles of a block whose boxes overlap a box: all of them, or those that count.
    struct Overlapping<'a>(&'a Block, usize, &'a Bounds, bool);

    impl Kernel for Overlapping<'_> {
        type Output = (Vec<usize>, Vec<usize>);
        #[inline(always)]
        fn run<F: Eight>(self, like: F) -> Self::Output {
            let Self(block, first, bounds, all) = self;
            let near = block.near(like, bounds);
            let edges = block.near_edges(like, near, all, first, bounds).map(|place| block.edge(place)).collect();
            (edges, block.near_faces(like, near, all, bounds).collect())
        }
    }

    #[test]
    fn boxes_side_by_side_overlap_as_one_by_one_do() {
        let mut state = 1u32;
        let mut next = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % most
        };
        let (mut some, mut none) = (0, 0);
        for round in 0..500 {
            // Nine particles, of which one may have no place, and up to four triangles, some of whose features are others'.
            let mut place = || Vec3::from([0; 3].map(|_| next(12) as f32));
            let mut corners: [Bounds; 9] = core::array::from_fn(|_| Bounds::around(place(), place(), 0.5));
            let bounds = Bounds::around(place(), place(), 1.0);
            if round % 3 == 0 {
                corners[next(9) as usize] = Bounds::EMPTY;
            }
            let faces: Vec<Face> = (0..=next(4))
                .map(|_| {
                    bytemuck::cast([next(3), 3 + next(3), 6 + next(3), if round % 5 == 0 { 63 } else { next(64) }])
                })
                .collect();
            let mut block: Block = bytemuck::Zeroable::zeroed();
            block.fit(&faces, &corners, |i| i.is_multiple_of(2));
            let sound = |i: &usize| !Bounds::of_face(&faces[*i], &corners).is_empty();
            let own = |owns: fn(&Face, usize) -> bool| -> Vec<usize> {
                let all = (0..faces.len()).filter(sound).flat_map(|i| [0, 1, 2].map(|k| (i, k)));
                all.filter(|&(i, k)| owns(&faces[i], k)).map(|(i, k)| 4 * i + k).collect()
            };
            let edges = own(Face::owns_edge);
            let listed = block.edges(Near::ALL).map(|place| block.edge(place));
            assert!(listed.eq(edges.iter().copied()));
            assert_eq!(block.corners().collect::<Vec<_>>(), own(Face::owns_corner));
            let first = next(3) as usize;
            let (near, triangles) = lanes::run(Overlapping(&block, first, &bounds, true));
            let touches = |&feature: &usize| {
                let [a, b] = faces[feature / 4].edge(feature % 4).map(|corner| corners[corner as usize]);
                a.and(&b).overlaps(&bounds)
            };
            assert_eq!(near, edges.iter().skip(first).copied().filter(touches).collect::<Vec<_>>());
            let of_faces = |i: &usize| Bounds::of_face(&faces[*i], &corners).overlaps(&bounds);
            assert_eq!(triangles, (0..faces.len()).filter(sound).filter(of_faces).collect::<Vec<_>>());
            let counts = |all: &[usize], each: usize| -> Vec<usize> {
                all.iter().copied().filter(|feature| (feature / each).is_multiple_of(2)).collect()
            };
            let few = lanes::run(Overlapping(&block, first, &bounds, false));
            assert_eq!(few, (counts(&near, 4), counts(&triangles, 1)));
            some += near.len() + triangles.len();
            none += edges.len().saturating_sub(first) - near.len();
        }
        assert!(some > 100 && none > 100, "{some} {none}");
    }
}
