//! Velocities of sheets that have been moved apart: how fast they part, and what friction takes of their slip.

use super::super::Bodies;
use super::super::contacts::{Touch, bounce};
use super::contact::{Contact, Surface};
use super::lists::{Kept, Work};
use super::rest::{Rest, root};
use super::{tell, zones};
use crate::math::{aside, min};
use glam::Vec3;

/// Passes over all contacts.
const PASSES: u32 = 4;
/// The share of the distance they are to have by which two may be farther and still touch, unless one is at the rim of the other.
const SLACK: f32 = 1e-3;

/// Lets what touches part as fast as its elasticity wants, and no faster; then friction by all that presses, here and by position. What it
/// took by what turns out to press less it gives back, so that methods that leave half of the pressure to this are held as others.
pub(super) fn settle(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) {
    zones::part(rest, work);
    zones::join(kept, work);
    for i in 0..work.group.len() {
        (work.group[i], work.moved[i]) = (root(work.group, i as u32), Vec3::ZERO);
    }
    let (group, torques) = (&*work.group, &mut *work.moved);
    let mut turn = |contact: &Contact, torque: Vec3| torques[group[contact.corners[0] as usize] as usize] += torque;
    for pass in 0..PASSES {
        press(kept, bodies, pass == 0, &mut turn);
        rub(kept, bodies, &mut turn);
    }
    zones::settle_spin(kept, work, bodies);
    tell::tell(kept, bodies);
    count(kept, bodies);
}

/// Counts what touches, and leaves it to the sweep only to see that no particle goes through a surface.
fn count(kept: &mut Kept<'_>, bodies: &mut Bodies<'_>) {
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    let touches = |touch: &Touch| touch.pressed() > 0.0;
    bodies.report.contacts += kept.contacts[..contacts].iter().filter(|contact| touches(&contact.touch)).count() as u64;
    for surface in kept.surfaces[..surfaces].iter().filter(|surface| touches(&surface.touch)) {
        bodies.report.hits += 1;
        bodies.mark_touching(kept.rows[surface.particle as usize] as usize);
    }
}

fn press(kept: &mut Kept<'_>, bodies: &mut Bodies<'_>, first: bool, turn: &mut impl FnMut(&Contact, Vec3)) {
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    for leaning in [false, true] {
        for contact in kept.contacts[..contacts].iter_mut().filter(|contact| contact.leans() == leaning) {
            let Some(ease) = ease_of(contact, kept.rows, kept.weight, bodies) else { continue };
            let normal = contact.normal;
            let along = |of: &[Vec3]| contact.between(|i| of[kept.rows[i] as usize]).dot(normal);
            let parting = along(bodies.velocity);
            let approach = contact.between(|i| kept.pushed[i]).dot(normal);
            let mut wanted = bounce(&bodies.substep, contact.touch.elasticity, [along(bodies.before[1]), approach]);
            if leaning {
                let most = if first { contact.touch.pressed() } else { 0.0 };
                wanted = min(parting + most, wanted);
            }
            let by = normal * (contact.touch.press(wanted, parting) / ease);
            turn(contact, push(contact, kept.rows, kept.weight, bodies, by));
        }
    }
    for surface in &mut kept.surfaces[..surfaces] {
        let (i, normal) = (surface.particle as usize, surface.normal);
        let row = kept.rows[i] as usize;
        if touches(surface, bodies.position[row]) {
            let along = |v: Vec3| (v - surface.velocity).dot(normal);
            let ends = [along(bodies.before[1][row]), along(kept.pushed[i])];
            let wanted = bounce(&bodies.substep, surface.touch.elasticity, ends);
            let change = surface.touch.press(wanted, along(bodies.velocity[row]));
            bodies.velocity[row] += normal * change;
        }
    }
}

/// Takes from the slip of all what friction can by all that has pressed them.
fn rub(kept: &mut Kept<'_>, bodies: &mut Bodies<'_>, turn: &mut impl FnMut(&Contact, Vec3)) {
    let (contacts, surfaces) = (kept.counts.contacts as usize, kept.counts.surfaces as usize);
    for contact in kept.contacts[..contacts].iter_mut().filter(|contact| contact.tangent.acts(&contact.touch)) {
        let Some(ease) = ease_of(contact, kept.rows, kept.weight, bodies) else { continue };
        let slip = aside(contact.between(|i| bodies.velocity[kept.rows[i] as usize]), contact.normal);
        let by = contact.tangent.hold(&contact.touch, slip, contact.touch.pressed()) / ease;
        turn(contact, push(contact, kept.rows, kept.weight, bodies, by));
    }
    for surface in kept.surfaces[..surfaces].iter_mut().filter(|surface| surface.tangent.acts(&surface.touch)) {
        let row = kept.rows[surface.particle as usize] as usize;
        let slip = aside(bodies.velocity[row] - surface.velocity, surface.normal);
        bodies.velocity[row] += surface.tangent.hold(&surface.touch, slip, surface.touch.pressed());
    }
}

/// How fast two that touch part by a unit push \[1/kg\].
fn ease_of(contact: &Contact, rows: &[u32], weight: &[f32], bodies: &Bodies<'_>) -> Option<f32> {
    let far = || contact.between(|i| bodies.position[rows[i] as usize]).dot(contact.normal);
    let pushes = contact.touch.pressed() > 0.0 || contact.tangent.acts(&contact.touch);
    let touches = pushes || !contact.leans() && far() < contact.target * (1.0 + SLACK);
    Some(contact.ease(weight)).filter(|&ease| touches && ease > 0.0)
}

fn touches(surface: &Surface, place: Vec3) -> bool {
    let slack = SLACK * (surface.offset - surface.limit);
    surface.touch.pressed() > 0.0 || place.dot(surface.normal) < surface.offset + slack
}

/// Pushes two apart by equal and opposite pushes; returns their moment.
fn push(contact: &Contact, rows: &[u32], weight: &[f32], bodies: &mut Bodies<'_>, by: Vec3) -> Vec3 {
    for (&corner, share) in contact.corners.iter().zip(contact.weights) {
        let i = corner as usize;
        bodies.velocity[rows[i] as usize] += by * (share * weight[i]);
    }
    contact.between(|i| bodies.position[rows[i] as usize]).cross(by)
}
