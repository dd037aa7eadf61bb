//! What an emitter goes on from.

/// The state of an emitter; numbers and instants of births go on from here, even when its rate changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EmitterState {
    /// Births so far, those that found no room included.
    pub(crate) serial: u32,
    /// How much of the next birth is done, in units of 2⁻⁶⁴.
    pub(crate) phase: u64,
}

impl EmitterState {
    pub(crate) const NEW: Self = Self { serial: 0, phase: 0 };
}
