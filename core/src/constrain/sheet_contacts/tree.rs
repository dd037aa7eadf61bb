//! Boxes around the ways of triangles, in a tree that their order at rest makes: what is near in the material is near in space.

use super::blocks::{Block, Near};
use super::bounds::Bounds;
use super::pair::Pair;
use super::rest::{BLOCK, Face, Rest};
use crate::lanes::{self, Eight, Kernel};
use crate::math::max;
use crate::memory::take;
use glam::Vec3;

/// Where particles are at the beginning and in the end.
#[derive(Clone, Copy)]
pub(super) struct Ways<'m> {
    pub(super) from: &'m [Vec3],
    pub(super) to: &'m [Vec3],
}

/// A perfect binary tree of boxes over blocks of triangles: the children of node i are 2 i and 2 i + 1, the root is 1.
pub(super) struct Tree<'m> {
    /// Boxes around the ways of particles, wider than these, and by how much they are wider.
    corners: &'m mut [Bounds],
    reach: &'m mut [f32],
    nodes: &'m mut [Bounds],
    /// Boxes of the features of each block.
    inside: &'m mut [Block],
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
    let each = |count: usize, words: usize| count.saturating_mul(words);
    let nodes = each(blocks(triangles), 2 * (WORDS[0] + 1));
    let inside = each(triangles.div_ceil(BLOCK), WORDS[1]);
    nodes.saturating_add(inside).saturating_add(triangles).saturating_add(each(particles, WORDS[0] + 1))
}

/// Words of a box, and of a block.
const WORDS: [usize; 2] = [size_of::<Bounds>() / 4, size_of::<Block>() / 4];

impl<'m> Tree<'m> {
    /// An undefined one.
    pub(super) fn of(rest: &mut &'m mut [u32], [particles, triangles]: [usize; 2]) -> Self {
        let blocks = blocks(triangles);
        let mut boxes = |count: usize| bytemuck::cast_slice_mut(take(rest, count * WORDS[0]));
        let [corners, nodes] = [boxes(particles), boxes(2 * blocks)];
        let inside = bytemuck::cast_slice_mut(take(rest, triangles.div_ceil(BLOCK) * WORDS[1]));
        let [reach, strays] = [particles, triangles].map(|count| bytemuck::cast_slice_mut(take(rest, count)));
        Self { corners, reach, nodes, inside, strays, marks: take(rest, 2 * blocks), blocks }
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

    /// Puts boxes around the ways of all particles, wider by what `reach` says of half the thickness of any of their triangles, and around those of
    /// triangles. A triangle with a corner that is not sound is in none.
    pub(super) fn fit(
        &mut self,
        (rest, uniform): (&Rest<'_>, Option<f32>),
        ways: Ways<'_>,
        reach: impl Fn(f32) -> f32,
    ) {
        let faces = &*rest.faces;
        // Who has no triangle may have any reach.
        self.reach.fill(uniform.map_or(0.0, &reach));
        if uniform.is_none() {
            for face in faces {
                let reach = reach(rest.widest(face));
                for corner in face.corners {
                    if let Some(far) = self.reach.get_mut(corner as usize) {
                        *far = max(reach, *far);
                    }
                }
            }
        }
        let ends = ways.from.iter().zip(ways.to);
        for ((bounds, &reach), (&from, &to)) in self.corners.iter_mut().zip(&*self.reach).zip(ends) {
            let sound = from.is_finite() && to.is_finite();
            *bounds = if sound { Bounds::around(from, to, reach) } else { Bounds::EMPTY };
        }
        self.inside.iter_mut().for_each(Block::fade);
        let (inner, leaves) = self.nodes.split_at_mut(self.blocks);
        leaves.fill(Bounds::EMPTY);
        for (leaf, faces) in leaves.iter_mut().zip(faces.chunks(BLOCK)) {
            *leaf = faces.iter().fold(Bounds::EMPTY, |sum, face| sum.and(&Bounds::of_face(face, self.corners)));
        }
        for node in (1..inner.len()).rev() {
            self.nodes[node] = self.nodes[2 * node].and(&self.nodes[2 * node + 1]);
        }
    }

    /// Visits every two features whose boxes overlap that have no corner in common: of all triangles, or those of which one's is marked.
    pub(super) fn pairs(&mut self, faces: &[Face], all: bool, visit: impl FnMut(Pair, [u32; 4])) {
        lanes::run_at_length(Visit { tree: self, faces, all, visit });
    }
}

/// A visit of all pairs.
struct Visit<'a, 'm, V> {
    tree: &'a mut Tree<'m>,
    faces: &'a [Face],
    all: bool,
    visit: V,
}

impl<V: FnMut(Pair, [u32; 4])> Kernel for Visit<'_, '_, V> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        // Both of two are of one level; each level leaves three of four behind at the most.
        let mut open = [[0usize; 2]; 4 * usize::BITS as usize];
        let mut count = 1;
        open[0] = [1, 1];
        while count > 0 {
            count -= 1;
            let [a, b] = open[count];
            if a >= self.tree.blocks {
                self.blocks(like, [a - self.tree.blocks, b - self.tree.blocks]);
                continue;
            }
            let later = if a != b { [2 * a + 1, 2 * b] } else { [0; 2] };
            for pair in [later, [2 * a, 2 * b + 1], [2 * a + 1, 2 * b + 1], [2 * a, 2 * b]] {
                if pair != [0; 2] && self.are_near(pair) {
                    open[count] = pair;
                    count += 1;
                }
            }
        }
    }
}

impl<V: FnMut(Pair, [u32; 4])> Visit<'_, '_, V> {
    /// Tells whether two nodes have anything to visit.
    #[inline(always)]
    fn are_near(&self, [a, b]: [usize; 2]) -> bool {
        let Tree { nodes, marks, .. } = &*self.tree;
        (self.all || marks[a] | marks[b] != 0) && (a == b || nodes[a].overlaps(&nodes[b]))
    }

    /// Visits the features of two blocks, or of one.
    #[inline(always)]
    fn blocks<F: Eight>(&mut self, like: F, [a, b]: [usize; 2]) {
        // Those without triangles fill the tree up.
        if b >= self.tree.inside.len() {
            return;
        }
        self.fit(a);
        self.fit(b);
        let near = [self.near(like, [a, b]), self.near(like, [b, a])];
        self.points(like, [a, b], near[1]);
        if a != b {
            self.points(like, [b, a], near[0]);
        }
        self.edges(like, [a, b], near);
    }

    /// What of a block is near another one, which is all that can be near any of that.
    #[inline(always)]
    fn near<F: Eight>(&self, like: F, [a, b]: [usize; 2]) -> Near {
        let Tree { inside, nodes, blocks, .. } = &*self.tree;
        if a == b { Near::ALL } else { inside[a].near(like, &nodes[blocks + b]) }
    }

    /// Puts boxes around a block's features.
    #[inline(always)]
    fn fit(&mut self, block: usize) {
        let Self { tree: Tree { inside, corners, strays, .. }, all, faces, .. } = self;
        let first = BLOCK * block;
        let faces = &faces[first..faces.len().min(first + BLOCK)];
        inside[block].fit(faces, corners, |i| *all || strays[first + i] == f32::INFINITY);
    }

    /// Visits the corners of one block with those triangles of another that are near it.
    #[inline(always)]
    fn points<F: Eight>(&mut self, like: F, [a, b]: [usize; 2], near: Near) {
        let Self { tree, faces, visit, .. } = self;
        let (one, other, around) = (&tree.inside[a], &tree.inside[b], &tree.nodes[tree.blocks + b]);
        let some = other.is_marked();
        for feature in one.corners() {
            let (i, k) = (feature / 4, feature % 4);
            let corner = faces[BLOCK * a + i].corners[k];
            let bounds = &tree.corners[corner as usize];
            let counts = one.marks(i);
            if !(counts || some) || near.faces == 0 || !bounds.overlaps(around) {
                continue;
            }
            for j in other.near_faces(like, near, counts, bounds).map(|j| BLOCK * b + j) {
                let [p, q, r] = faces[j].corners;
                if corner != p && corner != q && corner != r {
                    visit(Pair::of_point([BLOCK * a + i, k], j), [corner, p, q, r]);
                }
            }
        }
    }

    /// Visits the edges of one block with those of another, of both those that are near the other one.
    #[inline(always)]
    fn edges<F: Eight>(&mut self, like: F, [a, b]: [usize; 2], [near, other_near]: [Near; 2]) {
        let Self { tree, faces, visit, .. } = self;
        let (one, other) = (&tree.inside[a], &tree.inside[b]);
        let some = other.is_marked();
        if other_near.edges == 0 {
            return;
        }
        for place in one.edges(near) {
            let (i, k) = (one.edge(place) / 4, one.edge(place) % 4);
            let ([p, q], counts) = (faces[BLOCK * a + i].edge(k), one.marks(i));
            if !(counts || some) {
                continue;
            }
            let bounds = one.around(place);
            let first = if a == b { place + 1 } else { 0 };
            for place in other.near_edges(like, other_near, counts, first, &bounds) {
                let feature = other.edge(place);
                let (j, l) = (BLOCK * b + feature / 4, feature % 4);
                let [r, s] = faces[j].edge(l);
                if p != r && p != s && q != r && q != s {
                    visit(Pair::of_edges([BLOCK * a + i, k], [j, l]), [p, q, r, s]);
                }
            }
        }
    }
}
