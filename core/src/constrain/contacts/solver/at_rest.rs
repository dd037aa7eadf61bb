//! The last sweep over velocities of a step, from the ground up, so that what rests shows hardly any speed.

use super::super::lists::{Face, Pair};
use super::{Pass, SUPPORT};
use crate::math::min;

impl Pass<'_> {
    /// Takes from the upper of two that rest on each other what it still comes down with, as far as it is above the lower: from the ground up, what is below
    /// has come to rest already. To share that out would take the more sweeps, the heavier the upper is. What the lower has not been given of it
    /// weighs on it all the same.
    pub(super) fn rest_on_other(&mut self, pair: &mut Pair) {
        let ([a, b], normal) = self.ends(pair);
        let parting = (self.velocity[a] - self.velocity[b]).dot(normal);
        if pair.lean == 0.0 || !(parting < 0.0) {
            return;
        }
        let (upper, lower, up) = if pair.lean > 0.0 { (a, b, normal) } else { (b, a, -normal) };
        let (fa, fb) = self.weights(pair);
        let (own, other) = if pair.lean > 0.0 { (fa, fb) } else { (fb, fa) };
        let above = min(pair.lean.abs() * (1.0 / SUPPORT), 1.0);
        let given = self.inverse_mass[lower] * (1.0 - above);
        // What nothing moves may lie on another.
        if !(own > 0.0) {
            return;
        }
        let [raised, lowered] = [own, given].map(|share| -parting * share / (own + given));
        self.velocity[upper] += up * raised;
        self.velocity[lower] -= up * lowered;
        let pressed = raised * (own + other) / own;
        pair.touch.give(pressed);
        self.borne[upper] += up * raised;
        self.owed[lower] -= up * (pressed * other / (own + other) - lowered);
    }

    /// The same of one that rests on a face, where others have pressed it.
    pub(super) fn rest_on_face(&mut self, face: &mut Face) {
        let row = face.row as usize;
        let parting = (self.velocity[row] - face.velocity).dot(face.normal);
        let change = face.normal * face.touch.part(face.given, parting);
        self.velocity[row] += change;
        self.borne[row] += change;
    }
}
