//! How particles that nothing holds move as a whole, and what rounding takes of that.

use super::Bodies;
use super::turn::{outer, solve_thin};
use crate::math::{dot, largest, length};
use glam::{Mat3, Vec3};

/// Words that a debt is kept in.
pub(super) const WORDS: usize = 3;
/// How many times what rounding of each place and velocity makes of an angular momentum may be lost by rounding.
const ROUNDINGS: f32 = 8.0;

/// The motion of some particles as a whole.
#[derive(Clone, Copy)]
pub(super) struct Whole {
    /// The row from which places are told, and where the middle of all masses is from there \[m\].
    first: usize,
    middle: Vec3,
    /// The velocity of the middle \[m/s\].
    pub(super) drift: Vec3,
    /// The angular momentum about the middle \[kg m²/s\], how much of it may be rounding, and the sum of m r rᵀ \[kg m²\].
    pub(super) spin: Vec3,
    rounding: f32,
    spread: Mat3,
}

impl Whole {
    /// Of those in some rows, of whom there is one at least, told along the shortest way through the sides of a room.
    pub(super) fn of(bodies: &Bodies<'_>, rows: impl Iterator<Item = usize> + Clone) -> Option<Self> {
        let first = rows.clone().next()?;
        let (mut mass, mut middle, mut drift) = (0.0, Vec3::ZERO, Vec3::ZERO);
        for row in rows.clone() {
            mass += bodies.mass[row];
            middle += bodies.between(first, row) * bodies.mass[row];
            drift += (bodies.velocity[row] - bodies.velocity[first]) * bodies.mass[row];
        }
        let (middle, drift) = (middle / mass, bodies.velocity[first] + drift / mass);
        let (mut spin, mut spread, mut coarse) = (Vec3::ZERO, Mat3::ZERO, 0.0);
        for row in rows {
            let (arm, v) = (bodies.between(first, row) - middle, bodies.velocity[row]);
            spin += arm.cross(v - drift) * bodies.mass[row];
            spread += outer(arm * bodies.mass[row], arm);
            coarse += bodies.mass[row] * (largest(bodies.position[row]) * length(v - drift) + length(arm) * largest(v));
        }
        Some(Self { first, middle, drift, spin, rounding: ROUNDINGS * f32::EPSILON * coarse, spread })
    }

    /// How all of it would turn as a rigid body \[rad/s\].
    pub(super) fn omega(&self) -> Vec3 {
        solve_thin(self.spread, self.spin)
    }

    /// Where somebody is from the middle \[m\].
    pub(super) fn arm(&self, bodies: &Bodies<'_>, row: usize) -> Vec3 {
        bodies.between(self.first, row) - self.middle
    }
}

/// The angular momentum that rounding has taken and that velocities have been too coarse to give back.
pub(super) struct Owed<'m>(pub(super) &'m mut [u32]);

impl Owed<'_> {
    fn all(&self) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.0.get(axis).copied().map_or(0.0, f32::from_bits));
        Vec3::new(x, y, z)
    }

    fn keep(&mut self, all: Vec3) {
        // Which bits a NaN has depends on the machine, and these words are in the hash.
        let all = if all.is_finite() { all } else { Vec3::ZERO };
        self.0.iter_mut().zip(all.to_array()).for_each(|(word, part)| *word = part.to_bits());
    }

    /// Forgets it: something holds what it is of.
    pub(super) fn forget(&mut self) {
        self.0.fill(0);
    }

    /// Gives back to those in some rows what they lack of the angular momentum that they had before something kept it but for rounding, by turning as
    /// a whole. What is more than rounding is gone.
    pub(super) fn give_back(
        &mut self,
        bodies: &mut Bodies<'_>,
        rows: impl Iterator<Item = usize> + Clone,
        before: Option<Whole>,
    ) {
        let (Some(before), Some(now)) = (before, Whole::of(bodies, rows.clone())) else { return self.forget() };
        let spin = before.spin + self.all();
        let (lack, most) = (spin - now.spin, now.rounding + before.rounding);
        if !(dot(lack, lack) <= most * most) {
            return self.forget();
        }
        let omega = solve_thin(now.spread, lack);
        for row in rows.clone() {
            let by = omega.cross(now.arm(bodies, row));
            if by.is_finite() {
                bodies.velocity[row] += by;
            }
        }
        self.keep(Whole::of(bodies, rows).map_or(Vec3::ZERO, |after| spin - after.spin));
    }
}
