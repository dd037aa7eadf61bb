//! A cycle through the coarser graphs of a shell: a guess at what solves its system, by which conjugate gradients are short.

use super::finest::{self, Back, Finest, Forth, Links, Product};
use super::folded::{Invert, Sum};
use super::mesh::{Graph, LEVELS, Room};
use super::plate::Plate;
use super::strips;
use super::sweep::{self, BLOCK, Level, invert};
use super::words::structs;
use crate::constrain::walls::Wall;
use crate::lanes;
use crate::memory::take;
use glam::Vec3;

/// So many times what the next graph finds do all of the finest go: groups that go as one are stiffer than what they stand for (over-correction:
/// Braess, Computing 55, 1995).
const FURTHER: f32 = 1.6;

/// The finest, and all others, finer ones first.
#[derive(Default)]
pub(super) struct Levels<'m> {
    pub(super) finest: Finest<'m>,
    others: [Level<'m>; LEVELS - 1],
    /// Their number; those of the finest are groups of the first of them, if there is one.
    count: usize,
}

/// Words for all of them.
pub(super) fn words(room: &Room) -> usize {
    let ([fine, coarse], [links, others]) = (room.rows, room.links);
    if fine == 0 {
        return 0;
    }
    let finest = finest::words(fine, strips::entries(fine, links));
    let blocks = (others + 2 * coarse).saturating_mul(BLOCK);
    finest.saturating_add(blocks).saturating_add(coarse.saturating_mul(8))
}

impl<'m> Levels<'m> {
    /// As many as there are graphs, in words: they hold anything.
    pub(super) fn of(graphs: [Graph<'m>; LEVELS], links: Links<'m>, plate: Plate<'m>, words: &'m mut [u32]) -> Self {
        let [fine, others @ ..] = graphs;
        if fine.rows() == 0 {
            return Self::default();
        }
        let mut rest = words;
        let finest = Finest::of(fine.into, links, plate, &mut rest);
        let mut count = 0;
        let others = others.map(|graph| {
            let rows = graph.rows();
            if rows == 0 {
                return Level::default();
            }
            let mut numbers = |len| bytemuck::cast_slice_mut(take(&mut rest, len));
            let blocks = numbers(BLOCK * graph.links.len());
            let [whole, inverse] = [0, 1].map(|_| numbers(BLOCK * rows));
            let [r, x] = [0, 1].map(|_| structs(take(&mut rest, 4 * rows)));
            count += 1;
            Level { graph, blocks, whole, inverse, r, x }
        });
        Self { finest, others, count }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.finest.links.strips.len() == 0
    }

    /// Sums up the blocks of each graph for the next, each group going as one.
    pub(super) fn sum(&mut self) {
        let Self { finest, others, count } = self;
        let others = &mut others[..*count];
        for level in &mut *others {
            level.blocks.fill(0.0);
            level.whole.fill(0.0);
        }
        if let Some(next) = others.first_mut() {
            lanes::run(Sum { finest, next });
        }
        for level in 1..others.len() {
            if let [fine, coarse, ..] = &mut others[level - 1..] {
                lanes::widest(
                    #[inline(always)]
                    || fine.sum_into(coarse),
                );
            }
        }
    }

    /// Inverts the blocks of rows with themselves. What a wall presses hardly gives way, in the cycle too; conjugate gradients know that it does not
    /// at all. It is done anew where other walls press: a cycle that takes them for what they were costs several times the iterations.
    pub(super) fn press(&mut self, walls: &[Wall], pressing: &[u32]) {
        let Self { finest, others, count } = self;
        let others = &mut others[..*count];
        finest.inverse.copy_from_slice(finest.whole);
        others.iter_mut().for_each(|level| level.inverse.copy_from_slice(level.whole));
        for &row in pressing {
            let row = row as usize;
            let Some(wall) = walls.get(row) else { continue };
            let stiff = finest.stiffen(row, wall).to_cols_array();
            let [a, b, c, d, e, f, g, h, i] = stiff;
            let mut into = finest.into.get(row);
            for level in &mut *others {
                let Some(&group) = into else { break };
                sweep::add(level.inverse, group as usize, &[a, b, c, d, e, f, g, h, i, 0.0]);
                into = level.graph.into.get(group as usize);
            }
        }
        finest.soften();
        lanes::run(Invert { all: finest.inverse });
        others.iter_mut().for_each(|level| level.inverse.chunks_exact_mut(BLOCK).for_each(invert));
    }

    /// q = A p.
    pub(super) fn apply(&mut self, p: &[Vec3], q: &mut [Vec3]) {
        lanes::run(Product { finest: &mut self.finest, p, q });
    }

    /// z ≈ A⁻¹ r: a sweep of Gauss and Seidel's method forth on the way to the coarsest graph, and one back on the way from there. So it is symmetric.
    pub(super) fn cycle(&mut self, r: &[Vec3], z: &mut [Vec3]) {
        let Self { finest, others, count } = self;
        let others = &mut others[..*count];
        lanes::run(Forth { finest, r, next: others.first_mut().map(|next| &mut *next.r) });
        lanes::widest(
            #[inline(always)]
            || {
                for i in 0..others.len() {
                    let (this, next) = others[i..].split_at_mut(1);
                    this[0].forth();
                    if let Some(next) = next.first_mut() {
                        this[0].leave(next.r);
                    }
                }
                for i in (0..others.len()).rev() {
                    let (this, next) = others[i..].split_at_mut(1);
                    this[0].back(next.first().map(|next| &*next.x));
                }
            },
        );
        lanes::run(Back { finest, next: others.first().map(|next| &*next.x), further: FURTHER, z });
    }
}

#[cfg(test)]
mod tests {
    use super::super::{mesh::Room, plate};
    use super::*;

    /// What does not fit an address is not taken for something small: `start` refuses it.
    #[test]
    fn words_of_the_largest_shells_do_not_wrap() {
        let mut last = [0; 3];
        for bits in 4..=26 {
            let counts = [1 << bits, 2 << bits, 3 << bits].map(|count: usize| count.min(u32::MAX as usize / 64));
            let room = Room::of(counts);
            let all = [words(&room), finest::pattern(&room, counts[1]), plate::words(&room)];
            for (now, before) in all.iter().zip(last) {
                assert!(*now > before || *now == usize::MAX, "{counts:?}: {all:?} after {last:?}");
            }
            last = all;
        }
    }
}
