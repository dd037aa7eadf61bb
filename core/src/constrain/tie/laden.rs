//! Ties that lay what they join on each other, where a constraint bears it: a shell that is solved for all of its particles at once feels what hangs from them.

use super::super::Bodies;
use super::super::bodies::Change;
use super::grip::Grip;
use super::place::weights;
use super::{EVEN, NEARLY, Tie};
use crate::math::{largest, length, max};
use glam::Vec3;

/// The words that it keeps through a step: how heavy the particle is for what bears that \[kg\], and how heavy the body is for what bears the particle.
pub(super) const STEP: usize = 2;

/// The weight of something that nothing moves, where it is tied between several of a body's particles, in weights of these.
const HEAVY: f32 = 1e3;

impl<T: AsRef<[u32]>, W: AsRef<[f32]>> Tie<T, W> {
    /// Says that it holds the particle and the body.
    pub(super) fn hold_both(&self, bodies: &mut Bodies<'_>) {
        for number in [Some(&self.particle), self.to.as_ref().first()].into_iter().flatten() {
            if let Some(row) = bodies.row_of_start(*number) {
                bodies.hold(row);
            }
        }
    }

    /// Brings both together as a sub-step begins, and lays each on the other if that bears it.
    pub(super) fn lay_on_both(&self, bodies: &mut Bodies<'_>, place: &[u32], step: &mut [u32]) {
        let masses = if self.compliance == 0.0 { self.weigh(bodies, place) } else { None };
        let masses = masses.unwrap_or([0.0; STEP]);
        step.iter_mut().zip(masses).for_each(|(word, mass)| *word = mass.to_bits());
        let [own, held] = masses;
        for number in 0..self.to.as_ref().len() {
            if let Some((row, part)) = self.part(bodies, place, (number, own)) {
                bodies.lay_on(row, part, self.beside(bodies, row));
            }
        }
        // A body's place is where the particle is.
        if let Some(row) = bodies.row_of_start(self.particle) {
            bodies.lay_on(row, held, Vec3::ZERO);
        }
    }

    /// The way from another particle to the tied one, as the sub-step began by their velocities.
    fn beside(&self, bodies: &Bodies<'_>, row: usize) -> Vec3 {
        let h = bodies.substep.seconds();
        let way = |tied: usize| bodies.between(row, tied) - (bodies.velocity[tied] - bodies.velocity[row]) * h;
        bodies.row_of_start(self.particle).map_or(Vec3::ZERO, way)
    }

    /// How heavy each is for the other, where they are brought together; zero, if the other does not bear it.
    fn weigh(&self, bodies: &mut Bodies<'_>, place: &[u32]) -> Option<[f32; STEP]> {
        let tied = bodies.row_of_start(self.particle)?;
        let is_borne = |number: &u32| bodies.row_of_start(*number).is_some_and(|row| bodies.is_borne(row));
        let [on_body, on_tied] = [self.to.as_ref().iter().any(is_borne), bodies.is_borne(tied)];
        let h = bodies.substep.seconds();
        // Of two that are solved for apart, with many others each, neither knows what those about the other resist: laid on each other they would drive
        // each other.
        let is_joined = |number: &u32| bodies.row_of_start(*number).is_some_and(|row| bodies.is_joined(row));
        let are_apart = bodies.is_joined(tied) && self.to.as_ref().iter().any(is_joined);
        if !(h > 0.0 && (on_body || on_tied)) || are_apart {
            return None;
        }
        self.close(bodies, place)?;
        let (rows, grip) = self.grip(bodies, place, h)?;
        let part = |mass: f32, row: usize| mass / bodies.holders(row) as f32;
        let own = if on_body { part(1.0 / grip.own, rows[0]) } else { 0.0 };
        let held = if on_tied { part(self.whole(grip).least_mass(), rows[1]) } else { 0.0 };
        Some([own, held])
    }

    /// The body as a rigid one, if it has more than three particles.
    fn whole(&self, grip: Grip) -> Grip {
        if self.to.as_ref().len() > 3 { grip.as_one() } else { grip }
    }

    /// The row of one of the body's particles that bears the tied one, which is so heavy, with what it bears of that: as much as a place between several is moved by
    /// what is at each.
    fn part(&self, bodies: &Bodies<'_>, place: &[u32], (number, own): (usize, f32)) -> Option<(usize, f32)> {
        let row = bodies.row_of_start(*self.to.as_ref().get(number)?)?;
        let weight = f32::from_bits(weights(place).nth(number)?);
        // What nothing moves holds a particle that it is at. A triangle may turn about it, which it has to feel.
        let heavy = if own == f32::INFINITY && weight < 1.0 - EVEN { HEAVY * bodies.mass[row] } else { own };
        let bears = weight > 0.0 && own > 0.0 && bodies.is_borne(row);
        bears.then_some((row, heavy * (weight * weight)))
    }

    /// Brings both together again, if one is laid on the other and has been moved away by another tie since; tells whether that is so.
    pub(super) fn close_again(&self, bodies: &mut Bodies<'_>, place: &[u32], step: &[u32]) -> Option<bool> {
        let is_laid = step.iter().any(|&mass| f32::from_bits(mass) > 0.0);
        let (rows, grip) = self.grip(bodies, place, bodies.substep.seconds()).filter(|_| is_laid)?;
        let size = max(grip.size(), f32::EPSILON * largest(bodies.position[rows[0]]) / NEARLY);
        let is_open = length(self.open(bodies, place, rows)?) > NEARLY * size;
        is_open.then(|| self.close(bodies, place));
        Some(is_open)
    }

    /// Moves what is laid on something held to where its velocity leads.
    fn catch_up(&self, bodies: &mut Bodies<'_>, place: &[u32], (tied, [own, held]): (usize, [f32; STEP])) {
        let is_held = |bodies: &Bodies<'_>, number: usize| {
            let part = self.part(bodies, place, (number, own));
            part.is_some_and(|(row, _)| bodies.is_caught_up(row))
        };
        if (0..self.to.as_ref().len()).any(|number| is_held(bodies, number)) {
            bodies.catch_up(tied);
        }
        if held > 0.0 && bodies.is_caught_up(tied) {
            for &number in self.to.as_ref() {
                if let Some(row) = bodies.row_of_start(number) {
                    bodies.catch_up(row);
                }
            }
        }
    }

    /// Gives each the impulse that what bears it has moved it by, and made it faster.
    pub(super) fn follow(&self, bodies: &mut Bodies<'_>, place: &[u32], step: &[u32]) -> Option<()> {
        let (&[own, held], h) = (step.first_chunk()?, bodies.substep.seconds());
        let [own, held] = [own, held].map(f32::from_bits);
        let tied = bodies.row_of_start(self.particle)?;
        self.catch_up(bodies, place, (tied, [own, held]));
        let mut pull = [Vec3::ZERO; 2];
        for number in 0..self.to.as_ref().len() {
            let part = self.part(bodies, place, (number, own)).filter(|&(_, part)| part < f32::INFINITY);
            let Some((row, part)) = part else { continue };
            let [way, faster] = bodies.borne(row);
            pull = [pull[0] + way * part, pull[1] + (faster - way / h) * part];
        }
        let [way, faster] = bodies.borne(tied);
        if held > 0.0 && held < f32::INFINITY && way != Vec3::ZERO {
            let grip = self.whole(self.grip(bodies, place, h)?.1);
            for (what, by) in [(Change::Place, way), (Change::Velocity, faster - way / h)] {
                self.push(bodies, place, &grip, by * held, |bodies, row, by| bodies.change(what, row, by));
            }
        }
        if pull[0] != Vec3::ZERO {
            bodies.change(Change::Place, tied, pull[0] * bodies.inverse_mass[tied]);
            bodies.change(Change::Velocity, tied, pull[1] * bodies.inverse_mass[tied]);
        }
        Some(())
    }
}
