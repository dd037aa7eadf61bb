//! The energy of a chain that goes through a sub-step in paces, beside what all of it moves.

use super::super::Bodies;
use super::links::Links;
use crate::constrain::turn::inverse;
use crate::index::between;
use crate::math::{max, sqrt};
use glam::{Mat3, Vec3};

impl Links<'_> {
    /// The velocity that all of it has: that of the first who is fixed, none by walls, else the mean by mass \[m/s\].
    fn drift(&self, bodies: &Bodies<'_>) -> Vec3 {
        self.middle(bodies, |particle, _| self.velocity[particle])
    }

    /// The value of the first who is fixed, or none by walls, else the mean by mass.
    fn middle(&self, bodies: &Bodies<'_>, of: impl Fn(usize, usize) -> Vec3) -> Vec3 {
        let fixed = self.chain.members().find(|&(particle, _)| !(self.weight[particle] > 0.0));
        match fixed {
            Some((particle, row)) => of(particle, row),
            // Walls take what all of it has.
            None if self.is_by_walls() => Vec3::ZERO,
            None => self.mean(bodies, of).unwrap_or(Vec3::ZERO),
        }
    }

    /// The mean by mass of all, and of what its ends are joined to; none if that is no number.
    pub(super) fn mean(&self, bodies: &Bodies<'_>, of: impl Fn(usize, usize) -> Vec3) -> Option<Vec3> {
        let (mut sum, mut mass, mut beside) = (Vec3::ZERO, 0.0, Mat3::ZERO);
        for (particle, row) in self.chain.members() {
            let of = of(particle, row);
            sum += of * bodies.mass[row];
            mass += bodies.mass[row];
            if let Some(held) = self.chain.held(particle) {
                sum += held.mass * of;
                beside += held.mass;
            }
        }
        if beside == Mat3::ZERO {
            return Some(sum / mass).filter(|mean| mean.is_finite());
        }
        inverse(beside + Mat3::from_diagonal(Vec3::splat(mass))).map(|inverse| inverse * sum)
    }

    /// The product of two velocities, or ways, by the mass of a particle and of what it is joined to.
    fn product(&self, bodies: &Bodies<'_>, (particle, row): (usize, usize), [one, other]: [Vec3; 2]) -> f32 {
        let own = one.dot(other) * bodies.mass[row];
        self.chain.held(particle).map_or(own, |held| own + one.dot(held.mass * other))
    }

    /// Twice the kinetic energy beside that, after so much more of what forces do in the sub-step \[J\].
    pub(super) fn vigour(&self, bodies: &Bodies<'_>, share: f32) -> f32 {
        let drift = self.drift(bodies);
        let moving = self.chain.members().filter(|&(particle, _)| self.weight[particle] > 0.0);
        let twice = moving.map(|(particle, row)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            let beside = self.velocity[particle] + gained * share - drift;
            self.product(bodies, (particle, row), [beside; 2])
        });
        twice.sum()
    }

    /// The work of forces on the way to where all are from where they were as the sub-step began, beside what all of it moves \[J\].
    pub(super) fn work(&self, bodies: &Bodies<'_>) -> f32 {
        let h = bodies.substep.seconds();
        let from = |row: usize| between(self.room.as_ref(), self.origin, bodies.before[0][row]);
        let way = |particle: usize, row: usize| self.place[particle] - from(row);
        let together = self.middle(bodies, way);
        let moving = self.chain.members().filter(|&(particle, _)| self.weight[particle] > 0.0);
        let work = moving.map(|(particle, row)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            self.product(bodies, (particle, row), [way(particle, row) - together, gained])
        });
        work.sum::<f32>() / h
    }

    /// Twice the energy that forces give in a sub-step to what rests \[J\].
    pub(super) fn fallen(&self, bodies: &Bodies<'_>) -> f32 {
        let twice = self.chain.members().map(|(particle, row)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            self.product(bodies, (particle, row), [gained; 2])
        });
        twice.sum()
    }

    /// The work of those who are fixed on the links that hold them in the pace that has been solved, beside what all of it moves \[J\].
    pub(super) fn hauled(&self, bodies: &Bodies<'_>) -> f32 {
        let drift = self.drift(bodies);
        let held = (0..self.weight.len()).filter(|&particle| !(self.weight[particle] > 0.0));
        held.map(|particle| self.pulled(particle).dot(drift - self.velocity[particle])).sum()
    }

    /// Slows all down so that twice their kinetic energy is no more than `most`, where it is `now` \[J\].
    pub(super) fn calm(&mut self, bodies: &Bodies<'_>, now: f32, most: f32) {
        let drift = self.drift(bodies);
        if now > most {
            let share = sqrt(max(most, 0.0) / now);
            self.velocity.iter_mut().for_each(|velocity| *velocity = drift + (*velocity - drift) * share);
        }
    }
}
