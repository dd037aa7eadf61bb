//! Charts: lines and dots over scales that may be logarithmic, and bars.

use super::svg::{INK, Place, Svg};
use super::words::{short, thousands};
use std::borrow::Cow;

/// Width and height of a chart of lines \[pixels\].
const PANEL: Place = (560.0, 330.0);
/// Height of a bar with the space around it, of what surrounds a chart of bars, and of the numbers of a scale below them.
const BAR: f64 = 22.0;
const AROUND_BARS: f64 = 44.0;
const NUMBERS: f64 = 18.0;
/// Margins of a plot: above, beside and below, and at the axes.
const TITLE: f64 = 36.0;
const MARGIN: f64 = 7.0;
const AXES: Place = (40.0, 68.0);
/// Width of the names beside lines, at the least and at the most, of those before bars, and of the words behind these.
const LEGEND: [f64; 2] = [110.0, 160.0];
const NAMES: f64 = 120.0;
const WORDS: f64 = 150.0;
/// Height of a line of the legend.
const ROW: f64 = 20.0;

/// Colours that those who see few of them can tell apart (Okabe and Ito, "Color Universal Design", 2008), and some more.
const PALETTE: [&str; 14] = [
    "#555555", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#999933", "#332288",
    "#aa4400", "#005a32", "#44aa99", "#781c81",
];
const FAINT: &str = "#e1e1e1";
const ALARM: &str = "#c81e1e";

/// A chart of its own.
pub(crate) struct Chart<'a> {
    /// Its subject: the part of a report in which it stands.
    pub(crate) of: String,
    pub(crate) title: String,
    pub(crate) kind: Kind<'a>,
    size: Place,
}

/// The content of a chart.
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

/// The style of a line.
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
    /// The quantity, with its unit.
    pub(crate) name: &'static str,
    /// True if equal lengths are equal factors; else it begins at zero.
    pub(crate) is_log: bool,
    /// From where to where it goes, if not as far as what is drawn.
    pub(crate) ends: Option<[f64; 2]>,
    /// Places of numbers; if there are none, round ones.
    pub(crate) ticks: Vec<f64>,
    /// The way in which these are written.
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
            return Some(Scale { ends: [low, high], is_log: self.is_log, ticks: even_ticks(low, high) });
        }
        let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        if !(high > 0.0) {
            return None;
        }
        let (low, high) = if self.is_log { (low / margin, high * margin) } else { (0.0, high) };
        let mut ticks = match self.is_log {
            _ if !self.ticks.is_empty() => self.ticks.clone(),
            true => ticks(low, high),
            false => even_ticks(low, high),
        };
        ticks.retain(|tick| (low..=high).contains(tick));
        Some(Scale { ends: [low, high], is_log: self.is_log, ticks })
    }
}

/// Values and their places on paper.
#[derive(Debug)]
struct Scale {
    ends: [f64; 2],
    is_log: bool,
    ticks: Vec<f64>,
}

impl Scale {
    /// That of bars: from zero, or logarithmic from a power of ten where a long one would squash the others.
    fn of(bars: &[Bar<'_>]) -> Self {
        /// Times the shortest of some bars from which on a longer one would.
        const SQUASHED: f64 = 10.0;
        let longest = bars.iter().map(|bar| bar.parts[0] + bar.parts[1]).fold(0.0f64, f64::max);
        let shortest = bars.iter().map(|bar| bar.parts[0]).filter(|part| *part > 0.0).fold(f64::INFINITY, f64::min);
        let low = 10f64.powf((shortest / 1.5).log10().floor());
        match longest > SQUASHED * shortest {
            true => Self { ends: [low, longest], is_log: true, ticks: powers(low, longest).collect() },
            false => Self { ends: [0.0, longest], is_log: false, ticks: Vec::new() },
        }
    }

    /// The place of a value as a part of the way between the ends.
    fn share(&self, value: f64) -> f64 {
        let place = |value: f64| if self.is_log { value.log10() } else { value };
        let [low, high] = self.ends.map(place);
        if high > low { (place(value) - low) / (high - low) } else { 0.0 }
    }
}

impl<'a> Chart<'a> {
    /// Lines; what is not above zero has no place on a logarithmic scale and must not be among them.
    pub(crate) fn of_lines(of: &str, title: String, lines: Vec<Line<'a>>, axes: [Axis; 2]) -> Self {
        Self { of: of.into(), title, kind: Kind::Lines(lines, Box::new(axes)), size: PANEL }
    }

    /// Bars, from the top down.
    pub(crate) fn of_bars(of: &str, title: String, bars: Vec<Bar<'a>>) -> Self {
        let numbers = if Scale::of(&bars).is_log { NUMBERS } else { 0.0 };
        let size = (PANEL.0, AROUND_BARS + BAR * bars.len() as f64 + numbers);
        Self { of: of.into(), title, kind: Kind::Bars(bars), size }
    }

    /// The same, so many pixels wide and high.
    pub(crate) fn sized(self, size: Place) -> Self {
        Self { size, ..self }
    }

    /// Height over width of the plot itself in a chart of so many pixels, beside names as long as they may be.
    pub(crate) fn aspect((width, height): Place) -> f64 {
        (height - TITLE - MARGIN - AXES.0) / (width - LEGEND[1] - 2.0 * MARGIN - AXES.1)
    }

    /// As a picture of its own.
    pub(crate) fn svg(&self) -> String {
        self.drawn().picture(self.size)
    }

    fn drawn(&self) -> Svg {
        let mut svg = Svg::default();
        svg.title(&self.title, (12.0, 17.0));
        match &self.kind {
            Kind::Lines(lines, axes) => draw_lines(&mut svg, lines, axes, self.size),
            Kind::Bars(bars) => draw_bars(&mut svg, bars),
        }
        svg
    }
}

/// All charts in one picture.
pub(crate) fn all(charts: &[Chart<'_>]) -> String {
    const COLUMNS: usize = 2;
    let width = charts.iter().map(|chart| chart.size.0).fold(0.0, f64::max);
    let (mut picture, mut top) = (Svg::default(), 0.0);
    for row in charts.chunks(COLUMNS) {
        for (column, chart) in row.iter().enumerate() {
            picture.add((column as f64 * width, top), &chart.drawn());
        }
        top += row.iter().map(|chart| chart.size.1).fold(0.0, f64::max);
    }
    let size = (COLUMNS as f64 * width, top);
    let mut paper = Svg::default();
    paper.area([(0.0, 0.0), (size.0, 0.0), size, (0.0, size.1)], "#ffffff", 1.0);
    paper.add((0.0, 0.0), &picture);
    paper.picture(size)
}

fn draw_lines(svg: &mut Svg, lines: &[Line<'_>], [x_axis, y_axis]: &[Axis; 2], (width, height): Place) {
    let dots = || lines.iter().flat_map(|line| &line.dots);
    let scales = x_axis.scale(dots().map(|dot| dot.0), 1.15).zip(y_axis.scale(dots().map(|dot| dot.1), 1.25));
    let Some((x, y)) = scales else { return };
    let longest = lines.iter().map(|line| line.name.chars().count()).max().unwrap_or(0);
    let legend = width - (35.0 + 7.0 * longest.min(18) as f64).clamp(LEGEND[0], LEGEND[1]);
    let ([left, right], [top, bottom]) = ([MARGIN + AXES.1, legend - MARGIN], [TITLE, height - MARGIN - AXES.0]);
    let place = |&(a, b): &(f64, f64)| (left + x.share(a) * (right - left), bottom - y.share(b) * (bottom - top));
    for &tick in &x.ticks {
        let (at, _) = place(&(tick, y.ends[0]));
        svg.hairline([(at, top), (at, bottom)], FAINT);
        svg.words(&(x_axis.format)(tick), (at, bottom + 12.0), "middle");
    }
    for &tick in &y.ticks {
        let (_, at) = place(&(x.ends[0], tick));
        svg.hairline([(left, at), (right, at)], FAINT);
        svg.words(&(y_axis.format)(tick), (left - 6.0, at), "end");
    }
    svg.hairline([(left, top), (left, bottom), (right, bottom)], INK);
    svg.words(x_axis.name, (0.5 * (left + right), height - MARGIN - 8.0), "middle");
    svg.upwards(y_axis.name, (MARGIN + 8.0, 0.5 * (top + bottom)));
    for line in lines {
        line.draw(svg, line.dots.iter().map(place).collect());
    }
    draw_legend(svg, legend, lines, longest.min(18));
}

fn draw_legend(svg: &mut Svg, left: f64, lines: &[Line<'_>], longest: usize) {
    let mut y = TITLE + 0.5 * ROW;
    for line in lines.iter().filter(|line| !line.name.is_empty()) {
        if line.dots.is_empty() {
            svg.words(&line.name, (left, y), "start");
        } else {
            if !matches!(line.style, Style::Dots { .. }) {
                svg.line([(left, y), (left + ROW, y)], line.color());
            }
            if !matches!(line.style, Style::Around(_)) {
                line.mark(svg, (left + 0.5 * ROW, y));
            }
            svg.words(&shown(&line.name, longest.max(13)), (left + 1.25 * ROW, y), "start");
        }
        y += ROW;
    }
}

impl Line<'_> {
    fn color(&self) -> &'static str {
        match self.style {
            Style::Dots { alarm: true } => ALARM,
            Style::Dots { alarm: false } => INK,
            _ => PALETTE[self.look % PALETTE.len()],
        }
    }

    fn draw(&self, svg: &mut Svg, places: Vec<Place>) {
        /// Dots that stand closer together have no marks: the line says enough.
        const MOST: usize = 20;
        match self.style {
            Style::Around(fill) if fill > 0.0 => svg.area(places.iter().copied(), self.color(), fill),
            _ => {}
        }
        if matches!(self.style, Style::Dots { .. }) || self.style == Style::Marked && places.len() <= MOST {
            places.iter().for_each(|&at| self.mark(svg, at));
        }
        match self.style {
            Style::Dots { .. } => {}
            _ if self.name.is_empty() => svg.hairline(places, self.color()),
            _ => svg.line(places, self.color()),
        }
    }

    /// Marks a line's dots, so that lines are told apart without colours too.
    fn mark(&self, svg: &mut Svg, at: Place) {
        match self.style {
            Style::Dots { .. } => svg.dot(at, self.color(), 0.75),
            _ => svg.mark(self.look, at, self.color()),
        }
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

fn draw_bars(svg: &mut Svg, bars: &[Bar<'_>]) {
    const GAP: f64 = 3.0;
    let scale = Scale::of(bars);
    let place = |value: f64| NAMES + scale.share(value).max(0.0) * (PANEL.0 - NAMES - WORDS - ROW);
    let bottom = TITLE + BAR * bars.len() as f64;
    for &tick in &scale.ticks {
        svg.hairline([(place(tick), TITLE), (place(tick), bottom)], FAINT);
        svg.words(&self::tick(tick), (place(tick), bottom + 3.0 * GAP), "middle");
    }
    for (i, bar) in bars.iter().enumerate() {
        let color = PALETTE[bar.look % PALETTE.len()];
        let top = TITLE + BAR * i as f64;
        let (bottom, middle) = (top + BAR - 2.0 * GAP, top + 0.5 * BAR - GAP);
        let [b, c] = [bar.parts[0], bar.parts[0] + bar.parts[1]].map(place);
        for (from, to, fill) in [(NAMES, b, 1.0), (b, c, 0.35)] {
            svg.area([(from, top), (to, top), (to, bottom), (from, bottom)], color, fill);
        }
        svg.words(&shown(bar.name, 15), (NAMES - 2.0 * GAP, middle), "end");
        svg.words(&bar.label, (c + 2.0 * GAP, middle), "start");
    }
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
        let even = Scale::of(&bars(&[10.0, 20.0]));
        assert!(!even.is_log && even.share(10.0) == 0.5);
        let log = Scale::of(&bars(&[20.0, 2e5]));
        assert!(log.is_log && log.ends == [10.0, 2e5] && log.ticks.len() == 5, "{log:?}");
        assert!((log.share(20.0) - 0.07).abs() < 0.001 && log.share(2e5) == 1.0 && log.share(0.0) < 0.0);
        assert_eq!(Scale::of(&[]).share(1.0), 0.0);
    }
}
