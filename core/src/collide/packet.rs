//! Eight paths past one flat face, side by side: of those who lie on it, and of those who bounce off it once.
//!
//! Every number is made as `Sweep` makes it, in the same order, and so has the same bits. Whoever needs more than this is left
//! to that: two hits in a step, a hit after which it rests, a place that is not free.

use super::path::{CHORD_ERROR, MAX_CHORDS};
use super::sweep::{LAIN, MAX_LOOKS, RESTING};
use crate::lanes::{Eight, LANES, Vectors, max, min, negated, not};
use crate::shape::Face;
use crate::time::Time;
use glam::Vec3;

/// Eight cubics, as `Path`.
#[derive(Clone, Copy)]
pub(super) struct Paths<F> {
    pub(super) x0: Vectors<F>,
    pub(super) v0: Vectors<F>,
    pub(super) x1: Vectors<F>,
    pub(super) v1: Vectors<F>,
    /// How long they take \[s\].
    pub(super) time: F,
}

/// The same as polynomials.
struct Cubics<F> {
    start: Vectors<F>,
    coefficients: [Vectors<F>; 3],
    /// Half the change of velocity as a way, and how much farther the cubic leads.
    bend: Vectors<F>,
    excess: Vectors<F>,
}

/// Straight pieces of them.
struct Segments<F> {
    from: Vectors<F>,
    to: Vectors<F>,
}

impl<F: Eight> Segments<F> {
    #[inline(always)]
    fn at(&self, time: F) -> Vectors<F> {
        self.from + (self.to - self.from) * time
    }

    /// Where balls that go along them first meet a face.
    #[inline(always)]
    fn first_hits(&self, face: &Face, radius: F) -> Hits<F> {
        let Self { from, to } = *self;
        let (like, [point, normal, unit]) = (radius, face.vectors());
        let (zero, one) = (like.all(0.0), like.all(1.0));
        let (point, normal, unit) =
            (Vectors::splat(like, point), Vectors::splat(like, normal), Vectors::splat(like, unit));
        let size = like.all(face.size());
        let slack = like.all(4.0 * f32::EPSILON) * (max(from.largest(), to.largest()) + radius + size);
        let (before, after) = (normal.dot(from - point), normal.dot(to - point));
        let falls = before.simd_ge(zero) & after.simd_le(zero) & before.simd_gt(after);
        let rises = before.simd_lt(zero) & after.simd_ge(zero);
        let time = min(max(before / (before - after), zero), one);
        let center = Hits { are: falls | rises, time, normal: Vectors::select(falls, unit, -unit), slack };
        let wide = radius.simd_gt(slack);
        if !wide.any() {
            return center;
        }
        let start = unit.dot(from - point);
        let normal = Vectors::select(start.simd_lt(zero), -unit, unit);
        let (room, closing) = (start.abs() - radius, negated(normal.dot(to - from)));
        let time = max(room, zero) / closing;
        let touched = wide & closing.simd_gt(zero) & time.simd_le(one);
        let is_first = touched & not(center.are & center.time.simd_lt(time));
        let mut hits = center;
        hits.take(is_first, Hits { are: touched, time, normal, slack });
        hits
    }
}

impl<F: Eight> Hits<F> {
    /// Takes some from others.
    #[inline(always)]
    fn take(&mut self, mask: F, others: Self) {
        self.are = self.are | mask;
        self.time = mask.select(others.time, self.time);
        self.normal = Vectors::select(mask, others.normal, self.normal);
        self.slack = mask.select(others.slack, self.slack);
    }
}

impl<F: Eight> Meetings<F> {
    fn none(place: Vectors<F>, unclear: F) -> Self {
        let (like, zero) = (unclear, unclear.all(0.0));
        let hits = Hits { are: zero, time: zero, normal: Vectors::splat(like, Vec3::ZERO), slack: zero };
        Self { hits, unclear, place, begun: zero, chord_from: place }
    }

    /// Takes those that chords have found before `end` to their instants on the paths.
    #[inline(always)]
    fn put_on_path(&mut self, paths: &Paths<F>, cubics: &Cubics<F>, face: &Face, radius: F, end: F) {
        let all = |x| radius.all(x);
        let time = cubics.crossings(&self.hits, self.place, [self.begun, end]);
        let place = cubics.at(time);
        let is_far = (place - self.place).length().simd_gt(all(16.0) * self.hits.slack) & self.hits.are;
        self.hits.time = time;
        self.place = place;
        if !is_far.any() {
            return;
        }
        // A place far along the surface from that on the chord asks for the surface there.
        let reach = (end - self.begun) * all(1.0 / 16.0);
        let [from, to] = [max(time - reach, self.begun), min(time + reach, end)];
        let begin = Vectors::select(from.simd_eq(all(0.0)), paths.x0, cubics.at(from));
        let piece = Segments { from: begin, to: Vectors::select(to.simd_eq(all(1.0)), paths.x1, cubics.at(to)) };
        let near = piece.first_hits(face, radius);
        let are = is_far & near.are & near.normal.dot(self.hits.normal).simd_gt(all(0.0));
        let time = cubics.crossings(&near, piece.at(near.time), [from, to]);
        self.place = Vectors::select(are, cubics.at(time), self.place);
        self.hits.take(are, Hits { time, ..near });
    }
}

/// Where some of them meet the face.
struct Hits<F> {
    /// Which do.
    are: F,
    time: F,
    normal: Vectors<F>,
    slack: F,
}

/// The same on the paths.
struct Meetings<F> {
    hits: Hits<F>,
    /// Those whose place could not be told here.
    unclear: F,
    place: Vectors<F>,
    begun: F,
    chord_from: Vectors<F>,
}

/// Properties of eight particles that decide how they meet a face.
pub(super) struct Riders<F> {
    pub(super) radius: F,
    pub(super) elasticity: F,
    /// Coefficients of friction.
    pub(super) at_rest: F,
    pub(super) kinetic: F,
}

/// How many hits of a particle in a step are found in packets.
const ROUNDS: usize = 4;

/// The outcome of a packet: a bit for each particle.
pub(super) struct Outcome {
    /// Particles that are at the end of the step now, those of them that were hit, were so again ..., and those to be followed alone.
    pub(super) settled: u32,
    pub(super) hits: [u32; ROUNDS],
    pub(super) left: u32,
    /// Places and velocities, coordinate by coordinate.
    pub(super) ends: [[[f32; LANES]; 3]; 2],
}

impl<F: Eight> Paths<F> {
    /// The first of two where a mask says so, else the second.
    #[inline(always)]
    fn select(mask: F, a: Self, b: Self) -> Self {
        Self {
            x0: Vectors::select(mask, a.x0, b.x0),
            v0: Vectors::select(mask, a.v0, b.v0),
            x1: Vectors::select(mask, a.x1, b.x1),
            v1: Vectors::select(mask, a.v1, b.v1),
            time: mask.select(a.time, b.time),
        }
    }

    /// Where they lead, and the velocities there.
    #[inline(always)]
    fn ends(&self) -> [[[f32; LANES]; 3]; 2] {
        [self.x1.columns(), self.v1.columns()]
    }

    #[inline(always)]
    fn acceleration(&self) -> Vectors<F> {
        (self.v1 - self.v0) / self.time
    }

    /// Those of which all numbers are finite, and their sums.
    #[inline(always)]
    fn are_finite(&self) -> F {
        let zero = self.time.all(0.0);
        let nought = (self.x0 + self.v0 + self.x1 + self.v1) * zero;
        let [x, y, z] = nought.0;
        (x + y + z).simd_eq(zero)
    }

    #[inline(always)]
    fn cubics(&self) -> Cubics<F> {
        let all = |x| self.time.all(x);
        let half = all(0.5) * self.time;
        let excess = (self.x1 - self.x0) - (self.v0 + self.v1) * half;
        let noticed = |axis: usize| {
            let (excess, rounding) = (excess.0[axis], self.x0.0[axis].abs() + self.x1.0[axis].abs());
            excess & not(excess.abs().simd_le(rounding * all(f32::EPSILON)))
        };
        let excess = Vectors([noticed(0), noticed(1), noticed(2)]);
        let bend = (self.v1 - self.v0) * half;
        let coefficients = [self.v0 * self.time, bend + excess * all(3.0), excess * all(-2.0)];
        Cubics { start: self.x0, coefficients, bend, excess }
    }

    /// Their velocities at fractions of their times.
    #[inline(always)]
    fn velocity(&self, cubics: &Cubics<F>, s: F) -> Vectors<F> {
        let Cubics { bend, excess, .. } = *cubics;
        let steady = self.v0 + (self.v1 - self.v0) * s;
        let all = |x| s.all(x);
        let is_smooth = not(excess.is_zero()) & excess.dot(excess).simd_lt(all(0.0625) * bend.dot(bend));
        let share = all(6.0) * s * (all(1.0) - s) / self.time;
        Vectors::select(is_smooth, steady + excess * share, steady)
    }

    /// Where those who are asked for first meet a face.
    #[inline(always)]
    fn first_meetings(&self, cubics: &Cubics<F>, face: &Face, radius: F, asked: F) -> Meetings<F> {
        let all = |x| radius.all(x);
        let chords = asked.select(cubics.chords(), all(1.0));
        let unclear = chords.simd_gt(all(MAX_CHORDS as f32));
        let mut found = Meetings::none(self.x0, unclear);
        let mut end = all(0.0);
        let (mut from, most) = (self.x0, chords.to_array().into_iter().fold(1.0, crate::math::max));
        for i in 0..(most as u8).min(MAX_CHORDS as u8) {
            let (begun, ends) = (all(f32::from(i)), all(f32::from(i + 1)));
            let share = ends / chords;
            let to = Vectors::select(ends.simd_eq(chords), self.x1, cubics.at(share));
            let piece = Segments { from, to };
            let open = asked & begun.simd_lt(chords) & not(found.hits.are | unclear);
            let hits = piece.first_hits(face, radius);
            let are = hits.are & open;
            if are.any() {
                found.chord_from = Vectors::select(are, from, found.chord_from);
                found.begun = are.select(begun / chords, found.begun);
                found.place = Vectors::select(are, piece.at(hits.time), found.place);
                end = are.select(share, end);
                let time = (begun + hits.time) / chords;
                found.hits.take(are, Hits { time, ..hits });
            }
            from = to;
        }
        if found.hits.are.any() {
            found.put_on_path(self, cubics, face, radius, end);
        }
        found
    }
}

impl<F: Eight> Cubics<F> {
    #[inline(always)]
    fn at(&self, s: F) -> Vectors<F> {
        let [c1, c2, c3] = self.coefficients;
        self.start + (c1 + (c2 + c3 * s) * s) * s
    }

    /// Those whose ends lag behind their velocities.
    #[inline(always)]
    fn lag(&self) -> F {
        let bend = self.bend.dot(self.bend);
        self.excess.dot(self.bend).simd_lt(bend.all(-0.5) * bend)
    }

    /// When they cross the planes that touch the surface at places where they are hit, between two instants, from the side of the
    /// normal to the other.
    #[inline(always)]
    fn crossings(&self, hits: &Hits<F>, place: Vectors<F>, [begun, end]: [F; 2]) -> F {
        let [c1, c2, c3] = self.coefficients;
        let (c1, c2, c3) = (c1.dot(hits.normal), c2.dot(hits.normal), c3.dot(hits.normal));
        let c0 = (self.start - place).dot(hits.normal);
        let all = |x| end.all(x);
        let (mut low, mut high, mut s, mut sought) = (begun, end, end, hits.are);
        for _ in 0..MAX_LOOKS {
            let height = c0 + (c1 + (c2 + c3 * s) * s) * s;
            let slope = c1 + (all(2.0) * c2 + all(3.0) * c3 * s) * s;
            let above = height.simd_gt(all(0.0));
            (low, high) = (above.select(s, low), above.select(high, s));
            let newton = s - height / slope;
            let is_between = newton.simd_ge(low) & newton.simd_le(high);
            let next = sought.select(is_between.select(newton, all(0.5) * (low + high)), s);
            let moved = (next - s).abs().simd_gt(all(f32::EPSILON) * end);
            s = next;
            sought = sought & moved;
            if !sought.any() {
                break;
            }
        }
        s
    }

    /// How many chords stay near each, without a bound.
    #[inline(always)]
    fn chords(&self) -> F {
        const STRAIGHT: f32 = (4.0 * CHORD_ERROR) * (4.0 * CHORD_ERROR);
        let [_, c2, c3] = self.coefficients;
        let (like, one) = (c2.0[0], c2.0[0].all(1.0));
        let all = |x| like.all(x);
        let end = c2 + c3 * all(3.0);
        let (c2, end) = (c2.dot(c2), end.dot(end));
        let bent = not(max(c2, end).simd_le(all(STRAIGHT)));
        if !bent.any() {
            return one;
        }
        let ratio = all(2.0) * max(c2.sqrt(), end.sqrt()) / all(8.0 * CHORD_ERROR);
        let whole = like.of(ratio.sqrt().to_array().map(|root| root as u16 as f32));
        (bent & ratio.simd_gt(one)).select(whole + one, one)
    }
}

impl<F: Eight> Riders<F> {
    /// Those who lie on a face: along it, from their own places, for a step.
    #[inline(always)]
    pub(super) fn lie(&self, paths: &Paths<F>, face: &Face) -> Outcome {
        let acceleration = paths.acceleration();
        let (lying, normal) = self.seated(paths, face, acceleration);
        let lying = lying & paths.are_finite();
        if !lying.any() {
            return Outcome { settled: 0, hits: [0; ROUNDS], left: 0, ends: paths.ends() };
        }
        let (incoming, pressing) = (paths.v0.dot(normal), negated(acceleration.dot(normal)));
        let (slip, drive) = (paths.v0 - normal * incoming, acceleration + normal * pressing);
        let (way, end) = self.slide(slip, drive, pressing, paths.time);
        let along = Paths { v0: slip, x1: paths.x0 + way, v1: end, ..*paths };
        let straight = along.cubics().chords().simd_eq(paths.time.all(1.0));
        let passes = Segments { from: along.x0, to: along.x1 }.first_hits(face, self.radius).are;
        let settled = (lying & straight & not(passes)).to_bitmask();
        let left = lying.to_bitmask() & !settled;
        let mut hits = [0; ROUNDS];
        hits[0] = settled;
        Outcome { settled, hits, left, ends: along.ends() }
    }

    /// Who begins on the face and leaves it only to come back to it within the step; and the normals toward them.
    #[inline(always)]
    fn seated(&self, paths: &Paths<F>, face: &Face, acceleration: Vectors<F>) -> (F, Vectors<F>) {
        let (time, like) = (paths.time, paths.time);
        let (all, zero) = (|x| like.all(x), like.all(0.0));
        let fall = |acceleration: F| all(0.5) * acceleration * time * time;
        let [point, _, unit] = face.vectors();
        let (point, unit) = (Vectors::splat(like, point), Vectors::splat(like, unit));
        let away = unit.dot(paths.x0 - point);
        let normal = Vectors::select(away.simd_lt(zero), -unit, unit);
        let distance = (unit * away).dot(normal);
        let slack = all(4.0 * f32::EPSILON) * (paths.x0.largest() + distance + all(face.size()));
        let is_near = distance.simd_le(self.radius + fall(acceleration.length()));
        let gap = distance - self.radius;
        let (leaving, pressing) = (paths.v0.dot(normal).abs(), negated(acceleration.dot(normal)));
        let lain = all(LAIN) * slack;
        let is_there = gap.simd_ge(all(0.5) * slack) & gap.simd_le(lain) & fall(pressing).simd_gt(gap);
        let rests = (leaving * time).simd_le(lain) & (all(2.0) * leaving).simd_lt(all(RESTING) * time * pressing);
        (is_near & is_there & rests, normal)
    }

    /// How far they slide in a time, and how fast they are then, as `Slide` has it.
    #[inline(always)]
    fn slide(&self, velocity: Vectors<F>, drive: Vectors<F>, pressing: F, time: F) -> (Vectors<F>, Vectors<F>) {
        let all = |x| time.all(x);
        let (speed, zero) = (velocity.length(), all(0.0));
        let held = self.kinetic * pressing;
        let braked = |along: Vectors<F>| drive - along * held;
        let going = |acceleration: Vectors<F>, time: F| (velocity + acceleration * (all(0.5) * time)) * time;
        let steady = braked((velocity + drive * time).unit());
        let (mut way, mut end) = (going(steady, time), velocity + steady * time);
        let stays = speed.simd_eq(zero);
        let brakes = self.kinetic.simd_gt(zero) & not(stays);
        if (stays | brakes).any() {
            let along = velocity / speed;
            let acceleration = braked(along);
            let braking = negated(acceleration.dot(along));
            let stops = brakes & (braking * time).simd_gt(speed);
            let until = speed / braking;
            let (rest, velocity) = self.start(drive, pressing, stays.select(time, time - until));
            let stopped = going(acceleration, until) + rest;
            way = Vectors::select(stays, rest, Vectors::select(stops, stopped, way));
            end = Vectors::select(stops | stays, velocity, end);
        }
        (way, end)
    }

    /// The same from rest.
    #[inline(always)]
    fn start(&self, drive: Vectors<F>, pressing: F, time: F) -> (Vectors<F>, Vectors<F>) {
        let all = |x| time.all(x);
        let (pull, zero) = (drive.length(), all(0.0));
        let starts = not(pull.simd_le(self.at_rest * pressing)) & pull.simd_gt(zero);
        let left = pull - self.kinetic * pressing;
        let acceleration = drive * (max(left, zero) / pull);
        ((acceleration * (all(0.5) * time * time)).masked(starts), (acceleration * time).masked(starts))
    }

    /// Those who bounce off a face, come to rest on it, or miss it, and fly on till the end of a step of so long; not those who are
    /// hit so many times.
    #[inline(always)]
    pub(super) fn bounce(&self, paths: &Paths<F>, face: &Face, step: Time, max_bounces: u32) -> Outcome {
        let (mut onward, mut cubics) = (*paths, paths.cubics());
        let mut clear = paths.are_finite() & not(cubics.lag());
        let mut meetings = paths.first_meetings(&cubics, face, self.radius, clear);
        let mut hit = meetings.hits.are & clear;
        clear = clear & not(meetings.unclear);
        let (mut left, mut hits, mut rounds) = ([step; LANES], [0; ROUNDS], 1);
        for hits in &mut hits {
            hit = hit & clear;
            if !hit.any() || rounds >= max_bounces {
                break;
            }
            rounds += 1;
            *hits = hit.to_bitmask();
            let (next, is_free) = self.rebound(&onward, &cubics, &meetings, face, step.seconds(), &mut left);
            // Who has no time left is followed by itself.
            clear = clear & not(hit & not(is_free & next.time.simd_gt(next.time.all(0.0))));
            onward = Paths::select(hit, next, onward);
            cubics = onward.cubics();
            meetings = onward.first_meetings(&cubics, face, self.radius, hit);
            clear = clear & not(hit & meetings.unclear);
            hit = hit & meetings.hits.are;
        }
        let settled = (clear & not(hit)).to_bitmask();
        Outcome { settled, hits: hits.map(|hits| hits & settled), left: !settled, ends: onward.ends() }
    }

    /// The ways on from hits in steps of `dt` \[s\], of which so much is left, and whose are free.
    #[inline(always)]
    fn rebound(
        &self,
        paths: &Paths<F>,
        cubics: &Cubics<F>,
        meetings: &Meetings<F>,
        face: &Face,
        dt: f32,
        left: &mut [Time; LANES],
    ) -> (Paths<F>, F) {
        let Meetings { hits: Hits { time: s, normal, .. }, place, .. } = *meetings;
        let like = s;
        let (all, zero) = (|x| like.all(x), like.all(0.0));
        for (left, s) in left.iter_mut().zip(s.to_array()) {
            let ticks = left.ticks();
            *left = Time::from_ticks(ticks - ((ticks as f32 * s) as u64).min(ticks));
        }
        let rest = like.of(left.map(Time::seconds));
        let acceleration = paths.acceleration();
        let before = paths.velocity(cubics, s);
        let incoming = before.dot(normal);
        let outgoing = incoming.simd_lt(zero).select(negated(incoming) * self.elasticity, incoming);
        let (beside, is_free) = self.set_off(paths, cubics, meetings, face, incoming);
        let onward = slowed(outgoing, acceleration.dot(beside - place));
        let pressing = negated(acceleration.dot(normal));
        let rests = pressing.simd_gt(zero)
            & (incoming.simd_ge(zero) | (all(2.0) * onward).simd_lt(all(RESTING * dt) * pressing));
        let (outgoing, onward) = (outgoing & not(rests), onward & not(rests));
        let came = before - normal * incoming;
        let slip = Vectors::splat(like, Vec3::ZERO) + (came + self.answer(came, outgoing - incoming));
        let velocity = slip + normal * onward;
        let x1 = beside + (velocity + acceleration * (all(0.5) * rest)) * rest;
        let flying = Paths { x0: beside, v0: velocity, x1, v1: velocity + acceleration * rest, time: rest };
        if !rests.any() {
            return (flying, is_free);
        }
        let resting = self.rest(paths, meetings, beside, [came, acceleration], [incoming, pressing, rest]);
        (Paths::select(rests, resting, flying), is_free)
    }

    /// The ways on of those who have come to rest, from beside a face that their velocities are `came` along.
    #[inline(always)]
    fn rest(
        &self,
        paths: &Paths<F>,
        meetings: &Meetings<F>,
        beside: Vectors<F>,
        [came, acceleration]: [Vectors<F>; 2],
        [incoming, pressing, rest]: [F; 3],
    ) -> Paths<F> {
        let Meetings { hits: Hits { time: s, normal, slack, .. }, place, .. } = *meetings;
        let (zero, still) = (s.all(0.0), Vectors::splat(s, Vec3::ZERO));
        let slip = came + self.answer(came, zero - incoming);
        let (way, end) = self.slide(slip, acceleration + normal * pressing, pressing, rest);
        // Falling onto the face anew each step, what has lain on it has not moved at all.
        let near = s.all(LAIN) * slack;
        let off = paths.x0 - place;
        let has_lain = off.dot(off).simd_le(near * near) & (paths.v0.length() * (paths.time * s)).simd_le(near);
        let stays = slip.is_zero() & end.is_zero() & has_lain;
        let x0 = Vectors::select(stays, paths.x0 + still, beside);
        Paths { x0, v0: still + slip + normal * zero, x1: x0 + still + way, v1: still + end, time: rest }
    }

    /// Places beside hits, and which of them are reached freely from as little before as that takes.
    #[inline(always)]
    fn set_off(
        &self,
        paths: &Paths<F>,
        cubics: &Cubics<F>,
        meetings: &Meetings<F>,
        face: &Face,
        incoming: F,
    ) -> (Vectors<F>, F) {
        let Meetings { hits: Hits { time, normal, slack, .. }, place, begun, chord_from, .. } = *meetings;
        let all = |x| time.all(x);
        let closing = max(negated(incoming), all(f32::MIN_POSITIVE));
        let beside = place + normal * (all(2.0) * slack);
        let back = all(2.0) * slack / (closing * paths.time);
        let before = cubics.at(max(time - back, begun));
        let is_free = not(Segments { from: chord_from, to: before }.first_hits(face, self.radius).are);
        let aside = Segments { from: before, to: beside }.first_hits(face, self.radius).are;
        (Vectors::select(aside, before, beside), is_free)
    }

    /// What friction does to slips, as `Friction` has it.
    #[inline(always)]
    fn answer(&self, slip: Vectors<F>, press: F) -> Vectors<F> {
        let (speed, zero) = (slip.length(), press.all(0.0));
        let held = self.kinetic * press;
        let all_of_it = speed.simd_le(self.at_rest * press) | speed.simd_le(held);
        let answer = Vectors::select(all_of_it, -slip, slip * (negated(held) / speed));
        answer.masked(speed.simd_gt(zero) & press.simd_gt(zero))
    }
}

/// Speeds after a way along which they gain `work` \[m²/s²\], a share of the square of it.
#[inline(always)]
fn slowed<F: Eight>(speed: F, work: F) -> F {
    let gain = work.all(2.0) * work;
    let square = speed * speed + gain;
    (speed + gain / (speed + square.sqrt())) & square.simd_gt(work.all(0.0))
}
