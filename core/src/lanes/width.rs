//! How many numbers go side by side.

/// The number of lanes.
pub(crate) const LANES: usize = 8;

/// How many eights go side by side where registers hold more than one: these many at the most.
pub(crate) const PARTS: usize = 2;

/// Where a lane that stands for nothing is put, without weight: so far that whatever is divided by its distance is zero,
/// and so near that its square is a number.
pub(crate) const NOWHERE: f32 = 1e19;

/// The number that goes side by side where eight may: one on chips, where lanes would be taken one after the other, and without optimisation.
pub(crate) const ABREAST: usize = if cfg!(one_by_one) { 1 } else { LANES };
