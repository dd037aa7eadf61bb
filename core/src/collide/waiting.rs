//! Rows that wait until there are enough of them to go side by side.

use crate::lanes::LANES;

/// Places in a queue: for a word of marks besides fewer than eight of before.
const PLACES: usize = 128;

/// Rows that wait until there are eight.
#[derive(Clone, Copy)]
pub(super) struct Queue {
    rows: [u32; PLACES],
    len: usize,
}

/// Rows that go together, the first of them in place of those that are missing, and how many they are.
#[derive(Clone, Copy)]
pub(super) struct Packet {
    pub(super) rows: [u32; LANES],
    pub(super) len: usize,
}

impl Packet {
    /// A bit for each that is not missing.
    pub(super) fn present(&self) -> u32 {
        (1 << self.len) - 1
    }
}

impl Queue {
    pub(super) const EMPTY: Self = Self { rows: [0; PLACES], len: 0 };

    /// Puts a row in, behind no more than there is room for.
    #[inline(always)]
    pub(super) fn push(&mut self, row: u32) {
        self.rows[self.len % PLACES] = row;
        self.len += 1;
    }

    /// Puts in those from the first on that are marked.
    #[inline(always)]
    pub(super) fn push_all(&mut self, first: u32, mut marks: u64) {
        let end = self.len + marks.count_ones() as usize;
        let Some(places) = self.rows.get_mut(self.len..end) else { return };
        for place in places {
            *place = first + marks.trailing_zeros();
            marks &= marks.wrapping_sub(1);
        }
        self.len = end;
    }

    /// The last eight, once there are so many.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Packet> {
        let rest = self.len.checked_sub(LANES)?;
        let rows = *self.rows.get(rest..)?.first_chunk()?;
        self.len = rest;
        Some(Packet { rows, len: LANES })
    }

    /// Those who still wait, if anybody does.
    pub(super) fn rest(&self) -> Option<Packet> {
        let mut rows = *self.rows.first_chunk()?;
        let (first, len) = (rows[0], self.len.min(LANES));
        rows[len..].fill(first);
        (len > 0).then_some(Packet { rows, len })
    }
}

/// The numbers of the bits that are set.
pub(super) fn ones(bits: impl Into<u64>) -> impl Iterator<Item = usize> {
    let mut bits = bits.into();
    core::iter::from_fn(move || {
        let i = bits.trailing_zeros() as usize % u64::BITS as usize;
        let any = bits != 0;
        bits &= bits.wrapping_sub(1);
        any.then_some(i)
    })
}
