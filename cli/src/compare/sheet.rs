//! A comparison as a table for other programs: one row a measurement, units in the head.

use super::study::{Figure, Study, Subject};
use crate::report::table::{Cell, Table};

/// Heads that differ between what points are asked and what a mesh is.
struct Heads {
    of: &'static str,
    n: &'static str,
    queries: &'static str,
    radius: &'static str,
    times: [&'static str; 3],
    counters: [&'static str; 3],
    bytes: &'static str,
}

const OF_POINTS: Heads = Heads {
    of: "points",
    n: "n",
    queries: "mean_neighbours",
    radius: "radius",
    times: ["median_ns_per_point", "min_ns_per_point", "samples_ns_per_point"],
    counters: ["nodes_visited_per_point", "distance_tests_per_point", "found_per_point"],
    bytes: "bytes_per_point",
};

/// Times are in ns for each triangle that is built, else for each query.
const OF_A_MESH: Heads = Heads {
    of: "mesh",
    n: "triangles",
    queries: "queries",
    radius: "ball_radius",
    times: ["median_ns", "min_ns", "samples_ns"],
    counters: ["nodes_visited_per_query", "triangles_tested_per_query", "hits_per_query"],
    bytes: "bytes_per_triangle",
};

/// The table. Who was not measured has a row that says why.
pub(crate) fn sheet(study: &Study) -> Table {
    let of_mesh = study.subject() == Subject::Mesh;
    let heads = if of_mesh { OF_A_MESH } else { OF_POINTS };
    let all = study.cases.iter().flat_map(|case| case.contestants.iter().map(move |one| (case, one)));
    let rows = all.flat_map(|(case, one)| {
        let figures = one.figures.iter().map(Some).chain(one.figures.is_empty().then_some(None));
        figures.map(move |figure| (case, one, figure))
    });
    let rows: Vec<_> = rows.collect();
    let mut table = Table::default();
    let cases = || rows.iter().map(|(case, ..)| case);
    let builds = || rows.iter().map(|(_, one, _)| &one.build);
    let figures = |cell: fn(&Figure) -> Cell| rows.iter().map(move |(.., figure)| figure.map(cell));
    table.column(heads.of, cases().map(|case| case.of.as_str()));
    table.column(heads.n, cases().map(|case| case.n));
    if of_mesh {
        table.column(heads.queries, cases().map(|case| case.queries));
    }
    table.column(heads.radius, cases().map(|case| case.radius));
    if !of_mesh {
        table.column(heads.queries, cases().map(|case| case.neighbours));
    }
    table.column("name", rows.iter().map(|(_, one, _)| one.name.as_str()));
    table.column("workload", figures(|figure| figure.workload.name().into()));
    table.column(heads.times[0], figures(|figure| figure.median.into()));
    table.column(heads.times[1], figures(|figure| figure.min.into()));
    table.column("spread_iqr_per_median", figures(|figure| figure.spread.into()));
    table.column("ratio_to_best", figures(|figure| figure.ratio.into()));
    table.column("ties_with_best", figures(|figure| figure.ties.into()));
    table.column("samples", figures(|figure| figure.samples.len().into()));
    table.column(heads.counters[0], figures(|figure| figure.visits.into()));
    table.column(heads.counters[1], figures(|figure| figure.tests.into()));
    table.column(heads.counters[2], figures(|figure| figure.found.into()));
    table.column("nodes", builds().map(|build| build.nodes));
    table.column("depth", builds().map(|build| build.depth));
    table.column("fullest_leaf", builds().map(|build| build.fullest));
    table.column("crowded", builds().map(|build| build.crowded));
    table.column(heads.bytes, builds().map(|build| build.bytes_each));
    if of_mesh {
        table.column("mismatches", rows.iter().map(|(_, one, _)| one.mismatches));
    }
    table.column(heads.times[2], figures(|figure| listed(&figure.samples).into()));
    table.column("left_out", rows.iter().map(|(_, one, _)| one.left_out.as_deref()));
    table
}

fn listed(samples: &[f64]) -> String {
    samples.iter().map(|sample| format!("{sample:.3}")).collect::<Vec<_>>().join(" ")
}
