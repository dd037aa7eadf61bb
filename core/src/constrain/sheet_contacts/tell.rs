//! Telling whoever watches of what comes together.

use super::super::Bodies;
use super::contact::Contact;
use super::lists::Kept;
use crate::math::{dot, max, min};
use crate::observe::{Impact, closing};
use crate::particles::Id;
use glam::Vec3;

/// The share of the speed of a blow that a face has to have taken by itself to be told of where something else has stopped the particle as well.
const MOSTLY: f32 = 0.5;

/// Tells of what has pressed in the sub-step, and came together faster than what rests does in a step.
pub(super) fn tell(kept: &mut Kept<'_>, bodies: &mut Bodies<'_>) {
    if !bodies.is_watched() {
        return;
    }
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    for contact in kept.contacts[..contacts].iter().filter(|contact| contact.touch.pressed() > 0.0) {
        let along = |of: &[Vec3]| dot(contact.between(|i| of[kept.rows[i] as usize]), contact.normal);
        let ends = [along(bodies.before[1]), dot(contact.between(|i| kept.pushed[i]), contact.normal)];
        let Some(closing) = closing(ends, bodies.substep.count) else { continue };
        let [one, other] = most(contact);
        let id = |i: usize| bodies.id(kept.rows[i] as usize);
        let both = [(one, id(other), contact.normal), (other, id(one), -contact.normal)];
        for (i, other, normal) in both {
            met(kept, bodies, (i, other, normal), (closing, Vec3::ZERO));
        }
    }
    for surface in kept.surfaces[..surfaces].iter().filter(|surface| surface.touch.pressed() > 0.0) {
        let i = surface.particle as usize;
        let along = |v: Vec3| dot(v - surface.velocity, surface.normal);
        let row = kept.rows[i] as usize;
        let mut ends = [along(bodies.before[1][row]), along(kept.pushed[i])];
        let is_stopped = bodies.is_touching(row);
        if is_stopped {
            // A shell's wall, mostly, has stopped it before and told of that: a face is another if that has not slowed it toward this.
            ends = [max(ends[0], ends[1]), min(ends[0], ends[1])];
        }
        let is_own = |closing: &f32| !is_stopped || surface.touch.pressed() > MOSTLY * closing;
        if let Some(closing) = closing(ends, bodies.substep.count).filter(is_own) {
            met(kept, bodies, (i, None, surface.normal), (closing, surface.velocity));
        }
    }
}

/// The corner of each side that has the largest share in the place that touches.
fn most(contact: &Contact) -> [usize; 2] {
    let sides = [0..contact.split as usize, contact.split as usize..4];
    sides.map(|side| {
        let first = side.start;
        let most =
            side.fold(first, |most, i| if contact.weights[i].abs() > contact.weights[most].abs() { i } else { most });
        contact.corners[most] as usize
    })
}

/// Tells of a particle, unless it is fixed, that has met another, or a collider that moves there with a velocity.
fn met(
    kept: &Kept<'_>,
    bodies: &mut Bodies<'_>,
    (i, other, normal): (usize, Option<Id>, Vec3),
    (closing, surface): (f32, Vec3),
) {
    let row = kept.rows[i] as usize;
    let Some(id) = bodies.id(row).filter(|_| kept.weight[i] > 0.0) else { return };
    let (before, after) = (kept.pushed[i], bodies.velocity[row]);
    let (mass, place, time) = (bodies.mass[row], bodies.position[row], bodies.substep.during[1]);
    bodies.tell(&Impact { id, row, other, mass, place, normal, closing, before, after, surface, time });
}
