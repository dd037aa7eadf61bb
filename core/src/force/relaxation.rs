//! A column of a user's own that comes to rest: heat that is lost, fuel that burns down.

use super::{Force, Needs, State, Writing};
use crate::custom::CustomColumnsMut;
use crate::math::exp;
use core::ops::Range;
use glam::Vec3;

/// Brings a column of a user's own toward a value, by a share of the difference in each second (Newton's law of cooling):
/// c(t) = c∞ + (c(0) − c∞) e^(−λ t), at any step. The newborn begin at their births, wherever in a step these lie. It pushes nothing.
///
/// Without such a column in the scene it does nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Relaxation<N = &'static str> {
    /// The column's name.
    pub column: N,
    /// The value that it comes to, c∞.
    pub toward: f32,
    /// How fast, λ \[1/s\]; zero or more.
    pub rate: f32,
}

impl<N: AsRef<str> + Sync> Force for Relaxation<N> {
    fn add_to(&self, _: &State<'_>, _: Range<usize>, _: &mut [Vec3]) {}

    fn is_local(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs { write: Some(Writing::COLUMNS), ..Needs::default() }
    }

    fn write(&self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>, dt: f32) {
        let whole = exp(-self.rate * dt);
        let values = custom.get_mut(self.column.as_ref()).into_iter().flatten();
        for (value, &born) in values.zip(state.born) {
            // Who is born within the step has lived through a part of it.
            let age = (state.time - born).seconds();
            let left = if age < dt { exp(-self.rate * age) } else { whole };
            *value = self.toward + (*value - self.toward) * left;
        }
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "relaxation"
    }
}
