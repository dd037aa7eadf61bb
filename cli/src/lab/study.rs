//! The findings of the laboratory, as every report tells them.

use super::problem::Problem;
use super::reference::{Reference, walk};
use super::trial::{Outturn, Trend, Trial, apart};
use crate::outcome::Outcome;
use crate::report::origin::Origin;
use crate::statistics::growth;
use pointmass::integrate::{Method, Tuned, Tuning};
use serde::Serialize;

/// All of it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Study {
    /// Its origin.
    #[serde(flatten)]
    pub(crate) origin: Origin,
    pub(crate) cases: Vec<Case>,
}

/// A problem and how it was solved.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Case {
    pub(crate) problem: String,
    pub(crate) about: String,
    /// When errors are taken \[s\].
    pub(crate) duration: f64,
    /// The reference that they are held against, and how far that may be off \[m\].
    pub(crate) reference: String,
    pub(crate) reference_error: f64,
    /// How far the rounding of places takes it \[m\].
    pub(crate) reference_rounding: f64,
    /// Its largest coordinate \[m\].
    pub(crate) extent: f64,
    /// The energy that errors of energy are a share of \[J\], and what that is.
    pub(crate) energy_scale: f64,
    pub(crate) energy_scale_is: String,
    /// How long energies are followed, in steps of what length \[s\].
    pub(crate) energy_duration: f64,
    pub(crate) energy_dt: f64,
    pub(crate) rows: Vec<Row>,
    /// The remarks that a reader should know.
    pub(crate) notes: Vec<String>,
}

/// A method on a problem.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    /// Its name in tables.
    pub(crate) name: String,
    pub(crate) integrator: Method,
    pub(crate) steps: Steps,
    /// By theory: the power of the step, or of the tolerance, that errors go with.
    pub(crate) expected: Option<f64>,
    /// As found.
    pub(crate) order: Option<f64>,
    pub(crate) points: Vec<Point>,
    /// How energy went over a longer time; not followed where steps go by tolerance.
    pub(crate) energy: Option<Energy>,
    pub(crate) remark: String,
}

/// Who says how long steps are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Steps {
    /// The user.
    Fixed,
    /// The method, within steps of the user's.
    Own,
    /// The method, by several tolerances.
    Tolerance,
}

impl Steps {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Own => "own",
            Self::Tolerance => "tolerance",
        }
    }
}

/// One solution.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Point {
    /// The step \[s\].
    pub(crate) dt: f64,
    /// The tolerance \[m\], if it varies.
    pub(crate) tolerance: Option<f32>,
    /// Places at the end, the root of the mean square \[m\].
    pub(crate) error: Option<f64>,
    /// How much of it rounding may be, and the reference's own error \[m\].
    pub(crate) floor: f64,
    /// Whether that is too much for the order.
    pub(crate) is_floor: bool,
    /// Whether the order was fitted to it.
    pub(crate) is_fitted: bool,
    /// Evaluations of all forces.
    pub(crate) evaluations: u64,
    /// Products with their Jacobian.
    pub(crate) products: u64,
    /// Particles held against the reference, and those that live in one of both alone.
    pub(crate) compared: usize,
    pub(crate) unmatched: usize,
    /// Times that a particle met a collider.
    pub(crate) hits: u64,
    /// Particles that emitters brought into the world.
    pub(crate) born: u64,
    /// Inner steps taken although they err too much, and solutions cut off.
    pub(crate) capped: u64,
    /// When it blew up \[s\].
    pub(crate) blew_up_at: Option<f64>,
    /// The worst error of energy, as a share.
    pub(crate) energy_worst: f64,
    /// And its trend.
    pub(crate) energy_trend: Trend,
}

/// How energy went, errors as a share.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Energy {
    pub(crate) worst: f64,
    pub(crate) trend: Trend,
    /// Evaluations of all forces and products with their Jacobian, for each second.
    pub(crate) work_per_second: f64,
    pub(crate) blew_up_at: Option<f64>,
    /// In each of equal parts of the time, when it ends \[s\] and the worst error there.
    pub(crate) curve: Vec<[f64; 2]>,
}

/// Tolerances on trial \[m\].
const TOLERANCES: [f32; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// An error has to be so many times what rounding may be.
const CLEAR: f64 = 5.0;
/// Errors of less than this part of the motion go on being rounding once they are, as steps become more.
const SMALL: f64 = 1e-3;
/// To how many of the shortest steps an order is fitted at the most.
const FITTED: usize = 3;
/// A solution so many times as far out as the reference has blown up.
const FAR: f64 = 1000.0;

impl Case {
    /// The study of these rows, without remarks.
    pub(crate) fn new(problem: &Problem, reference: &Reference, rows: Vec<Row>) -> Self {
        Self {
            problem: problem.name.clone(),
            about: problem.about.clone(),
            duration: problem.duration,
            reference: reference.about.clone(),
            reference_error: reference.error,
            reference_rounding: reference.rounding,
            extent: reference.extent,
            energy_scale: reference.energy,
            energy_scale_is: reference.energy_about.into(),
            energy_duration: problem.long,
            energy_dt: problem.usual(),
            rows,
            notes: Vec::new(),
        }
    }
}

impl Point {
    /// Evaluations of forces, and products with their Jacobian, which cost as much.
    pub(crate) fn work(&self) -> u64 {
        self.evaluations + self.products
    }
}

/// Who is tried: every method at fixed steps, and those that choose their own by that choice as well.
pub(crate) fn contestants(methods: &[Method]) -> Vec<(Method, Steps)> {
    let ways = |method: &Method| match method.chooses_steps() {
        true => &[Steps::Own, Steps::Fixed, Steps::Tolerance][..],
        false => &[Steps::Fixed][..],
    };
    methods.iter().flat_map(|method| ways(method).iter().map(|steps| (*method, *steps))).collect()
}

/// A problem with what it is held against.
pub(crate) struct Bench<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) reference: &'a Reference,
}

impl Bench<'_> {
    /// A method in its way of stepping.
    pub(crate) fn row(&self, method: Method, steps: Steps) -> Outcome<Row> {
        let Problem { tuning, dts, frame, .. } = self.problem;
        let fixed = Tuning { tolerance: f32::INFINITY, ..*tuning };
        let points: Outcome<Vec<_>> = match steps {
            Steps::Own => dts.iter().map(|dt| self.point(method, *tuning, *dt)).collect(),
            Steps::Fixed => dts.iter().map(|dt| self.point(method, fixed, *dt)).collect(),
            Steps::Tolerance => TOLERANCES
                .iter()
                .map(|&tolerance| {
                    let point = self.point(method, Tuning { tolerance, ..*tuning }, *frame)?;
                    Ok(Point { tolerance: Some(tolerance), ..point })
                })
                .collect(),
        };
        let mut points = points?;
        spread_floor(&mut points, self.reference.extent);
        let expected = self.expected(method, steps);
        let order = expected.and_then(|_| fit(&mut points, self.reference.extent));
        let energy = match steps {
            Steps::Own => Some(self.energy(Tuned { method, tuning: *tuning })?),
            Steps::Fixed => Some(self.energy(Tuned { method, tuning: fixed })?),
            Steps::Tolerance => None,
        };
        let name = match steps {
            Steps::Fixed if method.chooses_steps() => format!("{method} fixed"),
            _ => method.to_string(),
        };
        Ok(Row { name, integrator: method, steps, expected, order, points, energy, remark: String::new() })
    }

    /// Errors of a step go with h^(p+1) where those of all go with h^p; the pair compares with its lower order.
    fn expected(&self, method: Method, steps: Steps) -> Option<f64> {
        let order = self.problem.expected(method);
        match steps {
            Steps::Fixed => Some(order),
            Steps::Own => None,
            Steps::Tolerance if method == Method::Embedded => Some(1.0),
            Steps::Tolerance => Some(order / (order + 1.0)),
        }
    }

    fn trial(&self, method: Tuned, dt: f64, duration: f64) -> Trial<'_> {
        let limit = FAR * self.reference.extent.max(f64::MIN_POSITIVE);
        Trial { problem: self.problem, method, dt, duration, limit }
    }

    fn point(&self, method: Method, tuning: Tuning, dt: f64) -> Outcome<Point> {
        let trial = self.trial(Tuned { method, tuning }, dt, self.problem.duration);
        let outturn = trial.watched()?;
        let rounding = match outturn.blew_up_at {
            None => apart(&outturn.places, &trial.nudged()?.places).0,
            Some(_) => 0.0,
        };
        let (error, compared, unmatched) = apart(&outturn.places, &self.reference.places);
        let steps = (self.problem.duration / dt).max(outturn.effort.accepted as f64);
        let floor = rounding.max(walk(self.reference.extent, steps)).max(self.reference.error);
        let trend = outturn.track.trend();
        Ok(Point {
            dt,
            tolerance: None,
            error: (outturn.blew_up_at.is_none() && compared > 0).then_some(error),
            floor,
            is_floor: error < CLEAR * floor,
            is_fitted: false,
            evaluations: outturn.effort.evaluations,
            products: outturn.effort.iterations,
            compared,
            unmatched,
            hits: outturn.hits,
            born: outturn.born,
            capped: outturn.effort.capped,
            blew_up_at: outturn.blew_up_at,
            energy_worst: outturn.track.worst / self.reference.energy,
            energy_trend: self.share(trend),
        })
    }

    fn energy(&self, method: Tuned) -> Outcome<Energy> {
        let outturn = self.trial(method, self.problem.usual(), self.problem.long).watched()?;
        let Outturn { effort, track, blew_up_at, .. } = outturn;
        let scale = self.reference.energy;
        let work = effort.evaluations + effort.iterations;
        Ok(Energy {
            worst: track.worst / scale,
            trend: self.share(track.trend()),
            work_per_second: work as f64 / blew_up_at.unwrap_or(self.problem.long),
            blew_up_at,
            curve: track.curve.iter().map(|[t, error]| [*t, error / scale]).collect(),
        })
    }

    fn share(&self, Trend { per_second, swing }: Trend) -> Trend {
        Trend { per_second: per_second / self.reference.energy, swing: swing / self.reference.energy }
    }
}

/// Once errors are rounding, those of shorter steps are.
fn spread_floor(points: &mut [Point], extent: f64) {
    let is_small = |point: &Point| point.error.is_some_and(|error| error < SMALL * extent);
    if let Some(first) = points.iter().position(|point| point.is_floor && is_small(point)) {
        points[first..].iter_mut().for_each(|point| point.is_floor = true);
    }
}

/// The power of the step, or of the tolerance, that errors go with: the slope through the points of the shortest steps
/// whose errors are clear of rounding, and smaller than the motion itself.
fn fit(points: &mut [Point], extent: f64) -> Option<f64> {
    let is_clear = |point: &Point| !point.is_floor && point.error.is_some_and(|error| error < 0.3 * extent);
    let mut clear: Vec<_> = points.iter_mut().filter(|point| is_clear(point)).collect();
    let first =
        clear.len().saturating_sub(if clear[..].first()?.tolerance.is_some() { TOLERANCES.len() } else { FITTED });
    let fitted = &mut clear[first..];
    if fitted.len() < 2 {
        return None;
    }
    fitted.iter_mut().for_each(|point| point.is_fitted = true);
    let x = |point: &Point| point.tolerance.map_or(point.dt, f64::from);
    growth(&fitted.iter().filter_map(|point| Some((x(point), point.error?))).collect::<Vec<_>>())
}
