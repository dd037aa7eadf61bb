//! Where methods are stable, and where a scene's oscillations lie.
//!
//! On the left the plane of hλ, λ being the rates of the solutions e^{λt}: a method whose step multiplies them by R(hλ) is
//! stable where |R| ≤ 1. On the right hω against the damping ratio, for methods that have no such factor as well.

use super::report::Check;
use super::words::time;
use crate::Outcome;
use crate::plot::{Area, FAINT, INK, PALETTE, undrawn};
use nalgebra::Complex;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, ChartBuilder, ChartContext, Circle, Color, IntoDrawingArea, IntoFont, LineSeries, PathElement,
    Polygon, RGBColor, SVGBackend, Text, TextStyle, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use pointmass::Method;
use pointmass::stability::{Limit, Mode, Scheme};

/// Units of a pixel: the library draws at whole units, which as pixels would make curves of stairs.
const FINE: u32 = 2;
/// Width and height of each half, in units as all that follow.
const HALF: (u32, u32) = (640 * FINE, 560 * FINE);
/// What surrounds a plot: above, beside the axes, and the legend's width.
const MARGIN: u32 = 8 * FINE;
const TITLE: u32 = 40 * FINE;
const AXES: (u32, u32) = (40 * FINE, 56 * FINE);
const LEGEND: u32 = 122 * FINE;
/// Letters of titles and of all else, the radius of dots, the width of lines.
const LETTERS: (u32, u32) = (17 * FINE, 14 * FINE);
const DOT: u32 = 4 * FINE;
const LINE: u32 = 2 * FINE;
/// Height of a line of the legend.
const ROW: i32 = 20 * FINE as i32;
/// Dots of what is not stable.
const ALARM: RGBColor = RGBColor(200, 30, 30);

type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// What is drawn: oscillations, stepped by `dt`.
pub(crate) struct Scenery<'a> {
    pub(crate) check: &'a Check,
    pub(crate) modes: Vec<Mode>,
    pub(crate) method: Method,
}

/// A line of the legend.
struct Entry {
    name: String,
    color: RGBColor,
}

/// The picture.
///
/// # Errors
/// If it cannot be drawn.
pub(crate) fn svg(scenery: &Scenery<'_>) -> Outcome<String> {
    let mut picture = String::new();
    {
        let root = SVGBackend::with_string(&mut picture, (2 * HALF.0, HALF.1)).into_drawing_area();
        root.fill(&WHITE).map_err(undrawn)?;
        let (left, right) = root.split_horizontally(HALF.0);
        scenery.draw_plane(&left)?;
        scenery.draw_limits(&right)?;
        root.present().map_err(undrawn)?;
    }
    // The same picture in pixels.
    let size = |unit: u32| format!("width=\"{}\" height=\"{}\"", 2 * HALF.0 / unit, HALF.1 / unit);
    Ok(picture.replacen(&size(1), &size(FINE), 1))
}

/// The border of where |R(z)| ≤ 1, from the origin around: the solutions of R(z) = e^{iθ}, each found by Newton's method
/// from the one before.
fn border(coefficients: &[f64]) -> Vec<(f64, f64)> {
    const POINTS: u32 = 240;
    let degree = coefficients.len().saturating_sub(1) as u32;
    let mut z = Complex::new(0.0, 0.0);
    let point = |i: u32| {
        let target = Complex::from_polar(1.0, std::f64::consts::TAU * f64::from(i) / f64::from(POINTS));
        for _ in 0..8 {
            let horner = |(value, slope), k: &f64| (value * z + k, slope * z + value);
            let zero = Complex::new(0.0, 0.0);
            let (value, slope): (Complex<f64>, Complex<f64>) = coefficients.iter().rev().fold((zero, zero), horner);
            z -= (value - target) / slope;
        }
        (z.re, z.im)
    };
    (0..=degree * POINTS).map(point).collect()
}

/// What methods do to a linear system, by the first that does it.
fn schemes() -> Vec<(Scheme, Entry)> {
    let mut schemes: Vec<(Scheme, Entry)> = Vec::new();
    for (&method, color) in Method::ALL.iter().zip(&PALETTE[1..]) {
        if schemes.iter().all(|(scheme, _)| *scheme != method.scheme()) {
            schemes.push((method.scheme(), Entry { name: method.to_string(), color: *color }));
        }
    }
    schemes
}

impl Scenery<'_> {
    /// Rates times the step.
    fn dots(&self) -> Vec<((f64, f64), bool)> {
        let h = self.check.dt;
        let of = |mode: &Mode| {
            let stable = self.is_stable(mode);
            let rates = mode.rates().map(|[re, im]| ((h * re, h * im), stable || self.is_calm([h * re, h * im])));
            // What stands still is neutral, and of no interest.
            rates.into_iter().filter(|((re, im), _)| *re != 0.0 || *im != 0.0)
        };
        self.modes.iter().flat_map(of).collect()
    }

    fn is_stable(&self, mode: &Mode) -> bool {
        mode.largest_step(self.method).admits(self.check.dt)
    }

    /// Of an oscillation that grows, one rate may still decay.
    fn is_calm(&self, z: [f64; 2]) -> bool {
        self.method.scheme().factor(z).is_some_and(|factor| factor <= 1.0)
    }

    fn draw_plane(&self, area: &Area<'_>) -> Outcome {
        /// No farther than so many times the usual width is shown.
        const FARTHEST: f64 = 6.0;
        let dots = self.dots();
        let (mut left, right) = (-3.7f64, 2.3);
        let reach = dots.iter().fold(0.0f64, |reach, ((re, im), _)| reach.max(-re).max(im.abs()));
        left = left.min(-1.08 * reach).max(FARTHEST * left);
        let size = (HALF.0 - LEGEND - 2 * MARGIN - AXES.1, HALF.1 - TITLE - MARGIN - AXES.0);
        let top = 0.5 * (right - left) * f64::from(size.1) / f64::from(size.0);
        let title = format!("Steps of {}: rates hλ, and where methods are stable", time(self.check.dt));
        let (plot, legend) = area.split_horizontally(HALF.0 - LEGEND);
        let mut chart = framed(
            area,
            &plot,
            &title,
            [left, right],
            [-top, top],
            ["real part of hλ: decay", "imaginary part: swing"],
        )?;
        let line = |from, to| LineSeries::new([from, to], INK.mix(0.5).stroke_width(LINE / 2));
        chart.draw_series(line((left, 0.0), (right, 0.0))).map_err(undrawn)?;
        chart.draw_series(line((0.0, -top), (0.0, top))).map_err(undrawn)?;
        let mut entries = Vec::new();
        for (scheme, entry) in schemes() {
            let (around, fill) = match scheme {
                Scheme::Polynomial(coefficients) => (border(coefficients), 0.10),
                // |1 − z| = 1; stable outside.
                Scheme::Implicit => (border(&[1.0, -1.0]), 0.0),
                Scheme::Symplectic | Scheme::Verlet => continue,
            };
            chart.draw_series([Polygon::new(around.clone(), entry.color.mix(fill))]).map_err(undrawn)?;
            chart.draw_series(LineSeries::new(around, entry.color.stroke_width(LINE))).map_err(undrawn)?;
            let beyond = if scheme == Scheme::Implicit { " (outside)" } else { "" };
            entries.push(Entry { name: entry.name + beyond, color: entry.color });
        }
        let is_seen = |(x, y): (f64, f64)| (left..=right).contains(&x) && (-top..=top).contains(&y);
        let hidden = draw_dots(&mut chart, &dots, is_seen)?;
        draw_legend(&legend, &entries, self, hidden)
    }

    fn draw_limits(&self, area: &Area<'_>) -> Outcome {
        const CURVE: u32 = 400;
        let h = self.check.dt;
        let swing = self.modes.iter().filter(|mode| mode.omega2 > 0.0);
        let dots: Vec<_> = swing
            .map(|mode| ((0.5 * mode.damping / mode.omega2.sqrt(), h * mode.omega2.sqrt()), self.is_stable(mode)))
            .collect();
        let most =
            |start: f64, of: fn((f64, f64)) -> f64| dots.iter().fold(start, |most, (dot, _)| most.max(1.08 * of(*dot)));
        let (right, top) = (most(1.5, |dot| dot.0).min(20.0), most(3.2, |dot| dot.1).min(12.0));
        let (plot, legend) = area.split_horizontally(HALF.0 - LEGEND);
        let title = "Stable below the line: hω against damping";
        let mut chart = framed(area, &plot, title, [0.0, right], [0.0, top], ["damping ratio", "hω"])?;
        let mut entries = Vec::new();
        for (scheme, entry) in schemes() {
            let limit = |i: u32| {
                let ratio = right * f64::from(i) / f64::from(CURVE);
                match scheme.largest_step(Mode { omega2: 1.0, damping: 2.0 * ratio }) {
                    Limit::Step(step) => Some((ratio, step)),
                    Limit::Never => Some((ratio, 0.0)),
                    Limit::Unconditional => None,
                }
            };
            let curve: Vec<_> = (0..=CURVE).filter_map(limit).filter(|(_, y)| *y <= top).collect();
            if curve.is_empty() {
                continue;
            }
            chart.draw_series(LineSeries::new(curve, entry.color.stroke_width(LINE))).map_err(undrawn)?;
            entries.push(entry);
        }
        let hidden = draw_dots(&mut chart, &dots, |(x, y)| x <= right && y <= top)?;
        draw_legend(&legend, &entries, self, hidden)
    }
}

/// Axes under a title.
fn framed<'a, 'b>(
    area: &Area<'b>,
    plot: &'a Area<'b>,
    title: &str,
    [left, right]: [f64; 2],
    [bottom, top]: [f64; 2],
    [x, y]: [&str; 2],
) -> Outcome<Plot<'a, 'b>> {
    let large = TextStyle::from(("sans-serif", LETTERS.0).into_font()).color(&INK);
    area.draw(&Text::new(title.to_string(), (ROW / 2, ROW / 2), large)).map_err(undrawn)?;
    let mut chart = ChartBuilder::on(plot)
        .margin_top(TITLE)
        .margin_right(MARGIN)
        .margin_left(MARGIN)
        .margin_bottom(MARGIN)
        .x_label_area_size(AXES.0)
        .y_label_area_size(AXES.1)
        .build_cartesian_2d(left..right, bottom..top)
        .map_err(undrawn)?;
    let small = TextStyle::from(("sans-serif", LETTERS.1).into_font()).color(&INK);
    chart
        .configure_mesh()
        .x_desc(x)
        .y_desc(y)
        .label_style(small.clone())
        .axis_desc_style(small)
        .bold_line_style(FAINT.stroke_width(LINE / 2))
        .axis_style(INK.stroke_width(LINE / 2))
        .light_line_style(WHITE.mix(0.0))
        .x_label_formatter(&|x| super::words::plain(round(*x)))
        .y_label_formatter(&|y| super::words::plain(round(*y)))
        .draw()
        .map_err(undrawn)?;
    Ok(chart)
}

/// A tick without what rounding adds to zero.
fn round(x: f64) -> f64 {
    (x * 1e6).round() / 1e6
}

/// Draws those dots that can be seen; how many cannot.
fn draw_dots(
    chart: &mut Plot<'_, '_>,
    dots: &[((f64, f64), bool)],
    is_seen: impl Fn((f64, f64)) -> bool,
) -> Outcome<usize> {
    let (seen, hidden): (Vec<_>, Vec<_>) = dots.iter().partition(|(dot, _)| is_seen(*dot));
    let circle = |(dot, stable): &((f64, f64), bool)| Circle::new(*dot, DOT, color(*stable).mix(0.75).filled());
    chart.draw_series(seen.into_iter().map(circle)).map_err(undrawn)?;
    Ok(hidden.len())
}

fn color(stable: bool) -> RGBColor {
    if stable { INK } else { ALARM }
}

fn draw_legend(area: &Area<'_>, entries: &[Entry], scenery: &Scenery<'_>, hidden: usize) -> Outcome {
    let small = TextStyle::from(("sans-serif", LETTERS.1).into_font()).color(&INK);
    let small = small.pos(Pos::new(HPos::Left, VPos::Center));
    let mut y = TITLE as i32 + ROW / 2;
    let mut word = |text: String, mark: Option<(RGBColor, bool)>| {
        match mark {
            Some((color, true)) => area.draw(&Circle::new((ROW / 2, y), DOT, color.mix(0.75).filled())),
            Some((color, false)) => area.draw(&PathElement::new(vec![(0, y), (ROW, y)], color.stroke_width(LINE))),
            None => Ok(()),
        }
        .map_err(undrawn)?;
        area.draw(&Text::new(text, (if mark.is_some() { ROW * 13 / 10 } else { 0 }, y), small.clone()))
            .map_err(undrawn)?;
        y += ROW;
        Ok(())
    };
    entries.iter().try_for_each(|entry| word(entry.name.clone(), Some((entry.color, false))))?;
    if scenery.modes.is_empty() {
        return word("no oscillations".into(), None);
    }
    let method = scenery.method;
    word(format!("{method}: stable"), Some((color(true), true)))?;
    if scenery.modes.iter().any(|mode| !scenery.is_stable(mode)) {
        word(format!("{method}: grows"), Some((color(false), true)))?;
    }
    if hidden > 0 {
        word(format!("{hidden} lie outside"), None)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_are_where_the_factor_is_one_and_close() {
        for scheme in [Scheme::EULER, Scheme::MIDPOINT, Scheme::RK4] {
            let Scheme::Polynomial(coefficients) = scheme else { panic!() };
            let around = border(coefficients);
            for &(re, im) in &around {
                let factor = scheme.factor([re, im]).expect("a factor");
                assert!((factor - 1.0).abs() < 1e-9, "{re} {im}: {factor}");
            }
            let (first, last) = (around[0], around[around.len() - 1]);
            assert!((first.0 - last.0).hypot(first.1 - last.1) < 1e-6, "{first:?} {last:?}");
            let left = around.iter().fold(0.0f64, |left, dot| left.min(dot.0));
            let Limit::Step(limit) = scheme.largest_step(Mode { omega2: 0.0, damping: 1.0 }) else { panic!() };
            assert!((left + limit).abs() < 1e-3, "{left} {limit}");
        }
    }
}
