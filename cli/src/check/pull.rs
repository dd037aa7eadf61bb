//! The pull of sinks, which changes the faster the nearer to their surfaces.

use super::body::Body;
use super::words::{plain, time};
use pointmass::Sink;
use pointmass::scene::Model;
use serde::Serialize;

/// A sink whose pull changes from place to place.
#[derive(Debug, Serialize)]
pub(crate) struct Pull {
    /// Its place in the file.
    pub(crate) place: String,
    /// The steepest change of its pull with distance \[N/m\], or a bound on it; infinite where the pull is.
    pub(crate) gradient: f64,
    /// The distance from its surface at which the pull is infinite \[m\], if there is one.
    pub(crate) infinite_at: Option<f64>,
    /// The lightest mass that it may pull \[kg\].
    pub(crate) mass: f64,
    /// √(gradient / mass) \[1/s\].
    pub(crate) rate: f64,
}

impl Pull {
    /// Those of a scene's sinks that change.
    pub(crate) fn all(model: &Model, bodies: &[Body]) -> Vec<Self> {
        let mass = bodies.iter().filter(|body| body.is_free()).map(|body| body.mass[0]).fold(f64::INFINITY, f64::min);
        let pull = |(i, sink): (usize, &Sink<_>)| {
            let law = Law::of(sink);
            let (gradient, infinite_at) = (law.steepest(), law.infinite_at());
            let rate = (gradient / mass).sqrt();
            (rate > 0.0).then(|| Self { place: format!("sinks[{i}]"), gradient, infinite_at, mass, rate })
        };
        model.forces.1.iter().enumerate().filter_map(pull).collect()
    }

    /// How steep it is, in words.
    pub(crate) fn told(&self) -> String {
        match self.infinite_at {
            Some(0.0) => "its pull has no bound at its surface".into(),
            Some(distance) => format!("its pull has no bound {} m from its surface", plain(distance)),
            None => {
                let (gradient, mass, within) = (plain(self.gradient), plain(self.mass), time(1.0 / self.rate));
                format!("its pull changes by up to {gradient} N/m, so that of {mass} kg within {within}")
            }
        }
    }

    /// The advice on one that has no bound.
    pub(crate) fn without_bound(&self) -> Option<String> {
        let Self { place, infinite_at, .. } = self;
        infinite_at.map(|distance| match distance {
            0.0 => format!("{place} pulls without bound at its surface: give it a softening, or a ca above zero"),
            _ => format!(
                "{place} pulls without bound {} m from its surface, where ca + la D + qa D² is zero: give it others",
                plain(distance)
            ),
        })
    }
}

/// The pull at a distance d from a surface: f = I d / (D R), R = c + b D + a D², D² = d² + s².
struct Law {
    intensity: f64,
    /// The terms c, b and a of R.
    terms: [f64; 3],
    softening: f64,
}

impl Law {
    fn of<M>(sink: &Sink<M>) -> Self {
        let [intensity, softening] = [sink.intensity, sink.softening].map(|x| f64::from(x).abs());
        let terms = [sink.ca, sink.la, sink.qa].map(f64::from);
        // What divides by nothing but zeros pulls nobody.
        Self { intensity: if terms == [0.0; 3] { 0.0 } else { intensity }, terms, softening }
    }

    /// R at a distance D.
    fn resistance(&self, d: f64) -> f64 {
        let [c, b, a] = self.terms;
        c + (b + a * d) * d
    }

    /// |d(1/R)/dD| at a distance D.
    fn slope(&self, d: f64) -> f64 {
        let [_, b, a] = self.terms;
        (b + 2.0 * a * d).abs() / self.resistance(d).powi(2)
    }

    /// The least D ≥ s at which R is zero, or changes its sign.
    fn pole(&self) -> Option<f64> {
        let [c, b, a] = self.terms;
        let root = (b * b - 4.0 * a * c).sqrt();
        // Of both roots each in the form that does not subtract what is nearly equal; without a the second is the only one.
        let sum = -0.5 * (b + if b < 0.0 { -root } else { root });
        let poles = [sum / a, c / sum, if c == 0.0 { 0.0 } else { f64::NAN }];
        poles.into_iter().filter(|pole| pole.is_finite() && *pole >= self.softening).reduce(f64::min)
    }

    /// The distance from the surface at which the pull is infinite \[m\].
    fn infinite_at(&self) -> Option<f64> {
        let pole = self.pole().filter(|_| self.intensity > 0.0)?;
        Some((pole * pole - self.softening * self.softening).max(0.0).sqrt())
    }

    /// The largest |df/dd|, d ≥ 0 \[N/m\]. With df/dd = I (s² / (D³ R) − (1 − s²/D²) R' / R²):
    /// - not softened it is the largest slope of 1/R: at the surface, or where the second derivative is zero, at
    ///   6 a D = −3 b ± √(12 a c − 3 b²);
    /// - softened, of terms of one sign, it is I / (s R(s)), the change at the surface: the first term is nowhere larger, and the second, with
    ///   D R' ≤ 2 R, nowhere more than 4 / √27 of it;
    /// - softened, of terms of both signs, both at their largest bound it, which may be many times what it is where R is nearly zero.
    fn steepest(&self) -> f64 {
        if self.intensity == 0.0 {
            return 0.0;
        }
        if self.pole().is_some() {
            return f64::INFINITY;
        }
        let ([c, b, a], s) = (self.terms, self.softening);
        let is_beyond = |d: &f64| d.is_finite() && *d > s;
        let root = (12.0 * a * c - 3.0 * b * b).sqrt();
        let bends = [root, -root].map(|root| (root - 3.0 * b) / (6.0 * a));
        let straight = bends.into_iter().filter(is_beyond).map(|d| self.slope(d)).fold(self.slope(s), f64::max);
        if s == 0.0 {
            return self.intensity * straight;
        }
        let least = Some(-0.5 * b / a).filter(is_beyond).map_or(f64::INFINITY, |d| self.resistance(d).abs());
        let soft = 1.0 / (s * least.min(self.resistance(s).abs()));
        let is_of_one_sign = self.terms.iter().all(|x| *x >= 0.0) || self.terms.iter().all(|x| *x <= 0.0);
        self.intensity * if is_of_one_sign { soft } else { soft + straight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest |df/dd| among many distances, by differences of the pull itself.
    fn searched(law: &Law) -> f64 {
        let pull = |d: f64| {
            let long = d.hypot(law.softening);
            law.intensity * d / (long * law.resistance(long))
        };
        let slope = |d: f64| {
            let more = 1e-5 * d.max(1e-3);
            ((pull(d + more) - pull(d)) / more).abs()
        };
        // At the surface itself what is not softened has no direction.
        let distances = (0..2000).map(|i| 1e-5 * 1e10f64.powf(f64::from(i) / 2e3));
        distances.chain([1e-12]).map(slope).fold(0.0, f64::max)
    }

    /// All laws of such terms, their softening the last.
    fn laws(terms: [[f64; 5]; 3], softening: [f64; 5]) -> impl Iterator<Item = Law> {
        let all =
            (0..625).map(move |i| [terms[0][i % 5], terms[1][i / 5 % 5], terms[2][i / 25 % 5], softening[i / 125]]);
        let pulls = all.filter(|[c, b, a, _]| [*c, *b, *a] != [0.0; 3]);
        pulls.map(|[c, b, a, softening]| Law { intensity: 10.0, terms: [c, b, a], softening })
    }

    #[test]
    fn the_steepest_change_is_that_of_the_pull() {
        let [coarse, fine] = [[0.0, 0.01, 0.3, 2.0, 100.0], [0.0, 0.01, 0.5, 1.0, 50.0]];
        for law in laws([coarse, coarse, fine], fine) {
            let (told, at, [c, b, a], s) = (law.steepest(), law.infinite_at(), law.terms, law.softening);
            let is_bound = c > 0.0 || s > 0.0;
            assert_eq!((told.is_finite(), at), (is_bound, (!is_bound).then_some(0.0)), "{c} {b} {a}, {s}");
            let found = if is_bound { searched(&law) } else { told };
            assert!(!is_bound || (found - told).abs() < 1e-3 * told + 1e-4, "{c} {b} {a}, {s}: {told}, not {found}");
        }
    }

    #[test]
    fn terms_of_both_signs_are_bounded_too() {
        let terms = [-3.0, -0.1, 0.0, 0.2, 2.0];
        let mut bounded = 0;
        for law in laws([terms; 3], [0.0, 0.01, 0.3, 1.0, 5.0]) {
            let (told, at, [c, b, a], s) = (law.steepest(), law.infinite_at(), law.terms, law.softening);
            assert_eq!(told.is_finite(), at.is_none(), "{c} {b} {a}, {s}: {told} {at:?}");
            let Some(at) = at else {
                let found = searched(&law);
                assert!(found <= told * (1.0 + 1e-3) + 1e-4, "{c} {b} {a}, {s}: {told}, not {found}");
                bounded += 1;
                continue;
            };
            let least = law.resistance(at.hypot(s)).abs();
            assert!(least < 1e-9 * (c.abs() + b.abs() * at + a.abs() * at * at).max(1.0), "{c} {b} {a}, {s}: {at}");
        }
        assert!(bounded > 200, "{bounded}");
    }
}
