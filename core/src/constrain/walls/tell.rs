//! Whoever watches is told of particles that have come together with walls.

use super::Wall;
use crate::constrain::Bodies;
use crate::observe::{Impact, closing};
use glam::Vec3;

/// Tells of a particle that its wall has pressed, if both came together faster than what rests does in a step.
pub(super) fn tell(wall: &Wall, bodies: &mut Bodies<'_>) {
    let Wall { normal, pushed: before, velocity: surface, .. } = *wall;
    let row = wall.row as usize;
    let Some(closing) = closing(wall.ends(bodies), bodies.substep.count) else { return };
    let Some(id) = bodies.id(row) else { return };
    let (mass, place, after) = (bodies.mass[row], bodies.position[row], bodies.velocity[row]);
    let (other, time) = (None, bodies.substep.during[1]);
    bodies.tell(&Impact { id, row, other, mass, place, normal, closing, before, after, surface, time });
}

impl Wall {
    /// The speed at which its particle leaves it as the sub-step begins, and before the material answers \[m/s\].
    pub(super) fn ends(&self, bodies: &Bodies<'_>) -> [f32; 2] {
        [bodies.before[1][self.row as usize], self.pushed].map(|v: Vec3| (v - self.velocity).dot(self.normal))
    }
}
