//! Collision: every path of the step is followed to its first hit, answered, and followed on with the time left.

mod contacts;
mod flight;
mod grip;
mod impulse;
mod lists;
mod meeting;
mod melee;
mod path;
mod projection;
mod queue;
mod response;
mod slide;
mod solver;
mod sweep;
mod touch;

pub use contacts::{Contacts, Passage, Stage};
pub use grip::Grip;
pub use impulse::Impulse;
pub(crate) use lists::Lists;
#[cfg(feature = "std")]
pub(crate) use path::{CHORD_ERROR, MAX_CHORDS};
pub use projection::Projection;
pub use response::Response;
