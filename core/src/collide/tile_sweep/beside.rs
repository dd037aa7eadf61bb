//! Rows that wait until there are enough, each before a solid of its own, or before two.

use super::TileSweep;
use super::packets::Unsettled;
use crate::collide::packet::Things;
use crate::collide::tile::Tile;
use crate::collide::waiting::{EIGHTS, Packet, in_place_of, missing};
use crate::lanes::{BroadKernel, LANES, Lanes};
use crate::shape::{Face, Solid};

/// Rows that wait until there are so many, each with as many solids that it is near, in their order.
pub(super) struct Beside<const MANY: usize> {
    pub(super) rows: [[u32; LANES]; EIGHTS],
    solids: [[[Solid; LANES]; EIGHTS]; MANY],
    /// A bit for each whose solid comes after the face in their order, and for each that gets near nothing else whatever it hits.
    after: [u64; MANY],
    alone: u64,
    len: usize,
}

/// Rows past solids of a kind, so many of which are not missing.
pub(super) struct PastThings<'t, 's, 'a, const MANY: usize, const KIND: u8> {
    pub(super) of: &'t mut TileSweep<'s, 'a>,
    pub(super) len: usize,
    pub(super) waiting: &'t Beside<MANY>,
    pub(super) face: Option<Face>,
}

impl<const MANY: usize, const KIND: u8> BroadKernel for PastThings<'_, '_, '_, MANY, KIND> {
    type Output = Unsettled;

    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> Unsettled {
        let Self { of, len, waiting: Beside { rows, solids, after, alone, .. }, face } = self;
        let (first, terms, mut unsettled) = (of.first, of.terms(), Unsettled::default());
        let Tile { dt, ref obstacles, .. } = *of.tile;
        let max_bounces = obstacles.max_bounces;
        for (nth, packet) in Packet::all::<F>(rows, len) {
            let (riders, paths) = of.packet::<F, false, true>(like, &packet, first, None, terms, None);
            let things = Things::<F, MANY, KIND>::of(like, solids, after, nth, face);
            let alone = (alone >> (LANES * nth)) as u32;
            let outcome = riders.go(&paths, &things, [packet.present(), alone], dt, max_bounces);
            of.reach(outcome.farthest.largest_lane());
            unsettled.add(of.settle(&packet, first, &outcome), nth);
        }
        unsettled
    }
}

impl<const MANY: usize> Beside<MANY> {
    pub(super) const NOBODY: Self = Self {
        rows: [[0; LANES]; EIGHTS],
        solids: [[[Solid::NONE; LANES]; EIGHTS]; MANY],
        after: [0; MANY],
        alone: 0,
        len: 0,
    };

    /// Puts a row in, with its solids and whether these come after the face; true, if all places are taken now.
    pub(super) fn push(&mut self, row: u32, solids: [(Solid, bool); MANY], is_alone: bool) -> bool {
        let place = self.len % (EIGHTS * LANES);
        self.rows.as_flattened_mut()[place] = row;
        for ((all, after), (solid, is_after)) in self.solids.iter_mut().zip(&mut self.after).zip(solids) {
            all.as_flattened_mut()[place] = solid;
            *after |= u64::from(is_after) << place;
        }
        self.alone |= u64::from(is_alone) << place;
        self.len = place + 1;
        self.len == EIGHTS * LANES
    }

    /// Takes all out that are there, with others [in place of](in_place_of) those that are missing, and says how many.
    pub(super) fn take(&mut self) -> Option<(usize, Self)> {
        let len = self.len;
        if len == 0 {
            return None;
        }
        let mut taken = core::mem::replace(self, Self::NOBODY);
        for i in missing(len) {
            let other = in_place_of(i, len);
            let rows = taken.rows.as_flattened_mut();
            rows[i] = rows[other];
            for (solids, after) in taken.solids.iter_mut().zip(&mut taken.after) {
                let solids = solids.as_flattened_mut();
                solids[i] = solids[other];
                *after |= (*after >> other & 1) << i;
            }
            taken.alone |= (taken.alone >> other & 1) << i;
        }
        Some((len, taken))
    }
}
