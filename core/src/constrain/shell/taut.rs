//! Edges of a shell that have come out longer than its linear system knows of.

use super::eights::{WIDE, column, eight, eight_mut, gathered};
use super::membrane::{Cell, Strain};
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

    /// Finds how long the edges of a triangle may be at the most: as they are at rest, or as what is solved means them to be; no number where
    /// that does not say.
    fn measure(&mut self, i: usize, bodies: &Bodies<'_>) {
        let (Some(&corners), Some(cell), Some(strain)) =
            (self.triangles.get(i), self.cells.get(i), self.strains.get_mut(i))
        else {
            return;
        };
        for side in 0..3 {
            let edge = [corners[side] as usize, corners[(side + 1) % 3] as usize];
            let meant = if cell.area > 0.0 { self.vectors.meant(edge, bodies) } else { f32::NAN };
            strain.held[side] = if meant.is_nan() { meant } else { max(meant, cell.rest(side)) };
        }
    }

    /// Shortens the edges of a triangle, and stamps who goes with it; tells whether it had to.
    fn shorten(&mut self, i: usize, bodies: &Bodies<'_>, stamp: u32) -> bool {
        let (Some(&corners), Some(&Strain { held, .. })) = (self.triangles.get(i), self.strains.get(i)) else {
            return false;
        };
        let mut some = false;
        for side in 0..3 {
            let edge = [corners[side] as usize, corners[(side + 1) % 3] as usize];
            if self.vectors.shorten(edge, held[side], bodies) {
                some = true;
                let stamps = self.vectors.stamps();
                edge.into_iter().for_each(|end| stamps[end] = stamp);
            }
        }
        some
    }
}

impl Vectors<'_> {
    /// The rows of the ends of an edge that can be shortened.
    fn ends(&self, [a, b]: [usize; 2]) -> Option<[usize; 2]> {
        let [first, second] = [*self.rows.get(a)?, *self.rows.get(b)?];
        let is_free = self.weight[a] + self.weight[b] > 0.0;
        (first != NOBODY && second != NOBODY && is_free).then_some([first as usize, second as usize])
    }

    /// How long what is solved means an edge to be; no number, if there is none that can be shortened.
    fn meant(&self, [a, b]: [usize; 2], bodies: &Bodies<'_>) -> f32 {
        let Some([first, second]) = self.ends([a, b]) else { return f32::NAN };
        let between = |of: &[Vec3]| of[second] - of[first];
        let (way, before) = (between(bodies.position), between(bodies.before[0]));
        length(way) + before.dot(self.p[b] - self.p[a]) / length(before)
    }

    fn shorten(&mut self, [a, b]: [usize; 2], most: f32, bodies: &Bodies<'_>) -> bool {
        let Some([first, second]) = self.ends([a, b]) else { return false };
        let Self { weight, shift, .. } = self;
        let now = bodies.position[second] - bodies.position[first] + (shift[b] - shift[a]);
        let far = length(now);
        if !(far > most * (1.0 + SLACK)) {
            return false;
        }
        let by = now * ((far - most) / (far * (weight[a] + weight[b])));
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
    fn run<F: Eight>(mut self, like: F) -> bool {
        let (count, mut some) = (self.solver.triangles.len(), false);
        let eights = count.div_ceil(LANES) as u32;
        for (number, first) in (0..count).step_by(LANES).enumerate() {
            let stamp = self.before + number as u32 + 1;
            if self.before > 0 && self.stand_since(stamp - eights, first) {
                continue;
            }
            let last = count.min(first + LANES);
            if self.before == 0 && !(WIDE && self.measure_eight(like, first)) {
                (first..last).for_each(|i| self.solver.measure(i, self.bodies));
            }
            let skipped = if WIDE { self.none_before(like, first) } else { 0 };
            for i in first + skipped..last {
                some |= self.solver.shorten(i, self.bodies, stamp);
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

    /// The corners of eight as rows; none, if one of them is not there.
    #[inline(always)]
    fn rows(&self, corners: &[[u32; 3]; LANES]) -> Option<[[u32; 3]; LANES]> {
        let mut rows = [[NOBODY; 3]; LANES];
        for (row, corner) in rows.as_flattened_mut().iter_mut().zip(corners.as_flattened()) {
            *row = *self.solver.vectors.rows.get(*corner as usize)?;
        }
        Some(rows)
    }

    /// Of eight, finds how long their edges may be at the most, by the operations of `measure`. Tells whether there are eight, all of them there.
    #[inline(always)]
    fn measure_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let Some(most) = self.most(like, first) else { return false };
        let Some(strains) = eight_mut(self.solver.strains, first) else { return false };
        let most = most.map(Eight::to_array);
        for (lane, strain) in strains.iter_mut().enumerate() {
            strain.held = [most[0][lane], most[1][lane], most[2][lane]];
        }
        true
    }

    #[inline(always)]
    fn most<F: Eight>(&self, like: F, first: usize) -> Option<[F; 3]> {
        let Solver { triangles, cells, ref vectors, .. } = *self.solver;
        let (corners, cells) = (eight(triangles, first)?, eight(cells, first)?);
        let rows = self.rows(corners)?;
        let places: [Side<F>; 3] = gathered(like, self.bodies.position, &rows)?;
        let before: [Side<F>; 3] = gathered(like, self.bodies.before[0], &rows)?;
        let solved: [Side<F>; 3] = gathered(like, vectors.p, corners)?;
        let twice = like.all(2.0) * column!(like, cells, |cell| cell.area);
        let [a, b, c, d] = [
            column!(like, cells, |cell| cell.inverse[0]),
            column!(like, cells, |cell| cell.inverse[1]),
            column!(like, cells, |cell| cell.inverse[2]),
            column!(like, cells, |cell| cell.inverse[3]),
        ];
        let (e, f) = ([d * twice, lanes::negated(b) * twice], [lanes::negated(c) * twice, a * twice]);
        let sides = [e, [f[0] - e[0], f[1] - e[1]], f];
        let (none, is_there) = (like.all(f32::NAN), twice.simd_gt(like.all(0.0)));
        let mut most = [none; 3];
        for side in 0..3 {
            let ([x, y], before) = (sides[side], edge(&before, side));
            let meant = edge(&places, side).length() + before.dot(edge(&solved, side)) / before.length();
            let rest = (x * x + y * y).sqrt();
            most[side] = (is_there & meant.simd_eq(meant)).select(lanes::max(meant, rest), none);
        }
        Some(most)
    }

    /// The number of those of eight that come before the first which has an edge to be shortened, by the operations of `shorten`.
    #[inline(always)]
    fn none_before<F: Eight>(&self, like: F, first: usize) -> usize {
        let Some((strains, now)) = self.now(like, first) else { return 0 };
        let most = [
            column!(like, strains, |strain| strain.held[0]),
            column!(like, strains, |strain| strain.held[1]),
            column!(like, strains, |strain| strain.held[2]),
        ];
        let (slack, mut some) = (like.all(1.0 + SLACK), like.all(0.0));
        for side in 0..3 {
            some = some | now[side].simd_gt(most[side] * slack);
        }
        LANES.min(some.to_bitmask().trailing_zeros() as usize)
    }

    /// How long the edges of eight are; none, if one of them is not there.
    #[inline(always)]
    fn now<F: Eight>(&self, like: F, first: usize) -> Option<(&[Strain; LANES], [F; 3])> {
        let Solver { triangles, ref strains, ref vectors, .. } = *self.solver;
        let (corners, strains) = (eight(triangles, first)?, eight(strains, first)?);
        let rows = self.rows(corners)?;
        let places: [Side<F>; 3] = gathered(like, self.bodies.position, &rows)?;
        let shift: [Side<F>; 3] = gathered(like, vectors.shift, corners)?;
        let mut now = [like.all(0.0); 3];
        for (side, now) in now.iter_mut().enumerate() {
            *now = (edge(&places, side) + edge(&shift, side)).length();
        }
        Some((strains, now))
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
