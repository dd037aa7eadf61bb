//! A body that looks around in the scenery, and the places where it touches that.

use super::super::Bodies;
use super::body::Body;
use super::facets::{Spot, Spots, four, push};
use super::forms::{Form, Forms};
use super::manifold::{DIRECTIONS, Manifold, POINTS, Point};
use crate::material::on_surface;
use crate::math::{dot, length, max, min};
use crate::shape::{Contact, Segment};
use glam::{Mat3, Vec3};

/// The cosine of the angle within which two faces are one.
pub(super) const ONE_FACE: f32 = 0.9999;
/// The cosine of the angle within which a corner of the scenery presses no otherwise than a corner of the body.
pub(super) const ALIKE: f32 = 0.9;
/// How much higher than the deepest a place is that holds a body least, as a share of the least of its half sides.
const HIGH: f32 = 0.25;
/// How deep a body may be in the scenery where it is first seen there, at the most, as a share of a length that is small beside it; and from which share on that
/// is more than rounding.
pub(super) const SUNK: f32 = 0.5;
const NOTED: f32 = 0.005;

/// A body among the scenery, and which of its pieces is looked at.
pub(super) struct Visit<'a> {
    pub(super) body: &'a Body,
    pub(super) forms: Forms<'a>,
    pub(super) number: u32,
    pub(super) piece: u8,
    pub(super) form: Form<'a>,
    pub(super) slots: &'a mut [Manifold],
    pub(super) before: [Manifold; DIRECTIONS],
    pub(super) reach: f32,
    /// True if it is on something round, where places move as it turns.
    pub(super) is_on_round: bool,
}

impl Visit<'_> {
    /// Two places are level that are no farther apart than this \[m\].
    pub(super) fn level(&self) -> f32 {
        0.25 * self.body.small()
    }

    /// Adds a place, to the points on the same face if there are any.
    pub(super) fn put(&mut self, bodies: &mut Bodies<'_>, contact: &Contact, place: Vec3) {
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
