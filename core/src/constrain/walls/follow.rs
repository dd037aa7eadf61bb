//! Ways of particles through a sub-step, past the scenery.

use super::{NOBODY, NONE, Wall};
use crate::constrain::Bodies;
use crate::math::{high, length, low};
use crate::shape::{Aabb, Segment};
use glam::Vec3;

/// Notes whose ways through the sub-step may pass through the scenery, and leaves all others out of the sweep at the step's end: that goes straight
/// from the step's beginning, through what they have gone around.
pub(in crate::constrain) fn follow(walls: &mut [Wall], bodies: &mut Bodies<'_>) {
    for wall in walls.iter_mut().filter(|wall| wall.row != NOBODY && wall.lost == 0) {
        let row = wall.row as usize;
        // Whoever is kept off by another constraint is followed by that.
        if bodies.clearance(row) > 0.0 {
            continue;
        }
        let (from, to, radius) = (bodies.before[0][row], bodies.position[row], bodies.radius[row]);
        let far = wall.state != NONE && length(to - from) < wall.free - radius;
        let around = Aabb { min: low(from, to) - radius, max: high(from, to) + radius };
        // What touches sinks in by its radius at the most.
        let way = Segment { from, to, radius: 0.5 * radius, during: bodies.substep.during };
        let hit = if bodies.colliders.may_touch(&around) { bodies.colliders.first_hit(&way) } else { None };
        // What moves may come from farther off than has been searched; what stands still and is far can only be met by rounding.
        if hit.is_some_and(|hit| !far || hit.velocity != Vec3::ZERO) {
            wall.lost = 1;
        } else if bodies.substep.is_last() {
            bodies.mark_followed(row);
        }
    }
}
