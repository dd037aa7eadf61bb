//! Creases: what two surfaces press back at once goes along the line in which they meet, and what three do stays.
//!
//! From hit to hit it would go from the one to the other and back, some micrometres each time, as often as a step allows, and lose the rest of its way.

use super::air::Until;
use super::path::Path;
use super::rebound::{answered, free_of};
use super::slide::Slide;
use super::sweep::{LAIN, Meeting, RESTING, Sweep};
use super::turn::{gaining, sent_back};
use crate::force::Friction;
use crate::material::{Mixed, on_surface};
use crate::math::{along, dot, is_zero, length, max, min, minus, plus, scaled};
use crate::observe::{Impact, Sliding};
use crate::shape::{Collider, Contact, Crease, Hit, Segment};
use crate::time::Time;
use glam::Vec3;

/// How much deeper it has come than where its path began, at the most, which is in a crease already \[slacks\].
pub(super) const HOP: f32 = 16.0;

/// How far rounding lets something fall in a crease \[slacks\].
const ROOM: f32 = 16.0;

/// The sine by which the sides of a sharp crease lean over each other at the least: from others a hit or two throw out whoever comes in.
const OPEN: f32 = 0.05;

/// The least cosine between the normals of one surface in two places that are within rounding.
const SAME: f32 = 0.999;

/// The number of hits after which nothing is left of a velocity across a sharp crease.
const MOST_HITS: u32 = 128;

/// The number of times that a place is raised off both sides of a crease, and a third surface.
const MOST_RAISES: u32 = 4;

/// How something comes into a crease: from where it goes on along that and from when, with which velocity, of which so much is left, and what drives it.
struct Arriving {
    place: Vec3,
    during: [Time; 2],
    before: Vec3,
    slip: Vec3,
    raised: Vec3,
    acceleration: Vec3,
}

impl<C: Collider + ?Sized> Sweep<'_, C> {
    /// The way on from a hit of what has slid along another surface into the one that it hits, or has hardly come off that: along both, if it leaves neither for longer
    /// than a rest, or off both, where a sharp crease throws it from the one to the other and back until it comes out.
    #[inline(never)]
    pub(super) fn along_crease(
        &mut self,
        path: &Path,
        meeting: &Meeting,
        place: Vec3,
        (after, is_sharp): (Vec3, bool),
    ) -> Option<Path> {
        let Hit { normal, slack, .. } = meeting.hit;
        let (pull, now, before) = (path.drive(), path.instant(meeting.time), path.velocity(meeting.time));
        let mut crease = self.crease(place, slack, now, pull, after);
        let is_held = crease.is_some();
        if !is_held && is_sharp {
            crease = self.sharp(place, slack, now, before);
        }
        let crease = crease.as_ref()?;
        let place = self.off_both(crease, [meeting.chord.from, place, place], now).unwrap_or(place);
        let until = Until { path, place: meeting.place, now, acceleration: pull };
        let (raised, during) = (minus(place, meeting.place), [now, path.during[1]]);
        if !is_held {
            return Some(self.fly_off(crease, &until, raised, [before, after]));
        }
        // What comes to a third surface has been answered by that alone.
        let is_side = crease.sides.iter().any(|side| dot(side.normal, normal) > SAME);
        let slip = if is_sharp || !is_side {
            within(crease, after)
        } else {
            let (friction, press) = self.friction(crease, pushes(crease, before));
            let came = within(crease, before);
            plus(came, friction.answer(came, press))
        };
        let drive = within(crease, pull);
        let slip = if length(raised) > LAIN * slack { sent_back(slip, raised, drive) } else { slip };
        let acceleration = self.onward(&until, slip).mean;
        Some(self.go_along(crease, &Arriving { place, during, before, slip, raised, acceleration }))
    }

    /// The velocity of what a hit may leave in a crease, after that or after all hits of a sharp one, and whether it was one.
    #[inline(never)]
    pub(super) fn after_hits(&self, path: &Path, meeting: &Meeting, place: Vec3) -> Option<(Vec3, bool)> {
        let Hit { normal, velocity: surface, slack, material, .. } = meeting.hit;
        let (pull, hop) = (path.drive(), dot(minus(meeting.place, path.x0), normal));
        let is_near = path.pull.is_some() || hop.abs() <= HOP * slack;
        let before = path.velocity(meeting.time);
        let incoming = dot(before, normal);
        if !(is_near && incoming < 0.0 && self.heeds_creases() && is_zero(surface)) {
            return None;
        }
        if let Some(crease) = self.sharp(place, slack, path.instant(meeting.time), before) {
            return Some((self.after_both(&crease, before), true));
        }
        // Most bounce: nothing more has to be known of those.
        let mixed = self.mixed(material);
        let (outgoing, pulled) = (-incoming * mixed.elasticity, length(pull));
        if 2.0 * outgoing >= RESTING * self.dt * pulled && outgoing * outgoing > ROOM * slack * pulled {
            return None;
        }
        let [.., after] = answered(before, Vec3::ZERO, normal, [incoming, outgoing], &mixed.friction);
        Some((after, false))
    }

    /// The sharp crease that a velocity leads into.
    fn sharp(&self, place: Vec3, slack: f32, now: Time, before: Vec3) -> Option<Crease> {
        let crease = self.walls.crease(place, self.radius + LAIN * slack, now, Some(before));
        crease.filter(|crease| cosine(crease) < -OPEN)
    }

    /// Puts a meeting to what the path meets in a crease before the side that its chord meets first, if there is such a thing: a chord strays by so little that a path
    /// may meet that behind the other side.
    #[inline(never)]
    pub(super) fn has_missed(&self, path: &Path, meeting: &mut Meeting) -> bool {
        let Meeting { time, place, begun, chord, hit, .. } = *meeting;
        let during = [chord.during[0], path.instant(time)];
        let way = Segment { to: free_of(&hit, place), during, ..chord };
        let reach = self.radius + length(way.step());
        if self.walls.crease(place, reach, during[1], None).is_none() {
            return false;
        }
        let Some(other) = self.walls.first_hit(&way) else { return false };
        let behind = (other.time - 1.0) * dot(way.step(), other.normal);
        let has_missed = behind > ROOM * hit.slack
            && is_zero(hit.velocity)
            && is_zero(other.velocity)
            && dot(other.normal, hit.normal) < 0.5;
        if has_missed {
            meeting.put_nearer(path, &path.cubic(), other, &way, [begun, time], place);
        }
        has_missed
    }

    /// The velocity of what comes into a sharp crease with another after all hits of both sides, from the one to the other and back: none across the crease, if so many
    /// do not throw it out.
    fn after_both(&self, crease: &Crease, before: Vec3) -> Vec3 {
        let sides = crease.sides.map(|side| (side.normal, self.mixed(side.material)));
        let mut velocity = before;
        for _ in 0..MOST_HITS {
            let Some((normal, mixed)) = sides.iter().find(|(normal, _)| dot(velocity, *normal) < 0.0) else {
                return velocity;
            };
            let incoming = dot(velocity, *normal);
            let speeds = [incoming, -incoming * mixed.elasticity];
            [.., velocity] = answered(velocity, Vec3::ZERO, *normal, speeds, &mixed.friction);
        }
        let (friction, press) = self.friction(crease, pushes(crease, velocity));
        let came = within(crease, velocity);
        plus(came, friction.answer(came, press))
    }

    /// The way out of a sharp crease, from so far off both sides: what this has raised it by it pays for.
    fn fly_off(&mut self, crease: &Crease, until: &Until<'_>, raised: Vec3, [before, after]: [Vec3; 2]) -> Path {
        self.report.hits += 1;
        self.tell_sides(crease, until.now, before, after);
        let acceleration = self.onward(until, after).mean;
        let along_it = within(crease, after);
        let across = gaining(minus(after, along_it), min(2.0 * dot(acceleration, raised), 0.0));
        Path::onward(plus(until.place, raised), plus(along_it, across), acceleration, [until.now, until.path.during[1]])
    }

    /// The way of what lies in a crease at the start of a path, and is pressed into it: along that, from its own place.
    #[inline(never)]
    pub(super) fn lying_in_crease(&mut self, path: &Path, side: &Contact) -> Option<Path> {
        let (place, during, before, slack) = (path.x0, path.during, path.v0, side.slack);
        let acceleration = path.acceleration();
        if !self.heeds_creases() {
            return None;
        }
        let crease = self.crease(place, slack, during[0], acceleration, before);
        let crease = crease.as_ref()?;
        let lies = |side: &Contact| dot(before, side.normal).abs() * path.duration() <= LAIN * side.slack;
        if is_zero(crease.along) && !is_zero(before) || !crease.sides.iter().all(lies) {
            return None;
        }
        // Far from the origin rounding is larger: what has come from nearer to it is too close to them.
        let is_close = |side: &Contact| side.distance - self.radius < 0.5 * side.slack;
        let raised = crease.sides.iter().any(is_close).then(|| self.off_both(crease, [place; 3], during[0]));
        let beside = raised.flatten().unwrap_or(place);
        let (slip, raised) = (within(crease, before), minus(beside, place));
        Some(self.go_along(crease, &Arriving { place: beside, during, before, slip, raised, acceleration }))
    }

    /// Tells whether creases are for it. Where constraints have moved it, or springs lead a method on along a surface, it goes from hit to hit.
    fn heeds_creases(&self) -> bool {
        self.left.is_none() && self.obstacles.lead.is_none()
    }

    /// The elasticity and friction of it on a surface.
    fn mixed(&self, material: Option<u16>) -> Mixed {
        on_surface(self.obstacles.materials, self.elasticity, self.material, material)
    }

    /// The crease that an acceleration presses it into, if it leaves that with such a velocity for no longer than a rest.
    fn crease(&self, place: Vec3, slack: f32, now: Time, acceleration: Vec3, after: Vec3) -> Option<Crease> {
        let crease = self.walls.crease(place, self.radius + LAIN * slack, now, Some(acceleration));
        crease.filter(|crease| self.is_held(crease, slack, acceleration, after))
    }

    #[inline(never)]
    fn is_held(&self, crease: &Crease, slack: f32, acceleration: Vec3, after: Vec3) -> bool {
        let (rest, pulled) = (RESTING * self.dt, length(acceleration));
        // What rounding has set it off by gives it as much, and would never let it rest.
        let room = ROOM * slack;
        let rests = |(side, closing): (&Contact, f32)| {
            let across = dot(after, side.normal);
            let leaving = if across < 0.0 { -across * self.mixed(side.material).elasticity } else { across };
            2.0 * leaving < rest * closing || leaving * leaving <= room * closing
        };
        let stays = 2.0 * length(after) < rest * pulled || dot(after, after) <= room * pulled;
        (!is_zero(crease.along) || stays) && crease.sides.iter().zip(crease.closing).all(rests)
    }

    /// A place beside a hit, off both sides of the crease, as they are at a place near it that may be between them by rounding alone; that
    /// itself, if there is none.
    #[inline(never)]
    pub(super) fn off_crease(&self, path: &Path, meeting: &Meeting, near: Vec3) -> Vec3 {
        let Meeting { time, place, ref hit, .. } = *meeting;
        let (now, reach) = (path.instant(time), self.radius + LAIN * hit.slack);
        let Some(crease) = self.walls.crease(near, reach, now, None) else { return near };
        let off = |place| self.off_both(&crease, [meeting.chord.from, near, place], now);
        off(place).or_else(|| off(near)).unwrap_or(near)
    }

    /// A place, raised off both sides of a crease, as they are at one near it, by as much as what rests on one is, and off whatever else is then in the way; none, if
    /// there is no free way to it from where it came from.
    fn off_both(&self, crease: &Crease, [from, near, mut place]: [Vec3; 3], now: Time) -> Option<Vec3> {
        let ([a, b], cosine) = (&crease.sides, cosine(crease));
        // Who is farther behind one than by rounding was put there.
        if [a, b].iter().any(|side| side.distance - self.radius < -(LAIN * side.slack)) {
            return None;
        }
        let across = 1.0 - cosine * cosine;
        for _ in 0..MOST_RAISES {
            let [near_a, near_b] = [a, b].map(|side| {
                let gap = side.distance - self.radius + dot(minus(place, near), side.normal);
                max(2.0 * side.slack - gap, 0.0)
            });
            let to = along(place, a.normal, (near_a - cosine * near_b) / across);
            let to = along(to, b.normal, (near_b - cosine * near_a) / across);
            let way = Segment { from, to, radius: self.radius, during: [now; 2] };
            let Some(Hit { time, normal, slack, .. }) = self.walls.first_hit(&way) else { return Some(to) };
            place = along(to, normal, 2.0 * slack - dot(minus(to, way.at(time)), normal));
        }
        None
    }

    /// The friction of both sides of a crease that press so hard, and their sum.
    fn friction(&self, crease: &Crease, presses: [f32; 2]) -> (Friction, f32) {
        let [a, b] = crease.sides.map(|side| self.mixed(side.material).friction);
        let press = presses[0] + presses[1];
        let mean = |a: f32, b: f32| if press > 0.0 { (a * presses[0] + b * presses[1]) / press } else { 0.0 };
        (Friction { static_: mean(a.static_, b.static_), kinetic: mean(a.kinetic, b.kinetic) }, press)
    }

    /// The way along a crease, which is told to whoever wants to know.
    fn go_along(&mut self, crease: &Crease, arriving: &Arriving) -> Path {
        let Arriving { place, during, before, slip, raised, acceleration } = *arriving;
        let (friction, pressing) = self.friction(crease, crease.pressing);
        let drive = within(crease, acceleration);
        let rest = (during[1] - during[0]).seconds();
        let (way, end) = Slide { velocity: slip, drive, pressing, friction }.after(rest);
        self.report.hits += 1;
        self.tell_sides(crease, during[0], before, slip);
        if let Some(observer) = &mut self.observer {
            let world = [acceleration, way, slip, end];
            observer.slid(&Sliding { mass: self.mass, raised, world, along: [drive, way, slip, end] });
        }
        Path { x0: place, v0: slip, x1: plus(place, way), v1: end, during, pull: Some(acceleration) }
    }

    /// Tells of the hits of both sides, if anybody wants to know: of what the first pushes it by, and of all else with the second.
    fn tell_sides(&mut self, crease: &Crease, time: Time, before: Vec3, after: Vec3) {
        let (id, row, mass, surface) = (self.id, self.row, self.mass, Vec3::ZERO);
        if let Some(observer) = &mut self.observer {
            let [push, _] = pushes(crease, minus(before, after));
            let pushed = along(before, crease.sides[0].normal, push);
            for (side, [before, after]) in crease.sides.iter().zip([[before, pushed], [pushed, after]]) {
                let (normal, place) = (side.normal, side.point);
                let closing = max(-dot(before, normal), 0.0);
                observer.hit(&Impact {
                    id,
                    row,
                    other: None,
                    mass,
                    place,
                    normal,
                    closing,
                    before,
                    after,
                    surface,
                    time,
                });
            }
        }
    }
}

/// How hard each side of a crease pushes what comes into it with such a velocity and leaves neither \[m/s\].
fn pushes(crease: &Crease, velocity: Vec3) -> [f32; 2] {
    let [a, b] = &crease.sides;
    let (cosine, [on_a, on_b]) = (cosine(crease), [a, b].map(|side| -dot(velocity, side.normal)));
    let across = 1.0 - cosine * cosine;
    [on_a - cosine * on_b, on_b - cosine * on_a].map(|push| max(push / across, 0.0))
}

/// The part of a vector that leads along a crease.
fn within(crease: &Crease, vector: Vec3) -> Vec3 {
    scaled(crease.along, dot(crease.along, vector))
}

/// The cosine between the sides of a crease.
fn cosine(crease: &Crease) -> f32 {
    let [a, b] = &crease.sides;
    dot(a.normal, b.normal)
}
