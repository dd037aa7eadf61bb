//! Bounces by position within a sub-step, one after the other, each of which may lead to others.

use super::super::lists::{Face, Pair};
use super::Pass;
use crate::collide::RESTING;
use crate::math::{aside, max, min, sqrt};
use glam::Vec3;

/// How often at most a bounce may lead to others in a sub-step, and how often they go from above on at first. Then every other round begins below, so that a row is
/// gone through in one, whichever way it is numbered.
const BOUNCES: u32 = 64;
const FROM_ABOVE: u32 = 48;
/// The share of its weight that a pair keeps at least that something bears: else the light one gives way all the same, as a heavy one would be
/// raised by more than it can pay for.
const LEAST: f32 = 0.1;
/// The share of the hardest bounce below which none leads to others.
const FAINT: f32 = 0.01;

impl Pass<'_> {
    /// The ways along which the first of two gives way to the other, and that against which the other does: along what bears it, which gives way to nobody.
    /// A particle that stands on one that is borne is borne as well.
    #[inline(never)]
    pub(super) fn ways(&mut self, a: usize, b: usize, normal: Vec3) -> [Vec3; 2] {
        let sides = [(a, normal), (b, -normal)];
        let borne = sides.map(|(row, way)| max(-self.borne[row].dot(way), 0.0));
        let ways = [0, 1].map(|i| if borne[i] > 0.0 { aside(normal, self.borne[sides[i].0]) } else { normal });
        for ((row, way), by) in sides.into_iter().zip([borne[1], borne[0]]) {
            if self.borne[row].dot(self.up) < by * way.dot(self.up) {
                self.borne[row] = way * by;
            }
        }
        let weight = |i: usize| ways[i].dot(normal) * self.inverse_mass[sides[i].0];
        let whole = self.inverse_mass[a] + self.inverse_mass[b];
        if weight(0) + weight(1) > LEAST * whole { ways } else { [normal; 2] }
    }

    /// Lets what bounces have thrown against others bounce on these, until nothing does any more or often enough; tells whether something still does.
    pub(super) fn bounce_on(&mut self, pairs: &mut [Pair], faces: &mut [Face]) -> bool {
        self.least = max(self.calm, FAINT * *self.hardest);
        while *self.hardest > 0.0 && self.round <= BOUNCES {
            (*self.hardest, self.round) = (0.0, self.round + 1);
            for face in faces.iter_mut().filter(|face| face.touch.is_on()) {
                if self.is_thrown(face.row) {
                    self.bounce_face(face, 0.0);
                }
            }
            let is_from_above = self.round <= FROM_ABOVE || self.round.is_multiple_of(2);
            for i in 0..pairs.len() {
                let pair = &mut pairs[if is_from_above { pairs.len() - 1 - i } else { i }];
                if pair.touch.is_on() && pair.rows.iter().any(|&row| self.is_thrown(row)) {
                    let (_, normal) = self.ends(pair);
                    self.bounce_pair(pair, normal, 0.0);
                }
            }
        }
        *self.hardest > 0.0
    }

    /// Tells whether a particle has been thrown in this round of bounces or in the one before.
    #[inline(always)]
    fn is_thrown(&self, row: u32) -> bool {
        self.rounds[row as usize] + 1 >= self.round
    }

    /// Lets two bounce on whose way forces have done `work`.
    #[inline(always)]
    pub(super) fn bounce_pair(&mut self, pair: &mut Pair, normal: Vec3, work: f32) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let along = |v: &[Vec3]| (v[a] - v[b]).dot(normal);
        let [thrown, given] = self.bounce(pair.touch.elasticity, work, &along);
        if thrown == 0.0 {
            return;
        }
        (self.rounds[a], self.rounds[b]) = (self.round, self.round);
        let (wa, wb) = (self.inverse_mass[a], self.inverse_mass[b]);
        let share = normal * (1.0 / (wa + wb));
        self.thrown[a] += share * (thrown * wa);
        self.thrown[b] -= share * (thrown * wb);
        self.velocity[a] += share * (given * wa);
        self.velocity[b] -= share * (given * wb);
        pair.touch.give(given);
        pair.given += given;
    }

    /// The same against a face.
    #[inline(always)]
    pub(super) fn bounce_face(&mut self, face: &mut Face, work: f32) {
        let (row, normal) = (face.row as usize, face.normal);
        let along = |v: &[Vec3]| (v[row] - face.velocity).dot(normal);
        let [thrown, given] = self.bounce(face.touch.elasticity, work, &along);
        if thrown == 0.0 {
            return;
        }
        self.rounds[row] = self.round;
        self.thrown[row] += normal * thrown;
        self.velocity[row] += normal * given;
        face.touch.give(given);
        face.given += given;
    }

    /// By how much the speed changes at which two part that come together: for bounces alone, and with all else that has been given.
    ///
    /// They bounce by the elasticity's share of their approach as they touched, without what forces have added since: their `work` by the mass that counts,
    /// times the sub-step \[m²/s\]. It is no bounce if it would be over within a part of the step; those that come faster than by what
    /// drives them stop each other then, which others have to know. What others have taken of the approach meanwhile is not given back.
    #[inline(always)]
    fn bounce(&mut self, elasticity: f32, work: f32, along: &impl Fn(&[Vec3]) -> f32) -> [f32; 2] {
        let parting = along(self.thrown);
        if !(parting < 0.0) {
            return [0.0; 2];
        }
        if elasticity > 0.0 {
            let bounce = sqrt(max(parting * parting - 2.0 * self.rate * work, 0.0)) * elasticity;
            let pressing = (along(self.v0) - along(self.pushed)) * self.rate;
            if bounce > 0.0 && 2.0 * bounce >= RESTING * max(self.long * pressing, self.least) {
                let now = along(self.velocity);
                *self.hardest = max(*self.hardest, bounce);
                return [bounce - parting, max(min(bounce, -now * elasticity) - now, 0.0)];
            }
        }
        [if -parting > self.calm { -parting } else { 0.0 }, 0.0]
    }
}
