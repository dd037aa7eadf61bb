//! The path of a particle through a step, and the chords along which its collisions are sought.

use crate::math::{along, dot, high, is_zero, length, low, max, minus, over, plus, scaled, sqrt};
use crate::rows::are_finite;
use crate::shape::{Aabb, Segment};
use crate::time::Time;
use core::slice::from_ref;
use glam::Vec3;

/// How far the chords along which hits are found may stray from a path \[m\], unless that takes more than `MAX_CHORDS`.
pub(crate) const CHORD_ERROR: f32 = 1e-4;

/// The largest number of chords that a path is followed along.
pub(crate) const MAX_CHORDS: u32 = 8;

/// The cubic along which a particle moves: positions and velocities at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    pub(super) x0: Vec3,
    pub(super) v0: Vec3,
    pub(super) x1: Vec3,
    pub(super) v1: Vec3,
    /// When it begins and ends.
    pub(super) during: [Time; 2],
    /// Along a surface, which bears some of it, the mean acceleration of what drives it \[m/s²\]: its next hit is not to think that gone.
    pub(super) pull: Option<Vec3>,
}

/// The same as a polynomial in the fraction of its time, for whoever asks for many points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    pub(super) start: Vec3,
    /// The coefficients of the first power and on \[m\].
    pub(super) coefficients: [Vec3; 3],
}

impl Cubic {
    /// The point at a fraction of the time: Hermite's cubic, which is the exact parabola under constant acceleration.
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn at(&self, s: f32) -> Vec3 {
        let [c1, c2, c3] = self.coefficients;
        along(self.start, along(c1, along(c2, c3, s), s), s)
    }

    /// The number of chords that stay within `CHORD_ERROR` of it: a chord strays by at most |x''| / 8.
    pub(super) fn chords(&self) -> u32 {
        let [_, c2, c3] = self.coefficients;
        let end = along(c2, c3, 3.0);
        // Most do not bend so much: no root is needed.
        if max(dot(c2, c2), dot(end, end)) <= (4.0 * CHORD_ERROR) * (4.0 * CHORD_ERROR) {
            return 1;
        }
        let bend = 2.0 * max(length(c2), length(end));
        let ratio = bend / (8.0 * CHORD_ERROR);
        // The cast rounds down and saturates.
        if ratio > 1.0 { (sqrt(ratio) as u32).saturating_add(1) } else { 1 }
    }
}

impl Path {
    /// How long it takes \[s\].
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn duration(&self) -> f32 {
        let [start, end] = self.during;
        (end - start).seconds()
    }

    /// The instant at a fraction of the time.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn instant(&self, s: f32) -> Time {
        between(self.during, s)
    }

    pub(super) fn is_finite(&self) -> bool {
        // A term that is not finite makes a sum that is not; a sum may be so without one. Chips are spared the sum.
        let sum_is_finite = || (self.x0 + self.v0 + self.x1 + self.v1).is_finite();
        let ends = || [&self.x0, &self.v0, &self.x1, &self.v1].into_iter().all(|end| are_finite(from_ref(end)));
        !cfg!(one_by_one) && sum_is_finite() || ends()
    }

    /// A box that holds a ball on it: that of its Bézier control points.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn hull(&self, radius: f32) -> Aabb {
        let third = self.duration() * (1.0 / 3.0);
        let (a, b) = (along(self.x0, self.v0, third), along(self.x1, self.v1, -third));
        let (min, max) = (low(low(self.x0, self.x1), low(a, b)), high(high(self.x0, self.x1), high(a, b)));
        Aabb { min, max }.grown(radius).with_slack()
    }

    /// It as a polynomial.
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn cubic(&self) -> Cubic {
        let (duration, excess) = (self.duration(), self.excess());
        let bend = along(scaled(minus(self.v1, self.v0), 0.5 * duration), excess, 3.0);
        Cubic { start: self.x0, coefficients: [scaled(self.v0, duration), bend, scaled(excess, -2.0)] }
    }

    /// The point at a fraction of the time.
    pub(super) fn at(&self, s: f32) -> Vec3 {
        self.cubic().at(s)
    }

    /// The velocity at a fraction of the time \[m/s\]. Where the cubic bends as the ends' velocities do not say, as with the
    /// two Euler methods, it is theirs in between: what a hit takes in before and after adds up to the step's.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn velocity(&self, s: f32) -> Vec3 {
        let (steady, excess) = (along(self.v0, minus(self.v1, self.v0), s), self.excess());
        if self.is_smooth(excess) { along(steady, excess, 6.0 * s * (1.0 - s) / self.duration()) } else { steady }
    }

    /// How much farther it leads than a parabola with the velocities of its ends. What is within the rounding of the ends is
    /// nothing: as a velocity it would be noise.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn excess(&self) -> Vec3 {
        let excess = along(minus(self.x1, self.x0), plus(self.v0, self.v1), -0.5 * self.duration());
        let rounding = scaled(plus(self.x0.abs(), self.x1.abs()), f32::EPSILON);
        Vec3::select(excess.abs().cmple(rounding), Vec3::ZERO, excess)
    }

    /// Half the change of its velocity, as a way \[m\].
    fn bend(&self) -> Vec3 {
        scaled(minus(self.v1, self.v0), 0.5 * self.duration())
    }

    /// Tells whether its cubic bends as the motion does: its derivative is the velocity.
    pub(super) fn is_smooth(&self, excess: Vec3) -> bool {
        let bend = self.bend();
        !is_zero(excess) && dot(excess, excess) < 0.0625 * dot(bend, bend)
    }

    /// Its rest from a fraction of the time on, as a path of its own.
    pub(super) fn rest(&self, s: f32) -> Self {
        if !(s > 0.0 && self.duration() > 0.0) {
            return *self;
        }
        Self { x0: self.at(s), v0: self.velocity(s), during: [self.instant(s), self.during[1]], ..*self }
    }

    /// How it runs as seen from another during the same time.
    pub(super) fn seen_from(&self, other: &Self) -> Self {
        let (x0, v0) = (self.x0 - other.x0, self.v0 - other.v0);
        Self { x0, v0, x1: self.x1 - other.x1, v1: self.v1 - other.v1, during: self.during, pull: None }
    }

    /// The way on from a place and a velocity under a steady acceleration, until it ends.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn onward(x0: Vec3, v0: Vec3, acceleration: Vec3, during: [Time; 2]) -> Self {
        let time = (during[1] - during[0]).seconds();
        let (x1, v1) = (along(x0, along(v0, acceleration, 0.5 * time), time), along(v0, acceleration, time));
        Self { x0, v0, x1, v1, during, pull: None }
    }

    /// Tells whether its end shows nothing yet of what its velocity has taken in, as with the explicit Euler method.
    pub(super) fn lags(&self) -> bool {
        let bend = self.bend();
        dot(self.excess(), bend) < -0.5 * dot(bend, bend)
    }

    /// The parabola from its beginning with the velocities of its ends.
    pub(super) fn caught_up(&self) -> Self {
        Self { x1: along(self.x0, plus(self.v0, self.v1), 0.5 * self.duration()), ..*self }
    }

    /// Straight from its beginning to its end.
    pub(super) fn straightened(&self) -> Self {
        let duration = self.duration();
        let velocity = if duration > 0.0 { over(minus(self.x1, self.x0), duration) } else { Vec3::ZERO };
        Self { v0: velocity, v1: velocity, ..*self }
    }

    /// Its mean acceleration \[m/s²\].
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn acceleration(&self) -> Vec3 {
        let duration = self.duration();
        if duration > 0.0 { over(minus(self.v1, self.v0), duration) } else { Vec3::ZERO }
    }

    /// The mean acceleration of what drives it \[m/s²\], whatever bears some of that.
    pub(super) fn drive(&self) -> Vec3 {
        self.pull.unwrap_or_else(|| self.acceleration())
    }

    /// Its mean velocity \[m/s\], of which rounding of places is no part.
    pub(super) fn mean_velocity(&self) -> Vec3 {
        let (duration, of_ends) = (self.duration(), scaled(plus(self.v0, self.v1), 0.5));
        if duration > 0.0 { plus(of_ends, over(self.excess(), duration)) } else { of_ends }
    }

    /// The straight line between two fractions of its time, for a ball; `cubic` is it as a polynomial.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn piece(&self, cubic: &Cubic, [from, to]: [f32; 2], radius: f32) -> Segment {
        let end = |s: f32| match s {
            0.0 => (self.x0, self.during[0]),
            1.0 => (self.x1, self.during[1]),
            s => (cubic.at(s), self.instant(s)),
        };
        let ((from, start), (to, end)) = (end(from), end(to));
        Segment { from, to, radius, during: [start, end] }
    }
}

/// The instant at a fraction of a span.
#[cfg_attr(one_by_one, inline(never))]
pub(super) fn between([start, end]: [Time; 2], s: f32) -> Time {
    // A span is so short that single precision leaves less than a nanosecond; the cast saturates.
    let ticks = ((end - start).ticks() as f32 * s) as u64;
    (start + Time::from_ticks(ticks)).min(end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::unit;

    #[test]
    fn chords_stay_near_the_path() {
        let (v0, a, h) = (Vec3::new(3.0, 1.0, 0.0), Vec3::new(0.0, -9.8, 0.0), 0.05);
        let during = [Time::ZERO, Time::from_seconds(h)];
        let path = Path { x0: Vec3::ZERO, v0, x1: (v0 + a * (h / 2.0)) * h, v1: v0 + a * h, during, pull: None };
        let n = path.cubic().chords();
        assert!(n > 1 && n < MAX_CHORDS);
        for i in 0..n {
            let (s, t) = (i as f32 / n as f32, (i + 1) as f32 / n as f32);
            let gap = length((path.at(s) + path.at(t)) * 0.5 - path.at((s + t) * 0.5));
            assert!(gap <= CHORD_ERROR, "{gap}");
        }
        assert!((path.at(0.5) - (v0 + a * (h / 4.0)) * (h / 2.0)).length() < 1e-6);
        let straight = Path { x1: v0, v1: v0, during: [Time::ZERO, Time::from_seconds(1.0)], ..path };
        assert_eq!(straight.cubic().chords(), 1);
        assert_eq!(unit(straight.at(0.3)), unit(v0));
    }

    #[test]
    fn pieces_join_in_space_and_time() {
        let during = [Time::from_seconds(3.0), Time::from_seconds(3.25)];
        let path = Path { x0: Vec3::ZERO, v0: Vec3::X, x1: Vec3::ONE, v1: Vec3::Y, during, pull: None };
        let (mut place, mut instant) = (path.x0, during[0]);
        for i in 0..5_u8 {
            let piece = path.piece(&path.cubic(), [i, i + 1].map(|end| f32::from(end) / 5.0), 0.0);
            assert_eq!((piece.from, piece.during[0]), (place, instant));
            (place, instant) = (piece.to, piece.during[1]);
        }
        assert_eq!((place, instant), (path.x1, during[1]));
    }
}
