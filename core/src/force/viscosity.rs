//! Friction between neighbours.

use super::near::add_up;
#[cfg(feature = "std")]
use super::near::sum_of_pairs;
use super::{Force, Needs, Perturbation, State};
use crate::math::{length, max};
use core::ops::Range;
use glam::Vec3;

/// Neighbours drag each other along: f₁ = μ m₁ m₂ (v₂ − v₁) (1 − d / reach), and the opposite on the other.
///
/// The weight falls with the distance as the Laplacian of the viscosity kernel of Müller, Charypar and Gross does
/// ("Particle-Based Fluid Simulation for Interactive Applications", SCA 2003), here 1 where two coincide. Momentum stays
/// what it is, kinetic energy only falls.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Viscosity {
    /// μ \[1/(kg s)\]: beside a neighbour of 1 kg at the same place a particle loses the part μ of their difference in
    /// velocity each second.
    pub coefficient: f32,
    /// Beyond this distance nothing acts \[m\].
    pub reach: f32,
}

impl Viscosity {
    /// μ m₁ m₂ (1 − d / reach) \[kg/s\] of two neighbours.
    #[inline(always)]
    fn weight(&self, state: &State<'_>, [a, b]: [usize; 2]) -> f32 {
        let d = length(state.between(a, b));
        self.coefficient * (state.mass[a] * state.mass[b]) * max(1.0 - d / self.reach, 0.0)
    }
}

impl Force for Viscosity {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        add_up(state, self.reach, rows, total, |row, other| {
            (state.velocity[other] - state.velocity[row]) * self.weight(state, [row, other])
        });
    }

    fn needs(&self) -> Needs {
        Needs::within(self.reach)
    }

    /// Exact in the velocities; how the weights change with the places is left out, and all of a coefficient below zero.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let all = 0..if change.velocity == 0.0 { 0 } else { total.len() };
        add_up(state, self.reach, all, total, |row, other| {
            (change.along[other] - change.along[row]) * (max(self.weight(state, [row, other]), 0.0) * change.velocity)
        });
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        let all = 0..total.len();
        add_up(state, self.reach, all, total, |row, other| {
            Vec3::splat(max(self.weight(state, [row, other]), 0.0) * velocity)
        });
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        sum_of_pairs(state, self.reach, |row, other| {
            let wide = |row: usize| state.velocity[row].to_array().map(f64::from);
            let square: f64 = wide(row).iter().zip(wide(other)).map(|(a, b)| (a - b) * (a - b)).sum();
            -f64::from(self.weight(state, [row, other])) * square
        })
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "viscosity"
    }
}
