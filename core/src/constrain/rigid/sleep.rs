//! Bodies that lie still sleep: a heap at rest costs next to nothing until something stirs it.
//!
//! A body sleeps when neither it nor any that it touches has gone farther than a small share of its size for a time in which one that is not held
//! would have fallen many times that far. It stays where it is, at rest, as long as forces do to its particles what they did then; who is awake
//! and lies on it finds it fixed. It wakes alone when that presses on it otherwise than it did, and with those around when it is struck, so far
//! as the blow is hard: what is farther off would not be moved by it. All that sleep and touch wake together when forces or the scenery change,
//! and all when a particle of any body has died. In a scene without forces nothing sleeps, nor does what touches a ball.

use super::super::Bodies;
use super::super::union::{Bound, root, unite};
use super::body::Body;
use super::kept::Kept;
use super::manifold::{DIRECTIONS, Manifold};
use super::span::Span;
use super::{scenery, solver};
use crate::math::{length, max, sqrt};
use glam::Vec3;

/// How long bodies lie still before they sleep: in units of the time √(r/a) in which one falls half its size r.
const AFTER: f32 = 5.0;
/// A body is too fast to sleep at so many times the speed at which it would go a small share of its size in that time.
const SLOW: f32 = 3.0;
/// The share by which forces may change before they wake a body.
pub(super) const ALIKE: f32 = 1e-3;

/// The share by which what presses on a body may change before that wakes it: as much as impulses that are sought in a few passes do.
const PRESSED_ALIKE: f32 = 0.5;

/// A blow that would wake bodies more contacts away than this wakes all that sleep together.
const RINGS: f32 = 64.0;
/// The share of the time after which bodies sleep for which one is awake that has been freed, if it stays where it is.
const TRIAL: f32 = 0.25;
/// It is to be freed.
const FREED: u32 = 4;

/// It does not lie still.
const RESTLESS: u32 = 1;
/// Something that it touches does not.
const UNEASY: u32 = 2;

/// It is carried by scenery that moves, or by one that is.
const BORNE: u32 = 3;

/// All that sleep with it are to wake.
const CALLED: u32 = 1;
/// It is to wake at once.
pub(super) const STIRRED: u32 = 2;
/// It sleeps.
const ASLEEP: u32 = 1;
/// It has just fallen asleep: its particles have to be told.
const DROPS: u32 = 2;

impl Bound for Body {
    fn bound(&mut self) -> &mut u32 {
        &mut self.island
    }
}

impl Body {
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
        (self.before, self.whirl) = ([Vec3::ZERO; 2], 0.0);
    }

    /// For how long it has to lie still before it sleeps \[s\]; of what nothing drives no number, or infinitely long.
    fn wait(&self) -> f32 {
        AFTER * sqrt(self.radius / length(self.drive[0]))
    }

    /// Tells whether it is slow enough to sleep, and driven.
    fn is_slow(&self) -> bool {
        let far = self.speed() * self.wait();
        far <= SLOW * 2.0 * self.small()
    }

    /// Watches it through a step \[s\]; tells whether it has been still for long enough to sleep.
    fn is_still(&mut self, step: f32) -> bool {
        let (wait, small) = (self.wait(), 2.0 * self.small());
        if !(wait < f32::INFINITY && self.is_slow()) {
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
    if all.iter().all(|body| body.calls == 0) {
        return;
    }
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

/// Wakes those who have touched one that is no longer listed beside them, and all who sleep with them.
pub(super) fn miss(all: &mut [Body], before: &[Manifold], pairs: &[Manifold]) {
    let (mut is_any, mut pairs) = (false, pairs.iter().peekable());
    for gone in before.iter().filter(|pair| pair.count > 0) {
        // Both lists are in the same order.
        while pairs.next_if(|pair| pair.key() < gone.key()).is_some() {}
        if pairs.peek().is_some_and(|pair| pair.key() == gone.key() && pair.count > 0) {
            continue;
        }
        gone.bodies.iter().for_each(|&number| call(all, number as usize));
        is_any = true;
    }
    if is_any {
        wake_called(all);
    }
}

/// Wakes those around whom the scenery is not as it was.
pub(super) fn look_around(bodies: &Bodies<'_>, kept: &mut Kept<'_>) {
    for number in 1..kept.first_ball() {
        let body = &kept.bodies[number];
        let slots = &kept.scenery[DIRECTIONS * (number - 1)..][..(body.met as usize).min(DIRECTIONS)];
        let is_as_before = || scenery::faces(bodies, body, slots) == Some(body.faces);
        if body.sleeps() && !(is_as_before() && scenery::holds(bodies, body, slots)) {
            call(kept.bodies, number);
        }
    }
    wake_called(kept.bodies);
}

/// Wakes those whom one that is awake is about to touch in the sub-step, unless it has lain against them since before they slept and lies still.
/// Where it is a blow, those around wake as well: so many contacts away as it is times faster than what forces do in a step, and it times heavier.
pub(super) fn look_out(kept: &mut Kept<'_>, span: Span) {
    let all = &mut *kept.bodies;
    for pair in &mut kept.pairs[..kept.lists.pairs as usize] {
        let [a, b] = pair.bodies.map(|number| number as usize);
        let asleep = if all[a].sleeps() { a } else { b };
        let other = if asleep == a { b } else { a };
        if !all[asleep].sleeps() {
            pair.rested = 0;
        } else if all[other].is_awake() {
            if pair.rested != 0 && pair.count == 0 {
                // What it lay against, or what lay on it, has gone.
                pair.rested = 0;
                all[asleep].calls |= FREED;
                continue;
            }
            if pair.rested != 0 && all[other].is_slow() {
                continue;
            }
            let Some(closing) = solver::meeting(all, pair, span.h) else { continue };
            let (calm, times) =
                (length(all[other].drive[0]) * span.step, all[asleep].inverse_mass / all[other].inverse_mass);
            if closing <= calm {
                all[asleep].calls |= FREED;
            } else {
                strike(all, asleep, 1.0 + closing / calm * max(times, 1.0));
            }
        }
    }
    stir(all, &kept.pairs[..kept.lists.pairs as usize]);
}

/// Says that those wake who are so many contacts or fewer from one that is struck.
fn strike(all: &mut [Body], number: usize, rings: f32) {
    if rings <= RINGS {
        all[number].rings = all[number].rings.max(rings as u32);
    } else {
        call(all, number);
    }
}

/// Wakes those who are so many contacts or fewer from one that is struck.
fn wake_around(all: &mut [Body], pairs: &[Manifold]) {
    if all.iter().all(|body| body.rings == 0) {
        return;
    }
    for _ in 0..RINGS as u32 {
        let mut is_changed = false;
        for pair in pairs.iter().filter(|pair| pair.count > 0) {
            let [a, b] = pair.bodies.map(|number| number as usize);
            let next = all[a].rings.max(all[b].rings).saturating_sub(1);
            for number in [a, b] {
                if all[number].sleeps() && all[number].rings < next {
                    all[number].rings = next;
                    is_changed = true;
                }
            }
        }
        if !is_changed {
            break;
        }
    }
    for body in all.iter_mut().filter(|body| body.rings != 0) {
        body.rings = 0;
        body.wake();
    }
}

/// At the end of a sub-step: wakes with the next one who sleeps with those that have been pushed, or are pressed on otherwise than when they fell
/// asleep. `touching` are the numbers of those pairs that touch and are awake.
pub(super) fn feel(all: &mut [Body], pairs: &[Manifold], touching: &[u32], span: Span) {
    for number in 1..all.len() {
        let body = &all[number];
        if body.sleeps() && (body.velocity != Vec3::ZERO || body.spin != Vec3::ZERO) {
            strike(all, number, 1.0 + body.speed() / (length(body.drive[0]) * span.step));
        }
    }
    let touching = touching.iter().filter_map(|&number| pairs.get(number as usize));
    for pair in touching.filter(|pair| pair.rested != 0 && pair.count > 0) {
        let [a, b] = pair.bodies.map(|number| &all[number as usize]);
        if !(a.is_awake() || b.is_awake()) {
            continue;
        }
        let side = usize::from(b.sleeps());
        let (body, [force, torque]) = ([a, b][side], pair.load(span.h));
        let most = PRESSED_ALIKE * (length(body.drive[0]) + length(pair.loads[0]) * body.inverse_mass);
        let [force, torque] = [force - pair.loads[0], torque - pair.loads[1]].map(|by| length(by) * body.inverse_mass);
        if !(force <= most && torque <= most * body.radius) {
            all[pair.bodies[side] as usize].calls |= FREED;
        }
    }
    stir(all, pairs);
}

/// Wakes those who are to be freed, who are struck, and who sleep with those that have been called.
fn stir(all: &mut [Body], pairs: &[Manifold]) {
    if all.iter().any(|body| body.calls | body.rings != 0) {
        free(all);
        wake_around(all, pairs);
        wake_called(all);
    }
}

/// Wakes those who are to be freed: alone, and for as long as it takes to see whether they stay where they are.
fn free(all: &mut [Body]) {
    for body in all.iter_mut().filter(|body| body.calls & FREED != 0) {
        body.calls &= !FREED;
        body.wake();
        let wait = body.wait();
        body.still = if wait < f32::INFINITY { wait * (1.0 - TRIAL) } else { 0.0 };
    }
}

/// At the end of a step: lets those sleep who have lain still for long enough, if all that they touch have.
pub(super) fn settle(bodies: &Bodies<'_>, kept: &mut Kept<'_>) {
    let (step, first) = (bodies.substep.step.seconds(), kept.first_ball());
    let Kept { bodies: all, pairs, lists, scenery, .. } = kept;
    let pairs = &mut pairs[..lists.pairs as usize];
    if !all[1..first].iter().any(Body::is_awake) {
        return;
    }
    for (number, body) in all.iter_mut().enumerate() {
        // Here a call keeps awake.
        body.calls = 0;
        if body.is_awake() {
            body.calls = RESTLESS;
            if number < first && body.is_still(step) {
                let slots = scenery.chunks(DIRECTIONS).nth(number - 1).unwrap_or(&[]);
                let faces = scenery::faces(bodies, body, slots);
                body.faces = faces.unwrap_or(0);
                body.calls = if faces.is_some() { 0 } else { BORNE };
            }
        }
    }
    bear(all, pairs);
    for pair in pairs.iter().filter(|pair| pair.count > 0) {
        let [a, b] = pair.bodies.map(|number| number as usize);
        for [one, other] in [[a, b], [b, a]] {
            if all[one].calls == RESTLESS && all[other].calls == 0 {
                all[other].calls = UNEASY;
            }
        }
    }
    let mut falls = false;
    for body in all[1..first].iter_mut() {
        if body.is_awake() && body.calls == 0 {
            body.fall_asleep();
            falls = true;
        }
    }
    all.iter_mut().for_each(|body| body.calls = 0);
    if falls {
        join(all, pairs, bodies.substep.seconds());
    }
}

/// Keeps awake who is carried by what scenery carries that moves, so many contacts away at the most.
fn bear(all: &mut [Body], pairs: &[Manifold]) {
    for _ in 0..RINGS as u32 {
        let mut is_changed = false;
        for pair in pairs.iter().filter(|pair| pair.count > 0) {
            let [a, b] = pair.bodies.map(|number| number as usize);
            for [one, other] in [[a, b], [b, a]] {
                if all[one].calls == BORNE && all[other].is_awake() && all[other].calls != BORNE {
                    all[other].calls = BORNE;
                    is_changed = true;
                }
            }
        }
        if !is_changed {
            break;
        }
    }
}

/// Finds who sleep together, and notes what presses on those that have just fallen asleep.
fn join(all: &mut [Body], pairs: &mut [Manifold], h: f32) {
    for (number, body) in all.iter_mut().enumerate() {
        body.island = number as u32;
    }
    for pair in pairs.iter_mut().filter(|pair| pair.count > 0) {
        let [a, b] = pair.bodies.map(|number| number as usize);
        if pair.rested == 0 && (all[a].asleep == DROPS || all[b].asleep == DROPS) {
            (pair.rested, pair.loads) = (1, pair.load(h));
        }
        if all[a].sleeps() && all[b].sleeps() {
            unite(all, a as u32, b as u32);
        }
    }
    for number in 1..all.len() {
        all[number].island = root(all, number as u32);
    }
}
