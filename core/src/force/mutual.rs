//! Newton's law of gravitation between all particles, far groups as one if so wished.

use super::inverse_square::field;
#[cfg(feature = "std")]
use super::inverse_square::potential;
use super::{AllPairs, BuildTrees, Force, Needs, State};
#[cfg(doc)]
use crate::index::BarnesHut;
use crate::index::Opening;
use core::ops::Range;
use glam::Vec3;

/// Every two particles attract each other as by [`AllPairs`], or with an opening angle in about N log N: then far groups
/// act as one, see [`BarnesHut`]. The energy is always that of all pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MutualGravity {
    /// The constant of gravitation G \[m³/(kg s²)\].
    pub constant: f32,
    /// Softening length s \[m\]; zero is Newton's law, singular where particles meet.
    pub softening: f32,
    /// The opening angle θ: a group acts as one if it is smaller than θ times its distance. Zero: all pairs, exactly;
    /// 0.5 errs by about a thousandth. Fewer than 128 particles are always summed pair by pair.
    pub theta: f32,
    /// True if such a group acts by its quadrupole as well, which makes the error several times smaller.
    pub quadrupole: bool,
}

impl MutualGravity {
    /// Newton's law between all pairs, as [`AllPairs::NEWTON`].
    pub const NEWTON: Self =
        Self { constant: AllPairs::NEWTON.constant, softening: 0.0, theta: 0.0, quadrupole: false };
}

impl Default for MutualGravity {
    fn default() -> Self {
        Self::NEWTON
    }
}

impl Force for MutualGravity {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let law = Opening { theta: self.theta, softening: self.softening, quadrupole: self.quadrupole };
        field(law, state.mass_tree, (state.position, state.mass), rows.clone(), &mut |row, field| {
            if let Some(total) = total.get_mut(row - rows.start) {
                *total += field * (self.constant * state.mass[row]);
            }
        });
    }

    fn needs(&self) -> Needs {
        Needs { mass_tree: (self.theta > 0.0).then_some(BuildTrees::BARNES_HUT), ..Needs::default() }
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
