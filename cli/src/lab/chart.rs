//! Charts: errors against steps, work and tolerances on paper of two logarithmic scales, and energy over time.

use super::study::{Case, Point, Row, Steps, Study};
use crate::report::plot::{Axis, Chart, Line, look};

/// The name of the line of floors.
const ROUNDING: &str = "rounding";

/// All charts, in the order in which they should be looked at.
pub(crate) fn charts(study: &Study) -> Vec<Chart<'_>> {
    let mut looks: Vec<&str> = vec![ROUNDING];
    for row in study.cases.iter().flat_map(|case| &case.rows) {
        if !looks.contains(&row.name.as_str()) {
            looks.push(&row.name);
        }
    }
    study.cases.iter().flat_map(|case| of_case(case, &looks)).collect()
}

fn of_case<'a>(case: &'a Case, looks: &[&'a str]) -> Vec<Chart<'a>> {
    let titled = |what: &str| format!("{}: {what}", case.problem);
    let chart = |what: &str, lines: Vec<Line<'a>>, axes| Chart::of_lines(&case.problem, titled(what), lines, axes);
    let error = || Axis::log("error [m]");
    let mut by_step = lines(case, looks, |row| row.steps != Steps::Tolerance, |point| point.dt);
    by_step.extend(rounding(case));
    let by_work = lines(case, looks, |row| row.steps != Steps::Own, |point| point.work() as f64);
    let by_tolerance =
        lines(case, looks, |row| row.steps == Steps::Tolerance, |point| point.tolerance.map_or(0.0, f64::from));
    let mut charts = vec![
        chart("error against the step", by_step, [Axis::log("step [s]"), error()]),
        chart("error against work", by_work, [Axis::log("evaluations of all forces"), error()]),
        chart(
            "error of energy over time",
            energies(case, looks),
            [Axis::linear("time [s]"), Axis::log("error, a share")],
        ),
    ];
    if !by_tolerance.is_empty() {
        charts.push(chart("error against the tolerance", by_tolerance, [Axis::log("tolerance [m]"), error()]));
    }
    charts
}

/// A line for each of some rows, errors against something; those of solutions that are no solutions are left out.
fn lines<'a>(case: &'a Case, looks: &[&str], of: fn(&Row) -> bool, x: fn(&Point) -> f64) -> Vec<Line<'a>> {
    let mut lines = Vec::new();
    for row in case.rows.iter().filter(|row| of(row)) {
        let dots = row.points.iter().filter_map(|point| Some((x(point), point.error?)));
        let dots = dots.filter(|(x, y)| *x > 0.0 && *y > 0.0 && *y < 10.0 * case.extent).collect();
        push(&mut lines, &row.name, looks, dots);
    }
    lines
}

fn push<'a>(lines: &mut Vec<Line<'a>>, name: &'a str, looks: &[&str], dots: Vec<(f64, f64)>) {
    if !dots.is_empty() {
        lines.push(Line::new(name, look(looks, name), dots));
    }
}

/// The share of errors that rounding may be: in the middle of all methods, by step.
fn rounding(case: &Case) -> Option<Line<'static>> {
    let fixed = || case.rows.iter().filter(|row| row.steps == Steps::Fixed);
    let at = |i: usize| {
        let mut floors: Vec<_> = fixed().filter_map(|row| row.points.get(i)).map(|point| point.floor).collect();
        floors.retain(|floor| *floor > 0.0 && *floor < case.extent);
        floors.sort_by(f64::total_cmp);
        floors.get(floors.len() / 2).copied()
    };
    let points = &fixed().next()?.points;
    let dots: Vec<_> = points.iter().enumerate().filter_map(|(i, point)| Some((point.dt, at(i)?))).collect();
    (!dots.is_empty()).then(|| Line::new(ROUNDING, 0, dots))
}

fn energies<'a>(case: &'a Case, looks: &[&str]) -> Vec<Line<'a>> {
    let mut lines = Vec::new();
    for row in &case.rows {
        let curve = row.energy.iter().flat_map(|energy| &energy.curve);
        let dots = curve.map(|[t, error]| (*t, *error)).filter(|(_, error)| (1e-9..10.0).contains(error)).collect();
        push(&mut lines, &row.name, looks, dots);
    }
    lines
}
