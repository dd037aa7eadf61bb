//! Steps divided into sub-steps: into a given number, or into as many as accuracy takes.

use pointmass::stability::Limit;
use pointmass::{Heap, Observer, Report, Scene, System, Time};
use serde::Serialize;
use std::str::FromStr;

/// How many sub-steps a step may have at the most when their number is chosen here.
pub(crate) const MOST: u32 = 1024;

/// How many sub-steps a step has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Substeps {
    /// So many.
    Fixed(u32),
    /// As many as stability and the tolerance ask, `MOST` at the most.
    Auto,
}

impl Default for Substeps {
    fn default() -> Self {
        Self::Fixed(1)
    }
}

impl FromStr for Substeps {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.trim() {
            "auto" => Ok(Self::Auto),
            text => match text.parse() {
                Ok(n) if (1..=1_000_000).contains(&n) => Ok(Self::Fixed(n)),
                _ => Err("expected a whole number from 1 to 1000000, or auto".into()),
            },
        }
    }
}

/// Divides the steps of a run.
#[derive(Clone, Debug)]
pub(crate) struct Pace {
    substeps: Substeps,
    /// The largest stable sub-step.
    limit: Limit,
    /// How far a step of half as many sub-steps may end from it \[m\].
    tolerance: f64,
    /// How many sub-steps are tried first.
    first: u32,
    told: Told,
}

/// How steps were divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Told {
    /// Whether the numbers were chosen by the program.
    pub(crate) auto: bool,
    /// The fewest sub-steps of a step.
    pub(crate) least: u32,
    /// The most.
    pub(crate) most: u32,
    /// Sub-steps of all steps.
    pub(crate) total: u64,
    /// Steps that may end farther off, since they had as many as they may have or more did not help.
    pub(crate) beyond: u64,
    /// How far a step of half as many sub-steps may end from it \[m\], if the numbers were chosen.
    pub(crate) tolerance: Option<f64>,
}

impl Pace {
    /// A given number of sub-steps, or as many as it takes to stay below the largest stable step and within the tolerance
    /// \[m\].
    pub(crate) fn new(substeps: Substeps, limit: Limit, tolerance: f64) -> Self {
        let auto = substeps == Substeps::Auto;
        let told = Told { auto, tolerance: auto.then_some(tolerance), ..Told::default() };
        Self { substeps, limit, tolerance, first: 1, told }
    }

    /// How many sub-steps a step has.
    pub(crate) fn substeps(&self) -> Substeps {
        self.substeps
    }

    /// How steps were divided so far.
    pub(crate) fn told(&self) -> Told {
        self.told
    }

    /// Steps a system to the instant `end`, while somebody may watch.
    pub(crate) fn step(
        &mut self,
        system: &mut System<Heap>,
        scene: &Scene<'_>,
        end: Time,
        observer: Option<&mut dyn Observer>,
    ) -> Report {
        let (report, n, is_enough) = match (self.substeps, observer) {
            (Substeps::Fixed(n), observer) => (divided(system, scene, end, n, observer.unwrap_or(&mut ())), n, true),
            (Substeps::Auto, None) => self.step_within_tolerance(system, scene, end),
            // Only the way that is kept shall be seen: it is found first, and gone again.
            (Substeps::Auto, Some(observer)) => {
                let (_, n, is_enough) = self.step_within_tolerance(&mut system.clone(), scene, end);
                (divided(system, scene, end, n, observer), n, is_enough)
            }
        };
        let told = &mut self.told;
        told.least = if told.total == 0 { n } else { told.least.min(n) };
        told.most = told.most.max(n);
        told.total += u64::from(n);
        told.beyond += u64::from(!is_enough);
        report
    }

    /// Step doubling: twice as many sub-steps until that changes the end of the step by no more than the tolerance, or
    /// until it helps no longer, as where particles that are hit end elsewhere each time. The last result is kept.
    fn step_within_tolerance(
        &mut self,
        system: &mut System<Heap>,
        scene: &Scene<'_>,
        end: Time,
    ) -> (Report, u32, bool) {
        /// A method of first order halves the error; what leaves more than this is no improvement.
        const STALLED: f32 = 0.75;
        let dt = (end - system.time()).seconds_f64();
        let first = self.stable(dt).max(self.first).min(MOST / 2);
        let (mut n, mut error) = (first, f32::INFINITY);
        let mut coarse = system.clone();
        divided(&mut coarse, scene, end, n, &mut ());
        loop {
            n *= 2;
            let mut fine = system.clone();
            let report = divided(&mut fine, scene, end, n, &mut ());
            let before = error;
            error = distance(&coarse, &fine, dt, self.tolerance);
            let is_enough = error <= 1.0;
            if is_enough || error > STALLED * before || 2 * n > MOST {
                self.first = if is_enough { n / 2 } else { first };
                *system = fine;
                return (report, n, is_enough);
            }
            coarse = fine;
        }
    }

    /// How many sub-steps of a step are stable.
    fn stable(&self, dt: f64) -> u32 {
        match self.limit {
            // The cast saturates.
            Limit::Step(limit) => ((dt / limit).ceil() as u32).max(1),
            Limit::Never | Limit::Unconditional => 1,
        }
    }
}

/// Steps to `end` in `n` equal parts, up to the clock's tick.
fn divided(system: &mut System<Heap>, scene: &Scene<'_>, end: Time, n: u32, observer: &mut dyn Observer) -> Report {
    let begin = system.time();
    let ticks = u128::from((end - begin).ticks());
    let mut report = Report::NOTHING;
    for i in 1..=u128::from(n) {
        // A part of a span that fits in 64 bits fits in them.
        let part = Time::from_ticks((ticks * i / u128::from(n)) as u64);
        report += system.step_observed(scene, begin + part - system.time(), observer);
    }
    report
}

/// How far apart both systems are, in tolerances: the largest difference of any particle in place, or in velocity times
/// `dt` \[s\], over the tolerance \[m\] and what rounding may do. Infinite if one of them has removed a particle that was
/// not finite.
fn distance(a: &System<Heap>, b: &System<Heap>, dt: f64, tolerance: f64) -> f32 {
    /// Units in the last place by which rounding may part them.
    const ROUNDING: f32 = 8.0 * f32::EPSILON;
    if a.totals().died.nonfinite != b.totals().died.nonfinite {
        return f32::INFINITY;
    }
    let (p, q) = (a.particles(), b.particles());
    let apart = |row: usize| {
        // Who lives in one alone died or was born at the step's end.
        let other = b.id(row).and_then(|id| a.row(id))?;
        let slack = tolerance as f32 + ROUNDING * q.position[row].length();
        let apart = (p.position[other] - q.position[row]).length();
        let parting = (p.velocity[other] - q.velocity[row]).length() * dt as f32;
        Some(apart.max(parting) / slack)
    };
    (0..b.len()).filter_map(apart).fold(0.0, f32::max)
}
