//! Newton's law of gravitation between all particles, summed directly.

use super::{Force, State};
use crate::math::sqrt;
use core::ops::Range;
use glam::Vec3;

/// Every two particles attract each other with G m₁ m₂ / (d² + s²), s being the softening (Plummer's): f = G m₁ m₂ d⃗ /
/// (d² + s²)^{3/2}. Two that coincide do not act on each other. Costs the square of their number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MutualGravity {
    /// The constant of gravitation G \[m³/(kg s²)\].
    pub constant: f32,
    /// Softening length s \[m\]; zero is Newton's law, singular where particles meet.
    pub softening: f32,
}

/// How many partial sums run side by side. Their number is part of the definition: it decides how sums round.
const LANES: usize = 8;

impl MutualGravity {
    /// Newton's law with the constant of CODATA 2006, which the `.scn` format uses.
    pub const NEWTON: Self = Self { constant: 6.674_28e-11, softening: 0.0 };
}

impl Default for MutualGravity {
    fn default() -> Self {
        Self::NEWTON
    }
}

impl Force for MutualGravity {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let square = self.softening * self.softening;
        let sound = state.position.iter().all(|x| x.is_finite()) && state.mass.iter().all(|m| m.is_finite());
        for (total, row) in total.iter_mut().zip(rows) {
            let field = field(state.position[row], state.position, state.mass, square, sound);
            *total += field * (self.constant * state.mass[row]);
        }
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

/// Σ m d⃗ / (d² + `square`)^{3/2} at `place`: eight sums side by side, then a tree over them.
///
/// Unless all are `sound`, what is not finite is left out: it would spoil all others in one step.
fn field(place: Vec3, position: &[Vec3], mass: &[f32], square: f32, sound: bool) -> Vec3 {
    let mut sums = [[0.0f32; LANES]; 3];
    let ((x, x_rest), (m, m_rest)) = (position.as_chunks(), mass.as_chunks());
    for (x, m) in x.iter().zip(m) {
        if sound {
            add_chunk(&mut sums, place, x, m, square);
        } else {
            add_part(&mut sums, place, x, m, square);
        }
    }
    add_part(&mut sums, place, x_rest, m_rest, square);
    Vec3::from_array(sums.map(|s| ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))))
}

/// Lanes that are beyond the end or not finite lie at the place itself, without mass.
fn add_part(sums: &mut [[f32; LANES]; 3], place: Vec3, position: &[Vec3], mass: &[f32], square: f32) {
    let (mut x, mut m) = ([place; LANES], [0.0; LANES]);
    for (lane, (&position, &mass)) in position.iter().zip(mass).enumerate() {
        if position.is_finite() && mass.is_finite() {
            (x[lane], m[lane]) = (position, mass);
        }
    }
    add_chunk(sums, place, &x, &m, square);
}

/// One attractor a lane. Each loop runs over all lanes, so that a compiler makes vectors of them.
#[inline(always)]
fn add_chunk(sums: &mut [[f32; LANES]; 3], place: Vec3, x: &[Vec3; LANES], m: &[f32; LANES], square: f32) {
    let mut d = [[0.0f32; LANES]; 3];
    for lane in 0..LANES {
        d[0][lane] = x[lane].x - place.x;
        d[1][lane] = x[lane].y - place.y;
        d[2][lane] = x[lane].z - place.z;
    }
    let mut weight = [0.0f32; LANES];
    for lane in 0..LANES {
        let r2 = d[0][lane] * d[0][lane] + d[1][lane] * d[1][lane] + d[2][lane] * d[2][lane] + square;
        let w = m[lane] / (r2 * sqrt(r2));
        weight[lane] = if r2 > 0.0 { w } else { 0.0 };
    }
    for axis in 0..3 {
        for lane in 0..LANES {
            sums[axis][lane] += weight[lane] * d[axis][lane];
        }
    }
}
