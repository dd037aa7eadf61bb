//! One particle's way through a step: hit by hit.

use super::grip::on_surface;
use super::path::{MAX_CHORDS, Path, between};
use super::slide::Slide;
use crate::math::{clamp, length, max, unit};
use crate::observe::{Impact, Observer};
use crate::particles::Id;
use crate::report::Report;
use crate::retire::Fate;
use crate::scene::Scene;
use crate::shape::{Hit, Segment};
use glam::Vec3;

/// How many times a particle may bounce in one step before it waits at the surface.
const MAX_BOUNCES: u32 = 8;

/// How many times a point beside a hit is sought farther back.
const MAX_RETREATS: u32 = 12;

/// A rebound that would be over within this part of a step is none: the particle rests on the surface.
pub(super) const RESTING: f32 = 0.25;

/// How a path ends.
pub(super) struct Arrival {
    pub(super) position: Vec3,
    pub(super) velocity: Vec3,
    pub(super) fate: Fate,
}

/// Where a path meets something.
pub(super) struct Meeting {
    /// The fraction of the whole path before it.
    pub(super) time: f32,
    /// The chord on which it lies, and where there.
    chord: Segment,
    hit: Hit,
    /// What it meets removes it.
    pub(super) is_sink: bool,
}

/// What it takes to follow one particle.
pub(super) struct Flight<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) id: Id,
    pub(super) row: usize,
    pub(super) radius: f32,
    pub(super) mass: f32,
    pub(super) elasticity: f32,
    pub(super) material: Option<u16>,
    /// The step \[s\].
    pub(super) dt: f32,
    pub(super) report: &'a mut Report,
    pub(super) observer: &'a mut dyn Observer,
}

impl Meeting {
    /// The end in a sink.
    pub(super) fn arrival(&self, path: &Path) -> Arrival {
        let velocity = path.v0 + (path.v1 - path.v0) * self.time;
        Arrival { position: self.chord.at(self.hit.time), velocity, fate: Fate::Sink }
    }
}

impl Flight<'_> {
    /// A newborn's path without the surface that it meets within rounding of its birth: it lies on that of its source,
    /// on whichever side rounding put it, and leaves it the way its velocity points.
    pub(super) fn let_go(&self, path: Path) -> Path {
        let [start, _] = path.during;
        let ahead = Segment { during: [start; 2], ..Segment::new(path.x0, path.x0 + path.v0 * self.dt) };
        let hits = [self.scene.colliders.first_hit(&ahead), self.scene.sinks.first_hit(&ahead)];
        let (step, far) = (ahead.step(), length(ahead.step()));
        let near = |hit: &Hit| {
            let off_surface = -step.dot(hit.normal) * hit.time <= 2.0 * hit.slack;
            // A graze farther away is no birth on the surface.
            off_surface && far * hit.time <= 40.0 * hit.slack
        };
        let beyond = |hit: Hit| ahead.at(hit.time) + unit(step) * (4.0 * hit.slack);
        let x0 = hits.into_iter().flatten().find(near).map_or(path.x0, beyond);
        Path { x0, x1: if path.duration() > 0.0 { path.x1 } else { x0 }, ..path }
    }

    pub(super) fn follow(&mut self, mut path: Path) -> Arrival {
        for _ in 0..MAX_BOUNCES {
            let Some(meeting) = self.first_meeting(&path) else {
                return Arrival { position: path.x1, velocity: path.v1, fate: Fate::Lives };
            };
            if meeting.is_sink {
                return meeting.arrival(&path);
            }
            path = self.rebound(&path, &meeting);
        }
        self.report.caps.bounces += 1;
        let position = self.scene.colliders.carry(path.x0, self.radius, path.during);
        Arrival { position, velocity: path.v0, fate: Fate::Lives }
    }

    /// The first hit along the path's chords. A sink wins over a collider in the same place.
    pub(super) fn first_meeting(&mut self, path: &Path) -> Option<Meeting> {
        let chords = path.chords();
        if chords > MAX_CHORDS {
            self.report.caps.chords += 1;
        }
        let chords = chords.min(MAX_CHORDS);
        for (chord, i) in path.pieces(chords, self.radius).zip(0_u8..) {
            let (wall, sink) = (self.scene.colliders.first_hit(&chord), self.scene.sinks.first_hit(&chord));
            let is_sink = match (&wall, &sink) {
                (Some(wall), Some(sink)) => sink.time <= wall.time,
                (_, sink) => sink.is_some(),
            };
            if let Some(hit) = if is_sink { sink } else { wall } {
                return Some(Meeting { time: (f32::from(i) + hit.time) / chords as f32, chord, hit, is_sink });
            }
        }
        None
    }

    /// The way on from a hit: the velocity against the surface turned round and scaled by the elasticity, that along it
    /// braked by friction, the mean acceleration of the path so far for the time that is left.
    pub(super) fn rebound(&mut self, path: &Path, meeting: &Meeting) -> Path {
        self.report.hits += 1;
        let Hit { normal, velocity: surface, material, .. } = meeting.hit;
        let feel = on_surface(self.scene.grips, self.elasticity, self.material, material);
        let during = [path.instant(meeting.time), path.during[1]];
        let rest = (during[1] - during[0]).seconds();
        let acceleration = path.acceleration();
        let before = path.v0 + (path.v1 - path.v0) * meeting.time;
        let incoming = (before - surface).dot(normal);
        // Should the velocity already point out, the path left and came back between two chords: it rests.
        let outgoing = if incoming < 0.0 { -incoming * feel.elasticity } else { incoming };
        let pressing = -acceleration.dot(normal);
        let rests = pressing > 0.0 && (incoming >= 0.0 || 2.0 * outgoing < RESTING * self.dt * pressing);
        let outgoing = if rests { 0.0 } else { outgoing };
        let slip = before - surface - normal * incoming;
        let slip = slip + feel.friction.answer(slip, outgoing - incoming);
        let velocity = surface + slip + normal * outgoing;
        let Self { id, row, mass, .. } = *self;
        let (place, time, closing) = (meeting.chord.at(meeting.hit.time), during[0], max(-incoming, 0.0));
        self.observer.hit(&Impact {
            id,
            row,
            other: None,
            mass,
            place,
            normal,
            closing,
            before,
            after: velocity,
            time,
        });
        if !rests {
            return Path::onward(self.set_off(meeting), velocity, acceleration, during);
        }
        let drive = acceleration + normal * pressing;
        let (way, end) = Slide { velocity: slip, drive, pressing, friction: feel.friction }.after(rest);
        // What was at rest and stays so has not moved at all: falling onto the surface anew each step, it would creep.
        let rested = path.v0 == surface && slip == Vec3::ZERO && end == Vec3::ZERO;
        let x0 = if rested { path.x0 + surface * (path.duration() - rest) } else { self.set_off(meeting) };
        Path { x0, v0: velocity, x1: x0 + surface * rest + way, v1: surface + end, during }
    }

    /// A point beside the hit that is surely on the side the path came from: off the surface by twice its slack, if the
    /// way there is free; else as far back on the path as is free, at last its beginning. A surface that moves takes
    /// what is back on the path along to the instant of the hit.
    fn set_off(&self, meeting: &Meeting) -> Vec3 {
        let Meeting { chord, hit, .. } = meeting;
        let [start, end] = chord.during;
        let (moves, ride) = (hit.velocity != Vec3::ZERO, hit.velocity * (end - start).seconds());
        let taken = |point: Vec3, time: f32| if moves { point + ride * (hit.time - time) } else { point };
        let free = |segment: Segment| self.scene.colliders.first_hit(&segment).is_none();
        let closing = max((ride - chord.step()).dot(hit.normal), f32::MIN_POSITIVE);
        let beside = chord.at(hit.time) + hit.normal * (2.0 * hit.slack);
        let now = between(chord.during, hit.time);
        let mut back = 2.0 * hit.slack / closing;
        // At a rim or in a corner another surface may be nearer than the slack of this one.
        for _ in 0..MAX_RETREATS {
            let time = clamp(hit.time - back, 0.0, 1.0);
            let before = taken(chord.at(time), time);
            if free(Segment { to: before, during: [start, now], ..*chord }) {
                let aside = Segment { from: before, to: beside, during: [now; 2], ..*chord };
                return if free(aside) { beside } else { before };
            }
            back *= 4.0;
        }
        taken(chord.from, 0.0)
    }
}
