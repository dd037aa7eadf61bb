//! A comparison as a table for other programs: one row a measurement, units in the head.

use super::study::{Case, Contestant, Figure, Study};
use crate::Outcome;
use crate::formats::sheet;
use serde::Serialize;

#[derive(Serialize)]
struct Row<'a> {
    points: &'a str,
    n: usize,
    radius: f32,
    mean_neighbours: f64,
    name: &'a str,
    workload: &'a str,
    median_ns_per_point: Option<f64>,
    min_ns_per_point: Option<f64>,
    spread_iqr_per_median: Option<f64>,
    ratio_to_best: Option<f64>,
    ties_with_best: Option<bool>,
    samples: Option<usize>,
    nodes_visited_per_point: Option<f64>,
    distance_tests_per_point: Option<f64>,
    found_per_point: Option<f64>,
    nodes: Option<usize>,
    depth: Option<usize>,
    fullest_leaf: Option<usize>,
    crowded: Option<usize>,
    bytes_per_point: Option<f64>,
    samples_ns_per_point: String,
    left_out: &'a str,
}

/// The table.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn csv(study: &Study) -> Outcome<String> {
    let mut rows = Vec::new();
    for case in &study.cases {
        for one in &case.contestants {
            match one.figures.is_empty() {
                true => rows.push(row(case, one, None)),
                false => rows.extend(one.figures.iter().map(|figure| row(case, one, Some(figure)))),
            }
        }
    }
    sheet(rows)
}

fn row<'a>(case: &'a Case, one: &'a Contestant, figure: Option<&'a Figure>) -> Row<'a> {
    let samples = figure.map(|figure| figure.samples.as_slice()).unwrap_or_default();
    Row {
        points: &case.points,
        n: case.n,
        radius: case.radius,
        mean_neighbours: case.neighbours,
        name: &one.name,
        workload: figure.map_or("", |figure| figure.workload.name()),
        median_ns_per_point: figure.map(|figure| figure.median),
        min_ns_per_point: figure.map(|figure| figure.min),
        spread_iqr_per_median: figure.map(|figure| figure.spread),
        ratio_to_best: figure.map(|figure| figure.ratio),
        ties_with_best: figure.map(|figure| figure.ties),
        samples: figure.map(|figure| figure.samples.len()),
        nodes_visited_per_point: figure.and_then(|figure| figure.visits),
        distance_tests_per_point: figure.and_then(|figure| figure.tests),
        found_per_point: figure.and_then(|figure| figure.found),
        nodes: one.build.nodes,
        depth: one.build.depth,
        fullest_leaf: one.build.fullest,
        crowded: one.build.crowded,
        bytes_per_point: one.build.bytes_per_point,
        samples_ns_per_point: samples.iter().map(|sample| format!("{sample:.3}")).collect::<Vec<_>>().join(" "),
        left_out: one.left_out.as_deref().unwrap_or_default(),
    }
}
