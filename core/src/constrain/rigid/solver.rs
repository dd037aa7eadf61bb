//! What bodies that touch do to each other in a sub-step: impulses that hold them apart, and friction.

use super::body::Body;
use super::bound::{bound, take_back};
use super::facets::middle;
use super::manifold::{Manifold, Manifolds};
use super::moving::{self, Moving};
use super::order::Order;
use super::pass::Passes;
use super::span::{FAR, Span};
use super::stand::{Begin, HoldOn, Stand, Tell};
use crate::lanes::run_abreast;
use crate::math::{dot, max};
use glam::Vec3;

/// How fast two come together that may touch within a sub-step of `h` \[s\], driven as they were \[m/s\].
pub(super) fn meeting(bodies: &[Body], manifold: &Manifold, h: f32) -> Option<f32> {
    let [a, b] = manifold.bodies.map(|number| bodies.get(number as usize));
    let (a, b) = (a?, b?);
    if !(a.is_awake() || b.is_awake()) {
        return None;
    }
    let (normal, pull) =
        (a.rotation * manifold.normal, |body: &Body| if body.sleeps() { Vec3::ZERO } else { body.drive[0] });
    let driven = 2.0 * h * dot(pull(b) - pull(a), normal);
    let mut fastest = None;
    for point in manifold.points() {
        let spot = [a.point(point.places[0]), b.point(point.places[1])];
        let (gap, arms) = (dot(normal, spot[1] - spot[0]), [a, b].map(|body| middle(spot) - body.center));
        let parting = dot(b.velocity_at(arms[1]) - a.velocity_at(arms[0]) - point.surface, normal);
        if gap + (parting + driven) * h <= 0.0 {
            fastest = Some(fastest.map_or(-parting, |fastest| max(fastest, -parting)));
        }
    }
    fastest
}

/// Keeps all from passing into each other within the sub-step, by velocities, before they go: with what held them in the last one to begin with. Tells
/// whether any come to blows.
pub(super) fn keep_apart(bodies: &mut [Body], manifolds: &Manifolds<'_>, order: &mut Order<'_>, span: Span) -> bool {
    run_abreast(Begin { bodies, manifolds, order, span });
    moving::take(order.moving, bodies);
    if order.packs.iter().any(|pack| pack.blows != 0) {
        order.packs.iter_mut().for_each(|pack| pack.pressed_before = pack.pressed());
    }
    run_abreast(HoldOn { order });
    go_over(order);
    let struck = strike(bodies, order);
    if struck && bound(bodies, order, span) {
        take_back(bodies, order);
    }
    moving::tell(order.moving, bodies);
    for pack in order.packs.iter() {
        let pressed = pack.pressed();
        for lane in (0..pack.len()).filter(|lane| pressed >> lane & 1 != 0) {
            for side in 0..2 {
                if let Some(body) = bodies.get_mut(pack.bodies[side][lane] as usize) {
                    body.pressed = 1;
                }
            }
        }
    }
    struck
}

/// Marks those that have come to blows; tells whether any have.
fn strike(bodies: &mut [Body], order: &Order<'_>) -> bool {
    bodies.iter_mut().for_each(|body| body.bounces = 0);
    let mut struck = false;
    for pack in order.packs.iter().filter(|pack| pack.blows != 0) {
        let blows = pack.blows & pack.pressed();
        struck |= blows != 0;
        for lane in (0..pack.len()).filter(|lane| blows >> lane & 1 != 0) {
            for numbers in &pack.bodies {
                if let Some(body) = bodies.get_mut(numbers[lane] as usize) {
                    body.bounces = u32::from(body.moves());
                }
            }
        }
    }
    struck
}

/// Marks those that have turned far in the sub-step; tells whether any have. What impulses do to them is known of where they were, so that passes may
/// give energy.
fn whirl(bodies: &mut [Body], span: Span) -> bool {
    let mut whirls = false;
    for body in bodies.iter_mut().filter(|body| body.moves() && body.omega.dot(body.omega) * (span.h * span.h) > FAR) {
        (body.bounces, whirls) = (1, true);
    }
    whirls
}

/// Lets all part as they shall, when they have gone: what overlaps is no reason to, elasticity is. Notes what they have done. Some of
/// them may have been `struck` before they went.
pub(super) fn part(
    bodies: &mut [Body],
    manifolds: &mut Manifolds<'_>,
    order: &mut Order<'_>,
    (struck, span): (bool, Span),
) {
    let whirls = whirl(bodies, span);
    let bounces = run_abreast(Stand { bodies, order, span }) | struck | whirls;
    moving::take(order.moving, bodies);
    if bounces {
        order.packs.iter_mut().for_each(|pack| pack.pressed_before = pack.pressed());
    }
    go_over(order);
    if bounces {
        bound(bodies, order, span);
    }
    moving::tell(order.moving, bodies);
    run_abreast(Tell { manifolds, order });
}

/// Goes over all until they part as they shall, or as often as there is time for.
#[inline(never)]
fn go_over(order: &mut Order<'_>) {
    order.moving.iter_mut().for_each(Moving::begin);
    run_abreast(Passes { order });
}
