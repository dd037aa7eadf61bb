//! A comparison as a table for other programs: one row a measurement, units in the head.

use super::study::{Case, Contestant, Figure, Study, Subject};
use crate::Outcome;
use crate::formats::sheet;
use serde::Serialize;

/// Of points.
#[derive(Serialize)]
struct Row<'a> {
    points: &'a str,
    n: usize,
    radius: f32,
    mean_neighbours: Option<f64>,
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
    let mut all = Vec::new();
    for case in &study.cases {
        for one in &case.contestants {
            match one.figures.is_empty() {
                true => all.push((case, one, None)),
                false => all.extend(one.figures.iter().map(|figure| (case, one, Some(figure)))),
            }
        }
    }
    match study.subject() {
        Subject::Points => sheet(all.into_iter().map(|(case, one, figure)| row(case, one, figure))),
        Subject::Mesh => sheet(all.into_iter().map(|(case, one, figure)| mesh_row(case, one, figure))),
    }
}

fn listed(figure: Option<&Figure>) -> String {
    let samples = figure.map(|figure| figure.samples.as_slice()).unwrap_or_default();
    samples.iter().map(|sample| format!("{sample:.3}")).collect::<Vec<_>>().join(" ")
}

fn row<'a>(case: &'a Case, one: &'a Contestant, figure: Option<&'a Figure>) -> Row<'a> {
    Row {
        points: &case.of,
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
        bytes_per_point: one.build.bytes_each,
        samples_ns_per_point: listed(figure),
        left_out: one.left_out.as_deref().unwrap_or_default(),
    }
}

/// Of a mesh: times are in ns for each triangle that is built, else for each query.
#[derive(Serialize)]
struct MeshRow<'a> {
    mesh: &'a str,
    triangles: usize,
    queries: Option<usize>,
    ball_radius: f32,
    name: &'a str,
    workload: &'a str,
    median_ns: Option<f64>,
    min_ns: Option<f64>,
    spread_iqr_per_median: Option<f64>,
    ratio_to_best: Option<f64>,
    ties_with_best: Option<bool>,
    samples: Option<usize>,
    nodes_visited_per_query: Option<f64>,
    triangles_tested_per_query: Option<f64>,
    hits_per_query: Option<f64>,
    nodes: Option<usize>,
    depth: Option<usize>,
    fullest_leaf: Option<usize>,
    crowded: Option<usize>,
    bytes_per_triangle: Option<f64>,
    mismatches: Option<usize>,
    samples_ns: String,
    left_out: &'a str,
}

fn mesh_row<'a>(case: &'a Case, one: &'a Contestant, figure: Option<&'a Figure>) -> MeshRow<'a> {
    MeshRow {
        mesh: &case.of,
        triangles: case.n,
        queries: case.queries,
        ball_radius: case.radius,
        name: &one.name,
        workload: figure.map_or("", |figure| figure.workload.name()),
        median_ns: figure.map(|figure| figure.median),
        min_ns: figure.map(|figure| figure.min),
        spread_iqr_per_median: figure.map(|figure| figure.spread),
        ratio_to_best: figure.map(|figure| figure.ratio),
        ties_with_best: figure.map(|figure| figure.ties),
        samples: figure.map(|figure| figure.samples.len()),
        nodes_visited_per_query: figure.and_then(|figure| figure.visits),
        triangles_tested_per_query: figure.and_then(|figure| figure.tests),
        hits_per_query: figure.and_then(|figure| figure.found),
        nodes: one.build.nodes,
        depth: one.build.depth,
        fullest_leaf: one.build.fullest,
        crowded: one.build.crowded,
        bytes_per_triangle: one.build.bytes_each,
        mismatches: one.mismatches,
        samples_ns: listed(figure),
        left_out: one.left_out.as_deref().unwrap_or_default(),
    }
}
