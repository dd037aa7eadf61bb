//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

mod flight;
mod grip;
mod impulse;
mod meeting;
mod meetings;
mod melee;
mod packet;
mod passage;
mod path;
mod queue;
mod slide;
mod sweep;

pub(crate) use flight::RESTING;
pub use grip::Grip;
pub(crate) use grip::{Feel, of_two, on_surface};
pub use meetings::{Impulse, Meetings};
pub(crate) use passage::Passage;
#[cfg(feature = "std")]
pub(crate) use path::{CHORD_ERROR, MAX_CHORDS};
pub(crate) use sweep::each_by_itself;
