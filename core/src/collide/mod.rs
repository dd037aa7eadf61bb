//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

mod flight;
mod grip;
mod path;
mod slide;

pub use grip::Grip;
pub(crate) use path::{CHORD_ERROR, MAX_CHORDS};

use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;
use crate::view::View;
use flight::Flight;
use path::Path;

/// Sends every free particle along its path through the step that ends at `end`; those from row `old` on are newborn.
pub(crate) fn collide(
    view: &mut View<'_>,
    scene: &Scene<'_>,
    old: usize,
    [dt, end]: [Time; 2],
    report: &mut Report,
    observer: &mut dyn Observer,
) {
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
        let hull = path.hull(m.radius[row]);
        if !(scene.colliders.may_touch(&hull) || scene.sinks.may_touch(&hull)) || !path.is_finite() {
            continue;
        }
        let (radius, mass, elasticity) = (m.radius[row], m.mass[row], m.elasticity[row]);
        let material = m.material[row].checked_sub(1);
        let (report, observer) = (&mut *report, &mut *observer);
        let mut flight = Flight { scene, row, radius, mass, elasticity, material, dt: dt.seconds(), report, observer };
        let end = flight.follow(if row >= old { flight.let_go(path) } else { path });
        (m.position[row], m.velocity[row], m.fate[row]) = (end.position, end.velocity, end.fate);
    }
}
