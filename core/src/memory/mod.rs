//! The memory of a system: who owns it, and what lies where.

mod column;
#[cfg(feature = "alloc")]
mod heap;
mod in_common;
mod layout;
mod likeness;
mod storage;
mod table;
mod workspace;

pub use column::Column;
#[cfg(feature = "alloc")]
pub use heap::Heap;
pub(crate) use in_common::InCommon;
pub use layout::{Demand, Kept, Words};
pub(crate) use layout::{LEAD_WORDS, LOAD_WORDS, Layout, Past, Plan, Scratch, Shares, take, take_vectors};
pub use likeness::{Likeness, Own};
pub(crate) use storage::Attribute;
pub use storage::{Alike, Columns, Common, Inline, Size, Slices, Storage};
pub(crate) use workspace::{Status, TILED, Workspace};
