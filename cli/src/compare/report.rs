//! A comparison, told at a terminal or on a page.

use super::chart::charts;
use super::study::{Case, Contestant, Crossover, Study, Subject, names, series, workloads};
use super::workload::Workload;
use super::{rays, stopwatch, verify};
use crate::outcome::Outcome;
use crate::report::Report;
use crate::report::table::{Cell, Table};
use crate::report::words::{counted, digits, ratio, thousands};

/// Tells all of it: at a terminal what to use comes last, where one looks first.
pub(crate) fn tell(study: &Study, detail: bool, report: &mut dyn Report) -> Outcome {
    if report.is_page() {
        summary(study, report);
        advice(study, report);
    }
    let charts = charts(study);
    for (of, cases) in series(&study.cases) {
        if report.is_page() {
            report.heading(2, &format!("Measurements: {of}"));
        }
        for case in &cases {
            overview(case, report);
            if detail {
                details(case, report);
            }
        }
        growth(study, of, &cases, report);
        crossovers(study, of, report);
        report.charts(&charts.iter().filter(|chart| chart.of == of).collect::<Vec<_>>())?;
        if let Some(largest) = cases.last().filter(|_| report.is_page() && !detail) {
            details(largest, report);
        }
    }
    if report.is_page() {
        method(study, report);
    } else {
        advice(study, report);
    }
    Ok(())
}

fn summary(study: &Study, report: &mut dyn Report) {
    let mut facts = vec![("Compared", names(&study.cases).join(", "))];
    for (of, cases) in series(&study.cases) {
        let sizes: Vec<_> = cases.iter().map(|case| thousands(case.n)).collect();
        let about = cases.last().map_or("", |case| case.about.as_str());
        facts.push((of, format!("{about}; {} {}", sizes.join(", "), study.subject().things())));
    }
    report.facts(&facts);
}

fn advice(study: &Study, report: &mut dyn Report) {
    if report.is_page() {
        report.heading(2, "What to use");
    }
    for (of, cases) in series(&study.cases) {
        let Some(largest) = cases.last() else { continue };
        report.heading(3, &format!("Advice for {of}, {} {}", thousands(largest.n), largest.subject.things()));
        let of = study.advice.iter().filter(|advice| advice.of == of);
        let items: Vec<_> =
            of.map(|advice| (advice.workload.map_or("all round", Workload::name), advice.text.as_str())).collect();
        report.items(&items);
    }
    report.items(&study.notes.iter().map(|note| ("note", note.as_str())).collect::<Vec<_>>());
}

/// The number of points, the radius and its neighbours; or the number of triangles, and of segments.
fn heading(case: &Case) -> String {
    let (of, n, radius) = (&case.of, thousands(case.n), digits(f64::from(case.radius)));
    match case.subject {
        Subject::Points => {
            let neighbours = digits(case.neighbours.unwrap_or_default());
            format!("{of}, {n} points: radius {radius}, {neighbours} others within it on average")
        }
        Subject::Mesh => {
            let queries = thousands(case.queries.unwrap_or_default());
            format!("{of}, {n} triangles: {queries} segments of every kind, balls of radius {radius}")
        }
    }
}

fn overview(case: &Case, report: &mut dyn Report) {
    report.heading(3, &heading(case));
    report.paragraph(&case.about);
    report.paragraph(&case.verified);
    let (rounds, units) = (counted(case.rounds, "round"), case.subject.units());
    let mark = "* marks the best and what cannot be told apart from it";
    report.paragraph(&format!("medians of {rounds} in {units}, and times the best; {mark}"));
    let all: Vec<_> = case.contestants.iter().filter(|one| !one.figures.is_empty()).collect();
    let mut table = Table::default();
    table.column("", all.iter().map(|one| one.name.as_str()));
    for workload in case.workloads() {
        let cell = |one: &&Contestant| {
            let figure = one.figure(workload)?;
            Some(Cell::with(digits(figure.median), ratio(figure.ratio)).best(figure.ties))
        };
        table.column(workload.name(), all.iter().map(cell));
    }
    let spread = |one: &Contestant| one.figures.iter().fold(0.0f64, |most, figure| most.max(figure.spread));
    let bytes = |one: &&Contestant| one.build.bytes_each.map(|bytes| format!("{bytes:.0}"));
    let each = if report.is_page() { format!("bytes a {}", case.subject.thing()) } else { "bytes".into() };
    table.column(each, all.iter().map(bytes));
    table.column("spread", all.iter().map(|one| percent(spread(one))));
    let count = |count: Option<usize>| count.map(thousands);
    table.column("nodes", all.iter().map(|one| count(one.build.nodes)));
    table.column("depth", all.iter().map(|one| count(one.build.depth)));
    table.column("fullest", all.iter().map(|one| count(one.build.fullest)));
    table.column("crowded", all.iter().map(|one| count(one.build.crowded)));
    report.table(&table);
    report.list(&remarks(case));
    if case.subject == Subject::Mesh {
        work(case, report);
    }
}

/// Remarks on what somebody did not do, and on who finds other first hits than ours, and how often.
fn remarks(case: &Case) -> Vec<String> {
    let left_out = |one: &Contestant| one.left_out.as_ref().map(|why| format!("{} left out: {why}", one.name));
    let queries = case.queries.unwrap_or_default();
    let unlike = |one: &Contestant| {
        let asked = queries * one.figures.iter().filter(|figure| figure.workload.is_query()).count();
        let (unlike, asked) = (thousands(one.mismatches?), thousands(asked));
        Some(format!("{}: {unlike} of {asked} first hits differ from ours by more than rounding", one.name))
    };
    let all = || case.contestants.iter();
    all().filter_map(left_out).chain(all().filter_map(unlike)).collect()
}

/// The boxes and triangles that every query looked at.
fn work(case: &Case, report: &mut dyn Report) {
    report.paragraph(
        "boxes looked at (nodes, cells; by brute force the triangles' own) and triangles tested (those whose box is met), for each query; \
         counted, so the same on every machine",
    );
    let all: Vec<_> = case.contestants.iter().filter(|one| one.build.nodes.is_some()).collect();
    let mut table = Table::default();
    table.column("", all.iter().map(|one| one.name.as_str()));
    for workload in case.workloads().into_iter().filter(|workload| workload.is_query()) {
        let cell = |one: &&Contestant| {
            let figure = one.figure(workload)?;
            Some(Cell::with(digits(figure.visits?), digits(figure.tests?)))
        };
        table.column(workload.name(), all.iter().map(cell));
    }
    report.table(&table);
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

fn details(case: &Case, report: &mut dyn Report) {
    report.heading(3, &format!("In detail: {}, {} {}", case.of, thousands(case.n), case.subject.things()));
    let each = match case.subject {
        Subject::Points => ["nodes/pt", "tests/pt", "found/pt"],
        Subject::Mesh => ["boxes/q", "tests/q", "hits/q"],
    };
    for workload in case.workloads() {
        report.items(&[(workload.name(), workload.describe())]);
        let ranking = case.ranking(workload);
        let figures = || ranking.iter().map(|(_, figure)| figure);
        let mut table = Table::default();
        table.column("", ranking.iter().map(|(one, _)| one.name.as_str()));
        table.column("median ns", figures().map(|figure| digits(figure.median)));
        table.column("minimum", figures().map(|figure| digits(figure.min)));
        table.column("spread", figures().map(|figure| percent(figure.spread)));
        table.column("x best", figures().map(|figure| ratio(figure.ratio)));
        table.column(each[0], figures().map(|figure| figure.visits.map(digits)));
        table.column(each[1], figures().map(|figure| figure.tests.map(digits)));
        table.column(each[2], figures().map(|figure| figure.found.map(digits)));
        report.table(&table);
    }
    let (query, visits, tests) = (case.subject.query(), case.subject.visits(), case.subject.tests());
    report.paragraph(&format!(
        "all of it for each {query}; {visits}, {tests} and finds are counted, not timed: the same on every machine"
    ));
}

fn growth(study: &Study, of: &str, cases: &[&Case], report: &mut dyn Report) {
    let growths: Vec<_> = study.growth.iter().filter(|growth| growth.of == of).collect();
    let (Some(first), Some(last), false) = (cases.first(), cases.last(), growths.is_empty()) else { return };
    let what = match last.subject {
        Subject::Points => "time",
        Subject::Mesh => "time of the build, and of a query,",
    };
    let (from, to, things) = (thousands(first.n), thousands(last.n), last.subject.things());
    report.heading(3, &format!("{of}: {what} grows from {from} to {to} {things} with this power of their number"));
    let mut rows = names(cases.iter().copied());
    rows.retain(|name| growths.iter().any(|growth| growth.name == *name));
    let mut table = Table::default();
    table.column("", rows.iter().copied());
    for workload in workloads(cases.iter().copied()) {
        let cell = |row: &&str| {
            let growth = growths.iter().find(|growth| growth.name == *row && growth.workload == workload);
            growth.map(|growth| format!("{:.2}", growth.exponent))
        };
        table.column(workload.name(), rows.iter().map(cell));
    }
    report.table(&table);
    report.paragraph("1 is linear; n log n looks like 1.1 here, all pairs like 2");
}

/// Sentences on who overtakes whom; at a terminal only where the lead changes.
fn crossovers(study: &Study, of: &str, report: &mut dyn Report) {
    let is_told = |crossover: &&Crossover| crossover.of == of && (crossover.leads || report.is_page());
    let told: Vec<_> = study.crossovers.iter().filter(is_told).collect();
    if told.is_empty() {
        return;
    }
    report.heading(3, if report.is_page() { "Where one overtakes another" } else { "The lead changes" });
    let mut sentences: Vec<String> = Vec::new();
    for (i, first) in told.iter().enumerate() {
        let is_like = |other: &&&Crossover| other.workload == first.workload && other.winner == first.winner;
        if told[..i].iter().all(|other| !is_like(&other)) {
            let losers = told.iter().filter(is_like).map(|other| format!("{} at about {}", other.loser, other.size()));
            let (losers, things) = (losers.collect::<Vec<_>>().join(", "), study.subject().things());
            sentences.push(format!("{}: {} overtakes {losers} {things}", first.workload.name(), first.winner));
        }
    }
    report.list(&sentences);
}

impl Crossover {
    /// The number of points or triangles, with two digits: between two sizes the lines are not known better.
    pub(crate) fn size(&self) -> String {
        let digits = 10f64.powf(self.at.log10().floor() - 1.0).max(1.0);
        thousands(((self.at / digits).round() * digits) as usize)
    }
}

fn method(study: &Study, report: &mut dyn Report) {
    report.heading(2, "How it was measured");
    let work = workloads(&study.cases);
    report.items(&work.iter().map(|workload| (workload.name(), workload.describe())).collect::<Vec<_>>());
    let paragraphs = match study.subject() {
        Subject::Points => of_points(study),
        Subject::Mesh => rays::method(),
    };
    paragraphs.iter().for_each(|paragraph| report.paragraph(paragraph));
    report.paragraph(&format!(
        "Everything runs on one core. Times are {}; the spread is the range of the middle half of the samples over their median. Two medians are told \
         apart where they differ by more than 3 % and by more than two standard errors. Powers are slopes of log time \
         against log number, by least squares. All randomness comes from the seed {}.",
        stopwatch::SHOWS,
        study.seed
    ));
}

/// The method by which points are compared.
fn of_points(study: &Study) -> Vec<String> {
    let (most, sample, k) = (thousands(verify::EXHAUSTIVE), verify::SAMPLE, study.k);
    let (totals, distances) = (verify::TOTALS, verify::DISTANCES);
    vec![
        format!(
            "Verification comes first: who gives a wrong answer ends the comparison. Counts, neighbours, pairs and the \
             distances of the {k} nearest of every row have to be the same from all structures, to the last bit, and \
             the same as those of an exhaustive search: of all rows up to {most} points, of {sample} random rows \
             beyond. Other libraries round in their own way, so their totals may differ by {totals} and their \
             distances by {distances} of the value."
        ),
        "Everybody takes a turn in every round, another one first each time, so that what else the machine does hits \
         all alike. A turn builds, asks, moves all points by up to 5 % of the radius along every axis, refits and \
         counts. Who would compute very many distances is left out, and the table says so."
            .into(),
        "Structures answer for all rows in one call, which shares work between rows that are near each other. Other \
         libraries are asked row by row in the order of the points, or in the best way they have for all rows."
            .into(),
        "Of what was built, nodes are nodes or cells, depth is the levels below the root, fullest the most points in a \
         leaf or cell, and crowded the leaves left larger than they should be, or how many times cells were doubled, \
         for want of memory. Bytes are all that the structure uses, its copy of the points included."
            .into(),
    ]
}
