//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

mod air;
mod borne;
mod crease;
mod event_driven;
mod images;
mod impulse;
mod lead;
mod marks;
mod meeting;
mod meetings;
mod near;
mod on_walls;
mod packet;
mod path;
mod paths;
mod queue;
mod rebound;
mod slide;
mod straight;
mod sweep;
mod swept;
mod tile;
mod tile_sweep;
mod turn;
mod waiting;

pub(crate) use lead::LeadCode;
pub(crate) use marks::MarkCode;
pub use meetings::{Impulse, Meetings};
#[cfg(feature = "std")]
pub(crate) use path::{CHORD_ERROR, MAX_CHORDS};
pub use paths::Paths;
pub(crate) use sweep::RESTING;
pub(crate) use swept::Swept;
pub(crate) use tile::{Obstacles, Tile};
pub(crate) use tile_sweep::face::leap_by_itself;
