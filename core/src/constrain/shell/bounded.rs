//! The momenta and the energy of the pieces of a shell that nothing holds, and the energy of those that walls press.

use super::Bodies;
use super::STEPS;
use super::membrane::Cell;
use super::pieces::{Piece, Roll};
use super::plate::Shape;
use super::solver::{NOBODY, Solver, Vectors};
use super::stored::Stored;
use crate::constrain::bisect::bisect;
use crate::constrain::budget::{Budget, Free};
use crate::constrain::turn::{outer, turn_of};
use crate::constrain::walls::Wall;
use crate::constrain::whole::Group;
use crate::math::{aside, dot, largest, length, max};
use glam::{Mat3, Vec3};

/// Sums that go on side by side.
const SUMS: usize = 8;
/// The share of its energy that what is pressed by walls may gain in a sub-step: that much is rounding, and what solutions are cut off at. What gains
/// more has turned too far for the directions of the beginning.
const EVEN: f32 = 1e-3;
/// Rounds in which a piece that bears something is brought to its momenta.
const LADEN_ROUNDS: u32 = 4;
/// The sine of the angle by which a wall has to lean out of others to be another.
const LEVEL: f32 = 1e-3;

/// The energy of a piece's motion as a sub-step began \[J\], and what forces have given it since.
struct Given {
    moved: f32,
    /// How much forces have added on the way that it has gone, and the method by itself \[J\].
    work: f32,
    /// The momentum that forces have added \[kg m/s\].
    push: Vec3,
    /// By how much rounding of places may be wrong about their work \[J\].
    unsure: f32,
}

impl Solver<'_> {
    /// Moves all by their shifts; of pieces that nothing holds so that their momenta stay, and no farther than the energy that they have takes them. Tells
    /// whether that is all: where walls press pieces that gain energy, these need another step of Newton's method, unless this one is the last.
    pub(super) fn act_within(
        &mut self,
        bodies: &mut Bodies<'_>,
        roll: &mut Roll<'_>,
        work: &mut [u32],
        step: u32,
    ) -> bool {
        let shape = Shape { triangles: self.triangles, cells: self.cells, hinges: self.hinges, bends: self.bends };
        let all = 0..self.vectors.rows.len();
        let is_fixed = |i: usize| self.vectors.rows[i] != NOBODY && self.vectors.weight[i] == 0.0;
        let is_hung = roll.is_one() && all.clone().any(is_fixed);
        let Some(pieces) = (if is_hung { None } else { roll.sorted(self.vectors.rows, &shape, work) }) else {
            roll.forget();
            self.act(bodies, all);
            return true;
        };
        let mut is_done = true;
        self.vectors.pressing.fill(0);
        for piece in pieces.each() {
            let members = || piece.members.iter().map(|&number| number as usize);
            if step > 1 && members().any(|number| self.vectors.shift[number].is_nan()) {
                continue;
            }
            let is_laden = piece.rows.iter().any(|&row| bodies.load(row as usize) > 0.0);
            if self.is_free(members()) {
                self.keep_momenta(bodies, &piece, is_laden);
                self.act_freely(bodies, &piece, roll.budget(&piece));
            } else {
                roll.budget(&piece).forget();
                let is_bounded = !piece.triangles.is_empty() && !is_laden && self.leans(members());
                self.act(bodies, members());
                if let Some((most, given)) = if is_bounded { self.gains(bodies, &piece) } else { None } {
                    if step == STEPS {
                        self.hold_short(bodies, &piece, most, &given);
                    } else {
                        members().for_each(|number| self.vectors.needs_more(number));
                        is_done = false;
                    }
                }
            }
        }
        is_done
    }

    /// Tells whether none of them is fixed, and whatever presses them stands still.
    fn leans(&self, mut members: impl Iterator<Item = usize>) -> bool {
        let Vectors { rows, weight, .. } = &self.vectors;
        let stands = |i: usize| self.walls.get(i).is_none_or(|wall| !wall.is_met() || wall.stands());
        members.all(|i| (rows[i] == NOBODY || weight[i] > 0.0) && stands(i))
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

    /// Takes from the shifts of a piece what they would change of its momenta: Σ m Δx and Σ m (x − v h) × Δx are none then, with all that it bears. What is beside the
    /// particle that bears it is heavy elsewhere than what is taken tells, so that this takes another round.
    fn keep_momenta(&mut self, bodies: &Bodies<'_>, piece: &Piece<'_>, is_laden: bool) {
        let Vectors { weight, shift, .. } = &mut self.vectors;
        let Some(&origin) = piece.rows.first() else { return };
        let (h, origin) = (bodies.substep.seconds(), origin as usize);
        let place = |row: usize| {
            bodies.position[row] - bodies.position[origin] - (bodies.velocity[row] - bodies.velocity[origin]) * h
        };
        let all = || piece.members.iter().zip(piece.rows).map(|(&number, &row)| (number as usize, row as usize));
        for _ in 0..if is_laden { LADEN_ROUNDS } else { 1 } {
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
                torque += bodies.load_moment(row).cross(shift[number]);
                spread += outer(arm / weight[number], arm);
            }
            let turn = turn_of(spread, torque);
            for (number, row) in all() {
                let by = drift + turn.cross(place(row) - middle);
                shift[number] -= if by.is_finite() { by } else { Vec3::ZERO };
            }
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

    /// Tells whether a piece has gained that walls press which stand still: they give it no energy, so what is solved leaves it no more of motion and strain
    /// than there was as the sub-step began, and what forces have done on its way. A solution along the directions of the beginning makes more of triangles
    /// that are pressed far. Bending is asked for only where what is in the plane of triangles, which costs little to tell, comes to too much. Tells how
    /// much it may have \[J\], and what it is given.
    fn gains(&mut self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> Option<(f32, Given)> {
        let given = self.given(bodies, piece);
        let [strained, now] = self.stored(piece).stretched_at([bodies.before[0], bodies.position]);
        let now = self.moving(bodies, piece) + now;
        if !(now > (given.moved + strained) * (1.0 + EVEN) + given.work + given.unsure) {
            return None;
        }
        let begun = given.moved + self.stored(piece).within(bodies.before[0]);
        let most = begun + given.unsure + self.rounding(bodies, piece);
        (self.seen(bodies, piece) > most + given.work + EVEN * begun).then_some((most, given))
    }

    /// Lets a piece go only as much of its way, but for how all together go along the walls, as takes no more energy than `most` \[J\] and what it is given
    /// on that: if need be none, when it is strained as it was. Whoever was on this side of a flat wall that presses is so then.
    fn hold_short(&mut self, bodies: &mut Bodies<'_>, piece: &Piece<'_>, most: f32, given: &Given) {
        let (h, slide) = (bodies.substep.seconds(), self.along_walls(bodies, piece));
        let along = given.push.dot(slide);
        let mut now = 1.0;
        let longest = bisect(|next| {
            let share = next / now;
            now = next;
            for row in piece.rows.iter().map(|&row| row as usize) {
                let from = bodies.before[0][row] + slide * h;
                bodies.position[row] = from + (bodies.position[row] - from) * share;
                bodies.velocity[row] = slide + (bodies.velocity[row] - slide) * share;
            }
            self.seen(bodies, piece) <= most + along + (given.work - along) * next
        });
        bodies.report.caps.crushed += u64::from(longest == 0.0);
    }

    /// How the middle of a piece goes along all walls that press it, as forces have it: they take none of that if they are smooth, and what solutions are
    /// wrong by would drive it.
    fn along_walls(&self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> Vec3 {
        let walls = || piece.members.iter().filter_map(|&i| self.walls.get(i as usize)).filter(|wall| wall.is_met());
        if walls().any(Wall::is_rough) {
            return Vec3::ZERO;
        }
        let (mut mass, mut drift, mut across) = (0.0, Vec3::ZERO, [Vec3::ZERO; 3]);
        for (&number, &row) in piece.members.iter().zip(piece.rows) {
            let row = row as usize;
            mass += bodies.mass[row];
            drift += self.free(bodies, number as usize, row) * bodies.mass[row];
        }
        let mut along = drift / mass;
        for normal in walls().flat_map(Wall::normals) {
            let other = across.iter().fold(normal, |normal, &across| aside(normal, across));
            let size = length(other);
            if let Some(free) = across.iter_mut().find(|across| **across == Vec3::ZERO).filter(|_| size > LEVEL) {
                *free = other / size;
                along = aside(along, *free);
            }
        }
        along
    }

    /// How fast a particle would be if the shell and its walls had done nothing in the sub-step \[m/s\].
    fn free(&self, bodies: &Bodies<'_>, number: usize, row: usize) -> Vec3 {
        let Vectors { shift, met, .. } = &self.vectors;
        bodies.velocity[row] - (met[number] + shift[number]) / bodies.substep.seconds()
    }

    /// The energy of a piece, of strain and of motion \[J\].
    fn seen(&mut self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> f32 {
        self.stored(piece).within(bodies.position) + self.moving(bodies, piece)
    }

    /// The energy of motion of a piece \[J\]. How fast anybody goes into a wall that has pressed him is no part of that, as it takes it from him.
    fn moving(&self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> f32 {
        let mut sums = [0.0; SUMS];
        for (i, (&number, &row)) in piece.members.iter().zip(piece.rows).enumerate() {
            let fast = bodies.velocity[row as usize];
            let fast = self.walls.get(number as usize).map_or(fast, |wall| wall.without_inward(fast));
            sums[i % SUMS] += 0.5 * bodies.mass[row as usize] * dot(fast, fast);
        }
        sums.iter().sum()
    }

    /// The energy of motion of a piece as the sub-step began, and what forces have given it since.
    fn given(&self, bodies: &Bodies<'_>, piece: &Piece<'_>) -> Given {
        let (Vectors { shift, met, .. }, h) = (&self.vectors, bodies.substep.seconds());
        let (mut sums, mut far, mut all) = ([[0.0; SUMS]; 4], 0.0, Vec3::ZERO);
        for (i, (&number, &row)) in piece.members.iter().zip(piece.rows).enumerate() {
            let (number, row) = (number as usize, row as usize);
            let (mass, solved) = (bodies.mass[row], met[number] + shift[number]);
            let (before, free) = (bodies.before[1][row], bodies.velocity[row] - solved / h);
            let way = (bodies.position[row] - bodies.before[0][row]) / h;
            let (push, energy) = ((free - before) * mass, |v: Vec3| 0.5 * mass * dot(v, v));
            sums[0][i % SUMS] += energy(before);
            sums[1][i % SUMS] += dot(push, way);
            sums[2][i % SUMS] += energy(free) - energy(before) - dot(push, way - solved / h);
            sums[3][i % SUMS] += length(push);
            all += push;
            far = max(far, largest(bodies.position[row]));
        }
        let [moved, work, own, pushed] = sums.map(|sums| sums.iter().sum::<f32>());
        Given { moved, work: work + max(own, 0.0), push: all, unsure: pushed * (f32::EPSILON * far / h) }
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
