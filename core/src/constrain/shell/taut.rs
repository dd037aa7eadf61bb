//! Edges of a shell that have come out longer than its linear system knows of.

use super::eights::{WIDE, column, eight, gathered};
use super::membrane::Cell;
use super::solver::{NOBODY, Solver, Vectors};
use crate::constrain::{Bodies, walls};
use crate::lanes::{self, Eight, Kernel, LANES, Vectors as Side};
use crate::math::{length, max, sqrt};
use glam::Vec3;

/// Passes over all edges, at the most.
const PASSES: u32 = 64;
/// The share of an edge's length by which they leave it too long.
const SLACK: f32 = 1e-3;

impl Solver<'_> {
    /// Shortens, by equal and opposite shifts, the edges that have turned so far that what is solved along the directions of the sub-step's
    /// beginning leaves them longer than they are at rest and than it means them to be.
    pub(super) fn tighten(&mut self, bodies: &mut Bodies<'_>) {
        let Vectors { shift, p, .. } = &mut self.vectors;
        p.copy_from_slice(shift);
        self.vectors.stamps().fill(0);
        let eights = self.triangles.len().div_ceil(LANES) as u32;
        for pass in 0..PASSES {
            if !lanes::run(Tighten { solver: self, bodies, before: pass * eights }) {
                return;
            }
            let Vectors { shift, q, .. } = &mut self.vectors;
            let stamps = bytemuck::cast_slice_mut::<_, u32>(q);
            walls::keep(self.walls, bodies, shift, |number| stamps[number] = (pass + 1) * eights);
        }
        bodies.report.caps.edges += 1;
    }

    /// Shortens the edges of a triangle, and stamps who goes with it; tells whether it had to.
    fn shorten(&mut self, i: usize, bodies: &Bodies<'_>, stamp: u32) -> bool {
        let (Some(&corners), Some(cell)) = (self.triangles.get(i), self.cells.get(i)) else { return false };
        if !(cell.area > 0.0) {
            return false;
        }
        let mut some = false;
        for side in 0..3 {
            let edge = [corners[side] as usize, corners[(side + 1) % 3] as usize];
            if self.shorten_edge(edge, |this| this.cells.get(i).map_or(0.0, |cell| cell.rest(side)), bodies) {
                some = true;
                let stamps = self.vectors.stamps();
                edge.into_iter().for_each(|end| stamps[end] = stamp);
            }
        }
        some
    }

    fn shorten_edge(&mut self, [a, b]: [usize; 2], rest: impl Fn(&Self) -> f32, bodies: &Bodies<'_>) -> bool {
        let Vectors { rows, weight, shift, p: solved, .. } = &self.vectors;
        let (Some(&first), Some(&second)) = (rows.get(a), rows.get(b)) else { return false };
        let ease = weight[a] + weight[b];
        if first == NOBODY || second == NOBODY || !(ease > 0.0) {
            return false;
        }
        let between = |of: &[Vec3]| of[second as usize] - of[first as usize];
        let way = between(bodies.position);
        let now = way + (shift[b] - shift[a]);
        let before = between(bodies.before[0]);
        let far = length(now);
        let meant = length(way) + before.dot(solved[b] - solved[a]) / length(before);
        if !(far > meant * (1.0 + SLACK)) {
            return false;
        }
        let most = max(meant, rest(self));
        if !(far > most * (1.0 + SLACK)) {
            return false;
        }
        let by = now * ((far - most) / (far * ease));
        let Vectors { weight, shift, .. } = &mut self.vectors;
        shift[a] += by * weight[a];
        shift[b] -= by * weight[b];
        true
    }
}

/// One pass over all triangles; tells whether an edge had to be shortened. Of eight side by side that have none nobody is asked, nor of those whose
/// corners have not gone since they were asked last.
struct Tighten<'a, 's, 'm, 'b> {
    solver: &'a mut Solver<'m>,
    bodies: &'s Bodies<'b>,
    /// The eights that passes before this one have been through.
    before: u32,
}

impl Kernel for Tighten<'_, '_, '_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> bool {
        let (count, mut some) = (self.solver.triangles.len(), false);
        let eights = count.div_ceil(LANES) as u32;
        for (number, first) in (0..count).step_by(LANES).enumerate() {
            let stamp = self.before + number as u32 + 1;
            if self.before > 0 && self.stand_since(stamp - eights, first) {
                continue;
            }
            if !(WIDE && self.none_of_eight(like, first)) {
                for i in first..count.min(first + LANES) {
                    some |= self.solver.shorten(i, self.bodies, stamp);
                }
            }
        }
        some
    }
}

impl Tighten<'_, '_, '_, '_> {
    /// Tells whether no corner of eight triangles has gone since then.
    fn stand_since(&self, stamp: u32, first: usize) -> bool {
        let Solver { triangles, ref vectors, .. } = *self.solver;
        let stamps = bytemuck::cast_slice::<_, u32>(&*vectors.q);
        let eight = triangles.get(first..triangles.len().min(first + LANES)).unwrap_or(&[]);
        eight.as_flattened().iter().all(|&corner| stamps.get(corner as usize).is_none_or(|&last| last < stamp))
    }

    /// Tells whether there are eight, all of them there, and none has an edge to be shortened: by the operations of `shorten_edge`.
    #[inline(always)]
    fn none_of_eight<F: Eight>(&self, like: F, first: usize) -> bool {
        let all = self.edges(like, first);
        let Some((cells, [now, meant])) = all else { return false };
        let twice = like.all(2.0) * column!(like, cells, |cell| cell.area);
        let [a, b, c, d] = [
            column!(like, cells, |cell| cell.inverse[0]),
            column!(like, cells, |cell| cell.inverse[1]),
            column!(like, cells, |cell| cell.inverse[2]),
            column!(like, cells, |cell| cell.inverse[3]),
        ];
        let (e, f) = ([d * twice, lanes::negated(b) * twice], [lanes::negated(c) * twice, a * twice]);
        let sides = [e, [f[0] - e[0], f[1] - e[1]], f];
        let slack = like.all(1.0 + SLACK);
        let mut some = like.all(0.0);
        for side in 0..3 {
            let [x, y] = sides[side];
            let most = lanes::max(meant[side], (x * x + y * y).sqrt());
            some = some | (now[side].simd_gt(meant[side] * slack) & now[side].simd_gt(most * slack));
        }
        !(some & twice.simd_gt(like.all(0.0))).any()
    }

    /// How long the edges of eight are, and mean to be.
    #[inline(always)]
    fn edges<F: Eight>(&self, like: F, first: usize) -> Option<(&[Cell; LANES], [[F; 3]; 2])> {
        let Solver { triangles, cells, ref vectors, .. } = *self.solver;
        let (corners, cells) = (eight(triangles, first)?, eight(cells, first)?);
        let mut rows = [[NOBODY; 3]; LANES];
        for (row, corner) in rows.as_flattened_mut().iter_mut().zip(corners.as_flattened()) {
            *row = *vectors.rows.get(*corner as usize)?;
        }
        let places: [Side<F>; 3] = gathered(like, self.bodies.position, &rows)?;
        let before: [Side<F>; 3] = gathered(like, self.bodies.before[0], &rows)?;
        let shift: [Side<F>; 3] = gathered(like, vectors.shift, corners)?;
        let solved: [Side<F>; 3] = gathered(like, vectors.p, corners)?;
        let [mut now, mut meant] = [[like.all(0.0); 3]; 2];
        for side in 0..3 {
            let (way, before) = (edge(&places, side), edge(&before, side));
            now[side] = (way + edge(&shift, side)).length();
            meant[side] = way.length() + before.dot(edge(&solved, side)) / before.length();
        }
        Some((cells, [now, meant]))
    }
}

#[inline(always)]
fn edge<F: Eight>(of: &[Side<F>; 3], side: usize) -> Side<F> {
    of[(side + 1) % 3] - of[side]
}

impl Cell {
    /// The length of one of its edges at rest.
    fn rest(&self, side: usize) -> f32 {
        let places = self.places();
        let ([a, b], [c, d]) = (places[side], places[(side + 1) % 3]);
        let (x, y) = (c - a, d - b);
        sqrt(x * x + y * y)
    }
}
