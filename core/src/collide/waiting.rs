//! Rows that wait until there are enough of them to go side by side.

use crate::lanes::{Eight, HITS, LANES, Lanes, PARTS, Vectors};
use core::ops::Range;
use glam::Vec3;

/// Rows in the order in which they are met, with some places.
pub(super) struct List<const PLACES: usize> {
    rows: [u32; PLACES],
    len: usize,
}

/// Eights that wait until they go past something, one after the other: a few packets, so that the code which that takes is fetched for all of
/// them at once, but no more rows than a word has bits.
pub(super) const EIGHTS: usize = 8;

/// Where a row was and how fast when the step began, each with some number behind it.
pub(super) type Start = [[f32; 4]; 2];

/// Rows that wait until there are so many, eight by eight, with where they were.
pub(super) struct Queue {
    rows: [[u32; LANES]; EIGHTS],
    starts: [[Start; LANES]; EIGHTS],
    len: usize,
}

/// Rows that go together, others of them in place of those that are missing, and how many they are. Where only eight go together, these
/// are the first eight, and the second.
#[derive(Clone, Copy)]
pub(super) struct Packet<'q> {
    pub(super) rows: [&'q [u32; LANES]; PARTS],
    pub(super) len: usize,
}

/// The place of what is put in a missing one's, where there are so many: the first of the same eight, which may go without the others; if all
/// eight are missing, the first of those with whom they go. Whoever went in another packet would be read after that has moved it.
pub(super) fn in_place_of(i: usize, len: usize) -> usize {
    let first = i / LANES * LANES;
    if first < len { first } else { i / (PARTS * LANES) * (PARTS * LANES) }
}

/// The places behind so many rows in the last packet, however many go together.
pub(super) fn missing(len: usize) -> Range<usize> {
    len..len.next_multiple_of(PARTS * LANES).min(EIGHTS * LANES)
}

/// Rows that have waited, and where they were, with others [in place of](in_place_of) those that are missing.
#[derive(Clone, Copy)]
pub(super) struct Waited<'q> {
    pub(super) rows: &'q [[u32; LANES]; EIGHTS],
    pub(super) starts: &'q [[Start; LANES]; EIGHTS],
    pub(super) len: usize,
}

impl<'q> Packet<'q> {
    /// So many rows, eight by eight, as packets of what registers like `F` hold, each with the number of its first eight.
    #[inline(always)]
    pub(super) fn all<F: Lanes>(eights: &'q [[u32; LANES]], len: usize) -> impl Iterator<Item = (usize, Self)> {
        eights.chunks(F::PARTS).enumerate().map_while(
            #[inline(always)]
            move |(nth, eights)| {
                let first = F::PARTS * nth;
                let left = len.checked_sub(LANES * first).filter(|&left| left > 0)?;
                let rows = [eights.first()?, eights.last()?];
                Some((first, Self { rows, len: left.min(LANES * eights.len()) }))
            },
        )
    }

    /// A bit for each that is not missing.
    pub(super) fn present(&self) -> u32 {
        (1 << self.len) - 1
    }
}

impl<const PLACES: usize> List<PLACES> {
    #[inline(always)]
    pub(super) fn empty() -> Self {
        Self { rows: [0; PLACES], len: 0 }
    }

    /// Tells whether it has no room for another word of marks.
    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.len + (u64::BITS as usize + LANES) > PLACES
    }

    /// Puts in those from the first on that are marked, if there is room: by a table instead of one after the other, so that there is no
    /// branch to guess.
    #[inline(always)]
    pub(super) fn add(&mut self, first: u32, marks: u64) {
        let mut len = self.len;
        for (byte, marks) in marks.to_le_bytes().into_iter().enumerate() {
            let Some(places) = self.rows.get_mut(len..) else { return };
            let Some(places) = places.first_chunk_mut::<LANES>() else { return };
            let (lanes, mut rows) = (HITS[usize::from(marks)], [first + (LANES * byte) as u32; LANES]);
            for (row, lane) in rows.iter_mut().zip(lanes) {
                *row += lane;
            }
            *places = rows;
            len += marks.count_ones() as usize;
        }
        self.len = len;
    }

    /// All of them, eight by eight, who are not listed any longer, and how many they are: of the last eight, the first is in place of those
    /// that are missing.
    pub(super) fn take_eights(&mut self) -> (&[[u32; LANES]], usize) {
        let len = core::mem::take(&mut self.len);
        let (eights, _) = self.rows.as_chunks_mut();
        let eights = eights.get_mut(..len.div_ceil(LANES)).unwrap_or_default();
        let last = len - LANES * eights.len().saturating_sub(1);
        if let Some(rows) = eights.last_mut() {
            let first = rows[0];
            rows[last.min(LANES)..].fill(first);
        }
        (eights, len)
    }
}

impl Queue {
    #[inline(always)]
    pub(super) fn empty() -> Self {
        Self { rows: [[0; LANES]; EIGHTS], starts: [[[[0.0; 4]; 2]; LANES]; EIGHTS], len: 0 }
    }

    /// Puts a row in that was there, so fast. Says whether all places are taken then, who have to go before another comes.
    #[inline(always)]
    pub(super) fn push(&mut self, row: u32, [x, v]: [Vec3; 2]) -> bool {
        let place = self.len % (EIGHTS * LANES);
        self.rows.as_flattened_mut()[place] = row;
        self.starts.as_flattened_mut()[place] = [[x.x, x.y, x.z, 0.0], [v.x, v.y, v.z, 0.0]];
        self.len = place + 1;
        self.len == EIGHTS * LANES
    }

    /// Those who wait, who do not wait any longer, and how many they are.
    pub(super) fn take(&mut self) -> Option<Waited<'_>> {
        let len = core::mem::take(&mut self.len);
        let (rows, starts) = (self.rows.as_flattened_mut(), self.starts.as_flattened_mut());
        for i in missing(len) {
            (rows[i], starts[i]) = (rows[in_place_of(i, len)], starts[in_place_of(i, len)]);
        }
        (len > 0).then_some(Waited { rows: &self.rows, starts: &self.starts, len })
    }
}

/// Where they were and how fast, side by side in such registers as `like` is in.
#[inline(always)]
pub(super) fn side_by_side<F: Eight>(like: F, starts: &[Start; LANES]) -> [Vectors<F>; 2] {
    let (mut places, mut velocities) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES]);
    for (start, (place, velocity)) in starts.iter().zip(places.iter_mut().zip(&mut velocities)) {
        [*place, *velocity] = *start;
    }
    [Vectors(like.columns_of(places)), Vectors(like.columns_of(velocities))]
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
