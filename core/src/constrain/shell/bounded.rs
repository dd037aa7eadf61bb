//! The energy of a shell that nothing holds.

use super::fold::{Fold, RestFold, curve};
use super::membrane::{Cell, Strain};
use super::solver::{Solver, Vectors};
use super::step::Step;
use super::{Bodies, ShellParams};
use crate::cloth::Hinge;
use crate::constrain::budget::{Budget, Free};
use crate::constrain::walls::Wall;
use crate::math::{largest, max};
use glam::Vec3;

/// Sums that go on side by side.
const SUMS: usize = 8;

impl Solver<'_> {
    /// Tells whether nobody is fixed, and nothing in the way.
    pub(super) fn is_free(&self) -> bool {
        let Vectors { rows, weight, .. } = &self.vectors;
        let mut living = rows.iter().zip(&**weight).filter(|&(&row, _)| row != super::solver::NOBODY);
        living.all(|(_, &weight)| weight > 0.0) && !self.walls.iter().any(Wall::is_met)
    }

    /// Moves all by their shifts; if nothing holds them, no farther than the energy that they have takes them.
    pub(super) fn act_within(&mut self, bodies: &mut Bodies<'_>, mut budget: Budget<'_>) {
        if !self.is_free() {
            budget.forget();
            return self.act(bodies);
        }
        let h = self.step.h;
        self.show(bodies.before[0], bodies.velocity);
        let most = budget.most(self.energy());
        self.show(bodies.position, bodies.velocity);
        let Vectors { shift, p, q, .. } = &mut self.vectors;
        for ((x, v), &by) in p.iter_mut().zip(&mut **q).zip(&**shift) {
            *x += by;
            *v += by * (1.0 / h);
        }
        let mut now = self.energy();
        let allowed = if now > most { most + self.rounding() } else { most };
        if now > allowed {
            let (mut free, mut sheet, rows) = self.parts();
            free.hold_back(
                h,
                allowed,
                |number| bodies.before[0][rows[number] as usize],
                |places, _| sheet.stored(places),
            );
            self.place(bodies);
            now = self.energy();
        } else {
            self.act(bodies);
        }
        budget.keep(now, most);
    }

    /// Takes the places and velocities of all for the first directions and what comes of these, which nobody needs any more.
    fn show(&mut self, places: &[Vec3], velocities: &[Vec3]) {
        let Vectors { rows, p, q, .. } = &mut self.vectors;
        for ((x, v), &row) in p.iter_mut().zip(&mut **q).zip(&**rows) {
            let at = |column: &[Vec3]| column.get(row as usize).copied().unwrap_or(Vec3::ZERO);
            (*x, *v) = (at(places), at(velocities));
        }
    }

    /// Leaves all where those columns say.
    fn place(&self, bodies: &mut Bodies<'_>) {
        let Vectors { rows, weight, p, q, .. } = &self.vectors;
        for (((&row, &weight), &x), &v) in rows.iter().zip(&**weight).zip(&**p).zip(&**q) {
            if weight > 0.0 && x.is_finite() && v.is_finite() {
                let row = row as usize;
                bodies.shift(row, x - bodies.position[row]);
                (bodies.position[row], bodies.velocity[row]) = (x, v);
            }
        }
    }

    /// The energy of strain and of motion beside that of the middle, where those columns say \[J\].
    fn energy(&mut self) -> f32 {
        let (free, mut sheet, _) = self.parts();
        free.moving() + sheet.stored(free.place)
    }

    /// The energy of strain that rounding of places may show where those columns say \[J\].
    fn rounding(&self) -> f32 {
        let there = self.vectors.p.iter().zip(&*self.vectors.weight).filter(|&(_, &weight)| weight > 0.0);
        let off = f32::EPSILON * there.map(|(&place, _)| largest(place)).fold(0.0, max);
        let ([warp, weft], shear) = (self.params.stretch, self.params.shear);
        let strained = |cell: &Cell| cell.area * cell.inverse.iter().map(|by| by * by).sum::<f32>();
        let sum: f32 = self.cells.iter().map(strained).sum();
        let sum = 0.5 * (warp + weft + shear) * sum * (off * off);
        if sum.is_finite() { sum } else { 0.0 }
    }

    fn parts(&mut self) -> (Free<'_>, Stored<'_>, &[u32]) {
        let Self { params, triangles, cells, ref mut strains, hinges, bends, .. } = *self;
        let Vectors { rows, weight, p, q, r, .. } = &mut self.vectors;
        let free = Free { weight, place: p, velocity: q, goal: r };
        (free, Stored { params, triangles, cells, strains, hinges, bends, weight }, rows)
    }
}

/// What a shell is strained by.
struct Stored<'s> {
    params: &'s ShellParams,
    triangles: &'s [[u32; 3]],
    cells: &'s [Cell],
    strains: &'s mut [Strain],
    hinges: &'s [Hinge],
    bends: &'s [RestFold],
    weight: &'s [f32],
}

impl Stored<'_> {
    /// The energy of strain where all are in these places \[J\].
    fn stored(&mut self, places: &[Vec3]) -> f32 {
        let mut sums = [0.0; SUMS];
        for (number, ((&corners, cell), strain)) in
            self.triangles.iter().zip(self.cells).zip(&mut *self.strains).enumerate()
        {
            strain.curvature = [0.0; 3];
            if let Some([a, b, c]) = at(places, self.weight, corners) {
                sums[number % SUMS] += cell.energy(self.params, [b - a, c - a]);
            }
        }
        if self.params.bending > 0.0 {
            self.curve(places);
            for (number, (cell, strain)) in self.cells.iter().zip(&*self.strains).enumerate() {
                let [a, b, c] = strain.curvature;
                sums[number % SUMS] += 0.5 * self.params.bending * cell.area * (a * a + b * b + c * c);
            }
        }
        sums.iter().sum()
    }

    /// Adds to each triangle's curvature what its folds make of it.
    fn curve(&mut self, places: &[Vec3]) {
        let still = Step { h: 1.0, lag: 0.0, rate: 1.0 };
        for (hinge, bend) in self.hinges.iter().zip(self.bends) {
            if let Some([a, b, c, d]) = at(places, self.weight, hinge.corners()) {
                let (_, open) = Fold::of(bend, &still, [[b - a, c - a, d - a]; 3]);
                curve(self.strains, hinge, bend, open);
            }
        }
    }
}

/// The places of some corners, if all are there.
fn at<const N: usize>(places: &[Vec3], weight: &[f32], corners: [u32; N]) -> Option<[Vec3; N]> {
    let all_there = corners.iter().all(|&corner| weight.get(corner as usize).is_some_and(|&weight| weight > 0.0));
    all_there.then(|| corners.map(|corner| places[corner as usize]))
}
