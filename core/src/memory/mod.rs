//! The memory of a system: who owns it, and what lies where.

mod layout;
mod storage;

pub(crate) use layout::{Demand, Layout, Past, Shares};
#[cfg(feature = "alloc")]
pub use storage::Heap;
pub use storage::{Columns, Inline, Size, Slices, Storage};
