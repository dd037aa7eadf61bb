//! The energy of strain of a piece of a shell.

use super::ShellParams;
use super::eights::{WIDE, at_rest, gathered};
use super::fold::{Fold, RestFold, curve};
use super::linear::{deform, green, stress};
use super::membrane::{Cell, Strain};
use super::pieces::Piece;
use super::solver::NOBODY;
use super::step::Step;
use crate::cloth::Hinge;
use crate::lanes::{self, Eight, Kernel, LANES};
use glam::Vec3;

/// The triangles and folds that a piece is strained by.
pub(super) struct Stored<'s> {
    pub(super) params: &'s ShellParams,
    pub(super) triangles: &'s [[u32; 3]],
    pub(super) cells: &'s [Cell],
    pub(super) strains: &'s mut [Strain],
    pub(super) hinges: &'s [Hinge],
    pub(super) bends: &'s [RestFold],
    pub(super) rows: &'s [u32],
    pub(super) piece: Piece<'s>,
}

impl Stored<'_> {
    /// The energy of strain where all are in these places \[J\].
    pub(super) fn within(&mut self, places: &[Vec3]) -> f32 {
        let stretched = self.stretched(places);
        if !(self.params.bending > 0.0) {
            return stretched;
        }
        let mut sums = [0.0; LANES];
        self.curve(places);
        for (number, triangle) in self.piece.triangles.iter().map(|&triangle| triangle as usize).enumerate() {
            let ([a, b, c], area) = (self.strains[triangle].curvature, self.cells[triangle].area);
            sums[number % LANES] += 0.5 * self.params.bending * area * (a * a + b * b + c * c);
        }
        stretched + sums.iter().sum::<f32>()
    }

    /// The part of it that is in the plane of triangles \[J\].
    pub(super) fn stretched(&self, places: &[Vec3]) -> f32 {
        let [energy] = self.stretched_at([places]);
        energy
    }

    /// The same for all in several places, in one pass over the triangles.
    pub(super) fn stretched_at<const N: usize>(&self, places: [&[Vec3]; N]) -> [f32; N] {
        lanes::run(Stretched { stored: self, places })
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

/// The energies that triangles are stretched and sheared by in several places, eight triangles side by side.
struct Stretched<'a, 's, const N: usize> {
    stored: &'a Stored<'s>,
    places: [&'a [Vec3]; N],
}

impl<const N: usize> Kernel for Stretched<'_, '_, N> {
    type Output = [f32; N];

    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> [f32; N] {
        let mut sums = [[0.0; LANES]; N];
        for triangles in self.stored.piece.triangles.chunks(LANES) {
            let eight = if WIDE { self.eight(like, triangles) } else { None };
            if let Some(energies) = eight {
                for (sums, energies) in sums.iter_mut().zip(energies) {
                    *sums = (like.of(*sums) + energies).to_array();
                }
            } else {
                for (sums, places) in sums.iter_mut().zip(self.places) {
                    for (sum, &triangle) in sums.iter_mut().zip(triangles) {
                        *sum += self.one(places, triangle as usize);
                    }
                }
            }
        }
        sums.map(|sums| sums.iter().sum())
    }
}

impl<const N: usize> Stretched<'_, '_, N> {
    /// The energy of one in such places, if its corners are there.
    fn one(&self, places: &[Vec3], triangle: usize) -> f32 {
        let Stored { params, triangles, cells, rows, .. } = self.stored;
        let found = at(places, rows, triangles[triangle]);
        found.map_or(0.0, |[a, b, c]| cells[triangle].energy(params, [b - a, c - a]))
    }

    /// The energies of eight by the operations of one; none, if there are fewer or one of their corners is not there.
    #[inline(always)]
    fn eight<F: Eight>(&self, like: F, numbers: &[u32]) -> Option<[F; N]> {
        let Stored { params, triangles, cells, rows, .. } = self.stored;
        let numbers: &[u32; LANES] = numbers.try_into().ok()?;
        let (mut corners, mut at) = ([[NOBODY; 3]; LANES], [Cell::NONE; LANES]);
        for ((corners, at), &number) in corners.iter_mut().zip(&mut at).zip(numbers) {
            let [a, b, c] = *triangles.get(number as usize)?;
            *corners = [*rows.get(a as usize)?, *rows.get(b as usize)?, *rows.get(c as usize)?];
            *at = *cells.get(number as usize)?;
        }
        let ((inverse, area), mut energies) = (at_rest(like, &at), [like.all(0.0); N]);
        for (energy, places) in energies.iter_mut().zip(self.places) {
            let [a, b, c] = gathered(like, places, &corners)?;
            let strain = green(like, deform(inverse, [a, b - a, c - a]));
            let [warp, weft, shear] = stress(params, area, strain);
            *energy = like.all(0.5) * (warp * strain[0] + weft * strain[1] + shear * strain[2]);
        }
        Some(energies)
    }
}

/// The places of some corners, if all are there.
fn at<const N: usize>(places: &[Vec3], rows: &[u32], corners: [u32; N]) -> Option<[Vec3; N]> {
    let found = corners.map(|corner| rows.get(corner as usize).and_then(|&row| places.get(row as usize)));
    found.iter().all(Option::is_some).then(|| found.map(|place| place.copied().unwrap_or_default()))
}
