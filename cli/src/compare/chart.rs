//! Charts: time against the number of points or triangles on paper of two logarithmic scales, and bars at the largest number.

use super::study::{Case, Contestant, Study, Subject, line, names, series, workloads};
use super::workload::Workload;
use crate::report::plot::{Axis, Bar, Chart, Line, look};
use crate::report::words::{digits, ratio, thousands};

/// All charts, in the order in which they should be looked at.
pub(crate) fn charts(study: &Study) -> Vec<Chart<'_>> {
    let looks = names(&study.cases);
    let mut charts = Vec::new();
    for (title, cases) in series(&study.cases) {
        for workload in workloads(cases.iter().copied()).into_iter().filter(|_| cases.len() > 1) {
            charts.push(lines(title, &cases, workload, &looks));
        }
        let Some(largest) = cases.last() else { continue };
        for workload in workloads(cases.iter().copied()).into_iter().filter(|workload| workload.is_query()) {
            charts.push(bars(title, largest, workload, &looks));
        }
        charts.push(memory(title, largest, &looks));
    }
    charts
}

fn lines<'a>(of: &'a str, cases: &[&'a Case], workload: Workload, looks: &[&'a str]) -> Chart<'a> {
    let mut lines: Vec<_> = looks
        .iter()
        .map(|name| {
            let dots = line(cases, name, workload).into_iter().map(|(n, figure)| (n as f64, figure.median));
            Line::new(*name, look(looks, name), dots.filter(|(_, y)| *y > 0.0).collect())
        })
        .filter(|line| !line.dots.is_empty())
        .collect();
    // The legend has the order of the lines' right ends.
    lines.sort_by(|a, b| end(b).total_cmp(&end(a)));
    let subject = cases.first().map_or(Subject::Points, |case| case.subject);
    let unit = subject.unit(workload);
    let title = format!("{of}: {}, {unit}", workload.name());
    let sizes = cases.iter().map(|case| case.n as f64).collect();
    let x = Axis { ticks: sizes, format: |n| thousands(n.round() as usize), ..Axis::log(subject.things()) };
    Chart::of_lines(of, title, lines, [x, Axis::log(unit)])
}

fn end(line: &Line<'_>) -> f64 {
    line.dots.last().map_or(0.0, |dot| dot.1)
}

fn bars<'a>(of: &'a str, case: &'a Case, workload: Workload, looks: &[&'a str]) -> Chart<'a> {
    let is_built = workload != Workload::Moving && case.subject == Subject::Points;
    let rows = case.ranking(workload).into_iter().map(|(one, figure)| {
        let build = one.figure(Workload::Build).map_or(0.0, |build| build.median);
        let (parts, label) = match is_built {
            true => ([figure.median, build], format!("{} + {} ns", digits(figure.median), digits(build))),
            false => ([figure.median, 0.0], format!("{} ns", digits(figure.median))),
        };
        let label = format!("{label}  ({} x)", ratio(figure.ratio));
        Bar { name: &one.name, look: look(looks, &one.name), parts, label }
    });
    let behind = if is_built { " + build (pale)" } else { "" };
    let (n, things, unit) = (thousands(case.n), case.subject.things(), case.subject.unit(workload));
    let title = format!("{of}, {n} {things}: {}{behind}, {unit}", workload.name());
    Chart::of_bars(of, title, rows.collect())
}

fn memory<'a>(of: &'a str, case: &'a Case, looks: &[&'a str]) -> Chart<'a> {
    let bytes = |one: &Contestant| one.build.bytes_each;
    let mut all: Vec<_> = case.contestants.iter().filter_map(|one| Some((bytes(one)?, one))).collect();
    all.retain(|(_, one)| !one.figures.is_empty());
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let rows = all.into_iter().map(|(bytes, one)| Bar {
        name: &one.name,
        look: look(looks, &one.name),
        parts: [bytes, 0.0],
        label: format!("{bytes:.0} bytes"),
    });
    let (n, things, thing) = (thousands(case.n), case.subject.things(), case.subject.thing());
    let title = format!("{of}, {n} {things}: memory for each {thing}");
    Chart::of_bars(of, title, rows.collect())
}

#[cfg(test)]
mod tests {
    use super::super::tests::case;
    use super::*;
    use crate::report::plot::Kind;

    #[test]
    fn lines_and_bars_are_as_long_as_medians() {
        let cases = [case(10, &[("a", 100.0), ("b", 70.0)]), case(20, &[("a", 200.0), ("b", 90.0)])];
        let looks = names(&cases);
        let Kind::Lines(lines, _) = lines("p", &[&cases[0], &cases[1]], Workload::Count, &looks).kind else { panic!() };
        assert_eq!((&*lines[0].name, &lines[0].dots[..]), ("a", &[(10.0, 100.0), (20.0, 200.0)][..]));
        let Kind::Bars(bars) = bars("p", &cases[1], Workload::Count, &looks).kind else { panic!() };
        // The build takes 10 ns everywhere.
        assert_eq!((bars[0].name, bars[0].parts, bars[1].parts), ("b", [90.0, 10.0], [200.0, 10.0]));
    }
}
