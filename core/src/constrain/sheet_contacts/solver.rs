//! Sheets kept apart in a sub-step by position.

use super::super::Bodies;
use super::contact::{Contact, Surface};
use super::lists::{Kept, NOBODY, Work};
use super::rest::Rest;
use super::{scenery, search, taut, zones};
use crate::math::{aside, length, min};
use glam::Vec3;

/// Searches of who is near whom, at the most, before what would pass is held.
const ROUNDS: u32 = 5;
/// Passes over all contacts after each.
const SWEEPS: u32 = 4;

/// Moves apart what is nearer than it may be, and holds what would pass.
///
/// Nobody passes anybody on the way to where a search has found none to pass, nor within the bounds that it sets from there: each may go by
/// less than half its distance to all that it is not part of (Chen et al., "Offset Geometric Contact", SIGGRAPH 2025, section 3.3).
pub(super) fn project(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) {
    kept.counts.contacts = 0;
    if bodies.substep.number == 0 {
        taut::list(rest, kept);
        kept.counts.compare(rest);
        if let Some(near) = &mut kept.near {
            near.forget(rest);
        }
    }
    if let Some(near) = &mut kept.near {
        near.part();
    }
    scenery::gather(rest, kept, work, bodies);
    zones::part(rest, work);
    let h = bodies.substep.seconds();
    let mut safe = false;
    for round in 0..ROUNDS {
        let meetings = search::search(rest, kept, work, bodies);
        if meetings == 0 && kept.counts.contacts == 0 && kept.counts.surfaces == 0 {
            safe = true;
            break;
        }
        zones::join(kept, work);
        work.searched.copy_from_slice(work.now);
        for _ in 0..SWEEPS {
            taut::hold(kept, work);
            sweep(kept, work, h);
            rub(kept, work, h);
        }
        if meetings == 0 {
            let share = share(work);
            if share >= 1.0 || round + 1 == ROUNDS {
                hold(work, share);
                bodies.report.effort.capped += u64::from(share < 1.0);
                safe = true;
                break;
            }
        }
    }
    work.held.fill(0);
    if scenery::hold(kept, work, bodies) || !safe {
        zones::hold(rest, kept, work, bodies);
    }
    zones::keep_spin(kept, work);
    scenery::follow(kept, work, bodies);
    act(kept, work, bodies);
}

/// The share of what all have been pushed since the search that none of them has gone too far by.
fn share(work: &Work<'_>) -> f32 {
    let pushes = work.now.iter().zip(&*work.searched).zip(&*work.room);
    pushes.fold(1.0, |least, ((&now, &searched), &room)| {
        let far = length(now - searched);
        if far > room { min(room / far, least) } else { least }
    })
}

/// Leaves that share of the pushes: of all alike, so that momenta stay.
fn hold(work: &mut Work<'_>, share: f32) {
    if share < 1.0 {
        for i in 0..work.now.len() {
            let pushed = work.now[i] - work.searched[i];
            work.put(i, work.searched[i] + pushed * share);
        }
    }
}

/// Lets particles and their velocities follow: these by the sum of all pushes, which is not rounded to where they are.
fn act(kept: &Kept<'_>, work: &Work<'_>, bodies: &mut Bodies<'_>) {
    for (i, &row) in kept.rows.iter().enumerate().filter(|&(_, &row)| row != NOBODY) {
        let row = row as usize;
        let by = work.moved[i];
        if by != Vec3::ZERO && by.is_finite() {
            bodies.shift(row, by);
            bodies.position[row] = work.now[i];
        }
    }
}

/// Pushes all to the distances that they are to have.
fn sweep(kept: &mut Kept<'_>, work: &mut Work<'_>, h: f32) {
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    // Points over triangles first: what leans pushes only where that leaves it too near.
    for leaning in [false, true] {
        for contact in kept.contacts[..contacts].iter_mut().filter(|contact| contact.leans() == leaning) {
            let ease = contact.ease(kept.weight);
            let distance = contact.between(|i| work.now[i]).dot(contact.normal);
            let change = contact.touch.press(contact.target / h, distance / h) * h;
            if change != 0.0 && ease > 0.0 {
                push(contact, kept.weight, work, contact.normal * (change / ease));
            }
        }
    }
    for Surface { particle, normal, offset, touch, .. } in &mut kept.surfaces[..surfaces] {
        let i = *particle as usize;
        let change = touch.press(*offset / h, work.now[i].dot(*normal) / h);
        work.shift(i, *normal * (change * h));
    }
}

/// Takes from the slip of all what friction can by what has pressed them, but for the speed that gives a missing gap back, which
/// `settle` takes again.
fn rub(kept: &mut Kept<'_>, work: &mut Work<'_>, h: f32) {
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    for contact in kept.contacts[..contacts].iter_mut().filter(|contact| contact.tangent.acts(&contact.touch)) {
        let ease = contact.ease(kept.weight);
        let slip = aside(contact.between(|i| work.now[i] - work.from[i]), contact.normal);
        let load = contact.touch.pressed() - contact.recovery / h;
        let change = contact.tangent.hold(&contact.touch, slip / h, load) * h;
        if change != Vec3::ZERO && ease > 0.0 {
            push(contact, kept.weight, work, change / ease);
        }
    }
    for surface in kept.surfaces[..surfaces].iter_mut().filter(|surface| surface.tangent.acts(&surface.touch)) {
        let i = surface.particle as usize;
        let slip = aside((work.now[i] - work.from[i]) / h - surface.velocity, surface.normal);
        let load = surface.touch.pressed() - surface.recovery / h;
        work.shift(i, surface.tangent.hold(&surface.touch, slip, load) * h);
    }
}

/// Pushes two apart by equal and opposite pushes.
fn push(contact: &Contact, weight: &[f32], work: &mut Work<'_>, by: Vec3) {
    for (&corner, share) in contact.corners.iter().zip(contact.weights) {
        work.shift(corner as usize, by * (share * weight[corner as usize]));
    }
}
