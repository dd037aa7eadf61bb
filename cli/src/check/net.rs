//! A scene's springs as two matrices, about the places where it starts.

use nalgebra::{Complex, DMatrix, DVector, Schur, SymmetricEigen};
use pointmass::stability::{Limit, Mode};
use pointmass::{Method, Particle, Spring};

/// Parts of the largest below which a rate is rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// Numbers that the search for the largest may keep, as far as its accuracy allows.
const MOST_NUMBERS: usize = 2_000_000;

/// Springs between particles, in coordinates scaled by the roots of the masses.
pub(super) struct Net {
    pub(super) bars: Vec<Bar>,
    /// Drag over mass of every particle that is held and free \[1/s\].
    drag: Vec<f64>,
}

pub(super) struct Bar {
    /// The place among those held and free, if it is one of them, and 1/√m.
    ends: [(Option<usize>, f64); 2],
    along: [f64; 3],
    /// Stiffness and damping.
    law: [f64; 2],
}

impl Net {
    pub(super) fn of(particles: &[Particle], springs: &[Spring]) -> Self {
        let (mut place, mut drag) = (vec![None; particles.len()], Vec::new());
        let mut bars = Vec::new();
        for spring in springs {
            let [a, b] = spring.ends.map(|end| end as usize);
            let way = (wide(particles[b].position) - wide(particles[a].position)).try_normalize(0.0);
            let Some(along) = way else { continue };
            let ends = [a, b].map(|i| {
                let particle = &particles[i];
                if particle.fixed {
                    return (None, 0.0);
                }
                let mass = f64::from(particle.mass);
                let place = *place[i].get_or_insert_with(|| {
                    drag.push(f64::from(particle.drag) / mass);
                    drag.len() - 1
                });
                (Some(place), mass.sqrt().recip())
            });
            if ends.iter().any(|end| end.0.is_some()) && (spring.ks != 0.0 || spring.kd != 0.0) {
                bars.push(Bar { ends, along: along.into(), law: [spring.ks, spring.kd].map(f64::from) });
            }
        }
        Self { bars, drag }
    }

    /// Coordinates.
    pub(super) fn len(&self) -> usize {
        3 * self.drag.len()
    }

    /// (s K + t C) x.
    fn apply(&self, [s, t]: [f64; 2], x: &DVector<f64>) -> DVector<f64> {
        let mut y = DVector::from_fn(self.len(), |i, _| t * self.drag[i / 3] * x[i]);
        for Bar { ends, along, law } in &self.bars {
            let share = |(place, scale): (Option<usize>, f64)| {
                place.map_or(0.0, |place| (0..3).map(|i| along[i] * x[3 * place + i]).sum::<f64>() * scale)
            };
            let pull = (s * law[0] + t * law[1]) * (share(ends[1]) - share(ends[0]));
            for ((place, scale), sign) in ends.iter().zip([-1.0, 1.0]) {
                if let Some(place) = place {
                    (0..3).for_each(|i| y[3 * place + i] += sign * scale * pull * along[i]);
                }
            }
        }
        y
    }

    /// K and C among the directions in which something pulls.
    pub(super) fn both(&self) -> [DMatrix<f64>; 2] {
        let [k, c] = [[1.0, 0.0], [0.0, 1.0]].map(|weights| self.matrix(weights));
        let eigen = SymmetricEigen::new(mixed(&k, &c));
        let least = ROUNDING * eigen.eigenvalues.amax();
        let pulled = eigen.eigenvectors.column_iter().zip(&eigen.eigenvalues).filter(|(_, value)| value.abs() > least);
        let basis = DMatrix::from_columns(&pulled.map(|(vector, _)| vector).collect::<Vec<_>>());
        [k, c].map(|m| basis.tr_mul(&(m * &basis)))
    }

    /// s K + t C.
    fn matrix(&self, weights: [f64; 2]) -> DMatrix<f64> {
        let n = self.len();
        let unit = |j| DVector::from_fn(n, |i, _| if i == j { 1.0 } else { 0.0 });
        DMatrix::from_columns(&(0..n).map(|j| self.apply(weights, &unit(j))).collect::<Vec<_>>())
    }

    /// The direction in which s K + t C is largest, taken for a mode, by Lanczos' method ("An iteration method for the
    /// solution of the eigenvalue problem", 1950) with every vector held at right angles to all before it.
    pub(super) fn top(&self, weights: [f64; 2]) -> Mode {
        let n = self.len();
        // Of a very large scene fewer, for memory's sake.
        let most = (MOST_NUMBERS / n).clamp(16, 80).min(n);
        // Some direction that is at right angles to none: the golden ratio's multiples.
        let mut next = DVector::from_fn(n, |i, _| (i as f64 * 0.618_033_988_75).fract() - 0.5).normalize();
        let mut basis: Vec<DVector<f64>> = Vec::new();
        let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
        while basis.len() < most {
            let image = self.apply(weights, &next);
            let scale = image.norm();
            diagonal.push(image.dot(&next));
            basis.push(next);
            let rest = basis.iter().fold(image, |rest, vector| &rest - vector * rest.dot(vector));
            let rest = basis.iter().fold(rest, |rest, vector| &rest - vector * rest.dot(vector));
            let length = rest.norm();
            if !(length > ROUNDING * scale) {
                break;
            }
            beside.push(length);
            next = rest / length;
        }
        let m = diagonal.len();
        let small = DMatrix::from_fn(m, m, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => beside[i.min(j)],
            _ => 0.0,
        });
        let eigen = SymmetricEigen::new(small);
        let shares = eigen.eigenvectors.column(eigen.eigenvalues.imax());
        let direction =
            basis.iter().zip(shares.iter()).fold(DVector::zeros(n), |sum, (vector, share)| sum + vector * *share);
        self.along(&direction)
    }

    /// A direction taken for a mode.
    fn along(&self, direction: &DVector<f64>) -> Mode {
        let [omega2, damping] = [[1.0, 0.0], [0.0, 1.0]].map(|w| direction.dot(&self.apply(w, direction)));
        Mode { omega2, damping }
    }

    /// The largest step for the direction in which h² K + 2h C is largest at that step h.
    ///
    /// For symplectic Euler this is exact: x(t+h) − 2x(t) + x(t−h) = −hC (x(t) − x(t−h)) − h² K x(t) first grows by turning its
    /// sign, x(t+h) = −x(t), where h² K + 2h C has the eigenvalue 4. For others it is an estimate.
    pub(super) fn critical_step(&self, method: Method) -> Limit {
        let mut limit = self.top([1.0, 0.0]).largest_step(method);
        for _ in 0..30 {
            let h = match limit {
                Limit::Step(h) => h,
                _ => return limit,
            };
            limit = self.top([h * h, 2.0 * h]).largest_step(method);
            if matches!(limit, Limit::Step(better) if (better - h).abs() < 1e-6 * h) {
                break;
            }
        }
        limit
    }
}

/// A sum of both that has no more equal eigenvalues than it must, and turns to zero what both do.
pub(super) fn mixed(k: &DMatrix<f64>, c: &DMatrix<f64>) -> DMatrix<f64> {
    if c.norm() > 0.0 { k + c * (0.618 * k.norm().max(c.norm()) / c.norm()) } else { k.clone() }
}

/// All eigenvalues of a square matrix, by iterations that give up the last digits where they do not come to rest. None if
/// they do not at all.
pub(super) fn eigenvalues(m: &DMatrix<f64>) -> Option<DVector<Complex<f64>>> {
    /// Rounds for each row; two or three are usual.
    const ROUNDS: usize = 60;
    let schur = |digits: &f64| Schur::try_new(m.clone(), digits * f64::EPSILON, ROUNDS * m.nrows());
    [1.0, 30.0, 1e3, 1e5].iter().find_map(schur).map(|schur| schur.complex_eigenvalues())
}

/// A vector in double precision.
pub(super) fn wide(v: pointmass::Vec3) -> nalgebra::Vector3<f64> {
    v.to_array().map(f64::from).into()
}
