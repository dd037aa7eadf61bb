//! Steps divided into sub-steps: into a given number, or into as many as accuracy takes.

use pointmass::stability::Limit;
use pointmass::{Heap, Id, Observer, Report, Scene, System, Time, Vec3};
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
    /// How far the worst of them ends from where half as many sub-steps would take it \[m\]; infinite if somebody was no longer finite.
    pub(crate) farthest: f64,
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
        let (report, n, gap, is_enough) = match (self.substeps, observer) {
            (Substeps::Fixed(n), observer) => {
                (divided(system, scene, end, n, observer.unwrap_or(&mut ())), n, 0.0, true)
            }
            (Substeps::Auto, None) => self.step_within_tolerance(system, scene, end),
            // Only the way that is kept shall be seen: it is found first, and gone again.
            (Substeps::Auto, Some(observer)) => {
                let (_, n, gap, is_enough) = self.step_within_tolerance(&mut system.clone(), scene, end);
                (divided(system, scene, end, n, observer), n, gap, is_enough)
            }
        };
        let told = &mut self.told;
        told.least = if told.total == 0 { n } else { told.least.min(n) };
        told.most = told.most.max(n);
        told.total += u64::from(n);
        if !is_enough {
            told.beyond += 1;
            told.farthest = told.farthest.max(gap);
        }
        report
    }

    /// Step doubling: twice as many sub-steps until that changes the end of the step by no more than the tolerance, or
    /// until it helps no longer, as where particles that are hit end elsewhere each time. The last result is kept.
    fn step_within_tolerance(
        &mut self,
        system: &mut System<Heap>,
        scene: &Scene<'_>,
        end: Time,
    ) -> (Report, u32, f64, bool) {
        /// A method of first order halves the error; what leaves more than this is no improvement.
        const STALLED: f64 = 0.75;
        /// Who errs less than this tries half as many in the next step: methods of up to third order are within the tolerance then.
        const EASY: f64 = 1.0 / 8.0;
        let dt = (end - system.time()).seconds_f64();
        // Several emitters take turns in each sub-step, so that the newborn of a step are not known by their numbers.
        let is_same = |id| system.row(id).is_some() || scene.emitters.count() < 2;
        let is_lost = |trial: &System<Heap>| trial.totals().died.nonfinite > system.totals().died.nonfinite;
        let first = self.stable(dt).max(self.first).min(MOST / 2);
        let (mut n, mut before, mut is_wild) = (first, f64::INFINITY, false);
        let mut coarse = system.clone();
        divided(&mut coarse, scene, end, n, &mut ());
        loop {
            n *= 2;
            let mut fine = system.clone();
            let report = divided(&mut fine, scene, end, n, &mut ());
            let gap = Gap::between([&coarse, &fine], dt, self.tolerance, is_lost, is_same);
            let is_enough = gap.tolerances <= 1.0;
            let is_less = gap.metres <= STALLED * before;
            // What has exploded may do so more or less at first.
            is_wild = gap.is_wild() || is_wild && !is_less;
            let helps = is_less || is_wild;
            if is_enough || !helps || 2 * n > MOST {
                self.first = match is_enough {
                    true if gap.tolerances < EASY => (n / 4).max(1),
                    true => n / 2,
                    false => first,
                };
                *system = fine;
                return (report, n, gap.metres, is_enough);
            }
            before = gap.metres;
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

/// How far apart two trials of a step end.
#[derive(Clone, Copy, Debug)]
struct Gap {
    /// The largest difference of any particle in place, or in velocity times the step \[m\]. Infinite if a trial has lost
    /// somebody who was not finite.
    metres: f64,
    /// The largest such difference over the tolerance and what rounding may do.
    tolerances: f64,
    /// How far the fastest goes in a step, in the trial where that is less \[m\].
    way: f64,
}

impl Gap {
    /// Between two trials of a step of `dt` \[s\], of which `is_lost` says whether somebody was no longer finite, and `is_same`
    /// whether a number is the same particle's in both.
    fn between(
        [coarse, fine]: [&System<Heap>; 2],
        dt: f64,
        tolerance: f64,
        is_lost: impl Fn(&System<Heap>) -> bool,
        is_same: impl Fn(Id) -> bool,
    ) -> Self {
        /// Units in the last place by which rounding may part them.
        const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;
        let way = dt * fastest(coarse).min(fastest(fine));
        let mut gap = Self { metres: 0.0, tolerances: 0.0, way };
        if is_lost(coarse) || is_lost(fine) {
            return Self { metres: f64::INFINITY, tolerances: f64::INFINITY, way };
        }
        let (p, q) = (coarse.particles(), fine.particles());
        for row in 0..fine.len() {
            // Who lives in one alone died or was born at the step's end.
            let known = fine.id(row).filter(|&id| is_same(id));
            let Some(other) = known.and_then(|id| coarse.row(id)) else { continue };
            let apart = between(p.position[other], q.position[row]);
            let parting = between(p.velocity[other], q.velocity[row]) * dt;
            let metres = apart.max(parting);
            gap.metres = gap.metres.max(metres);
            let slack = tolerance + ROUNDING * between(q.position[row], Vec3::ZERO);
            gap.tolerances = gap.tolerances.max(number_or_infinite(metres / slack));
        }
        gap
    }

    /// True if the trials have nothing in common, as those of steps that explode: where hits end elsewhere each time, they
    /// differ by no more than what moves anyway.
    fn is_wild(&self) -> bool {
        /// So many ways of the fastest are beyond what a hit makes of a step.
        const WILD: f64 = 10.0;
        !(self.metres <= WILD * self.way)
    }
}

/// The speed of the fastest \[m/s\].
fn fastest(system: &System<Heap>) -> f64 {
    system.particles().velocity.iter().map(|&v| between(v, Vec3::ZERO)).fold(0.0, f64::max)
}

/// The distance between two places, which 64 bits hold whatever they are.
fn between(a: Vec3, b: Vec3) -> f64 {
    let square: f64 = (0..3).map(|axis| (f64::from(a[axis]) - f64::from(b[axis])).powi(2)).sum();
    number_or_infinite(square.sqrt())
}

/// What is not a number is as far as can be, since the greatest of several passes it over.
fn number_or_infinite(x: f64) -> f64 {
    if x.is_nan() { f64::INFINITY } else { x }
}
