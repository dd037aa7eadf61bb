//! The facts that scene files, checks and pictures ask of a constraint, whatever its kind.

use super::Constraint;

/// A constraint that scene files can name.
pub(super) trait Declared: Constraint {
    /// The first of its numbers that cannot be used, and what it has to be.
    fn fault(&self) -> Option<(&'static str, &'static str)>;

    /// The particles of the scene's start that it binds, in up to three lists.
    fn ends(&self) -> [&[u32]; 3];

    /// The particles that it joins by straight links, each to the next, and true if the last one to the first as well. By default it joins none.
    fn chain(&self) -> (&[u32], bool) {
        (&[], false)
    }

    /// How long each of these links is at rest \[m\], and for ever the last of these.
    fn lengths(&self) -> &[f32] {
        &[]
    }
}

/// Tells whether a list names a particle twice.
pub(super) fn names_twice(particles: &[u32]) -> bool {
    let mut sorted = particles.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// The fault of a list of particles that names one twice.
pub(super) fn twice(particles: &[u32]) -> Option<(&'static str, &'static str)> {
    names_twice(particles).then_some(("particles", "must not name a particle twice"))
}
