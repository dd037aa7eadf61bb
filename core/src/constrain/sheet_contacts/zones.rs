//! Sheets that move as one where nothing else keeps them from passing, and the turning of all.

use super::super::Bodies;
use super::super::turn::turn_of;
use super::lists::{Kept, NOBODY, Work};
use super::rest::{Rest, root, unite};
use super::{scenery, search};
use glam::{Mat3, Vec3};

/// Times that zones grow, at the most, before all sheets are one.
const GROWTH: u32 = 12;
/// An angle by which all sheets may be turned \[rad\].
pub(super) const LITTLE: f32 = 0.02;

/// Lets what would pass each other move as one, with its momenta (rigid impact zones: Provot, "Collision and self-collision handling in
/// cloth model dedicated to design garments", 1997): each zone goes by a shift and a turn of first order, x + u + ω × r, and since
/// that maps space without folding it at any ω, nothing within it passes anything. A zone in which something is fixed, or held by the scenery,
/// goes as that does.
pub(super) fn hold(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) {
    for (i, zone) in work.zone.iter_mut().enumerate() {
        *zone = i as u32;
    }
    for growth in 0..GROWTH {
        let holds = scenery::hold(kept, work, bodies);
        if search::search(rest, kept, work, bodies) == 0 && !holds {
            return;
        }
        bodies.report.effort.capped += 1;
        if growth + 1 == GROWTH {
            work.zone.fill(0);
        } else {
            for contact in kept.lists().0.iter().filter(|contact| contact.meets()) {
                let [a, b, c, d] = contact.corners;
                [b, c, d].into_iter().for_each(|other| unite(work.zone, a, other));
            }
        }
        for i in 0..work.zone.len() {
            work.zone[i] = root(work.zone, i as u32);
        }
        for of in 0..work.zone.len() {
            if work.zone[of] == of as u32 {
                move_as_one(kept.weight, kept.rows, work, of);
            }
        }
    }
}

/// Moves a zone as one: with its momenta, or as what in it is fixed.
fn move_as_one(weight: &[f32], rows: &[u32], work: &mut Work<'_>, of: usize) {
    let is_in = |work: &Work<'_>, i: usize| rows[i] != NOBODY && work.zone[i] == of as u32;
    let is_free = |work: &Work<'_>, i: usize| is_in(work, i) && weight[i] > 0.0 && work.held[i] == 0;
    if (0..rows.len()).filter(|&i| is_in(work, i)).nth(1).is_none() {
        return;
    }
    let (mut mass, mut middle, mut way, mut fixed) = (0.0, Vec3::ZERO, Vec3::ZERO, None);
    let origin = work.from[of];
    for i in (0..rows.len()).filter(|&i| is_in(work, i)) {
        let gone = work.now[i] - work.from[i];
        if is_free(work, i) {
            mass += 1.0 / weight[i];
            middle += (work.from[i] - origin) / weight[i];
            way += gone / weight[i];
        } else {
            fixed = fixed.or(Some(gone));
        }
    }
    let (middle, way) = (origin + middle / mass, way / mass);
    let mut whole = Whole::NONE;
    for i in (0..rows.len()).filter(|&i| is_free(work, i)) {
        let arm = work.from[i] - middle;
        whole.add(arm, arm, 1.0 / weight[i], work.now[i] - work.from[i] - way);
    }
    let turn = whole.turn();
    for i in 0..rows.len() {
        if is_free(work, i) {
            let from = work.from[i];
            work.put(i, from + fixed.unwrap_or_else(|| way + turn.cross(from - middle)));
        }
    }
}

/// Turns all sheets together by what pushes between them would change of the angular momentum, so that it stays as it is.
///
/// That is rounding and friction across the thickness, and what comes of it that pushes count from the sub-step's beginning on. Nothing is
/// kept where something is fixed or touches the scenery, nor where sheets are so fast that it would turn them by more than a little.
pub(super) fn keep_spin(kept: &Kept<'_>, work: &mut Work<'_>) {
    let members = || (0..kept.rows.len()).filter(|&i| kept.rows[i] != NOBODY);
    let Some(origin) = members().next() else { return };
    let is_held = kept.counts.surfaces > 0 || members().any(|i| kept.weight[i] == 0.0);
    if is_held || members().all(|i| work.moved[i] == Vec3::ZERO) {
        return;
    }
    let (mut mass, mut arms, mut middle) = (0.0, Vec3::ZERO, Vec3::ZERO);
    for i in members() {
        mass += 1.0 / kept.weight[i];
        arms += (work.arm[i] - work.arm[origin]) / kept.weight[i];
        middle += (work.now[i] - work.now[origin]) / kept.weight[i];
    }
    let (arms, middle) = (work.arm[origin] + arms / mass, work.now[origin] + middle / mass);
    let mut whole = Whole::NONE;
    for i in members() {
        whole.add(work.arm[i] - arms, work.now[i] - middle, 1.0 / kept.weight[i], work.moved[i]);
    }
    let turn = whole.turn();
    if turn.dot(turn) < LITTLE * LITTLE {
        for i in members() {
            let place = work.now[i] - middle;
            work.shift(i, -turn.cross(place));
        }
    }
}

/// Masses that turn as one.
pub(super) struct Whole {
    torque: Vec3,
    spread: Mat3,
}

impl Whole {
    const NONE: Self = Self { torque: Vec3::ZERO, spread: Mat3::ZERO };

    /// None, with this moment.
    pub(super) fn of(torque: Vec3) -> Self {
        Self { torque, ..Self::NONE }
    }

    /// Adds a mass at a place about the middle, whose way counts as from another.
    pub(super) fn add(&mut self, arm: Vec3, place: Vec3, mass: f32, way: Vec3) {
        self.torque += arm.cross(way) * mass;
        let [x, y, z] = arm.to_array().map(|along| place * (along * mass));
        self.spread += Mat3::from_cols(x, y, z);
    }

    pub(super) fn turn(&self) -> Vec3 {
        turn_of(self.spread, self.torque)
    }
}
