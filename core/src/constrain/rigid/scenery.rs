//! Where bodies meet the scene's colliders.

use super::super::Bodies;
use super::body::Body;
use super::closest::{Near, Over};
use super::facets::{Spot, Spots, four, push};
use super::forms::{Form, Forms};
use super::manifold::{DIRECTIONS, Manifold, POINTS, Point};
use super::skin;
use super::span::FAR;
use crate::material::on_surface;
use crate::math::{dot, length, max, min};
use crate::shape::{Aabb, Contact, Segment, Surface, Triangle};
use glam::{Mat3, Vec3};

/// How near a body's middle may come to the scenery, as a share of the least of its half sides.
const CLOSE: f32 = 0.25;
/// How far forces drive a body in a sub-step at the most for that to make no difference to how far it is looked around it, as a share likewise.
const DRIVEN: f32 = 0.1;
/// How much higher than the deepest a place is that holds a body least, as a share likewise.
const HIGH: f32 = 0.25;
/// Parts of the scenery that a piece may touch elsewhere than by its corners, at the most.
const PARTS: usize = 16;
/// Triangles of a mesh that are one of them, at the most.
const FACES: usize = 12;
/// Bodies so many times as long as they are thick are looked at in parts where they lie on much, so many at the most along each side.
const SLENDER: f32 = 4.0;
const SPANS: f32 = 8.0;
/// The cosine of the angle within which two faces are one.
const ONE_FACE: f32 = 0.9999;
/// How far from a place of the scenery another is at the most that is nearer to what is above it, as a share of how high that is.
const WITHIN: f32 = 0.9;
/// The cosine of the angle within which a corner of the scenery presses no otherwise than a corner of the body.
const ALIKE: f32 = 0.9;
/// How deep a body may be in the scenery where it is first seen there, at the most, as a share of a length that is small beside it; and from which share on that
/// is more than rounding.
const SUNK: f32 = 0.5;
const NOTED: f32 = 0.005;

/// A part of the scenery that is near a piece: something convex, or the triangles of a mesh around an edge or a corner that is nearest of all of them to the
/// piece's middle.
struct Part {
    contact: Contact,
    /// How far that is from the piece \[m\].
    far: f32,
    faces: heapless::Vec<u32, FACES>,
}

impl Part {
    /// Tells whether another place of the scenery is this one, but for so much \[m\].
    fn is_at(&self, other: &Contact, much: f32) -> bool {
        let own = &self.contact;
        let is_alike = own.material == other.material && own.velocity == other.velocity;
        is_alike && length(own.point - other.point) <= much && dot(own.normal, other.normal) > ONE_FACE
    }
}

/// A body among the scenery, and which of its pieces is looked at.
struct Visit<'a> {
    body: &'a Body,
    forms: Forms<'a>,
    number: u32,
    piece: u8,
    form: Form<'a>,
    slots: &'a mut [Manifold],
    before: [Manifold; DIRECTIONS],
    reach: f32,
    /// True if it is on something round, where places move as it turns.
    is_on_round: bool,
}

/// Looks where a body touches the scenery, or will within two sub-steps, if it has gone far enough since the last time, or the scenery may have.
///
/// Its corners are asked for, as points: one that is beyond a surface, as seen from the body's middle, is met where the way there crosses it.
/// Then for each part of the scenery that is near the place where an edge or a face is nearest to it ([`Over::closest`]). A ball has no corners. Of
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

    /// Two places are level that are no farther apart than this \[m\].
    fn level(&self) -> f32 {
        0.25 * self.body.small()
    }

    /// Adds a place if it is within reach.
    fn put_near(&mut self, bodies: &mut Bodies<'_>, contact: &Contact, place: Vec3) {
        if dot(contact.normal, self.body.point(place) - contact.point) <= self.reach {
            self.put(bodies, contact, place);
        }
    }

    /// Looks for the places of the scenery that come nearest to the body's edges and faces.
    fn scenery(&mut self, bodies: &mut Bodies<'_>) {
        let (middle, half) = (self.form.middle(self.body), self.form.half(self.body));
        let (parts, left_out) = self.parts(bodies, (middle, half));
        let lengths = spans(half);
        if left_out == 0 || lengths == [1; 3] {
            bodies.report.caps.contacts += left_out;
            parts.iter().for_each(|part| self.part(bodies, part));
            return;
        }
        // What is long or wide lies on more than there is room for at a time.
        let span = half / Vec3::from(lengths.map(f32::from));
        for number in 0..lengths.iter().product() {
            let [x, y, z] = [number % lengths[0], number / lengths[0] % lengths[1], number / lengths[0] / lengths[1]];
            let place = span * (Vec3::from([x, y, z].map(f32::from)) * 2.0 + 1.0) - half;
            let (parts, left_out) = self.parts(bodies, (middle + self.body.rotation * place, span));
            bodies.report.caps.contacts += left_out;
            parts.iter().for_each(|part| self.part(bodies, part));
        }
    }

    /// The parts of the scenery that the piece may touch elsewhere than by its corners, near the box around it or a part of that, told by its middle and half its
    /// sides: of more than there is room for the nearest. Counts those that are left out.
    fn parts(&self, bodies: &Bodies<'_>, (middle, half): (Vec3, Vec3)) -> (heapless::Vec<Part, PARTS>, u64) {
        let (body, colliders, at) = (self.body, bodies.colliders, bodies.substep.during[0]);
        let over = Over { form: &self.form, body, colliders, at, faces: &[] };
        let (mut parts, mut left_out) = (heapless::Vec::<Part, PARTS>::new(), 0);
        colliders.contacts(middle, length(half) + self.reach, at, &mut |contact| {
            if over.gap(contact) > self.reach || self.is_stood_on(contact) {
                return;
            }
            if let Some(part) = parts.iter_mut().find(|part| part.is_at(contact, 0.1 * self.level())) {
                left_out += u64::from(part.faces.push(contact.face).is_err());
                return;
            }
            let (.., out) = self.form.nearest(body, body.place(contact.point));
            // Of those within it the nearest to its middle come first.
            let far = out + 0.1 * contact.distance;
            let faces = heapless::Vec::from_iter([contact.face]);
            if let Err(one) = parts.push(Part { far, contact: *contact, faces }) {
                left_out += 1;
                let farthest = parts.iter_mut().reduce(|most, other| if other.far > most.far { other } else { most });
                if let Some(most) = farthest.filter(|most| one.far < most.far) {
                    *most = one;
                }
            }
        });
        (parts, left_out)
    }

    /// Looks for the place of one of them that comes nearest to the piece.
    fn part(&mut self, bodies: &mut Bodies<'_>, part: &Part) {
        let (body, at) = (self.body, bodies.substep.during[0]);
        let over = Over { form: &self.form, body, colliders: bodies.colliders, at, faces: &part.faces };
        let Some(mut near) = over.closest(part.contact, self.reach) else { return };
        if near.turned && spans(self.form.half(body)) != [1; 3] && self.is_seam(bodies, &near.contact) {
            let Some(other) = self.beyond(bodies, &near.contact) else { return };
            near = other;
        }
        let Near { contact, on, depth, turned } = near;
        let normal = if turned { self.face(on, contact.normal) } else { contact.normal };
        let out = body.rotation.transpose() * -normal;
        if !skin::shows(self.forms, body, (self.number, self.piece), [on, out])
            || turned && self.is_seam(bodies, &contact)
        {
            return;
        }
        let Some(normal) = self.support(&contact, on, (normal, turned)) else { return };
        self.is_on_round |= turned;
        self.put(bodies, &Contact { normal, ..contact }, on);
        let facing = self.form.facing(out);
        // Four points bear a face, and further ones would only take their places.
        let mut alike = self.slots.iter().filter(|slot| dot(slot.normal, normal) > ALIKE);
        if dot(facing, out) > ALIKE && !alike.any(|slot| slot.count as usize == POINTS) {
            self.rims(bodies, body.rotation * -facing, [on, facing], depth);
        }
    }

    /// The place nearest to the piece of all triangles that meet at a place of the scenery: what is long lies across a ridge near the end of one of them, over which
    /// that one alone would let it by.
    fn beyond(&self, bodies: &Bodies<'_>, end: &Contact) -> Option<Near> {
        let (body, colliders, at) = (self.body, bodies.colliders, bodies.substep.during[0]);
        let mut faces = heapless::Vec::<u32, FACES>::new();
        colliders.contacts(end.point, 0.1 * self.level(), at, &mut |contact| {
            // What finds no room is no part of it.
            let _ = faces.push(contact.face);
        });
        Over { form: &self.form, body, colliders, at, faces: &faces }.closest(*end, self.reach)
    }

    /// Tells whether corners do all that a flat face of the scenery would: who stands on four hangs over nothing.
    fn is_stood_on(&self, contact: &Contact) -> bool {
        self.slots.iter().any(|slot| slot.count as usize == POINTS && self.is_level(slot, contact))
    }

    /// Tells whether a place of the body is between points on a face.
    fn is_between(&self, slot: &Manifold, on: Vec3) -> bool {
        let points = slot.points();
        let at = |i: usize| points.get(i).or(points.last()).map_or(on, |point| point.places[1]);
        let corners = Triangle { corners: [at(0), at(1), at(2)] };
        points.len() == POINTS || length(corners.nearest(on) - on) <= self.level()
    }

    /// Tells whether the scenery goes on beyond a place no lower than across a normal there: what comes from that side meets the scenery there by a corner only, if
    /// at all, as where triangles of a floor end on each other, or in a valley.
    fn is_seam(&self, bodies: &Bodies<'_>, contact: &Contact) -> bool {
        let (away, mut is_seam) = (self.body.small(), false);
        bodies.colliders.contacts(
            contact.point + contact.normal * away,
            away,
            bodies.substep.during[0],
            &mut |other| {
                let aside = length(other.point - contact.point);
                is_seam |= aside < WITHIN * away && dot(other.normal, contact.normal) < ONE_FACE;
            },
        );
        is_seam
    }

    /// The normal of the body's surface at a place on it where the scenery's is so, as that presses on it: that of a face, or across an edge.
    fn face(&self, on: Vec3, normal: Vec3) -> Vec3 {
        let out = self.body.rotation.transpose() * -normal;
        let (_, out, _) = self.form.nearest(self.body, on + out * (0.1 * self.body.small()));
        self.body.rotation * -out
    }

    /// Tells whether a place of the scenery is level with a face on which the body stands, and hangs over nowhere: such an edge is a seam.
    fn is_level(&self, slot: &Manifold, contact: &Contact) -> bool {
        let (ground, normal) = (slot.points[0].places[0], slot.normal);
        let lowest = self.body.point(self.form.farthest(self.body, -(self.body.rotation.transpose() * normal)));
        let below = |place: Vec3| dot(normal, place - lowest);
        let feet = slot.points().iter().map(|point| below(self.body.point(point.places[1])));
        dot(normal, contact.point - ground).abs() <= self.level() && feet.fold(f32::INFINITY, min) <= self.level()
    }

    /// The normal along which the scenery presses on a place of the body: its own, if it has `turned` and is another than the one seen from the middle, or that of
    /// corners on a face alike; none, if corners do all that it would.
    fn support(&self, contact: &Contact, on: Vec3, (normal, turned): (Vec3, bool)) -> Option<Vec3> {
        let mut slots = self.slots.iter().filter(|slot| slot.count > 0);
        if let Some(slot) = slots.clone().find(|slot| dot(slot.normal, normal) > ALIKE) {
            let is_known = slot.points().iter().any(|point| length(point.places[1] - on) <= self.level());
            // Who stands on fewer feet may hang over an edge beyond them.
            let is_met = is_known || self.is_level(slot, contact) && self.is_between(slot, on);
            return (!is_met).then_some(if turned { normal } else { slot.normal });
        }
        // Corners stand on that very face, or on one that ends there.
        let is_met = slots.any(|slot| dot(slot.normal, contact.normal) > ONE_FACE || self.is_level(slot, contact));
        (!is_met).then_some(normal)
    }

    /// Looks for further places of the scenery on a face of the body, with a place in it and its normal: those nearest to the body's corners. What hangs over
    /// an edge lies on that from one end to the other.
    fn rims(&mut self, bodies: &mut Bodies<'_>, normal: Vec3, [inside, out]: [Vec3; 2], depth: f32) {
        let (body, at, above_it) = (self.body, bodies.substep.during[0], self.reach);
        let (reach, far, level) = (above_it + 2.0 * depth, 2.0 * length(self.form.half(body)), self.level());
        for corner in 0..self.form.corners() {
            let corner = self.form.corner(body, corner);
            // Corners of other faces see what is farther from this one, and those that lie on something see that.
            let lies = self.slots.iter().flat_map(Manifold::points).any(|point| point.places[1] == corner);
            if lies || dot(corner - inside, out).abs() > self.reach {
                continue;
            }
            // From within the body walls beside it are met higher up.
            let from = |place: Vec3| body.point(place - out * (2.0 * reach));
            let under = |contact: &Contact| {
                let place = body.place(contact.point);
                let above = dot(place - inside, out);
                (above <= above_it && -above <= reach).then_some(place - out * above)
            };
            let (mut rims, mut left_out) = (heapless::Vec::<(Contact, Vec3), 8>::new(), 0);
            bodies.colliders.contacts(from(corner), far, at, &mut |contact| {
                let Some(on) = under(contact) else { return };
                let (rim, _, beyond) = self.form.nearest(body, on);
                // Who lies on what goes on beyond him lies on it up to where his face ends.
                let end = (beyond > level).then(|| self.nearer(bodies, contact, from(rim), far));
                let contact = Contact { normal, ..end.unwrap_or(*contact) };
                if let Some(on) = under(&contact).filter(|&on| self.form.nearest(body, on).2 <= level) {
                    left_out += u64::from(rims.push((contact, on)).is_err());
                }
            });
            bodies.report.caps.contacts += left_out;
            for (contact, on) in &rims {
                if !self.is_seam(bodies, contact) {
                    self.put(bodies, contact, *on);
                }
            }
        }
    }

    /// The place of the same part of the scenery that is nearest to a place within so far \[m\] of it.
    fn nearer(&self, bodies: &Bodies<'_>, contact: &Contact, to: Vec3, far: f32) -> Contact {
        let (mut nearer, mut least) = (*contact, f32::INFINITY);
        bodies.colliders.contacts_of(&[contact.face], to, far, bodies.substep.during[0], &mut |other| {
            let aside = length(other.point - contact.point);
            if aside < least {
                (nearer, least) = (*other, aside);
            }
        });
        nearer
    }

    /// Adds a place, to the points on the same face if there are any.
    fn put(&mut self, bodies: &mut Bodies<'_>, contact: &Contact, place: Vec3) {
        let Contact { point, normal, .. } = *contact;
        // Where it is over the surface, whatever the way on which that was met.
        let over = self.body.point(place);
        let gap = dot(normal, over - point);
        let (on, level, small) = (over - normal * gap, self.level(), self.body.small());
        let Some(number) = self.slot(bodies, contact).or_else(|| self.give_way(bodies, contact, gap)) else { return };
        let Some(slot) = self.slots.get_mut(number) else { return };
        if slot.points().iter().any(|other| length(other.places[1] - place) <= level) {
            return;
        }
        let near = |slot: &&Manifold| slot.count > 0 && dot(slot.normal, normal) > ALIKE;
        let known = self.before.iter().find(near);
        let before = known.map_or(&[][..], Manifold::points);
        if let Some(known) = known.filter(|known| slot.count == 0 && known.friction == slot.friction) {
            slot.grip = known.grip;
        }
        if slot.count as usize >= POINTS && !make_room(slot, self.body, [on, over]) {
            return;
        }
        // What moves comes to where others were.
        let depth = if contact.velocity == Vec3::ZERO { -gap } else { 0.0 };
        let on = on - normal * sunk(&self.before, (on, normal), place, (depth, small));
        slot.put([on, place], before, 0.0, &Mat3::IDENTITY);
        if let Some(point) = slot.points.get_mut(slot.count as usize - 1) {
            point.surface = mean_velocity(bodies, contact, small);
            point.lift = dot(point.surface, slot.normal);
        }
    }

    /// The number of the slot of a face: of its normal, and of what moves as the first place there does or feels like it; a free one if there is none; and
    /// where none is left, that whose normal is most alike and that feels like it.
    fn slot(&mut self, bodies: &Bodies<'_>, contact: &Contact) -> Option<usize> {
        let Contact { normal, velocity, material, .. } = *contact;
        let own = (self.body.material as u16).checked_sub(1);
        let fresh = || {
            let mixed = on_surface(bodies.materials, self.body.elasticity, own, material);
            Manifold { normal, ..Manifold::of(([0, self.number], [0; 2]), mixed) }
        };
        let is_like = |slot: &Manifold| {
            let fresh = fresh();
            slot.friction == fresh.friction && slot.elasticity == fresh.elasticity
        };
        let on = |slot: &Manifold| {
            slot.count > 0
                && dot(slot.normal, normal) > ONE_FACE
                && (slot.points[0].surface == velocity || is_like(slot))
        };
        if let Some(number) = self.slots.iter().position(on) {
            return Some(number);
        }
        if let Some(number) = self.slots.iter().position(|slot| slot.count == 0) {
            self.slots[number] = fresh();
            return Some(number);
        }
        // What is rough presses in more directions than there is room for.
        let mut best = (None, ALIKE);
        for (number, slot) in self.slots.iter().enumerate().filter(|(_, slot)| is_like(slot)) {
            let along = dot(slot.normal, normal);
            best = if along > best.1 { (Some(number), along) } else { best };
        }
        best.0
    }

    /// The number of the slot of a face that is left out for another with a gap, if it is farther from the body: of more faces than there are
    /// slots the deepest count, for what is left out the body sinks into, and beyond its middle it would be pressed out on the other side.
    fn give_way(&mut self, bodies: &mut Bodies<'_>, contact: &Contact, gap: f32) -> Option<usize> {
        bodies.report.caps.contacts += 1;
        let (body, mut farthest) = (self.body, (0, f32::NEG_INFINITY));
        for (number, slot) in self.slots.iter().enumerate() {
            let gaps =
                slot.points().iter().map(|point| dot(slot.normal, body.point(point.places[1]) - point.places[0]));
            let least = gaps.fold(f32::INFINITY, min);
            if least > farthest.1 {
                farthest = (number, least);
            }
        }
        let (number, least) = farthest;
        if !(gap < least) {
            return None;
        }
        self.slots[number].count = 0;
        self.slot(bodies, contact)
    }
}

/// Into how many parts something is divided along each of its sides, of which these are half, if it is many times as long or wide as it is thick.
fn spans(half: Vec3) -> [u8; 3] {
    let least = min(half.x, min(half.y, half.z));
    half.to_array().map(|half| (half / (SLENDER * least)).clamp(1.0, SPANS) as u8)
}

/// Leaves out one of four points on a face for another spot; tells whether it is not that which holds the body least: the highest if it is much higher than
/// the deepest, as where a body comes down fast. What has more corners or feet there stands on those that are farthest from each other, and rocks on the deepest.
#[inline(never)]
fn make_room(slot: &mut Manifold, body: &Body, spot: Spot) -> bool {
    let mut spots = Spots::new();
    let at = |point: &Point| [point.places[0], body.point(point.places[1])];
    slot.points().iter().for_each(|point| push(&mut spots, at(point)));
    push(&mut spots, spot);
    let gap = |[on, over]: &Spot| dot(slot.normal, *over - *on);
    let [least, most] =
        spots.iter().map(gap).fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| [min(a, x), max(b, x)]);
    let is_uneven = most - least > HIGH * body.least();
    let best = four(slot.normal, &spots);
    let stays = |spot: Spot| if is_uneven { gap(&spot) < most } else { best.contains(&spot) };
    let (mut kept, mut count) = (slot.points, 0);
    for point in slot.points().iter().filter(|point| stays(at(point))) {
        kept[count] = *point;
        count += 1;
    }
    let is_room = count < POINTS;
    if is_room {
        (slot.points, slot.count) = (kept, count as u32);
    }
    is_room
}

/// How far a body stays in the scenery at a place of it \[m\], of so much: as far as it was when that was first seen. What lies across edges is seen now at one place,
/// now at another, and would be lifted each time.
fn sunk(before: &[Manifold], (on, normal): (Vec3, Vec3), place: Vec3, (depth, small): (f32, f32)) -> f32 {
    let least = NOTED * small;
    if !(depth > least) {
        return 0.0;
    }
    let alike = before.iter().filter(|slot| dot(slot.normal, normal) > ALIKE);
    let known = alike.flat_map(Manifold::points).find(|point| length(point.places[1] - place) <= 0.25 * small);
    let sunk = known.map_or(depth, |point| min(depth, dot(normal, on - point.places[0])));
    if sunk > least { min(sunk, SUNK * small) } else { 0.0 }
}

/// The mean velocity in the sub-step of what the scenery has at a contact \[m/s\]: what turns leads on along its arc.
fn mean_velocity(bodies: &Bodies<'_>, contact: &Contact, small: f32) -> Vec3 {
    let Contact { point, normal, velocity, .. } = *contact;
    if velocity == Vec3::ZERO {
        return velocity;
    }
    let way = normal * small;
    let seat = Segment { from: point + way, to: point - way, radius: 0.0, during: bodies.substep.during };
    let change = bodies.colliders.ride(&seat).map_or(Vec3::ZERO, |ride| ride.velocity[1] - ride.velocity[0]);
    velocity + change * 0.5
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
