//! What a body is made of: its particles, and their places in it.

use super::RigidBox;
use crate::constrain::Bodies;
use core::ops::Range;
use glam::Vec3;

/// The make of a body: its box, and the places of its particles in it, three words each.
#[derive(Clone, Copy)]
pub(super) struct Made<'a> {
    pub(super) of: &'a RigidBox,
    pub(super) places: &'a [u32],
}

impl Made<'_> {
    /// The rows of its particles, where all live, one behind the other.
    pub(super) fn run(&self, bodies: &Bodies<'_>) -> Option<Range<usize>> {
        let (first, count) = (self.of.first as usize, self.of.count as usize);
        let end = first.checked_add(count).filter(|&end| end <= bodies.start as usize)?;
        let rows = bodies.row_of.get(first..end)?;
        let row = *rows.first()? as usize;
        let serials = bodies.serial.get(row..row.checked_add(count)?)?;
        // Words that differ leave bits, which are looked at once: so many go side by side.
        let (row, first) = (row as u32, first as u32);
        let differs = |i: usize, at: u32, serial: u32| {
            (at ^ row.wrapping_add(i as u32)) | (serial ^ first.wrapping_add(i as u32))
        };
        let both = rows.iter().zip(serials).enumerate();
        let differ = both.fold(0, |any, (i, (&at, &serial))| any | differs(i, at, serial));
        (differ == 0).then_some(row as usize..row as usize + count)
    }

    /// Visits its living particles: row, and place in the box's frame \[m\].
    pub(super) fn each(&self, bodies: &Bodies<'_>, visit: &mut dyn FnMut(usize, Vec3)) {
        for (i, &[x, y, z]) in self.places.as_chunks().0.iter().enumerate() {
            if let Some(row) = bodies.row_of_start(self.of.first.saturating_add(i as u32)) {
                visit(row, Vec3::from_array([x, y, z].map(f32::from_bits)));
            }
        }
    }
}
