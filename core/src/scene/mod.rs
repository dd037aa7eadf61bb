//! Scenes: what a system steps through, and the files that say it, our JSON and the course's `.scn`.
//!
//! Without a heap, `scn` parses command by command and [`InlineScene`] holds a small scene. With the feature `alloc`,
//! text → `SceneFile` (what the file says, for writing back) → `Model` (meshes loaded, colours and transforms
//! settled) → [`Scene`] (what a system steps through).

#[cfg(feature = "alloc")]
mod air;
#[cfg(feature = "alloc")]
mod boxes;
#[cfg(feature = "alloc")]
mod check;
#[cfg(feature = "alloc")]
mod check_force;
#[cfg(feature = "alloc")]
mod cloth;
#[cfg(feature = "alloc")]
mod error;
#[cfg(feature = "alloc")]
mod file;
mod inline;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "alloc")]
mod material;
#[cfg(feature = "alloc")]
mod model;
#[cfg(feature = "alloc")]
mod numbers;
#[cfg(feature = "alloc")]
mod placing;
#[cfg(feature = "alloc")]
mod read;
#[cfg(feature = "alloc")]
mod remarks;
mod response;
#[cfg(feature = "alloc")]
mod room;
mod rules;
#[cfg(feature = "schema")]
mod schema;
pub mod scn;
#[cfg(feature = "alloc")]
mod start;
#[cfg(feature = "alloc")]
mod tuft;
#[cfg(feature = "alloc")]
mod write;

#[cfg(feature = "alloc")]
pub use air::{Fog, Sky};
#[cfg(feature = "alloc")]
pub use boxes::{BoxForm, Boxes, Scatter};
#[cfg(feature = "alloc")]
pub use cloth::{Air, Cloth, Form, Gas};
#[cfg(feature = "alloc")]
pub use error::SceneError;
#[cfg(feature = "alloc")]
pub use file::{Camera, Group, Item, Light, Run, SceneFile};
pub use inline::{InlineError, InlineScene};
#[cfg(feature = "alloc")]
pub use material::{CurveBuf, LifeBuf, Material, ParticleShape, Sides, Sprite, VaryingBuf};
#[cfg(feature = "alloc")]
pub use model::{Constraints, Forces, Model, PatchBuf, SheetContactsBuf, Solid};
#[cfg(feature = "alloc")]
pub use read::{Files, Reading, Unknown, beside, read_scn, read_scn_with};
pub use response::{Position, Response};
#[cfg(feature = "alloc")]
pub use room::PeriodicRoom;
pub use rules::{InsufficientMemory, Scene};
#[cfg(feature = "schema")]
pub use schema::schema;
#[cfg(feature = "alloc")]
pub use tuft::{Curl, Field, Growth, StrandAir, Tuft};
#[cfg(feature = "alloc")]
pub use write::write_scn;

/// The colour of particles of a material: diffuse, or emitted where that is black.
fn shown(diffuse: [f32; 3], emission: [f32; 3]) -> crate::Color {
    let [r, g, b] = if diffuse == [0.0; 3] { emission } else { diffuse };
    // The casts saturate.
    let byte = |x: f32| (x * 255.0 + 0.5) as u8;
    [byte(r), byte(g), byte(b), 255]
}
