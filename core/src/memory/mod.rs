//! The memory of a system: who owns it, and what lies where.

mod layout;
mod storage;

pub use layout::{Demand, Kept, Words};
pub(crate) use layout::{Layout, Past, Plan, Scratch, Shares, take, take_vectors};
#[cfg(feature = "alloc")]
pub use storage::Heap;
pub use storage::{Columns, Inline, Size, Slices, Storage};
