//! The momenta and the energy of the pieces of a shell that nothing holds.

use super::fold::{Fold, RestFold, curve};
use super::membrane::{Cell, Strain};
use super::pieces::{Piece, Roll};
use super::plate::Shape;
use super::solver::{NOBODY, Solver, Vectors};
use super::step::Step;
use super::{Bodies, ShellParams};
use crate::cloth::Hinge;
use crate::constrain::budget::{Budget, Free};
use crate::constrain::turn::{outer, turn_of};
use crate::constrain::walls::Wall;
use crate::constrain::whole::Group;
use crate::math::{largest, max};
use glam::{Mat3, Vec3};

/// Sums that go on side by side.
const SUMS: usize = 8;

impl Solver<'_> {
    /// Moves all by their shifts; of pieces that nothing holds so that their momenta stay, and no farther than the energy that they have takes them.
    pub(super) fn act_within(&mut self, bodies: &mut Bodies<'_>, roll: &mut Roll<'_>, work: &mut [u32]) {
        let shape = Shape { triangles: self.triangles, cells: self.cells, hinges: self.hinges, bends: self.bends };
        let all = 0..self.vectors.rows.len();
        let is_fixed = |i: usize| self.vectors.rows[i] != NOBODY && self.vectors.weight[i] == 0.0;
        let is_hung = roll.is_one() && all.clone().any(is_fixed);
        let Some(pieces) = (if is_hung { None } else { roll.sorted(self.vectors.rows, &shape, work) }) else {
            roll.forget();
            return self.act(bodies, all);
        };
        for piece in pieces.each() {
            let members = || piece.members.iter().map(|&number| number as usize);
            if self.is_free(members()) {
                self.keep_momenta(bodies, &piece);
                self.act_freely(bodies, &piece, roll.budget(&piece));
            } else {
                roll.budget(&piece).forget();
                self.act(bodies, members());
            }
        }
    }

    /// Tells whether none of them is fixed, and nothing in their way.
    fn is_free(&self, mut members: impl Iterator<Item = usize>) -> bool {
        let Vectors { rows, weight, .. } = &self.vectors;
        members.all(|i| (rows[i] == NOBODY || weight[i] > 0.0) && !self.walls.get(i).is_some_and(Wall::is_met))
    }

    /// Moves some.
    fn act(&self, bodies: &mut Bodies<'_>, members: impl Iterator<Item = usize>) {
        let Vectors { rows, weight, shift, .. } = &self.vectors;
        for i in members.filter(|&i| weight[i] > 0.0 && shift[i].is_finite()) {
            bodies.shift(rows[i] as usize, shift[i]);
        }
    }

    /// Takes from the shifts of a piece what they would change of its momenta: Σ m Δx and Σ m (x − v h) × Δx are none then.
    fn keep_momenta(&mut self, bodies: &Bodies<'_>, piece: &Piece<'_>) {
        let Vectors { weight, shift, .. } = &mut self.vectors;
        let Some(&origin) = piece.rows.first() else { return };
        let (h, origin) = (bodies.substep.seconds(), origin as usize);
        let place = |row: usize| {
            bodies.position[row] - bodies.position[origin] - (bodies.velocity[row] - bodies.velocity[origin]) * h
        };
        let all = || piece.members.iter().zip(piece.rows).map(|(&number, &row)| (number as usize, row as usize));
        let (mut mass, mut middle, mut drift) = (0.0, Vec3::ZERO, Vec3::ZERO);
        for (number, row) in all() {
            mass += 1.0 / weight[number];
            middle += place(row) / weight[number];
            drift += shift[number] / weight[number];
        }
        let (middle, drift) = (middle / mass, drift / mass);
        let (mut torque, mut spread) = (Vec3::ZERO, Mat3::ZERO);
        for (number, row) in all() {
            let arm = place(row) - middle;
            torque += arm.cross(shift[number] - drift) / weight[number];
            spread += outer(arm / weight[number], arm);
        }
        let turn = turn_of(spread, torque);
        for (number, row) in all() {
            let by = drift + turn.cross(place(row) - middle);
            shift[number] -= if by.is_finite() { by } else { Vec3::ZERO };
        }
    }

    /// Moves a piece that nothing holds, no farther than the energy that it has takes it.
    fn act_freely(&mut self, bodies: &mut Bodies<'_>, piece: &Piece<'_>, mut budget: Budget<'_>) {
        let begun = Group::begun(bodies, piece.rows).moving() + self.stored(piece).within(bodies.before[0]);
        let most = budget.most(begun);
        self.act(bodies, piece.members.iter().map(|&number| number as usize));
        let mut now = self.energy(bodies, piece);
        if now > most {
            // Strain that rounding may show is no too much: it would be taken of the motion time and again.
            let rounding = self.rounding(bodies, piece);
            let (mut stored, goal) = self.stored_with_column(piece);
            let mut free = Free { bodies, rows: piece.rows, due: None, goal };
            let _ = free.hold_back(most, |places, _| max(stored.within(places) - rounding, 0.0));
            now = self.energy(bodies, piece);
        }
        budget.keep(now, most);
    }

    /// The energy of a piece, of motion beside that of its middle and of strain \[J\].
    fn energy(&mut self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> f32 {
        Group::of(bodies, piece.rows).moving() + self.stored(piece).within(bodies.position)
    }

    /// The energy of strain that rounding of places may show \[J\].
    fn rounding(&self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> f32 {
        let far = piece.rows.iter().map(|&row| largest(bodies.position[row as usize])).fold(0.0, max);
        let (off, ([warp, weft], shear)) = (f32::EPSILON * far, (self.params.stretch, self.params.shear));
        let strained = |cell: &Cell| cell.area * cell.inverse.iter().map(|by| by * by).sum::<f32>();
        let sum: f32 = piece.triangles.iter().map(|&triangle| strained(&self.cells[triangle as usize])).sum();
        let sum = 0.5 * (warp + weft + shear) * sum * (off * off);
        if sum.is_finite() { sum } else { 0.0 }
    }

    fn stored<'s>(&'s mut self, piece: &Piece<'s>) -> Stored<'s> {
        self.stored_with_column(piece).0
    }

    /// What a piece is strained by, and a column that the solution needs no more.
    fn stored_with_column<'s>(&'s mut self, piece: &Piece<'s>) -> (Stored<'s>, &'s mut [Vec3]) {
        let Self { params, triangles, cells, ref mut strains, hinges, bends, .. } = *self;
        let Vectors { rows, r, .. } = &mut self.vectors;
        (Stored { params, triangles, cells, strains, hinges, bends, rows, piece: *piece }, r)
    }
}

/// What a piece is strained by.
struct Stored<'s> {
    params: &'s ShellParams,
    triangles: &'s [[u32; 3]],
    cells: &'s [Cell],
    strains: &'s mut [Strain],
    hinges: &'s [Hinge],
    bends: &'s [RestFold],
    rows: &'s [u32],
    piece: Piece<'s>,
}

impl Stored<'_> {
    /// The energy of strain where all are in these places \[J\].
    fn within(&mut self, places: &[Vec3]) -> f32 {
        let stretched = self.stretched(places);
        if !(self.params.bending > 0.0) {
            return stretched;
        }
        let mut sums = [0.0; SUMS];
        self.curve(places);
        for (number, triangle) in self.triangles_of().enumerate() {
            let ([a, b, c], area) = (self.strains[triangle].curvature, self.cells[triangle].area);
            sums[number % SUMS] += 0.5 * self.params.bending * area * (a * a + b * b + c * c);
        }
        stretched + sums.iter().sum::<f32>()
    }

    /// The part of it that is in the plane of triangles \[J\].
    fn stretched(&self, places: &[Vec3]) -> f32 {
        let mut sums = [0.0; SUMS];
        for (number, triangle) in self.triangles_of().enumerate() {
            if let Some([a, b, c]) = at(places, self.rows, self.triangles[triangle]) {
                sums[number % SUMS] += self.cells[triangle].energy(self.params, [b - a, c - a]);
            }
        }
        sums.iter().sum()
    }

    fn triangles_of(&self) -> impl Iterator<Item = usize> + use<'_> {
        self.piece.triangles.iter().map(|&triangle| triangle as usize)
    }

    /// Adds to each triangle's curvature what its folds make of it.
    fn curve(&mut self, places: &[Vec3]) {
        let still = Step { h: 1.0, lag: 0.0, rate: 1.0 };
        for &triangle in self.piece.triangles {
            self.strains[triangle as usize].curvature = [0.0; 3];
        }
        for hinge in self.piece.hinges.iter().map(|&hinge| hinge as usize) {
            let (hinge, bend) = (&self.hinges[hinge], &self.bends[hinge]);
            if let Some([a, b, c, d]) = at(places, self.rows, hinge.corners()) {
                let (_, open) = Fold::of(bend, &still, [[b - a, c - a, d - a]; 3]);
                curve(self.strains, hinge, bend, open);
            }
        }
    }
}

/// The places of some corners, if all are there.
fn at<const N: usize>(places: &[Vec3], rows: &[u32], corners: [u32; N]) -> Option<[Vec3; N]> {
    let found = corners.map(|corner| rows.get(corner as usize).and_then(|&row| places.get(row as usize)));
    found.iter().all(Option::is_some).then(|| found.map(|place| place.copied().unwrap_or_default()))
}
