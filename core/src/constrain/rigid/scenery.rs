//! Where bodies meet the scene's colliders.

use super::super::Bodies;
use super::body::Body;
use super::forms::Forms;
use super::manifold::{DIRECTIONS, Manifold};
use super::span::FAR;
use super::visit::{ONE_FACE, SUNK, Visit};
use crate::math::{dot, length, max, min};
use crate::shape::{Aabb, Contact, Segment};
use glam::Vec3;

/// How near a body's middle may come to the scenery, as a share of the least of its half sides.
const CLOSE: f32 = 0.25;
/// How far forces drive a body in a sub-step at the most for that to make no difference to how far it is looked around it, as a share likewise.
const DRIVEN: f32 = 0.1;

/// Looks where a body touches the scenery, or will within two sub-steps, if it has gone far enough since the last time, or the scenery may have.
///
/// Its corners are asked for, as points: one that is beyond a surface, as seen from the body's middle, is met where the way there crosses it.
/// Then for each part of the scenery that is near the place where an edge or a face is nearest to it ([`Visit::scenery`]). A ball has no corners. Of
/// several pieces each is looked at so by itself.
pub(super) fn meet(
    bodies: &mut Bodies<'_>,
    body: &mut Body,
    forms: Forms<'_>,
    (number, may_move): (u32, bool),
    slots: &mut [Manifold],
) {
    let h = bodies.substep.seconds();
    let (way, small) = (body.speed() * h + driven(body, h), body.small());
    let is_new = bodies.substep.number == 0 || may_move;
    if !is_new && body.spare > way {
        body.spare -= way;
        return;
    }
    let about = |middle: Vec3, reach: f32| Aabb { min: middle - reach, max: middle + reach };
    let around = |reach: f32| about(body.middle(), reach + length(body.half));
    let reach = 2.0 * (small + way);
    let free = max(0.5 * body.radius, reach);
    if bodies.colliders.is_empty() || !bodies.colliders.may_touch(&around(free)) {
        clear(body, slots);
        body.spare = free - way;
        return;
    }
    if !bodies.colliders.may_touch(&around(reach)) {
        clear(body, slots);
        body.spare = small;
        return;
    }
    let Ok(&before) = <&[Manifold; DIRECTIONS]>::try_from(&*slots) else { return };
    clear(body, slots);
    let mut visit =
        Visit { body, forms, number, piece: 0, form: forms.piece(number, 0), slots, before, reach, is_on_round: false };
    let count = forms.count(number);
    for piece in 0..count {
        let form = forms.piece(number, piece);
        let near = about(form.middle(body), length(form.half(body)) + reach);
        if count > 1 && !bodies.colliders.may_touch(&near) {
            continue;
        }
        (visit.piece, visit.form) = (piece, form);
        (0..form.corners()).for_each(|corner| visit.corner(bodies, form.corner(body, corner)));
        visit.scenery(bodies);
    }
    // Slots are taken one after the other.
    let met = visit.slots.iter().filter(|slot| slot.count > 0).count() as u32;
    body.spare = if visit.is_on_round || is_carried(visit.slots) { 0.0 } else { small };
    body.met = met;
}

/// How far forces drive a body in a sub-step of `h` \[s\], if that is a good part of its size: it gets somewhere before it has been as fast \[m\].
fn driven(body: &Body, h: f32) -> f32 {
    let driven = length(body.drive[0]) * (h * h);
    if driven > DRIVEN * body.least() { driven } else { 0.0 }
}

/// Stops the middle of a body before the scenery that it would have gone through in a sub-step of `h` \[s\], or come close to. Corners are held by how fast they are as
/// it begins: where it turns far, or is driven far, they go elsewhere, and who has his middle behind a surface is held by nothing any more.
pub(super) fn hold_back(bodies: &Bodies<'_>, body: &mut Body, h: f32) {
    if driven(body, h) == 0.0 && body.omega.dot(body.omega) * (h * h) <= FAR {
        return;
    }
    let drift = if body.pressed == 0 { body.drift } else { Vec3::ZERO };
    let (way, close) = (body.velocity * h + drift, CLOSE * body.least());
    let far = length(way);
    if !(far > 0.0) {
        return;
    }
    let (from, to) = (body.center - way, body.center + way * (close / far));
    let path = Segment { from, to, radius: 0.0, during: bodies.substep.during };
    if !bodies.colliders.may_touch(&path.bounds()) {
        return;
    }
    if let Some(hit) = bodies.colliders.first_hit(&path) {
        let met = path.at(hit.time);
        let before = max(dot(hit.normal, path.from - met), 2.0 * hit.slack);
        let lack = min(before, close) - dot(hit.normal, body.center - met);
        if lack > 0.0 && lack < f32::INFINITY {
            body.center += hit.normal * lack;
        }
    }
}

/// Forgets what pressed on a body.
pub(super) fn clear(body: &mut Body, slots: &mut [Manifold]) {
    slots.iter_mut().take(body.met as usize).for_each(|slot| slot.count = 0);
    body.met = 0;
}

/// Tells whether the scenery moves at any place where a body touches it: what turns stands still on its axis.
fn is_carried(slots: &[Manifold]) -> bool {
    slots.iter().flat_map(Manifold::points).any(|point| point.surface != Vec3::ZERO)
}

/// The number of places of the scenery that are near a body; none if one of them moves, or one where it touches.
pub(super) fn faces(bodies: &Bodies<'_>, body: &Body, slots: &[Manifold]) -> Option<u32> {
    let (mut count, mut moves) = (0, is_carried(slots));
    if !bodies.colliders.is_empty() {
        let reach = length(body.half) + body.small();
        bodies.colliders.contacts(body.middle(), reach, bodies.substep.during[0], &mut |contact| {
            count += 1;
            moves |= contact.velocity != Vec3::ZERO;
        });
    }
    (!moves).then_some(count)
}

/// Tells whether the scenery still is where a body touches it, and at rest.
pub(super) fn holds(bodies: &Bodies<'_>, body: &Body, slots: &[Manifold]) -> bool {
    let (at, small) = (bodies.substep.during[0], body.small());
    slots.iter().all(|slot| {
        slot.points().iter().all(|point| {
            let (place, mut is_there) = (point.places[0], false);
            bodies.colliders.contacts(place, small, at, &mut |contact| {
                let aside = contact.point - place;
                is_there |= length(aside) <= (0.1 + SUNK) * small && contact.velocity == Vec3::ZERO;
            });
            is_there
        })
    })
}

impl Visit<'_> {
    /// Looks around a corner.
    fn corner(&mut self, bodies: &mut Bodies<'_>, place: Vec3) {
        let (middle, at, colliders) = (self.form.middle(self.body), bodies.substep.during[0], bodies.colliders);
        let point = self.body.point(place);
        let around = Aabb { min: middle.min(point) - self.reach, max: middle.max(point) + self.reach };
        if !colliders.may_touch(&around) {
            return;
        }
        let path = Segment { from: middle, to: point, radius: 0.0, during: [at, at] };
        if let Some(hit) = colliders.first_hit(&path) {
            let met = path.at(hit.time);
            if self.is_past(bodies, &path, (met, hit.normal)) {
                return;
            }
            let floor = Contact {
                point: met,
                normal: hit.normal,
                distance: 0.0,
                slack: hit.slack,
                velocity: hit.velocity,
                material: hit.material,
                face: hit.face,
            };
            self.put(bodies, &floor, place);
            // From before it other faces are seen.
            return self.beside(bodies, (place, path.at(0.9 * hit.time)), &floor);
        }
        let (mut floor, mut count) = (None::<Contact>, 0);
        colliders.contacts(point, self.reach, at, &mut |contact| {
            count += 1;
            if floor.is_none_or(|floor| contact.distance < floor.distance) {
                floor = Some(*contact);
            }
        });
        let Some(mut floor) = floor else { return };
        // Nothing is between the middle and it, but rounding may have put it behind what it lies on.
        if floor.distance <= 2.0 * floor.slack && dot(floor.normal, middle - floor.point) < 0.0 {
            floor.normal = -floor.normal;
        }
        self.put_near(bodies, &floor, place);
        if count > 1 {
            self.beside(bodies, (place, point + floor.normal * (0.5 * self.reach)), &floor);
        }
    }

    /// Tells whether a corner that is deep beyond a place, as seen from the middle, has come out of the scenery again on the other side: what is thin lies across
    /// edges or faces there.
    fn is_past(&self, bodies: &Bodies<'_>, path: &Segment, (met, normal): (Vec3, Vec3)) -> bool {
        let back = Segment { from: path.to, to: path.from, ..*path };
        dot(normal, met - path.to) > self.reach
            && bodies.colliders.first_hit(&back).is_some_and(|hit| length(back.at(hit.time) - met) > self.level())
    }

    /// Looks for other faces around a corner that a floor is next to, from somewhat above that: what rises no higher than it is a seam or an edge of the
    /// floor itself, on which nothing catches.
    fn beside(&mut self, bodies: &mut Bodies<'_>, (place, from): (Vec3, Vec3), floor: &Contact) {
        let reach = self.reach + length(from - self.body.point(place));
        let (mut others, mut left_out, level) = (heapless::Vec::<Contact, 8>::new(), 0, self.level());
        bodies.colliders.contacts(from, reach, bodies.substep.during[0], &mut |contact| {
            let rises = dot(floor.normal, contact.point - floor.point);
            if dot(floor.normal, contact.normal) > ONE_FACE || rises.abs() > level {
                left_out += u64::from(others.push(*contact).is_err());
            }
        });
        bodies.report.caps.contacts += left_out;
        for contact in &others {
            self.put_near(bodies, contact, place);
        }
    }

    /// Adds a place if it is within reach.
    fn put_near(&mut self, bodies: &mut Bodies<'_>, contact: &Contact, place: Vec3) {
        if dot(contact.normal, self.body.point(place) - contact.point) <= self.reach {
            self.put(bodies, contact, place);
        }
    }
}

/// How far a body may go before the lists are made anew \[m\], if that shall last for some time: who sleeps goes nowhere, and those around it that
/// do not touch it are left out of the lists until it wakes. Lists of what has `many` pieces last for less: each has several neighbours.
pub(super) fn max_travel(body: &Body, many: bool, seconds: f32) -> f32 {
    let share = match (body.sleeps(), many) {
        (true, _) => 0.02,
        (_, true) => 0.05,
        _ => 0.25,
    };
    share * max(min(body.radius, f32::MAX), 0.0) + 0.5 * body.speed() * seconds
}
