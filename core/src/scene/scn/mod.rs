//! The `.scn` format's commands, read one by one from borrowed text, without a heap.
//!
//! ```
//! use pointmass::scene::scn::{Command, commands};
//! let text = "particle_gravity 0 -9.8 0  # down\nparticle 0 0 0  1 5 0  1 0 0 0 2 -1";
//! for command in commands(text) {
//!     if let Command::Particle { particle, .. } = command?.command {
//!         assert_eq!(particle.velocity.y, 5.0);
//!     }
//! }
//! # Ok::<(), pointmass::scene::scn::ScnError>(())
//! ```

mod command;
mod lex;

#[cfg(feature = "alloc")]
pub(super) use command::known;
pub use command::{Command, Commands, Located, Scenery, Source, commands};
pub use lex::{Index, Place, Problem, ScnError};
