//! How shells resist small shifts, eight triangles or folds side by side: by the operations of one, in their order, so that the bits are the same.

use super::ShellParams;
use super::corners::{add_all, add_pair, all_at};
use super::eights::{WIDE, all_corners, at_rest, column, eight, eight_mut, gathered, vector, vectors};
use super::fold::{Fold, RestFold, curve, moment};
use super::membrane::{Cell, Strain};
use super::step::Step;
use crate::cloth::Hinge;
use crate::lanes::{Eight, Kernel, LANES, Vectors};
use glam::Vec3;

/// Adds h² K p to q.
pub(super) struct Resist<'s> {
    pub(super) params: &'s ShellParams,
    pub(super) step: &'s Step,
    /// Bending stiffness × h², for changes within the sub-step.
    pub(super) bending: f32,
    /// True if what acts along edges is in blocks, and is left out.
    pub(super) bends_only: bool,
    pub(super) triangles: &'s [[u32; 3]],
    pub(super) cells: &'s [Cell],
    pub(super) strains: &'s mut [Strain],
    pub(super) hinges: &'s [Hinge],
    pub(super) bends: &'s [RestFold],
    pub(super) folds: &'s [Fold],
    pub(super) p: &'s [Vec3],
    pub(super) q: &'s mut [Vec3],
}

impl Kernel for Resist<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        let (triangles, hinges) = (self.triangles.len(), self.hinges.len());
        if self.bends_only {
            self.strains.iter_mut().for_each(|strain| strain.curvature = [0.0; 3]);
        }
        for first in (0..if self.bends_only { 0 } else { triangles }).step_by(LANES) {
            if !(WIDE && self.stretch_eight(like, first)) {
                (first..triangles.min(first + LANES)).for_each(|i| self.stretch(i));
            }
        }
        for first in (0..hinges).step_by(LANES) {
            if !(WIDE && self.curve_eight(like, first)) {
                (first..hinges.min(first + LANES)).for_each(|i| self.curve(i));
            }
        }
        for first in (0..hinges).step_by(LANES) {
            if !(WIDE && self.bend_eight(like, first)) {
                (first..hinges.min(first + LANES)).for_each(|i| self.bend(i));
            }
        }
    }
}

impl Resist<'_> {
    fn stretch(&mut self, i: usize) {
        let (Some(&corners), Some(cell), Some(strain)) =
            (self.triangles.get(i), self.cells.get(i), self.strains.get_mut(i))
        else {
            return;
        };
        strain.curvature = [0.0; 3];
        let at = |corner: u32| self.p.get(corner as usize);
        let (Some(&a), Some(&b), Some(&c)) = (at(corners[0]), at(corners[1]), at(corners[2])) else { return };
        add_pair(self.q, corners, strain.resist(cell, self.params, self.step, [b - a, c - a]));
    }

    fn curve(&mut self, i: usize) {
        let (Some(hinge), Some(bend), Some(fold)) = (self.hinges.get(i), self.bends.get(i), self.folds.get(i)) else {
            return;
        };
        let Some(corners) = all_at(self.p, hinge.corners()) else { return };
        curve(self.strains, hinge, bend, fold.change(corners));
    }

    fn bend(&mut self, i: usize) {
        let (Some(hinge), Some(bend), Some(fold)) = (self.hinges.get(i), self.bends.get(i), self.folds.get(i)) else {
            return;
        };
        let forces = fold.forces(moment(self.strains, self.cells, hinge, bend, self.bending));
        if self.bends_only {
            return add_all(self.q, hinge.corners(), forces);
        }
        let Some(corners) = all_at(self.p, hinge.corners()) else { return };
        let ([a, b, c, d], [e, f, g, h]) = (forces, fold.resist(corners));
        add_all(self.q, hinge.corners(), [a + e, b + f, c + g, d + h]);
    }

    /// Tells whether it has done so: there have to be eight, all corners, and none the last particle.
    #[inline(always)]
    fn stretch_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(corners), Some(cells), Some(strains)) =
            (eight(self.triangles, first), eight(self.cells, first), eight_mut(self.strains, first))
        else {
            return false;
        };
        let Some([a, b, c]) = gathered(like, self.p, corners) else { return false };
        let (e, f) = (b - a, c - a);
        let (inverse, area) = at_rest(like, cells);
        let (du, dv) = (e * inverse[0] + f * inverse[1], e * inverse[2] + f * inverse[3]);
        let all = &*strains;
        let u = vectors!(like, all, |strain| strain.along[0]);
        let v = vectors!(like, all, |strain| strain.along[1]);
        let tension = column!(like, all, |strain| strain.tension);
        let (square, rate) = (like.all(self.step.h * self.step.h), like.all(self.step.rate));
        let scale = area * square;
        let stiff = |stiffness: f32, strain: F| scale * like.all(stiffness) * strain * rate;
        let [warp, weft] = self.params.stretch;
        let (warp, weft) = (stiff(warp, u.dot(du)), stiff(weft, v.dot(dv)));
        let shear = stiff(self.params.shear, u.dot(dv) + v.dot(du));
        let forces = |p: Vectors<F>, q: Vectors<F>| [p * inverse[0] + q * inverse[2], p * inverse[1] + q * inverse[3]];
        let taut = like.all(0.25) * tension * area * square;
        let [a, b] = forces(u * warp + v * shear, v * weft + u * shear);
        let [c, d] = forces(du * taut, dv * taut);
        let (f, g) = ((a + c).rows(), (b + d).rows());
        for (i, strain) in strains.iter_mut().enumerate() {
            strain.curvature = [0.0; 3];
            add_pair(self.q, corners[i], [vector(f[i]), vector(g[i])]);
        }
        true
    }

    #[inline(always)]
    fn curve_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(hinges), Some(bends), Some(folds)) =
            (eight(self.hinges, first), eight(self.bends, first), eight(self.folds, first))
        else {
            return false;
        };
        let Some(corners) = gathered(like, self.p, &all_corners(hinges)) else { return false };
        let (foot, slope) = columns(like, folds);
        let [f, g] = ways(corners, foot, like.all(1.0));
        let change = (slope[0].dot(f) + slope[1].dot(g)).to_array();
        for i in 0..LANES {
            curve(self.strains, &hinges[i], &bends[i], change[i]);
        }
        true
    }

    #[inline(always)]
    fn bend_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(hinges), Some(bends), Some(folds)) =
            (eight(self.hinges, first), eight(self.bends, first), eight(self.folds, first))
        else {
            return false;
        };
        let rows = all_corners(hinges);
        let ((foot, slope), one) = (columns(like, folds), like.all(1.0));
        let mut moments = [0.0; LANES];
        for (i, sum) in moments.iter_mut().enumerate() {
            *sum = moment(self.strains, self.cells, &hinges[i], &bends[i], self.bending);
        }
        let moments = like.of(moments);
        let mut forces = spread([slope[0] * moments, slope[1] * moments], foot, one);
        if !self.bends_only {
            let Some(corners) = gathered(like, self.p, &rows) else { return false };
            let [f, g] = ways(corners, foot, one);
            let held = like.all(0.25) * column!(like, folds, |fold| fold.moment);
            let turning = [f * (held * slope[0].dot(slope[0])), g * (held * slope[1].dot(slope[1]))];
            let [[a, b, c, d], [e, f, g, h]] = [forces, spread(turning, foot, one)];
            forces = [a + e, b + f, c + g, d + h];
        }
        let [a, b, c, d] = forces;
        let [a, b, c, d] = [a.rows(), b.rows(), c.rows(), d.rows()];
        for (i, &corners) in rows.iter().enumerate() {
            add_all(self.q, corners, [vector(a[i]), vector(b[i]), vector(c[i]), vector(d[i])]);
        }
        true
    }
}

/// The feet of eight folds, and their slopes.
#[inline(always)]
pub(super) fn columns<F: Eight>(like: F, folds: &[Fold; LANES]) -> ([F; 2], [Vectors<F>; 2]) {
    let mut quads = [[[0.0; 4]; LANES]; 2];
    for (i, fold) in folds.iter().enumerate() {
        // The slopes, the feet, and the moment.
        let [a, b, c, d, e, f, g, h, _]: [f32; 9] = bytemuck::cast(*fold);
        (quads[0][i], quads[1][i]) = ([a, b, c, d], [e, f, g, h]);
    }
    let ([a, b, c, d], [e, f, g, h]) = (like.quads_of(quads[0]), like.quads_of(quads[1]));
    ([g, h], [Vectors([a, b, c]), Vectors([d, e, f])])
}

/// As [`Fold::ways`].
#[inline(always)]
fn ways<F: Eight>([a, b, c, d]: [Vectors<F>; 4], [x, y]: [F; 2], one: F) -> [Vectors<F>; 2] {
    [c - a * (one - x) - b * x, d - a * (one - y) - b * y]
}

/// As [`Fold::spread`].
#[inline(always)]
pub(super) fn spread<F: Eight>([c, d]: [Vectors<F>; 2], [x, y]: [F; 2], one: F) -> [Vectors<F>; 4] {
    [-(c * (one - x) + d * (one - y)), -(c * x + d * y), c, d]
}
