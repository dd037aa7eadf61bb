//! The lists of contacts held by position: who may touch whom, made anew when somebody has gone far.

use super::super::bodies::are_bound;
use super::super::{Bodies, Substep, Words};
use super::touch::Touch;
use crate::index::between;
use crate::least;
use crate::material::{of_two, on_surface};
use crate::math::{length, max, min};
use crate::memory::{take, take_vectors};
use crate::shape::{Collider, Contact, Segment, is_level};
use crate::time::Time;
use glam::Vec3;

/// Pairs of near particles that there is room for, for each particle.
const PAIRS: usize = 8;
/// Faces near a particle that there is room for, for each particle.
const FACES: usize = 3;
/// How much farther apart than a touch two may be and still be listed, as a share of the smaller radius.
const MARGIN: f32 = 0.1;
/// How far off the plane of a face an edge may seem to be that is one of that \[slacks\].
const LEVEL: f32 = 4.0;
/// The cosine of the angle between the normals of a face and of what it may turn to.
const ALIKE: f32 = 0.5;
/// Contacts with the scenery around a particle.
type Around = heapless::Vec<Contact, 16>;
/// The words kept through the step: for each particle two velocities, a drift, two loads, a round, pairs and faces, and how long the
/// lists are.
pub(super) const KEPT: Words =
    Words { per_row: 5 * 3 + 1 + PAIR_WORDS + FACES * (size_of::<Face>() / 4), fixed: size_of::<Listed>() / 4 };
const PAIR_WORDS: usize = (PAIRS * size_of::<Pair>()).div_ceil(size_of::<Vec3>()) * 3;

/// Two that may touch in the step, and what they do to each other then.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Pair {
    pub(super) rows: [u32; 2],
    /// By how much the lower one counts as heavier, as a share: above zero if that is the second, below if the first.
    pub(super) lean: f32,
    /// By how much bounces have changed the speed at which they part \[m/s\].
    pub(super) given: f32,
    pub(super) touch: Touch,
}

/// A face that a particle may touch in the step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Face {
    pub(super) row: u32,
    pub(super) normal: Vec3,
    /// The distance of its plane from the origin, along the normal, at the sub-step's end \[m\].
    pub(super) offset: f32,
    /// How it moves the particle then \[m/s\].
    pub(super) velocity: Vec3,
    pub(super) touch: Touch,
    /// By how much bounces have changed the speed at which the two part \[m/s\].
    pub(super) given: f32,
    /// 1 if the surface has been found to be flat there.
    pub(super) is_flat: u32,
    /// 1 if the particle came there from afar in the sub-step.
    pub(super) struck: u32,
}

/// How long the lists are, and what else is to be known of the sub-step.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Listed {
    pub(super) pairs: u32,
    pub(super) faces: u32,
    /// The sub-step before which they have to be made anew.
    pub(super) until: u32,
    /// 1 if somebody is so fast that two could pass each other within a sub-step, else 0; likewise the next two.
    pub(super) fast: u32,
    /// 1 if pairs are in their order from the ground up.
    pub(super) sorted: u32,
    /// 1 if any of them has friction.
    pub(super) rough: u32,
    /// The fastest bounce of the sub-step so far \[m/s\].
    pub(super) hardest: f32,
    /// The mean change of all velocities in the sub-step \[m/s\].
    pub(super) driven: Vec3,
}

/// The memory of contacts in its parts.
pub(super) struct Kept<'a> {
    /// Velocities when the method has moved all.
    pub(super) pushed: &'a mut [Vec3],
    /// Velocities that bounces alone, one after the other, make of these.
    pub(super) thrown: &'a mut [Vec3],
    pub(super) drift: &'a mut [Vec3],
    /// The round of bounces in which each was thrown last; none: zero.
    pub(super) round: &'a mut [u32],
    /// The pushes that carry each particle, summed, and what it should carry beyond them.
    pub(super) borne: &'a mut [Vec3],
    pub(super) owed: &'a mut [Vec3],
    pub(super) pairs: &'a mut [Pair],
    pub(super) faces: &'a mut [Face],
    pub(super) lists: &'a mut Listed,
}

impl<'a> Kept<'a> {
    /// None: the memory is too small.
    pub(super) fn of(mut memory: &'a mut [u32], capacity: usize) -> Option<Self> {
        let lists = bytemuck::cast_slice_mut(take(&mut memory, KEPT.fixed)).first_mut()?;
        let [pushed, thrown, drift, borne, owed] = [(); 5].map(|()| take_vectors(&mut memory, capacity));
        let round = take(&mut memory, capacity);
        let pairs = take(&mut memory, PAIR_WORDS * capacity);
        let whole = pairs.len() - pairs.len() % (size_of::<Pair>() / 4);
        let pairs = bytemuck::cast_slice_mut(&mut pairs[..whole]);
        let faces = memory.len() - memory.len() % (size_of::<Face>() / 4);
        let faces = bytemuck::cast_slice_mut(&mut memory[..faces]);
        Some(Self { pushed, thrown, round, drift, borne, owed, pairs, faces, lists })
    }
}

/// Lists all that may come to touch, for as many sub-steps as nobody goes half a radius in; then anew.
pub(super) fn gather(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>) {
    let Substep { number, count, .. } = bodies.substep;
    if number == 0 {
        *kept.lists = Listed::default();
    }
    if number < kept.lists.until {
        // What stands still at the moment may be on the turn.
        if bodies.colliders.moves() {
            kept.lists.faces = 0;
            gather_faces(bodies, kept, bodies.substep.seconds());
        }
        return;
    }
    *kept.lists = Listed { until: count, ..Listed::default() };
    let Some((half, reach)) = reach(bodies, kept.lists) else { return };
    gather_pairs(bodies, kept, half, reach);
    gather_faces(bodies, kept, 2.0 * half);
}

/// Lists pairs that may touch within twice `half` \[s\]; of more than there is room for the nearest.
fn gather_pairs(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, half: f32, reach: f32) {
    // Two that go on steadily are within half their way of each other in the middle of the time.
    let middle = &mut kept.pushed[..bodies.len()];
    for (middle, (&x, &v)) in middle.iter_mut().zip(bodies.position.iter().zip(&*bodies.velocity)) {
        *middle = x + v * half;
    }
    let (middle, lists, room) = (&*middle, &mut *kept.lists, &mut *kept.pairs);
    // Until all are known, each pair has its gap for its lean.
    let is_nearer = |one: &Pair, other: &Pair| (one.lean, one.rows) < (other.lean, other.rows);
    let mut count = 0;
    let around = bodies.near.room();
    let Bodies { velocity, radius, inverse_mass, material, elasticity, materials, report, near, bound, .. } = bodies;
    near.pairs(middle, reach, &mut |row, other| {
        let (a, b) = (row as usize, other as usize);
        if are_bound(bound, a, b) {
            return;
        }
        let way = length(velocity[a] - velocity[b]) * half;
        let touch = radius[a] + radius[b];
        let near = touch + MARGIN * min(radius[a], radius[b]) + way;
        let d = between(around, middle[b], middle[a]);
        let yielding = inverse_mass[a] + inverse_mass[b];
        let is_sound = |x: f32| x > 0.0 && x < f32::INFINITY;
        if !(d.dot(d) < near * near) || !is_sound(touch) || !is_sound(yielding) {
            return;
        }
        let gap = length(d) - touch;
        let of_both = [a, b].map(|row| material[row].checked_sub(1));
        let touch = Touch::new(of_two(materials, [elasticity[a], elasticity[b]], of_both));
        let rows = if row > other { [row, other] } else { [other, row] };
        let is_left_out = least::put(room, &mut count, Pair { rows, lean: gap, given: 0.0, touch }, is_nearer);
        report.caps.contacts += u64::from(is_left_out);
    });
    lists.pairs = count as u32;
    for pair in &mut room[..count] {
        pair.lean = 0.0;
        lists.rough |= u32::from(pair.touch.has_friction());
    }
}

/// Half the time for which a list is to do, and how far two may then be from each other that touch in it; none: no two can.
fn reach(bodies: &Bodies<'_>, lists: &mut Listed) -> Option<(f32, f32)> {
    let len = bodies.len();
    let finite = bodies.velocity.iter().copied().filter(|v| v.is_finite());
    let mean = finite.sum::<Vec3>() / max(len as f32, 1.0);
    let (mut widest, mut narrowest, mut fastest) = (0.0, f32::INFINITY, 0.0);
    for (&radius, &velocity) in bodies.radius[..len].iter().zip(&*bodies.velocity) {
        let speed = length(velocity - mean);
        if radius > 0.0 && radius < f32::INFINITY && speed < f32::INFINITY {
            (widest, narrowest) = (max(widest, radius), min(narrowest, radius));
            fastest = max(fastest, speed);
        }
    }
    let Substep { number, count, step, .. } = bodies.substep;
    let piece = step.seconds() / count as f32;
    // The cast saturates.
    let pieces = (0.5 * narrowest / max(fastest * piece, f32::MIN_POSITIVE)) as u32;
    let pieces = pieces.clamp(1, count - number);
    let half = 0.5 * pieces as f32 * piece;
    lists.until = number + pieces;
    lists.fast = u32::from(2.0 * fastest * piece > narrowest);
    (widest > 0.0).then_some((half, 2.0 * widest + 2.0 * fastest * half + MARGIN * widest))
}

/// Lists faces that may be touched within `seconds`.
fn gather_faces(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, seconds: f32) {
    let (lists, substep, colliders) = (&mut *kept.lists, bodies.substep, bodies.colliders);
    for (row, &center) in bodies.position.iter().enumerate() {
        let radius = bodies.radius[row];
        if bodies.inverse_mass[row] == 0.0 || !(radius > 0.0) || !center.is_finite() {
            continue;
        }
        // A face from farther away is met on the particle's way.
        let reach = radius + min(length(bodies.velocity[row]) * seconds, 0.5 * radius) + MARGIN * radius;
        let own = bodies.material[row].checked_sub(1);
        let elasticity = bodies.elasticity[row];
        let mut around = Around::new();
        colliders.contacts(center, reach, substep.during[0], &mut |contact: &Contact| {
            // An edge of a mesh that is level with a face bears nobody whom that does not: its plane leans in the way.
            if around.iter().any(|other| is_level(contact, other, LEVEL) && other.distance <= contact.distance) {
                return;
            }
            around.retain(|other| !(is_level(other, contact, LEVEL) && contact.distance <= other.distance));
            bodies.report.caps.contacts += u64::from(around.push(*contact).is_err());
        });
        for contact in &around {
            let Some(place) = kept.faces.get_mut(lists.faces as usize) else {
                bodies.report.caps.contacts += 1;
                break;
            };
            lists.faces += 1;
            let Contact { point, normal, material, .. } = *contact;
            let touch = Touch::new(on_surface(bodies.materials, elasticity, own, material));
            lists.rough |= u32::from(touch.has_friction());
            let (way, velocity) = carried(colliders, center, contact, substep);
            let (row, offset) = (row as u32, normal.dot(point + way));
            *place = Face { row, normal, offset, velocity, touch, given: 0.0, is_flat: 0, struck: 0 };
        }
    }
}

impl Face {
    /// Turns the face to where the surface curves to beside its particle now, from where on that goes along it: along a plane that touches it elsewhere it
    /// would gain by being raised. Where several faces are alike, as the edges of a mesh are, it stays what it is.
    pub(super) fn turn(&mut self, colliders: &dyn Collider, center: Vec3, radius: f32, now: Time) {
        if self.is_flat != 0 || !center.is_finite() {
            return;
        }
        let (mut alike, mut other) = (0, None);
        colliders.contacts(center, (1.0 + MARGIN) * radius, now, &mut |contact: &Contact| {
            if contact.normal.dot(self.normal) > ALIKE {
                (alike, other) = (alike + 1, Some(*contact));
            }
        });
        let Some(Contact { normal, point, .. }) = other.filter(|_| alike == 1) else { return };
        self.is_flat = u32::from(normal == self.normal);
        if self.is_flat == 0 {
            (self.normal, self.offset) = (normal, normal.dot(point));
        }
    }
}

/// How far a face takes a particle that touches it in a sub-step \[m\], along its arc if it turns, and the velocity it gives it
/// in the end.
fn carried(colliders: &dyn Collider, center: Vec3, contact: &Contact, substep: Substep) -> (Vec3, Vec3) {
    let Contact { normal, distance, velocity, .. } = *contact;
    let steady = (velocity * substep.seconds(), velocity);
    if velocity == Vec3::ZERO || !(distance > 0.0) {
        return steady;
    }
    // From the centre past the place of contact, thick enough to meet a rim as well.
    let during = substep.during;
    let seat = Segment { from: center, to: center - normal * (1.5 * distance), radius: 0.5 * distance, during };
    colliders.ride(&seat).map_or(steady, |ride| (ride.place - center, ride.velocity[1]))
}
