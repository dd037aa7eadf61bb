//! Pairs that wait until eight of a kind are there, to be taken side by side.

use super::pair::Pair;
use crate::lanes::LANES;

/// Pairs of one kind, with their corners and how far apart they are kept.
#[derive(Clone, Copy)]
pub(super) struct Waiting {
    pub(super) pairs: [Pair; LANES],
    pub(super) corners: [[u32; 4]; LANES],
    pub(super) wanted: [f32; LANES],
    pub(super) len: usize,
}

impl Waiting {
    /// None of either kind.
    pub(super) const fn none() -> [Self; 2] {
        let none = Self { pairs: [Pair::NONE; LANES], corners: [[0; 4]; LANES], wanted: [0.0; LANES], len: 0 };
        [none; 2]
    }

    /// Adds one; tells whether there are eight now. Where there were eight already, these are over.
    pub(super) fn push(&mut self, pair: Pair, corners: [u32; 4], wanted: f32) -> bool {
        let at = self.len % LANES;
        (self.pairs[at], self.corners[at], self.wanted[at]) = (pair, corners, wanted);
        self.len = at + 1;
        self.len == LANES
    }

    /// Those with a bit in a mask.
    pub(super) fn of_mask(&self, mask: u32) -> impl Iterator<Item = (usize, Pair, [u32; 4], f32)> {
        let all = (0..self.len).filter(move |lane| mask >> lane & 1 != 0);
        all.map(|lane| (lane, self.pairs[lane], self.corners[lane], self.wanted[lane]))
    }
}
