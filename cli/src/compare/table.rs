//! A comparison for those who sit at a terminal.

use super::study::{Case, Study, names, series, workloads};
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

/// Of what radius, how many neighbours, and how it was verified.
pub(crate) fn heading(case: &Case) -> String {
    let (n, radius, neighbours) = (thousands(case.n), digits(f64::from(case.radius)), digits(case.neighbours));
    format!("{}, {n} points: radius {radius}, {neighbours} others within it on average", case.points)
}

fn overview(text: &mut String, case: &Case) {
    say(text, &heading(case));
    paragraph(text, " ", &case.about);
    paragraph(text, " ", &case.verified);
    let rounds = counted(case.rounds, "round");
    let mark = "* marks the best and what cannot be told apart from it";
    say(text, &format!("  medians of {rounds} in ns a point, and times the best; {mark}"));
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
        let bytes = one.build.bytes_per_point.map_or("-".into(), |bytes| format!("{bytes:.0}"));
        let spread = one.figures.iter().fold(0.0f64, |most, figure| most.max(figure.spread));
        say(text, &format!("{row} {bytes:>6} {:>4.0} %", spread * 100.0));
    }
    for one in &case.contestants {
        if let Some(why) = &one.left_out {
            say(text, &format!("  {:<10}  left out: {why}", one.name));
        }
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
    let head = ["median ns", "min", "spread", "x best", "nodes/pt", "tests/pt", "found/pt"];
    let mut line = format!("  {:<10}", "");
    head.iter().for_each(|name| line.push_str(&format!(" {name:>10}")));
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
    for (points, cases) in series(&study.cases) {
        let of: Vec<_> = study.growth.iter().filter(|growth| growth.points == points).collect();
        let (Some(first), Some(last)) = (cases.first(), cases.last()) else { continue };
        if of.is_empty() {
            continue;
        }
        let (from, to) = (thousands(first.n), thousands(last.n));
        say(text, &format!("{points}: time grows from {from} to {to} points with this power of their number"));
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
            say(text, &format!("  {}", crossover.text()));
        }
        say(text, "");
    }
}

impl super::study::Crossover {
    /// In words.
    pub(crate) fn text(&self) -> String {
        let Self { points, workload, winner, loser, .. } = self;
        format!("{points}, {}: {winner} overtakes {loser} at about {} points", workload.name(), self.size())
    }

    /// The number of points, with two digits: between two sizes the lines are not known better.
    pub(crate) fn size(&self) -> String {
        let digits = 10f64.powf(self.at.log10().floor() - 1.0).max(1.0);
        thousands(((self.at / digits).round() * digits) as usize)
    }
}

fn advice(text: &mut String, study: &Study) {
    for (points, cases) in series(&study.cases) {
        let Some(largest) = cases.last() else { continue };
        say(text, &format!("Advice for {points}, {} points", thousands(largest.n)));
        for advice in study.advice.iter().filter(|advice| advice.points == points) {
            let what = advice.workload.map_or("all round", Workload::name);
            paragraph(text, &format!("  {what}:"), &advice.text);
        }
        say(text, "");
    }
}
