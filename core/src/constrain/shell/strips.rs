//! Eight rows of a symmetric matrix side by side, so that products and sweeps go through them in lanes.
//!
//! All rows are cut into eight parts of as many one behind the other, and a strip has one row of each part: those beside each other in a lane
//! follow each other in the mesh, those beside each other in a strip are far apart. So a sweep through one strip after the other
//! is one of Gauss and Seidel's method, and the rows that those of a strip are linked with most often are those of another.
//!
//! Each link is there once, at the row of the later strip: what it does to both rows is told when that strip's turn comes, since matrices of fine
//! meshes are larger than caches, and it is the memory that products and sweeps wait for.
//!
//! Where a row has many more links than those beside it, the rest of its links go eight side by side in entries of their own, which are
//! mixed: any lane may have a link of any row. So there is always room, whatever the mesh, for little more than as many places as links. Links within a
//! strip, of which there are some in small meshes, are among these.

mod make;

use crate::lanes::{Eight, LANES, Vectors, mask_of};
use core::ops::Range;

/// Where nothing is.
pub(super) const NONE: u32 = u32::MAX;
/// Words to put the links of a strip in order in: those of a strip with more are mixed as they come.
pub(super) const KEYS: usize = 512;
/// What the base of a mixed entry says: this, and three bits for each lane that tell whose link it has.
const MIXED: u32 = 1 << 31;
/// A mixed entry whose lanes are those of the strip.
const IN_TURN: u32 = MIXED | 0o7654_3210;
/// Links of a graph, in strips of eight rows: an entry has one link of each to a row of an earlier strip, or none, and names the row itself
/// then. Rows are named by their places: the lane in the strip, and eight times the strip.
#[derive(Clone, Copy, Default)]
pub(super) struct Strips<'m> {
    /// Where the entries of each strip begin and which is the first mixed one; and where the last one's end.
    starts: &'m [u32],
    /// The first of eight rows that lie one behind the other as their links do, if they do; of mixed entries whose links they have.
    bases: &'m [u32],
    columns: &'m [[u32; LANES]],
}

/// Where a link is: its entry and lane, and whether it is there as one from the other row.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) entry: usize,
    pub(super) lane: usize,
    pub(super) back: bool,
}

/// Entries for so many links of so many rows, there and back. If all are mixed it takes a sixteenth of the links, and in each strip some places stay
/// empty; with half of that more, those of uneven meshes seldom have to be.
pub(super) fn entries(rows: usize, links: usize) -> usize {
    let once = links / 2;
    once / LANES + once / (2 * LANES) + rows.div_ceil(LANES).min(once)
}

/// The number of words that tell where entries begin.
fn ends(rows: usize) -> usize {
    2 * rows.div_ceil(LANES) + 1
}

/// Words for so many rows and entries.
pub(super) fn words(rows: usize, entries: usize) -> usize {
    entries.saturating_mul(1 + LANES).saturating_add(ends(rows))
}

impl<'m> Strips<'m> {
    pub(super) fn of(rows: usize, entries: usize, words: &'m [u32]) -> Self {
        let mut rest = words;
        let mut next = |len: usize| {
            let (first, others) = rest.split_at(rest.len().min(len));
            rest = others;
            first
        };
        let (starts, bases) = (next(ends(rows)), next(entries));
        Self { starts, bases, columns: bytemuck::cast_slice(next(entries.saturating_mul(LANES))) }
    }

    /// The number of entries.
    pub(super) fn entries(&self) -> usize {
        self.starts.last().map_or(0, |&end| end as usize)
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len() / 2
    }

    /// The entries of a strip in which each lane has links of its own row.
    #[inline(always)]
    pub(super) fn range(&self, strip: usize) -> Range<usize> {
        self.between(2 * strip, 2 * strip + 1)
    }

    /// Its mixed entries: most often none.
    #[inline(always)]
    pub(super) fn mixed(&self, strip: usize) -> Range<usize> {
        self.between(2 * strip + 1, 2 * strip + 2)
    }

    /// All of its entries.
    #[inline(always)]
    pub(super) fn all(&self, strip: usize) -> Range<usize> {
        self.between(2 * strip, 2 * strip + 2)
    }

    #[inline(always)]
    fn between(&self, first: usize, last: usize) -> Range<usize> {
        match (self.starts.get(first), self.starts.get(last)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        }
    }

    /// Entries, and what there is of each.
    #[inline(always)]
    pub(super) fn each<'a, T>(
        &self,
        range: Range<usize>,
        of: &'a [T],
    ) -> impl Iterator<Item = (Entry<'m>, &'a T)> + use<'a, 'm, T> {
        self.entries_in(range.clone()).zip(of.get(range).unwrap_or(&[]))
    }

    /// The same to change it.
    #[inline(always)]
    pub(super) fn each_mut<'a, T>(
        &self,
        range: Range<usize>,
        of: &'a mut [T],
    ) -> impl Iterator<Item = (Entry<'m>, &'a mut T)> + use<'a, 'm, T> {
        self.entries_in(range.clone()).zip(of.get_mut(range).unwrap_or(&mut []))
    }

    #[inline(always)]
    fn entries_in(&self, range: Range<usize>) -> impl Iterator<Item = Entry<'m>> + use<'m> {
        let (bases, columns) = (self.bases.get(range.clone()), self.columns.get(range));
        let entries = bases.unwrap_or(&[]).iter().zip(columns.unwrap_or(&[]));
        entries.map(
            #[inline(always)]
            |(&base, columns)| Entry { base, columns },
        )
    }

    /// The strip of a row, and its lane.
    #[inline(always)]
    pub(super) fn at(&self, row: usize) -> (usize, usize) {
        let strips = self.len().max(1);
        (row % strips, row / strips)
    }

    /// The place of a row.
    pub(super) fn slot(&self, row: usize) -> usize {
        let (strip, lane) = self.at(row);
        LANES * strip + lane
    }

    /// The rows of a strip; some at the end may be none.
    #[inline(always)]
    pub(super) fn rows(&self, strip: usize) -> [usize; LANES] {
        let strips = self.len();
        let mut rows = [strip; LANES];
        for (lane, row) in rows.iter_mut().enumerate() {
            *row += lane * strips;
        }
        rows
    }

    /// Where the link of two rows is.
    pub(super) fn place(&self, row: usize, other: u32) -> Option<Place> {
        let other = other as usize;
        let [one, two] = [row, other].map(|row| self.slot(row));
        let (from, to, back) = if one > two { (one, two, false) } else { (two, one, true) };
        let (strip, lane, to) = (from / LANES, from % LANES, to as u32);
        if one == two {
            return None;
        }
        let all = self.all(strip);
        let mut entries = all.clone().zip(self.entries_in(all));
        let found = entries.find_map(|(entry, links)| {
            if !links.is_mixed() {
                return (links.columns[lane] == to).then_some((entry, lane));
            }
            let mut lanes = links.columns.iter().enumerate();
            let is_it = |&(at, &column): &(usize, &u32)| column == to && links.owner(at) == lane;
            lanes.find(is_it).map(|(at, _)| (entry, at))
        });
        found.map(|(entry, lane)| Place { entry, lane, back })
    }
}

/// Eight links, one in each lane.
#[derive(Clone, Copy)]
pub(super) struct Entry<'m> {
    /// See [`Strips`].
    base: u32,
    columns: &'m [u32; LANES],
}

impl<'m> Entry<'m> {
    /// The places that they lead to.
    #[inline(always)]
    pub(super) fn columns(&self) -> &'m [u32; LANES] {
        self.columns
    }

    /// Whose links a mixed entry has.
    #[inline(always)]
    pub(super) fn owners(&self) -> Owners {
        Owners(self.base)
    }

    /// The lane of the row whose link a mixed entry has in one.
    #[inline(always)]
    pub(super) fn owner(&self, lane: usize) -> usize {
        self.owners().of(lane)
    }

    #[inline(always)]
    fn is_mixed(&self) -> bool {
        self.base & MIXED != 0 && self.base != NONE
    }

    /// Numbers that rows have of their own, for the links of each.
    #[inline(always)]
    pub(super) fn lent<F: Eight>(&self, like: F, own: F) -> F {
        if self.is_mixed() { self.owners().lent_number(like, own) } else { own }
    }

    /// With what comes of links added to the sums of their rows.
    #[inline(always)]
    pub(super) fn added<F: Eight>(&self, like: F, sum: F, parts: F) -> F {
        if self.is_mixed() { self.owners().add_number(like, sum, parts) } else { sum + parts }
    }

    /// The strip whose rows it links with, lane by lane, if that is so.
    #[inline(always)]
    pub(super) fn strip(&self) -> Option<usize> {
        let base = self.base as usize;
        (self.base & MIXED == 0 && base.is_multiple_of(LANES)).then_some(base / LANES)
    }

    /// A bit for each lane of a mixed entry that leads to a row of the same strip.
    #[inline(always)]
    pub(super) fn within(&self, strip: usize) -> u32 {
        let lanes = self.columns.iter().enumerate();
        lanes.fold(0, |bits, (lane, &other)| bits | u32::from(other as usize / LANES == strip) << lane)
    }

    /// The same as a mask, if there is any.
    #[inline(always)]
    pub(super) fn mask_within<F: Eight>(&self, like: F, strip: usize) -> Option<F> {
        let within = self.within(strip);
        (within != 0).then(
            #[inline(always)]
            || mask_of(like, within),
        )
    }

    /// The run of eight that it links with, if they are one.
    #[inline(always)]
    fn run(&self) -> Range<usize> {
        let base = self.base as usize;
        base..base.wrapping_add(LANES)
    }

    /// The numbers of those that it links with.
    #[inline(always)]
    pub(super) fn numbers<F: Eight>(&self, like: F, column: &[f32]) -> F {
        match column.get(self.run()).and_then(|run| run.first_chunk()) {
            Some(run) => like.of(*run),
            None => gathered(like, column, self.columns),
        }
    }

    /// Their vectors, by columns of one length.
    #[inline(always)]
    pub(super) fn vectors<F: Eight>(&self, like: F, [x, y, z]: [&[f32]; 3]) -> Vectors<F> {
        Vectors([self.numbers(like, x), self.numbers(like, y), self.numbers(like, z)])
    }

    /// Takes vectors from theirs.
    #[inline(always)]
    pub(super) fn take_from<F: Eight>(&self, like: F, to: &mut [&mut [f32]; 3], Vectors([a, b, c]): Vectors<F>) {
        let [x, y, z] = to;
        self.take_numbers(like, x, a);
        self.take_numbers(like, y, b);
        self.take_numbers(like, z, c);
    }

    #[inline(always)]
    fn take_numbers<F: Eight>(&self, like: F, to: &mut [f32], part: F) {
        match to.get_mut(self.run()).and_then(|run| run.first_chunk_mut()) {
            Some(run) => *run = (like.of(*run) - part).to_array(),
            None => scatter(to, self.columns, part.to_array()),
        }
    }
}

/// Takes numbers from those of some rows, one after the other.
#[inline(always)]
fn scatter(column: &mut [f32], rows: &[u32; LANES], parts: [f32; LANES]) {
    for (&row, part) in rows.iter().zip(parts) {
        if let Some(to) = column.get_mut(row as usize) {
            *to -= part;
        }
    }
}

#[inline(always)]
fn gathered<F: Eight>(like: F, column: &[f32], rows: &[u32; LANES]) -> F {
    let mut lanes = [0.0; LANES];
    for (lane, &row) in lanes.iter_mut().zip(rows) {
        *lane = column.get(row as usize).copied().unwrap_or(0.0);
    }
    like.of(lanes)
}

/// Whose links a mixed entry has: three bits for each lane.
#[derive(Clone, Copy)]
pub(super) struct Owners(u32);

impl Owners {
    #[inline(always)]
    fn of(self, lane: usize) -> usize {
        (self.0 >> (3 * lane)) as usize % LANES
    }

    /// What rows have of their own, for the links of each.
    #[inline(always)]
    pub(super) fn lent<F: Eight>(self, like: F, own: Vectors<F>) -> Vectors<F> {
        let (own, mut rows) = (own.rows(), [[0.0; 4]; LANES]);
        for (lane, row) in rows.iter_mut().enumerate() {
            *row = own[self.of(lane)];
        }
        Vectors(like.columns_of(rows))
    }

    /// Adds what comes of links to the sums of their rows, one link after the other.
    #[inline(always)]
    pub(super) fn add<F: Eight>(self, like: F, sum: Vectors<F>, parts: Vectors<F>) -> Vectors<F> {
        let (mut rows, parts) = (sum.rows(), parts.rows());
        for (lane, [x, y, z, _]) in parts.into_iter().enumerate() {
            let [a, b, c, _] = &mut rows[self.of(lane)];
            (*a, *b, *c) = (*a + x, *b + y, *c + z);
        }
        Vectors(like.columns_of(rows))
    }

    /// The same for numbers.
    #[inline(always)]
    fn lent_number<F: Eight>(self, like: F, own: F) -> F {
        let (own, mut lanes) = (own.to_array(), [0.0; LANES]);
        for (lane, number) in lanes.iter_mut().enumerate() {
            *number = own[self.of(lane)];
        }
        like.of(lanes)
    }

    /// The same for numbers.
    #[inline(always)]
    fn add_number<F: Eight>(self, like: F, sum: F, parts: F) -> F {
        let mut lanes = sum.to_array();
        for (lane, part) in parts.to_array().into_iter().enumerate() {
            lanes[self.of(lane)] += part;
        }
        like.of(lanes)
    }
}
