//! Ways of particles through a sub-step, past the scenery.

use super::{NOBODY, NONE, Wall};
use crate::constrain::Bodies;
use crate::math::{high, length, low};
use crate::shape::{Aabb, Segment};
use glam::Vec3;

/// Leaves out of the sweep at the sub-step's end whose ways do not pass through the scenery.
pub(in crate::constrain) fn follow(walls: &[Wall], bodies: &mut Bodies<'_>) {
    for wall in walls.iter().filter(|wall| wall.row != NOBODY) {
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
        let passes = hit.is_some_and(|hit| !far || hit.velocity != Vec3::ZERO);
        if !passes {
            bodies.mark_followed(row);
        }
    }
}
