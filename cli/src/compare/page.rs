//! A comparison as a page that stands alone: no scripts, nothing from the network.

use super::chart::charts;
use super::study::{Case, Contestant, Crossover, Study, Subject, series, workloads};
use super::table::{heading, ratio, unlike};
use super::workload::Workload;
use super::{rays, stopwatch, study, verify};
use crate::Outcome;
use crate::page::{Page, escape};
use crate::plot::Chart;
use crate::words::{counted, digits, thousands};
use std::fmt::Write;

/// The page.
///
/// # Errors
/// If a chart cannot be drawn.
pub(crate) fn html(study: &Study) -> Outcome<String> {
    let mut page = Page::titled("Which spatial partition?");
    page.summary(study);
    page.advice(study);
    let charts = charts(study);
    for (title, cases) in series(&study.cases) {
        page.tagged("h2", &format!("Measurements: {title}"));
        for case in &cases {
            page.case(case);
        }
        page.growth(study, title, &cases);
        page.crossovers(study, title);
        page.charts(title, &charts)?;
        if let Some(largest) = cases.last() {
            page.details(largest);
        }
    }
    page.method(study);
    Ok(page.done())
}

impl Page {
    fn summary(&mut self, study: &Study) {
        let machine = &study.machine;
        let names = study::names(&study.cases).join(", ");
        self.raw("<dl>\n");
        let _ = writeln!(self.0, "<dt>Compared</dt><dd>{}</dd>", escape(&names));
        for (title, cases) in series(&study.cases) {
            let sizes: Vec<_> = cases.iter().map(|case| thousands(case.n)).collect();
            let about = cases.last().map_or("", |case| case.about.as_str());
            let text = format!("{about}; {} {}", sizes.join(", "), study.subject().things());
            let _ = writeln!(self.0, "<dt>{}</dt><dd>{}</dd>", escape(title), escape(&text));
        }
        let machine = format!("{}, {} cores (one is used), {}", machine.cpu, machine.cores, machine.os);
        let _ = writeln!(self.0, "<dt>Machine</dt><dd>{}</dd>", escape(&machine));
        let program = format!("pointmass {}, {}", study.version, study.machine.build);
        let _ = writeln!(self.0, "<dt>Program</dt><dd>{}</dd>", escape(&program));
        let _ = writeln!(self.0, "<dt>Command</dt><dd><code>{}</code></dd>", escape(&study.command));
        self.raw("</dl>\n");
    }

    fn advice(&mut self, study: &Study) {
        self.tagged("h2", "What to use");
        for (title, cases) in series(&study.cases) {
            let Some(largest) = cases.last() else { continue };
            self.tagged("h3", &format!("{title}, {} {}", thousands(largest.n), largest.subject.things()));
            let of = study.advice.iter().filter(|advice| advice.of == title);
            let items: Vec<_> = of
                .map(|advice| (advice.workload.map_or("all round", Workload::name).into(), advice.text.clone()))
                .collect();
            self.items(&items);
        }
        study.notes.iter().for_each(|note| self.tagged("p", &format!("Note: {note}.")));
    }

    fn case(&mut self, case: &Case) {
        self.tagged("h3", &heading(case));
        let (rounds, verified, units) = (counted(case.rounds, "round"), &case.verified, case.subject.units());
        let text = format!(
            "Medians of {rounds}, in {units}, and times the best; {verified}. Green: the best and what cannot be told \
             apart from it."
        );
        self.tagged("p", &text);
        let workloads = case.workloads();
        self.raw("<div class=\"wide\"><table><tr><th></th>");
        workloads.iter().for_each(|workload| self.cell("th", "", workload.name()));
        self.cell("th", "", &format!("bytes a {}", case.subject.thing()));
        ["nodes", "depth", "fullest", "crowded"].iter().for_each(|name| self.cell("th", "", name));
        self.raw("</tr>\n");
        for one in &case.contestants {
            self.row(case, one, &workloads);
        }
        self.raw("</table></div>\n");
        let partly = case.contestants.iter().filter(|one| !one.figures.is_empty());
        let partly: Vec<_> =
            partly.filter_map(|one| Some(format!("{}: {}", one.name, one.left_out.as_ref()?))).collect();
        if !partly.is_empty() {
            self.tagged("p", &format!("Left out: {}.", partly.join("; ")));
        }
        unlike(case).iter().for_each(|line| self.tagged("p", line));
    }

    fn row(&mut self, case: &Case, one: &Contestant, workloads: &[Workload]) {
        self.raw("<tr>");
        self.cell("td", "", &one.name);
        if let Some(why) = one.left_out.as_ref().filter(|_| one.figures.is_empty()) {
            let _ =
                write!(self.0, "<td class=\"why\" colspan=\"{}\">left out: {}</td>", workloads.len() + 5, escape(why));
        } else {
            for workload in case.workloads() {
                match one.figure(workload) {
                    Some(figure) => {
                        let class = if figure.ties { " class=\"best\"" } else { "" };
                        let (median, ratio) = (digits(figure.median), ratio(figure.ratio));
                        let _ = write!(self.0, "<td{class}>{median} <small>{ratio}</small></td>");
                    }
                    None => self.cell("td", "", "-"),
                }
            }
            let bytes = one.build.bytes_each.map_or("-".into(), |bytes| format!("{bytes:.0}"));
            self.cell("td", "", &bytes);
            let build = &one.build;
            for count in [build.nodes, build.depth, build.fullest, build.crowded] {
                self.cell("td", "", &count.map_or("-".into(), thousands));
            }
        }
        self.raw("</tr>\n");
    }

    fn growth(&mut self, study: &Study, title: &str, cases: &[&Case]) {
        let of: Vec<_> = study.growth.iter().filter(|growth| growth.of == title).collect();
        if of.is_empty() {
            return;
        }
        let growth = match study.subject() {
            Subject::Points => "Growth: time for all points, as a power of their number",
            Subject::Mesh => "Growth: time of the build and of a query, as a power of the number of triangles",
        };
        self.tagged("h3", growth);
        let workloads = workloads(cases.iter().copied());
        self.raw("<table><tr><th></th>");
        workloads.iter().for_each(|workload| self.cell("th", "", workload.name()));
        self.raw("</tr>\n");
        for name in study::names(&study.cases) {
            if !of.iter().any(|growth| growth.name == name) {
                continue;
            }
            self.raw("<tr>");
            self.cell("td", "", name);
            for workload in &workloads {
                let growth = of.iter().find(|growth| growth.name == name && growth.workload == *workload);
                self.cell("td", "", &growth.map_or("-".into(), |growth| format!("{:.2}", growth.exponent)));
            }
            self.raw("</tr>\n");
        }
        self.raw("</table>\n");
        let meaning = "1 is linear; n log n looks like 1.1 here, all pairs like 2. The slope of log time against log \
                       number, by least squares.";
        self.tagged("p", meaning);
    }

    fn crossovers(&mut self, study: &Study, title: &str) {
        let of: Vec<_> = study.crossovers.iter().filter(|crossover| crossover.of == title).collect();
        if of.is_empty() {
            return;
        }
        let things = study.subject().things();
        self.tagged("h3", "Where one overtakes another");
        self.raw("<ul>\n");
        for (i, first) in of.iter().enumerate() {
            let is_like = |other: &&&Crossover| other.workload == first.workload && other.winner == first.winner;
            if of[..i].iter().any(|other| is_like(&other)) {
                continue;
            }
            let losers = of.iter().filter(is_like).map(|other| format!("{} at {}", other.loser, other.size()));
            let losers = losers.collect::<Vec<_>>().join(", ");
            self.tagged("li", &format!("{}: {} overtakes {losers} {things}", first.workload.name(), first.winner));
        }
        self.raw("</ul>\n");
    }

    fn charts(&mut self, title: &str, charts: &[Chart<'_>]) -> Outcome {
        self.pictures(charts.iter().filter(|chart| chart.of == title))
    }

    fn details(&mut self, case: &Case) {
        self.tagged("h3", &format!("In detail: {} {}", thousands(case.n), case.subject.things()));
        for workload in case.workloads() {
            self.tagged("p", &format!("{}: {}", workload.name(), workload.describe()));
            self.raw("<div class=\"wide\"><table><tr><th></th>");
            let head =
                ["median ns", "minimum ns", "spread", "times the best", "nodes visited", case.subject.tests(), "found"];
            head.iter().for_each(|name| self.cell("th", "", name));
            self.raw("</tr>\n");
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
                self.raw("<tr>");
                self.cell("td", "", &one.name);
                cells.iter().for_each(|cell| self.cell("td", "", cell));
                self.raw("</tr>\n");
            }
            self.raw("</table></div>\n");
        }
        let (query, tests) = (case.subject.query(), case.subject.tests());
        let text = format!(
            "All of it for each {query}. Nodes, {tests} and finds are counted, not timed: the same on every machine."
        );
        self.tagged("p", &text);
    }

    fn method(&mut self, study: &Study) {
        self.tagged("h2", "How it was measured");
        let work = workloads(&study.cases);
        self.items(&work.iter().map(|w| (w.name().into(), w.describe().into())).collect::<Vec<_>>());
        let paragraphs = match study.subject() {
            Subject::Points => of_points(study),
            Subject::Mesh => rays::method(),
        };
        paragraphs.iter().for_each(|paragraph| self.tagged("p", paragraph));
        let text = format!(
            "Times are {}; the spread is the range of the middle half of the samples over their median. Two medians are told \
             apart where they differ by more than 3 % and by more than two standard errors. All randomness comes from the \
             seed {}.",
            stopwatch::SHOWS,
            study.seed
        );
        self.tagged("p", &text);
    }
}

/// How points are compared.
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
