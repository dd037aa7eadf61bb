//! A loose ball that is near a body.

use crate::constrain::Bodies;

/// A ball that is near a body: its particle.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Ball {
    pub(super) slot: u32,
    pub(super) serial: u32,
    pub(super) state: u32,
}

/// The place of a ball is free.
pub(super) const FREE: u32 = 0;
/// A ball was there when the lists were made the last time but one, as well.
pub(super) const STAYS: u32 = 1;
/// A ball has come when the lists were made.
pub(super) const CAME: u32 = 2;
/// A ball was there, and has not been found near a body yet.
pub(super) const LEAVES: u32 = 3;

impl Ball {
    /// Its row while it is there.
    pub(super) fn row(&self, bodies: &Bodies<'_>) -> Option<usize> {
        if self.state == FREE {
            return None;
        }
        let row = *bodies.row_of.get(self.slot as usize)? as usize;
        (bodies.serial.get(row) == Some(&self.serial)).then_some(row)
    }

    /// Tells whether it has come when the lists were made: what is known of another that had its number says nothing of it.
    pub(super) fn is_new(&self) -> bool {
        self.state == CAME
    }
}
