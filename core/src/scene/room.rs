//! A room whose opposite faces are one, as files say it.

use crate::index::Room;
use glam::Vec3;

/// A box whose opposite faces are one: what leaves it at one comes in at the other. Forces between neighbours, springs, contacts of balls,
/// distances, ropes and attachments act through its sides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PeriodicRoom {
    /// Its lower corner \[m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub low: [f32; 3],
    /// Its sides \[m\]; along those that are zero space goes on.
    pub sides: [f32; 3],
}

impl PeriodicRoom {
    /// It, to find neighbours in.
    #[must_use]
    pub fn room(&self) -> Room {
        Room::new(Vec3::from_array(self.low), Vec3::from_array(self.sides))
    }
}
