//! What becomes of a chain that does not come near its lengths in any number of paces.

use super::super::Bodies;
use super::links::Links;
use super::solver::Way;
use crate::index::between;
use crate::math::max;
use glam::Vec3;

impl Links<'_> {
    /// Goes straight to where lengths are met next to where the method has moved all, by the directions that links have there. Gives a rope that has not
    /// come near its lengths the form back that it had when the sub-step began, if that was nearer. No energy comes of it.
    pub(super) fn jump(&mut self, bodies: &mut Bodies<'_>) {
        let h = bodies.substep.seconds();
        self.take_up(bodies, h);
        self.forget_walls();
        let before = self.vigour(bodies, 0.0);
        if !self.meet(h, Way::Now) {
            bodies.report.effort.capped += 1;
            let off = self.worst();
            self.keep_form(bodies);
            if !(self.worst() < off) {
                self.take_up(bodies, h);
                let _ = self.meet(h, Way::Now);
            }
        }
        if self.chain.tether {
            self.let_go(h);
        }
        self.note_walls();
        self.hand_back(bodies, h);
        self.calm(bodies, self.vigour(bodies, 0.0), before);
        self.hand_back(bodies, 0.0);
    }

    /// How far the worst link is off, as a share of its length.
    fn worst(&self) -> f32 {
        let off = |link| {
            let line = self.line(link)?;
            let off = (line.distance - line.rest) / (line.distance + line.rest);
            Some(if self.chain.tether { off } else { off.abs() })
        };
        (0..self.count).filter_map(off).fold(0.0, max)
    }

    /// Takes all to where they were as the sub-step began, in the middle of all of their masses if nobody is fixed: that keeps their momentum.
    pub(super) fn keep_form(&mut self, bodies: &Bodies<'_>) {
        let h = bodies.substep.seconds();
        let room = bodies.near.room();
        let way = |row: usize| between(room, bodies.before[0][row], bodies.position[row]);
        let moves = |particle, row| self.chain.weight(bodies, particle, row) > 0.0;
        let mean = if self.chain.is_free(bodies) { self.mean(bodies, |_, row| way(row)) } else { None };
        // One that is no number keeps nobody else from being one.
        let together = mean.unwrap_or(Vec3::ZERO);
        for (particle, row) in self.chain.members().filter(|&(particle, row)| moves(particle, row)) {
            self.velocity[particle] = bodies.velocity[row] + (together - way(row)) * (1.0 / h);
        }
        // Nothing pulls that could be taken back.
        self.pull.fill(0.0);
    }
}
