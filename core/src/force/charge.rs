//! Coulomb's law between all particles, far groups as one if so wished.

use super::inverse_square::field;
#[cfg(feature = "std")]
use super::inverse_square::potential;
use super::{BuildTrees, Force, Needs, State};
use crate::index::Opening;
use core::ops::Range;
use glam::Vec3;

/// Every two particles push each other apart with k q₁ q₂ / (d² + s²), s being the softening: those with charges of one
/// sign repel, those of unlike signs attract each other. f = −k q₁ q₂ d⃗ / (d² + s²)^{3/2}, d⃗ being the way to the other.
///
/// The energy is always that of all pairs. It is left out of [`Force::add_jacobian`]: whatever the signs, each pair drives
/// apart what is displaced along it or across it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coulomb {
    /// Coulomb's constant k \[N m²/C²\].
    pub constant: f32,
    /// Softening length s \[m\]; zero is Coulomb's law, singular where particles meet.
    pub softening: f32,
    /// The opening angle θ, as of [`MutualGravity`](super::MutualGravity). Where charges of both signs are mixed, the sums
    /// are small beside their terms, and errors grow beside them.
    pub theta: f32,
    /// True if a far group acts by its dipole and quadrupole as well; without these, a group of no charge in all does
    /// nothing.
    pub quadrupole: bool,
}

impl Coulomb {
    /// Coulomb's law in empty space (CODATA 2018) between all pairs.
    pub const VACUUM: Self = Self { constant: 8.987_552e9, softening: 0.0, theta: 0.0, quadrupole: false };
}

impl Default for Coulomb {
    fn default() -> Self {
        Self::VACUUM
    }
}

impl Force for Coulomb {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let law = Opening { theta: self.theta, softening: self.softening, quadrupole: self.quadrupole };
        field(law, state.charge_tree, (state.position, state.charge), rows.clone(), &mut |row, field| {
            if let Some(total) = total.get_mut(row - rows.start) {
                *total -= field * (self.constant * state.charge[row]);
            }
        });
    }

    fn needs(&self) -> Needs {
        Needs { charge_tree: (self.theta > 0.0).then_some(BuildTrees::BARNES_HUT), ..Needs::default() }
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        f64::from(self.constant) * potential(state.position, state.charge, self.softening)
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "charges"
    }
}
