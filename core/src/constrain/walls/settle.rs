//! Velocities of what walls have pressed.

use super::tell::tell;
use super::{NONE, Wall};
use crate::constrain::Bodies;
use crate::constrain::contacts::bounce;
use crate::math::aside;

/// Lets particles leave walls as fast as elasticity wants, and takes what friction can of their slip by all that has pressed.
pub(in crate::constrain) fn settle(walls: &mut [Wall], bodies: &mut Bodies<'_>) {
    for wall in walls.iter_mut().filter(|wall| wall.state != NONE) {
        let (row, normal) = (wall.row as usize, wall.normal);
        let meets = wall.touch.pressed() > 0.0 || wall.touches(bodies);
        wall.fresh = u32::from(meets);
        if !meets {
            continue;
        }
        let wanted = bounce(&bodies.substep, wall.touch.elasticity, wall.ends(bodies));
        let parting = (bodies.velocity[row] - wall.velocity).dot(normal);
        bodies.velocity[row] += normal * wall.touch.press(wanted, parting);
        if wall.tangent.acts(&wall.touch) {
            let slip = aside(bodies.velocity[row] - wall.velocity, normal);
            bodies.velocity[row] += wall.tangent.hold(&wall.touch, slip, wall.touch.pressed());
        }
    }
    report(walls, bodies);
}

/// Counts what walls have pressed, and tells whoever watches.
pub(in crate::constrain) fn report(walls: &[Wall], bodies: &mut Bodies<'_>) {
    let watched = bodies.is_watched();
    for wall in walls.iter().filter(|wall| wall.is_met()) {
        bodies.report.hits += 1;
        bodies.mark_touching(wall.row as usize);
        if watched {
            tell(wall, bodies);
        }
    }
}
