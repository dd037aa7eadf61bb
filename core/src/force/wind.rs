//! Air that moves.

use super::{Flow, Force, Perturbation, State};
use crate::math::max;
use core::ops::Range;
use glam::Vec3;

/// Drag toward the velocity w of moving air: f = k (w − v). Speeds tend to that of the air and never pass it.
///
/// It takes the place of [`Drag`](super::Drag), which is the same in still air.
///
/// ```
/// use pointmass::force::{Gusts, Vortex, Wind};
/// use pointmass::Vec3;
///
/// let breeze = Gusts { velocity: Vec3::X * 3.0, amplitude: 0.5, frequency: 0.2 };
/// let devil = Vortex { center: Vec3::ZERO, axis: Vec3::Y, speed: 4.0, core: 0.5 };
/// let wind = Wind { field: (breeze, devil), coefficient: None };
/// let scene = pointmass::Scene { forces: &wind, ..pointmass::Scene::EMPTY };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Wind<F> {
    /// How the air moves; a list is the sum of its flows.
    pub field: F,
    /// The coefficient k of all particles \[kg/s\]; without it, each particle's own coefficient of drag.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub coefficient: Option<f32>,
}

impl<F: Flow> Wind<F> {
    /// Visits some rows with their coefficients and the air's velocity there.
    #[inline(always)]
    fn each(&self, state: &State<'_>, rows: Range<usize>, mut visit: impl FnMut(usize, f32, Vec3)) {
        let steady = self.field.everywhere(state.time);
        for row in rows {
            let air = steady.unwrap_or_else(|| self.field.velocity(state.position[row], state.time));
            visit(row, self.coefficient.unwrap_or(state.drag[row]), air);
        }
    }
}

impl<F: Flow> Force for Wind<F> {
    fn is_local(&self) -> bool {
        true
    }

    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let first = rows.start;
        self.each(state, rows, |row, k, air| {
            if let Some(total) = total.get_mut(row - first) {
                *total += (air - state.velocity[row]) * k;
            }
        });
    }

    /// −k δv. How the air's velocity changes from place to place is left out: it may drive apart what is displaced.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        for ((total, &along), &own) in total.iter_mut().zip(change.along).zip(state.drag) {
            *total -= along * (max(self.coefficient.unwrap_or(own), 0.0) * change.velocity);
        }
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        for (total, &own) in total.iter_mut().zip(state.drag) {
            *total += Vec3::splat(max(self.coefficient.unwrap_or(own), 0.0) * velocity);
        }
    }

    /// The power \[W\] that air gives to those who go with it, less what it takes from others.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let mut sum = 0.0;
        self.each(state, 0..state.velocity.len(), |row, k, air| {
            let (v, air) = (state.velocity[row].to_array().map(f64::from), air.to_array().map(f64::from));
            sum += f64::from(k) * v.iter().zip(air).map(|(v, air)| (air - v) * v).sum::<f64>();
        });
        sum
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "wind"
    }
}
