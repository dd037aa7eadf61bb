//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

mod contacts;
mod flight;
mod grip;
mod impulse;
mod lists;
mod meeting;
mod melee;
mod path;
mod projection;
mod queue;
mod response;
mod slide;
mod solver;
mod touch;

pub use contacts::{Contacts, Passage, Stage};
pub use grip::Grip;
pub use impulse::Impulse;
pub(crate) use lists::Lists;
#[cfg(feature = "std")]
pub(crate) use path::{CHORD_ERROR, MAX_CHORDS};
pub use projection::Projection;
pub use response::Response;

use crate::particles::Id;
use crate::retire::Fate;
use flight::Flight;
use path::Path;

/// Sends every free particle along its path through the step, past all others.
fn each_by_itself(passage: Passage<'_, '_>) {
    let Passage { view, scene, old, dt, end, report, observer } = passage;
    let capacity = view.capacity();
    for row in 0..view.len() {
        let m = &mut view.memory;
        if m.inverse_mass[row] == 0.0 {
            continue;
        }
        let (start_x, start_v) = (m.work[row], m.work[capacity + row]);
        // A newborn has come only part of the way.
        let start = end - (end - m.born[row]).min(dt);
        let path = Path { x0: start_x, v0: start_v, x1: m.position[row], v1: m.velocity[row], during: [start, end] };
        let held = &m.work[2 * capacity..(2 + scene.contacts.held(scene.index)) * capacity];
        // Contacts know nothing of the newborn.
        let has_moved = row < old && scene.contacts.has_moved(held, row);
        // What contacts have moved goes straight, and is only kept from passing: half of it may not touch anything.
        let (path, radius) = if has_moved { (path.straightened(), 0.5 * m.radius[row]) } else { (path, m.radius[row]) };
        let hull = path.hull(radius);
        if !(scene.colliders.may_touch(&hull) || scene.sinks.may_touch(&hull)) || !path.is_finite() {
            continue;
        }
        let (mass, elasticity) = (m.mass[row], m.elasticity[row]);
        let material = m.material[row].checked_sub(1);
        let (report, observer) = (&mut *report, &mut *observer);
        let id = Id { slot: m.slot[row], serial: m.serial[row] };
        let mut flight =
            Flight { scene, id, row, radius, mass, elasticity, material, dt: dt.seconds(), report, observer };
        let before = flight.report.hits;
        let path = match path {
            path if row >= old => flight.let_go(path),
            path if path.lags() => flight.pressed_on(path),
            path => path,
        };
        let end = flight.follow(path);
        if has_moved && end.fate == Fate::Lives && report.hits == before {
            continue;
        }
        (m.position[row], m.velocity[row], m.fate[row]) = (end.position, end.velocity, end.fate);
    }
}
