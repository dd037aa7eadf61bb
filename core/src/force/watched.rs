//! A sub-step that somebody watches, for forces to tell what has come to touch in it.

use super::State;
use crate::observe::{Impact, Observer, closing};
use glam::Vec3;

/// A sub-step that somebody watches, at its end: what forces are lent to tell of those who have come to touch in it.
#[allow(missing_debug_implementations)]
pub struct Watched<'a> {
    /// The particles as the sub-step began, in the rows that they have now; the newborn at their births. Who is near whom is to be asked of those at its end.
    /// Where balls meet by impulse, whoever met another is as his last way in it began.
    pub before: State<'a>,
    /// The particles at its end, when all have been held against colliders and each other.
    pub now: State<'a>,
    pub(crate) inverse_mass: &'a [f32],
    /// The number of sub-steps in the step.
    pub(crate) substeps: u32,
    /// The speed that forces give what rests in the step \[m/s\], once somebody has asked, and what works it out.
    pub(crate) rests: Option<f32>,
    pub(crate) work_out: &'a mut dyn FnMut(&State<'_>) -> f32,
    pub(crate) observer: &'a mut dyn Observer,
}

impl Watched<'_> {
    /// Tells that the particle in a row has come to touch another thing.
    pub fn tell(&mut self, touch: &Impact) {
        self.observer.touched(touch);
    }

    /// Tells that two particles have come to touch, of both unless one is fixed; `normal` points from the second to the first. Nobody is told if they came
    /// together no faster than what rests does in a step, or if one of them is still to be born.
    pub fn tell_pair(&mut self, [row, other]: [usize; 2], normal: Vec3) {
        let Self { before, now, substeps, .. } = *self;
        let ends = [before.velocity, now.velocity].map(|v: &[Vec3]| (v[row] - v[other]).dot(normal));
        let are_born = [row, other].iter().all(|&row| now.born[row] <= now.time);
        let Some(closing) = closing(ends, substeps).filter(|_| are_born) else { return };
        if !(closing > self.rests()) {
            return;
        }
        for ([row, other], normal) in [([row, other], normal), ([other, row], -normal)] {
            let Some(id) = now.id(row).filter(|_| self.inverse_mass[row] > 0.0) else { continue };
            let (other, mass, place) = (now.id(other), now.mass[row], now.position[row]);
            let (before, after, surface, time) = (before.velocity[row], now.velocity[row], Vec3::ZERO, now.time);
            self.tell(&Impact { id, row, other, mass, place, normal, closing, before, after, surface, time });
        }
    }

    /// The speed that forces from outside give what rests in a whole step \[m/s\]: by the mean acceleration of all, in which what two do to each other
    /// is nothing.
    pub fn rests(&mut self) -> f32 {
        *self.rests.get_or_insert_with(|| (self.work_out)(&self.now))
    }
}
