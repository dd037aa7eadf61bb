//! Linear drag.

use super::{Force, Perturbation, State};
use crate::math::max;
use crate::rows::add_each;
use core::ops::Range;
use glam::Vec3;

/// Linear drag: f = −k v, k being each particle's own coefficient.
///
/// A coefficient below zero drives; it is left out of [`Force::add_jacobian`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Drag {}

impl Force for Drag {
    fn is_local(&self) -> bool {
        true
    }

    #[cfg(not(target_os = "none"))]
    fn steady(&self) -> Option<super::Steady> {
        Some(super::Steady { acceleration: None, drags: true })
    }

    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        add_each(total, &state.velocity[rows.clone()], &state.drag[rows], |k| -k);
    }

    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        add_each(total, change.along, state.drag, |k| -(max(k, 0.0) * change.velocity));
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        for (total, &k) in total.iter_mut().zip(state.drag) {
            *total += Vec3::splat(max(k, 0.0) * velocity);
        }
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let square = |v: &Vec3| v.to_array().map(|v| f64::from(v).powi(2)).iter().sum::<f64>();
        -state.velocity.iter().zip(state.drag).map(|(v, &k)| f64::from(k) * square(v)).sum::<f64>()
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "drag"
    }
}
