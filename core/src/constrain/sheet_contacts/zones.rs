//! Sheets that move as one where nothing else keeps them from passing, and the turning of all.

use super::super::Bodies;
use super::super::turn::turn_of;
use super::lists::{Kept, NOBODY, Work};
use super::rest::{Rest, root, unite};
use super::{scenery, search};
use crate::math::length;
use glam::{Mat3, Vec3};

/// Times that zones grow by what meets, at the most, then by whole sheets, before all sheets are one.
const GROWTH: [u32; 2] = [11, 4];
/// An angle by which all sheets may be turned \[rad\].
const LITTLE: f32 = 0.02;

/// Lets what would pass each other move as one, with its momenta (rigid impact zones: Provot, "Collision and self-collision handling in
/// cloth model dedicated to design garments", 1997): each zone goes by a shift and a turn of first order, x + u + ω × r, and since
/// that maps space without folding it at any ω, nothing within it passes anything. A zone in which something is fixed, or held by the scenery,
/// goes as that does.
pub(super) fn hold(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) {
    for (i, zone) in work.zone.iter_mut().enumerate() {
        *zone = i as u32;
    }
    let [by_contacts, by_sheets] = GROWTH;
    for growth in 0..=by_contacts + by_sheets {
        let holds = scenery::hold(kept, work, bodies);
        if search::search(rest, kept, work, bodies) == 0 && !holds {
            return;
        }
        bodies.report.effort.capped += 1;
        if growth < by_contacts {
            bind_contacts(kept, work);
        } else if growth < by_contacts + by_sheets {
            bind_sheets(rest, kept, work);
        } else {
            work.zone.fill(0);
        }
        move_all(kept, work);
    }
}

/// Makes one zone of all that would pass each other at a place.
fn bind_contacts(kept: &mut Kept<'_>, work: &mut Work<'_>) {
    for contact in kept.lists().0.iter().filter(|contact| contact.meets()) {
        let [a, b, c, d] = contact.corners;
        [b, c, d].into_iter().for_each(|other| unite(work.zone, a, other));
    }
}

/// Makes one zone of sheets of which some parts would pass each other.
fn bind_sheets(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>) {
    bind_contacts(kept, work);
    // The next search sets the room anew: until then it says whose sheet has to do with that.
    work.room.fill(0.0);
    for contact in kept.lists().0.iter().filter(|contact| contact.meets()) {
        contact.corners.into_iter().for_each(|corner| work.room[rest.sheet[corner as usize] as usize] = 1.0);
    }
    for (i, &sheet) in rest.sheet.iter().enumerate() {
        if work.room[sheet as usize] == 1.0 {
            unite(work.zone, i as u32, sheet);
        }
    }
}

/// Moves each zone as one.
fn move_all(kept: &Kept<'_>, work: &mut Work<'_>) {
    let zone = core::mem::take(&mut work.zone);
    each_of(zone, work, &mut |work, members| {
        if members.len() > 1 {
            move_as_one(kept, work, members);
        }
    });
    work.zone = zone;
}

/// Does something with each of those that hang together, by what they are bound to.
fn each_of(bound: &mut [u32], work: &mut Work<'_>, visit: &mut dyn FnMut(&mut Work<'_>, &[u32])) {
    for i in 0..bound.len() {
        bound[i] = root(bound, i as u32);
    }
    // A search needs no places of the last one: until then they say who is where in an order by what they hang on.
    let places = core::mem::take(&mut work.searched);
    let order: &mut [u32] = bytemuck::cast_slice_mut(&mut *places);
    let order = &mut order[..bound.len()];
    order.iter_mut().enumerate().for_each(|(i, place)| *place = i as u32);
    order.sort_unstable_by_key(|&i| (bound[i as usize], i));
    order.chunk_by(|&a, &b| bound[a as usize] == bound[b as usize]).for_each(|members| visit(work, members));
    work.searched = places;
}

/// Moves a zone as one: with its momenta, or as what in it is fixed.
fn move_as_one(kept: &Kept<'_>, work: &mut Work<'_>, members: &[u32]) {
    let weight = &*kept.weight;
    let there = || members.iter().map(|&i| i as usize).filter(|&i| kept.rows[i] != NOBODY);
    let is_free = |work: &Work<'_>, i: usize| weight[i] > 0.0 && work.held[i] == 0;
    let (mut mass, mut middle, mut way, mut fixed) = (0.0, Vec3::ZERO, Vec3::ZERO, None);
    // The first of them may be gone.
    let Some(origin) = there().next().map(|first| work.from[first]) else { return };
    for i in there() {
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
    for i in there().filter(|&i| is_free(work, i)) {
        let arm = work.from[i] - middle;
        whole.add(arm, arm, 1.0 / weight[i], work.now[i] - work.from[i] - way);
    }
    let turn = whole.turn();
    for i in there() {
        if is_free(work, i) {
            let from = work.from[i];
            work.put(i, from + fixed.unwrap_or_else(|| way + turn.cross(from - middle)));
        }
    }
}

/// Says that sheets have nothing to do with each other yet.
pub(super) fn part(rest: &Rest<'_>, work: &mut Work<'_>) {
    work.group.copy_from_slice(rest.sheet);
}

/// Says which sheets touch each other.
pub(super) fn join(kept: &mut Kept<'_>, work: &mut Work<'_>) {
    for contact in kept.lists().0 {
        let [a, b] = contact.sides();
        unite(work.group, a as u32, b as u32);
    }
}

/// Those of sheets that touch each other who are there; none, if one of them is fixed, or near the scenery: that may take their angular momentum.
fn free<'k>(kept: &'k Kept<'_>, members: &'k [u32]) -> Option<impl Iterator<Item = usize> + Clone + 'k> {
    let there = members.iter().map(|&i| i as usize).filter(|&i| kept.rows[i] != NOBODY);
    there.clone().all(|i| kept.weight[i] > 0.0 && !scenery::is_near(kept, i)).then_some(there)
}

/// Turns sheets that touch each other together by what pushes between them would change of the angular momentum, so that it stays as it is.
///
/// That is rounding and friction across the thickness, and what comes of it that pushes count from the sub-step's beginning on. Nothing is
/// kept where one of them is fixed or touches the scenery, nor where they are so fast that it would turn them by more than a little.
pub(super) fn keep_spin(kept: &Kept<'_>, work: &mut Work<'_>) {
    let group = core::mem::take(&mut work.group);
    each_of(group, work, &mut |work, members| keep_spin_of(kept, work, members));
    work.group = group;
}

fn keep_spin_of(kept: &Kept<'_>, work: &mut Work<'_>, members: &[u32]) {
    let Some(free) = free(kept, members) else { return };
    let members = || free.clone();
    let Some(origin) = members().next().filter(|_| members().any(|i| work.moved[i] != Vec3::ZERO)) else { return };
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

/// Turns sheets that touch each other together by what pushes have changed of their angular momentum by the end of the sub-step, of which `work.moved` has the sum
/// at the lowest of each.
pub(super) fn settle_spin(kept: &Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) {
    let group = core::mem::take(&mut work.group);
    each_of(group, work, &mut |work, members| {
        let torque = members.first().map_or(Vec3::ZERO, |&lowest| work.moved[lowest as usize]);
        if let Some(free) = free(kept, members).filter(|_| torque != Vec3::ZERO) {
            turn_back(kept, free, bodies, torque);
        }
    });
    work.group = group;
}

/// Takes an angular momentum from some, whose middle goes on as it does.
fn turn_back(kept: &Kept<'_>, members: impl Iterator<Item = usize> + Clone, bodies: &mut Bodies<'_>, torque: Vec3) {
    let living = || members.clone().map(|i| (kept.rows[i] as usize, kept.weight[i]));
    let Some(origin) = living().next().map(|(row, _)| bodies.position[row]) else { return };
    let (mass, middle) = living().fold((0.0, Vec3::ZERO), |(mass, middle), (row, weight)| {
        (mass + 1.0 / weight, middle + (bodies.position[row] - origin) / weight)
    });
    let middle = origin + middle / mass;
    let mut whole = Whole::of(torque);
    for (row, weight) in living() {
        let arm = bodies.position[row] - middle;
        whole.add(arm, arm, 1.0 / weight, Vec3::ZERO);
    }
    let turn = whole.turn();
    if length(turn) * bodies.substep.seconds() <= LITTLE {
        for (row, _) in living() {
            bodies.velocity[row] -= turn.cross(bodies.position[row] - middle);
        }
    }
}

/// Masses that turn as one.
struct Whole {
    torque: Vec3,
    spread: Mat3,
}

impl Whole {
    const NONE: Self = Self { torque: Vec3::ZERO, spread: Mat3::ZERO };

    /// None, with this moment.
    fn of(torque: Vec3) -> Self {
        Self { torque, ..Self::NONE }
    }

    /// Adds a mass at a place about the middle, whose way counts as from another.
    fn add(&mut self, arm: Vec3, place: Vec3, mass: f32, way: Vec3) {
        self.torque += arm.cross(way) * mass;
        let [x, y, z] = arm.to_array().map(|along| place * (along * mass));
        self.spread += Mat3::from_cols(x, y, z);
    }

    fn turn(&self) -> Vec3 {
        turn_of(self.spread, self.torque)
    }
}

#[cfg(test)]
mod tests {
    use super::super::lists::demand;
    use super::*;
    use alloc::vec;

    #[test]
    fn a_zone_goes_on_without_those_who_are_gone() {
        const COUNTS: [usize; 2] = [3, 1];
        let demand = demand(COUNTS);
        let (mut step, mut scratch) = (vec![0; demand.step.fixed], vec![0; demand.scratch.fixed]);
        let kept = Kept::of(&mut step, COUNTS).expect("the memory is asked for");
        let mut work = Work::of(&mut scratch, COUNTS).expect("the memory is asked for");
        kept.rows.copy_from_slice(&[NOBODY, 0, 1]);
        kept.weight.copy_from_slice(&[0.0, 1.0, 1.0]);
        work.from.copy_from_slice(&[Vec3::NAN, Vec3::ZERO, Vec3::X]);
        work.now.copy_from_slice(&[Vec3::NAN, Vec3::Y, Vec3::new(1.5, 1.0, 0.0)]);
        work.zone.fill(0);
        move_all(&kept, &mut work);
        // They go as one, and share what they had along their line.
        let ways = [1, 2].map(|i| work.now[i] - work.from[i]);
        assert!(ways.iter().all(|way| (*way - Vec3::new(0.25, 1.0, 0.0)).length() < 1e-6), "{ways:?}");
        assert_eq!(work.moved[0], Vec3::ZERO);
    }
}
