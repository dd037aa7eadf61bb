//! Rows that wait until there are enough, each before a solid of its own.

use super::TileSweep;
use super::packets::Unsettled;
use crate::collide::packet::Things;
use crate::collide::tile::Tile;
use crate::collide::waiting::{Packet, in_place_of};
use crate::lanes::{BroadKernel, LANES, Lanes, PARTS};
use crate::shape::{Face, Solid};
use glam::Vec3;

/// Rows that wait until there are so many, each with the solid that it is near.
pub(super) struct Pairs {
    pub(super) rows: [[u32; LANES]; PARTS],
    solids: [[Solid; LANES]; PARTS],
    /// A bit for each whose solid comes after the face in their order, and for each that gets near nothing but both whatever it hits.
    after: u32,
    alone: u32,
    len: usize,
}

/// Rows past solids of a kind, so many of which are not missing.
pub(super) struct PastThings<'t, 's, 'a, const BOXES: bool> {
    pub(super) of: &'t mut TileSweep<'s, 'a>,
    pub(super) len: usize,
    pub(super) pairs: &'t Pairs,
    pub(super) face: Option<Face>,
}

impl<const BOXES: bool> BroadKernel for PastThings<'_, '_, '_, BOXES> {
    type Output = Unsettled;

    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> Unsettled {
        let Self { of, len, pairs: Pairs { rows, solids, after, alone, .. }, face } = self;
        let (first, terms, mut unsettled) = (of.first, of.terms(), Unsettled::default());
        let Tile { dt, ref obstacles, .. } = *of.tile;
        let max_bounces = obstacles.max_bounces;
        for (nth, packet) in Packet::all::<F>(rows, len) {
            let (riders, paths) = of.packet::<F, false, true>(like, &packet, first, None, terms, None);
            let solids = [&solids[nth], &solids[nth + F::PARTS - 1]];
            let [after, alone] = [after >> (LANES * nth), alone >> (LANES * nth)];
            let things = Things::<F, BOXES>::of(like, solids, after, face);
            let outcome = riders.go(&paths, &things, [packet.present(), alone], dt, max_bounces);
            of.reach(outcome.farthest.largest_lane());
            unsettled.add(of.settle(&packet, first, &outcome), nth);
        }
        unsettled
    }
}

impl Pairs {
    pub(super) const EMPTY: Self = Self {
        rows: [[0; LANES]; PARTS],
        solids: [[Solid::Sphere { center: Vec3::ZERO, radius: 0.0 }; LANES]; PARTS],
        after: 0,
        alone: 0,
        len: 0,
    };

    /// Puts a row in; true, if all places are taken now.
    pub(super) fn push(&mut self, row: u32, (solid, is_after): (Solid, bool), is_alone: bool) -> bool {
        let place = self.len % (PARTS * LANES);
        (self.rows.as_flattened_mut()[place], self.solids.as_flattened_mut()[place]) = (row, solid);
        self.after |= u32::from(is_after) << place;
        self.alone |= u32::from(is_alone) << place;
        self.len = place + 1;
        self.len == PARTS * LANES
    }

    /// Takes all out that are there, with others [in place of](in_place_of) those that are missing, and says how many.
    pub(super) fn take(&mut self) -> Option<(usize, Self)> {
        let len = self.len;
        let mut taken = core::mem::replace(self, Self::EMPTY);
        let (rows, solids) = (taken.rows.as_flattened_mut(), taken.solids.as_flattened_mut());
        for i in len..rows.len() {
            let other = in_place_of(i, len);
            (rows[i], solids[i]) = (rows[other], solids[other]);
            taken.after |= (taken.after >> other & 1) << i;
            taken.alone |= (taken.alone >> other & 1) << i;
        }
        (len > 0).then_some((len, taken))
    }
}
