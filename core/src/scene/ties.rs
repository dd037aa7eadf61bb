//! Ties in scene files: points of one body at places on another.

use super::SceneError;
use super::numbers::{Checked, zero_or_more};
use alloc::format;
use alloc::vec::Vec;

/// Points of a body that are tied to the surface of another: buttons and patches on cloth, ropes on boxes, hair on skin. Each goes with the place at which it
/// is to begin with. A rope's end that is tied rigidly is as one of the rope's `ends`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BodyTie {
    /// The body whose points they are; without it the points are `particles` of the scene.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub of: Option<Body>,
    /// Its points that are tied, by their number in it from 0: of a sheet along its first side first, of ropes and strands from their beginning.
    pub points: Vec<u32>,
    /// The body that they are tied to.
    pub to: Body,
    /// How far each gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// The force against being drawn away, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

/// A body of a scene by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Body {
    /// One of the `cloths`: the nearest of its triangles.
    Cloth(u32),
    /// One of the rigid bodies that the `boxes` are, counted through all of them along x, then z, then y.
    Box(u32),
    /// One of the strands that the `strands` are, counted through all of them: the nearest of its segments.
    Strand(u32),
    /// One of the `ropes`: the nearest of its segments.
    Rope(u32),
}

impl BodyTie {
    pub(super) fn check(&self, at: &str) -> Checked {
        zero_or_more(&format!("{at}.compliance"), self.compliance)?;
        zero_or_more(&format!("{at}.damping"), self.damping)?;
        if self.points.is_empty() {
            return Err(SceneError::value(format!("{at}.points"), "has to name a point at least"));
        }
        if self.of == Some(self.to) {
            return Err(SceneError::value(format!("{at}.to"), "is the body that is to be tied; name another"));
        }
        Ok(())
    }
}
