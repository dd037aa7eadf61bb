//! Newton's law of gravitation between all particles, pair by pair.

use super::{Force, State};
use crate::lanes::{LANES, NOWHERE, Pull, splat};
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

/// Every two particles attract each other with G m₁ m₂ / (d² + s²), s being the softening (Plummer's): f = G m₁ m₂ d⃗ /
/// (d² + s²)^{3/2}. Two that coincide do not act on each other. Costs the square of their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllPairs {
    /// The constant of gravitation G \[m³/(kg s²)\].
    pub constant: f32,
    /// Softening length s \[m\]; zero is Newton's law, singular where particles meet.
    pub softening: f32,
}

impl AllPairs {
    /// Newton's law with the constant of CODATA 2006, which the `.scn` format uses.
    pub const NEWTON: Self = Self { constant: 6.674_28e-11, softening: 0.0 };
}

impl Force for AllPairs {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let square = self.softening * self.softening;
        direct(state.position, state.mass, square, rows.clone(), &mut |row, field| {
            if let Some(total) = total.get_mut(row - rows.start) {
                *total += field * (self.constant * state.mass[row]);
            }
        });
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let square = f64::from(self.softening * self.softening);
        let bodies = || state.position.iter().zip(state.mass);
        let mut sum = 0.0;
        for (i, (x, &m)) in bodies().enumerate() {
            for (y, &n) in bodies().skip(i + 1) {
                let d = (*x - *y).to_array().map(f64::from);
                let r2 = d.iter().map(|d| d * d).sum::<f64>() + square;
                if r2 > 0.0 {
                    sum += f64::from(m) * f64::from(n) / libm::sqrt(r2);
                }
            }
        }
        -f64::from(self.constant) * sum
    }
}

/// Particles for which the sums go on side by side, so that each block of sources is turned into lanes once for all. Their
/// number changes no sum: few on a chip, whose stack is small, many on a host.
const PLACES: usize = if cfg!(feature = "std") { 32 } else { 2 };

/// Visits the rows with Σ m d⃗ / (d² + `square`)^{3/2} over all others, summed pair by pair.
///
/// What is not finite is left out: it would spoil all others in one step.
fn direct(position: &[Vec3], mass: &[f32], square: f32, rows: Range<usize>, visit: &mut dyn FnMut(usize, Vec3)) {
    let sound = position.iter().all(|x| x.is_finite()) && mass.iter().all(|m| m.is_finite());
    let square = f32x8::splat(square);
    for first in rows.clone().step_by(PLACES) {
        let places = &position[first..rows.end.min(first + PLACES)];
        let mut pulls = [Pull::default(); PLACES];
        for (x, m) in position.chunks(LANES).zip(mass.chunks(LANES)) {
            let (x, m) = sources(x, m, sound);
            for (pull, place) in pulls.iter_mut().zip(places) {
                pull.add(splat(*place), x, m, square);
            }
        }
        for ((row, _), pull) in (first..).zip(places).zip(pulls) {
            visit(row, pull.total());
        }
    }
}

/// Some sources in lanes; those beyond the end, and unless all are `sound` those that are not finite, have no mass.
#[inline(always)]
fn sources(position: &[Vec3], mass: &[f32], sound: bool) -> ([f32x8; 3], f32x8) {
    let (mut x, mut m) = ([[NOWHERE; LANES]; 3], [0.0; LANES]);
    for (lane, (position, mass)) in position.iter().zip(mass).enumerate().take(LANES) {
        if sound || (position.is_finite() && mass.is_finite()) {
            (x[0][lane], x[1][lane], x[2][lane]) = (*position).into();
            m[lane] = *mass;
        }
    }
    (x.map(f32x8::new), f32x8::new(m))
}
