//! Reports of contacts by position: the numbers of them, and each meeting for whoever watches.

use super::super::lists::Kept;
use crate::constrain::Bodies;
use crate::math::{length, unit};
use crate::observe::Impact;
use crate::particles::Id;
use glam::Vec3;

/// Counts what touches, and tells whoever watches of what came together.
pub(super) fn report(bodies: &mut Bodies<'_>, kept: &Kept<'_>) {
    let rests = bodies.substep.count as f32 * length(kept.lists.driven);
    let pairs = kept.pairs[..kept.lists.pairs as usize].iter();
    for pair in pairs.filter(|pair| pair.touch.is_on()) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let normal = unit(bodies.between(b, a));
        let share = pair.given / (bodies.inverse_mass[a] + bodies.inverse_mass[b]);
        for (row, other, normal) in [(a, b, normal), (b, a, -normal)] {
            bodies.mark_touching(row);
            let given = normal * (share * bodies.inverse_mass[row]);
            let met = Met {
                row,
                other: bodies.id(other),
                normal,
                surface: Vec3::ZERO,
                thrown: pair.touch.thrown(pair.given),
                given,
            };
            met.tell(bodies, kept.pushed, kept.pushed[other], rests);
        }
        bodies.report.contacts += 1;
    }
    let faces = kept.faces[..kept.lists.faces as usize].iter();
    for face in faces.filter(|face| face.touch.is_on()) {
        let (row, normal, surface) = (face.row as usize, face.normal, face.velocity);
        bodies.mark_touching(row);
        let (thrown, given) = (face.touch.thrown(face.given), normal * face.given);
        Met { row, other: None, normal, surface, thrown, given }.tell(bodies, kept.pushed, surface, rests);
        bodies.report.hits += 1;
    }
}

/// A particle that has met another, or a collider.
struct Met {
    row: usize,
    other: Option<Id>,
    /// From that to the particle.
    normal: Vec3,
    /// How a collider moves there \[m/s\].
    surface: Vec3,
    /// How fast bounces say that they came together, and by how much these have changed the velocity \[m/s\].
    thrown: f32,
    given: Vec3,
}

impl Met {
    /// Tells whoever watches, if it is not fixed and came against what moves with `velocity` faster than what rests does.
    fn tell(&self, bodies: &mut Bodies<'_>, pushed: &[Vec3], velocity: Vec3, rests: f32) {
        let Self { row, other, normal, surface, thrown, given } = *self;
        let after = bodies.velocity[row];
        let mut closing = (velocity - pushed[row]).dot(normal);
        let mut before = pushed[row];
        // Others have thrown it there within the sub-step.
        if !(closing > rests) && thrown > rests {
            (closing, before) = (thrown, after - given);
        }
        if !(closing > rests) || bodies.inverse_mass[row] == 0.0 {
            return;
        }
        let Some(id) = bodies.id(row) else { return };
        let (mass, place, time) = (bodies.mass[row], bodies.position[row], bodies.substep.during[1]);
        bodies.tell(&Impact { id, row, other, mass, place, normal, closing, before, after, surface, time });
    }
}
