//! Scenes as files: the declared scene, our JSON and the course's `.scn`.
//!
//! `scn` parses without a heap, command by command; everything else here needs the feature `alloc`.
//!
//! text → [`SceneFile`] (what the file says, for writing back) → [`Model`] (meshes loaded, colours and transforms
//! settled) → [`Scene`](crate::Scene) (what a system steps through).

#[cfg(feature = "alloc")]
mod check;
#[cfg(feature = "alloc")]
mod error;
#[cfg(feature = "alloc")]
mod file;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "alloc")]
mod model;
#[cfg(feature = "alloc")]
mod read;
pub mod scn;
#[cfg(feature = "alloc")]
mod write;

#[cfg(feature = "alloc")]
pub use error::SceneError;
#[cfg(feature = "alloc")]
pub use file::{Camera, ForceKind, Group, Item, Light, Material, Run, SceneFile};
#[cfg(feature = "alloc")]
pub use model::{Model, Solid};
#[cfg(feature = "alloc")]
pub use read::{Files, beside, read_scn};
#[cfg(feature = "alloc")]
pub use write::write_scn;
