//! The laboratory's findings as a table for other programs: one row a solution, units in the head.

use super::study::{Case, Point, Row, Study};
use crate::Outcome;
use crate::formats::sheet;
use serde::Serialize;

#[derive(Serialize)]
struct Line<'a> {
    problem: &'a str,
    integrator: &'a str,
    steps: super::study::Steps,
    dt_s: f64,
    tolerance_m: Option<f32>,
    error_m: Option<f64>,
    floor_m: f64,
    is_floor: bool,
    is_fitted: bool,
    order: Option<f64>,
    expected_order: Option<f64>,
    evaluations: u64,
    jacobian_products: u64,
    energy_worst: f64,
    energy_drift_per_s: f64,
    energy_swing: f64,
    compared: usize,
    unmatched: usize,
    hits: u64,
    born: u64,
    capped: u64,
    blew_up_at_s: Option<f64>,
    long_energy_worst: Option<f64>,
    long_energy_drift_per_s: Option<f64>,
    remark: &'a str,
}

/// The table.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn csv(study: &Study) -> Outcome<String> {
    let mut lines = Vec::new();
    for case in &study.cases {
        for row in &case.rows {
            lines.extend(row.points.iter().map(|point| line(case, row, point)));
        }
    }
    sheet(lines)
}

fn line<'a>(case: &'a Case, row: &'a Row, point: &Point) -> Line<'a> {
    Line {
        problem: &case.problem,
        integrator: row.integrator.name(),
        steps: row.steps,
        dt_s: point.dt,
        tolerance_m: point.tolerance,
        error_m: point.error,
        floor_m: point.floor,
        is_floor: point.is_floor,
        is_fitted: point.is_fitted,
        order: row.order,
        expected_order: row.expected,
        evaluations: point.evaluations,
        jacobian_products: point.products,
        energy_worst: point.energy_worst,
        energy_drift_per_s: point.energy_trend.per_second,
        energy_swing: point.energy_trend.swing,
        compared: point.compared,
        unmatched: point.unmatched,
        hits: point.hits,
        born: point.born,
        capped: point.capped,
        blew_up_at_s: point.blew_up_at,
        long_energy_worst: row.energy.as_ref().map(|energy| energy.worst),
        long_energy_drift_per_s: row.energy.as_ref().map(|energy| energy.trend.per_second),
        remark: &row.remark,
    }
}
