//! A cycle through the coarser graphs of a shell: a guess at what solves its system, by which conjugate gradients are short.

use super::mesh::{Graph, LEVELS, Room};
use super::plate::Plate;
use super::sweep::{BLOCK, Level, Quad, invert};
use crate::constrain::walls::Wall;
use crate::lanes;
use crate::memory::take;
use glam::Vec3;

/// So many times what the next graph finds do all of the finest go: groups that go as one are stiffer than what they stand for (over-correction:
/// Braess, Computing 55, 1995).
const FURTHER: f32 = 1.6;

/// All of them, finest first.
pub(super) struct Levels<'m> {
    pub(super) all: [Level<'m>; LEVELS],
    count: usize,
}

/// Words for all of them.
pub(super) fn words(room: &Room) -> usize {
    let [rows, links] = [room.rows, room.links].map(|[fine, coarse]| fine + coarse);
    if rows == 0 { 0 } else { BLOCK * (links + rows + 2 * room.rows[0]) + 8 * rows }
}

impl<'m> Levels<'m> {
    /// As many as there are graphs, in words: they hold anything.
    pub(super) fn of(graphs: [Graph<'m>; LEVELS], plate: Plate<'m>, words: &'m mut [u32]) -> Self {
        let (mut rest, mut plate) = (words, Some(plate));
        let mut count = 0;
        let all = core::array::from_fn(|level| {
            let (graph, rows) = (graphs[level], graphs[level].rows());
            if rows == 0 {
                return Level::default();
            }
            let mut numbers = |len| bytemuck::cast_slice_mut(take(&mut rest, len));
            let blocks = numbers(BLOCK * graph.links.len());
            let diagonal = numbers(BLOCK * rows);
            let [whole, alone] = [0, 1].map(|_| numbers(if level > 0 { 0 } else { BLOCK * rows }));
            let [r, x] = [0, 1].map(|_| super::whole(take(&mut rest, 4 * rows)));
            let plate = plate.take().unwrap_or_default();
            count = level + 1;
            Level { graph, blocks, diagonal, whole, alone, plate, bending: 0.0, r, x }
        });
        Self { all, count }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Sums up the blocks of each graph for the next, each group going as one, and inverts those of rows with themselves. What a wall presses hardly
    /// gives way, in the cycle too; conjugate gradients know that it does not at all. It is done anew where other walls press: a cycle
    /// that takes them for what they were costs several times the iterations.
    pub(super) fn fold(&mut self, walls: &[Wall]) {
        let [finest, ..] = &mut self.all;
        finest.diagonal.copy_from_slice(finest.whole);
        for (numbers, wall) in finest.diagonal.chunks_exact_mut(BLOCK).zip(walls).filter(|(_, wall)| wall.presses()) {
            let stiff = wall.stiffness(numbers[0] + numbers[4] + numbers[8]).to_cols_array();
            numbers.iter_mut().zip(stiff).for_each(|(number, stiff)| *number += stiff);
        }
        for level in 1..self.count {
            if let [fine, coarse, ..] = &mut self.all[level - 1..] {
                coarse.blocks.fill(0.0);
                coarse.diagonal.fill(0.0);
                lanes::widest(
                    #[inline(always)]
                    || fine.sum_into(coarse),
                );
            }
        }
        for level in &mut self.all[..self.count] {
            level.diagonal.chunks_exact_mut(BLOCK).for_each(invert);
        }
    }

    /// q = A p.
    pub(super) fn apply(&mut self, p: &[Vec3], q: &mut [Vec3]) {
        let [finest, ..] = &mut self.all;
        lanes::widest(
            #[inline(always)]
            || finest.apply(p, q),
        );
    }

    /// z ≈ A⁻¹ r: a sweep of Gauss and Seidel's method forth on the way to the coarsest graph, and one back on the way from there. So it is symmetric.
    pub(super) fn cycle(&mut self, r: &[Vec3], z: &mut [Vec3]) {
        lanes::widest(
            #[inline(always)]
            || {
                let levels = &mut self.all[..self.count];
                let Some(finest) = levels.first_mut() else { return };
                for (to, r) in finest.r.iter_mut().zip(r) {
                    *to = [r.x, r.y, r.z, 0.0];
                }
                for i in 0..levels.len() {
                    let (this, next) = levels[i..].split_at_mut(1);
                    this[0].forth();
                    if let Some(next) = next.first_mut() {
                        this[0].leave(next.r);
                    }
                }
                for i in (0..levels.len()).rev() {
                    let (this, next) = levels[i..].split_at_mut(1);
                    this[0].back(next.first().map(|next| &*next.x), if i == 0 { FURTHER } else { 1.0 });
                }
                for (z, &[x, y, w, _]) in z.iter_mut().zip(&*levels[0].x) {
                    *z = Vec3::new(x, y, w);
                }
            },
        );
    }

    /// Takes from shifts what each piece that hangs together, and by nothing that is fixed, would go as a whole: Σ m Δx. Of those who are there, masses
    /// are given: infinite ones of what is fixed.
    pub(super) fn rid_of_drift(&mut self, masses: impl Iterator<Item = Option<f32>>, shift: &mut [Vec3]) {
        let [finest, others @ ..] = &mut self.all;
        let others = &mut others[..self.count.saturating_sub(1)];
        let Some(first) = others.first_mut() else { return };
        first.r.fill([0.0; 4]);
        for ((mass, &shift), &into) in masses.zip(&*shift).zip(finest.graph.into) {
            let Some(mass) = mass else { continue };
            let Vec3 { x, y, z } = if mass < f32::INFINITY { shift * mass } else { Vec3::ZERO };
            first.gather(into, [x, y, z, mass]);
        }
        for i in 1..others.len() {
            let (this, next) = others.split_at_mut(i);
            let (Some(this), Some(next)) = (this.last(), next.first_mut()) else { return };
            next.r.fill([0.0; 4]);
            for (&sum, &into) in this.r.iter().zip(this.graph.into) {
                next.gather(into, sum);
            }
        }
        if let Some(last) = others.last_mut() {
            last.share_out();
        }
        for i in (1..others.len()).rev() {
            let (this, next) = others.split_at_mut(i);
            let (Some(this), Some(next)) = (this.last_mut(), next.first()) else { return };
            for (drift, &into) in this.r.iter_mut().zip(this.graph.into) {
                *drift = next.r.get(into as usize).copied().unwrap_or_default();
            }
        }
        let Some(first) = others.first() else { return };
        for (shift, &into) in shift.iter_mut().zip(finest.graph.into) {
            let [x, y, z, _]: Quad = first.r.get(into as usize).copied().unwrap_or_default();
            *shift -= Vec3::new(x, y, z);
        }
    }
}
