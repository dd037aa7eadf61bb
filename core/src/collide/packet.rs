//! Paths past one flat face, eight or sixteen side by side: of those who lie on it, and of those who bounce off it a few times.
//!
//! Every number is made as `Sweep` makes it, in the same order, and so has the same bits. Whoever needs more than this is left
//! to that: more hits in a step than are found here, a place that is not free.

mod airs;
mod hits;
mod leads;
mod paths;
mod things;
mod walls;

use super::crease::HOP;
use super::sweep::{LAIN, RESTING};
use super::turn::{LOSS, SMOOTH, STEEP};
use crate::lanes::{Eight, LANES, Lanes, PARTS, Vectors, mask_of, max, negated, not};
use crate::shape::Face;
use crate::time::Time;
pub(super) use airs::Airs;
use airs::Onwards;
use glam::Vec3;
use hits::{Hits, Meetings, Seats, Segments, Walls};
use leads::Leads;
use paths::Cubics;
pub(super) use paths::{CLOSE, Paths};
pub(super) use things::{BOXES, EITHER, SPHERES, Things};

/// Properties of particles that decide how they meet a face. If they are `POINTS`, their radius is nothing.
pub(super) struct Riders<F, const POINTS: bool> {
    /// Those that are not held where they are, on paths all of whose numbers are finite.
    pub(super) are_free: F,
    pub(super) radius: F,
    /// True if rounding leaves a path along a face that is braked steadily as straight as [`Paths::hardly_bend`] asks.
    pub(super) are_close: bool,
    /// True if there are springs, whose method leads beyond parabolas.
    pub(super) swing: bool,
    pub(super) elasticity: F,
    /// The forces that brake them, if any depend on their velocities.
    pub(super) air: Medium<F>,
    /// Coefficients of friction.
    pub(super) at_rest: F,
    pub(super) kinetic: F,
}

/// The forces that a hit changes, as far as they are known.
#[derive(Clone, Copy)]
pub(super) enum Medium<F> {
    /// There are none.
    Thin,
    Steady(Airs<F>),
    /// Others: whoever is hit is followed by itself.
    Any,
}

/// The number of hits of a particle in a step are found in packets.
const ROUNDS: usize = 4;

/// Ticks of a step in which particles bounce in packets, at the most: so few that 32 bits do for what is left of it.
const MOST_TICKS: u64 = 1 << 30;

/// The outcome of a packet: a bit for each particle.
pub(super) struct Outcome<F> {
    /// Particles that are at the end of the step now, and those to be followed alone.
    pub(super) settled: u32,
    pub(super) left: u32,
    /// How often those who are at the end were hit, and the largest coordinate of each \[m\].
    pub(super) hits: u32,
    pub(super) farthest: F,
    /// Places and velocities.
    pub(super) ends: [Vectors<F>; 2],
}

/// The ways of a packet after some hits.
struct Flight<F> {
    onward: Paths<F>,
    /// Particles that are at the end of the step, and those that have hit something beside the face.
    settled: F,
    astray: F,
    /// A bit for each particle that has been hit so many times.
    hits: [u32; ROUNDS],
}

/// Those of a packet who go along surfaces, and what drives them, whatever these bear of it, as `Path::pull`.
#[derive(Clone, Copy)]
struct Slides<F> {
    are: F,
    pull: Vectors<F>,
    /// The slack of what they go along.
    slack: F,
}

impl<F: Lanes> Slides<F> {
    /// Nobody.
    #[inline(always)]
    fn none(like: F) -> Self {
        Self { are: like.all(0.0), pull: Vectors::splat(like, Vec3::ZERO), slack: like.all(0.0) }
    }

    /// The first of two where a mask says so, else the second.
    #[inline(always)]
    fn select(mask: F, a: Self, b: Self) -> Self {
        let [are, slack] = [(a.are, b.are), (a.slack, b.slack)].map(
            #[inline(always)]
            |(a, b)| mask.select(a, b),
        );
        Self { are, pull: Vectors::select(mask, a.pull, b.pull), slack }
    }

    /// What drives all on their paths.
    #[inline(always)]
    fn drive(&self, paths: &Paths<F>) -> Vectors<F> {
        Vectors::select(self.are, self.pull, paths.acceleration())
    }
}

impl<F> Flight<F> {
    /// How often these were hit.
    #[inline(always)]
    fn hits_of(&self, which: u32) -> u32 {
        self.hits.iter().map(|hits| (hits & which).count_ones()).sum()
    }
}

impl<F: Lanes> Outcome<F> {
    /// The outcome for those who are `settled` on their paths, after so many hits, and for those who are `left`.
    #[inline(always)]
    fn of(paths: &Paths<F>, settled: F, left: u32, hits: u32) -> Self {
        let farthest = paths.x1.largest() & settled;
        Self { settled: settled.to_bitmask(), left, hits, farthest, ends: [paths.x1, paths.v1] }
    }
}

impl<F: Lanes, const POINTS: bool> Riders<F, POINTS> {
    /// Those of who are `present` who lie on a face: along it, from their own places, for a step.
    #[inline(always)]
    pub(super) fn lie(&self, paths: &Paths<F>, face: &Face, present: u32) -> Outcome<F> {
        let acceleration = paths.acceleration();
        let (lying, normal, _) = self.seated(paths, face, acceleration);
        let lying = lying & self.are_free;
        if !lying.any() {
            return Outcome::of(paths, lying, 0, 0);
        }
        let (along, is_steady) = self.along(paths, acceleration, normal);
        let mut straight = along.hardly_bend();
        if !(self.are_close && is_steady) || (lying & not(straight)).any() {
            straight = along.cubics().chords().simd_eq(paths.time.all(1.0));
        }
        let passes = Segments { from: along.x0, to: along.x1 }.first_hits::<POINTS>(face, self.radius).are;
        let settled = lying & straight & not(passes) & along.end_finite();
        let which = settled.to_bitmask() & present;
        Outcome::of(&along, settled, lying.to_bitmask() & !which, which.count_ones())
    }

    /// The ways of those who lie on surfaces with these normals, and whether all are driven steadily.
    #[inline(always)]
    fn along(&self, paths: &Paths<F>, acceleration: Vectors<F>, normal: Vectors<F>) -> (Paths<F>, bool) {
        let (incoming, pressing) = (paths.v0.dot(normal), negated(acceleration.dot(normal)));
        let (slip, drive) = (paths.v0 - normal * incoming, acceleration + normal * pressing);
        let ([way, end], is_steady) = self.slide(slip, drive, pressing, paths.time);
        let mut along = Paths { v0: slip, x1: paths.x0 + way, v1: end, ..*paths };
        if self.swing {
            let leads = Leads::of(&paths.cubics(), paths.time, paths.time.all(0.0), normal);
            along.x1 = leads.slid(along.x1, drive * paths.time, end - slip);
        }
        (along, is_steady)
    }

    /// Those that begin on one surface and leave it only to come back to it within the step, the normals toward them, its slack, and those of which it
    /// cannot be told.
    #[inline(always)]
    fn seated(&self, paths: &Paths<F>, walls: &impl Walls<F>, acceleration: Vectors<F>) -> (F, Vectors<F>, [F; 2]) {
        let (time, all) = (paths.time, |x| paths.time.all(x));
        let fall = |acceleration: F| all(0.5) * acceleration * time * time;
        let reach = self.radius + fall(acceleration.length());
        let Seats { are, normal, distance, slack, unclear } = walls.seats(paths.x0, reach);
        let gap = distance - self.radius;
        let (leaving, pressing) = (paths.v0.dot(normal).abs(), negated(acceleration.dot(normal)));
        let lain = all(LAIN) * slack;
        let is_there = gap.simd_ge(all(0.5) * slack) & gap.simd_le(lain) & fall(pressing).simd_gt(gap);
        let rests = (leaving * time).simd_le(lain) & (all(2.0) * leaving).simd_lt(all(RESTING) * time * pressing);
        (are & is_there & rests, normal, [slack, unclear])
    }

    /// How far they slide in a time, and how fast they are then, as `Slide` has it; and whether all are driven steadily meanwhile.
    #[inline(always)]
    fn slide(&self, velocity: Vectors<F>, drive: Vectors<F>, pressing: F, time: F) -> ([Vectors<F>; 2], bool) {
        let all = |x| time.all(x);
        let (square, zero) = (velocity.dot(velocity), all(0.0));
        let held = self.kinetic * pressing;
        let going = |acceleration: Vectors<F>, time: F| (velocity + acceleration * (all(0.5) * time)) * time;
        let (stays, brakes) = (square.simd_eq(zero), held.simd_gt(zero));
        let mut steady = drive;
        if brakes.any() {
            let along = (velocity + drive * time).unit();
            steady = Vectors::select(brakes, drive - along * held, drive);
        }
        let (mut way, mut end) = (going(steady, time), velocity + steady * time);
        let is_steady = !(stays | brakes).any();
        if !is_steady {
            let speed = square.sqrt();
            let along = velocity / speed;
            let acceleration = drive - along * held;
            let braking = negated(acceleration.dot(along));
            let stops = brakes & not(stays) & (braking * time).simd_gt(speed);
            let until = speed / braking;
            let (rest, velocity) = self.start(drive, pressing, stays.select(time, time - until));
            let stopped = going(acceleration, until) + rest;
            way = Vectors::select(stays, rest, Vectors::select(stops, stopped, way));
            end = Vectors::select(stops | stays, velocity, end);
        }
        ([way, end], is_steady)
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

    /// Those of who are `present` who bounce off a face, come to rest on it, or miss it, and fly on till the end of a step of so long;
    /// not those who are hit so many times.
    #[inline(always)]
    pub(super) fn bounce(
        &self,
        paths: &Paths<F>,
        face: &Face,
        present: u32,
        step: Time,
        max_bounces: u32,
    ) -> Outcome<F> {
        let cubics = paths.cubics();
        let clear = self.are_free & not(cubics.lag());
        if step.ticks() > MOST_TICKS {
            return Outcome::of(paths, clear & not(clear), u32::MAX, 0);
        }
        let flight = self.fly((*paths, Slides::none(paths.time)), cubics, face, clear, step, max_bounces);
        let which = flight.settled.to_bitmask() & present;
        Outcome::of(&flight.onward, flight.settled, !which, flight.hits_of(which))
    }

    /// The same among walls of any kind, of those who are `clear`.
    #[inline(always)]
    fn fly(
        &self,
        (mut onward, mut slides): (Paths<F>, Slides<F>),
        mut cubics: Cubics<F>,
        walls: &impl Walls<F>,
        mut clear: F,
        step: Time,
        max_bounces: u32,
    ) -> Flight<F> {
        let mut meetings = onward.first_meetings::<POINTS>(&cubics, walls, self.radius, clear);
        let mut hit = meetings.hits.are & clear;
        clear = clear & not(meetings.unclear);
        let (mut left, mut hits, mut rounds) = ([[step.ticks() as i32; LANES]; PARTS], [0; ROUNDS], 1);
        let mut astray = clear & not(clear);
        if let Medium::Any = self.air {
            clear = clear & not(hit);
        }
        for hits in &mut hits {
            hit = hit & clear;
            if !hit.any() || rounds >= max_bounces {
                break;
            }
            rounds += 1;
            if walls.face().is_none() {
                // What may be turned by a curve, or held by two surfaces, is followed by itself.
                let incoming = onward.velocity(&cubics, meetings.hits.time).dot(meetings.hits.normal);
                let alone = self.may_be_turned(&onward, incoming, &meetings.hits)
                    | self.may_be_held(&onward, &slides, &meetings);
                clear = clear & not(hit & alone);
                hit = hit & clear;
            }
            *hits = hit.to_bitmask();
            astray = astray | (hit & meetings.hits.beside_face);
            let ways = (&onward, &cubics, &slides);
            let (next, next_slides, is_free) = self.rebound(ways, &meetings, walls, step.seconds(), &mut left);
            // Who has no time left is followed by itself.
            clear = clear & not(hit & not(is_free & next.time.simd_gt(next.time.all(0.0))));
            onward = Paths::select(hit, next, onward);
            slides = Slides::select(hit, next_slides, slides);
            cubics = onward.cubics();
            meetings = onward.first_meetings::<POINTS>(&cubics, walls, self.radius, hit);
            clear = clear & not(hit & meetings.unclear);
            hit = hit & meetings.hits.are;
        }
        if walls.face().is_none() && slides.are.any() {
            clear = clear & not(self.may_be_turned_at_end(&onward, &slides, walls));
        }
        let settled = clear & not(hit) & onward.end_finite();
        Flight { onward, settled, astray, hits }
    }

    /// Those whose hits may be some of a chain along one surface, as `turn` has it.
    #[inline(always)]
    fn may_be_turned(&self, paths: &Paths<F>, incoming: F, hits: &Hits<F>) -> F {
        let all = |x| incoming.all(x);
        let deeper = paths.time * hits.time * incoming * max(all(1.0) - max(self.elasticity, all(0.0)), all(LOSS));
        let is_slow = (all(STEEP) * (incoming * incoming)).simd_le(paths.v0.dot(paths.v0));
        deeper.abs().simd_le(all(2.0 * SMOOTH) * hits.slack) & is_slow
    }

    /// Those that slide to where a surface may turn them, as `turned_at_end` has it.
    #[inline(always)]
    fn may_be_turned_at_end(&self, paths: &Paths<F>, slides: &Slides<F>, walls: &impl Walls<F>) -> F {
        let like = slides.are;
        let Seats { are, normal, unclear, .. } = walls.seats(paths.x1, self.radius + like.all(LAIN) * slides.slack);
        like & (unclear | (are & paths.v1.dot(normal).simd_lt(like.all(0.0))))
    }

    /// Those that slide into another surface, or have hardly left one, which may be in a crease, as `along_crease` has it.
    #[inline(always)]
    fn may_be_held(&self, paths: &Paths<F>, slides: &Slides<F>, meetings: &Meetings<F>) -> F {
        let hop = (meetings.place - paths.x0).dot(meetings.hits.normal);
        slides.are | hop.abs().simd_le(hop.all(HOP) * meetings.hits.slack)
    }

    /// The ways on from hits in steps of `dt` \[s\], of which so many ticks are left, those of them that slide, and whose are free.
    #[inline(always)]
    fn rebound(
        &self,
        (paths, cubics, slides): (&Paths<F>, &Cubics<F>, &Slides<F>),
        meetings: &Meetings<F>,
        walls: &impl Walls<F>,
        dt: f32,
        left: &mut [[i32; LANES]; PARTS],
    ) -> (Paths<F>, Slides<F>, F) {
        let Meetings { hits: Hits { time: s, normal, slack, .. }, place, .. } = *meetings;
        let like = s;
        let (all, zero) = (|x| like.all(x), like.all(0.0));
        // As `Path` has it: numbers of ticks and what is rounded of them are the same in 32 bits.
        let [rest] = like.of_parts(
            #[inline(always)]
            |like, nth| {
                let mut rest = s.part(nth).to_array();
                for (left, rest) in left[nth].iter_mut().zip(&mut rest) {
                    *left -= ((*left as f32 * *rest) as i32).max(0).min(*left);
                    *rest = *left as f32;
                }
                [like.of(rest)]
            },
        );
        let rest = rest / all(Time::SECOND.ticks() as f32);
        let leads = self.swing.then(|| Leads::of(cubics, paths.time, s, normal));
        let mean = slides.drive(paths);
        let mean = leads.map_or(mean, |leads| leads.onward(mean));
        let before = paths.velocity(cubics, s);
        let incoming = before.dot(normal);
        let outgoing = incoming.simd_lt(zero).select(negated(incoming) * max(self.elasticity, zero), incoming);
        let came = before - normal * incoming;
        let (still, held) = (Vectors::splat(like, Vec3::ZERO), came + self.answer(came, zero - incoming));
        let until = [(paths.v0 + paths.v1) * all(0.5) + cubics.excess / paths.time, mean];
        let pressed = self.onward(until, still + held + normal * zero, rest);
        let (beside, is_free) = self.set_off(paths, cubics, meetings, walls, incoming);
        let work = mean.dot(beside - place);
        let onward = slowed(outgoing, work);
        let pressing = negated(pressed.first.dot(normal));
        let rests = pressing.simd_gt(zero)
            & (incoming.simd_ge(zero) | (all(2.0) * onward).simd_lt(all(RESTING * dt) * pressing));
        let slip = still + (came + self.answer(came, outgoing - incoming));
        let acceleration = self.onward(until, slip + normal * outgoing, rest).mean;
        let velocity = slip + normal * onward;
        let x1 = beside + (velocity + acceleration * (all(0.5) * rest)) * rest;
        let x1 = leads.map_or(x1, |leads| leads.beyond(x1));
        let flying = Paths { x0: beside, v0: velocity, x1, v1: velocity + acceleration * rest, time: rest };
        if !rests.any() {
            return (flying, Slides::none(like), is_free);
        }
        let borne = pressed.held(normal);
        let held = if slides.are.any() { Vectors::select(slides.are, risen(held, work), held) } else { held };
        let resting = self.rest(paths, meetings, leads, beside, [held, borne], rest);
        (Paths::select(rests, resting, flying), Slides { are: rests, pull: borne, slack }, is_free)
    }

    /// How those go on with other velocities of which the mean velocities and accelerations so far are known.
    #[inline(always)]
    fn onward(&self, until: [Vectors<F>; 2], velocity: Vectors<F>, rest: F) -> Onwards<F> {
        match &self.air {
            Medium::Steady(airs) => airs.onward(until, velocity, rest),
            _ => Onwards { first: until[1], mean: until[1] },
        }
    }

    /// The ways on of those who have come to rest, from beside a face that friction leaves them so fast along, with these accelerations.
    #[inline(always)]
    fn rest(
        &self,
        paths: &Paths<F>,
        meetings: &Meetings<F>,
        leads: Option<Leads<F>>,
        beside: Vectors<F>,
        [slip, acceleration]: [Vectors<F>; 2],
        rest: F,
    ) -> Paths<F> {
        let Meetings { hits: Hits { time: s, normal, slack, .. }, place, .. } = *meetings;
        let (zero, still) = (s.all(0.0), Vectors::splat(s, Vec3::ZERO));
        let pressing = max(negated(acceleration.dot(normal)), zero);
        let drive = acceleration + normal * pressing;
        let ([way, end], _) = self.slide(slip, drive, pressing, rest);
        // Falling onto the face anew each step, what has lain on it has not moved at all.
        let near = s.all(LAIN) * slack;
        let off = paths.x0 - place;
        let has_lain = off.dot(off).simd_le(near * near) & (paths.v0.length() * (paths.time * s)).simd_le(near);
        let stays = slip.is_zero() & end.is_zero() & has_lain;
        let x0 = Vectors::select(stays, paths.x0 + still, beside);
        let x1 = x0 + still + way;
        let x1 = leads.map_or(x1, |leads| leads.slid(x1, drive * rest, end - slip));
        Paths { x0, v0: still + slip + normal * zero, x1, v1: still + end, time: rest }
    }

    /// Places beside hits, and which of them are reached freely from as little before as that takes.
    #[inline(always)]
    fn set_off(
        &self,
        paths: &Paths<F>,
        cubics: &Cubics<F>,
        meetings: &Meetings<F>,
        walls: &impl Walls<F>,
        incoming: F,
    ) -> (Vectors<F>, F) {
        let Meetings { hits: Hits { time, normal, slack, .. }, place, begun, chord_from, .. } = *meetings;
        let all = |x| time.all(x);
        let closing = max(negated(incoming), all(f32::MIN_POSITIVE));
        let beside = place + normal * (all(2.0) * slack);
        let back = all(2.0) * slack / (closing * paths.time);
        let before = cubics.at(max(time - back, begun));
        let is_free = not(walls.first_hits::<POINTS>(&Segments { from: chord_from, to: before }, self.radius).are);
        let aside = walls.first_hits::<POINTS>(&Segments { from: before, to: beside }, self.radius).are;
        (Vectors::select(aside, before, beside), is_free)
    }

    /// The effect of friction on slips, as `Friction` has it.
    #[inline(always)]
    fn answer(&self, slip: Vectors<F>, press: F) -> Vectors<F> {
        let (speed, zero) = (slip.length(), press.all(0.0));
        let held = self.kinetic * press;
        let all_of_it = speed.simd_le(self.at_rest * press) | speed.simd_le(held);
        let answer = Vectors::select(all_of_it, -slip, slip * (negated(held) / speed));
        answer.masked(speed.simd_gt(zero) & press.simd_gt(zero))
    }
}

impl<F: Lanes> Riders<F, true> {
    /// Those of who are `present` who lie on a face or a solid, or bounce off them. Whose solids are not `alone` may hit nothing else but the
    /// face.
    #[inline(always)]
    pub(in crate::collide) fn go<const MANY: usize, const KIND: u8>(
        &self,
        paths: &Paths<F>,
        things: &Things<F, MANY, KIND>,
        [present, alone]: [u32; 2],
        step: Time,
        max_bounces: u32,
    ) -> Outcome<F> {
        let acceleration = paths.acceleration();
        let (lying, normal, [slack, unclear]) = self.seated(paths, things, acceleration);
        let mut onward = *paths;
        if lying.any() {
            onward = Paths::select(lying, self.along(paths, acceleration, normal).0, onward);
        }
        let cubics = onward.cubics();
        let clear = self.are_free & (lying | not(cubics.lag())) & not(unclear);
        if step.ticks() > MOST_TICKS {
            return Outcome::of(paths, clear & not(clear), u32::MAX, 0);
        }
        let flight = self.fly(
            (onward, Slides { are: lying, pull: acceleration, slack }),
            cubics,
            things,
            clear,
            step,
            max_bounces,
        );
        let settled = flight.settled & not(flight.astray & not(mask_of(flight.settled, alone)));
        let which = settled.to_bitmask() & present;
        let hits = flight.hits_of(which) + (lying.to_bitmask() & which).count_ones();
        Outcome::of(&flight.onward, settled, !which, hits)
    }
}

/// The slips of what has slid into surfaces that curve, and is set off from them by such a work, as in `rebound`.
#[inline(always)]
fn risen<F: Lanes>(slip: Vectors<F>, work: F) -> Vectors<F> {
    let square = slip.dot(slip);
    let left = square + work.all(2.0) * work;
    let share = (left / square).sqrt() & left.simd_gt(work.all(0.0));
    Vectors::select(left.simd_lt(square), slip * share, slip)
}

/// Speeds after a way along which they gain `work` \[m²/s²\], a share of the square of it.
#[inline(always)]
fn slowed<F: Lanes>(speed: F, work: F) -> F {
    let gain = work.all(2.0) * work;
    let square = speed * speed + gain;
    (speed + gain / (speed + square.sqrt())) & square.simd_gt(work.all(0.0))
}
