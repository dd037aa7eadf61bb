//! Contacts held by position: lists of who may touch whom, made anew when somebody has gone far, and the passes over them in
//! each sub-step.

use super::contacts::Stage;
use super::flight::RESTING;
use super::grip::{of_two, on_surface};
use super::touch::{Touch, aside, hold_back, passed};
use crate::math::{largest, length, max, min, sqrt, unit};
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
/// Sweeps over the velocities at a step's end, so that what rests shows it.
const SETTLING: u32 = 4;
/// How much lighter the lower of two that rest on each other counts for each other, as a share.
const SUPPORT: f32 = 0.6;
/// Vectors a particle takes: a place and two velocities of before, a drift, pairs, faces, and marks.
pub(super) const HELD: usize = 4 + PAIR_COLUMNS + 5 * FACES + 1;
const PAIR_COLUMNS: usize = (PAIRS * size_of::<Pair>()).div_ceil(size_of::<Vec3>());

/// Two that may touch in the step, and what they do to each other then.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Pair {
    rows: [u32; 2],
    /// By how much the lower one counts as heavier, as a share: above zero if that is the second, below if the first.
    lean: f32,
    touch: Touch,
}

/// A face that a particle may touch in the step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Face {
    row: u32,
    normal: Vec3,
    /// Of its plane from the origin along the normal at the sub-step's end \[m\].
    offset: f32,
    /// How it moves the particle then \[m/s\].
    velocity: Vec3,
    touch: Touch,
    spare: [u32; 2],
}

/// How long the lists are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lists {
    pairs: usize,
    faces: usize,
    /// The sub-step before which they have to be made anew.
    until: u32,
    /// Whether somebody is so fast that two could pass each other within a sub-step.
    fast: bool,
    /// Whether a face moves: then faces are listed anew for every sub-step.
    moving: bool,
}

/// The memory of a stage in its parts.
struct Held<'a> {
    /// Places and velocities at the sub-step's beginning, and velocities when the integrator has moved all.
    x: &'a mut [Vec3],
    v: &'a mut [Vec3],
    pushed: &'a mut [Vec3],
    drift: &'a mut [Vec3],
    pairs: &'a mut [Pair],
    faces: &'a mut [Face],
    /// Whether a particle has been moved by a contact in this step.
    marks: &'a mut [u32],
}

impl<'a> Held<'a> {
    fn of(memory: &'a mut [Vec3]) -> Self {
        let capacity = memory.len() / HELD;
        let (x, rest) = memory.split_at_mut(capacity);
        let (v, rest) = rest.split_at_mut(capacity);
        let (pushed, rest) = rest.split_at_mut(capacity);
        let (drift, rest) = rest.split_at_mut(capacity);
        let (pairs, rest) = rest.split_at_mut(PAIR_COLUMNS * capacity);
        let pairs = bytemuck::cast_slice_mut::<Vec3, u32>(pairs);
        let whole = pairs.len() - pairs.len() % (size_of::<Pair>() / 4);
        let (faces, marks) = rest.split_at_mut(5 * FACES * capacity);
        let (pairs, faces) = (bytemuck::cast_slice_mut(&mut pairs[..whole]), bytemuck::cast_slice_mut(faces));
        Self { x, v, pushed, drift, pairs, faces, marks: bytemuck::cast_slice_mut(marks) }
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
        *place = Pair { rows: [row, other], lean: 0.0, touch };
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
            let (way, velocity) = carried(stage.scene, center, contact, [stage.now, stage.now + stage.h]);
            let (row, offset) = (row as u32, normal.dot(point + way));
            *place = Face { row, normal, offset, velocity, touch, spare: [0; 2] };
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
    scene.colliders.ride(&seat).map_or(steady, |ride| (ride.place - center, ride.velocity))
}

/// Remembers the state at a sub-step's beginning, as the integrator wants it too.
pub(super) fn begin<'h>(held: &'h mut [Vec3], position: &[Vec3], velocity: &[Vec3]) -> [&'h [Vec3]; 2] {
    let Held { x, v, .. } = Held::of(held);
    let len = position.len();
    x[..len].copy_from_slice(position);
    v[..len].copy_from_slice(velocity);
    [&x[..len], &v[..len]]
}

/// Moves what overlaps apart, lets velocities follow, then answers the approach by the elasticity and the slip by friction.
pub(super) fn project(stage: &mut Stage<'_>, compliance: f32) {
    let h = stage.h.seconds();
    if !(h > 0.0) {
        return;
    }
    let Held { x, v, pushed, drift, pairs, faces, marks } = Held::of(stage.held);
    let (pairs, faces) = (&mut pairs[..stage.lists.pairs], &mut faces[..stage.lists.faces]);
    pushed[..stage.velocity.len()].copy_from_slice(stage.velocity);
    let len = stage.velocity.len();
    let (x, v, drift) = (&x[..len], &v[..len], &mut drift[..len]);
    for (row, drift) in drift.iter_mut().enumerate() {
        *drift = stage.position[row] - x[row] - (v[row] + stage.velocity[row]) * (0.5 * h);
    }
    let driven = stage.velocity.iter().zip(v).map(|(now, before)| *now - *before);
    // What is no longer finite must not reach the others before it is taken out.
    let driven = driven.filter(|change| change.is_finite()).sum::<Vec3>() / max(len as f32, 1.0);
    let mut pass = Pass {
        up: -unit(driven),
        calm: stage.pieces as f32 * length(driven),
        x0: x,
        v0: v,
        pushed,
        drift,
        position: stage.position,
        velocity: stage.velocity,
        radius: stage.radius,
        inverse_mass: stage.inverse_mass,
        h,
        rate: 1.0 / h,
        softness: compliance / (h * h),
        long: stage.dt.seconds(),
    };
    for face in faces.iter_mut() {
        pass.move_from_face(face);
    }
    for pair in pairs.iter_mut() {
        pass.move_apart(pair, stage.lists.fast);
    }
    let is_last = stage.piece + 1 == stage.pieces;
    for sweep in 0..if is_last { SETTLING } else { 1 } {
        faces.iter_mut().filter(|face| face.touch.is_on()).for_each(|face| pass.answer_face(face, sweep == 0));
        pairs.iter_mut().rev().filter(|pair| pair.touch.is_on()).for_each(|pair| pass.answer_pair(pair, sweep == 0));
    }
    for pair in pairs.iter().filter(|pair| pair.touch.is_on()) {
        pair.rows.iter().for_each(|&row| marks[row as usize] = 1);
        stage.report.contacts += 1;
    }
    for face in faces.iter().filter(|face| face.touch.is_on()) {
        marks[face.row as usize] = 1;
        stage.report.hits += 1;
    }
}

/// One pass over the contacts of a sub-step.
struct Pass<'a> {
    /// Before the sub-step.
    x0: &'a [Vec3],
    v0: &'a [Vec3],
    /// As the integrator left it.
    pushed: &'a [Vec3],
    /// How far positions are from where the mean of the velocities before and now leads \[m\]: by half of what forces do in
    /// the sub-step with methods of first order, hardly with others. Contacts take out what lies in their way.
    drift: &'a mut [Vec3],
    position: &'a mut [Vec3],
    velocity: &'a mut [Vec3],
    radius: &'a [f32],
    inverse_mass: &'a [f32],
    /// Against what drives all of them on average, and the speed that gives them in a step.
    up: Vec3,
    calm: f32,
    /// The sub-step, its inverse, and the whole step.
    h: f32,
    rate: f32,
    /// Compliance over h².
    softness: f32,
    long: f32,
}

impl Pass<'_> {
    #[inline(always)]
    fn move_apart(&mut self, pair: &mut Pair, fast: bool) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let (d, reach) = (self.position[a] - self.position[b], self.radius[a] + self.radius[b]);
        let square = d.dot(d);
        pair.touch.end();
        let slack = self.slack(a, reach);
        let (normal, overlap) = if square < (reach + slack) * (reach + slack) {
            let distance = sqrt(square);
            // Of two in one place the one with the higher row goes up.
            let upward = if a > b { Vec3::Y } else { Vec3::NEG_Y };
            (if distance > 0.0 { d * (1.0 / distance) } else { upward }, reach - distance)
        } else if fast && square > 0.0 {
            let Some(normal) = passed(self.x0[a] - self.x0[b], d, reach) else { return };
            (normal, reach - d.dot(normal))
        } else {
            return;
        };
        let closing = max((self.velocity[b] - self.velocity[a]).dot(normal), 0.0);
        // Who touches by rounding alone does so only to press.
        if !(overlap > 0.0 || overlap > -slack && closing > 0.0) {
            return;
        }
        let calm = (self.pushed[a] - self.pushed[b]).dot(normal).abs() <= self.calm;
        pair.lean = if calm { SUPPORT * normal.dot(self.up) } else { 0.0 };
        let (wa, wb) = self.weights(pair);
        let moved = max(overlap, 0.0) * ((wa + wb) / (wa + wb + self.softness));
        let felt = min(moved * self.rate, closing + self.calm);
        pair.touch.begin(felt);
        let share = normal * (1.0 / (wa + wb));
        self.position[a] += share * (moved * wa);
        self.position[b] -= share * (moved * wb);
        self.velocity[a] += share * (felt * wa);
        self.velocity[b] -= share * (felt * wb);
        let drift = share * (self.drift[a] - self.drift[b]).dot(normal);
        self.drift[a] -= drift * wa;
        self.drift[b] += drift * wb;
    }

    fn move_from_face(&mut self, face: &mut Face) {
        let row = face.row as usize;
        let (w, radius) = (self.inverse_mass[row], self.radius[row]);
        let overlap = radius - (self.position[row].dot(face.normal) - face.offset);
        face.touch.end();
        let closing = max((face.velocity - self.velocity[row]).dot(face.normal), 0.0);
        if !(overlap > 0.0 || overlap > -self.slack(row, radius) && closing > 0.0) {
            return;
        }
        let moved = max(overlap, 0.0) * (w / (w + self.softness));
        let felt = min(moved * self.rate, closing + self.calm);
        face.touch.begin(felt);
        self.position[row] += face.normal * moved;
        self.velocity[row] += face.normal * felt;
        self.drift[row] = aside(self.drift[row], face.normal);
    }

    /// How far apart two may be by rounding that touch \[m\].
    fn slack(&self, row: usize, reach: f32) -> f32 {
        4.0 * f32::EPSILON * (largest(self.position[row]) + reach)
    }

    /// By how much each of two gives way. Of two that rest on each other the lower one counts as heavier: then a heap carries
    /// itself from the ground up, and needs no more sub-steps the higher it is (Macklin et al., "Unified Particle Physics
    /// for Real-Time Applications", SIGGRAPH 2014, section 5.3). Of two that meet faster than they could by their weight in a
    /// step each counts as it is.
    #[inline(always)]
    fn weights(&self, Pair { rows: [a, b], lean, .. }: &Pair) -> (f32, f32) {
        let (wa, wb) = (self.inverse_mass[*a as usize], self.inverse_mass[*b as usize]);
        if *lean > 0.0 { (wa, wb * (1.0 - lean)) } else { (wa * (1.0 + lean), wb) }
    }

    #[inline(always)]
    fn answer_pair(&mut self, pair: &mut Pair, first: bool) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let d = self.position[a] - self.position[b];
        let normal = d * (1.0 / max(length(d), f32::MIN_POSITIVE));
        let along = |v: &[Vec3]| (v[a] - v[b]).dot(normal);
        let bounce = self.bounce(pair.touch.elasticity, &along);
        let change = pair.touch.press(bounce, along(self.velocity));
        let (wa, wb) = self.weights(pair);
        let share = normal * (change / (wa + wb));
        self.velocity[a] += share * wa;
        self.velocity[b] -= share * wb;
        if !pair.touch.has_friction() {
            return;
        }
        let whole = wa + wb;
        let (wa, wb) = (self.inverse_mass[a], self.inverse_mass[b]);
        let weight = (wa + wb) / whole;
        let inverse = 1.0 / (wa + wb);
        let slip = aside(self.velocity[a] - self.velocity[b], normal);
        let taken = pair.touch.hold(slip, weight);
        let share = taken * inverse;
        self.velocity[a] += share * wa;
        self.velocity[b] -= share * wb;
        if first {
            let drift = aside(self.drift[a] - self.drift[b], normal);
            let back = hold_back(taken, drift, self.h);
            let (share, drift) = (back * inverse, (back - taken * (0.5 * self.h)) * inverse);
            self.position[a] += share * wa;
            self.position[b] -= share * wb;
            self.drift[a] += drift * wa;
            self.drift[b] -= drift * wb;
            if taken == -slip && bounce == 0.0 && wa * wb == 0.0 {
                let reach = self.radius[a] + self.radius[b];
                let gap = length(self.x0[a] - self.x0[b]) - reach;
                let [row, other] = if wa > 0.0 { [a, b] } else { [b, a] };
                let way = self.position[other] - self.x0[other];
                let touched = gap.abs() <= self.slack(a, reach);
                self.keep(row, self.velocity[other], touched && self.v0[row] == self.v0[other], way);
            }
        }
    }

    fn answer_face(&mut self, face: &mut Face, first: bool) {
        let (row, normal) = (face.row as usize, face.normal);
        let along = |v: &[Vec3]| (v[row] - face.velocity).dot(normal);
        let bounce = self.bounce(face.touch.elasticity, &along);
        let change = face.touch.press(bounce, along(self.velocity));
        self.velocity[row] += normal * change;
        if !face.touch.has_friction() {
            return;
        }
        let slip = aside(self.velocity[row] - face.velocity, normal);
        let taken = face.touch.hold(slip, 1.0);
        self.velocity[row] += taken;
        if first {
            let back = hold_back(taken, aside(self.drift[row], normal), self.h);
            self.position[row] += back;
            self.drift[row] += back - taken * (0.5 * self.h);
            if taken == -slip && bounce == 0.0 {
                let way = face.velocity * self.h;
                let gap = (self.x0[row] + way).dot(normal) - face.offset - self.radius[row];
                let touched = gap.abs() <= self.slack(row, self.radius[row]);
                self.keep(row, face.velocity, touched && self.v0[row] == face.velocity, way);
            }
        }
    }

    /// Gives what friction holds the velocity of what holds it. What was at rest on that and stays so has gone its way and no
    /// other: rounding would let it creep.
    #[inline(never)]
    fn keep(&mut self, row: usize, velocity: Vec3, rests: bool, way: Vec3) {
        self.velocity[row] = velocity;
        if rests {
            self.position[row] = self.x0[row] + way;
        }
    }

    /// The speed at which two are to part: the elastic answer to their approach, or none where the bounce would be over
    /// within a part of the step.
    #[inline(always)]
    fn bounce(&self, elasticity: f32, along: &impl Fn(&[Vec3]) -> f32) -> f32 {
        let approach = along(self.pushed);
        let bounce = max(-approach * elasticity, 0.0);
        if bounce > 0.0 {
            let pressing = max(along(self.v0) - approach, 0.0) * self.rate;
            if 2.0 * bounce < RESTING * self.long * pressing {
                return 0.0;
            }
        }
        bounce
    }
}
