//! The blocks of a shell's system, for its graphs.

use super::cycle::Levels;
use super::solver::Solver;
use super::sweep::{BLOCK, Level};
use crate::lanes;
use glam::Mat3;

impl Solver<'_> {
    /// Puts M + h² K into the blocks of the finest graph, and of all others what comes of it. Of bending edges have a part, and the matrix of
    /// bending has the rest; of what is not thin blocks have only what each particle does to itself.
    pub(super) fn assemble(&mut self, levels: &mut Levels<'_>) {
        if levels.is_empty() {
            return;
        }
        let [finest, ..] = &mut levels.all;
        self.thin = finest.plate.is_thin(self.params);
        finest.blocks.fill(0.0);
        finest.whole.fill(0.0);
        let bending = self.bending() * self.step.rate;
        finest.bending = if self.thin { bending } else { 0.0 };
        lanes::widest(
            #[inline(always)]
            || {
                for i in 0..if bending > 0.0 { self.hinges.len() } else { 0 } {
                    self.add_fold(finest, bending, i);
                }
                for i in 0..self.triangles.len() {
                    self.add_membrane(finest, i);
                }
                self.settle_rows(finest);
            },
        );
        levels.fold(self.walls);
    }

    /// Adds the blocks of a triangle's edges: of the link from the lesser number to the greater.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn add_membrane(&self, finest: &mut Level<'_>, i: usize) {
        let (Some(corners), Some(cell), Some(strain)) = (self.triangles.get(i), self.cells.get(i), self.strains.get(i))
        else {
            return;
        };
        let blocks = strain.blocks(cell, self.params, &self.step);
        for (k, block) in blocks.into_iter().enumerate() {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let (from, to, block) = if from < to { (from, to, block) } else { (to, from, block.transpose()) };
            if let Some(link) = finest.graph.link(from as usize, to) {
                add(finest.blocks, link, &block);
            }
        }
    }

    /// Adds to a fold's triangles how their corners hold each other, by its moment, and by what the matrix of bending lacks of its stiffness; or
    /// what its corners do to themselves.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn add_fold(&mut self, finest: &mut Level<'_>, bending: f32, i: usize) {
        let (Some(hinge), Some(bend), Some(fold)) = (self.hinges.get(i), self.bends.get(i), self.folds.get(i)) else {
            return;
        };
        let mut stiffness = 0.0;
        for (side, face) in hinge.faces.into_iter().enumerate() {
            let mut curvature = [0.0; 3];
            bend.curve(side, 1.0, &mut curvature);
            stiffness += self.cells.get(face as usize).map_or(0.0, |cell| cell.area) * bend.moment(side, curvature);
        }
        let stiffness = stiffness * bending;
        let mut besides = [[0.0; 2]; 2];
        if self.thin {
            let excess = stiffness * fold.excess(bend);
            besides = [0, 1].map(|side| [excess, stiffness * fold.slip(bend, side)]);
        } else {
            for (corner, force) in hinge.corners().into_iter().zip(fold.forces(1.0)) {
                let [x, y, z] = force.to_array().map(|part| force * (stiffness * part));
                add(finest.whole, corner as usize, &Mat3::from_cols(x, y, z));
            }
        }
        for (side, face) in hinge.faces.into_iter().enumerate() {
            let corners = self.triangles.get(face as usize).copied().unwrap_or_default();
            let far = corners.iter().position(|&corner| corner == hinge.far[side]);
            let (Some(far), Some(strain)) = (far, self.strains.get_mut(face as usize)) else { continue };
            let [across, first, second] = fold.held(side, besides[side]);
            let (next, last) = ((far + 1) % 3, (far + 2) % 3);
            let [first, second] = if corners[next] == hinge.edge[0] { [first, second] } else { [second, first] };
            for (edge, held) in [(next, across), (far, first), (last, second)] {
                strain.held[edge] += held;
            }
        }
    }

    /// Each row's block with itself: its mass, and against what others feel of it. What does not move has none at all.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn settle_rows(&self, finest: &mut Level<'_>) {
        let weight = &*self.vectors.weight;
        for (row, &own) in weight.iter().enumerate() {
            let range = finest.graph.range(row);
            for (link, &other) in range.clone().zip(finest.graph.row(row)).rev() {
                if (other as usize) < row {
                    break;
                }
                mirror(finest, link, finest.graph.link(other as usize, row as u32));
            }
            let (mut sum, mut alone) = ([0.0f32; BLOCK], [0.0f32; BLOCK]);
            for (link, &other) in range.clone().zip(finest.graph.row(row)) {
                let Some(block) = finest.blocks.get_mut(BLOCK * link..BLOCK * (link + 1)) else { continue };
                sum.iter_mut().zip(&*block).for_each(|(sum, number)| *sum -= number);
                let moves = own > 0.0 && weight.get(other as usize).is_some_and(|&weight| weight > 0.0);
                if moves {
                    let near = finest.plate.near.get(link).map_or(0.0, |near| near * finest.bending);
                    [0, 4, 8].into_iter().for_each(|i| block[i] += near);
                } else {
                    alone.iter_mut().zip(&*block).for_each(|(sum, number)| *sum -= number);
                    block.fill(0.0);
                }
            }
            let at = BLOCK * row..BLOCK * (row + 1);
            let (Some(whole), Some(left)) = (finest.whole.get_mut(at.clone()), finest.alone.get_mut(at)) else {
                continue;
            };
            if own > 0.0 {
                let part = |of: &[f32]| 1.0 / own + of.get(row).map_or(0.0, |number| number * finest.bending);
                for i in [0, 4, 8] {
                    sum[i] += part(finest.plate.own);
                    alone[i] += part(finest.plate.alone);
                }
                whole.iter_mut().zip(sum).for_each(|(number, sum)| *number += sum);
                left.copy_from_slice(&alone);
            } else {
                whole.fill(0.0);
                left.fill(0.0);
            }
        }
    }
}

/// Puts a block on the link back.
#[cfg_attr(not(target_os = "none"), inline(always))]
fn mirror(finest: &mut Level<'_>, link: usize, back: Option<usize>) {
    let from = finest.blocks.get(BLOCK * link..).and_then(|numbers| numbers.first_chunk::<BLOCK>());
    let (Some(&[a, b, c, d, e, f, g, h, i, _]), Some(back)) = (from, back) else { return };
    if let Some(to) = finest.blocks.get_mut(BLOCK * back..).and_then(|numbers| numbers.first_chunk_mut::<BLOCK>()) {
        *to = [a, d, g, b, e, h, c, f, i, 0.0];
    }
}

/// Adds to a block.
#[cfg_attr(not(target_os = "none"), inline(always))]
fn add(blocks: &mut [f32], number: usize, block: &Mat3) {
    if let Some(numbers) = blocks.get_mut(BLOCK * number..BLOCK * (number + 1)) {
        numbers.iter_mut().zip(block.to_cols_array()).for_each(|(sum, number)| *sum += number);
    }
}
