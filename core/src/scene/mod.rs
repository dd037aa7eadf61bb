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
mod check_look;
#[cfg(feature = "alloc")]
mod check_room;
#[cfg(feature = "alloc")]
mod check_shape;
#[cfg(feature = "alloc")]
mod check_start;
#[cfg(feature = "alloc")]
mod cloth;
mod color;
#[cfg(feature = "alloc")]
mod cord;
#[cfg(feature = "alloc")]
mod error;
#[cfg(feature = "alloc")]
mod file;
#[cfg(feature = "alloc")]
mod files;
#[cfg(feature = "alloc")]
mod filling;
mod inline;
#[cfg(feature = "alloc")]
mod isotropic;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "json")]
mod json_path;
#[cfg(feature = "alloc")]
mod material;
#[cfg(feature = "alloc")]
mod model;
#[cfg(feature = "alloc")]
mod names;
#[cfg(feature = "alloc")]
mod numbers;
#[cfg(feature = "alloc")]
mod origins;
#[cfg(feature = "alloc")]
mod placing;
#[cfg(feature = "alloc")]
mod read;
#[cfg(feature = "alloc")]
mod references;
#[cfg(feature = "alloc")]
mod remarks;
mod response;
#[cfg(feature = "alloc")]
mod rigging;
#[cfg(feature = "alloc")]
mod room;
mod rules;
#[cfg(feature = "schema")]
mod schema;
pub mod scn;
#[cfg(feature = "alloc")]
mod soft;
#[cfg(feature = "alloc")]
mod start;
#[cfg(feature = "alloc")]
mod ties;
#[cfg(feature = "alloc")]
mod tuft;
#[cfg(feature = "alloc")]
mod tying;
#[cfg(feature = "alloc")]
mod write;

#[cfg(feature = "alloc")]
pub use air::{Fog, Sky};
#[cfg(feature = "alloc")]
pub use boxes::{BoxForm, Boxes, Scatter, SolidMesh};
#[cfg(feature = "alloc")]
pub use cloth::{Air, Cloth, Form, Gas, Hung, PatchBuf, SheetContactsBuf};
#[cfg(feature = "alloc")]
pub use cord::Cord;
#[cfg(feature = "alloc")]
pub use error::SceneError;
#[cfg(feature = "alloc")]
pub use file::{Camera, Group, Item, Light, Run, SceneFile};
#[cfg(feature = "alloc")]
pub use files::{Files, beside};
#[cfg(feature = "alloc")]
pub use filling::SoftForm;
pub use inline::{InlineError, InlineScene};
#[cfg(feature = "alloc")]
pub use isotropic::Isotropic;
#[cfg(feature = "alloc")]
pub use material::{CurveBuf, LifeBuf, Material, ParticleShape, Sides, Sprite, VaryingBuf};
#[cfg(feature = "alloc")]
pub use model::{Constraints, Forces, Model};
#[cfg(feature = "alloc")]
pub use placing::Solid;
#[cfg(feature = "alloc")]
pub use read::{Reading, Unknown, read_scn, read_scn_with};
pub use response::{Position, Response};
#[cfg(feature = "alloc")]
pub use room::PeriodicRoom;
pub use rules::{InsufficientMemory, Scene};
#[cfg(feature = "schema")]
pub use schema::schema;
#[cfg(feature = "alloc")]
pub use soft::SoftBody;
#[cfg(feature = "alloc")]
pub use ties::{Body, BodyTie};
#[cfg(feature = "alloc")]
pub use tuft::{Curl, Field, Growth, StrandAir, Tuft};
#[cfg(feature = "alloc")]
pub use write::write_scn;
