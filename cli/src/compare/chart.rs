//! Charts: time against the number of points on paper of two logarithmic scales, and bars at the largest number.

use super::advice::{digits, thousands};
use super::study::{Case, Contestant, Study, line, names, series, workloads};
use super::table::ratio;
use super::workload::Workload;
use crate::{Failure, Outcome};
use plotters::coord::Shift;
use plotters::coord::combinators::{BindKeyPoints, IntoLogRange};
use plotters::prelude::{
    ChartBuilder, Circle, Color, Cross, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, PathElement, RGBColor,
    Rectangle, SVGBackend, Text, TextStyle, TriangleMarker, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width and height of a chart of lines.
const PANEL: (u32, u32) = (560, 330);
/// Height of a bar with the space around it, and of what surrounds a chart of bars.
const BAR: u32 = 22;
const AROUND_BARS: u32 = 44;

/// Colours that those who see few of them can tell apart (Okabe and Ito, "Color Universal Design", 2008), and some more.
pub(crate) const PALETTE: [RGBColor; 14] = [
    RGBColor(85, 85, 85),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(136, 34, 85),
    RGBColor(153, 153, 51),
    RGBColor(51, 34, 136),
    RGBColor(170, 68, 0),
    RGBColor(0, 90, 50),
    RGBColor(68, 170, 153),
    RGBColor(120, 28, 129),
];
pub(crate) const INK: RGBColor = RGBColor(34, 34, 34);
pub(crate) const FAINT: RGBColor = RGBColor(225, 225, 225);

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A chart of its own.
pub(crate) struct Chart<'a> {
    /// Of which points.
    pub(crate) points: String,
    pub(crate) title: String,
    kind: Kind<'a>,
    size: (u32, u32),
}

enum Kind<'a> {
    /// Time against the number of points.
    Lines(Vec<Line<'a>>),
    /// Parts behind each other, by name.
    Bars(Vec<Bar<'a>>),
}

struct Line<'a> {
    name: &'a str,
    look: usize,
    dots: Vec<(f64, f64)>,
}

struct Bar<'a> {
    name: &'a str,
    look: usize,
    /// The first pale, the other full.
    parts: [f64; 2],
    label: String,
}

/// All charts, in the order in which they should be looked at.
pub(crate) fn charts(study: &Study) -> Vec<Chart<'_>> {
    let looks = names(&study.cases);
    let mut charts = Vec::new();
    for (points, cases) in series(&study.cases) {
        for workload in workloads(cases.iter().copied()).into_iter().filter(|_| cases.len() > 1) {
            charts.push(lines(points, &cases, workload, &looks));
        }
        let Some(largest) = cases.last() else { continue };
        for workload in workloads(cases.iter().copied()).into_iter().filter(|workload| workload.is_query()) {
            charts.push(bars(points, largest, workload, &looks));
        }
        charts.push(memory(points, largest, &looks));
    }
    charts
}

fn look(looks: &[&str], name: &str) -> usize {
    looks.iter().position(|look| *look == name).unwrap_or(0)
}

fn lines<'a>(points: &'a str, cases: &[&'a Case], workload: Workload, looks: &[&'a str]) -> Chart<'a> {
    let mut lines: Vec<_> = looks
        .iter()
        .map(|name| {
            let dots = line(cases, name, workload).into_iter().map(|(n, figure)| (n as f64, figure.median));
            Line { name, look: look(looks, name), dots: dots.filter(|(_, y)| *y > 0.0).collect() }
        })
        .filter(|line| !line.dots.is_empty())
        .collect();
    // The legend has the order of the lines' right ends.
    lines.sort_by(|a, b| end(b).total_cmp(&end(a)));
    let title = format!("{points}: {}, time for each point", workload.name());
    Chart { points: points.into(), title, kind: Kind::Lines(lines), size: PANEL }
}

fn end(line: &Line<'_>) -> f64 {
    line.dots.last().map_or(0.0, |dot| dot.1)
}

fn bars<'a>(points: &'a str, case: &'a Case, workload: Workload, looks: &[&'a str]) -> Chart<'a> {
    let is_built = workload != Workload::Moving;
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
    let title = format!("{points}, {} points: {}{behind}, ns a point", thousands(case.n), workload.name());
    chart_of_bars(points, title, rows.collect())
}

fn memory<'a>(points: &'a str, case: &'a Case, looks: &[&'a str]) -> Chart<'a> {
    let bytes = |one: &Contestant| one.build.bytes_per_point;
    let mut all: Vec<_> = case.contestants.iter().filter_map(|one| Some((bytes(one)?, one))).collect();
    all.retain(|(_, one)| !one.figures.is_empty());
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let rows = all.into_iter().map(|(bytes, one)| Bar {
        name: &one.name,
        look: look(looks, &one.name),
        parts: [bytes, 0.0],
        label: format!("{bytes:.0} bytes"),
    });
    let title = format!("{points}, {} points: memory for each point", thousands(case.n));
    chart_of_bars(points, title, rows.collect())
}

fn chart_of_bars<'a>(points: &str, title: String, bars: Vec<Bar<'a>>) -> Chart<'a> {
    let size = (PANEL.0, AROUND_BARS + BAR * bars.len() as u32);
    Chart { points: points.into(), title, kind: Kind::Bars(bars), size }
}

/// All charts in one picture.
///
/// # Errors
/// If it cannot be drawn.
pub(crate) fn all(study: &Study) -> Outcome<String> {
    const COLUMNS: usize = 2;
    let charts = charts(study);
    let heights: Vec<u32> =
        charts.chunks(COLUMNS).map(|row| row.iter().map(|chart| chart.size.1).max().unwrap_or(0)).collect();
    let size = (PANEL.0 * COLUMNS as u32, heights.iter().sum::<u32>().max(1));
    let mut picture = String::new();
    {
        let root = SVGBackend::with_string(&mut picture, size).into_drawing_area();
        root.fill(&WHITE).map_err(undrawn)?;
        let mut top = 0;
        for (row, height) in charts.chunks(COLUMNS).zip(heights) {
            for (column, chart) in row.iter().enumerate() {
                let left = column as u32 * PANEL.0;
                chart.draw(&root.clone().shrink((left, top), chart.size))?;
            }
            top += height;
        }
        root.present().map_err(undrawn)?;
    }
    Ok(picture)
}

pub(crate) fn undrawn(error: impl std::fmt::Display) -> Failure {
    Failure::new(format!("a chart cannot be drawn: {error}"))
}

impl Chart<'_> {
    /// As a picture of its own.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub(crate) fn svg(&self) -> Outcome<String> {
        let mut picture = String::new();
        {
            let root = SVGBackend::with_string(&mut picture, self.size).into_drawing_area();
            self.draw(&root)?;
            root.present().map_err(undrawn)?;
        }
        Ok(picture)
    }

    fn draw(&self, area: &Area<'_>) -> Outcome {
        let title = TextStyle::from(("sans-serif", 17).into_font()).color(&INK);
        area.draw(&Text::new(self.title.clone(), (12, 8), title)).map_err(undrawn)?;
        match &self.kind {
            Kind::Lines(lines) => draw_lines(area, lines),
            Kind::Bars(bars) => draw_bars(area, bars),
        }
    }
}

/// Width of the names beside lines, and of those before bars.
const LEGEND: u32 = 110;
const NAMES: i32 = 120;

fn draw_lines(area: &Area<'_>, lines: &[Line<'_>]) -> Outcome {
    let dots = || lines.iter().flat_map(|line| &line.dots);
    let Some(([left, right], [low, high])) = bounds(dots()) else { return Ok(()) };
    let mut sizes: Vec<f64> = dots().map(|dot| dot.0).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let x = (left / 1.15..right * 1.15).log_scale().with_key_points(sizes);
    let y = (low / 1.25..high * 1.25).log_scale().with_key_points(ticks(low / 1.25, high * 1.25));
    let (plot, legend) = area.split_horizontally(PANEL.0 - LEGEND);
    let mut chart = ChartBuilder::on(&plot)
        .margin_top(36)
        .margin_right(8)
        .margin_left(6)
        .margin_bottom(6)
        .x_label_area_size(40)
        .y_label_area_size(62)
        .build_cartesian_2d(x, y)
        .map_err(undrawn)?;
    let small = TextStyle::from(("sans-serif", 14).into_font()).color(&INK);
    chart
        .configure_mesh()
        .x_desc("points")
        .y_desc("ns a point")
        .label_style(small.clone())
        .axis_desc_style(small.clone())
        .bold_line_style(FAINT)
        .light_line_style(WHITE.mix(0.0))
        .x_label_formatter(&|n| thousands(*n as usize))
        .y_label_formatter(&|ns| tick(*ns))
        .draw()
        .map_err(undrawn)?;
    // The chart counts pixels from the picture's corner, the area from its own.
    let origin = area.get_pixel_range();
    for line in lines {
        let color = PALETTE[line.look % PALETTE.len()];
        chart.draw_series(LineSeries::new(line.dots.iter().copied(), color.stroke_width(2))).map_err(undrawn)?;
        for dot in &line.dots {
            let (x, y) = chart.backend_coord(dot);
            mark(area, (x - origin.0.start, y - origin.1.start), line.look)?;
        }
    }
    for (i, line) in lines.iter().enumerate() {
        let color = PALETTE[line.look % PALETTE.len()];
        let y = 44 + 20 * i as i32;
        legend.draw(&PathElement::new(vec![(2, y), (22, y)], color.stroke_width(2))).map_err(undrawn)?;
        mark(&legend, (12, y), line.look)?;
        let style = small.clone().pos(Pos::new(HPos::Left, VPos::Center));
        legend.draw(&Text::new(shown(line.name, 13), (28, y), style)).map_err(undrawn)?;
    }
    Ok(())
}

/// What marks a line's dots, so that lines are told apart without colours too.
fn mark(area: &Area<'_>, at: (i32, i32), look: usize) -> Outcome {
    let color = PALETTE[look % PALETTE.len()];
    let drawn = match look % 4 {
        0 => area.draw(&Circle::new(at, 4, color.filled())),
        1 => area.draw(&TriangleMarker::new(at, 5, color.filled())),
        2 => area.draw(&Cross::new(at, 4, color.stroke_width(2))),
        _ => area.draw(&Circle::new(at, 4, color.stroke_width(2))),
    };
    drawn.map_err(undrawn)
}

/// The least and the largest of both coordinates, if there are any.
fn bounds<'d>(dots: impl Iterator<Item = &'d (f64, f64)>) -> Option<([f64; 2], [f64; 2])> {
    let none = ([f64::INFINITY, 0.0], [f64::INFINITY, 0.0]);
    let all = dots.fold(none, |([left, right], [low, high]), (x, y)| {
        ([left.min(*x), right.max(*x)], [low.min(*y), high.max(*y)])
    });
    (all.0[1] > 0.0 && all.1[1] > 0.0).then_some(all)
}

/// 1, 2 and 5 times the powers of ten between two numbers; of a wide range, the powers alone, of a narrow one, more.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let steps: &[f64] = match high / low {
        wide if wide > 2e3 => &[1.0],
        narrow if narrow < 8.0 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
        _ => &[1.0, 2.0, 5.0],
    };
    let all = powers.flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
    all.filter(|tick| (low..=high).contains(tick)).collect()
}

/// A tick, without digits that do not count.
fn tick(value: f64) -> String {
    match value {
        value if value >= 10.0 => thousands(value.round() as usize),
        _ => digits(value).trim_end_matches('0').trim_end_matches('.').to_string(),
    }
}

/// A name cut to so many letters.
fn shown(name: &str, most: usize) -> String {
    match name.chars().count() > most {
        true => name.chars().take(most - 1).chain(['…']).collect(),
        false => name.to_string(),
    }
}

fn draw_bars(area: &Area<'_>, bars: &[Bar<'_>]) -> Outcome {
    /// Room for the words behind a bar.
    const WORDS: i32 = 150;
    let longest = bars.iter().fold(0.0f64, |longest, bar| longest.max(bar.parts[0] + bar.parts[1]));
    let width = f64::from(PANEL.0 as i32 - NAMES - WORDS - 12);
    let length = |part: f64| if longest > 0.0 { (part / longest * width).round() as i32 } else { 0 };
    let small = TextStyle::from(("sans-serif", 14).into_font()).color(&INK);
    for (i, bar) in bars.iter().enumerate() {
        let color = PALETTE[bar.look % PALETTE.len()];
        let top = 36 + BAR as i32 * i as i32;
        let (bottom, middle) = (top + BAR as i32 - 6, top + BAR as i32 / 2 - 3);
        let [first, second] = bar.parts.map(length);
        let [a, b, c] = [NAMES, NAMES + first, NAMES + first + second];
        area.draw(&Rectangle::new([(a, top), (b, bottom)], color.filled())).map_err(undrawn)?;
        area.draw(&Rectangle::new([(b, top), (c, bottom)], color.mix(0.35).filled())).map_err(undrawn)?;
        let right = small.clone().pos(Pos::new(HPos::Right, VPos::Center));
        area.draw(&Text::new(shown(bar.name, 15), (NAMES - 8, middle), right)).map_err(undrawn)?;
        let left = small.clone().pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(bar.label.clone(), (c + 6, middle), left)).map_err(undrawn)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::case;
    use super::*;

    #[test]
    fn lines_and_bars_are_as_long_as_medians() {
        let cases = [case(10, &[("a", 100.0), ("b", 70.0)]), case(20, &[("a", 200.0), ("b", 90.0)])];
        let looks = names(&cases);
        let Kind::Lines(lines) = lines("p", &[&cases[0], &cases[1]], Workload::Count, &looks).kind else { panic!() };
        assert_eq!((lines[0].name, &lines[0].dots[..]), ("a", &[(10.0, 100.0), (20.0, 200.0)][..]));
        let Kind::Bars(bars) = bars("p", &cases[1], Workload::Count, &looks).kind else { panic!() };
        // The build takes 10 ns everywhere.
        assert_eq!((bars[0].name, bars[0].parts, bars[1].parts), ("b", [90.0, 10.0], [200.0, 10.0]));
    }

    #[test]
    fn ticks_lie_within_and_are_few() {
        assert_eq!(ticks(0.9, 60.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
        assert_eq!(ticks(14.0, 45.0), [15.0, 20.0, 30.0, 40.0]);
        assert_eq!(ticks(15.0, 150.0), [20.0, 50.0, 100.0]);
        assert_eq!(ticks(0.5, 20_000.0), [1.0, 10.0, 100.0, 1000.0, 10_000.0]);
        assert_eq!([tick(0.5), tick(1.5), tick(2.0), tick(20.0), tick(1e4)], ["0.5", "1.5", "2", "20", "10 000"]);
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!(shown("grid", 6), "grid");
        assert_eq!(shown("octree-of-others", 6), "octre…");
    }
}
