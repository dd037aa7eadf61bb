//! The lists of contacts held by position: who may touch whom, made anew when somebody has gone far.

use super::contacts::Stage;
use super::grip::{of_two, on_surface};
use super::touch::Touch;
use crate::math::{length, max, min};
use crate::scene::Scene;
use crate::shape::{Contact, Segment};
use crate::time::Time;
use glam::Vec3;

/// Pairs of near particles that there is room for, for each particle.
const PAIRS: usize = 8;
/// Faces near a particle that there is room for, for each particle.
const FACES: usize = 3;
/// How much farther apart than a touch two may be and still be listed, as a share of the smaller radius.
const MARGIN: f32 = 0.1;
/// Vectors a particle takes: a place and two velocities of before, a drift, two loads, pairs, faces, and marks.
pub(super) const HELD: usize = 6 + PAIR_COLUMNS + 5 * FACES + 1;
const PAIR_COLUMNS: usize = (PAIRS * size_of::<Pair>()).div_ceil(size_of::<Vec3>());

/// Two that may touch in the step, and what they do to each other then.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Pair {
    pub(super) rows: [u32; 2],
    /// By how much the lower one counts as heavier, as a share: above zero if that is the second, below if the first.
    pub(super) lean: f32,
    pub(super) touch: Touch,
}

/// A face that a particle may touch in the step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Face {
    pub(super) row: u32,
    pub(super) normal: Vec3,
    /// Of its plane from the origin along the normal at the sub-step's end \[m\].
    pub(super) offset: f32,
    /// How it moves the particle then \[m/s\].
    pub(super) velocity: Vec3,
    pub(super) touch: Touch,
    pub(super) spare: u32,
}

/// How long the lists are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lists {
    pub(super) pairs: usize,
    pub(super) faces: usize,
    /// The sub-step before which they have to be made anew.
    pub(super) until: u32,
    /// Whether somebody is so fast that two could pass each other within a sub-step.
    pub(super) fast: bool,
    /// Whether a face moves: then faces are listed anew for every sub-step.
    pub(super) moving: bool,
    /// Whether pairs are in their order from the ground up.
    pub(super) sorted: bool,
    /// Whether any of them has friction.
    pub(super) rough: bool,
}

/// The memory of a stage in its parts.
pub(super) struct Held<'a> {
    /// Places and velocities at the sub-step's beginning, and velocities when the integrator has moved all.
    pub(super) x: &'a mut [Vec3],
    pub(super) v: &'a mut [Vec3],
    pub(super) pushed: &'a mut [Vec3],
    pub(super) drift: &'a mut [Vec3],
    /// What carries each, and what it should carry beyond that.
    pub(super) borne: &'a mut [Vec3],
    pub(super) owed: &'a mut [Vec3],
    pub(super) pairs: &'a mut [Pair],
    pub(super) faces: &'a mut [Face],
    /// Whether a particle has been moved by a contact in this step.
    pub(super) marks: &'a mut [u32],
}

impl<'a> Held<'a> {
    pub(super) fn of(memory: &'a mut [Vec3]) -> Self {
        let capacity = memory.len() / HELD;
        let (x, rest) = memory.split_at_mut(capacity);
        let (v, rest) = rest.split_at_mut(capacity);
        let (pushed, rest) = rest.split_at_mut(capacity);
        let (drift, rest) = rest.split_at_mut(capacity);
        let (borne, rest) = rest.split_at_mut(capacity);
        let (owed, rest) = rest.split_at_mut(capacity);
        let (pairs, rest) = rest.split_at_mut(PAIR_COLUMNS * capacity);
        let pairs = bytemuck::cast_slice_mut::<Vec3, u32>(pairs);
        let whole = pairs.len() - pairs.len() % (size_of::<Pair>() / 4);
        let (faces, marks) = rest.split_at_mut(5 * FACES * capacity);
        let (pairs, faces) = (bytemuck::cast_slice_mut(&mut pairs[..whole]), bytemuck::cast_slice_mut(faces));
        Self { x, v, pushed, drift, borne, owed, pairs, faces, marks: bytemuck::cast_slice_mut(marks) }
    }
}

/// Whether a contact has moved the particle in a row in this step.
pub(super) fn is_marked(memory: &[Vec3], row: usize) -> bool {
    let capacity = memory.len() / HELD;
    let marks: &[u32] = bytemuck::cast_slice(&memory[(HELD - 1) * capacity..]);
    marks[row] != 0
}

/// Lists all that may come to touch, for as many sub-steps as nobody goes half a radius in; then anew.
pub(super) fn gather(stage: &mut Stage<'_>, scratch: &mut [u32]) {
    let len = stage.position.len();
    if stage.piece == 0 {
        Held::of(stage.held).marks[..len].fill(0);
    }
    if stage.piece < stage.lists.until {
        if stage.lists.moving {
            stage.lists.faces = 0;
            gather_faces(stage, stage.h.seconds());
        }
        return;
    }
    stage.lists = Lists { until: stage.pieces, ..Lists::default() };
    let Some((half, reach)) = reach(stage) else { return };
    let held = Held::of(stage.held);
    // Two that go on steadily are within half their way of each other in the middle of the time.
    let middle = &mut held.x[..len];
    for (middle, (&x, &v)) in middle.iter_mut().zip(stage.position.iter().zip(&*stage.velocity)) {
        *middle = x + v * half;
    }
    let middle = &*middle;
    let (velocity, radius, inverse_mass) = (&*stage.velocity, stage.radius, stage.inverse_mass);
    let (material, elasticity, grips) = (stage.material, stage.elasticity, stage.scene.grips);
    let (lists, report, room) = (&mut stage.lists, &mut *stage.report, held.pairs);
    let mut keep = |row: u32, other: u32| {
        let (a, b) = (row as usize, other as usize);
        let way = length(velocity[a] - velocity[b]) * half;
        let near = radius[a] + radius[b] + MARGIN * min(radius[a], radius[b]) + way;
        let d = middle[a] - middle[b];
        let yielding = inverse_mass[a] + inverse_mass[b];
        let is_sound = |x: f32| x > 0.0 && x < f32::INFINITY;
        if !(d.dot(d) < near * near) || !is_sound(radius[a] + radius[b]) || !is_sound(yielding) {
            return;
        }
        let Some(place) = room.get_mut(lists.pairs) else {
            report.caps.contacts += 1;
            return;
        };
        let of_both = [a, b].map(|row| material[row].checked_sub(1));
        let touch = Touch::new(of_two(grips, [elasticity[a], elasticity[b]], of_both));
        lists.rough |= touch.has_friction();
        *place = Pair { rows: if row > other { [row, other] } else { [other, row] }, lean: 0.0, touch };
        lists.pairs += 1;
    };
    let words = (3 * stage.scene.index.columns() * len).min(scratch.len());
    stage.scene.index.arrange(&mut scratch[..words], middle, reach, &mut |index| match index {
        Some(index) => {
            index.pairs(reach, &mut |row, others| others.iter().for_each(|&other| keep(row, other)));
        }
        None => (0..len as u32).for_each(|row| (0..row).for_each(|other| keep(row, other))),
    });
    gather_faces(stage, 2.0 * half);
}

/// Half the time for which a list is to do, and how far two may then be from each other that touch in it; none: no two can.
fn reach(stage: &mut Stage<'_>) -> Option<(f32, f32)> {
    let len = stage.position.len();
    let finite = stage.velocity.iter().copied().filter(|v| v.is_finite());
    let mean = finite.sum::<Vec3>() / max(len as f32, 1.0);
    let (mut widest, mut narrowest, mut fastest) = (0.0, f32::INFINITY, 0.0);
    for (&radius, &velocity) in stage.radius[..len].iter().zip(&*stage.velocity) {
        let speed = length(velocity - mean);
        if radius > 0.0 && radius < f32::INFINITY && speed < f32::INFINITY {
            (widest, narrowest) = (max(widest, radius), min(narrowest, radius));
            fastest = max(fastest, speed);
        }
    }
    let piece = stage.dt.seconds() / stage.pieces as f32;
    // The cast saturates.
    let pieces = (0.5 * narrowest / max(fastest * piece, f32::MIN_POSITIVE)) as u32;
    let pieces = pieces.clamp(1, stage.pieces - stage.piece);
    let half = 0.5 * pieces as f32 * piece;
    stage.lists.until = stage.piece + pieces;
    stage.lists.fast = 2.0 * fastest * piece > narrowest;
    (widest > 0.0).then_some((half, 2.0 * widest + 2.0 * fastest * half + MARGIN * widest))
}

fn gather_faces(stage: &mut Stage<'_>, seconds: f32) {
    let held = Held::of(stage.held);
    for (row, &center) in stage.position.iter().enumerate() {
        let radius = stage.radius[row];
        if stage.inverse_mass[row] == 0.0 || !(radius > 0.0) || !center.is_finite() {
            continue;
        }
        // What comes from farther is met on its way.
        let reach = radius + min(length(stage.velocity[row]) * seconds, 0.5 * radius) + MARGIN * radius;
        let own = stage.material[row].checked_sub(1);
        let elasticity = stage.elasticity[row];
        stage.scene.colliders.contacts(center, reach, stage.now, &mut |contact: &Contact| {
            let Some(place) = held.faces.get_mut(stage.lists.faces) else {
                stage.report.caps.contacts += 1;
                return;
            };
            stage.lists.faces += 1;
            let Contact { point, normal, material, .. } = *contact;
            let touch = Touch::new(on_surface(stage.scene.grips, elasticity, own, material));
            stage.lists.moving |= contact.velocity != Vec3::ZERO;
            stage.lists.rough |= touch.has_friction();
            let (way, velocity) = carried(stage.scene, center, contact, [stage.now, stage.now + stage.h]);
            let (row, offset) = (row as u32, normal.dot(point + way));
            *place = Face { row, normal, offset, velocity, touch, spare: 0 };
        });
    }
}

/// How far a face takes a particle that touches it in a sub-step \[m\], along its arc if it turns, and the velocity it gives it
/// in the end.
fn carried(scene: &Scene<'_>, center: Vec3, contact: &Contact, during: [Time; 2]) -> (Vec3, Vec3) {
    let Contact { normal, distance, velocity, .. } = *contact;
    let steady = (velocity * (during[1] - during[0]).seconds(), velocity);
    if velocity == Vec3::ZERO || !(distance > 0.0) {
        return steady;
    }
    // From the centre past the place of contact, thick enough to meet a rim as well.
    let seat = Segment { from: center, to: center - normal * (1.5 * distance), radius: 0.5 * distance, during };
    scene.colliders.ride(&seat).map_or(steady, |ride| (ride.place - center, ride.velocity[1]))
}
