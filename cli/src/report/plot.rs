//! Charts as SVG: lines and dots over scales that may be logarithmic, and bars.

use super::words::{short, thousands};
use crate::outcome::{Failure, Outcome};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::{
    ChartBuilder, Circle, Color, Cross, DrawingArea, IntoDrawingArea, IntoFont, LineSeries, PathElement, Polygon,
    RGBColor, Rectangle, SVGBackend, Text, TextStyle, TriangleMarker, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::borrow::Cow;
use std::ops::Range;

/// Units of a pixel: the library draws at whole units, which as pixels would make curves of stairs. All that follows is in
/// units.
const FINE: u32 = 2;
/// Width and height of a chart of lines.
const PANEL: (u32, u32) = (560 * FINE, 330 * FINE);
/// Height of a bar with the space around it, of what surrounds a chart of bars, and of the numbers of a scale below them.
const BAR: u32 = 22 * FINE;
const AROUND_BARS: u32 = 44 * FINE;
const NUMBERS: u32 = 18 * FINE;
/// The margins of a plot: above, beside and below, and at the axes.
const TITLE: u32 = 36 * FINE;
const MARGIN: u32 = 7 * FINE;
const AXES: (u32, u32) = (40 * FINE, 62 * FINE);
/// Width of the names beside lines, at the least and at the most, and of those before bars.
const LEGEND: [u32; 2] = [110 * FINE, 160 * FINE];
const NAMES: i32 = 120 * FINE as i32;
/// Letters of titles and of all else, the size of marks, and the width of lines.
const LETTERS: [u32; 2] = [17 * FINE, 14 * FINE];
const DOT: u32 = 4 * FINE;
const STROKE: u32 = 2 * FINE;
/// Height of a line of the legend.
const ROW: i32 = 20 * FINE as i32;

/// Colours that those who see few of them can tell apart (Okabe and Ito, "Color Universal Design", 2008), and some more.
const PALETTE: [RGBColor; 14] = [
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
const INK: RGBColor = RGBColor(34, 34, 34);
const FAINT: RGBColor = RGBColor(225, 225, 225);
const ALARM: RGBColor = RGBColor(200, 30, 30);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A chart of its own.
pub(crate) struct Chart<'a> {
    /// Its subject: the part of a report in which it stands.
    pub(crate) of: String,
    pub(crate) title: String,
    pub(crate) kind: Kind<'a>,
    size: (u32, u32),
}

/// The contents of a chart.
pub(crate) enum Kind<'a> {
    /// One quantity against another.
    Lines(Vec<Line<'a>>, Box<[Axis; 2]>),
    /// Parts behind each other, by name.
    Bars(Vec<Bar<'a>>),
}

/// A line, or what else has a place in the legend; without a name it has none.
pub(crate) struct Line<'a> {
    pub(crate) name: Cow<'a, str>,
    pub(crate) look: usize,
    pub(crate) dots: Vec<(f64, f64)>,
    pub(crate) style: Style,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Style {
    /// Through dots that have marks, if they are few.
    Marked,
    /// Without marks, around an area that is filled so much.
    Around(f64),
    /// No line, but dots: dark, or in the colour of alarm.
    Dots { alarm: bool },
}

impl<'a> Line<'a> {
    /// A line through dots.
    pub(crate) fn new(name: impl Into<Cow<'a, str>>, look: usize, dots: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), look, dots, style: Style::Marked }
    }
}

/// A line's look: the place of its name among all, so that it is the same in every chart.
pub(crate) fn look(looks: &[&str], name: &str) -> usize {
    looks.iter().position(|look| *look == name).unwrap_or(0)
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
    /// The quantity that is counted, with its unit.
    pub(crate) name: &'static str,
    /// Whether equal lengths are equal factors; else it begins at zero.
    pub(crate) is_log: bool,
    /// From where to where it goes, if not as far as what is drawn.
    pub(crate) ends: Option<[f64; 2]>,
    /// Where numbers stand; if nowhere, at round ones.
    pub(crate) ticks: Vec<f64>,
    /// How these are written.
    pub(crate) format: fn(f64) -> String,
}

impl Axis {
    /// Equal lengths are equal factors.
    pub(crate) fn log(name: &'static str) -> Self {
        Self { name, is_log: true, ends: None, ticks: Vec::new(), format: tick }
    }

    /// From zero on.
    pub(crate) fn linear(name: &'static str) -> Self {
        Self { is_log: false, ..Self::log(name) }
    }

    /// Between two values.
    pub(crate) fn between(name: &'static str, ends: [f64; 2]) -> Self {
        Self { ends: Some(ends), ..Self::linear(name) }
    }

    /// Long enough for all `values`, with a margin.
    fn scale(&self, values: impl Iterator<Item = f64>, margin: f64) -> Option<Scale> {
        if let Some([low, high]) = self.ends {
            return Some(Scale { ends: low..high, is_log: self.is_log, ticks: even_ticks(low, high) });
        }
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        if !(high > 0.0) {
            return None;
        }
        let (low, high) = if self.is_log { (low / margin, high * margin) } else { (0.0, high) };
        let ticks = match self.is_log {
            _ if !self.ticks.is_empty() => self.ticks.clone(),
            true => ticks(low, high),
            false => even_ticks(low, high),
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

/// Times the shortest of some bars from which on a longer one would squash it, so that they have a logarithmic scale.
const SQUASHED: f64 = 10.0;

impl<'a> Chart<'a> {
    /// Lines; what is not above zero has no place on a logarithmic scale and must not be among them.
    pub(crate) fn of_lines(of: &str, title: String, lines: Vec<Line<'a>>, axes: [Axis; 2]) -> Self {
        Self { of: of.into(), title, kind: Kind::Lines(lines, Box::new(axes)), size: PANEL }
    }

    /// Bars, from the top down.
    pub(crate) fn of_bars(of: &str, title: String, bars: Vec<Bar<'a>>) -> Self {
        let numbers = if Length::of(&bars).ends.is_some() { NUMBERS } else { 0 };
        let size = (PANEL.0, AROUND_BARS + BAR * bars.len() as u32 + numbers);
        Self { of: of.into(), title, kind: Kind::Bars(bars), size }
    }

    /// The same, so many pixels wide and high.
    pub(crate) fn sized(self, width: u32, height: u32) -> Self {
        Self { size: (width * FINE, height * FINE), ..self }
    }

    /// Height over width of the plot itself in a chart of so many pixels, beside names as long as they may be.
    pub(crate) fn aspect(width: u32, height: u32) -> f64 {
        let width = width * FINE - LEGEND[1] - 2 * MARGIN - AXES.1;
        f64::from(height * FINE - TITLE - MARGIN - AXES.0) / f64::from(width)
    }
}

/// All charts in one picture.
pub(crate) fn all(charts: &[Chart<'_>]) -> Outcome<String> {
    const COLUMNS: usize = 2;
    let most = |sizes: &mut dyn Iterator<Item = u32>| sizes.max().unwrap_or(1);
    let heights: Vec<u32> = charts.chunks(COLUMNS).map(|row| most(&mut row.iter().map(|chart| chart.size.1))).collect();
    let width = most(&mut charts.iter().map(|chart| chart.size.0));
    let size = (width * COLUMNS as u32, heights.iter().sum::<u32>().max(1));
    picture(size, |root| {
        root.fill(&WHITE).map_err(undrawn)?;
        let mut top = 0;
        for (row, height) in charts.chunks(COLUMNS).zip(&heights) {
            for (column, chart) in row.iter().enumerate() {
                chart.draw(&root.clone().shrink((column as u32 * width, top), chart.size))?;
            }
            top += height;
        }
        Ok(())
    })
}

/// A picture of so many units, shown in pixels.
fn picture(size: (u32, u32), draw: impl FnOnce(&Area<'_>) -> Outcome) -> Outcome<String> {
    let mut picture = String::new();
    {
        let root = SVGBackend::with_string(&mut picture, size).into_drawing_area();
        draw(&root)?;
        root.present().map_err(undrawn)?;
    }
    let told = |unit: u32| format!("width=\"{}\" height=\"{}\"", size.0 / unit, size.1 / unit);
    Ok(picture.replacen(&told(1), &told(FINE), 1))
}

fn undrawn(error: impl std::fmt::Display) -> Failure {
    Failure::new(format!("a chart cannot be drawn: {error}"))
}

fn letters(size: u32) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size).into_font()).color(&INK)
}

impl Chart<'_> {
    /// As a picture of its own.
    pub(crate) fn svg(&self) -> Outcome<String> {
        picture(self.size, |root| self.draw(root))
    }

    fn draw(&self, area: &Area<'_>) -> Outcome {
        let at = (12 * FINE as i32, 8 * FINE as i32);
        area.draw(&Text::new(self.title.clone(), at, letters(LETTERS[0]))).map_err(undrawn)?;
        match &self.kind {
            Kind::Lines(lines, axes) => draw_lines(area, lines, axes, self.size.0),
            Kind::Bars(bars) => draw_bars(area, bars),
        }
    }
}

fn draw_lines(area: &Area<'_>, lines: &[Line<'_>], [x_axis, y_axis]: &[Axis; 2], width: u32) -> Outcome {
    let dots = || lines.iter().flat_map(|line| &line.dots);
    let scales = x_axis.scale(dots().map(|dot| dot.0), 1.15).zip(y_axis.scale(dots().map(|dot| dot.1), 1.25));
    let Some((x, y)) = scales else { return Ok(()) };
    let longest = lines.iter().map(|line| line.name.chars().count()).max().unwrap_or(0).min(18) as u32;
    let (plot, legend) = area.split_horizontally(width - ((35 + 7 * longest) * FINE).clamp(LEGEND[0], LEGEND[1]));
    let mut chart = ChartBuilder::on(&plot)
        .margin_top(TITLE)
        .margin_right(MARGIN)
        .margin_left(MARGIN)
        .margin_bottom(MARGIN)
        .x_label_area_size(AXES.0)
        .y_label_area_size(AXES.1)
        .build_cartesian_2d(x, y)
        .map_err(undrawn)?;
    chart
        .configure_mesh()
        .x_desc(x_axis.name)
        .y_desc(y_axis.name)
        .label_style(letters(LETTERS[1]))
        .axis_desc_style(letters(LETTERS[1]))
        .bold_line_style(FAINT.stroke_width(FINE))
        .axis_style(INK.stroke_width(FINE))
        .light_line_style(WHITE.mix(0.0))
        .x_label_formatter(&|x| (x_axis.format)(*x))
        .y_label_formatter(&|y| (y_axis.format)(*y))
        .draw()
        .map_err(undrawn)?;
    // The chart counts units from the picture's corner, the area from its own.
    let origin = area.get_pixel_range();
    for line in lines {
        if let Style::Around(fill) = line.style
            && fill > 0.0
        {
            chart.draw_series([Polygon::new(line.dots.clone(), line.color().mix(fill))]).map_err(undrawn)?;
        }
        let is_line = !matches!(line.style, Style::Dots { .. });
        if is_line {
            let stroke = line.color().stroke_width(if line.name.is_empty() { FINE } else { STROKE });
            chart.draw_series(LineSeries::new(line.dots.iter().copied(), stroke)).map_err(undrawn)?;
        }
        // Where dots stand close together, the line says enough.
        for dot in line.dots.iter().filter(|_| !is_line || line.style == Style::Marked && line.dots.len() <= 20) {
            let (x, y) = chart.backend_coord(dot);
            line.mark(area, (x - origin.0.start, y - origin.1.start))?;
        }
    }
    draw_legend(&legend, lines, longest as usize)
}

fn draw_legend(area: &Area<'_>, lines: &[Line<'_>], longest: usize) -> Outcome {
    let half = ROW / 2;
    let mut y = TITLE as i32 + half;
    for line in lines.iter().filter(|line| !line.name.is_empty()) {
        if line.dots.is_empty() {
            let words = Text::new(line.name.to_string(), (FINE as i32, y), beside(HPos::Left));
            area.draw(&words).map_err(undrawn)?;
        } else {
            if !matches!(line.style, Style::Dots { .. }) {
                let stroke = PathElement::new(vec![(FINE as i32, y), (ROW, y)], line.color().stroke_width(STROKE));
                area.draw(&stroke).map_err(undrawn)?;
            }
            if !matches!(line.style, Style::Around(_)) {
                line.mark(area, (half, y))?;
            }
            let words = Text::new(shown(&line.name, longest.max(13)), (ROW + half / 2, y), beside(HPos::Left));
            area.draw(&words).map_err(undrawn)?;
        }
        y += ROW;
    }
    Ok(())
}

/// Small letters in the middle of a line.
fn beside(side: HPos) -> TextStyle<'static> {
    letters(LETTERS[1]).pos(Pos::new(side, VPos::Center))
}

impl Line<'_> {
    fn color(&self) -> RGBColor {
        match self.style {
            Style::Dots { alarm: true } => ALARM,
            Style::Dots { alarm: false } => INK,
            _ => PALETTE[self.look % PALETTE.len()],
        }
    }

    /// The sign that marks a line's dots, so that lines are told apart without colours too.
    fn mark(&self, area: &Area<'_>, at: (i32, i32)) -> Outcome {
        let color = self.color();
        let drawn = match (self.style, self.look % 4) {
            (Style::Dots { .. }, _) => area.draw(&Circle::new(at, DOT, color.mix(0.75).filled())),
            (_, 0) => area.draw(&Circle::new(at, DOT, color.filled())),
            (_, 1) => area.draw(&TriangleMarker::new(at, DOT + FINE, color.filled())),
            (_, 2) => area.draw(&Cross::new(at, DOT, color.stroke_width(STROKE))),
            _ => area.draw(&Circle::new(at, DOT, color.stroke_width(STROKE))),
        };
        drawn.map_err(undrawn)
    }
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

/// About five round numbers between two.
fn even_ticks(low: f64, high: f64) -> Vec<f64> {
    let range = high - low;
    let power = 10f64.powf((range / 4.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power).find(|step| range / step <= 6.0);
    let step = step.unwrap_or(range);
    ((low / step).ceil() as i32..=(high / step).floor() as i32).map(|i| f64::from(i) * step).collect()
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

/// How long bars are.
struct Length {
    longest: f64,
    /// Where a logarithmic scale begins, at a power of ten, and ends.
    ends: Option<Range<f64>>,
}

impl Length {
    fn of(bars: &[Bar<'_>]) -> Self {
        let whole = || bars.iter().map(|bar| bar.parts[0] + bar.parts[1]);
        let longest = whole().fold(0.0f64, f64::max);
        let shortest = bars.iter().map(|bar| bar.parts[0]).filter(|part| *part > 0.0).fold(f64::INFINITY, f64::min);
        let low = 10f64.powf((shortest / 1.5).log10().floor());
        Self { longest, ends: (longest > SQUASHED * shortest).then_some(low..longest) }
    }

    /// The length of a bar as a part of the longest.
    fn share(&self, value: f64) -> f64 {
        match &self.ends {
            Some(Range { start, end }) => ((value / start).ln() / (end / start).ln()).max(0.0),
            None if self.longest > 0.0 => value / self.longest,
            None => 0.0,
        }
    }
}

fn draw_bars(area: &Area<'_>, bars: &[Bar<'_>]) -> Outcome {
    /// Room for the words behind a bar.
    const WORDS: i32 = 150 * FINE as i32;
    let lengths = Length::of(bars);
    let width = f64::from(PANEL.0 as i32 - NAMES - WORDS - ROW);
    let place = |value: f64| NAMES + (lengths.share(value) * width).round() as i32;
    let (row, gap, bottom) = (BAR as i32, 3 * FINE as i32, (TITLE + BAR * bars.len() as u32) as i32);
    for tick in lengths.ends.iter().flat_map(|ends| powers(ends.start, ends.end)) {
        let line = vec![(place(tick), TITLE as i32), (place(tick), bottom)];
        area.draw(&PathElement::new(line, FAINT.stroke_width(FINE))).map_err(undrawn)?;
        let number = Text::new(self::tick(tick), (place(tick), bottom + gap * 3), beside(HPos::Center));
        area.draw(&number).map_err(undrawn)?;
    }
    for (i, bar) in bars.iter().enumerate() {
        let color = PALETTE[bar.look % PALETTE.len()];
        let top = TITLE as i32 + row * i as i32;
        let (bottom, middle) = (top + row - 2 * gap, top + row / 2 - gap);
        let [b, c] = [bar.parts[0], bar.parts[0] + bar.parts[1]].map(place);
        area.draw(&Rectangle::new([(NAMES, top), (b, bottom)], color.filled())).map_err(undrawn)?;
        area.draw(&Rectangle::new([(b, top), (c, bottom)], color.mix(0.35).filled())).map_err(undrawn)?;
        let name = Text::new(shown(bar.name, 15), (NAMES - gap * 2, middle), beside(HPos::Right));
        area.draw(&name).map_err(undrawn)?;
        area.draw(&Text::new(bar.label.clone(), (c + gap * 2, middle), beside(HPos::Left))).map_err(undrawn)?;
    }
    Ok(())
}

/// The powers of ten between two numbers.
fn powers(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let from = low.log10().round() as i32;
    (from..=high.log10().floor() as i32).map(|power| 10f64.powi(power))
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
        assert_eq!(even_ticks(0.0, 40.0), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!(even_ticks(-3.7, 2.3), [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0]);
        assert_eq!(even_ticks(0.0, 13.0), [0.0, 5.0, 10.0]);
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!(shown("grid", 6), "grid");
        assert_eq!(shown("octree-of-others", 6), "octre…");
    }

    #[test]
    fn what_is_long_does_not_squash_the_rest() {
        let bars = |parts: &[f64]| {
            parts
                .iter()
                .map(|part| Bar { name: "", look: 0, parts: [*part, 0.0], label: String::new() })
                .collect::<Vec<_>>()
        };
        let even = Length::of(&bars(&[10.0, 20.0]));
        assert!(even.ends.is_none() && even.share(10.0) == 0.5);
        let log = Length::of(&bars(&[20.0, 2e5]));
        assert_eq!(log.ends, Some(10.0..2e5));
        assert!((log.share(20.0) - 0.07).abs() < 0.001 && log.share(2e5) == 1.0 && log.share(0.0) == 0.0);
        assert_eq!(powers(10.0, 2e5).count(), 5);
        assert_eq!(Length::of(&[]).share(1.0), 0.0);
    }
}
