//! The laboratory's findings as a table for other programs: one row a solution, units in the head.

use super::study::{Point, Row, Study};
use crate::report::table::{Cell, Table};

/// The table.
pub(crate) fn sheet(study: &Study) -> Table {
    let all = study.cases.iter().flat_map(|case| case.rows.iter().map(move |row| (case, row)));
    let all: Vec<_> = all.flat_map(|(case, row)| row.points.iter().map(move |point| (case, row, point))).collect();
    let mut table = Table::default();
    let rows = |cell: fn(&Row) -> Cell| all.iter().map(move |(_, row, _)| cell(row));
    let points = |cell: fn(&Point) -> Cell| all.iter().map(move |(.., point)| cell(point));
    table.column("problem", all.iter().map(|(case, ..)| case.problem.as_str()));
    table.column("integrator", rows(|row| row.integrator.name().into()));
    table.column("steps", rows(|row| row.steps.name().into()));
    table.column("dt_s", points(|point| point.dt.into()));
    table.column("tolerance_m", points(|point| point.tolerance.into()));
    table.column("error_m", points(|point| point.error.into()));
    table.column("floor_m", points(|point| point.floor.into()));
    table.column("is_floor", points(|point| point.is_floor.into()));
    table.column("is_fitted", points(|point| point.is_fitted.into()));
    table.column("order", rows(|row| row.order.into()));
    table.column("expected_order", rows(|row| row.expected.into()));
    table.column("evaluations", points(|point| point.evaluations.into()));
    table.column("jacobian_products", points(|point| point.products.into()));
    table.column("energy_worst", points(|point| point.energy_worst.into()));
    table.column("energy_drift_per_s", points(|point| point.energy_trend.per_second.into()));
    table.column("energy_swing", points(|point| point.energy_trend.swing.into()));
    table.column("compared", points(|point| point.compared.into()));
    table.column("unmatched", points(|point| point.unmatched.into()));
    table.column("hits", points(|point| point.hits.into()));
    table.column("born", points(|point| point.born.into()));
    table.column("capped", points(|point| point.capped.into()));
    table.column("blew_up_at_s", points(|point| point.blew_up_at.into()));
    table.column("long_energy_worst", rows(|row| row.energy.as_ref().map(|energy| energy.worst).into()));
    table.column(
        "long_energy_drift_per_s",
        rows(|row| row.energy.as_ref().map(|energy| energy.trend.per_second).into()),
    );
    table.column("remark", rows(|row| row.remark.as_str().into()));
    table
}
