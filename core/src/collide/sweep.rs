//! Every particle by itself: tiles of rows whose boxes touch nothing are passed by, the others are followed.

use super::flight::Flight;
use super::meetings::Passage;
use super::path::Path;
use crate::constrain::{SHIFTED, TOUCHING};
use crate::memory::{Layout, Past};
use crate::particles::Id;
use crate::reap::Fate;
use crate::shape::{Hulls, Marks};

/// Sends every free particle along its path through the step, past all others.
pub(super) fn each_by_itself(mut passage: Passage<'_, '_>) {
    let layout = Layout::of(passage.scene.plan(), passage.view.capacity());
    for first in (0..passage.view.len()).step_by(Hulls::MANY) {
        for (i, mark) in near(&passage, &layout, first).into_iter().enumerate() {
            if mark != 0 {
                follow(&mut passage, &layout, first + i);
            }
        }
    }
}

/// Marks those from a row on that may touch anything in the step. Its hulls are off the stack when anybody is followed.
#[inline(never)]
fn near(passage: &Passage<'_, '_>, layout: &Layout, first: usize) -> Marks {
    let Passage { view, scene, old, dt, .. } = passage;
    let m = &view.memory;
    let rows = first..view.len().min(first + Hulls::MANY);
    let Past { start: [start_x, start_v], .. } = layout.past(m.work);
    let ends = [start_x, start_v, m.position, m.velocity].map(|column| &column[rows.clone()]);
    let hulls = Hulls::of_paths(ends, &m.radius[rows.clone()], dt.seconds());
    let mut marks = [0; Hulls::MANY];
    scene.colliders.mark_near(&hulls, &mut marks);
    scene.sinks.mark_near(&hulls, &mut marks);
    // Newborns have come only part of the way: their cubics are others.
    for (row, mark) in (first..).zip(&mut marks) {
        *mark = if row >= rows.end {
            0
        } else if row >= *old {
            u32::MAX
        } else {
            *mark
        };
    }
    marks
}

/// Follows the particle in a row to its first hit and on, if its own box may touch anything.
#[inline(never)]
fn follow(passage: &mut Passage<'_, '_>, layout: &Layout, row: usize) {
    let Passage { view, scene, old, dt, end, report, observer } = passage;
    let (old, dt, end) = (*old, *dt, *end);
    let m = &mut view.memory;
    if m.inverse_mass[row] == 0.0 {
        return;
    }
    let Past { start: [start_x, start_v], marks } = layout.past(m.work);
    // A newborn has come only part of the way.
    let start = end - (end - m.born[row]).min(dt);
    let path =
        Path { x0: start_x[row], v0: start_v[row], x1: m.position[row], v1: m.velocity[row], during: [start, end] };
    // Constraints know nothing of the newborn.
    let mark = if row < old { marks.get(row).copied().unwrap_or(0) } else { 0 };
    // What constraints have moved goes straight. What they keep from what it touches is only kept from passing: half of it
    // may not touch anything.
    let path = if mark & SHIFTED != 0 { path.straightened() } else { path };
    let is_kept = mark & TOUCHING != 0;
    let radius = if is_kept { 0.5 * m.radius[row] } else { m.radius[row] };
    let hull = path.hull(radius);
    let near_sink = scene.sinks.may_touch(&hull);
    if !(scene.colliders.may_touch(&hull) || near_sink) || !path.is_finite() {
        return;
    }
    let (mass, elasticity) = (m.mass[row], m.elasticity[row]);
    let material = m.material[row].checked_sub(1);
    let (report, observer) = (&mut **report, &mut **observer);
    let id = Id { slot: m.slot[row], serial: m.serial[row] };
    let mut flight = Flight { scene, id, row, radius, mass, elasticity, material, dt: dt.seconds(), report, observer };
    let before = flight.report.hits;
    let path = match path {
        path if row >= old => flight.let_go(path),
        path if mark == 0 && !near_sink => match flight.lying(path) {
            path if path.lags() => flight.pressed_on(path),
            path => path,
        },
        path if path.lags() => flight.pressed_on(path),
        path => path,
    };
    let end = flight.follow(path);
    if is_kept && end.fate == Fate::Lives && report.hits == before {
        return;
    }
    (m.position[row], m.velocity[row], m.fate[row]) = (end.position, end.velocity, end.fate);
}
