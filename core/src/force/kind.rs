//! The forces that a file can name.

use super::{Drag, Force, Gravity, MutualGravity, Needs, State};
use core::ops::Range;
use glam::Vec3;

/// A force that acts on all particles, as files name it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ForceKind {
    /// Uniform gravity.
    Gravity(Gravity),
    /// Linear drag with each particle's own coefficient.
    Drag(Drag),
    /// Every two particles attract each other.
    MutualGravity(MutualGravity),
}

impl Force for ForceKind {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        match self {
            Self::Gravity(force) => force.add_to(state, rows, total),
            Self::Drag(force) => force.add_to(state, rows, total),
            Self::MutualGravity(force) => force.add_to(state, rows, total),
        }
    }

    fn needs(&self) -> Needs {
        match self {
            Self::Gravity(force) => force.needs(),
            Self::Drag(force) => force.needs(),
            Self::MutualGravity(force) => force.needs(),
        }
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        match self {
            Self::Gravity(force) => force.energy(state),
            Self::Drag(force) => force.energy(state),
            Self::MutualGravity(force) => force.energy(state),
        }
    }
}
