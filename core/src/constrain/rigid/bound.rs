//! Blows give no energy to speak of. Newton's restitution, asked for at several points of a body at once, or of a chain of bodies, can part them with more
//! than they came with; of that so much is taken back, evenly from all impulses of those that touch each other, that nothing is gained.

use super::body::{Blow, Body};
use super::moving::Moving;
use super::order::{Order, is_scenery};
use super::pack::Pack;
use super::span::Span;
use crate::lanes::ABREAST;
use crate::math::{dot, max, min, sqrt};

/// Takes back from what a blow has made of how bodies move, while these do not know it yet, what it has given. Tells whether that is any: then each body stands, by its
/// colour, for itself or leads to the one that stands for it.
pub(super) fn bound(bodies: &mut [Body], order: &mut Order<'_>, span: Span) -> bool {
    // Most often nobody has more than he came with.
    let gains = |(body, to): (&Body, &Moving)| {
        let [spare, linear, square] = account(body, to, span.h);
        linear + square > max(spare, 0.0)
    };
    let bouncing = bodies.iter().zip(&*order.moving).filter(|(body, _)| body.bounces != 0 && body.moves());
    if !{ bouncing }.any(gains) {
        return false;
    }
    // Colours have done their work.
    for (number, body) in bodies.iter_mut().enumerate() {
        body.colours = number as u32;
        (body.blow.spare, body.blow.linear, body.blow.square) = (0.0, 0.0, 0.0);
    }
    for colour in order.colours() {
        let on_scenery = is_scenery(colour);
        for pack in order.packs.get(order.range(colour)).unwrap_or_default() {
            join(bodies, pack, on_scenery);
        }
    }
    for number in 0..bodies.len() {
        let (root, body) = (root(bodies, number), &bodies[number]);
        if !body.moves() {
            continue;
        }
        let [spare, linear, square] = order.moving.get(number).map_or([0.0; 3], |to| account(body, to, span.h));
        let sum = &mut bodies[root].blow;
        sum.spare += spare;
        sum.linear += linear;
        sum.square += square;
    }
    for number in 0..bodies.len() {
        let share = share(&bodies[root(bodies, number)].blow);
        if let (true, Some(moving)) = (share < 1.0, order.moving.get_mut(number)) {
            moving.go_part(&bodies[number], share);
        }
    }
    true
}

/// Takes back from impulses what has been taken back of all that they have done: what bodies have not been given cannot be taken from them later.
pub(super) fn take_back(bodies: &mut [Body], order: &mut Order<'_>) {
    for pack in order.packs.iter_mut() {
        for lane in 0..pack.len() {
            // Of two of which one stays the other knows.
            let [a, b] = [0, 1].map(|side| pack.bodies[side][lane] as usize);
            let number = if bodies[b].moves() { b } else { a };
            let share = share(&bodies[root(bodies, number)].blow);
            if share < 1.0 {
                pack.press_part(lane, share);
            }
        }
    }
}

/// Joins bodies that press on each other, or did before and have let go. Scenery that moves may give them whatever it does.
fn join(bodies: &mut [Body], pack: &Pack, on_scenery: bool) {
    let pressed = pack.pressed() | pack.pressed_before;
    for lane in (0..pack.len().min(ABREAST)).filter(|lane| pressed >> lane & 1 != 0) {
        let [a, b] = [0, 1].map(|side| pack.bodies[side][lane] as usize);
        if on_scenery && pack.is_carried(lane) {
            let root = root(bodies, b);
            bodies[root].blow.spare = f32::INFINITY;
        } else if !on_scenery && pack.gives[0] & pack.gives[1] & 1 << lane != 0 {
            let (a, b) = (root(bodies, a), root(bodies, b));
            let spare = max(bodies[a].blow.spare, bodies[b].blow.spare);
            let (first, other) = (a.min(b), a.max(b));
            bodies[other].colours = first as u32;
            bodies[first].blow.spare = spare;
        }
    }
}

/// The body that stands for all that a body is joined with.
fn root(bodies: &mut [Body], number: usize) -> usize {
    let mut at = number;
    while bodies[at].colours as usize != at {
        let next = bodies[at].colours as usize;
        bodies[at].colours = bodies[next].colours;
        at = next;
    }
    at
}

/// The energy that a body had more when the sub-step began, with what forces have done since, than before a blow that lets it move `to`; and what
/// that gives, in proportion to it and to its square.
fn account(body: &Body, to: &Moving, h: f32) -> [f32; 3] {
    let mass = 1.0 / body.inverse_mass;
    let [velocity, spin, omega] = [to.velocity() - body.velocity, to.spin() - body.spin, to.omega() - body.omega];
    let drift = if body.pressed == 0 { body.drift } else { glam::Vec3::ZERO };
    let work = dot(body.drive[0], body.velocity * h + drift) + dot(body.drive[1], body.omega) * h;
    let spare = body.blow.begun + work - body.vigour();
    let linear = dot(body.velocity, velocity) + 0.5 * (dot(body.omega, spin) + dot(omega, body.spin));
    let square = 0.5 * (dot(velocity, velocity) + dot(omega, spin));
    [spare, linear, square].map(|x| x * mass)
}

/// The share of a blow that gives no more than there is to spare.
fn share(&Blow { spare, linear, square, .. }: &Blow) -> f32 {
    let spare = max(spare, 0.0);
    if !(linear + square > spare) || !(square > 0.0) {
        return 1.0;
    }
    let root = sqrt(linear * linear + 4.0 * square * spare);
    max(min((root - linear) / (2.0 * square), 1.0), 0.0)
}
