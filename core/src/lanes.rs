//! Eight numbers side by side, and the inverse square law on them.
//!
//! The number of lanes and the order in which they are added are part of every sum's definition: they decide how it
//! rounds, and so they are the same on every target, whatever its registers hold.

#[cfg(widest_found)]
mod avx2;
#[cfg(widest_found)]
mod avx512;
mod eight;
mod hits;
#[cfg(any(test, one_by_one))]
mod one;
mod row;
mod run;
mod sums;
#[cfg(any(test, target_feature = "simd128"))]
mod thrice;
mod vectors;
mod width;

pub(crate) use eight::{BroadKernel, Eight, Kernel, Lanes, max, min, negated, not};
pub(crate) use hits::{COUNTS, HITS};
#[cfg(any(test, one_by_one))]
pub(crate) use one::One;
pub(crate) use row::{Row, load, mask_of, saved};
#[cfg(test)]
pub(crate) use run::NARROW;
pub(crate) use run::{run, run_abreast, run_at_length, run_broad, widest};
pub(crate) use sums::{Pull, dot, splat, sqrt, total, turned};
pub(crate) use vectors::{Vectors, gathered};
pub(crate) use width::{ABREAST, LANES, NOWHERE, PARTS};
