//! The velocities that constraints take, for the forces of the next sub-step to know of.

use super::Moved;
use crate::math::{dot, sqrt};
use glam::Vec3;

impl Moved<'_> {
    /// Lets all begin the sub-step as much slower as constraints have stopped them in the one before, or the share of it that the method wants: constraints
    /// are met when it has moved everything, and forces that go by velocities or places were else those on whoever falls. What hangs in still air would be
    /// braked at half the speed that it gains in a sub-step, and weigh so much too little.
    pub(crate) fn lead(&mut self) {
        if !(self.lead > 0.0) {
            return;
        }
        let (share, [x, y, z]) = (self.lead, self.layout.lead(self.kept));
        let words = x.iter_mut().zip(y).zip(z);
        let ends = self.velocity.iter_mut().zip(&mut *self.start[1]);
        for ((v, before), ((x, y), z)) in ends.zip(words) {
            let by = Vec3::new(*x, *y, *z) * share;
            [*x, *y, *z] = v.to_array();
            *v += by;
            *before = *v;
        }
    }

    /// Takes that back when the method has moved everything, and keeps how fast they are by it alone.
    pub(crate) fn take_back_lead(&mut self, h: f32) {
        if !(self.lead > 0.0) {
            return;
        }
        let [x, y, z] = self.layout.lead(self.kept);
        let words = x.iter_mut().zip(y).zip(z);
        let ends = self.position.iter_mut().zip(&mut *self.velocity).zip(&mut *self.start[1]);
        for (((at, v), before), ((x, y), z)) in ends.zip(words) {
            let begun = Vec3::new(*x, *y, *z);
            let by = *before - begun;
            *before = begun;
            *v -= by;
            *at -= by * h;
            [*x, *y, *z] = v.to_array();
        }
    }

    /// Keeps what constraints have done to velocities, as far as it is no more than what the method has: blows are over.
    pub(crate) fn keep_lead(&mut self) {
        if !(self.lead > 0.0) {
            return;
        }
        let [x, y, z] = self.layout.lead(self.kept);
        let words = x.iter_mut().zip(y).zip(z);
        for ((&v, &before), ((x, y), z)) in self.velocity.iter().zip(&*self.start[1]).zip(words) {
            let moved = Vec3::new(*x, *y, *z);
            let (by, most) = (v - moved, moved - before);
            let (far, most) = (dot(by, by), dot(most, most));
            let share = if far <= most { 1.0 } else { sqrt(most / far) };
            let by = by * share;
            // Which bits a NaN has depends on the machine, and these words are in the hash.
            [*x, *y, *z] = if by.is_finite() { by.to_array() } else { [0.0; 3] };
        }
    }
}
