//! The memory of a system: who owns it, and what lies where.

mod column;
mod layout;
mod storage;
mod workspace;

pub use column::Column;
pub use layout::{Demand, Kept, Words};
pub(crate) use layout::{Layout, Past, Plan, Scratch, Shares, take, take_vectors};
#[cfg(feature = "alloc")]
pub use storage::Heap;
pub use storage::{Alike, Columns, Common, Inline, Size, Slices, Storage};
pub(crate) use workspace::{Inertias, Status, TILED, Workspace};
