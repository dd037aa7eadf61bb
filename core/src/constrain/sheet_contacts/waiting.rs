//! Pairs that wait until as many of a kind are there as are taken side by side.

use super::pair::Pair;
use crate::lanes::{LANES, PARTS};

/// As many as can wait.
pub(super) const ROOM: usize = PARTS * LANES;

/// Pairs of one kind, with their corners and how far apart they are kept.
#[derive(Clone, Copy)]
pub(super) struct Waiting {
    pub(super) pairs: [Pair; ROOM],
    pub(super) corners: [[[u32; 4]; LANES]; PARTS],
    pub(super) wanted: [[f32; LANES]; PARTS],
    pub(super) len: usize,
}

impl Waiting {
    /// None of either kind.
    pub(super) const fn none() -> [Self; 2] {
        let (corners, wanted) = ([[[0; 4]; LANES]; PARTS], [[0.0; LANES]; PARTS]);
        [Self { pairs: [Pair::NONE; ROOM], corners, wanted, len: 0 }; 2]
    }

    /// Adds one; tells whether there is no room for more now. Where there was none already, those are over.
    pub(super) fn push(&mut self, pair: Pair, corners: [u32; 4], wanted: f32) -> bool {
        let at = self.len % ROOM;
        self.pairs[at] = pair;
        self.corners.as_flattened_mut()[at] = corners;
        self.wanted.as_flattened_mut()[at] = wanted;
        self.len = at + 1;
        self.len == ROOM
    }

    /// Those with a bit in a mask.
    pub(super) fn of_mask(&self, mask: u32) -> impl Iterator<Item = (usize, Pair, [u32; 4], f32)> {
        let all = (0..self.len).filter(move |lane| mask >> lane & 1 != 0);
        let (corners, wanted) = (self.corners.as_flattened(), self.wanted.as_flattened());
        all.map(|lane| (lane, self.pairs[lane], corners[lane], wanted[lane]))
    }
}
