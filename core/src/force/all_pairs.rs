//! Newton's law of gravitation between all particles, pair by pair.

use super::inverse_square::direct;
#[cfg(feature = "std")]
use super::inverse_square::potential;
use super::{Force, State};
use core::ops::Range;
use glam::Vec3;

/// Every two particles attract each other with G m₁ m₂ / (d² + s²), s being the softening (Plummer's): f = G m₁ m₂ d⃗ /
/// (d² + s²)^{3/2}. Two that coincide do not act on each other. Costs the square of their number.
///
/// It is left out of [`Force::add_jacobian`]: the pull falls with the distance, so that it drives apart what is displaced
/// along it twice as much as it draws back what is displaced across it.
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
    // Apart on chips, as that of sinks is.
    #[cfg_attr(one_by_one, inline(never))]
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
        -f64::from(self.constant) * potential(state.position, state.mass, self.softening)
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "mutual gravity"
    }
}
