//! Every particle by itself: rows whose boxes touch nothing are passed by, the others are followed.

use super::flight::Flight;
use super::path::Path;
use crate::constrain::{SHIFTED, TOUCHING};
use crate::memory::{Layout, Past};
use crate::observe::Observer;
use crate::particles::Id;
use crate::reap::Fate;
use crate::report::Report;
use crate::shape::{Hulls, Marks};
use crate::step::Tile;

/// Sends every free particle of a tile along its path through the step, past all others.
pub(crate) fn each_by_itself(tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
    let work = core::mem::take(&mut tile.work);
    let past = Layout::of(tile.scene.plan(), tile.capacity).past(work);
    for first in (0..tile.position.len()).step_by(Hulls::MANY) {
        for (i, mark) in near(tile, &past, first).into_iter().enumerate() {
            if mark != 0 {
                follow(tile, &past, first + i, report, observer);
            }
        }
    }
    tile.work = work;
}

/// Marks those from a row on that may touch anything in the step. Its hulls are off the stack when anybody is followed.
#[inline(never)]
fn near(tile: &Tile<'_>, past: &Past<'_>, first: usize) -> Marks {
    let Tile { scene, old, dt, .. } = *tile;
    let rows = first..tile.position.len().min(first + Hulls::MANY);
    let [start_x, start_v] = past.start;
    let ends = [start_x, start_v, tile.position, tile.velocity].map(|column| &column[rows.clone()]);
    let hulls = Hulls::of_paths(ends, &tile.attributes.lives.radius[rows.clone()], dt.seconds());
    let mut marks = [0; Hulls::MANY];
    scene.colliders.mark_near(&hulls, &mut marks);
    scene.sinks.mark_near(&hulls, &mut marks);
    // Newborns have come only part of the way: their cubics are others.
    marks[old.clamp(rows.start, rows.end) - first..].fill(u32::MAX);
    marks[rows.len()..].fill(0);
    marks
}

/// Follows the particle in a row to its first hit and on, if its own box may touch anything.
#[inline(never)]
fn follow(tile: &mut Tile<'_>, past: &Past<'_>, row: usize, report: &mut Report, observer: &mut dyn Observer) {
    let Tile { scene, old, dt, attributes: ref m, .. } = *tile;
    if m.inverse_mass[row] == 0.0 {
        return;
    }
    let (lives, end) = (&m.lives, tile.end());
    // A newborn has come only part of the way.
    let start = end - (end - lives.born[row]).min(dt);
    let [[x0, v0], [x1, v1]] = [past.start.map(|column| column[row]), [tile.position[row], tile.velocity[row]]];
    let path = Path { x0, v0, x1, v1, during: [start, end] };
    // Constraints know nothing of the newborn.
    let mark = if row < old { past.marks.get(row).copied().unwrap_or(0) } else { 0 };
    // What constraints have moved goes straight. What they keep from what it touches is only kept from passing: half of it
    // may not touch anything.
    let path = if mark & SHIFTED != 0 { path.straightened() } else { path };
    let is_kept = mark & TOUCHING != 0;
    let radius = if is_kept { 0.5 * lives.radius[row] } else { lives.radius[row] };
    if !path.is_finite() {
        return;
    }
    let (mass, elasticity) = (lives.mass[row], m.elasticity[row]);
    let material = m.material[row].checked_sub(1);
    let id = Id { slot: lives.slot[row], serial: lives.springs.serial[row] };
    let before = report.hits;
    let number = tile.first + row;
    let mut flight =
        Flight { scene, id, row: number, radius, mass, elasticity, material, dt: dt.seconds(), report, observer };
    let may_lie = row < old && mark == 0 && (scene.sinks.is_empty() || !scene.sinks.may_touch(&path.hull(radius)));
    let path = match may_lie.then(|| flight.lying(&path)).flatten() {
        Some(path) => path,
        None => {
            let hull = path.hull(radius);
            if !(scene.colliders.may_touch(&hull) || scene.sinks.may_touch(&hull)) {
                return;
            }
            match path {
                path if row >= old => flight.let_go(path),
                path if path.lags() => flight.pressed_on(path),
                path => path,
            }
        }
    };
    let end = flight.follow(path);
    if is_kept && end.fate == Fate::Lives && report.hits == before {
        return;
    }
    (tile.position[row], tile.velocity[row], tile.fate[row]) = (end.position, end.velocity, end.fate);
}
