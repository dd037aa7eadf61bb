//! The laboratory's findings, told at a terminal or on a page.

use super::chart::charts;
use super::remark::step;
use super::study::{Case, Point, Row, Steps, Study};
use crate::outcome::Outcome;
use crate::report::Report;
use crate::report::table::{Cell, Table};
use crate::report::words::short;

/// The number of steps' errors that a row has room for.
const COLUMNS: usize = 5;

const ORDER: &str = "the power of the step that errors go with, fitted to the three shortest steps whose errors are \
    clear of rounding (theory in brackets)";
const FITTED: &str = "an error that the order is fitted to";
const ROUNDING: &str = "an error that may be rounding, by a random walk of its steps or as far as moving the start by the \
    last bit of its coordinates tells, or the reference's own; left out of the fit";
const WORK: &str = "evaluations of all forces, and products with their Jacobian, for each second of the energy's run";
const FIXED: &str = "adaptive and embedded choose inner steps, so that their tolerance and not dt says how large errors \
    are; with an infinite tolerance, fixed, they take every step as it comes";

/// Explanations of the charts.
const CHARTS: [(&str, &str); 4] = [
    (
        "Error against the step",
        "A method of order p is a line of slope p. Lines end to the right where the method is no longer stable, and \
         turn up to the left where more steps only bring more rounding: the engine computes in single precision.",
    ),
    (
        "Error against work",
        "What counts in the end: for an error that will do, take the line that is the farthest to the left there.",
    ),
    (
        "Energy over time",
        "The largest error in each of sixty parts of the time. Methods that are symplectic (symplectic Euler, \
         Verlet) swing but do not drift, so their lines stay level, if not low; explicit Euler's climbs, implicit Euler's \
         as well, since it damps. Where forces dissipate, what the ledger says they took is no error.",
    ),
    ("Rounding", "How far two solutions come apart that differ by the last bit of the starting coordinates."),
];

/// Tells all of it.
pub(crate) fn tell(study: &Study, detail: bool, report: &mut dyn Report) -> Outcome {
    if report.is_page() {
        report.paragraph("every figure is the same on each run");
    }
    let charts = charts(study);
    for case in &study.cases {
        report.heading(2, &format!("{}: {}", case.problem, case.about));
        let duration = short(case.duration);
        let errors = format!("errors [m]: places after {duration} s, root mean square, against {}", case.reference);
        report.paragraph(&errors);
        by_step(case, detail || report.is_page(), report);
        energies(case, report);
        by_tolerance(case, report);
        report.items(&case.notes.iter().map(|note| ("note", note.as_str())).collect::<Vec<_>>());
        report.charts(&charts.iter().filter(|chart| chart.of == case.problem).collect::<Vec<_>>())?;
    }
    report.heading(2, "How to read it");
    let has_own = study.cases.iter().flat_map(|case| &case.rows).any(|row| row.steps == Steps::Own);
    let signs = [("order", ORDER), ("*", FITTED), ("~", ROUNDING), ("work/s", WORK)];
    report.items(&signs.into_iter().chain(has_own.then_some(("fixed", FIXED))).collect::<Vec<_>>());
    if report.is_page() {
        report.heading(2, "What is to be seen");
        report.items(&CHARTS);
    }
    Ok(())
}

/// An error in so few letters.
fn error(point: &Point) -> Cell {
    let text = match (point.error, point.blew_up_at) {
        (_, Some(_)) => "blew up".into(),
        (None, _) => return Cell::default(),
        (Some(0.0), _) => "~0".into(),
        (Some(error), _) => format!("{}{error:.1e}", if point.is_floor { "~" } else { "" }),
    };
    Cell::from(text).best(point.is_fitted)
}

/// An order with its theory.
fn order(row: &Row) -> Option<String> {
    let order = row.order.map_or("-".into(), |order| format!("{order:.2}"));
    row.expected.map(|expected| format!("{order} ({expected})"))
}

/// Which of `n` columns there is room for.
fn chosen(n: usize, all: bool) -> Vec<usize> {
    if all || n <= COLUMNS {
        return (0..n).collect();
    }
    (0..COLUMNS).map(|i| i * (n - 1) / (COLUMNS - 1)).collect()
}

fn by_step(case: &Case, all: bool, report: &mut dyn Report) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps != Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    let mut table = Table::default();
    table.column("by step [s]", rows.iter().map(|row| row.name.as_str()));
    table.column("order", rows.iter().map(|row| order(row)));
    for i in chosen(first.points.len(), all) {
        table.column(step(first.points[i].dt), rows.iter().map(|row| error(&row.points[i])));
    }
    report.table(&table);
}

fn energies(case: &Case, report: &mut dyn Report) {
    let (long, dt) = (short(case.energy_duration), step(case.energy_dt));
    report
        .paragraph(&format!("energy: error over {long} s in steps of {dt} s, as a share of {}", case.energy_scale_is));
    let rows: Vec<_> = case.rows.iter().filter_map(|row| Some((row, row.energy.as_ref()?))).collect();
    let mut table = Table::default();
    table.column("energy", rows.iter().map(|(row, _)| row.name.as_str()));
    table.column("work/s", rows.iter().map(|(_, energy)| format!("{:.0}", energy.work_per_second)));
    table.column("worst", rows.iter().map(|(_, energy)| format!("{:.1e}", energy.worst)));
    table.column("drift/s", rows.iter().map(|(_, energy)| format!("{:+.0e}", energy.trend.per_second)));
    table.words("", rows.iter().map(|(row, _)| row.remark.as_str()));
    report.table(&table);
}

/// Errors by tolerance, and the work that each takes.
fn by_tolerance(case: &Case, report: &mut dyn Report) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps == Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    report
        .paragraph(&format!("by tolerance [m], in steps of {} s; below each error its work", step(first.points[0].dt)));
    let mut table = Table::default();
    table.column("by tolerance [m]", rows.iter().flat_map(|row| [Cell::from(row.name.as_str()), "  work".into()]));
    table.column("power", rows.iter().flat_map(|row| [order(row).into(), Cell::from("")]));
    for (i, tolerance) in first.points.iter().enumerate().filter_map(|(i, point)| Some((i, point.tolerance?))) {
        let cells = |row: &&Row| [error(&row.points[i]), row.points[i].work().to_string().into()];
        table.column(format!("{tolerance:.0e}"), rows.iter().flat_map(cells));
    }
    report.table(&table);
}
