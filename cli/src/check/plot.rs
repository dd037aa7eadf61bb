//! Charts of where methods are stable, and where a scene's oscillations lie.
//!
//! One chart shows the plane of hλ, λ being the rates of the solutions e^{λt}: a method whose step multiplies them by R(hλ)
//! is stable where |R| ≤ 1. The other shows hω against the damping ratio, for methods that have no such factor as well.

use super::words::time;
use crate::report::plot::{Axis, Chart, Line, Style};
use nalgebra::Complex;
use pointmass::Method;
use pointmass::stability::{Limit, Mode, Scheme};

/// Width and height of each chart, in pixels.
const SIZE: (u32, u32) = (640, 560);

/// The content of pictures: oscillations, stepped by a method in steps of `dt` \[s\].
pub(crate) struct Scenery {
    pub(crate) modes: Vec<Mode>,
    pub(crate) method: Method,
    pub(crate) dt: f64,
}

/// A dot, and whether what it stands for is stable.
type Dot = ((f64, f64), bool);

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

/// The effect of methods on a linear system, by the first that does it, and the look of its line.
fn schemes() -> Vec<(Scheme, Method, usize)> {
    let mut schemes: Vec<(Scheme, Method, usize)> = Vec::new();
    for (&method, look) in Method::ALL.iter().zip(1..) {
        if schemes.iter().all(|(scheme, ..)| *scheme != method.scheme()) {
            schemes.push((method.scheme(), method, look));
        }
    }
    schemes
}

/// A line without marks.
fn plain(name: &str, look: usize, dots: Vec<(f64, f64)>) -> Line<'static> {
    Line { style: Style::Around(0.0), ..Line::new(name.to_string(), look, dots) }
}

impl Scenery {
    /// Both charts.
    pub(crate) fn charts(&self) -> Vec<Chart<'static>> {
        vec![self.plane().sized(SIZE.0, SIZE.1), self.limits().sized(SIZE.0, SIZE.1)]
    }

    /// Rates times the step.
    fn rates(&self) -> Vec<Dot> {
        let h = self.dt;
        let of = |mode: &Mode| {
            let stable = self.is_stable(mode);
            let rates = mode.rates().map(|[re, im]| ((h * re, h * im), stable || self.is_calm([h * re, h * im])));
            // What stands still is neutral, and of no interest.
            rates.into_iter().filter(|((re, im), _)| *re != 0.0 || *im != 0.0)
        };
        self.modes.iter().flat_map(of).collect()
    }

    fn is_stable(&self, mode: &Mode) -> bool {
        mode.largest_step(self.method).admits(self.dt)
    }

    /// True of a rate that decays, which one of an oscillation that grows may.
    fn is_calm(&self, z: [f64; 2]) -> bool {
        self.method.scheme().factor(z).is_some_and(|factor| factor <= 1.0)
    }

    fn plane(&self) -> Chart<'static> {
        /// No farther than so many times the usual width is shown.
        const FARTHEST: f64 = 6.0;
        let dots = self.rates();
        let (mut left, right) = (-3.7f64, 2.3);
        let reach = dots.iter().fold(0.0f64, |reach, ((re, im), _)| reach.max(-re).max(im.abs()));
        left = left.min(-1.08 * reach).max(FARTHEST * left);
        let top = 0.5 * (right - left) * Chart::aspect(SIZE.0, SIZE.1);
        let cross = [vec![(left, 0.0), (right, 0.0)], vec![(0.0, -top), (0.0, top)]];
        let mut lines: Vec<_> = cross.into_iter().map(|dots| plain("", 0, dots)).collect();
        for (scheme, method, look) in schemes() {
            let (dots, fill, beyond) = match scheme {
                Scheme::Polynomial(coefficients) => (border(coefficients), 0.10, ""),
                // |1 − z| = 1; stable outside.
                Scheme::Implicit => (border(&[1.0, -1.0]), 0.0, " (outside)"),
                Scheme::Symplectic | Scheme::Verlet => continue,
            };
            lines.push(Line { style: Style::Around(fill), ..plain(&format!("{method}{beyond}"), look, dots) });
        }
        let is_seen = |(x, y): (f64, f64)| (left..=right).contains(&x) && (-top..=top).contains(&y);
        lines.extend(self.dots(&dots, is_seen));
        let title = format!("Steps of {}: rates hλ, and where methods are stable", time(self.dt));
        let axes = [
            Axis::between("real part of hλ: decay", [left, right]),
            Axis::between("imaginary part: swing", [-top, top]),
        ];
        Chart::of_lines("", title, lines, axes)
    }

    fn limits(&self) -> Chart<'static> {
        const CURVE: u32 = 400;
        let h = self.dt;
        let swing = self.modes.iter().filter(|mode| mode.omega2 > 0.0);
        let dots: Vec<_> = swing
            .map(|mode| ((0.5 * mode.damping / mode.omega2.sqrt(), h * mode.omega2.sqrt()), self.is_stable(mode)))
            .collect();
        let most =
            |start: f64, of: fn((f64, f64)) -> f64| dots.iter().fold(start, |most, (dot, _)| most.max(1.08 * of(*dot)));
        let (right, top) = (most(1.5, |dot| dot.0).min(20.0), most(3.2, |dot| dot.1).min(12.0));
        let mut lines = Vec::new();
        for (scheme, method, look) in schemes() {
            let limit = |i: u32| {
                let ratio = right * f64::from(i) / f64::from(CURVE);
                match scheme.largest_step(Mode { omega2: 1.0, damping: 2.0 * ratio }) {
                    Limit::Step(step) => Some((ratio, step)),
                    Limit::Never => Some((ratio, 0.0)),
                    Limit::Unconditional => None,
                }
            };
            let curve: Vec<_> = (0..=CURVE).filter_map(limit).filter(|(_, y)| *y <= top).collect();
            if !curve.is_empty() {
                lines.push(plain(method.name(), look, curve));
            }
        }
        lines.extend(self.dots(&dots, |(x, y)| x <= right && y <= top));
        let axes = [Axis::between("damping ratio", [0.0, right]), Axis::between("hω", [0.0, top])];
        Chart::of_lines("", "Stable below the line: hω against damping".into(), lines, axes)
    }

    /// The dots that can be seen, and words on the others.
    fn dots(&self, dots: &[Dot], is_seen: impl Fn((f64, f64)) -> bool) -> Vec<Line<'static>> {
        if self.modes.is_empty() {
            return vec![Line::new("no oscillations", 0, Vec::new())];
        }
        let (seen, hidden): (Vec<&Dot>, Vec<_>) = dots.iter().partition(|(dot, _)| is_seen(*dot));
        let of = |stable: bool, what: &str| {
            let dots: Vec<_> = seen.iter().filter(|dot| dot.1 == stable).map(|dot| dot.0).collect();
            let line = Line::new(format!("{}: {what}", self.method), 0, dots);
            Line { style: Style::Dots { alarm: !stable }, ..line }
        };
        let grows = self.modes.iter().any(|mode| !self.is_stable(mode)).then(|| of(false, "grows"));
        let outside = (!hidden.is_empty()).then(|| Line::new(format!("{} lie outside", hidden.len()), 0, Vec::new()));
        [of(true, "stable")].into_iter().chain(grows).chain(outside).collect()
    }
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
