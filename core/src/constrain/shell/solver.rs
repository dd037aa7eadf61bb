//! The positions of a shell at a sub-step's end, by conjugate gradients.

use super::cycle::Levels;
use super::fold::{Fold, RestFold};
use super::membrane::{Cell, Strain};
use super::resist::Resist;
use super::step::Step;
use super::words::structs;
use super::{Bodies, ShellParams};
use crate::cloth::Hinge;
use crate::constrain::walls::{self, Wall};
use crate::lanes;
use crate::math::{dot, max, sqrt};
use crate::memory::take;
use crate::report::Report;
use crate::rows::add_scaled;
use glam::Vec3;

/// Iterations at the most.
const ITERATIONS: u32 = 400;
/// Solutions in turn with the question which walls press, at the most.
const PASSES: u32 = 8;
/// As many of them at the most are good to ten times what a solution is to be good to: it takes no more to see which walls press.
const ROUGHLY: u32 = 4;
/// The residual that a solution may have, as a share of what it begins with: in the norm of energy by a cycle through graphs, and by masses; and
/// where walls press that are rough, as friction goes by what these bear.
const RESIDUAL: [f32; 2] = [3e-3, 1e-4];
const ROUGH: [f32; 2] = [3e-4, 1e-4];
/// Shells of fewer particles are solved to a tenth of that: their iterations cost little, and what a cycle through few rows leaves shows in how they
/// slide and come to rest.
const FEW: usize = 1024;
const CLOSER: f32 = 0.1;
/// The sub-steps of damping from which on solutions are corrected.
const MANY: f32 = 4.0;
/// The share of an edge from which on they are, if particles are moved farther.
const FAR: f32 = 0.1;
/// The row of a particle that is not there.
pub(super) const NOBODY: u32 = u32::MAX;

/// The particles of a shell in a sub-step, by their place in its list.
pub(super) struct Vectors<'m> {
    pub(super) rows: &'m mut [u32],
    /// Inverse masses; zero for what does not move \[1/kg\].
    pub(super) weight: &'m mut [f32],
    /// How far they are moved \[m\].
    pub(super) shift: &'m mut [Vec3],
    /// Residuals, directions, and what the system makes of these.
    pub(super) r: &'m mut [Vec3],
    pub(super) p: &'m mut [Vec3],
    pub(super) q: &'m mut [Vec3],
    /// How far walls have moved them before anything is solved \[m\].
    pub(super) met: &'m mut [Vec3],
    /// The particles that walls press, and how many these are; between two steps of Newton's method, 1 for each that needs another.
    pub(super) pressing: &'m mut [u32],
    pressed: usize,
}

impl<'m> Vectors<'m> {
    /// Those of particles by their place in the scene's start; whoever is not finite is not among them.
    pub(super) fn of(bodies: &Bodies<'_>, particles: &[u32], words: &'m mut [u32]) -> Self {
        let mut rest = words;
        let count = particles.len();
        let rows = take(&mut rest, count);
        let weight: &mut [f32] = bytemuck::cast_slice_mut(take(&mut rest, count));
        let pressing = take(&mut rest, count);
        let [shift, r, p, q, met] = core::array::from_fn(|_| structs(take(&mut rest, 3 * count)));
        for ((row, weight), &number) in rows.iter_mut().zip(&mut *weight).zip(particles) {
            let found = bodies.row_of_start(number);
            let sound = |row: usize| bodies.position[row].is_finite() && bodies.velocity[row].is_finite();
            let found = found.filter(|&row| sound(row));
            *row = found.map_or(NOBODY, |row| row as u32);
            let inverse = found.map_or(0.0, |row| bodies.laden_inverse(row));
            *weight = if inverse > 0.0 && inverse < f32::INFINITY { inverse } else { 0.0 };
        }
        shift.fill(Vec3::ZERO);
        r.fill(Vec3::ZERO);
        met.fill(Vec3::ZERO);
        Self { rows, weight, shift, r, p, q, met, pressing, pressed: 0 }
    }

    /// The rows of some particles, if all are there.
    pub(super) fn living<const N: usize>(&self, corners: [u32; N]) -> Option<[usize; N]> {
        let rows = corners.map(|corner| self.rows.get(corner as usize).copied().unwrap_or(NOBODY) as usize);
        rows.iter().all(|&row| row != NOBODY as usize).then_some(rows)
    }

    /// A number for each, where what the system makes of directions no longer counts.
    pub(super) fn stamps(&mut self) -> &mut [u32] {
        let count = self.rows.len();
        &mut bytemuck::cast_slice_mut(self.q)[..count]
    }

    /// Counts how somebody has been moved as if walls had moved him: another step of Newton's method goes on from there.
    pub(super) fn needs_more(&mut self, number: usize) {
        let shift = self.shift[number];
        self.met[number] += if shift.is_finite() { shift } else { Vec3::ZERO };
        self.pressing[number] = 1;
    }

    /// Who is pressed by a wall.
    pub(super) fn pressing(&self) -> &[u32] {
        &self.pressing[..self.pressed]
    }

    /// The first direction, and r · z.
    fn begin(&mut self, levels: &mut Levels<'_>, walls: &mut [Wall], by_masses: bool) -> f32 {
        let left = self.precondition(levels, walls, by_masses);
        self.p.copy_from_slice(self.q);
        left
    }

    /// z ≈ A⁻¹ r, or W r, r being what is left beside what walls bear, and r · z.
    fn precondition(&mut self, levels: &mut Levels<'_>, walls: &mut [Wall], by_masses: bool) -> f32 {
        let pressing = &self.pressing[..self.pressed];
        walls::hold(walls, pressing, self.r);
        if !by_masses {
            levels.cycle(self.r, self.q);
            walls::filter(walls, pressing, self.q);
            return lanes::dot(self.r, self.q);
        }
        for ((z, &r), &weight) in self.q.iter_mut().zip(&*self.r).zip(&*self.weight) {
            *z = r * weight;
        }
        lanes::dot(self.r, self.q)
    }
}

/// A shell in a sub-step: (M + h² K) Δx = h² f, f being the forces where the method has moved all, along the directions that the sub-step
/// began with.
///
/// However early the search for it ends, no momentum comes of it: preconditioned by masses, its directions are sums of forces within the shell, and
/// of what a cycle through coarser graphs leaves each piece that nothing holds is rid.
pub(super) struct Solver<'m> {
    pub(super) params: &'m ShellParams,
    pub(super) step: Step,
    pub(super) triangles: &'m [[u32; 3]],
    pub(super) cells: &'m [Cell],
    pub(super) strains: &'m mut [Strain],
    pub(super) hinges: &'m [Hinge],
    pub(super) bends: &'m [RestFold],
    pub(super) folds: &'m mut [Fold],
    pub(super) vectors: Vectors<'m>,
    /// True if a matrix holds how it bends.
    pub(super) thin: bool,
    /// The scenery that particles are pressed by.
    pub(super) walls: &'m mut [Wall],
    /// How far the particles were moved in the sub-step before; none, where there are no graphs.
    pub(super) last: &'m mut [Vec3],
    /// Where it left the particles in the sub-step before, if it is damped \[m\].
    pub(super) left: &'m mut [Vec3],
}

impl Solver<'_> {
    /// Keeps where it leaves the particles.
    pub(super) fn leave(&mut self, bodies: &Bodies<'_>) {
        for (left, &row) in self.left.iter_mut().zip(&*self.vectors.rows) {
            *left = bodies.position.get(row as usize).copied().unwrap_or(Vec3::NAN);
        }
    }

    /// Does something with all particles that bear something and that it moves.
    pub(super) fn each_laden(&self, bodies: &mut Bodies<'_>, act: impl Fn(&mut Bodies<'_>, usize)) {
        let rows = if bodies.loads.is_empty() { &[] } else { &*self.vectors.rows };
        for (&row, _) in rows.iter().zip(&*self.vectors.weight).filter(|&(&row, &weight)| row != NOBODY && weight > 0.0)
        {
            act(bodies, row as usize);
        }
    }

    /// Bending stiffness × h².
    pub(super) fn bending(&self) -> f32 {
        self.params.bending * (self.step.h * self.step.h)
    }

    /// q = (M + h² K) p, zero where nothing moves.
    fn apply(&mut self, levels: &mut Levels<'_>) {
        let bending = self.bending() * self.step.rate;
        let bends_only = !levels.is_empty();
        if bends_only {
            levels.apply(self.vectors.p, self.vectors.q);
        }
        if !bends_only || (bending > 0.0 && !self.thin) {
            self.resist(bending, bends_only);
        }
        let Vectors { p, q, pressing, pressed, .. } = &mut self.vectors;
        walls::brake(self.walls, &pressing[..*pressed], p, q);
    }

    /// Adds what is not assembled: what bending does, or all.
    fn resist(&mut self, bending: f32, bends_only: bool) {
        let Self { params, ref step, triangles, cells, ref mut strains, hinges, bends, ref folds, .. } = *self;
        let Vectors { p, q, weight, .. } = &mut self.vectors;
        if !bends_only {
            for ((q, &p), &weight) in q.iter_mut().zip(&**p).zip(&**weight) {
                *q = if weight > 0.0 { p / weight } else { Vec3::ZERO };
            }
        }
        lanes::run(Resist { params, step, bending, bends_only, triangles, cells, strains, hinges, bends, folds, p, q });
        for (q, &weight) in q.iter_mut().zip(&**weight) {
            *q = if weight > 0.0 { *q } else { Vec3::ZERO };
        }
    }

    /// Moves particles to the walls that press them, so that forces are those of where these leave them: the strain of an edge that a wall turns far
    /// is not what the directions of the beginning tell.
    pub(super) fn meet(&mut self, bodies: &mut Bodies<'_>) {
        let Vectors { weight, r, met, pressing, pressed, .. } = &mut self.vectors;
        walls::meet(self.walls, &pressing[..*pressed], bodies, weight, r, met);
    }

    /// Counts what walls have moved as shifts, where all of them have let go: what is left alone keeps both momenta.
    fn part(&mut self, bodies: &mut Bodies<'_>) {
        let Vectors { rows, shift, met, .. } = &mut self.vectors;
        for ((&row, shift), met) in rows.iter().zip(&mut **shift).zip(&mut **met) {
            let met = core::mem::take(met);
            if met != Vec3::ZERO {
                bodies.shift(row as usize, -met);
                *shift += met;
            }
        }
    }

    /// Lists the walls that press.
    pub(super) fn list_walls(&mut self) {
        self.vectors.pressed = walls::list(self.walls, self.vectors.pressing);
    }

    /// Solves it, and that anew for as long as other walls press than before.
    pub(super) fn solve(&mut self, bodies: &mut Bodies<'_>, levels: &mut Levels<'_>, is_first: bool) {
        let mut enough = [0.0; 2];
        let mut roughly = self.walls.iter().any(Wall::is_near);
        for pass in 0..PASSES {
            let Vectors { shift, p, pressing, pressed, .. } = &mut self.vectors;
            if walls::impose(self.walls, &pressing[..*pressed], bodies, shift, p) {
                self.apply(levels);
                let Vectors { shift, r, p, q, .. } = &mut self.vectors;
                add_scaled(shift, 1.0, p);
                add_scaled(r, -1.0, q);
            }
            let energy = if pass == 0 && is_first { self.go_on(levels) } else { 0.0 };
            roughly &= pass < ROUGHLY;
            self.descend(levels, energy, &mut enough, roughly, bodies.report);
            if pass + 1 == PASSES {
                break;
            }
            let Vectors { shift, r, .. } = &mut self.vectors;
            if walls::judge(self.walls, bodies, shift, r) {
                self.list_walls();
                levels.press(self.walls, self.vectors.pressing());
            } else if !core::mem::take(&mut roughly) {
                break;
            }
        }
        if is_first && self.vectors.pressed == 0 && !self.last.is_empty() && self.needs_correction() {
            self.correct(bodies, levels, &mut enough);
        }
        for (last, &shift) in self.last.iter_mut().zip(&*self.vectors.shift) {
            // Which bits a NaN has depends on the machine, and these words are in the hash.
            *last = match (is_first, shift.is_finite()) {
                (true, true) => shift,
                (true, false) => Vec3::ZERO,
                (false, true) => *last + shift,
                (false, false) => *last,
            };
        }
        if self.vectors.pressed == 0 {
            self.part(bodies);
        }
        let Vectors { weight, shift, .. } = &mut self.vectors;
        walls::finish(self.walls, bodies, weight, shift);
    }

    /// Tells whether what strains have of second order is no little: where damping multiplies it, and where particles of a sheet that hangs are moved far
    /// against the size of its triangles, as in long sub-steps.
    fn needs_correction(&self) -> bool {
        let Vectors { rows, weight, shift, .. } = &self.vectors;
        let is_hung = || rows.iter().zip(&**weight).any(|(&row, &weight)| row != NOBODY && weight == 0.0);
        let is_far = || {
            let farthest = shift.iter().map(|&shift| dot(shift, shift)).fold(0.0, max);
            let area: f32 = self.cells.iter().map(|cell| cell.area).sum();
            farthest > FAR * FAR * (2.0 * area / self.cells.len().max(1) as f32)
        };
        self.step.lag > MANY * self.step.h || is_hung() && is_far()
    }

    /// A second step of Newton's method, if it is the shorter one: what strains have of second order in the first is no little where damping multiplies it.
    fn correct(&mut self, bodies: &mut Bodies<'_>, levels: &mut Levels<'_>, enough: &mut [f32; 2]) {
        self.ask_again(bodies);
        self.descend(levels, 0.0, enough, false, bodies.report);
        let (first, second) = (&*self.last, &mut *self.vectors.shift);
        let is_shorter = lanes::dot(second, second) < lanes::dot(first, first);
        for (shift, &first) in second.iter_mut().zip(first) {
            *shift = if is_shorter { first + *shift } else { first };
        }
    }

    /// Begins with as much of the last sub-step's shifts as is best in the norm of energy, and tells the energy of that.
    fn go_on(&mut self, levels: &mut Levels<'_>) -> f32 {
        if self.last.is_empty() || levels.is_empty() {
            return 0.0;
        }
        let Vectors { r, p, weight, pressing, pressed, .. } = &mut self.vectors;
        for ((p, &last), &weight) in p.iter_mut().zip(&*self.last).zip(&**weight) {
            *p = if weight > 0.0 && last.is_finite() { last } else { Vec3::ZERO };
        }
        walls::hold(self.walls, &pressing[..*pressed], r);
        walls::filter(self.walls, &pressing[..*pressed], p);
        self.apply(levels);
        let Vectors { shift, r, p, q, .. } = &mut self.vectors;
        let (along, curvature) = (lanes::dot(p, r), lanes::dot(p, q));
        let far = along / curvature;
        if !(curvature > 0.0 && far.abs() < f32::INFINITY) {
            return 0.0;
        }
        add_scaled(shift, far, p);
        add_scaled(r, -far, q);
        far * along
    }

    /// Conjugate gradients on from what has been found, by a cycle through coarser graphs where there are any, else by masses: to what is
    /// good enough of what they begin with, or have begun with before.
    fn descend(
        &mut self,
        levels: &mut Levels<'_>,
        energy: f32,
        enough: &mut [f32; 2],
        roughly: bool,
        report: &mut Report,
    ) {
        let mut by_masses = levels.is_empty();
        let mut first = self.vectors.begin(levels, self.walls, by_masses);
        let rubs = |&number: &u32| self.walls.get(number as usize).is_some_and(Wall::rubs);
        let mut residual = if self.vectors.pressing().iter().any(rubs) { ROUGH } else { RESIDUAL };
        residual[0] *= if self.vectors.rows.len() < FEW { CLOSER } else { 1.0 };
        let mut note = |first: f32, by_masses: bool| {
            let kind = usize::from(by_masses);
            let first = first + if by_masses { 0.0 } else { energy };
            enough[kind] = max(first * (residual[kind] * residual[kind]), enough[kind]);
            // Ten times the residual is a hundred times its energy.
            enough[kind] * if roughly { 100.0 } else { 1.0 }
        };
        let mut most = note(first, by_masses);
        let solved = |left: f32, most: f32| left >= 0.0 && left <= most;
        let (mut left, mut iterations) = (first, 0);
        while !solved(left, most) && iterations < ITERATIONS {
            self.apply(levels);
            let Vectors { shift, r, p, q, .. } = &mut self.vectors;
            let curvature = lanes::dot(p, q);
            let far = left / curvature;
            if !(curvature > 0.0 && far > 0.0 && far < f32::INFINITY) {
                if by_masses {
                    break;
                }
                // Rounding has made more of the coarser graphs than there is.
                by_masses = true;
                first = self.vectors.begin(levels, self.walls, by_masses);
                (left, most) = (first, note(first, by_masses));
                continue;
            }
            add_scaled(shift, far, p);
            add_scaled(r, -far, q);
            let before = left;
            left = self.vectors.precondition(levels, self.walls, by_masses);
            let Vectors { p, q, .. } = &mut self.vectors;
            let beta = left / before;
            for (p, &z) in p.iter_mut().zip(&**q) {
                *p = z + *p * beta;
            }
            iterations += 1;
        }
        let kind = usize::from(by_masses);
        let residual = if enough[kind] > 0.0 { sqrt(left / enough[kind]) * residual[kind] } else { 0.0 };
        report.effort.solved(iterations, residual, !solved(left, most));
    }
}
