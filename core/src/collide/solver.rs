//! Contacts held by position: lists of who may touch whom, made once a step, and the passes over them in each sub-step.

use super::contacts::Stage;
use super::flight::RESTING;
use super::grip::{Feel, of_two, on_surface};
use crate::force::Friction;
use crate::math::{length, max, min, sqrt};
use crate::shape::Contact;
use glam::Vec3;

/// Pairs of near particles that there is room for, for each particle.
const PAIRS: usize = 9;
/// Faces near a particle that there is room for, for each particle.
const FACES: usize = 1;
/// Vectors a particle takes: a place and two velocities of before, pairs, faces, and marks.
pub(super) const HELD: usize = 3 + PAIRS + 4 * FACES + 1;

/// Two that may touch in the step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Pair {
    rows: [u32; 2],
    /// How far the sub-step moved them apart \[m\]; zero: they did not touch.
    moved: f32,
}

/// A face that a particle may touch in the step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Face {
    row: u32,
    /// Number of its material plus one.
    material: u32,
    normal: Vec3,
    /// Of the plane from the origin along the normal \[m\]; it goes with the velocity.
    offset: f32,
    velocity: Vec3,
    moved: f32,
    spare: [u32; 2],
}

/// How long the lists are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lists {
    pairs: usize,
    faces: usize,
    /// Whether somebody is so fast that two could pass each other within a sub-step.
    fast: bool,
}

/// The memory of a stage in its parts.
struct Held<'a> {
    /// Places and velocities at the sub-step's beginning, and velocities when the integrator has moved all.
    x: &'a mut [Vec3],
    v: &'a mut [Vec3],
    pushed: &'a mut [Vec3],
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
        let (pairs, rest) = rest.split_at_mut(PAIRS * capacity);
        let (faces, marks) = rest.split_at_mut(4 * FACES * capacity);
        let (pairs, faces) = (bytemuck::cast_slice_mut(pairs), bytemuck::cast_slice_mut(faces));
        Self { x, v, pushed, pairs, faces, marks: bytemuck::cast_slice_mut(marks) }
    }
}

/// Whether a contact has moved the particle in a row in this step.
pub(super) fn is_marked(memory: &[Vec3], row: usize) -> bool {
    let capacity = memory.len() / HELD;
    let marks: &[u32] = bytemuck::cast_slice(&memory[(HELD - 1) * capacity..]);
    marks[row] != 0
}

/// Lists all that may come to touch within the step: what is nearer than it can close in on each other at its present
/// velocities, and a tenth of the smaller radius.
pub(super) fn gather(stage: &mut Stage<'_>, scratch: &mut [u32]) {
    let held = Held::of(stage.held);
    let len = stage.position.len();
    held.marks[..len].fill(0);
    let seconds = stage.dt.seconds();
    let mean = stage.velocity.iter().copied().sum::<Vec3>() / max(len as f32, 1.0);
    let mut widest = 0.0;
    let mut narrowest = f32::INFINITY;
    let mut farthest = 0.0;
    for (&radius, &velocity) in stage.radius[..len].iter().zip(&*stage.velocity) {
        let away = length(velocity - mean) * seconds;
        if radius > 0.0 && away < f32::INFINITY {
            widest = max(widest, radius);
            narrowest = min(narrowest, radius);
            farthest = max(farthest, away);
        }
    }
    if widest == 0.0 {
        return;
    }
    stage.lists.fast = 2.0 * farthest > narrowest * stage.pieces as f32;
    let reach = 2.0 * widest + 2.0 * farthest + 0.1 * narrowest;
    let (position, velocity, radius, inverse_mass) =
        (&*stage.position, &*stage.velocity, stage.radius, stage.inverse_mass);
    let (lists, report, room) = (&mut stage.lists, &mut *stage.report, held.pairs);
    let mut keep = |row: u32, other: u32| {
        let (a, b) = (row as usize, other as usize);
        let touching = radius[a] + radius[b];
        let closing = length(velocity[a] - velocity[b]) * seconds + 0.1 * min(radius[a], radius[b]);
        let d = position[a] - position[b];
        let near = touching + closing;
        if d.dot(d) < near * near && touching > 0.0 && inverse_mass[a] + inverse_mass[b] > 0.0 {
            match room.get_mut(lists.pairs) {
                Some(place) => {
                    *place = Pair { rows: [row, other], moved: 0.0 };
                    lists.pairs += 1;
                }
                None => report.caps.contacts += 1,
            }
        }
    };
    let words = (3 * stage.scene.index.columns() * len).min(scratch.len());
    stage.scene.index.arrange(&mut scratch[..words], position, reach, &mut |index| match index {
        Some(index) => {
            index.pairs(reach, &mut |row, others| others.iter().for_each(|&other| keep(row, other)));
        }
        None => (0..len as u32).for_each(|row| (0..row).for_each(|other| keep(row, other))),
    });
    gather_faces(stage);
}

fn gather_faces(stage: &mut Stage<'_>) {
    let held = Held::of(stage.held);
    let seconds = stage.dt.seconds();
    for (row, &center) in stage.position.iter().enumerate() {
        let radius = stage.radius[row];
        if stage.inverse_mass[row] == 0.0 || !(radius > 0.0) || !center.is_finite() {
            continue;
        }
        // What comes from farther is met on its way.
        let reach = radius + min(length(stage.velocity[row]) * seconds, 0.5 * radius) + 0.1 * radius;
        stage.scene.colliders.contacts(center, reach, stage.now, &mut |contact: &Contact| {
            let Some(place) = held.faces.get_mut(stage.lists.faces) else {
                stage.report.caps.contacts += 1;
                return;
            };
            stage.lists.faces += 1;
            *place = Face {
                row: row as u32,
                material: contact.material.map_or(0, |number| u32::from(number) + 1),
                normal: contact.normal,
                offset: contact.normal.dot(contact.point),
                velocity: contact.velocity,
                moved: 0.0,
                spare: [0; 2],
            };
        });
    }
}

/// Remembers the state at a sub-step's beginning, as the integrator wants it too.
pub(super) fn begin<'h>(held: &'h mut [Vec3], position: &[Vec3], velocity: &[Vec3]) -> [&'h [Vec3]; 2] {
    let Held { x, v, .. } = Held::of(held);
    let len = position.len();
    x[..len].copy_from_slice(position);
    v[..len].copy_from_slice(velocity);
    [&x[..len], &v[..len]]
}

/// Moves what overlaps apart, lets velocities follow, then answers the approach by the elasticity.
pub(super) fn project(stage: &mut Stage<'_>, compliance: f32) {
    let h = stage.h.seconds();
    if !(h > 0.0) {
        return;
    }
    let mut pass = Pass {
        x0: &[],
        v0: &[],
        pushed: &[],
        position: stage.position,
        velocity: stage.velocity,
        radius: stage.radius,
        inverse_mass: stage.inverse_mass,
        elasticity: stage.elasticity,
        material: stage.material,
        grips: stage.scene.grips,
        h,
        rate: 1.0 / h,
        softness: compliance / (h * h),
        long: stage.dt.seconds(),
    };
    let Held { x, v, pushed, pairs, faces, marks } = Held::of(stage.held);
    pushed[..pass.velocity.len()].copy_from_slice(pass.velocity);
    (pass.x0, pass.v0, pass.pushed) = (x, v, pushed);
    let (pairs, faces) = (&mut pairs[..stage.lists.pairs], &mut faces[..stage.lists.faces]);
    for face in faces.iter_mut() {
        face.offset += face.normal.dot(face.velocity) * h;
        pass.move_from_face(face);
    }
    for pair in pairs.iter_mut() {
        pass.move_apart(pair, stage.lists.fast);
    }
    for pair in pairs.iter().filter(|pair| pair.moved > 0.0) {
        pass.answer_pair(pair);
        pair.rows.iter().for_each(|&row| marks[row as usize] = 1);
        stage.report.contacts += 1;
    }
    for face in faces.iter().filter(|face| face.moved > 0.0) {
        pass.answer_face(face);
        marks[face.row as usize] = 1;
        stage.report.hits += 1;
    }
}

/// One pass over the contacts of a sub-step.
struct Pass<'a> {
    x0: &'a [Vec3],
    v0: &'a [Vec3],
    pushed: &'a [Vec3],
    position: &'a mut [Vec3],
    velocity: &'a mut [Vec3],
    radius: &'a [f32],
    inverse_mass: &'a [f32],
    elasticity: &'a [f32],
    material: &'a [u16],
    grips: &'a [super::Grip],
    /// The sub-step, its inverse, and the whole step.
    h: f32,
    rate: f32,
    /// Compliance over h².
    softness: f32,
    long: f32,
}

impl Pass<'_> {
    fn move_apart(&mut self, pair: &mut Pair, fast: bool) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let (d, reach) = (self.position[a] - self.position[b], self.radius[a] + self.radius[b]);
        let square = d.dot(d);
        pair.moved = 0.0;
        let (normal, overlap) = if square < reach * reach && square > 0.0 {
            let distance = sqrt(square);
            (d / distance, reach - distance)
        } else if fast && square > 0.0 {
            let Some(normal) = passed(self.x0[a] - self.x0[b], d, reach) else { return };
            (normal, reach - d.dot(normal))
        } else {
            return;
        };
        let (wa, wb) = (self.inverse_mass[a], self.inverse_mass[b]);
        let share = overlap / (wa + wb + self.softness);
        pair.moved = share * (wa + wb);
        let way = (self.position[a] - self.x0[a]) - (self.position[b] - self.x0[b]);
        let held = held_back(self.friction_of_pair(a, b), way, normal, pair.moved);
        let change = normal * share + held / (wa + wb);
        self.shift(a, change * wa);
        self.shift(b, change * -wb);
    }

    fn move_from_face(&mut self, face: &mut Face) {
        let row = face.row as usize;
        let w = self.inverse_mass[row];
        let overlap = self.radius[row] - (self.position[row].dot(face.normal) - face.offset);
        face.moved = 0.0;
        if !(overlap > 0.0) {
            return;
        }
        face.moved = overlap / (w + self.softness) * w;
        let way = self.position[row] - self.x0[row] - face.velocity * self.h;
        let held = held_back(self.feel_of_face(face).friction, way, face.normal, face.moved);
        self.shift(row, face.normal * face.moved + held);
    }

    fn shift(&mut self, row: usize, change: Vec3) {
        self.position[row] += change;
        self.velocity[row] += change * self.rate;
    }

    fn answer_pair(&mut self, pair: &Pair) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let d = self.position[a] - self.position[b];
        let normal = d / max(length(d), f32::MIN_POSITIVE);
        let along = |v: &[Vec3]| (v[a] - v[b]).dot(normal);
        let material = [a, b].map(|row| self.material[row].checked_sub(1));
        let elasticity = of_two(self.grips, [self.elasticity[a], self.elasticity[b]], material).elasticity;
        let change = self.change(elasticity, along(self.pushed), along(self.v0), along(self.velocity), pair.moved);
        let (wa, wb) = (self.inverse_mass[a], self.inverse_mass[b]);
        self.velocity[a] += normal * (change * (wa / (wa + wb)));
        self.velocity[b] -= normal * (change * (wb / (wa + wb)));
    }

    fn answer_face(&mut self, face: &Face) {
        let row = face.row as usize;
        let along = |v: &[Vec3]| (v[row] - face.velocity).dot(face.normal);
        let elasticity = self.feel_of_face(face).elasticity;
        let change = self.change(elasticity, along(self.pushed), along(self.v0), along(self.velocity), face.moved);
        self.velocity[row] += face.normal * change;
    }

    /// How the speed at which two part has to change: to the elastic answer to their approach, or to none where the
    /// bounce would be over within a part of the step. It takes back no more than the contact has given, so that it never pulls.
    fn change(&self, elasticity: f32, approach: f32, began: f32, now: f32, moved: f32) -> f32 {
        let bounce = max(-approach * elasticity, 0.0);
        let pressing = max(began - approach, 0.0) * self.rate;
        let bounces = 2.0 * bounce > RESTING * self.long * pressing;
        let change = if bounces { bounce } else { 0.0 } - now;
        max(change, -moved * self.rate)
    }

    fn friction_of_pair(&self, a: usize, b: usize) -> Friction {
        if self.grips.is_empty() {
            return Friction::NONE;
        }
        let material = [a, b].map(|row| self.material[row].checked_sub(1));
        of_two(self.grips, [0.0; 2], material).friction
    }

    fn feel_of_face(&self, face: &Face) -> Feel {
        let row = face.row as usize;
        let surface = face.material.checked_sub(1).and_then(|number| u16::try_from(number).ok());
        on_surface(self.grips, self.elasticity[row], self.material[row].checked_sub(1), surface)
    }
}

/// What friction takes of a `way` gone along a surface while something was pressed onto it by so much.
fn held_back(friction: Friction, way: Vec3, normal: Vec3, pressed: f32) -> Vec3 {
    if friction == Friction::NONE {
        return Vec3::ZERO;
    }
    friction.answer(way - normal * way.dot(normal), pressed)
}

/// The normal at the first touch of two, one of which was at `from` and is at `to` as seen from the other, if they touched on
/// the way and do no longer.
fn passed(from: Vec3, to: Vec3, reach: f32) -> Option<Vec3> {
    let step = to - from;
    let (square, closing) = (step.dot(step), -from.dot(step));
    if !(closing > 0.0 && closing < square) {
        return None;
    }
    let middle = from + step * (closing / square);
    let rest = reach * reach - middle.dot(middle);
    if !(rest > 0.0) || from.dot(from) < reach * reach {
        return None;
    }
    let touch = middle - step * sqrt(rest / square);
    Some(touch / max(length(touch), f32::MIN_POSITIVE))
}
