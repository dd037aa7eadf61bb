//! Which parts of the scenery a piece of a body touches elsewhere than by its corners: by edges and faces.

use super::super::Bodies;
use super::closest::{Near, Over};
use super::manifold::{Manifold, POINTS};
use super::skin;
use super::visit::{ALIKE, ONE_FACE, Visit};
use crate::math::{dot, length, min};
use crate::shape::{Contact, Surface, Triangle};
use glam::Vec3;

/// Parts of the scenery that a piece may touch elsewhere than by its corners, at the most.
const PARTS: usize = 16;
/// Triangles of a mesh that are one of them, at the most.
const FACES: usize = 12;
/// Bodies so many times as long as they are thick are looked at in parts where they lie on much, so many at the most along each side.
const SLENDER: f32 = 4.0;
const SPANS: f32 = 8.0;
/// How far from a place of the scenery another is at the most that is nearer to what is above it, as a share of how high that is.
const WITHIN: f32 = 0.9;

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

impl Visit<'_> {
    /// Looks for the places of the scenery that come nearest to the body's edges and faces.
    pub(super) fn scenery(&mut self, bodies: &mut Bodies<'_>) {
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
}

/// Into how many parts something is divided along each of its sides, of which these are half, if it is many times as long or wide as it is thick.
fn spans(half: Vec3) -> [u8; 3] {
    let least = min(half.x, min(half.y, half.z));
    half.to_array().map(|half| (half / (SLENDER * least)).clamp(1.0, SPANS) as u8)
}
