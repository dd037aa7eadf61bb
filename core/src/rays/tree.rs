//! The parts that all trees share: nodes of eight children each, with their boxes side by side.
//!
//! A child is a node, a piece with its own box, or a run of pieces by their numbers. Nodes come in the order in which a walk
//! that takes the last child first meets them, so that one pass can tell that they are a tree.

use super::Pieces;
use super::header::{HEADER, Header, UNIT};
use super::near::Gathered;
use super::nearest::Closest;
use super::probe::{Best, Probe};
use super::visit::{Aabb8, Visit, Visitor};
use crate::shape::Aabb;
use core::ops::ControlFlow;
use glam::Vec3;
use wide::f32x8;

/// At most so many children has a node.
pub(super) const WIDE: usize = 8;
/// Deeper than this no node is.
pub(super) const DEEPEST: usize = 32;
/// Children that wait on the deepest way.
pub(super) const WAITING: usize = DEEPEST * (WIDE - 1) + WIDE;

/// A node: its children's boxes, and what the children are.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Node {
    pub(super) boxes: Aabb8,
    pub(super) children: [u32; WIDE],
}

/// Eight words.
pub(super) type Unit = [u32; UNIT];
/// Words and units of a node.
pub(super) const NODE: usize = size_of::<Node>() / 4;
pub(super) const NODE_UNITS: usize = NODE / UNIT;

/// The words that follow the header.
fn body(words: &[u32]) -> &[Unit] {
    words.get(HEADER..).unwrap_or_default().as_chunks().0
}

/// The kinds of a child's word, in two bits before a number.
pub(super) const RUN: u32 = 1 << 30;
pub(super) const PIECE: u32 = 2 << 30;
pub(super) const NOTHING: u32 = 3 << 30;
const NUMBER: u32 = RUN - 1;
/// The most that there may be of anything that a word numbers.
pub(super) const MOST: usize = NUMBER as usize;

/// Set on the last piece of a run.
pub(super) const LAST: u32 = 1 << 31;

impl Node {
    /// One without children: boxes that nothing meets.
    pub(super) const EMPTY: Self = Self { boxes: Aabb8::EMPTY, children: [NOTHING; WIDE] };

    pub(super) fn set(&mut self, lane: usize, bounds: &Aabb, child: u32) {
        self.boxes.set(lane, bounds);
        self.children[lane] = child;
    }

    /// Which of its children's boxes share a point with another.
    fn meets(&self, bounds: &Aabb) -> u32 {
        (0..3).fold(!0, |met, axis| {
            let (low, high) = (f32x8::new(self.boxes.min[axis]), f32x8::new(self.boxes.max[axis]));
            let below = low.simd_le(f32x8::splat(bounds.max[axis])).to_bitmask();
            met & below & high.simd_ge(f32x8::splat(bounds.min[axis])).to_bitmask()
        })
    }

    /// The squares of the distances from a point to its children's boxes, by the same operations as to one.
    fn squares(&self, point: Vec3) -> [f32; WIDE] {
        let gap = |axis: usize| {
            let (low, high) = (f32x8::new(self.boxes.min[axis]), f32x8::new(self.boxes.max[axis]));
            let center = f32x8::splat(point[axis]);
            (low - center).fast_max(center - high).fast_max(f32x8::ZERO)
        };
        let [x, y, z] = [gap(0), gap(1), gap(2)];
        (x * x + y * y + z * z).to_array()
    }

    /// The node at a unit.
    #[inline(always)]
    fn at(body: &[Unit], unit: u32) -> Option<&Self> {
        let units = body.get(unit as usize..)?.first_chunk::<NODE_UNITS>()?;
        Some(bytemuck::cast_ref(units))
    }
}

/// The pieces of the run at a unit.
#[inline(always)]
fn run(body: &[Unit], unit: u32) -> impl Iterator<Item = usize> + '_ {
    let mut more = true;
    let words = body.get(unit as usize..).unwrap_or_default().as_flattened().iter();
    words.take_while(move |&&word| core::mem::replace(&mut more, word & LAST == 0)).map(|&word| (word & !LAST) as usize)
}

/// Tells whether the words after a sound header are a tree whose every number leads somewhere.
pub(super) fn is_sound(words: &[u32]) -> bool {
    let (Some(header), body) = (Header::of(words), body(words)) else {
        return false;
    };
    let mut waiting = heapless::Vec::<(u32, usize), WAITING>::new();
    let (mut next, mut depth) = (0, 0);
    if waiting.push((0, 0)).is_err() {
        return false;
    }
    while let Some((child, level)) = waiting.pop() {
        let number = child & NUMBER;
        match child & NOTHING {
            NOTHING => {}
            PIECE if number < header.pieces => {}
            RUN if number == next && (next as usize) < body.len() => {
                let mut len = 0;
                for piece in run(body, number) {
                    len += 1;
                    if piece >= header.pieces as usize {
                        return false;
                    }
                }
                let end = number as usize * UNIT + len;
                if len == 0 || body.as_flattened().get(end - 1).is_none_or(|&word| word & LAST == 0) {
                    return false;
                }
                next = end.div_ceil(UNIT) as u32;
            }
            0 if number == next => {
                let Some(node) = Node::at(body, number) else {
                    return false;
                };
                next += NODE_UNITS as u32;
                depth = depth.max(level);
                for &child in &node.children {
                    if child & NOTHING != NOTHING && (level + 1 > DEEPEST || waiting.push((child, level + 1)).is_err())
                    {
                        return false;
                    }
                }
            }
            _ => return false,
        }
    }
    next as usize == body.len() && words.len().is_multiple_of(UNIT)
}

/// Goes down to the nearest child first.
pub(super) fn first_hit<P: Pieces + ?Sized>(words: &[u32], pieces: &P, probe: &Probe<'_>, best: &mut Best) {
    let body = body(words);
    let mut waiting = heapless::Vec::<(f32, u32), WAITING>::new();
    let _ = waiting.push((0.0, 0));
    while let Some((enter, child)) = waiting.pop() {
        if enter > best.time {
            continue;
        }
        if child & NOTHING == RUN {
            run(body, child & NUMBER).for_each(|piece| best.ask(pieces, probe, piece));
            continue;
        }
        let Some(node) = Node::at(body, child) else {
            continue;
        };
        best.cost.visits += 1;
        let (enter, leave, mut met) = probe.spans(&node.boxes, best.time);
        if met == 0 {
            continue;
        }
        let (enter, leave) = (enter.to_array(), leave.to_array());
        let first = waiting.len();
        while met != 0 {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            let (child, span) = (node.children[lane], (enter[lane], leave[lane]));
            match child & NOTHING {
                PIECE if span.0 <= best.time => best.meet(pieces, probe, (child & NUMBER) as usize, span),
                PIECE | NOTHING => {}
                _ => insert(&mut waiting, first, (span.0, child)),
            }
        }
    }
}

/// Puts a child among those from `first` on, the nearest last, since the last is taken first.
#[inline(always)]
fn insert(waiting: &mut heapless::Vec<(f32, u32), WAITING>, first: usize, child: (f32, u32)) {
    if waiting.push(child).is_ok() {
        let mut at = waiting.len() - 1;
        while at > first && waiting[at - 1].0 < child.0 {
            waiting.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// Gathers the pieces whose boxes meet another.
pub(super) fn near<P: Pieces + ?Sized>(words: &[u32], pieces: &P, bounds: &Aabb, found: &mut Gathered) {
    let body = body(words);
    let mut waiting = heapless::Vec::<u32, WAITING>::new();
    let _ = waiting.push(0);
    while let Some(child) = waiting.pop() {
        if child & NOTHING == RUN {
            run(body, child & NUMBER).for_each(|piece| found.ask(pieces, bounds, piece));
            continue;
        }
        let Some(node) = Node::at(body, child) else {
            continue;
        };
        found.cost.visits += 1;
        let mut met = node.meets(bounds);
        while met != 0 {
            let child = node.children[met.trailing_zeros() as usize];
            met &= met - 1;
            match child & NOTHING {
                NOTHING => {}
                PIECE => found.ask(pieces, bounds, (child & NUMBER) as usize),
                _ => drop(waiting.push(child)),
            }
        }
    }
}

/// Goes wherever a visitor enters, until it breaks off.
pub(super) fn visit<P: Pieces + ?Sized, V: Visitor>(words: &[u32], visit: &mut Visit<'_, P, V>) -> ControlFlow<()> {
    let body = body(words);
    let mut waiting = heapless::Vec::<u32, WAITING>::new();
    let _ = waiting.push(0);
    while let Some(child) = waiting.pop() {
        if child & NOTHING == RUN {
            run(body, child & NUMBER).try_for_each(|piece| visit.ask(piece))?;
            continue;
        }
        let Some(node) = Node::at(body, child) else {
            continue;
        };
        visit.cost.visits += 1;
        let mut entered = visit.visitor.enters_which(&node.boxes) & ((1 << WIDE) - 1);
        while entered != 0 {
            let child = node.children[entered.trailing_zeros() as usize];
            entered &= entered - 1;
            match child & NOTHING {
                NOTHING => {}
                PIECE => visit.meet((child & NUMBER) as usize)?,
                _ => drop(waiting.push(child)),
            }
        }
    }
    ControlFlow::Continue(())
}

/// Goes down to the nearest child first.
pub(super) fn nearest<P: Pieces + ?Sized, F: Fn(usize) -> Vec3>(words: &[u32], closest: &mut Closest<'_, P, F>) {
    let body = body(words);
    let mut waiting = heapless::Vec::<(f32, u32), WAITING>::new();
    let _ = waiting.push((0.0, 0));
    while let Some((square, child)) = waiting.pop() {
        if square > closest.square {
            continue;
        }
        if child & NOTHING == RUN {
            run(body, child & NUMBER).for_each(|piece| closest.ask(piece));
            continue;
        }
        let Some(node) = Node::at(body, child) else {
            continue;
        };
        closest.cost.visits += 1;
        let first = waiting.len();
        for (&child, square) in node.children.iter().zip(node.squares(closest.point)) {
            match child & NOTHING {
                NOTHING => {}
                PIECE => closest.ask((child & NUMBER) as usize),
                _ if square <= closest.square => insert(&mut waiting, first, (square, child)),
                _ => {}
            }
        }
    }
}
