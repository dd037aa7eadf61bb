//! Who sleeps stays where it is, as long as forces do to its particles what they did when it fell asleep.

use super::super::{Bodies, CARRIED, SHIFTED};
use super::RigidBox;
use super::body::Body;
use super::kept::{Kept, Lain};
use super::made::Made;
use super::sleep::{ALIKE, STIRRED};
use crate::lanes::{ABREAST, Eight, Kernel, LANES, not, run};
use crate::math::{length, min};
use core::ops::Range;
use glam::Vec3;

/// Lets all that sleep lie where they are, and marks those that are driven otherwise than when they fell asleep; tells whether there are any.
///
/// Those next to each other are looked at as one: a heap that sleeps is a few columns of numbers.
pub(super) fn lie(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, boxes: &[RigidBox]) -> bool {
    if kept.lists.awake != 0 {
        kept.lists.lain = Lain::default();
    }
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
        // What has lain so as one goes on with that, as long as nobody wakes.
        let mut lain = if end - number == boxes.len() { kept.lists.lain } else { Lain::default() };
        let lies = end > number + 1 && lie_together(bodies, (all, &mut lain), some, places);
        kept.lists.lain = if lies && end - number == boxes.len() { lain } else { Lain::default() };
        if !lies {
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
fn lie_together(
    bodies: &mut Bodies<'_>,
    (all, lain): (&[Body], &mut Lain),
    boxes: &[RigidBox],
    mut places: &[u32],
) -> bool {
    let Some(first) = boxes.first() else { return false };
    let count = boxes.iter().fold(0u32, |sum, of| sum.saturating_add(of.count));
    let Some(rows) = (Made { of: &RigidBox { count, ..*first }, places }).run(bodies) else { return false };
    let h = bodies.substep.seconds();
    let Some(&change) = bodies.velocity.get(rows.start) else { return false };
    let is_known = lain.is_so(change, h);
    if is_known && bodies.substep.number > 0 {
        return put_back(bodies, rows, change, lain.far);
    }
    let (mut row, mut far) = (rows.start, f32::INFINITY);
    for (body, of) in all.iter().zip(boxes) {
        let (own, rest) = places.split_at((3 * of.count as usize).min(places.len()));
        let own_rows = row..row + of.count as usize;
        // Between steps others may have moved them.
        let is_there = bodies.substep.number > 0 || body.is_where_told(bodies, Made { of, places: own }, &own_rows);
        if !(is_there && (is_known || body.is_driven_so(change, h))) {
            return false;
        }
        (places, row, far) = (rest, own_rows.end, min(far, length(body.drive[0]) * h * h));
    }
    *lain = Lain { change, h, far };
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
    // Chips take them one by one.
    let lie = if ABREAST > 1 {
        run(Falls { columns: all, velocity: change, h, far })
    } else {
        wrongs(all, change, h, far) == 0
    };
    if !lie {
        return false;
    }
    bodies.position[rows.clone()].copy_from_slice(from);
    bodies.velocity[rows.clone()].fill(Vec3::ZERO);
    bodies.marks.get_mut(rows).unwrap_or_default().iter_mut().for_each(|mark| *mark |= SHIFTED | CARRIED);
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
struct Falls<'a> {
    /// Where they began, how they moved then, where they are, and how they move.
    columns: [&'a [f32]; 4],
    velocity: Vec3,
    h: f32,
    far: f32,
}

/// Numbers of eight particles.
const WIDE: usize = 3 * LANES;

impl Kernel for Falls<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> bool {
        let Self { columns: [from, still, to, now], velocity, h, far } = self;
        let Vec3 { x, y, z } = velocity;
        let velocities =
            [like.of([x, y, z, x, y, z, x, y]), like.of([z, x, y, z, x, y, z, x]), like.of([y, z, x, y, z, x, y, z])];
        let (step, reach, mut differ) = (like.all(h), like.all(far), like.all(0.0));
        let ((from, a), (still, b)) = (from.as_chunks::<WIDE>(), still.as_chunks::<WIDE>());
        let ((to, c), (now, d)) = (to.as_chunks::<WIDE>(), now.as_chunks::<WIDE>());
        for ((from, still), (to, now)) in from.iter().zip(still).zip(to.iter().zip(now)) {
            let [from, still, to, now] = [from, still, to, now].map(|numbers| numbers.as_chunks::<LANES>().0);
            for (((from, still), (to, now)), &velocity) in
                from.iter().zip(still).zip(to.iter().zip(now)).zip(&velocities)
            {
                let (from, still, to, now) = (like.of(*from), like.of(*still), like.of(*to), like.of(*now));
                let drift = to - from - now * step;
                differ = differ | (now ^ velocity) | still.abs() | not(drift.abs().simd_le(reach));
            }
        }
        let differ = differ.to_array().iter().fold(0, |all, bits| all | bits.to_bits());
        differ | wrongs([a, b, c, d], velocity, h, far) == 0
    }
}

/// Zero if all coordinates are as they have to be.
fn wrongs([from, still, to, now]: [&[f32]; 4], velocity: Vec3, h: f32, far: f32) -> u32 {
    let all = from.iter().zip(still).zip(to.iter().zip(now)).zip(velocity.to_array().into_iter().cycle());
    all.fold(0, |all, (((&from, &still), (&to, &now)), v)| all | wrong([from, still, to, now], v, h, far))
}

/// Zero if a coordinate is as it has to be.
#[inline(always)]
fn wrong([from, still, to, now]: [f32; 4], velocity: f32, h: f32, far: f32) -> u32 {
    let (other, drift) = (now.to_bits() ^ velocity.to_bits(), to - from - now * h);
    other | still.to_bits() << 1 | u32::from(!(drift.abs() <= far))
}
