//! Who sleeps stays where it is, as long as forces do to its particles what they did when it fell asleep.

use super::super::Bodies;
use super::RigidBox;
use super::body::{Body, Made};
use super::lists::Kept;
use super::sleep::{ALIKE, STIRRED};
use crate::lanes::widest;
use crate::math::{length, min};
use core::ops::Range;
use glam::Vec3;

/// Lets all that sleep lie where they are, and marks those that are driven otherwise than when they fell asleep; tells whether there are any.
///
/// Those next to each other are looked at as one: a heap that sleeps is a few columns of numbers.
pub(super) fn lie(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, boxes: &[RigidBox]) -> bool {
    let (mut is_stirred, mut number, mut place) = (false, 0, 0);
    while number < boxes.len() {
        let sleeps = |i: usize| kept.bodies.get(i + 1).is_some_and(Body::sleeps);
        if !sleeps(number) {
            place += 3 * boxes[number].count as usize;
            number += 1;
            continue;
        }
        let follows = |i: usize| boxes[i - 1].first.checked_add(boxes[i - 1].count) == Some(boxes[i].first);
        let mut end = number + 1;
        while end < boxes.len() && sleeps(end) && follows(end) {
            end += 1;
        }
        let (some, all) = (&boxes[number..end], &mut kept.bodies[number + 1..=end]);
        let len = some.iter().map(|of| 3 * of.count as usize).sum::<usize>();
        let mut places = kept.places.get(place..place + len).unwrap_or_default();
        if end == number + 1 || !lie_together(bodies, all, some, places) {
            for (body, of) in all.iter_mut().zip(some) {
                let (own, rest) = places.split_at((3 * of.count as usize).min(places.len()));
                places = rest;
                if !body.lies(bodies, Made { of, places: own }) {
                    body.calls |= STIRRED;
                    is_stirred = true;
                }
            }
        }
        (number, place) = (end, place + len);
    }
    is_stirred
}

/// Lets the particles of some bodies lie where they are, if they are one behind the other and forces do the same to all; tells whether that is so.
fn lie_together(bodies: &mut Bodies<'_>, all: &[Body], boxes: &[RigidBox], mut places: &[u32]) -> bool {
    let Some(first) = boxes.first() else { return false };
    let count = boxes.iter().fold(0u32, |sum, of| sum.saturating_add(of.count));
    let Some(rows) = (Made { of: &RigidBox { count, ..*first }, places }).run(bodies) else { return false };
    let h = bodies.substep.seconds();
    let Some(&change) = bodies.velocity.get(rows.start) else { return false };
    let (mut row, mut far) = (rows.start, f32::INFINITY);
    for (body, of) in all.iter().zip(boxes) {
        let (own, rest) = places.split_at((3 * of.count as usize).min(places.len()));
        let own_rows = row..row + of.count as usize;
        // Between steps others may have moved them.
        let is_there = bodies.substep.number > 0 || body.is_where_told(bodies, Made { of, places: own }, &own_rows);
        if !(is_there && body.is_driven_so(change, h)) {
            return false;
        }
        (places, row, far) = (rest, own_rows.end, min(far, length(body.drive[0]) * h * h));
    }
    put_back(bodies, rows, change, far)
}

/// Puts particles back to where they began the sub-step, at rest, if forces have changed the velocity of each of them so, and the method has
/// moved them no farther beyond that than `far` \[m\] along each axis: half of what may be, so that the whole of it is no farther. Tells whether
/// that is so.
fn put_back(bodies: &mut Bodies<'_>, rows: Range<usize>, change: Vec3, far: f32) -> bool {
    let h = bodies.substep.seconds();
    let [from, still] = bodies.before.map(|column| &column[rows.clone()]);
    let (to, velocities) = (&bodies.position[rows.clone()], &bodies.velocity[rows.clone()]);
    let all = [from, still, to, velocities].map(bytemuck::cast_slice);
    if !widest(
        #[inline(always)]
        || falls_evenly(all, change, h, far),
    ) {
        return false;
    }
    bodies.position[rows.clone()].copy_from_slice(from);
    bodies.velocity[rows.clone()].fill(Vec3::ZERO);
    rows.for_each(|row| bodies.mark_followed(row));
    true
}

impl Body {
    /// Tells whether its particles, in these rows, began the sub-step where it says.
    fn is_where_told(&self, bodies: &Bodies<'_>, made: Made<'_>, rows: &Range<usize>) -> bool {
        let before = bodies.before[0].get(rows.clone()).unwrap_or_default();
        let places = made.places.as_chunks().0.iter().map(|&[x, y, z]| Vec3::from_array([x, y, z].map(f32::from_bits)));
        places.zip(before).fold(true, |all, (place, &from)| all & (self.point(place) == from))
    }

    /// Tells whether forces drive it as they did when it fell asleep, if they change the velocity of each of its particles so in `h` \[s\].
    fn is_driven_so(&self, change: Vec3, h: f32) -> bool {
        let size = length(self.drive[0]);
        length(change * (1.0 / h) - self.drive[0]) <= ALIKE * size
            && length(self.drive[1]) <= ALIKE * size * self.radius
    }

    /// Lets its particles lie where they are, in these rows, if forces do the same to all of them as when it fell asleep: they are put back to where
    /// they began the sub-step. Tells whether that is so.
    fn lies_evenly(&self, bodies: &mut Bodies<'_>, rows: Range<usize>) -> bool {
        let (h, size) = (bodies.substep.seconds(), length(self.drive[0]));
        let Some(&change) = bodies.velocity.get(rows.start) else { return false };
        self.is_driven_so(change, h) && put_back(bodies, rows, change, size * h * h)
    }

    /// Lets its particles lie where they are while it sleeps; tells whether that is so. What does otherwise to them than when it fell asleep
    /// wakes it.
    fn lies(&mut self, bodies: &mut Bodies<'_>, made: Made<'_>) -> bool {
        // Between steps others may have moved them.
        let rows = made.run(bodies).filter(|rows| bodies.substep.number > 0 || self.is_where_told(bodies, made, rows));
        if rows.is_some_and(|rows| self.lies_evenly(bodies, rows)) {
            return true;
        }
        let mut probe = *self;
        probe.gather(bodies, made);
        let [push, torque] = [0, 1].map(|k| length(probe.drive[k] - self.drive[k]));
        let (size, h) = (length(self.drive[0]), bodies.substep.seconds());
        let is_alike = push <= ALIKE * size && torque <= ALIKE * size * self.radius;
        if is_alike && length(probe.drift) <= 2.0 * size * h * h {
            self.tell(bodies, made);
            return true;
        }
        false
    }
}

/// Tells whether all particles have begun a sub-step of `h` \[s\] at rest, have the same velocity now, and have not gone so far from where that leads
/// along any axis. The columns' numbers go through it one like the other, eight particles at a time.
#[inline(always)]
fn falls_evenly([from, still, to, velocities]: [&[f32]; 4], velocity: Vec3, h: f32, far: f32) -> bool {
    const WIDE: usize = 24;
    let velocity: [f32; WIDE] = core::array::from_fn(|k| velocity[k % 3]);
    let mut wrongs = [0; WIDE];
    let [from, still, to, now] = [from, still, to, velocities].map(<[f32]>::as_chunks::<WIDE>);
    for ((from, still), (to, now)) in from.0.iter().zip(still.0).zip(to.0.iter().zip(now.0)) {
        for k in 0..WIDE {
            wrongs[k] |= wrong([from[k], still[k], to[k], now[k]], velocity[k], h, far);
        }
    }
    let rest = from.1.iter().zip(still.1).zip(to.1.iter().zip(now.1)).zip(velocity);
    let is_wrong =
        rest.fold(0, |all, (((&from, &still), (&to, &now)), v)| all | wrong([from, still, to, now], v, h, far));
    wrongs.iter().fold(is_wrong, |all, wrong| all | wrong) == 0
}

/// Zero if a coordinate is as it has to be.
#[inline(always)]
fn wrong([from, still, to, now]: [f32; 4], velocity: f32, h: f32, far: f32) -> u32 {
    let (other, drift) = (now.to_bits() ^ velocity.to_bits(), to - from - now * h);
    other | still.to_bits() << 1 | u32::from(!(drift.abs() <= far))
}
