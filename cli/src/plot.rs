//! Charts as SVG: lines over scales that may be logarithmic, and bars.

use crate::words::{short, thousands};
use crate::{Failure, Outcome};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::{
    ChartBuilder, Circle, Color, Cross, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, PathElement, RGBColor,
    Rectangle, SVGBackend, Text, TextStyle, TriangleMarker, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

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
    /// What it is about: the part of a report in which it stands.
    pub(crate) of: String,
    pub(crate) title: String,
    pub(crate) kind: Kind<'a>,
    size: (u32, u32),
}

/// What a chart shows.
pub(crate) enum Kind<'a> {
    /// One quantity against another.
    Lines(Vec<Line<'a>>, Box<[Axis; 2]>),
    /// Parts behind each other, by name.
    Bars(Vec<Bar<'a>>),
}

/// A line through dots.
pub(crate) struct Line<'a> {
    pub(crate) name: &'a str,
    pub(crate) look: usize,
    pub(crate) dots: Vec<(f64, f64)>,
}

/// A bar of two parts.
pub(crate) struct Bar<'a> {
    pub(crate) name: &'a str,
    pub(crate) look: usize,
    /// The first full, the other pale.
    pub(crate) parts: [f64; 2],
    pub(crate) label: String,
}

/// A scale with its numbers.
pub(crate) struct Axis {
    /// What is counted, with its unit.
    pub(crate) name: &'static str,
    /// Whether equal lengths are equal factors; else it begins at zero.
    pub(crate) is_log: bool,
    /// Where numbers stand; if nowhere, at round ones.
    pub(crate) ticks: Vec<f64>,
    /// How these are written.
    pub(crate) format: fn(f64) -> String,
}

impl Axis {
    /// Equal lengths are equal factors.
    pub(crate) fn log(name: &'static str) -> Self {
        Self { name, is_log: true, ticks: Vec::new(), format: tick }
    }

    /// From zero on.
    pub(crate) fn linear(name: &'static str) -> Self {
        Self { is_log: false, ..Self::log(name) }
    }

    /// Long enough for all `values`, with a margin.
    fn scale(&self, values: impl Iterator<Item = f64>, margin: f64) -> Option<Scale> {
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        if !(high > 0.0) {
            return None;
        }
        let (low, high) = if self.is_log { (low / margin, high * margin) } else { (0.0, high) };
        let ticks = match self.is_log {
            _ if !self.ticks.is_empty() => self.ticks.clone(),
            true => ticks(low, high),
            false => even_ticks(high),
        };
        Some(Scale { ends: low..high, is_log: self.is_log, ticks })
    }
}

/// Values and their places on paper.
struct Scale {
    ends: Range<f64>,
    is_log: bool,
    ticks: Vec<f64>,
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let place = |value: f64| if self.is_log { value.log10() } else { value };
        let [low, high] = [self.ends.start, self.ends.end].map(place);
        from + ((place(*value) - low) / (high - low) * f64::from(to - from)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        // The others are those between them.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.ends.clone()
    }
}

impl<'a> Chart<'a> {
    /// Lines; what is not above zero has no place on a logarithmic scale and must not be among them.
    pub(crate) fn of_lines(of: &str, title: String, lines: Vec<Line<'a>>, axes: [Axis; 2]) -> Self {
        Self { of: of.into(), title, kind: Kind::Lines(lines, Box::new(axes)), size: PANEL }
    }

    /// Bars, from the top down.
    pub(crate) fn of_bars(of: &str, title: String, bars: Vec<Bar<'a>>) -> Self {
        let size = (PANEL.0, AROUND_BARS + BAR * bars.len() as u32);
        Self { of: of.into(), title, kind: Kind::Bars(bars), size }
    }
}

/// All charts in one picture.
///
/// # Errors
/// If it cannot be drawn.
pub(crate) fn all(charts: &[Chart<'_>]) -> Outcome<String> {
    const COLUMNS: usize = 2;
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
            Kind::Lines(lines, axes) => draw_lines(area, lines, axes),
            Kind::Bars(bars) => draw_bars(area, bars),
        }
    }
}

/// Width of the names beside lines, at the least and at the most, and of those before bars.
const LEGEND: [u32; 2] = [110, 160];
const NAMES: i32 = 120;

fn draw_lines(area: &Area<'_>, lines: &[Line<'_>], [x_axis, y_axis]: &[Axis; 2]) -> Outcome {
    let dots = || lines.iter().flat_map(|line| &line.dots);
    let scales = x_axis.scale(dots().map(|dot| dot.0), 1.15).zip(y_axis.scale(dots().map(|dot| dot.1), 1.25));
    let Some((x, y)) = scales else { return Ok(()) };
    let letters = lines.iter().map(|line| line.name.chars().count()).max().unwrap_or(0).min(18);
    let (plot, legend) = area.split_horizontally(PANEL.0 - (34 + 7 * letters as u32 + 1).clamp(LEGEND[0], LEGEND[1]));
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
        .x_desc(x_axis.name)
        .y_desc(y_axis.name)
        .label_style(small.clone())
        .axis_desc_style(small.clone())
        .bold_line_style(FAINT)
        .light_line_style(WHITE.mix(0.0))
        .x_label_formatter(&|x| (x_axis.format)(*x))
        .y_label_formatter(&|y| (y_axis.format)(*y))
        .draw()
        .map_err(undrawn)?;
    // The chart counts pixels from the picture's corner, the area from its own.
    let origin = area.get_pixel_range();
    for line in lines {
        let color = PALETTE[line.look % PALETTE.len()];
        chart.draw_series(LineSeries::new(line.dots.iter().copied(), color.stroke_width(2))).map_err(undrawn)?;
        // Where dots stand close together, the line says enough.
        for dot in line.dots.iter().filter(|_| line.dots.len() <= 20) {
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
        legend.draw(&Text::new(shown(line.name, letters.max(13)), (28, y), style)).map_err(undrawn)?;
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

/// About five round numbers from zero up to `high`.
fn even_ticks(high: f64) -> Vec<f64> {
    let power = 10f64.powf((high / 4.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power).find(|step| high / step <= 6.0);
    let step = step.unwrap_or(high);
    (0..=(high / step) as u32).map(|i| f64::from(i) * step).collect()
}

/// A tick, without digits that do not count.
pub(crate) fn tick(value: f64) -> String {
    match value {
        value if value > 0.0 && value < 1e-3 => format!("{value:.1e}").replace(".0e", "e"),
        value if value >= 10.0 => thousands(value.round() as usize),
        _ => short(value),
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
    use super::*;

    #[test]
    fn ticks_lie_within_and_are_few() {
        assert_eq!(ticks(0.9, 60.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
        assert_eq!(ticks(14.0, 45.0), [15.0, 20.0, 30.0, 40.0]);
        assert_eq!(ticks(15.0, 150.0), [20.0, 50.0, 100.0]);
        assert_eq!(ticks(0.5, 20_000.0), [1.0, 10.0, 100.0, 1000.0, 10_000.0]);
        assert_eq!([tick(0.5), tick(1.5), tick(2.0), tick(20.0), tick(1e4)], ["0.5", "1.5", "2", "20", "10 000"]);
        assert_eq!([tick(1e-3), tick(1e-7), tick(1.5e-4), tick(0.0)], ["0.001", "1e-7", "1.5e-4", "0"]);
        assert_eq!(even_ticks(40.0), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(even_ticks(13.0), [0.0, 5.0, 10.0]);
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!(shown("grid", 6), "grid");
        assert_eq!(shown("octree-of-others", 6), "octre…");
    }
}
