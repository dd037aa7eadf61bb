//! Uniform gravity.

use super::{Force, State};
use crate::material::Floating;
use crate::rows::add_one;
use core::ops::Range;
use glam::Vec3;

/// Uniform gravity: f = m g, with the potential −m g·x, zero in the origin; less the share that a material's
/// [buoyancy](crate::material::Life::buoyancy) carries, which has no potential.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gravity {
    /// The acceleration g \[m/s²\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub acceleration: Vec3,
}

impl Gravity {
    /// Standard gravity, down the y axis.
    pub const EARTH: Self = Self { acceleration: Vec3::new(0.0, -9.80665, 0.0) };
}

impl Gravity {
    /// Takes off what carries those that are buoyant.
    fn carry(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        if let Some(code) = state.materials.code() {
            let State { time, born, dies, material, key, mass, .. } = *state;
            let floating = Floating { time, born, dies, material, key, mass };
            (code.carry)(state.materials, &floating, rows, self.acceleration, total);
        }
    }
}

impl Force for Gravity {
    fn is_local(&self) -> bool {
        true
    }

    fn depends_on_motion(&self) -> bool {
        false
    }

    #[cfg(not(target_os = "none"))]
    fn steady(&self) -> Option<super::Steady> {
        Some(super::Steady { acceleration: Some(self.acceleration), drags: false })
    }

    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        add_one(total, self.acceleration, &state.mass[rows.clone()]);
        self.carry(state, rows, total);
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let g = self.acceleration.to_array().map(f64::from);
        let height = |x: &Vec3| x.to_array().iter().zip(g).map(|(&x, g)| f64::from(x) * g).sum::<f64>();
        -state.position.iter().zip(state.mass).map(|(x, &m)| f64::from(m) * height(x)).sum::<f64>()
    }

    /// The power \[W\] of what carries those that are buoyant.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let work = |(row, v): (usize, &Vec3)| {
            let mut lift = [Vec3::ZERO];
            self.carry(state, row..row + 1, &mut lift);
            (0..3).map(|axis| f64::from(lift[0][axis]) * f64::from(v[axis])).sum::<f64>()
        };
        if state.materials.code().is_none() {
            return 0.0;
        }
        state.velocity.iter().enumerate().map(work).sum()
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "gravity"
    }
}
