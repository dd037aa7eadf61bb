//! How every tree is made: parts are cut until eight fit into a node, and so on down.

use super::entries::{ENTRY, Entries, Entry};
use super::header::{Boxes, HEADER, Header, UNIT};
use super::split::{Part, Split, longest};
use super::tree::{DEEPEST, LAST, MOST, NODE, NODE_UNITS, NOTHING, Node, PIECE, RUN, Unit, WAITING, WIDE};
use super::{Pieces, Structure, TooSmall};
use crate::math::{largest, max, power_to_one};
use crate::shape::Aabb;
use core::ops::Range;

/// So often cuts that separate nothing begin anew; the coordinates have no more bits.
const ROUNDS: u32 = 256;

/// Words of memory for so many pieces, at so many words for each.
pub(super) const fn words(pieces: usize, each: usize) -> usize {
    pieces.saturating_mul(each).saturating_add(HEADER + 4 * NODE + UNIT)
}

/// Builds a tree of pieces into memory, and returns the words that it needs from then on.
///
/// Entries are at the end of the memory, nodes grow from its beginning. If nodes run out, all is made anew with larger
/// leaves: better than a huge one where they ran out.
pub(super) fn build<'m, P: Pieces + ?Sized, S: Split>(
    structure: Structure,
    split: &S,
    pieces: &P,
    memory: &'m mut [u32],
) -> Result<&'m [u32], TooSmall> {
    let (len, words) = (pieces.count(), memory.len());
    let needed = HEADER + NODE + UNIT * len.div_ceil(UNIT) + ENTRY * len;
    if words < needed || len > MOST {
        return Err(TooSmall { words, needed });
    }
    // Pieces that planes cut need room for copies: half of the words beyond the least that is needed.
    let spare = if S::CUTS { (words - needed) / 2 / ENTRY } else { 0 };
    let room = len + spare.min(2 * len);
    let (front, back) = memory.split_at_mut(words - ENTRY * room);
    let mut leaf = S::LEAF;
    let header = loop {
        let body = &mut front[HEADER..];
        let entries = Entries::new(bytemuck::cast_slice_mut(back));
        let mut tree =
            Tree { split, leaf, scale: 1.0, body, used: 0, promised: 0, entries, header: Header::new(structure) };
        tree.take(pieces);
        if tree.fill() {
            break tree.header;
        }
        leaf *= 2;
    };
    Ok(header.write(front))
}

/// A tree that grows.
struct Tree<'m, 's, S> {
    split: &'s S,
    /// Pieces in a leaf, at most, if they can be cut.
    leaf: usize,
    /// Makes the longest side about one.
    scale: f32,
    body: &'m mut [u32],
    /// Units in use, and those that the parts that wait will need at least.
    used: usize,
    promised: usize,
    entries: Entries<'m>,
    header: Header,
}

/// A part that waits to become a child, and where its word goes.
struct Job<C> {
    range: Range<usize>,
    cell: C,
    word: usize,
    level: usize,
}

impl<S: Split> Tree<'_, '_, S> {
    /// Takes the boxes in.
    fn take<P: Pieces + ?Sized>(&mut self, pieces: &P) {
        let mut boxes = Boxes::NONE;
        for piece in 0..pieces.count() {
            let bounds = pieces.box_of(piece);
            boxes.add(&bounds);
            if bounds.min.is_finite() && bounds.max.is_finite() {
                self.entries.push(Entry::new(&bounds, piece));
            }
        }
        self.header.boxes = boxes.hash();
        self.header.pieces = pieces.count() as u32;
        self.header.skipped = (pieces.count() - self.entries.len) as u32;
    }

    /// Makes all nodes; false if there are too many of them and leaves could be larger.
    fn fill(&mut self) -> bool {
        let all = 0..self.entries.len;
        let bounds = self.entries.hull(all.clone()).bounds();
        self.scale = power_to_one(max(largest(bounds.min), largest(bounds.max)));
        let root = if all.is_empty() { Aabb { min: glam::Vec3::ZERO, max: glam::Vec3::ZERO } } else { bounds };
        let mut waiting = heapless::Vec::<Job<S::Cell>, WAITING>::new();
        let root = Job { range: all, cell: self.split.root(&root), word: usize::MAX, level: 0 };
        self.promised = units(root.range.len());
        let _ = waiting.push(root);
        while let Some(job) = waiting.pop() {
            self.promised -= units(job.range.len());
            if S::CUTS {
                // The copies made for earlier parts are no longer needed.
                self.entries.len = job.range.end;
            }
            self.header.depth = self.header.depth.max(job.level as u32);
            let first = waiting.len();
            if !self.place(&job, &mut waiting) {
                return false;
            }
            self.promised += waiting[first..].iter().map(|job| units(job.range.len())).sum::<usize>();
        }
        self.header.words = (HEADER + UNIT * self.used) as u32;
        true
    }

    /// Makes a child of a part: a node, whose own parts then wait, or a run. False if it has to be a run that is too long.
    fn place(&mut self, job: &Job<S::Cell>, waiting: &mut heapless::Vec<Job<S::Cell>, WAITING>) -> bool {
        let (len, is_root) = (job.range.len(), job.word == usize::MAX);
        let fits = self.used + NODE_UNITS + self.promised <= self.body.len() / UNIT;
        if self.boxes() && len <= WIDE && fits && job.level < DEEPEST {
            self.leaf_node(job);
            return true;
        }
        if (len > self.leaf || is_root) && job.level < DEEPEST {
            let parts = self.divide(job);
            let lanes: usize = parts.iter().map(|part| units(part.range.len())).sum();
            if self.used + NODE_UNITS + lanes + self.promised <= self.body.len() / UNIT {
                self.node(job, &parts, waiting);
                return true;
            }
            // One leaf of all there is has always room.
            if self.leaf < self.header.pieces as usize {
                return false;
            }
        }
        self.run(job);
        true
    }

    /// Tells whether pieces are listed with their own boxes, as leaves of the size of a node: a piece that is cut has
    /// another box there.
    fn boxes(&self) -> bool {
        !S::CUTS && self.leaf == WIDE
    }

    /// Cuts a part until there are as many as a node holds, or none is worth it.
    fn divide(&mut self, job: &Job<S::Cell>) -> heapless::Vec<Part<S::Cell>, WIDE> {
        let mut parts = heapless::Vec::<Part<S::Cell>, WIDE>::new();
        let _ = parts.push(Part::new(job.range.clone(), job.cell.clone(), 0, &self.entries));
        let mut rounds = 0;
        while parts.len() < WIDE {
            let open =
                |part: &&Part<S::Cell>| part.range.len() > self.leaf && (S::ROUNDS == 0 || part.cuts < S::ROUNDS);
            let size = |part: &Part<S::Cell>| part.hull.area(self.scale);
            let largest = parts.iter().enumerate().filter(|(_, part)| open(part)).map(|(i, part)| (i, size(part)));
            let Some((at, _)) = largest.reduce(|a, b| if b.1 > a.1 { b } else { a }) else {
                // Cut all the way and still in one piece: the cuts begin anew, without a level of their own.
                match &mut parts[..] {
                    [only] if only.cuts == S::ROUNDS && only.range.len() > self.leaf && rounds < ROUNDS => {
                        only.cuts = 0;
                        rounds += 1;
                        continue;
                    }
                    _ => break,
                }
            };
            let part = parts[at].clone();
            let [below, above] = match self.split.cut(&part, &mut self.entries, self.scale) {
                Some(halves) => halves,
                None => halve(&part, &mut self.entries),
            };
            parts[at] = below;
            if above.range.is_empty() {
                continue;
            }
            if parts[at].range.is_empty() {
                parts[at] = above;
            } else {
                let _ = parts.push(above);
            }
        }
        // The last is done first, and what it has copied is given up then.
        parts.sort_unstable_by_key(|part| part.range.start);
        parts
    }

    /// A node of parts. What is small goes right into it as long as there are lanes.
    fn node(
        &mut self,
        job: &Job<S::Cell>,
        parts: &heapless::Vec<Part<S::Cell>, WIDE>,
        waiting: &mut heapless::Vec<Job<S::Cell>, WAITING>,
    ) {
        let start = self.begin(job);
        let (mut node, mut lane, mut lanes) = (Node::EMPTY, 0, parts.len());
        for part in parts.iter().filter(|part| !part.range.is_empty()) {
            let len = part.range.len();
            if self.boxes() && lanes - 1 + len <= WIDE {
                lanes = lanes - 1 + len;
                for entry in self.entries.of(part.range.clone()) {
                    node.set(lane, &entry.bounds(), PIECE | entry.piece);
                    lane += 1;
                }
                self.header.references += len as u32;
                continue;
            }
            node.set(lane, &part.hull.bounds(), NOTHING);
            let word = start + 6 * WIDE + lane;
            let _ =
                waiting.push(Job { range: part.range.clone(), cell: part.cell.clone(), word, level: job.level + 1 });
            lane += 1;
        }
        self.write(start, &node);
    }

    /// A node of pieces with their own boxes.
    fn leaf_node(&mut self, job: &Job<S::Cell>) {
        let start = self.begin(job);
        let mut node = Node::EMPTY;
        for (lane, entry) in self.entries.of(job.range.clone()).iter().enumerate() {
            node.set(lane, &entry.bounds(), PIECE | entry.piece);
        }
        self.list(job.range.len(), false);
        self.write(start, &node);
    }

    fn begin(&mut self, job: &Job<S::Cell>) -> usize {
        self.link(job, self.used as u32);
        let start = self.used * UNIT;
        self.used += NODE_UNITS;
        self.header.nodes += 1;
        start
    }

    fn write(&mut self, start: usize, node: &Node) {
        if let Some(words) = self.body.get_mut(start..start + NODE) {
            words.copy_from_slice(bytemuck::cast_ref::<Node, [Unit; NODE_UNITS]>(node).as_flattened());
        }
    }

    /// A run of pieces by their numbers.
    fn run(&mut self, job: &Job<S::Cell>) {
        self.link(job, RUN | self.used as u32);
        let (start, len) = (self.used * UNIT, job.range.len());
        for (word, entry) in self.body[start..].iter_mut().zip(self.entries.of(job.range.clone())) {
            *word = entry.piece;
        }
        let end = start + UNIT * units(len);
        self.body[start + len..end].fill(0);
        if len > 0 {
            self.body[start + len - 1] |= LAST;
        }
        self.used += units(len);
        self.list(len, true);
    }

    fn list(&mut self, len: usize, run: bool) {
        self.header.references += len as u32;
        self.header.fullest = self.header.fullest.max(len as u32);
        self.header.crowded += u32::from(run && len > S::LEAF);
    }

    fn link(&mut self, job: &Job<S::Cell>, child: u32) {
        if let Some(word) = self.body.get_mut(job.word) {
            *word = child;
        }
    }
}

/// Units that a run takes.
fn units(pieces: usize) -> usize {
    pieces.div_ceil(UNIT)
}

/// Divides what no rule divides, in the middle of the list or of space.
fn halve<C: Clone>(part: &Part<C>, entries: &mut Entries<'_>) -> [Part<C>; 2] {
    let bounds = part.hull.bounds();
    let axis = longest(&bounds);
    let plane = 0.5 * bounds.min[axis] + 0.5 * bounds.max[axis];
    let middle = entries.part(part.range.clone(), |entry| entry.middle(axis) < plane);
    let uneven = (middle - part.range.start).min(part.range.end - middle) < part.range.len() / 8;
    let half = (part.range.len() / 2).next_multiple_of(WIDE).min(part.range.len() - 1);
    part.at(if uneven { part.range.start + half } else { middle }, entries)
}
