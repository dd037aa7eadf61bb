//! Bodies that lie still sleep: a heap at rest costs next to nothing until something stirs it.
//!
//! Bodies that press on each other sleep together, when none of them has gone farther than a small share of its size for a time in which one that is
//! not held would have fallen many times that far. They stay where they are, at rest, as long as forces do to their particles what they did then.
//! They wake together when that changes, when a body that is awake is about to touch one of them or has pushed it, when the scenery near one of them
//! moves or is another, and when a particle of any body has died. In a scene without forces nothing sleeps, nor does what touches a ball.

use super::super::Bodies;
use super::body::{Body, Made};
use super::lists::Kept;
use super::scenery::{self, DIRECTIONS};
use super::solver;
use crate::math::{length, sqrt};
use glam::Vec3;

/// How long bodies lie still before they sleep: in units of the time √(r/a) in which one falls half its size r.
const AFTER: f32 = 5.0;
/// A body is too fast to sleep at so many times the speed at which it would go a small share of its size in that time.
const SLOW: f32 = 3.0;
/// The share by which forces may change before they wake a body.
const ALIKE: f32 = 1e-3;

/// All that sleep with it are to wake.
const CALLED: u32 = 1;
/// It is to wake at once.
pub(super) const STIRRED: u32 = 2;
/// It sleeps.
const ASLEEP: u32 = 1;
/// It has just fallen asleep: its particles have to be told.
const DROPS: u32 = 2;

impl Body {
    /// Tells whether it moves and does not sleep.
    pub(super) fn is_awake(&self) -> bool {
        self.moves() && self.asleep == 0
    }

    /// Tells whether it sleeps.
    pub(super) fn sleeps(&self) -> bool {
        self.asleep != 0
    }

    /// Tells whether its particles have to be told where they are: not while it sleeps.
    pub(super) fn has_news(&mut self) -> bool {
        let has_news = self.asleep != ASLEEP;
        self.asleep = self.asleep.min(ASLEEP);
        has_news
    }

    /// Begins to watch whether it stays where it is.
    fn watch(&mut self) {
        (self.home, self.home_turn, self.still) = (self.center, self.turn, 0.0);
    }

    pub(super) fn wake(&mut self) {
        self.asleep = 0;
        (self.spare, self.lull) = (0.0, 0);
        self.watch();
    }

    fn fall_asleep(&mut self) {
        self.asleep = DROPS;
        (self.velocity, self.spin, self.omega, self.drift) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
        self.before = [Vec3::ZERO; 2];
    }

    /// Watches it through a step \[s\]; tells whether it has been still for long enough to sleep.
    fn is_still(&mut self, step: f32) -> bool {
        let (driven, small) = (length(self.drive[0]), 2.0 * self.small());
        let wait = AFTER * sqrt(self.radius / driven);
        if !(driven > 0.0 && self.speed() * wait <= SLOW * small) {
            self.watch();
            self.lull = 0;
            return false;
        }
        let [x, y, z, w] = [0, 1, 2, 3].map(|k| self.turn[k] - self.home_turn[k]);
        let far = length(self.center - self.home) + 2.0 * sqrt(x * x + y * y + z * z + w * w) * self.radius;
        if far <= small {
            self.still += step;
            self.lull |= u32::from(self.still >= wait);
        } else {
            // Who has taken so long to go so far creeps, and may sleep.
            self.lull = u32::from(self.still >= wait);
            self.watch();
        }
        self.lull != 0
    }

    /// Lets its particles lie where they are while it sleeps; tells whether that is so. What does otherwise to them than when it fell asleep wakes it.
    pub(super) fn lies(&mut self, bodies: &mut Bodies<'_>, made: Made<'_>) -> bool {
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

/// Says that all wake who sleep with a body.
fn call(all: &mut [Body], number: usize) {
    if all[number].sleeps() {
        let island = all[number].island as usize;
        all[island].calls |= CALLED;
    }
}

/// Wakes all who sleep with one that has been called.
pub(super) fn wake_called(all: &mut [Body]) {
    for number in 1..all.len() {
        if all[number].sleeps() && all[all[number].island as usize].calls != 0 {
            all[number].wake();
        }
    }
    all.iter_mut().for_each(|body| body.calls = 0);
}

/// Wakes those who are stirred; those who sleep with them wake at the end of the sub-step.
pub(super) fn rouse(all: &mut [Body]) {
    for number in 1..all.len() {
        if all[number].calls & STIRRED != 0 {
            let island = all[number].island as usize;
            all[number].calls &= !STIRRED;
            all[number].wake();
            all[island].calls |= CALLED;
        }
    }
}

/// Wakes all.
pub(super) fn wake_all(all: &mut [Body]) {
    all.iter_mut().filter(|body| body.sleeps()).for_each(Body::wake);
}

/// Wakes those around whom the scenery is not as it was.
pub(super) fn look_around(bodies: &Bodies<'_>, kept: &mut Kept<'_>) {
    for number in 1..kept.first_ball() {
        let (body, slots) = (&kept.bodies[number], &kept.scenery[DIRECTIONS * (number - 1)..][..DIRECTIONS]);
        if body.sleeps() && !(scenery::faces(bodies, body) == Some(body.faces) && scenery::holds(bodies, body, slots)) {
            call(kept.bodies, number);
        }
    }
    wake_called(kept.bodies);
}

/// Wakes those whom one that is awake is about to touch in the sub-step.
pub(super) fn look_out(kept: &mut Kept<'_>, h: f32) {
    for pair in &mut kept.pairs[..kept.lists.pairs as usize] {
        let [a, b] = pair.bodies.map(|number| number as usize);
        let asleep = if kept.bodies[a].sleeps() { a } else { b };
        let other = if asleep == a { b } else { a };
        if kept.bodies[asleep].sleeps() && kept.bodies[other].is_awake() && solver::may_touch(kept.bodies, pair, h) {
            call(kept.bodies, asleep);
        }
    }
    wake_called(kept.bodies);
}

/// At the end of a sub-step: wakes with the next one who sleeps with those that have been pushed.
pub(super) fn feel(all: &mut [Body]) {
    for number in 1..all.len() {
        let body = &all[number];
        if body.sleeps() && (body.velocity != Vec3::ZERO || body.spin != Vec3::ZERO) {
            call(all, number);
        }
    }
    wake_called(all);
}

/// At the end of a step: lets those sleep who have lain still for long enough, and all on whom they press.
pub(super) fn settle(bodies: &Bodies<'_>, kept: &mut Kept<'_>) {
    let (step, first) = (bodies.substep.step.seconds(), kept.first_ball());
    let all = &mut *kept.bodies;
    if !all[1..first].iter().any(Body::is_awake) {
        return;
    }
    for (number, body) in all.iter_mut().enumerate() {
        (body.island, body.calls) = (number as u32, 0);
    }
    for pair in kept.pairs[..kept.lists.pairs as usize].iter().filter(|pair| pair.count > 0) {
        let [a, b] = pair.bodies.map(|number| number as usize);
        if all[a].moves() && all[b].moves() {
            let [a, b] = [a, b].map(|number| root(all, number));
            all[a.max(b)].island = a.min(b) as u32;
        }
    }
    for number in 1..all.len() {
        if number < first && !all[number].is_awake() {
            continue;
        }
        let is_ready = number < first && all[number].is_still(step) && {
            let faces = scenery::faces(bodies, &all[number]);
            all[number].faces = faces.unwrap_or(0);
            faces.is_some()
        };
        let root = root(all, number);
        all[number].island = root as u32;
        // Here a call keeps awake.
        all[root].calls |= u32::from(!is_ready);
    }
    for number in 1..first {
        let root = root(all, number);
        all[number].island = root as u32;
        if all[number].is_awake() && all[root].calls == 0 {
            all[number].fall_asleep();
        }
    }
    all.iter_mut().for_each(|body| body.calls = 0);
}

/// The least number among those that a body is joined with so far.
fn root(all: &mut [Body], mut number: usize) -> usize {
    while all[number].island as usize != number {
        let next = all[all[number].island as usize].island;
        all[number].island = next;
        number = next as usize;
    }
    number
}
