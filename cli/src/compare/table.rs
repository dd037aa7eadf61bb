//! A comparison for those who sit at a terminal.

use super::study::{Case, Contestant, Study, Subject, names, series, workloads};
use super::workload::Workload;
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
    say(text, &heading(case));
    paragraph(text, " ", &case.about);
    paragraph(text, " ", &case.verified);
    let rounds = counted(case.rounds, "round");
    let mark = "* marks the best and what cannot be told apart from it";
    let units = case.subject.units();
    say(text, &format!("  medians of {rounds} in {units}, and times the best; {mark}"));
    let workloads = case.workloads();
    let mut head = format!("  {:<10}", "");
    workloads.iter().for_each(|workload| head.push_str(&format!(" {:>11}", workload.name())));
    head.push_str("  bytes spread");
    say(text, &head);
    for one in case.contestants.iter().filter(|one| !one.figures.is_empty()) {
        let mut row = format!("  {:<10}", one.name);
        for &workload in &workloads {
            let cell = one.figure(workload).map_or("-".to_string(), |figure| {
                let mark = if figure.ties { '*' } else { ' ' };
                format!("{} {:>4}{mark}", digits(figure.median), ratio(figure.ratio))
            });
            row.push_str(&format!(" {cell:>11}"));
        }
        let bytes = one.build.bytes_each.map_or("-".into(), |bytes| format!("{bytes:.0}"));
        let spread = one.figures.iter().fold(0.0f64, |most, figure| most.max(figure.spread));
        say(text, &format!("{row} {bytes:>6} {:>4.0} %", spread * 100.0));
    }
    for one in &case.contestants {
        if let Some(why) = &one.left_out {
            say(text, &format!("  {:<10}  left out: {why}", one.name));
        }
    }
    unlike(case).iter().for_each(|line| say(text, &format!("  {line}")));
    say(text, "");
    if case.subject == Subject::Mesh {
        work(text, case);
    }
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
    let queries: Vec<_> = case.workloads().into_iter().filter(|workload| workload.is_query()).collect();
    say(text, "  nodes visited and triangles tested, for each query; counted, so the same on every machine");
    let mut head = format!("  {:<10}", "");
    queries.iter().for_each(|workload| head.push_str(&format!(" {:>13}", workload.name())));
    say(text, &format!("{head} {:>9} {:>6} {:>8}", "nodes", "depth", "fullest"));
    for one in case.contestants.iter().filter(|one| one.build.nodes.is_some()) {
        let mut row = format!("  {:<10}", one.name);
        for &workload in &queries {
            let counters = one.figure(workload).and_then(|figure| figure.visits.zip(figure.tests));
            let cell =
                counters.map_or("-".into(), |(visits, tests)| format!("{} {:>6}", digits(visits), digits(tests)));
            row.push_str(&format!(" {cell:>13}"));
        }
        let [nodes, depth, fullest] =
            [one.build.nodes, one.build.depth, one.build.fullest].map(|count| count.map_or("-".into(), thousands));
        say(text, &format!("{row} {nodes:>9} {depth:>6} {fullest:>8}"));
    }
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
    say(text, &format!("  {}: {}", workload.name(), workload.describe()));
    let each = match case.subject {
        Subject::Points => ["nodes/pt", "tests/pt", "found/pt"],
        Subject::Mesh => ["nodes/q", "tests/q", "hits/q"],
    };
    let mut line = format!("  {:<10}", "");
    ["median ns", "min", "spread", "x best"]
        .iter()
        .chain(&each)
        .for_each(|name| line.push_str(&format!(" {name:>10}")));
    say(text, &line);
    for (one, figure) in case.ranking(workload) {
        let counter = |counter: Option<f64>| counter.map_or("-".into(), digits);
        let cells = [
            digits(figure.median),
            digits(figure.min),
            format!("{:.0} %", figure.spread * 100.0),
            ratio(figure.ratio),
            counter(figure.visits),
            counter(figure.tests),
            counter(figure.found),
        ];
        let mut line = format!("  {:<10}", one.name);
        cells.iter().for_each(|cell| line.push_str(&format!(" {cell:>10}")));
        say(text, &line);
    }
    say(text, "");
}

fn growth(text: &mut String, study: &Study) {
    let subject = study.subject();
    let what = match subject {
        Subject::Points => "time",
        Subject::Mesh => "time of the build, and of a query,",
    };
    for (title, cases) in series(&study.cases) {
        let of: Vec<_> = study.growth.iter().filter(|growth| growth.of == title).collect();
        let (Some(first), Some(last)) = (cases.first(), cases.last()) else { continue };
        if of.is_empty() {
            continue;
        }
        let (from, to) = (thousands(first.n), thousands(last.n));
        let things = subject.things();
        say(text, &format!("{title}: {what} grows from {from} to {to} {things} with this power of their number"));
        let workloads = workloads(cases.iter().copied());
        let mut head = format!("  {:<10}", "");
        workloads.iter().for_each(|workload| head.push_str(&format!(" {:>8}", workload.name())));
        say(text, &head);
        let grows = |name: &&str| of.iter().any(|growth| growth.name == *name);
        for name in names(cases.iter().copied()).into_iter().filter(grows) {
            let mut row = format!("  {name:<10}");
            for workload in &workloads {
                let growth = of.iter().find(|growth| growth.name == name && growth.workload == *workload);
                row.push_str(&format!(" {:>8}", growth.map_or("-".into(), |growth| format!("{:.2}", growth.exponent))));
            }
            say(text, &row);
        }
        say(text, "");
    }
}

fn crossovers(text: &mut String, study: &Study) {
    let leading: Vec<_> = study.crossovers.iter().filter(|crossover| crossover.leads).collect();
    if !leading.is_empty() {
        say(text, "The lead changes");
        for crossover in &leading {
            say(text, &format!("  {}", crossover.text(study.subject())));
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
    for (title, cases) in series(&study.cases) {
        let Some(largest) = cases.last() else { continue };
        say(text, &format!("Advice for {title}, {} {}", thousands(largest.n), largest.subject.things()));
        for advice in study.advice.iter().filter(|advice| advice.of == title) {
            let what = advice.workload.map_or("all round", Workload::name);
            paragraph(text, &format!("  {what}:"), &advice.text);
        }
        say(text, "");
    }
}
