//! A problem solved once: by one method, in steps of one length.

use super::problem::Problem;
use crate::outcome::Outcome;
use crate::schedule::Schedule;
use pointmass::integrate::Tuned;
use pointmass::{Effort, Heap, Ledger, Particle, Scene, System};
use serde::Serialize;

/// Places \[m\] of the living by the number of their birth.
pub(crate) type Places = Vec<(u32, [f64; 3])>;

/// How a problem is to be solved.
#[derive(Clone, Copy)]
pub(crate) struct Trial<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) method: Tuned,
    /// The step \[s\].
    pub(crate) dt: f64,
    /// Until when \[s\].
    pub(crate) duration: f64,
    /// Coordinates beyond this say that it blew up \[m\].
    pub(crate) limit: f64,
}

/// The outcome of that.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outturn {
    pub(crate) places: Places,
    pub(crate) effort: Effort,
    /// Times that a particle met a collider.
    pub(crate) hits: u64,
    /// Particles that emitters brought into the world.
    pub(crate) born: u64,
    /// When a place was no longer a number, or beyond the limit \[s\].
    pub(crate) blew_up_at: Option<f64>,
    /// The largest coordinate \[m\].
    pub(crate) extent: f64,
    pub(crate) track: Track,
}

/// How the error of the energy went \[J\].
#[derive(Clone, Debug, Default)]
pub(crate) struct Track {
    /// Kinetic and potential at the start.
    pub(crate) opening: f64,
    /// The most kinetic energy.
    pub(crate) kinetic: f64,
    /// The largest error.
    pub(crate) worst: f64,
    /// In each of equal parts of the time, when it ends \[s\] and the largest error there.
    pub(crate) curve: Vec<[f64; 2]>,
    sums: Sums,
}

/// Sums for a straight line through (time, error).
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    n: f64,
    t: f64,
    e: f64,
    tt: f64,
    te: f64,
    ee: f64,
}

/// A straight line through errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Trend {
    /// Its slope a second.
    pub(crate) per_second: f64,
    /// The root of the mean square about it.
    pub(crate) swing: f64,
}

impl Trial<'_> {
    /// Solves it, and keeps account of its energy.
    pub(crate) fn watched(&self) -> Outcome<Outturn> {
        let scene = Scene { integrator: &self.method, ..self.problem.scene() };
        let mut system = self.problem.system(&scene)?;
        let mut ledger = Ledger::new(&system, &scene);
        let mut track = Track { opening: ledger.books().opening, ..Track::default() };
        let schedule = Schedule::new(self.duration, self.dt);
        let mut outturn = self.follow(&mut system, schedule, |system, dt| {
            system.step_observed(&scene, dt, &mut ledger);
            track.add(system, ledger.books().remainder, self.duration);
        });
        outturn.track = track;
        Ok(outturn)
    }

    /// Solves it from a start that is moved by the least an `f32` can tell.
    pub(crate) fn nudged(&self) -> Outcome<Outturn> {
        let problem = self.problem.scene();
        let nudge = |x: f32| if x == 0.0 { x } else { x.next_up() };
        let move_up = |p: &Particle| if p.fixed { *p } else { Particle { position: p.position.map(nudge), ..*p } };
        let start: Vec<_> = problem.start.iter().map(move_up).collect();
        let scene = Scene { start: &start, integrator: &self.method, ..problem };
        let mut system = self.problem.system(&scene)?;
        let schedule = Schedule::new(self.duration, self.dt);
        Ok(self.follow(&mut system, schedule, |system, dt| {
            system.step(&scene, dt);
        }))
    }

    fn follow(
        &self,
        system: &mut System<Heap>,
        schedule: Schedule,
        mut step: impl FnMut(&mut System<Heap>, pointmass::Time),
    ) -> Outturn {
        let mut outturn = Outturn::default();
        for n in 1..=schedule.steps() {
            step(system, schedule.end(n) - system.time());
            let largest = |x: &pointmass::Vec3| f64::from(x.abs().max_element());
            outturn.extent = system.particles().position.iter().map(largest).fold(outturn.extent, f64::max);
            if outturn.extent > self.limit || system.totals().died.nonfinite > 0 {
                outturn.blew_up_at = Some(system.time().seconds_f64());
                break;
            }
        }
        let rows = (0..system.len()).filter_map(|row| Some((system.id(row)?.serial(), row)));
        let place = |row: usize| system.particles().position[row].to_array().map(f64::from);
        outturn.places = rows.map(|(serial, row)| (serial, place(row))).collect();
        outturn.places.sort_by_key(|(serial, _)| *serial);
        outturn.effort = system.totals().effort;
        outturn.hits = system.totals().hits;
        outturn.born = system.totals().born;
        outturn
    }
}

impl Track {
    /// Parts of the time in a curve.
    const PARTS: f64 = 60.0;

    fn add(&mut self, system: &System<Heap>, error: f64, duration: f64) {
        let particles = system.particles();
        let all = particles.velocity.iter().zip(particles.mass);
        let kinetic = all.map(|(v, &m)| 0.5 * f64::from(m) * f64::from(v.length_squared())).sum();
        self.kinetic = self.kinetic.max(kinetic);
        let t = system.time().seconds_f64();
        if !error.is_finite() {
            return;
        }
        self.worst = self.worst.max(error.abs());
        let part = (t / duration * Self::PARTS).ceil().max(1.0) * duration / Self::PARTS;
        match self.curve.last_mut().filter(|[end, _]| *end == part) {
            Some([_, worst]) => *worst = worst.max(error.abs()),
            None => self.curve.push([part, error.abs()]),
        }
        self.sums.add(t, error);
    }

    /// The straight line that fits the errors best.
    pub(crate) fn trend(&self) -> Trend {
        self.sums.trend()
    }
}

impl Sums {
    fn add(&mut self, t: f64, e: f64) {
        let Self { n, t: st, e: se, tt, te, ee } = *self;
        *self = Self { n: n + 1.0, t: st + t, e: se + e, tt: tt + t * t, te: te + t * e, ee: ee + e * e };
    }

    fn trend(&self) -> Trend {
        let Self { n, t, e, tt, te, ee } = *self;
        let (square, product, spread) = (tt - t * t / n, te - t * e / n, ee - e * e / n);
        if !(square > 0.0) {
            return Trend::default();
        }
        let per_second = product / square;
        Trend { per_second, swing: ((spread - per_second * product).max(0.0) / n).sqrt() }
    }
}

/// The root of the mean squared distance \[m\] of those that are in both, how many these are, and how many are in one
/// alone.
pub(crate) fn apart(a: &Places, b: &Places) -> (f64, usize, usize) {
    let square = |x: &[f64; 3], y: &[f64; 3]| x.iter().zip(y).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
    let in_b = |serial: u32| b.binary_search_by_key(&serial, |(serial, _)| *serial).ok();
    let squares: Vec<_> = a.iter().filter_map(|(serial, x)| Some(square(x, &b[in_b(*serial)?].1))).collect();
    let both = squares.len();
    let mean = if both > 0 { squares.iter().sum::<f64>() / both as f64 } else { 0.0 };
    (mean.sqrt(), both, a.len() + b.len() - 2 * both)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trends_are_lines() {
        let mut sums = Sums::default();
        (0..100).for_each(|i| sums.add(f64::from(i), 3.0 - 0.5 * f64::from(i)));
        let Trend { per_second, swing } = sums.trend();
        assert!((per_second + 0.5).abs() < 1e-12 && swing < 1e-6);
        assert_eq!(Sums::default().trend(), Trend::default());
    }

    #[test]
    fn only_those_in_both_are_held_against_each_other() {
        let a = vec![(0, [0.0; 3]), (2, [1.0, 0.0, 0.0]), (5, [9.0; 3])];
        let b = vec![(0, [0.0, 3.0, 4.0]), (1, [7.0; 3]), (2, [1.0, 0.0, 0.0])];
        assert_eq!(apart(&a, &b), (12.5f64.sqrt(), 2, 2));
        assert_eq!(apart(&a, &Vec::new()), (0.0, 0, 3));
    }
}
