//! The modes of a scene's springs about the places where it starts, as if they were at rest there.
//!
//! In coordinates scaled by the roots of the masses, x'' = −K x − C x'. Each spring adds k d dᵀ to K, d being its
//! direction: at its rest length it does not pull across itself. Gravity and other forces are left out.

use super::net::{Net, ROUNDING, eigenvalues, mixed};
use super::verlet;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use pointmass::stability::{Limit, Mode, Scheme};
use pointmass::{Method, Particle, Spring};

/// Coordinates up to which all modes are worked out.
const MOST_EQUAL: usize = 600;
/// The same where damping does not go with stiffness.
const MOST_UNEQUAL: usize = 360;
/// Coordinates up to which Verlet's step is worked out exactly then.
const MOST_VERLET: usize = 120;

/// The extent of what was worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum How {
    /// All modes: damping goes with stiffness, so that they are independent of each other.
    Independent,
    /// All eigenvalues of the damped problem, whose modes are not independent.
    Coupled,
    /// The direction that limits the step alone, since there are too many.
    Extreme,
}

/// The modes of a scene's springs.
pub(crate) struct Spectrum {
    pub(crate) how: How,
    /// All that move; of coupled ones, one for each pair of complex rates and one for each real rate; of extreme ones, the
    /// fastest.
    pub(crate) modes: Vec<Mode>,
    net: Net,
}

impl Spectrum {
    /// The spectrum of a scene's start, in which drag acts. None if no spring holds what can move.
    pub(crate) fn of(particles: &[Particle], springs: &[Spring]) -> Option<Self> {
        let net = Net::of(particles, springs);
        if net.bars.is_empty() {
            return None;
        }
        let (how, modes) = if net.len() > MOST_EQUAL {
            (How::Extreme, vec![net.top([1.0, 0.0])])
        } else {
            let [k, c] = net.both();
            if is_proportional(&k, &c) {
                (How::Independent, independent(&k, &c))
            } else if let Some(modes) = (k.nrows() <= MOST_UNEQUAL).then(|| coupled(&k, &c)).flatten() {
                (How::Coupled, modes)
            } else {
                (How::Extreme, vec![net.top([1.0, 0.0])])
            }
        };
        Some(Self { how, modes, net })
    }

    /// The largest stable step.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        let has_factor = !matches!(method.scheme(), Scheme::Symplectic | Scheme::Verlet);
        match self.how {
            How::Independent => self.of_all(method),
            How::Coupled if has_factor => self.of_all(method),
            How::Coupled if method.scheme() == Scheme::Verlet => self.verlet_step(method),
            How::Coupled | How::Extreme => self.net.critical_step(method),
        }
    }

    /// True if that is no more than an estimate.
    pub(crate) fn is_estimate(&self, method: Method) -> bool {
        let is_verlet = method.scheme() == Scheme::Verlet;
        match self.how {
            How::Independent => false,
            How::Coupled => is_verlet && self.net.len() > MOST_VERLET,
            How::Extreme => method.scheme() != Scheme::Symplectic,
        }
    }

    /// The longest step by the whole step's matrix, unless that is too large.
    fn verlet_step(&self, method: Method) -> Limit {
        let estimate = self.net.critical_step(method).and(self.of_all(method));
        match estimate {
            Limit::Step(step) if self.net.len() <= MOST_VERLET => {
                let [k, c] = self.net.both();
                Limit::Step(verlet::largest_step(&k, &c, 1.5 * step).unwrap_or(step))
            }
            other => other,
        }
    }

    fn of_all(&self, method: Method) -> Limit {
        self.modes.iter().fold(Limit::Unconditional, |least, mode| least.and(mode.largest_step(method)))
    }

    /// The one with the largest |λ|.
    pub(crate) fn fastest(&self) -> Mode {
        let speed = |mode: &Mode| mode.rates().iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f64::max);
        self.modes.iter().copied().max_by(|a, b| speed(a).total_cmp(&speed(b))).unwrap_or_default()
    }
}

/// True if both have the same eigenvectors: then they commute.
fn is_proportional(k: &DMatrix<f64>, c: &DMatrix<f64>) -> bool {
    /// Numbers in files are rounded; the error of a mode's damping is of the square of this.
    const ROUNDED: f64 = 1e-4;
    (k * c - c * k).norm() <= ROUNDED * k.norm() * c.norm()
}

/// The modes of two matrices that commute: the eigenvectors of a mixture are those of each.
fn independent(k: &DMatrix<f64>, c: &DMatrix<f64>) -> Vec<Mode> {
    let eigen = SymmetricEigen::new(mixed(k, c));
    let along = |m: &DMatrix<f64>, v: &DVector<f64>| snapped(v.dot(&(m * v)), m.norm());
    let vectors = eigen.eigenvectors.column_iter().map(|v| v.clone_owned());
    let modes = vectors.map(|v| Mode { omega2: along(k, &v), damping: along(c, &v) });
    modes.filter(|mode| *mode != Mode::default()).collect()
}

/// Zero, if that is what it would be without rounding.
fn snapped(value: f64, scale: f64) -> f64 {
    if value.abs() <= ROUNDING * scale { 0.0 } else { value }
}

/// The rates λ of λ² + λC + K, the eigenvalues of [0 1; −K −C], as modes that have them. None should they not be found.
fn coupled(k: &DMatrix<f64>, c: &DMatrix<f64>) -> Option<Vec<Mode>> {
    let n = k.nrows();
    // In units of time in which K and C are about as large as 1.
    let rate = k.norm().sqrt().max(c.norm());
    let mut companion = DMatrix::zeros(2 * n, 2 * n);
    companion.view_mut((0, n), (n, n)).fill_with_identity();
    companion.view_mut((n, 0), (n, n)).copy_from(&(k / -(rate * rate)));
    companion.view_mut((n, n), (n, n)).copy_from(&(c / -rate));
    let rates = eigenvalues(&companion)?;
    let mut modes = Vec::new();
    for z in rates.iter() {
        // Neutral directions have the double rate zero, which rounding splits by its root.
        if z.norm() <= ROUNDING.sqrt() || z.im < 0.0 {
            continue;
        }
        let re = rate * snapped(z.re, 1.0);
        modes.push(match snapped(z.im, 1.0) {
            0.0 => Mode { omega2: 0.0, damping: -re },
            im => Mode { omega2: re * re + (rate * im).powi(2), damping: -2.0 * re },
        });
    }
    Some(modes)
}
