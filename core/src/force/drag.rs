//! Linear drag.

use super::{Force, State};
use crate::rows::each_row;
use core::ops::Range;
use glam::Vec3;

/// Linear drag: f = −k v, k being each particle's own coefficient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Drag {}

impl Force for Drag {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        each_row(total, &state.velocity[rows.clone()], &state.drag[rows], |total, v, k| total - v * k);
    }
}
