//! The meaning of the figures, in words.

use super::study::{Case, Energy, Point, Row, Steps};
use crate::report::words::{counted, digits, short};
use pointmass::Method;

/// Errors of energy below this share are rounding.
const KEPT: f64 = 2e-5;
/// So many times what rounds up and down at random may come of rounding, which for a while goes one way.
const ROUNDED: f64 = 8.0;
/// How far an order may be off its theory.
const OFF: f64 = 0.25;

/// A step as people say it: a fraction, where it is one of a whole number.
pub(crate) fn step(dt: f64) -> String {
    let inverse = 1.0 / dt;
    match inverse.round() {
        whole if whole >= 2.0 && (inverse - whole).abs() < 1e-6 * whole => format!("1/{whole:.0}"),
        _ => short(dt),
    }
}

/// The case with what there is to remark on it.
pub(crate) fn remarked(mut case: Case) -> Case {
    let remarks: Vec<_> = case.rows.iter().map(|row| of_row(row, &case)).collect();
    case.rows.iter_mut().zip(remarks).for_each(|(row, remark)| row.remark = remark);
    case.notes = case.notes();
    case
}

/// The findings that stand out in a row.
fn of_row(row: &Row, case: &Case) -> String {
    let mut words: Vec<String> = Vec::new();
    if let Some(worst) =
        row.points.iter().filter(|point| point.blew_up_at.is_some()).map(|point| point.dt).reduce(f64::min)
    {
        words.push(format!(
            "blows up at dt {}",
            if row.points[0].dt > worst { format!("≥ {}", step(worst)) } else { step(worst) }
        ));
    }
    words.extend(row.energy.as_ref().map(|energy| energy.words(case.energy_duration).to_string()));
    words.extend(of_order(row));
    if case.is_twin(row) {
        words.push("as symplectic: no Jacobian".into());
    }
    words.join("; ")
}

fn of_order(row: &Row) -> Option<String> {
    let (order, expected) = (row.order, row.expected?);
    // A line through two points says little.
    let is_sure = row.points.iter().filter(|point| point.is_fitted).count() > 2;
    let finite = || row.points.iter().filter(|point| point.error.is_some());
    match order {
        Some(order) if is_sure && order < expected - OFF => Some("falls short of its order".into()),
        Some(order) if is_sure && order > expected + OFF => Some("better than its order here".into()),
        Some(_) => None,
        None if finite().count() > 1 && finite().all(|point| point.is_floor) => {
            Some("no error clear of rounding".into())
        }
        None if finite().count() < 2 => None,
        None => Some("no two steps show its order".into()),
    }
}

impl Energy {
    /// Whether energy is kept, swings or drifts.
    fn words(&self, duration: f64) -> &'static str {
        let drift = self.trend.per_second * duration;
        match self.blew_up_at {
            Some(_) => "energy explodes",
            None if self.worst < KEPT => "energy is kept",
            None if drift == 0.0 => "energy is off",
            None if drift.abs() < 2.0 * self.trend.swing => "energy swings, no drift",
            None if drift > 0.0 => "energy drifts up",
            None => "energy drifts down",
        }
    }
}

impl Case {
    /// Whether implicit Euler did the same as symplectic Euler, which it is where forces give no Jacobian.
    fn is_twin(&self, row: &Row) -> bool {
        let symplectic = self.rows.iter().find(|other| other.integrator == Method::Symplectic);
        let is_like = |a: &Point, b: &Point| match (a.error, b.error) {
            (Some(a), Some(b)) => (a - b).abs() <= 0.01 * a,
            _ => false,
        };
        let all_like = |other: &Row| row.points.iter().zip(&other.points).all(|(a, b)| is_like(a, b));
        row.integrator == Method::Implicit && symplectic.is_some_and(all_like)
    }

    /// The remarks that a reader should know.
    fn notes(&self) -> Vec<String> {
        let points = || self.rows.iter().flat_map(|row| &row.points);
        let most = |count: fn(&Point) -> u64| points().map(count).max().unwrap_or(0);
        let mut notes = Vec::new();
        let hits = most(|point| point.hits);
        if hits > 0 {
            let hits = counted(hits as usize, "hit");
            notes.push(format!(
                "up to {hits} on colliders: a path breaks there, and no method keeps its order beyond it"
            ));
        }
        if most(|point| point.born) > 0 {
            let text = "particles are born within steps, and fly on to their ends as if their acceleration stayed the same: \
                        no method is of more than order 2 there";
            notes.push(text.into());
        }
        let unmatched = most(|point| point.unmatched as u64);
        if unmatched > 0 {
            let particles = counted(unmatched as usize, "particle");
            notes.push(format!(
                "up to {particles} live in one of both, method and reference, alone: errors are of the others"
            ));
        }
        let capped = most(|point| point.capped);
        if capped > 0 {
            notes.push(format!(
                "up to {} were taken although they err too much, or solved too coarsely",
                counted(capped as usize, "step")
            ));
        }
        notes.extend(self.about_reference());
        notes
    }

    /// Whether the reference is good enough.
    fn about_reference(&self) -> Option<String> {
        let fixed = || self.rows.iter().filter(|row| row.steps == Steps::Fixed).flat_map(|row| &row.points);
        let worst = fixed().filter_map(|point| point.error).fold(0.0f64, f64::max);
        let is_poor = self.reference_error > 0.05 * worst && worst > 0.0;
        is_poor.then(|| {
            let error = digits(self.reference_error);
            match self.reference_error <= ROUNDED * self.reference_rounding {
                true => format!(
                    "the reference itself is uncertain by {error} m, as places up to {} m are rounded in each of its steps: \
                     smaller errors are rounding",
                    digits(self.extent)
                ),
                false => format!(
                    "the reference itself is uncertain by {error} m, as the motion is chaotic or not \
                     smooth; try a shorter --duration"
                ),
            }
        })
    }
}
