//! The answer to a hit on a particle's way: it bounces, or comes to rest on the surface, along which it slides and with which it goes.

use super::air::{Onward, Until};
use super::lead::Lead;
use super::path::Path;
use super::slide::Slide;
use super::sweep::{LAIN, Meeting, RESTING, Sweep};
use super::turn::{Answer, gaining, sent_back};
use crate::force::Friction;
use crate::material::{Mixed, on_surface};
use crate::math::{along, aside, dot, is_zero, length, max, minus, over, plus, scaled, sqrt};
use crate::observe::{Impact, Sliding};
use crate::shape::{Collider, Hit, Ride, Segment};
use crate::time::Time;
use glam::{Mat3, Vec3};

/// The largest number of times that a point beside a hit is sought farther back.
const MAX_RETREATS: u32 = 12;

/// By how much a normal of length one turns at the most on a surface that moves within itself: by what rounding does.
const WITHIN_ITSELF: f32 = 1e-6;

/// The same where the surface curves, of how much it turns as it is taken along.
const WITHIN_ITSELF_CURVED: f32 = 1.0 / 16.0;

/// A particle that a hit brings to rest on a surface.
struct Landing<'r> {
    /// Where it is set off to, and from when to when it goes on.
    beside: Vec3,
    during: [Time; 2],
    /// How the surface moves there \[m/s\], and where it takes it, if it moves: what is held by it, and what slides on one that curves and moves within
    /// itself.
    surface: Vec3,
    ride: Option<&'r Ride>,
    belt: Option<&'r Ride>,
    /// The speed at which it parted from the surface before the hit \[m/s\].
    incoming: f32,
    /// Its velocity along the surface, as seen from there, before friction and after it, and in the world after all \[m/s\].
    came: Vec3,
    slip: Vec3,
    after: Vec3,
    /// Its acceleration in the world \[m/s²\].
    acceleration: Vec3,
    friction: Friction,
}

/// How something slides on: the drive along the surface and what presses \[m/s²\], the way \[m\], and the velocity along it in the end \[m/s\].
struct Slid {
    drive: Vec3,
    pressing: f32,
    way: Vec3,
    end: Vec3,
}

impl Landing<'_> {
    /// How it slides on for a time, as seen from what takes it along.
    fn slid(&self, ride: Option<&Ride>, normal: Vec3, rest: f32) -> Slid {
        let drive = seen(self.acceleration, ride, self.slip);
        // What friction has braked may be pressed no more.
        let pressing = max(-dot(drive, normal), 0.0);
        let drive = along(drive, normal, pressing);
        let (way, end) = Slide { velocity: self.slip, drive, pressing, friction: self.friction }.after(rest);
        Slid { drive, pressing, way, end }
    }

    /// The place and the velocity after a time of what slides on a surface that moves within itself, or along its normal: along the surface it goes as in
    /// a world that stands still, braked as much as it is as seen from there, with such a drive and as fast in the end.
    fn glide(&self, ride: &Ride, normal: Vec3, [drive, end]: [Vec3; 2], rest: f32, pressing: f32) -> (Vec3, Vec3) {
        let Self { beside, slip, after, acceleration, friction, .. } = *self;
        let brakes = friction.kinetic * pressing > 0.0 && rest > 0.0;
        let braked = if brakes { minus(over(minus(end, slip), rest), drive) } else { Vec3::ZERO };
        let (velocity, mean) = (aside(after, normal), plus(aside(acceleration, normal), braked));
        let way = scaled(along(velocity, mean, 0.5 * rest), rest);
        let (raised, rising) = (dot(minus(ride.place, beside), normal), dot(ride.velocity[1], normal));
        (along(plus(beside, way), normal, raised), along(along(velocity, mean, rest), normal, rising))
    }
}

impl<C: Collider + ?Sized> Sweep<'_, C> {
    /// The way on from a hit: the velocity against the surface turned round and scaled by the elasticity, that along it
    /// braked by friction, and for the time that is left the mean acceleration of the path so far, less what brakes it no more.
    ///
    /// Apart, so that what it works out is off the stack when the next hit, or a place beside this one, is sought.
    pub(super) fn rebound(&mut self, path: &Path, meeting: &mut Meeting) -> Path {
        let mut beside = self.set_off(path, meeting, meeting.place);
        if beside != free_of(&meeting.hit, meeting.place) && self.has_missed(path, meeting) {
            beside = self.set_off(path, meeting, meeting.place);
        }
        if let Some(after) = self.after_hits(path, meeting, beside)
            && let Some(along) = self.along_crease(path, meeting, beside, after)
        {
            return along;
        }
        let is_turned = self.is_turned(path, meeting);
        let mut onward = self.leave(path, meeting, beside, is_turned);
        // What moves may have carried it there, and so may constraints.
        if is_zero(meeting.hit.velocity) && self.left.is_none() {
            pay_for(&mut onward, minus(beside, meeting.place), meeting.hit.slack);
        }
        onward
    }

    /// The same from a place beside the hit, which may be one of a chain along a surface that curves.
    #[inline(never)]
    fn leave(&mut self, path: &Path, meeting: &Meeting, beside: Vec3, is_turned: bool) -> Path {
        self.report.hits += 1;
        let Hit { normal, velocity: surface, material, .. } = meeting.hit;
        let mixed = on_surface(self.obstacles.materials, self.elasticity, self.material, material);
        let during = [path.instant(meeting.time), path.during[1]];
        let lead = self.lead(path, meeting.time, normal);
        let mut mean = path.drive();
        if let Some(lead) = &lead {
            mean = plus(mean, lead.acceleration);
        }
        let (place, before) = (meeting.place, path.velocity(meeting.time));
        let incoming = dot(minus(before, surface), normal);
        // Should the velocity already point out, the path left and came back between two chords: it rests.
        let outgoing = if incoming < 0.0 { -incoming * mixed.elasticity } else { incoming };
        let until = Until { path, place, now: during[0], acceleration: mean };
        let [_, _, lain] = answered(before, surface, normal, [incoming, 0.0], &mixed.friction);
        let pressed = self.onward(&until, lain).first;
        // Whoever is set off from the surface has come there with the speed that is left so high.
        let onward = slowed(outgoing, dot(mean, minus(beside, place)));
        let ride = self.ride(&meeting.hit, beside, during);
        let belt = ride.as_ref().and_then(|ride| self.belt(ride, meeting, beside, during));
        let (ride, belt) = (ride.as_ref(), belt.as_ref());
        let goes = ride.map_or(surface, |ride| ride.velocity[0]);
        let pressing = pressing([ride, belt], pressed, aside(minus(before, goes), normal), normal);
        let rests = pressing > 0.0 && (incoming >= 0.0 || 2.0 * onward < RESTING * self.dt * pressing);
        let [outgoing, onward] = if rests { [0.0; 2] } else { [outgoing, onward] };
        // A particle that bounces slips along the place that it touches; one that rests goes as one with the surface.
        let whole = match ride {
            Some(ride) if rests => aside(minus(ride.velocity[0], surface), normal),
            _ => Vec3::ZERO,
        };
        let surface = plus(surface, whole);
        let [came, mut slip, mut after] = answered(before, surface, normal, [incoming, outgoing], &mixed.friction);
        let going = self.onward(&until, after);
        // A surface that moves within itself turns what it has no hold of as if it stood still; of those that move otherwise nothing is known.
        let is_turned = is_turned && (belt.is_some() || is_zero(meeting.hit.velocity));
        let answer = Answer { raised: minus(beside, place), speeds: [incoming, outgoing], rests };
        let gain = answer.gain(mean, is_turned, path.pull.is_some());
        if gain != 0.0 {
            let carried = belt.filter(|_| is_turned).map_or(Vec3::ZERO, |_| aside(surface, normal));
            slip = minus(gaining(plus(slip, carried), gain), carried);
            after = along(plus(surface, slip), normal, outgoing);
        }
        let mut told = [before, after];
        self.answer_left(&meeting.hit, &mixed, surface, [incoming, outgoing], &mut told);
        self.tell(path, meeting, surface, told);
        if !rests {
            let fast = along(plus(surface, slip), normal, onward);
            let from =
                if self.lies(path, meeting, [surface, fast], going.mean) { lain_to(path, meeting) } else { beside };
            let pull = is_turned.then_some(going.mean);
            let mut onward = Path { pull, ..Path::onward(from, fast, going.mean, during) };
            self.lead_on(&lead, &mut onward, None);
            return onward;
        }
        let (friction, acceleration) = (mixed.friction, going.held(normal));
        let landing =
            Landing { beside, during, surface, ride, belt, incoming, came, slip, after, acceleration, friction };
        self.stay(path, meeting, &lead, landing)
    }

    /// Tells of a hit, if anybody wants to know.
    #[inline(always)]
    fn tell(&mut self, path: &Path, meeting: &Meeting, surface: Vec3, [before, after]: [Vec3; 2]) {
        let Self { id, row, mass, .. } = *self;
        let (place, normal, time) = (meeting.place, meeting.hit.normal, path.instant(meeting.time));
        if let Some(observer) = &mut self.observer {
            let closing = max(-dot(minus(before, surface), normal), 0.0);
            observer.hit(&Impact { id, row, other: None, mass, place, normal, closing, before, after, surface, time });
        }
    }

    /// Tells that of a slide which has been told of as a whole the part after a fraction of its path is not gone, if anybody wants to know.
    #[inline(never)]
    pub(super) fn tell_cut(&mut self, path: &Path, time: f32, slack: f32) {
        let (true, Some(pull)) = (self.observer.is_some(), path.pull) else { return };
        let (_, seat) = self.faces(path.x0, slack, path.during[0]);
        let surface = seat.map_or(Vec3::ZERO, |seat| seat.velocity);
        let back = [pull, minus(path.at(time), path.x1), path.v1, path.velocity(time)];
        let [_, way, first, last] = back;
        let way = along(way, surface, path.duration() * (1.0 - time));
        let seen = [pull, way, minus(first, surface), minus(last, surface)];
        if let Some(observer) = &mut self.observer {
            observer.slid(&Sliding { mass: self.mass, raised: Vec3::ZERO, world: back, along: seen });
        }
    }

    /// Tells whether a hit leaves lying what constraints have moved, which shows no force that would press it on: it leaves it the speed of the surface alone.
    fn lies(&self, path: &Path, meeting: &Meeting, [surface, fast]: [Vec3; 2], mean: Vec3) -> bool {
        let is_left = self.left.as_deref().is_some_and(|left| *left == surface);
        is_left && is_zero(mean) && fast == surface && has_lain(path, meeting, meeting.place)
    }

    /// How it goes on with another velocity. What constraints have moved is driven by the velocity that they have left it.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn onward(&self, until: &Until<'_>, velocity: Vec3) -> Onward {
        let air = self.air.filter(|_| self.left.is_none());
        air.map_or(until.unchanged(), |air| air.onward(until, velocity))
    }

    /// Answers with a hit the velocity that constraints have left, if they have: tells what it was and is. That of the way, which comes in and goes out
    /// so fast, is the mean of the sub-step; what forces have changed since presses on the surface, or is taken off the rebound, as they go on
    /// after it. A push that has brought it there and left no such velocity is no blow: it cannot be told from a force that has acted away from the surface, which then
    /// leaves a rebound somewhat too slow.
    #[cfg_attr(one_by_one, inline(never))]
    fn answer_left(
        &mut self,
        hit: &Hit,
        mixed: &Mixed,
        surface: Vec3,
        [incoming, outgoing]: [f32; 2],
        told: &mut [Vec3; 2],
    ) {
        let Some(left) = &mut self.left else { return };
        let relative = minus(**left, surface);
        let closing = dot(relative, hit.normal);
        let since = closing - incoming;
        let leaving = match () {
            () if !(since > 0.0) => max(outgoing + since, 0.0),
            () if closing < 0.0 => -closing * mixed.elasticity,
            () => closing,
        };
        let came = along(relative, hit.normal, -closing);
        let slip = plus(came, mixed.friction.answer(came, leaving - closing));
        let after = along(plus(surface, slip), hit.normal, leaving);
        *told = [core::mem::replace(*left, after), after];
    }

    /// The way on of a particle that a hit brings to rest on a surface: along that and with it, for the time that is left.
    #[inline(always)]
    fn stay(&mut self, path: &Path, meeting: &Meeting, lead: &Option<Lead>, landing: Landing<'_>) -> Path {
        let Landing { beside, during, surface, incoming, came, slip, after, .. } = landing;
        let (place, rest) = (meeting.place, (during[1] - during[0]).seconds());
        let normal = meeting.hit.normal;
        let on_belt =
            landing.belt.filter(|_| !is_zero(slip)).map(|belt| (Some(belt), landing.slid(Some(belt), normal, rest)));
        let (ride, Slid { drive, pressing, way, end }) = match on_belt {
            Some(slides) if !is_zero(slides.1.end) => slides,
            _ => (landing.ride, landing.slid(landing.ride, normal, rest)),
        };
        if let (Some(left), Some(ride)) = (&mut self.left, ride) {
            **left = plus(**left, minus(ride.velocity[1], ride.velocity[0]));
        }
        let (stays, pull) = (is_zero(slip) && is_zero(end), Some(landing.acceleration));
        let mut onward = if let Some(ride) = ride {
            // A particle that falls from where it was set off to goes along the surface meanwhile, which friction would
            // have kept it from.
            let fell = -incoming / pressing;
            let lay = stays && incoming < 0.0 && -incoming * fell < 2.0 * LAIN * meeting.hit.slack;
            let crept = if lay { scaled(came, 0.5 * fell) } else { Vec3::ZERO };
            // Only friction takes it along a surface that moves within itself, and not how that turns.
            let glides = !is_zero(end) && length(minus(ride.turn * normal, normal)) <= WITHIN_ITSELF;
            let (x1, v1) =
                if glides { landing.glide(ride, normal, [drive, end], rest, pressing) } else { ride.after(way, end) };
            Path { x0: beside, v0: after, x1: minus(x1, crept), v1, during, pull }
        } else {
            // Where what moves would take it is not known here.
            let stays = stays && is_zero(surface) && has_lain(path, meeting, place);
            let x0 = if stays { path.x0 } else { beside };
            Path { x0, v0: after, x1: plus(along(x0, surface, rest), way), v1: plus(surface, end), during, pull }
        };
        let along = [drive, way, slip, end];
        if let Some(observer) = &mut self.observer {
            let world = [landing.acceleration, minus(onward.x1, onward.x0), onward.v0, onward.v1];
            observer.slid(&Sliding { mass: self.mass, raised: minus(onward.x0, place), world, along });
        }
        self.lead_on(lead, &mut onward, Some(&along));
        onward
    }

    /// Where the surface of a hit would take a particle beside it by the end of the path, if it moves.
    fn ride(&self, hit: &Hit, beside: Vec3, during: [Time; 2]) -> Option<Ride> {
        let below = along(beside, hit.normal, -(LAIN * hit.slack));
        let seat = Segment { from: beside, to: below, radius: self.radius, during };
        if is_zero(hit.velocity) { None } else { self.walls.ride(&seat) }
    }

    /// The same where the surface curves, turns as it goes, and yet is where it was beside the hit, as that of a drum is that spins about its own axis: what
    /// slides is taken along as by a belt, which does not turn, and meets the curve as it would if that stood still.
    fn belt(&self, ride: &Ride, meeting: &Meeting, beside: Vec3, during: [Time; 2]) -> Option<Ride> {
        let Hit { normal, slack, .. } = meeting.hit;
        let turned = length(minus(ride.turn * normal, normal));
        if turned <= WITHIN_ITSELF {
            return None;
        }
        let to = along(beside, normal, -(LAIN * slack));
        let [now, then] = during
            .map(|instant| Segment { from: beside, to, radius: self.radius, during: [instant; 2] })
            .map(|seat| self.walls.first_hit(&seat));
        let (now, then) = (now?, then?);
        let (moved, turns) = (LAIN * (then.time - now.time).abs(), length(minus(then.normal, now.normal)));
        if !(moved <= 1.0 && turns <= WITHIN_ITSELF_CURVED * turned) {
            return None;
        }
        let time = (during[1] - during[0]).seconds();
        let velocity = [ride.velocity[0], then.velocity].map(|velocity| aside(velocity, normal));
        let acceleration = if time > 0.0 { over(minus(velocity[1], velocity[0]), time) } else { Vec3::ZERO };
        let place = along(beside, plus(velocity[0], velocity[1]), 0.5 * time);
        Some(Ride { place, velocity, acceleration, spin: [Vec3::ZERO; 2], turn: Mat3::IDENTITY })
    }

    /// A point beside the hit that is surely on the side the path came from: off the surface by twice its slack, if the
    /// way there is free; else as far back on the path as is free, at last where the chord begins, or where that is carried
    /// to, or has gone after what goes away from it. A surface that moves takes what is back on the path along to the instant of the hit.
    #[inline(never)]
    fn set_off(&self, path: &Path, meeting: &Meeting, place: Vec3) -> Vec3 {
        let Meeting { chord, hit, begun, time: s, .. } = meeting;
        let now = path.instant(*s);
        let span = (now - chord.during[0]).seconds();
        let (moves, advance) = (!is_zero(hit.velocity), dot(hit.velocity, hit.normal));
        let share = max(s - begun, f32::MIN_POSITIVE);
        let taken = |point: Vec3, time: f32| {
            if advance == 0.0 { point } else { along(point, hit.normal, advance * (span * ((s - time) / share))) }
        };
        let free = |segment: Segment| self.walls.first_hit(&segment).is_none();
        let closing = max(advance - dot(path.velocity(*s), hit.normal), f32::MIN_POSITIVE);
        let beside = free_of(hit, place);
        // As a fraction of the path, like all its instants.
        let mut back = 2.0 * hit.slack / (closing * path.duration());
        // At a rim or in a corner another surface may be nearer than the slack of this one.
        for _ in 0..MAX_RETREATS {
            let time = max(s - back, *begun);
            let before = taken(path.at(time), time);
            if free(Segment { to: before, during: [chord.during[0], now], ..*chord }) {
                let aside = |to: Vec3| Segment { from: before, to, during: [now; 2], ..*chord };
                if free(aside(beside)) {
                    return beside;
                }
                // Where the surface turns, the hit may lie deeper in it than its slack says: beside it is off where that is.
                let raised = along(beside, hit.normal, length(minus(before, beside)));
                let down = Segment { from: raised, to: beside, during: [now; 2], ..*chord };
                let surface = self.walls.first_hit(&down).filter(|_| moves);
                let off = surface.map(|there| along(down.at(there.time), there.normal, 2.0 * there.slack));
                return off.filter(|&off| free(aside(off))).unwrap_or_else(|| self.off_crease(path, meeting, before));
            }
            back *= 4.0;
        }
        let during = [chord.during[0], now];
        let left = if advance < 0.0 { self.gone_after(hit, chord.from, during) } else { None };
        let from = left.unwrap_or_else(|| self.walls.carry(chord.from, self.radius, during));
        self.off_crease(path, meeting, from)
    }

    /// Where something is, off it by as much as what rests, that lies on a surface within rounding and has gone after it as that has gone away: it runs over nobody.
    #[inline(never)]
    fn gone_after(&self, hit: &Hit, from: Vec3, during: [Time; 2]) -> Option<Vec3> {
        let [raised, below] = [2.0, -LAIN].map(|slacks| along(from, hit.normal, slacks * hit.slack));
        let Ride { place: to, .. } =
            self.walls.ride(&Segment { from: raised, to: below, radius: self.radius, during })?;
        let way = Segment { from, to, radius: self.radius, during };
        self.walls.carry_on(&way).or(Some(to))
    }
}

/// Lets a way on pay for such a way back, if that is far: it has not got since what it had got along the drive.
#[inline(never)]
fn pay_for(onward: &mut Path, back: Vec3, slack: f32) {
    let time = onward.duration();
    if !(length(back) > LAIN * slack && time > 0.0) {
        return;
    }
    let drive = over(minus(onward.v1, onward.v0), time);
    let change = minus(sent_back(onward.v0, back, drive), onward.v0);
    (onward.v0, onward.v1) = (plus(onward.v0, change), plus(onward.v1, change));
    onward.x1 = along(onward.x1, change, time);
}

/// A place beside a surface that is off it by as much as what rests on it is.
pub(super) fn free_of(hit: &Hit, place: Vec3) -> Vec3 {
    along(place, hit.normal, 2.0 * hit.slack)
}

/// The velocity that something has along a surface, as seen from there, before friction and after it, and in the world after all, where it comes in
/// and goes out so fast.
#[cfg_attr(one_by_one, inline(never))]
pub(super) fn answered(
    before: Vec3,
    surface: Vec3,
    normal: Vec3,
    [incoming, outgoing]: [f32; 2],
    friction: &Friction,
) -> [Vec3; 3] {
    let came = along(minus(before, surface), normal, -incoming);
    let slip = plus(came, friction.answer(came, outgoing - incoming));
    [came, slip, along(plus(surface, slip), normal, outgoing)]
}

/// By how much an acceleration presses on a surface \[m/s²\], as seen from what takes something along that slips so fast: from what would hold it, or from a belt,
/// if the surface is one for what slides.
fn pressing([ride, belt]: [Option<&Ride>; 2], acceleration: Vec3, slip: Vec3, normal: Vec3) -> f32 {
    let by = |ride| -dot(seen(acceleration, ride, slip), normal);
    belt.map_or(by(ride), |belt| max(by(ride), by(Some(belt))))
}

/// An acceleration as what takes along sees it that so fast a slip goes along: without its own, and Coriolis's.
fn seen(acceleration: Vec3, ride: Option<&Ride>, slip: Vec3) -> Vec3 {
    ride.map_or(acceleration, |ride| minus(acceleration, ride.acceleration_of(slip)))
}

/// Where what lies on a surface is at the instant at which a path hits that: off it as where the path begins.
fn lain_to(path: &Path, meeting: &Meeting) -> Vec3 {
    along(path.x0, meeting.hit.velocity, path.duration() * meeting.time)
}

/// Tells whether a path begins as what lay on the surface that it hits leaves off: nearby, and hardly moving as seen from there.
/// Falling onto it anew each step, it has not moved at all; else it would creep.
fn has_lain(path: &Path, meeting: &Meeting, place: Vec3) -> bool {
    let near = LAIN * meeting.hit.slack;
    let (off, fast) = (minus(lain_to(path, meeting), place), minus(path.v0, meeting.hit.velocity));
    dot(off, off) <= near * near && length(fast) * (path.duration() * meeting.time) <= near
}

/// A speed after a way along which it gains `work` \[m²/s²\], a share of the square of it; none, where that takes more.
fn slowed(speed: f32, work: f32) -> f32 {
    let square = speed * speed + 2.0 * work;
    // The change by itself, whose rounding is much less than that of the whole.
    if square > 0.0 { speed + 2.0 * work / (speed + sqrt(square)) } else { 0.0 }
}
