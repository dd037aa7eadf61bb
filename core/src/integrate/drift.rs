//! How Euler methods move places.

/// The velocity by which an Euler method moves places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drift {
    /// That of the step's beginning: the explicit method.
    Before,
    /// That of its end: the symplectic one.
    After,
}
