//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

use crate::math::{clamp, high, length, low, max, sqrt, unit};
use crate::observe::{Impact, Observer};
use crate::report::Report;
use crate::retire::Fate;
use crate::scene::Scene;
use crate::shape::{Aabb, Hit, Segment};
use crate::time::Time;
use crate::view::View;
use glam::Vec3;

/// How many times a particle may bounce in one step before it waits at the surface.
const MAX_BOUNCES: u32 = 8;

/// How far a path's chords may stray from it \[m\], unless that takes more than `MAX_CHORDS` of them.
pub(crate) const CHORD_ERROR: f32 = 1e-4;

/// How many chords a path is followed along at the most.
pub(crate) const MAX_CHORDS: u32 = 8;

/// How many times a point beside a hit is sought farther back.
const MAX_RETREATS: u32 = 12;

/// A rebound that would be over within this part of a step is none: the particle rests on the surface.
const RESTING: f32 = 0.25;

/// Sends every free particle along its path through the step that ends at `end`; those from row `old` on are newborn.
pub(crate) fn collide(
    view: &mut View<'_>,
    scene: &Scene<'_>,
    old: usize,
    [dt, end]: [Time; 2],
    report: &mut Report,
    observer: &mut dyn Observer,
) {
    let capacity = view.capacity();
    for row in 0..view.len() {
        let m = &mut view.memory;
        if m.inverse_mass[row] == 0.0 {
            continue;
        }
        let (start_x, start_v) = (m.work[row], m.work[capacity + row]);
        // A newborn has come only part of the way.
        let duration = (end - m.born[row]).min(dt).seconds();
        let path = Path { x0: start_x, v0: start_v, x1: m.position[row], v1: m.velocity[row], duration };
        let hull = path.hull();
        if !(scene.colliders.may_touch(&hull) || scene.sinks.may_touch(&hull)) || !path.is_finite() {
            continue;
        }
        let (mass, elasticity) = (m.mass[row], m.elasticity[row]);
        let (report, observer) = (&mut *report, &mut *observer);
        let mut flight = Flight { scene, row, mass, elasticity, dt: dt.seconds(), report, observer };
        let end = flight.follow(if row >= old { flight.let_go(path) } else { path });
        (m.position[row], m.velocity[row], m.fate[row]) = (end.position, end.velocity, end.fate);
    }
}

/// The cubic along which a particle moves: positions and velocities at both ends.
#[derive(Clone, Copy, Debug)]
struct Path {
    x0: Vec3,
    v0: Vec3,
    x1: Vec3,
    v1: Vec3,
    /// \[s\]
    duration: f32,
}

/// How a path ends.
struct Arrival {
    position: Vec3,
    velocity: Vec3,
    fate: Fate,
}

/// Where a path meets something.
struct Meeting {
    /// The fraction of the whole path before it.
    time: f32,
    /// The chord on which it lies, and where there.
    chord: Segment,
    hit: Hit,
    /// What it meets removes it.
    is_sink: bool,
}

/// What it takes to follow one particle.
struct Flight<'a> {
    scene: &'a Scene<'a>,
    row: usize,
    mass: f32,
    elasticity: f32,
    /// The step \[s\].
    dt: f32,
    report: &'a mut Report,
    observer: &'a mut dyn Observer,
}

impl Flight<'_> {
    /// A newborn's path without the surface that it meets within rounding of its birth: it lies on that of its source,
    /// on whichever side rounding put it, and leaves it the way its velocity points.
    fn let_go(&self, path: Path) -> Path {
        let ahead = Segment { from: path.x0, to: path.x0 + path.v0 * self.dt };
        let hits = [self.scene.colliders.first_hit(&ahead), self.scene.sinks.first_hit(&ahead)];
        let (step, far) = (ahead.step(), length(ahead.step()));
        let near = |hit: &Hit| {
            let off_surface = -step.dot(hit.normal) * hit.time <= 2.0 * hit.slack;
            // A graze farther away is no birth on the surface.
            off_surface && far * hit.time <= 40.0 * hit.slack
        };
        let beyond = |hit: Hit| ahead.at(hit.time) + unit(step) * (4.0 * hit.slack);
        let x0 = hits.into_iter().flatten().find(near).map_or(path.x0, beyond);
        Path { x0, x1: if path.duration > 0.0 { path.x1 } else { x0 }, ..path }
    }

    fn follow(&mut self, mut path: Path) -> Arrival {
        for _ in 0..MAX_BOUNCES {
            let Some(meeting) = self.first_meeting(&path) else {
                return Arrival { position: path.x1, velocity: path.v1, fate: Fate::Lives };
            };
            if meeting.is_sink {
                let velocity = path.v0 + (path.v1 - path.v0) * meeting.time;
                return Arrival { position: meeting.chord.at(meeting.hit.time), velocity, fate: Fate::Sink };
            }
            self.report.hits += 1;
            path = self.rebound(&path, &meeting);
        }
        self.report.caps.bounces += 1;
        Arrival { position: path.x0, velocity: path.v0, fate: Fate::Lives }
    }

    /// The first hit along the path's chords. A sink wins over a collider in the same place.
    fn first_meeting(&mut self, path: &Path) -> Option<Meeting> {
        let chords = path.chords();
        if chords > MAX_CHORDS {
            self.report.caps.chords += 1;
        }
        let chords = chords.min(MAX_CHORDS);
        let mut from = path.x0;
        for i in 1..=chords {
            let to = if i == chords { path.x1 } else { path.at(i as f32 / chords as f32) };
            let chord = Segment { from, to };
            let (wall, sink) = (self.scene.colliders.first_hit(&chord), self.scene.sinks.first_hit(&chord));
            let is_sink = match (&wall, &sink) {
                (Some(wall), Some(sink)) => sink.time <= wall.time,
                (_, sink) => sink.is_some(),
            };
            if let Some(hit) = if is_sink { sink } else { wall } {
                return Some(Meeting { time: ((i - 1) as f32 + hit.time) / chords as f32, chord, hit, is_sink });
            }
            from = to;
        }
        None
    }

    /// The way on from a hit: the normal velocity turned round and scaled by the elasticity, the mean acceleration of
    /// the path so far for the time that is left.
    fn rebound(&mut self, path: &Path, meeting: &Meeting) -> Path {
        let normal = meeting.hit.normal;
        let rest = path.duration * (1.0 - meeting.time);
        let mut acceleration = if path.duration > 0.0 { (path.v1 - path.v0) / path.duration } else { Vec3::ZERO };
        let before = path.v0 + (path.v1 - path.v0) * meeting.time;
        let incoming = before.dot(normal);
        // Should the velocity already point out, the path left and came back between two chords: it rests.
        let outgoing = if incoming < 0.0 { -incoming * self.elasticity } else { incoming };
        let mut velocity = before + normal * (outgoing - incoming);
        let pressing = -acceleration.dot(normal);
        if pressing > 0.0 && (incoming >= 0.0 || 2.0 * outgoing < RESTING * self.dt * pressing) {
            velocity -= normal * outgoing;
            acceleration += normal * pressing;
        }
        let (row, mass) = (self.row, self.mass);
        self.observer.hit(&Impact { row, mass, normal, before, after: velocity });
        let x0 = self.set_off(meeting);
        Path {
            x0,
            v0: velocity,
            x1: x0 + (velocity + acceleration * (0.5 * rest)) * rest,
            v1: velocity + acceleration * rest,
            duration: rest,
        }
    }

    /// A point beside the hit that is surely on the side the path came from: off the surface by twice its slack, if the
    /// way there is free; else as far back on the path as is free, at last its beginning.
    fn set_off(&self, meeting: &Meeting) -> Vec3 {
        let Meeting { chord, hit, .. } = meeting;
        let free = |from, to| self.scene.colliders.first_hit(&Segment { from, to }).is_none();
        let closing = max(-chord.step().dot(hit.normal), f32::MIN_POSITIVE);
        let beside = chord.at(hit.time) + hit.normal * (2.0 * hit.slack);
        let mut back = 2.0 * hit.slack / closing;
        // At a rim or in a corner another surface may be nearer than the slack of this one.
        for _ in 0..MAX_RETREATS {
            let before = chord.at(clamp(hit.time - back, 0.0, 1.0));
            if free(chord.from, before) {
                return if free(before, beside) { beside } else { before };
            }
            back *= 4.0;
        }
        chord.from
    }
}

impl Path {
    fn is_finite(&self) -> bool {
        [self.x0, self.v0, self.x1, self.v1].iter().all(|v| v.is_finite())
    }

    /// A box that holds it: that of its Bézier control points.
    fn hull(&self) -> Aabb {
        let third = self.duration * (1.0 / 3.0);
        let (a, b) = (self.x0 + self.v0 * third, self.x1 - self.v1 * third);
        Aabb { min: low(low(self.x0, self.x1), low(a, b)), max: high(high(self.x0, self.x1), high(a, b)) }.with_slack()
    }

    /// The point at a fraction of the time: Hermite's cubic, which is the exact parabola under constant acceleration.
    fn at(&self, s: f32) -> Vec3 {
        let [c1, c2, c3] = self.coefficients();
        self.x0 + (c1 + (c2 + c3 * s) * s) * s
    }

    fn coefficients(&self) -> [Vec3; 3] {
        let (way, m0, m1) = (self.x1 - self.x0, self.v0 * self.duration, self.v1 * self.duration);
        [m0, way * 3.0 - m0 * 2.0 - m1, m0 + m1 - way * 2.0]
    }

    /// How many chords stay within `CHORD_ERROR` of it: a chord strays by at most |x''| / 8.
    fn chords(&self) -> u32 {
        let [_, c2, c3] = self.coefficients();
        let bend = 2.0 * max(length(c2), length(c2 + c3 * 3.0));
        let ratio = bend / (8.0 * CHORD_ERROR);
        // The cast rounds down and saturates.
        if ratio > 1.0 { (sqrt(ratio) as u32).saturating_add(1) } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_stay_near_the_path() {
        let (v0, a, h) = (Vec3::new(3.0, 1.0, 0.0), Vec3::new(0.0, -9.8, 0.0), 0.05);
        let path = Path { x0: Vec3::ZERO, v0, x1: (v0 + a * (h / 2.0)) * h, v1: v0 + a * h, duration: h };
        let n = path.chords();
        assert!(n > 1 && n < MAX_CHORDS);
        for i in 0..n {
            let (s, t) = (i as f32 / n as f32, (i + 1) as f32 / n as f32);
            let gap = length((path.at(s) + path.at(t)) * 0.5 - path.at((s + t) * 0.5));
            assert!(gap <= CHORD_ERROR, "{gap}");
        }
        assert!((path.at(0.5) - (v0 + a * (h / 4.0)) * (h / 2.0)).length() < 1e-6);
        let straight = Path { x1: v0, v1: v0, duration: 1.0, ..path };
        assert_eq!(straight.chords(), 1);
        assert_eq!(unit(straight.at(0.3)), unit(v0));
    }
}
