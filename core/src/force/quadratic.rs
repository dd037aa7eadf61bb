//! Quadratic drag.

use super::{Force, Perturbation, State};
use crate::math::{length, max};
use core::ops::Range;
use glam::Vec3;

/// Quadratic drag, as fast bodies have it in air: f = −k |v| v. What falls tends to the speed √(m g / k).
///
/// A coefficient below zero drives; it is left out of [`Force::add_jacobian`].
///
/// For a ball k = ½ ρ c A: the density of the air times its coefficient of drag, about 0.5, times its cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuadraticDrag {
    /// The coefficient k of every particle \[kg/m\].
    pub coefficient: f32,
}

impl Force for QuadraticDrag {
    fn is_local(&self) -> bool {
        true
    }

    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, &v) in total.iter_mut().zip(&state.velocity[rows]) {
            *total -= v * (self.coefficient * length(v));
        }
    }

    /// −k (|v| + v vᵀ / |v|) δv: twice as steep along the velocity as across it.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let k = max(self.coefficient, 0.0) * change.velocity;
        for ((total, &v), &along) in total.iter_mut().zip(state.velocity).zip(change.along) {
            let speed = length(v);
            if speed > 0.0 {
                *total -= (along * speed + v * (v.dot(along) / speed)) * k;
            }
        }
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        for (total, &v) in total.iter_mut().zip(state.velocity) {
            let speed = length(v);
            if speed > 0.0 {
                *total += (Vec3::splat(speed) + v * v / speed) * (max(self.coefficient, 0.0) * velocity);
            }
        }
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let cube = |v: &Vec3| v.to_array().map(|v| f64::from(v).powi(2)).iter().sum::<f64>().powf(1.5);
        -f64::from(self.coefficient) * state.velocity.iter().map(cube).sum::<f64>()
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "quadratic drag"
    }
}
