//! The parts that all trees share: nodes in one flat list, each with the box around its points, and the way through
//! them.
//!
//! Nodes come in the order of a walk that goes down first, and each knows where to go on if its points are of no
//! interest, so that a walk needs neither pointers nor a stack. The trees differ in how they split, and only there.

use super::domain::{Domain, Image, constructors};
use super::frames::Frames;
use super::nearest::Nearest;
use super::partition::Partition;
use super::region::{Region, Run};
use super::search::{Search, answers};
use super::sorted::{LANES, Probe, Sorted};
use super::split::{CHILDREN, Split, bounds};
use super::{Cost, Facts, Neighbour, SpatialIndex, Stats, TooSmall};
use crate::math;
use core::ops::{ControlFlow, Range};
use glam::Vec3;

/// A node: what of the points it holds, and where.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Node {
    low: [f32; 3],
    high: [f32; 3],
    /// Its first slot; the last is before the first of the node to go on with.
    first: u32,
    /// The node to go on with if this one is of no interest.
    next: u32,
}

/// Words of a node.
const NODE: usize = size_of::<Node>() / 4;

impl Node {
    pub(super) fn low(&self) -> Vec3 {
        Vec3::from_array(self.low)
    }
    pub(super) fn high(&self) -> Vec3 {
        Vec3::from_array(self.high)
    }
    /// The node to go on with if this one is of no interest.
    pub(super) fn next(&self) -> usize {
        self.next as usize
    }
}

/// A tree over points: [`Kd`](super::Kd), [`Bsp`](super::Bsp), [`Octree`](super::Octree), [`Quadtree`](super::Quadtree)
/// and [`Bvh`](super::Bvh), which differ in how they split a node, `S`, and in nothing else.
///
/// The reach to build with makes no difference to it. If the memory has room for all points but not for all nodes, leaves
/// are larger, which [`Stats::crowded`] counts. Refitting keeps the nodes and draws their boxes anew.
#[derive(Debug)]
pub struct Tree<'m, S> {
    sorted: Sorted<'m>,
    /// `len` nodes, and one that says where the last one's points end.
    nodes: &'m mut [Node],
    /// The frames of their boxes; empty unless boxes are turned.
    turned: &'m mut [u32],
    frames: Frames<'m>,
    len: usize,
    depth: usize,
    fullest: usize,
    crowded: usize,
    split: S,
}

/// Deeper than this no node is split: coordinates have no more bits.
const DEEPEST: u32 = 64;
/// Nodes that wait to be built, or to be searched.
const WAITING: usize = 256;

impl<'m, S: Split> Tree<'m, S> {
    constructors!();

    /// Tells its facts from those of structures whose memory is divided in another way.
    const NAME: u32 = u32::from_le_bytes([b't', S::BYTES as u8, S::TURNS as u8, 0]);

    pub(super) const fn words(points: usize) -> usize {
        points.saturating_mul(7 + S::BYTES / 4).saturating_add(4 * LANES + 4 * NODE)
    }

    fn in_domain(memory: &'m mut [u32], domain: Domain) -> Self {
        let capacity = memory.len().saturating_sub(Self::words(0)) / (7 + S::BYTES / 4);
        let (sorted, rest) = Sorted::new(memory, capacity, domain);
        // A sixteenth is for frames, and a word a node says which is its.
        let (frames, rest) = rest.split_at_mut(if S::TURNS { rest.len() / 144 * 9 } else { 0 });
        let nodes = rest.len() / if S::TURNS { NODE + 1 } else { NODE };
        let (nodes, rest) = rest.split_at_mut(nodes * NODE);
        let frames = Frames::new(frames);
        let turned = if S::TURNS { rest } else { &mut [] };
        let nodes = bytemuck::cast_slice_mut(nodes);
        Self { sorted, nodes, turned, frames, len: 0, depth: 0, fullest: 0, crowded: 0, split: S::default() }
    }

    /// Makes the nodes and sorts the entries by them.
    fn grow(&mut self) {
        let len = self.sorted.len;
        if len == 0 {
            return;
        }
        self.frames.hold(self.sorted.low, self.sorted.high);
        // Nodes are dealt out as if leaves were five eighths full. If that is not enough, larger leaves everywhere are
        // better than a huge one where they ran out.
        let room = self.nodes.len() - 1;
        let mut leaf = S::LEAF.max((16 * len).div_ceil(5 * room));
        while !self.grow_to(leaf, room) {
            leaf *= 2;
        }
        self.sorted.spread();
        self.link();
    }

    /// Makes the nodes with leaves of a given size. False if they are too many; of one leaf there are never too many.
    fn grow_to(&mut self, leaf: usize, room: usize) -> bool {
        let len = self.sorted.len;
        (self.len, self.depth, self.fullest, self.crowded) = (0, 0, 0, 0);
        self.frames.clear();
        let root = self.split.root(self.sorted.low, self.sorted.high);
        let mut waiting = heapless::Vec::<_, WAITING>::new();
        let _ = waiting.push((0..len, 0u32, root));
        let mut children = heapless::Vec::new();
        while let Some((slots, depth, mut cell)) = waiting.pop() {
            let entries = &mut self.sorted.entries()[slots.clone()];
            let frame = self.split.frame(&mut cell, entries, &mut self.frames);
            let bounds = match frame {
                0 => bounds(entries),
                _ => self.frames.bounds(frame, entries.iter().map(|entry| Vec3::from_array(entry.x))),
            };
            let [low, high] = bounds.map(|corner| corner.to_array());
            self.nodes[self.len] = Node { low, high, first: slots.start as u32, next: slots.end as u32 };
            if let Some(turned) = self.turned.get_mut(self.len) {
                *turned = frame;
            }
            self.len += 1;
            self.depth = self.depth.max(depth as usize);
            children.clear();
            if slots.len() > leaf {
                if room - self.len - waiting.len() < CHILDREN {
                    return false;
                }
                if WAITING - waiting.len() >= CHILDREN && depth < DEEPEST {
                    self.split.split(cell, bounds, entries, &self.frames, &mut children);
                }
            }
            if children.len() < 2 {
                self.fullest = self.fullest.max(slots.len());
                self.crowded += usize::from(slots.len() > S::LEAF);
                continue;
            }
            // Backwards, so that the first is built next.
            for i in (0..children.len()).rev() {
                let start = if i == 0 { 0 } else { children[i - 1].0 };
                let (end, cell) = children[i];
                let _ = waiting.push((slots.start + start..slots.start + end, depth + 1, cell));
            }
        }
        true
    }

    /// Says where to go on from each node, which knows by now where its points end: with the first node that begins
    /// there.
    fn link(&mut self) {
        let len = self.sorted.len as u32;
        let (_, first_at) = self.sorted.rows_and_scratch();
        self.nodes[self.len] = Node { first: len, next: self.len as u32, ..Node::default() };
        for i in (0..=self.len).rev() {
            let Node { first, next: end, .. } = self.nodes[i];
            if i < self.len {
                self.nodes[i].next = first_at[end as usize];
            }
            // Parents come before their children, so what stays is the highest that begins here.
            first_at[first as usize] = i as u32;
        }
    }

    /// The points.
    pub(super) fn points(&self) -> &Sorted<'m> {
        &self.sorted
    }

    /// All nodes, and one that says where the last one's points end.
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes[..if self.len == 0 { 0 } else { self.len + 1 }]
    }

    /// The slots of a node.
    pub(super) fn all_slots(&self, node: usize) -> Range<usize> {
        self.nodes[node].first as usize..self.nodes[self.nodes[node].next()].first as usize
    }

    pub(super) fn is_leaf(&self, node: usize) -> bool {
        self.nodes[node].next as usize == node + 1
    }

    /// The slots of a leaf.
    #[inline(always)]
    pub(super) fn slots(&self, leaf: usize) -> Range<usize> {
        self.nodes[leaf].first as usize..self.nodes[leaf + 1].first as usize
    }

    /// Draws the boxes anew around where the points are now.
    fn redraw(&mut self) {
        self.frames.hold(self.sorted.low, self.sorted.high);
        for i in (0..self.len).rev() {
            let frame = self.frame(i);
            let same = |child: usize| self.frame(child) == frame;
            let [low, high] = if self.is_leaf(i) && frame == 0 {
                self.sorted.bounds(self.slots(i))
            } else if !self.is_leaf(i) && self.children(i).all(same) {
                let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
                for child in self.children(i) {
                    low = math::low(self.nodes[child].low(), low);
                    high = math::high(self.nodes[child].high(), high);
                }
                [low, high]
            } else {
                self.frames.bounds(frame, self.all_slots(i).map(|slot| self.sorted.point(slot)))
            };
            (self.nodes[i].low, self.nodes[i].high) = (low.to_array(), high.to_array());
        }
    }

    /// The frame of a node's box.
    #[inline(always)]
    fn frame(&self, node: usize) -> u32 {
        if S::TURNS { self.turned[node] } else { 0 }
    }

    #[inline(always)]
    pub(super) fn children(&self, node: usize) -> impl Iterator<Item = usize> + Clone {
        let end = self.nodes[node].next as usize;
        let first = (node + 1 < end).then_some(node + 1);
        core::iter::successors(first, move |&child| {
            let next = self.nodes[child].next as usize;
            (next < end).then_some(next)
        })
    }

    /// The square of the distance from a region to a node; `view` remembers the region in the frame of the last one.
    #[inline(always)]
    fn square(&self, node: usize, region: &Region, view: &mut (u32, Region), moved: Vec3) -> f32 {
        let Node { low, high, .. } = &self.nodes[node];
        let (low, high, frame) = (Vec3::from_slice(low), Vec3::from_slice(high), self.frame(node));
        if S::TURNS && frame != view.0 {
            let turned = || Region::new(self.frames.turn_region(frame, region, -moved));
            *view = (frame, if frame == 0 { *region } else { turned() });
        }
        view.1.square_to(low, high, if frame == 0 { moved } else { Vec3::ZERO })
    }

    /// Visits the leaves from one node to another that are within a distance that may change on the way.
    #[inline(always)]
    fn walk(
        &self,
        nodes: Range<usize>,
        region: &Region,
        moved: Vec3,
        mut visit: impl FnMut(f32, usize) -> ControlFlow<(), f32>,
        mut square: f32,
    ) -> u64 {
        let (mut node, mut visits, mut view) = (nodes.start, 0, (0, *region));
        while node < nodes.end {
            visits += 1;
            let distance = self.square(node, region, &mut view, moved);
            let Node { next, .. } = self.nodes[node];
            if !(distance <= square) {
                node = next as usize;
                continue;
            }
            node += 1;
            if node == next as usize {
                match visit(distance, node - 1) {
                    ControlFlow::Continue(now) => square = now,
                    ControlFlow::Break(()) => break,
                }
            }
        }
        visits
    }
}

impl<S: Split> Partition for Tree<'_, S> {
    const TURNS: bool = S::TURNS;

    fn turn(&self, frame: u32, point: Vec3) -> Vec3 {
        self.frames.turn(frame, point)
    }

    fn sorted(&self) -> &Sorted<'_> {
        &self.sorted
    }

    fn groups(&self, visit: &mut impl FnMut(Range<usize>, u32)) {
        let leaves = (0..self.len).filter(|&node| self.is_leaf(node));
        leaves.for_each(|leaf| visit(self.slots(leaf), self.frame(leaf)));
    }

    fn near(&self, region: &Region, image: Image, radius: f32, visit: &mut impl FnMut(Run) -> bool) -> u64 {
        let square = radius * radius;
        let visit = |_, leaf: usize| {
            let node = &self.nodes[leaf];
            let frame = self.frame(leaf);
            let more = visit(Run { slots: self.slots(leaf), low: node.low(), high: node.high(), frame });
            if more { ControlFlow::Continue(square) } else { ControlFlow::Break(()) }
        };
        self.walk(0..self.len, region, image.moved(), visit, square)
    }

    fn stride(&self) -> f32 {
        f32::INFINITY
    }

    /// Goes down to the nearer child first.
    fn seek(&self, center: Vec3, image: Image, _: f32, nearest: &mut Nearest<'_>) -> Cost {
        let (region, moved, probe) = (Region::point(center), image.moved(), Probe::new(center, image, 0.0));
        let (mut cost, mut view) = (Cost::default(), (0, region));
        let mut waiting = heapless::Vec::<(f32, u32), WAITING>::new();
        let _ = waiting.push((0.0, 0));
        while let Some((square, node)) = waiting.pop() {
            let node = node as usize;
            if !(square <= nearest.bound()) {
                continue;
            }
            let room = waiting.capacity() - waiting.len();
            if self.is_leaf(node) || room < CHILDREN {
                // Where there is no room to remember the way, all below is looked at in its own order.
                let nodes = node..self.nodes[node].next as usize;
                let bound = nearest.bound();
                let offer = |_, leaf| {
                    cost.tests += self.slots(leaf).len() as u64;
                    self.sorted.offer(&self.slots(leaf), &probe, nearest);
                    ControlFlow::Continue(nearest.bound())
                };
                cost.visits += self.walk(nodes, &region, moved, offer, bound);
                continue;
            }
            let first = waiting.len();
            for child in self.children(node) {
                cost.visits += 1;
                let square = self.square(child, &region, &mut view, moved);
                if square <= nearest.bound() {
                    let _ = waiting.push((square, child as u32));
                }
            }
            // The nearest last, since the last is taken first; of equally near ones the earlier.
            waiting[first..].sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        }
        cost
    }
}

impl<S: Split> SpatialIndex for Tree<'_, S> {
    fn build(&mut self, points: &[Vec3], _: f32) -> Result<(), TooSmall> {
        (self.len, self.depth, self.fullest, self.crowded) = (0, 0, 0, 0);
        self.sorted.take(points)?;
        self.grow();
        Ok(())
    }

    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        if !self.sorted.follow(points) {
            return self.build(points, 0.0);
        }
        self.redraw();
        Ok(())
    }

    fn facts(&self) -> Option<Facts> {
        let counts = [self.len, self.depth, self.fullest, self.crowded].map(|count| count as u32);
        let ([len, depth, fullest, crowded], [frames, slack]) = (counts, self.frames.facts());
        self.sorted.facts(Self::NAME, [len, depth, fullest, crowded, frames, slack, 0, 0, 0])
    }

    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        let Some([len, depth, fullest, crowded, frames, slack, ..]) = self.sorted.restore(Self::NAME, facts) else {
            return false;
        };
        let counts = [len, depth, fullest, crowded].map(|count| count as usize);
        [self.len, self.depth, self.fullest, self.crowded] = counts;
        self.frames.restore([frames, slack]);
        let nodes = self.nodes.get_mut(..=self.len).unwrap_or_default();
        self.sorted.renumber(points, row_of, nodes.iter_mut().map(|node| &mut node.first))
    }

    fn stats(&self) -> Stats {
        let stats = self.sorted.stats();
        let node = if S::TURNS { NODE + 1 } else { NODE };
        let bytes = stats.bytes + 4 * node * (self.len + 1) + 36 * self.frames.len();
        let (nodes, depth, fullest, crowded) = (self.len, self.depth, self.fullest, self.crowded);
        Stats { nodes, depth, fullest, crowded, bytes, ..stats }
    }

    answers!();
}
