//! The scenery as what holds together meets it within a sub-step: walls that press particles while the material gives way, so that a hit on a few
//! of them is one on all that hangs on them.

mod as_one;
mod follow;
mod glide;
mod settle;
mod solve;
mod tell;

pub(super) use as_one::{Motion, Whole};
pub(super) use follow::follow;
pub(super) use glide::{Pace, Pushed};
pub(super) use settle::{report, settle};
pub(super) use solve::{brake, filter, finish, hold, impose, judge, keep, list, meet};

use super::contacts::{TangentImpulse, Touch};
use super::{Bodies, Substep};
use crate::material::on_surface;
use crate::math::{aside, dot, high, largest, length, low, max, min, sqrt};
use crate::memory::take;
use crate::shape::{Aabb, Contact, Segment};
use glam::{Mat3, Vec3};

/// Sub-steps ahead that a search of the scenery looks, at the most.
const AHEAD: u32 = 8;
/// The share of a gap that is missing that a sub-step gives back.
const RECOVERY: f32 = 0.2;
/// So many times what rounding may be wrong by has to be missing for a wall to press: what presses less is left to whoever settles velocities, as
/// rounding would be a large part of it.
const NOTICED: f32 = 4.0;
/// The speed from which on a particle is taken for one that slips, as a multiple of what its friction can stop in a sub-step.
const FAST: f32 = 4.0;
/// The share of the largest coordinate by which rounding may put a particle off what it touches.
const ROUNDING: f32 = 4e-6;
/// The cosine of the least angle between two faces that a particle is kept from at once.
const ALIKE: f32 = 0.9;
/// The cosine of the angle between the normals of two that may be one face.
const SAME: f32 = 0.9999;
/// The row of a particle that is not there.
const NOBODY: u32 = u32::MAX;
/// The state of a wall and its particle: none is near, it is left alone, it slides along, it goes as the wall does.
const NONE: u32 = 0;
const NEAR: u32 = 1;
const SLIDES: u32 = 2;
const STICKS: u32 = 3;

/// The face of the scenery that a particle is about to meet, and what it does to that in the sub-step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Wall {
    row: u32,
    state: u32,
    /// 1 if its particle has yet to be brought to where the wall wants it; while walls are gathered, its state in the sub-step
    /// before; as velocities are settled, 1 if its particle touches it.
    fresh: u32,
    normal: Vec3,
    /// How far along the normal the particle is to be from the origin at the sub-step's end \[m\], at the least.
    offset: f32,
    /// How the surface moves \[m/s\], how far the particle can go in the sub-step without meeting any that is near, and by how much rounding may be
    /// wrong about that \[m\].
    velocity: Vec3,
    free: f32,
    slack: f32,
    /// The way beyond where it is to be that a particle which is solved by speeds may go in the sub-step before it presses that \[m\].
    leeway: f32,
    /// The velocity of its particle before the material answers \[m/s\].
    pushed: Vec3,
    /// How far off all scenery is, at the least \[m\].
    clear: f32,
    /// The part that it takes of the forces that are left \[kg m\], and what it brakes by for each metre that its particle slides \[kg\]. Where what it
    /// presses is solved by speeds: how fast that would go by itself \[m/s\], and how much heavier friction makes it, in its own masses. Where it presses
    /// what moves as one: what it has given its particle, and along `beside` \[kg m\], in the end as impulses \[kg m/s\].
    held: Vec3,
    brake: f32,
    /// Where its particle is held if friction can: where it comes to touch \[m\].
    stuck: Vec3,
    touch: Touch,
    tangent: TangentImpulse,
    /// The normal of another face that is near, or zero, and how far along that the particle is to be from the origin, at the least \[m\].
    beside: Vec3,
    beyond: f32,
    /// 1 if any face that is near moves.
    moves: u32,
    /// How much heavier friction has made what is solved by speeds, as it was pressed last.
    last: f32,
}

/// The words of the wall of a particle.
pub(super) const WORDS: usize = size_of::<Wall>() / 4;

/// The walls of so many particles in words that last through a step.
pub(super) fn of(step: &mut [u32], count: usize) -> &mut [Wall] {
    let mut rest = step;
    bytemuck::try_cast_slice_mut(take(&mut rest, count.saturating_mul(WORDS))).unwrap_or_default()
}

/// Finds the walls that particles may meet in the sub-step, and which of them press on where the method has moved these. Who is far from all is not
/// asked again before it has gone that far, if nothing there moves.
pub(super) fn gather(walls: &mut [Wall], particles: &[u32], bodies: &Bodies<'_>) {
    let Substep { number, count, .. } = bodies.substep;
    if number == 0 {
        walls.iter_mut().for_each(|wall| (wall.clear, wall.last) = (0.0, 0.0));
    }
    let mut around = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    let (mut size, mut farthest) = (0.0, 0.0);
    for (wall, &particle) in walls.iter_mut().zip(particles) {
        wall.fresh = if number == 0 { NONE } else { wall.state };
        wall.state = NONE;
        wall.touch.begin(0.0);
        wall.row = find(particle, bodies);
        if wall.row != NOBODY {
            let row = wall.row as usize;
            let (from, to) = (bodies.before[0][row], bodies.position[row]);
            around.min = low(low(from, to), around.min);
            around.max = high(high(from, to), around.max);
            size = max(max(bodies.clearance(row), bodies.radius[row]), size);
            farthest = max(dot(to - from, to - from), farthest);
        }
    }
    // Whoever stands may be pushed as fast as any of what hangs on him goes.
    let pushed = sqrt(farthest) + ROUNDING * max(largest(around.min), largest(around.max));
    let all = reach(size, pushed);
    around = Aabb { min: around.min - all, max: around.max + all };
    if bodies.colliders.is_empty() || !bodies.colliders.may_touch(&around) {
        walls.iter_mut().for_each(|wall| wall.clear = 0.0);
        return;
    }
    let ahead = (count - number).min(AHEAD) as f32;
    for wall in walls.iter_mut().filter(|wall| wall.row != NOBODY) {
        let row = wall.row as usize;
        let way = length(bodies.position[row] - bodies.before[0][row]);
        // Whoever another constraint keeps off is followed by that, from farther away.
        let kept = bodies.clearance(row);
        let near = reach(max(kept, bodies.radius[row]), if kept > 0.0 { way } else { pushed });
        if wall.clear < near || bodies.colliders.moves() {
            wall.clear = near + ahead * way;
            wall.look(near, bodies);
        }
        wall.clear = max(wall.clear - way, 0.0);
    }
}

/// The row of a particle that can be moved.
fn find(particle: u32, bodies: &Bodies<'_>) -> u32 {
    let sound = |&row: &usize| {
        let inverse = bodies.inverse_mass[row];
        let moves = inverse > 0.0 && inverse < f32::INFINITY;
        moves
            && bodies.position[row].is_finite()
            && bodies.velocity[row].is_finite()
            && bodies.before[0][row].is_finite()
    };
    bodies.row_of_start(particle).filter(sound).map_or(NOBODY, |row| row as u32)
}

/// How near a face has to be to be met in the sub-step by a particle of such a size that is pushed so far: what hangs on it may take it as far again.
fn reach(size: f32, pushed: f32) -> f32 {
    2.0 * (size + pushed)
}

impl Wall {
    /// Tells whether it presses its particle.
    pub(super) fn presses(&self) -> bool {
        self.state > NEAR
    }

    /// The row of its particle, if there is one near.
    pub(super) fn row(&self) -> Option<usize> {
        self.is_near().then_some(self.row as usize)
    }

    /// Tells whether there is one that may come to press.
    pub(super) fn is_near(&self) -> bool {
        self.state != NONE
    }

    /// Tells whether it presses its particle, and not smoothly.
    pub(super) fn rubs(&self) -> bool {
        self.presses() && self.touch.has_friction()
    }

    /// The stiffness of it, as good as not giving way, that is added to that of a particle with so much of its own.
    pub(super) fn stiffness(&self, own: f32) -> Mat3 {
        /// Its stiffness in those of its particle.
        const STIFF: f32 = 100.0;
        let all = own * STIFF;
        match self.state {
            STICKS => Mat3::from_diagonal(Vec3::splat(all)),
            SLIDES => {
                let brake = self.brake;
                let [x, y, z] = self.normal.to_array().map(|along| self.normal * (along * (all - brake)));
                Mat3::from_cols(x, y, z) + Mat3::from_diagonal(Vec3::splat(brake))
            }
            _ => Mat3::ZERO,
        }
    }

    /// Tells whether it has pressed its particle in the sub-step.
    pub(super) fn is_met(&self) -> bool {
        self.state != NONE && self.touch.pressed() > 0.0
    }

    /// Tells whether its particle is where it touches it.
    fn touches(&self, bodies: &Bodies<'_>) -> bool {
        bodies.position[self.row as usize].dot(self.normal) < self.offset + 0.5 * self.slack
    }

    /// A speed as seen from it without what would go into it, if it has pressed its particle.
    pub(super) fn without_inward(&self, fast: Vec3) -> Vec3 {
        if self.is_met() { fast - self.normal * min(fast.dot(self.normal), 0.0) } else { fast }
    }

    /// Its normal, and that of another face beside it or zero.
    pub(super) fn normals(&self) -> [Vec3; 2] {
        [self.normal, self.beside]
    }

    /// Tells whether it is not smooth.
    pub(super) fn is_rough(&self) -> bool {
        self.touch.has_friction()
    }

    /// Tells whether it stands still, and all that is near besides.
    pub(super) fn stands(&self) -> bool {
        self.moves == 0
    }

    /// Takes the face that the particle is farthest behind where the method has moved it.
    fn look(&mut self, near: f32, bodies: &Bodies<'_>) {
        let (was, searched) = (core::mem::take(&mut self.fresh), self.clear);
        let from = bodies.before[0][self.row as usize];
        let last = if was != NONE { self.normal } else { Vec3::ZERO };
        let (mut most, nearest) = self.survey((near, last), bodies, &|_| true);
        let is_alike = |normal: Vec3| normal.dot(nearest) >= SAME;
        if self.state == NEAR && !(is_alike(self.normal) && self.beside == Vec3::ZERO) {
            // The place of a triangle that is nearest may be on its edge, and edges inside a floor are no faces.
            (self.state, self.clear) = (NONE, searched);
            (most, _) = self
                .survey((near, last), bodies, &|contact| is_alike(contact.normal) || is_face(contact, from, bodies));
        }
        if self.state == NEAR {
            self.touch.begin(0.0);
            // Who was pressed in the sub-step before most often still is.
            if most > NOTICED * self.slack || was > NEAR {
                self.press(most, bodies);
            }
        }
    }

    /// Takes of the faces that count the one that the particle is farthest behind, and another beside it; tells how far it is behind that, and the
    /// normal of the nearest of all.
    fn survey(
        &mut self,
        (near, last): (f32, Vec3),
        bodies: &Bodies<'_>,
        counts: &dyn Fn(&Contact) -> bool,
    ) -> (f32, Vec3) {
        let row = self.row as usize;
        let (from, to, h) = (bodies.before[0][row], bodies.position[row], bodies.substep.seconds());
        let (mut most, mut second) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        let (mut least, mut nearest) = (f32::INFINITY, Vec3::ZERO);
        let mut free = self.clear;
        (self.beside, self.beyond, self.moves) = (Vec3::ZERO, 0.0, 0);
        bodies.colliders.contacts(from, self.clear, bodies.substep.during[0], &mut |contact: &Contact| {
            let contact = &as_before(contact, last);
            let Contact { point, normal, distance, velocity, slack, .. } = *contact;
            self.clear = min(distance, self.clear);
            self.moves |= u32::from(velocity != Vec3::ZERO);
            free = min(distance - length(velocity) * h, free);
            if !(distance < near + 4.0 * slack + length(velocity) * h) || !normal.is_finite() || !counts(contact) {
                return;
            }
            (least, nearest) = if distance < least { (distance, normal) } else { (least, nearest) };
            let keep = max(bodies.clearance(row), bodies.radius[row] + 2.0 * slack);
            let gap = if distance < keep { distance + RECOVERY * (keep - distance) } else { keep };
            let offset = normal.dot(point + velocity * h) + gap;
            let missing = offset - normal.dot(to);
            let another = |other: Vec3| normal.dot(other) < ALIKE;
            if !(missing > most) {
                if missing > second && another(self.normal) {
                    (second, self.beside, self.beyond) = (missing, normal, offset);
                }
                return;
            }
            if most > f32::NEG_INFINITY && another(self.normal) {
                (second, self.beside, self.beyond) = (most, self.normal, self.offset);
            } else if !another(self.beside) {
                (second, self.beside, self.beyond) = (f32::NEG_INFINITY, Vec3::ZERO, 0.0);
            }
            most = missing;
            // Friction does not act on the way there: whoever were held where that begins would be held beside where he hits a slope.
            let (there, far) = (from + velocity * h, distance - keep - slack);
            let share = if far > 0.0 && missing > 0.0 { far / (far + missing) } else { 0.0 };
            self.take(contact, offset, there + (to - there) * share, bodies);
            // Who got to the other side of a surface by rounding would be kept there.
            self.leeway = if gap > 0.0 { min(NOTICED * slack, 0.5 * gap) } else { NOTICED * slack };
        });
        self.free = free;
        (most, nearest)
    }

    /// Takes a face that keeps its particle so far from the origin, and if friction can at a place.
    fn take(&mut self, contact: &Contact, offset: f32, stuck: Vec3, bodies: &Bodies<'_>) {
        let Contact { normal, velocity, material, slack, .. } = *contact;
        let row = self.row as usize;
        let (own, elasticity) = (bodies.material[row].checked_sub(1), bodies.elasticity[row]);
        let touch = Touch::new(on_surface(bodies.materials, elasticity, own, material));
        let pushed = bodies.velocity[row];
        let (state, held, brake, tangent) = (NEAR, Vec3::ZERO, 0.0, TangentImpulse::of(Vec3::ZERO));
        *self = Self { state, normal, offset, velocity, slack, pushed, held, brake, stuck, touch, tangent, ..*self };
    }

    /// Begins to press a particle that is so far behind it \[m\]: with friction as if that held it, unless it slips by far faster than what presses it
    /// like that can stop. Whatever hangs on it would be held as well until solutions have let go of all of them.
    fn press(&mut self, missing: f32, bodies: &Bodies<'_>) {
        let slip = aside(bodies.before[1][self.row as usize] - self.velocity, self.normal);
        let [resting, _] = self.touch.friction();
        let holds = length(slip) * bodies.substep.seconds() <= FAST * resting * max(missing, 0.0);
        self.state = if self.touch.sticks() && holds { STICKS } else { SLIDES };
        self.fresh = 1;
    }
}

/// A place of a surface as it is seen from where that was seen from in the sub-step before, if rounding has taken a particle through it.
fn as_before(contact: &Contact, last: Vec3) -> Contact {
    let through = contact.distance <= NOTICED * contact.slack && contact.normal.dot(last) <= -SAME;
    let (normal, distance) = (-contact.normal, -contact.distance);
    if through { Contact { normal, distance, ..*contact } } else { *contact }
}

/// Tells whether a surface is where a place of it that is nearest says: who goes from the centre straight on through an edge of a flat floor meets
/// that, which looks elsewhere.
fn is_face(contact: &Contact, from: Vec3, bodies: &Bodies<'_>) -> bool {
    let Contact { point, normal, slack, .. } = *contact;
    let during = [bodies.substep.during[0]; 2];
    let through = Segment { during, ..Segment::new(from, point - normal * (4.0 * slack)) };
    bodies.colliders.first_hit(&through).is_some_and(|hit| hit.normal.dot(normal) >= SAME)
}
