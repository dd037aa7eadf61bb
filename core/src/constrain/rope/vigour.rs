//! The energy of a chain that goes through a sub-step in paces, beside what all of it moves.

use super::super::Bodies;
use super::links::Links;
use crate::index::between;
use crate::math::{max, sqrt};
use glam::Vec3;

impl Links<'_> {
    /// The velocity that all of it has: that of the first who is fixed, else the mean by mass \[m/s\].
    fn drift(&self, bodies: &Bodies<'_>) -> Vec3 {
        self.middle(bodies, |particle, _| self.velocity[particle])
    }

    /// What the first who is fixed has, else the mean by mass.
    fn middle(&self, bodies: &Bodies<'_>, of: impl Fn(usize, usize) -> Vec3) -> Vec3 {
        let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
        for (particle, row) in self.chain.members() {
            if !(self.weight[particle] > 0.0) {
                return of(particle, row);
            }
            sum += of(particle, row) * bodies.mass[row];
            mass += bodies.mass[row];
        }
        if mass > 0.0 { sum / mass } else { Vec3::ZERO }
    }

    /// Twice the kinetic energy beside that, after so much more of what forces do in the sub-step \[J\].
    pub(super) fn vigour(&self, bodies: &Bodies<'_>, share: f32) -> f32 {
        let drift = self.drift(bodies);
        let moving = self.chain.members().filter(|&(particle, _)| self.weight[particle] > 0.0);
        let twice = moving.map(|(particle, row)| {
            let gained = bodies.velocity[row] - bodies.before[1][row];
            (self.velocity[particle] + gained * share - drift).length_squared() * bodies.mass[row]
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
            (way(particle, row) - together).dot(gained) * (bodies.mass[row] / h)
        });
        work.sum()
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
