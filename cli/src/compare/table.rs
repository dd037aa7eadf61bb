//! A comparison for those who sit at a terminal.

use super::study::{Case, Contestant, Study, Subject, names, series, workloads};
use super::workload::Workload;
use crate::grid::Grid;
use crate::words::{counted, digits, paragraph, say, thousands};

/// The whole answer.
pub(crate) fn text(study: &Study, detail: bool) -> String {
    let mut text = String::new();
    for case in &study.cases {
        overview(&mut text, case);
        if detail {
            case.workloads().into_iter().for_each(|workload| details(&mut text, case, workload));
        }
    }
    growth(&mut text, study);
    crossovers(&mut text, study);
    advice(&mut text, study);
    study.notes.iter().for_each(|note| paragraph(&mut text, "note:", note));
    text
}

/// How many points of what radius and how many neighbours; how many triangles, and asked how often.
pub(crate) fn heading(case: &Case) -> String {
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

fn overview(text: &mut String, case: &Case) {
    title(text, &heading(case));
    paragraph(text, " ", &case.about);
    paragraph(text, " ", &case.verified);
    let rounds = counted(case.rounds, "round");
    let mark = "* marks the best and what cannot be told apart from it";
    let units = case.subject.units();
    paragraph(text, " ", &format!("medians of {rounds} in {units}, and times the best; {mark}"));
    let measured = || case.contestants.iter().filter(|one| !one.figures.is_empty());
    let mut grid = Grid::of(measured().map(|one| one.name.as_str()));
    for workload in case.workloads() {
        let cell = |one: &Contestant| {
            one.figure(workload).map_or("-".to_string(), |figure| {
                let mark = if figure.ties { '*' } else { ' ' };
                format!("{} {:>4}{mark}", digits(figure.median), ratio(figure.ratio))
            })
        };
        grid.column(workload.name(), 11, measured().map(cell));
    }
    let bytes = |one: &Contestant| one.build.bytes_each.map_or("-".into(), |bytes| format!("{bytes:.0}"));
    grid.column("bytes", 6, measured().map(bytes));
    let spread = |one: &Contestant| one.figures.iter().fold(0.0f64, |most, figure| most.max(figure.spread));
    grid.column("spread", 6, measured().map(|one| format!("{:.0} %", spread(one) * 100.0)));
    grid.write(text);
    for one in &case.contestants {
        if let Some(why) = &one.left_out {
            paragraph(text, &format!("  {:<10}  left out:", one.name), why);
        }
    }
    unlike(case).iter().for_each(|line| paragraph(text, " ", line));
    say(text, "");
    if case.subject == Subject::Mesh {
        work(text, case);
    }
}

/// Words that stand over a table.
fn title(text: &mut String, words: &str) {
    let (first, rest) = words.split_once(' ').unwrap_or((words, ""));
    paragraph(text, first, rest);
}

/// Who finds other first hits than ours, and how often.
pub(crate) fn unlike(case: &Case) -> Vec<String> {
    let all = case.queries.unwrap_or_default();
    let line = |one: &Contestant| {
        let asked = all * one.figures.iter().filter(|figure| figure.workload.is_query()).count();
        let (unlike, asked) = (thousands(one.mismatches?), thousands(asked));
        Some(format!("{:<10}  {unlike} of {asked} first hits differ from ours by more than rounding", one.name))
    };
    case.contestants.iter().filter_map(line).collect()
}

/// What every query looked at, and how deep the structures are.
fn work(text: &mut String, case: &Case) {
    let about = "nodes visited and triangles tested, for each query; counted, so the same on every machine";
    paragraph(text, " ", about);
    let counted = || case.contestants.iter().filter(|one| one.build.nodes.is_some());
    let mut grid = Grid::of(counted().map(|one| one.name.as_str()));
    for workload in case.workloads().into_iter().filter(|workload| workload.is_query()) {
        let cell = |one: &Contestant| {
            let counters = one.figure(workload).and_then(|figure| figure.visits.zip(figure.tests));
            counters.map_or("-".into(), |(visits, tests)| format!("{} {:>6}", digits(visits), digits(tests)))
        };
        grid.column(workload.name(), 12, counted().map(cell));
    }
    let shown = |count: Option<usize>| count.map_or("-".into(), thousands);
    grid.column("nodes", 7, counted().map(|one| shown(one.build.nodes)));
    grid.column("depth", 7, counted().map(|one| shown(one.build.depth)));
    grid.column("fullest", 7, counted().map(|one| shown(one.build.fullest)));
    grid.write(text);
    say(text, "");
}

/// How many times the best; coarser where it is large.
pub(crate) fn ratio(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 99.5 => format!("{ratio:.0}"),
        ratio if ratio >= 9.95 => format!("{ratio:.1}"),
        _ => format!("{ratio:.2}"),
    }
}

fn details(text: &mut String, case: &Case, workload: Workload) {
    paragraph(text, &format!("  {}:", workload.name()), workload.describe());
    let each = match case.subject {
        Subject::Points => ["nodes/pt", "tests/pt", "found/pt"],
        Subject::Mesh => ["nodes/q", "tests/q", "hits/q"],
    };
    let ranking = case.ranking(workload);
    let mut grid = Grid::of(ranking.iter().map(|(one, _)| one.name.as_str()));
    let counter = |counter: Option<f64>| counter.map_or("-".into(), digits);
    let figures = || ranking.iter().map(|(_, figure)| figure);
    grid.column("median ns", 8, figures().map(|figure| digits(figure.median)));
    grid.column("min", 8, figures().map(|figure| digits(figure.min)));
    grid.column("spread", 8, figures().map(|figure| format!("{:.0} %", figure.spread * 100.0)));
    grid.column("x best", 8, figures().map(|figure| ratio(figure.ratio)));
    grid.column(each[0], 8, figures().map(|figure| counter(figure.visits)));
    grid.column(each[1], 8, figures().map(|figure| counter(figure.tests)));
    grid.column(each[2], 8, figures().map(|figure| counter(figure.found)));
    grid.write(text);
    say(text, "");
}

fn growth(text: &mut String, study: &Study) {
    let subject = study.subject();
    let what = match subject {
        Subject::Points => "time",
        Subject::Mesh => "time of the build, and of a query,",
    };
    for (name, cases) in series(&study.cases) {
        let of: Vec<_> = study.growth.iter().filter(|growth| growth.of == name).collect();
        let (Some(first), Some(last)) = (cases.first(), cases.last()) else { continue };
        if of.is_empty() {
            continue;
        }
        let (from, to) = (thousands(first.n), thousands(last.n));
        let things = subject.things();
        let about = format!("{name}: {what} grows from {from} to {to} {things} with this power of their number");
        title(text, &about);
        let grows = |one: &&str| of.iter().any(|growth| growth.name == *one);
        let rows: Vec<_> = names(cases.iter().copied()).into_iter().filter(grows).collect();
        let mut grid = Grid::of(rows.iter().copied());
        for workload in workloads(cases.iter().copied()) {
            let cell = |row: &&str| {
                let growth = of.iter().find(|growth| growth.name == *row && growth.workload == workload);
                growth.map_or("-".into(), |growth| format!("{:.2}", growth.exponent))
            };
            grid.column(workload.name(), 8, rows.iter().map(cell));
        }
        grid.write(text);
        say(text, "");
    }
}

fn crossovers(text: &mut String, study: &Study) {
    let leading: Vec<_> = study.crossovers.iter().filter(|crossover| crossover.leads).collect();
    if !leading.is_empty() {
        say(text, "The lead changes");
        for crossover in &leading {
            paragraph(text, " ", &crossover.text(study.subject()));
        }
        say(text, "");
    }
}

impl super::study::Crossover {
    /// In words.
    pub(crate) fn text(&self, subject: Subject) -> String {
        let Self { of, workload, winner, loser, .. } = self;
        let (size, things) = (self.size(), subject.things());
        format!("{of}, {}: {winner} overtakes {loser} at about {size} {things}", workload.name())
    }

    /// The number of points or triangles, with two digits: between two sizes the lines are not known better.
    pub(crate) fn size(&self) -> String {
        let digits = 10f64.powf(self.at.log10().floor() - 1.0).max(1.0);
        thousands(((self.at / digits).round() * digits) as usize)
    }
}

fn advice(text: &mut String, study: &Study) {
    for (name, cases) in series(&study.cases) {
        let Some(largest) = cases.last() else { continue };
        title(text, &format!("Advice for {name}, {} {}", thousands(largest.n), largest.subject.things()));
        for advice in study.advice.iter().filter(|advice| advice.of == name) {
            let what = advice.workload.map_or("all round", Workload::name);
            paragraph(text, &format!("  {what}:"), &advice.text);
        }
        say(text, "");
    }
}
