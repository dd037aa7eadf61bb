//! The largest stable step of velocity Verlet where oscillations are coupled by their damping.
//!
//! Verlet gives the second evaluation v + h a, so its step holds products of stiffness and damping, which no single
//! oscillation shows: the eigenvalues have to be those of the whole step.

use super::net::eigenvalues;
use nalgebra::DMatrix;

/// Where the spectral radius of one step first exceeds 1, between zero and `beyond` \[s\], by bisection. None should the
/// eigenvalues not be found.
pub(crate) fn largest_step(k: &DMatrix<f64>, c: &DMatrix<f64>, beyond: f64) -> Option<f64> {
    /// The neutral directions' double eigenvalue 1 is split by the root of rounding.
    const ROUNDING: f64 = 1e-6;
    let (mut stable, mut grows) = (0.0, beyond);
    while grows - stable > 1e-4 * grows {
        let middle = 0.5 * (stable + grows);
        let is_stable = radius(step(k, c, middle))? <= 1.0 + ROUNDING;
        *(if is_stable { &mut stable } else { &mut grows }) = middle;
    }
    Some(stable)
}

/// The largest modulus of an eigenvalue.
fn radius(m: DMatrix<f64>) -> Option<f64> {
    Some(eigenvalues(&m)?.iter().map(|value| value.norm()).fold(0.0, f64::max))
}

/// The matrix of a step of (x, h v), for x'' = −K x − C x'.
fn step(k: &DMatrix<f64>, c: &DMatrix<f64>, h: f64) -> DMatrix<f64> {
    let n = k.nrows();
    let one = DMatrix::identity(n, n);
    let (k, c) = (k * (h * h), c * h);
    let place = [&one - &k * 0.5, &one - &c * 0.5];
    // The second acceleration, that at the new place with v + h a, times h².
    let second = [&c * &k - &k * &place[0], &c * &c - &k * &place[1] - &c];
    let speed = [(&second[0] - &k) * 0.5, &one + (&second[1] - &c) * 0.5];
    let mut m = DMatrix::zeros(2 * n, 2 * n);
    for (row, blocks) in [place, speed].iter().enumerate() {
        for (column, block) in blocks.iter().enumerate() {
            m.view_mut((row * n, column * n), (n, n)).copy_from(block);
        }
    }
    m
}
