//! Eight rows of a matrix side by side, so that products and sweeps go through them in lanes.
//!
//! All rows are cut into eight parts of as many one behind the other, and a strip has one row of each part: those beside each other in a lane
//! follow each other in the mesh, those beside each other in a strip are far apart. So a sweep through one strip after the other
//! is one of Gauss and Seidel's method, and the rows that those of a strip are linked with most often are those of another.
//!
//! Where a row has many more links than those beside it, the rest of its links go eight side by side in entries of their own, which are
//! mixed: any lane may have a link of any row. So there is always room, whatever the mesh, for little more than as many places as links.

use super::mesh::Graph;
use crate::lanes::{Eight, LANES, Vectors};
use crate::memory::take;
use core::ops::Range;

/// Where nothing is.
pub(super) const NONE: u32 = u32::MAX;
/// So many of eight rows have to be linked with rows that lie one behind the other for these to be taken as they lie.
const RUN: usize = 4;
/// Words to put the links of a strip in order in: those of a strip with more are mixed as they come.
pub(super) const KEYS: usize = 512;
/// How many others a mixed entry has to spare: what it adds up goes to its rows one by one.
const WORTH: usize = 3;
/// What the base of a mixed entry says: this, and three bits for each lane that tell whose link it has.
const MIXED: u32 = 1 << 31;
/// A mixed entry whose lanes are those of the strip.
const IN_TURN: u32 = MIXED | 0o7654_3210;
/// A bit for each lane.
pub(super) const ALL: u32 = (1 << LANES) - 1;

/// Who is linked with whom, in strips of eight rows: an entry has one link of each, or none, and names the row itself then. Rows are named by
/// their places: the lane in the strip, and eight times the strip.
#[derive(Clone, Copy, Default)]
pub(super) struct Strips<'m> {
    /// Where the entries of each strip begin and which is the first mixed one; and where the last one's end.
    starts: &'m [u32],
    /// The first of eight rows that lie one behind the other as their links do, if they do; of mixed entries whose links they have.
    bases: &'m [u32],
    /// A bit for each link to a row of an earlier strip, and one after these for each to one of the same.
    below: &'m [u32],
    columns: &'m [[u32; LANES]],
}

/// Entries for so many links of so many rows. If all are mixed it takes an eighth of the links, and in each strip some places stay empty; with half of
/// that more, those of uneven meshes seldom have to be.
pub(super) fn entries(rows: usize, links: usize) -> usize {
    links / LANES + links / (2 * LANES) + rows.div_ceil(LANES).min(links)
}

/// The number of words that tell where entries begin.
fn ends(rows: usize) -> usize {
    2 * rows.div_ceil(LANES) + 1
}

/// Words for so many rows and entries.
pub(super) fn words(rows: usize, entries: usize) -> usize {
    entries.saturating_mul(2 + LANES).saturating_add(ends(rows))
}

impl<'m> Strips<'m> {
    pub(super) fn of(rows: usize, entries: usize, words: &'m [u32]) -> Self {
        let mut rest = words;
        let mut next = |len: usize| {
            let (first, others) = rest.split_at(rest.len().min(len));
            rest = others;
            first
        };
        let (starts, bases, below) = (next(ends(rows)), next(entries), next(entries));
        Self { starts, bases, below, columns: bytemuck::cast_slice(next(entries.saturating_mul(LANES))) }
    }

    /// Puts the links of a graph into words, with others to work with; tells whether there is room, as there is for so many links as `entries`
    /// has been told.
    pub(super) fn make(graph: &Graph<'_>, entries: usize, words: &mut [u32], work: &mut [u32]) -> Option<()> {
        let rows = graph.starts.len().saturating_sub(1);
        let mut rest = words;
        let starts = take(&mut rest, ends(rows));
        let [bases, below] = [0, 1].map(|_| take(&mut rest, entries));
        let columns = bytemuck::cast_slice_mut(take(&mut rest, entries.saturating_mul(LANES)));
        let strips = rows.div_ceil(LANES);
        let least = (0..strips).map(|strip| count(graph, [strip, strips]).div_ceil(LANES)).sum();
        let keys = work.get_mut(..KEYS)?;
        let mut making = Making { bases, below, columns, end: 0, spare: entries.checked_sub(least)? };
        for (strip, [start, mixed]) in starts.as_chunks_mut().0.iter_mut().enumerate() {
            *start = making.end as u32;
            *mixed = making.strip(graph, [strip, strips], keys)? as u32;
        }
        *starts.last_mut()? = making.end as u32;
        Some(())
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

    /// The mixed entries of a strip: most often none.
    #[inline(always)]
    pub(super) fn mixed(&self, strip: usize) -> Range<usize> {
        self.between(2 * strip + 1, 2 * strip + 2)
    }

    /// All entries of a strip.
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

    /// Whose links a mixed entry has.
    #[inline(always)]
    pub(super) fn owners(&self, entry: usize) -> Owners {
        Owners(self.bases.get(entry).copied().unwrap_or(IN_TURN))
    }

    /// The lane of the row whose link an entry has in one.
    #[inline(always)]
    pub(super) fn owner(&self, entry: usize, lane: usize) -> usize {
        match self.owners(entry) {
            Owners(base) if base & MIXED == 0 || base == NONE => lane,
            owners => owners.of(lane),
        }
    }

    #[inline(always)]
    pub(super) fn columns(&self, entry: usize) -> &'m [u32; LANES] {
        self.columns.get(entry).unwrap_or(&[0; LANES])
    }

    /// A bit for each of an entry's links to a row of an earlier strip.
    #[inline(always)]
    pub(super) fn below(&self, entry: usize) -> u32 {
        self.below.get(entry).map_or(0, |below| below & ALL)
    }

    /// A bit for each of an entry's links to a row of the same strip.
    pub(super) fn within(&self, entry: usize) -> u32 {
        self.below.get(entry).map_or(0, |below| below >> LANES)
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

    /// The entry that has the link of two rows, and its lane there.
    pub(super) fn place(&self, row: usize, other: u32) -> Option<(usize, usize)> {
        let ((strip, lane), (there, beside)) = (self.at(row), self.at(other as usize));
        let other = (LANES * there + beside) as u32;
        if other == (LANES * strip + lane) as u32 {
            return None;
        }
        let plain = self.range(strip).find(|&entry| self.columns(entry).get(lane) == Some(&other));
        plain.map(|entry| (entry, lane)).or_else(|| {
            self.mixed(strip).find_map(|entry| {
                let mut lanes = self.columns(entry).iter().enumerate();
                let is_it = |&(at, &column): &(usize, &u32)| column == other && self.owner(entry, at) == lane;
                lanes.find(is_it).map(|(at, _)| (entry, at))
            })
        })
    }

    /// The numbers of those that an entry links with.
    #[inline(always)]
    pub(super) fn numbers<F: Eight>(&self, like: F, column: &[f32], entry: usize) -> F {
        let base = self.bases.get(entry).map_or(usize::MAX, |&base| base as usize);
        match column.get(base..).and_then(|run| run.first_chunk()) {
            Some(run) => like.of(*run),
            None => gathered(like, column, self.columns(entry)),
        }
    }

    /// The vectors of those that an entry links with.
    #[inline(always)]
    pub(super) fn vectors<F: Eight>(&self, like: F, [x, y, z]: [&[f32]; 3], entry: usize) -> Vectors<F> {
        Vectors([self.numbers(like, x, entry), self.numbers(like, y, entry), self.numbers(like, z, entry)])
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
    pub(super) fn lent_number<F: Eight>(self, like: F, own: F) -> F {
        let (own, mut lanes) = (own.to_array(), [0.0; LANES]);
        for (lane, number) in lanes.iter_mut().enumerate() {
            *number = own[self.of(lane)];
        }
        like.of(lanes)
    }

    /// The same for numbers.
    #[inline(always)]
    pub(super) fn add_number<F: Eight>(self, like: F, sum: F, parts: F) -> F {
        let mut lanes = sum.to_array();
        for (lane, part) in parts.to_array().into_iter().enumerate() {
            lanes[self.of(lane)] += part;
        }
        like.of(lanes)
    }
}

/// Entries as they are made.
struct Making<'w> {
    bases: &'w mut [u32],
    below: &'w mut [u32],
    columns: &'w mut [[u32; LANES]],
    end: usize,
    /// Entries that would be left if all from here on were mixed.
    spare: usize,
}

/// How the links of a strip's rows are put into entries: so many whose links lie one behind the other, so many in which each lane has others of
/// its own row, and so many for all that is left.
#[derive(Clone, Copy)]
struct Plan {
    runs: usize,
    plain: usize,
    mixed: usize,
}

impl Plan {
    fn of(keys: &[u32], slots: usize) -> Self {
        let (mut runs, mut others, mut all) = (0, [0; LANES], [0; LANES]);
        for links in together(keys) {
            let run = is_run(links, slots);
            runs += usize::from(run);
            for &key in links {
                all[lane(key)] += 1;
                others[lane(key)] += usize::from(!run);
            }
        }
        let most = |counts: &[usize; LANES]| counts.iter().fold(0, |most, &count| most.max(count));
        if 2 * (runs + most(&others)) > 3 * most(&all) {
            // Where few go together, each has its own places: as many as whoever has most.
            (runs, others) = (0, all);
        }
        let mixed = |plain: usize| others.iter().map(|&count| usize::saturating_sub(count, plain)).sum::<usize>();
        let cost = |&plain: &usize| plain + WORTH * mixed(plain).div_ceil(LANES);
        // The most of those that cost the same.
        let plain = (0..=most(&others)).rev().min_by_key(cost).unwrap_or(0);
        Self { runs, plain, mixed: mixed(plain).div_ceil(LANES) }
    }
}

impl Making<'_> {
    /// Adds the entries of a strip, one of so many, and tells which is the first mixed one.
    fn strip(&mut self, graph: &Graph<'_>, [strip, strips]: [usize; 2], keys: &mut [u32]) -> Option<usize> {
        let least = count(graph, [strip, strips]).div_ceil(LANES);
        let keys = sorted(graph, [strip, strips], keys);
        let plan = keys.map(|keys| Plan::of(keys, LANES * strips));
        let plan = plan.filter(|plan| plan.runs + plan.plain + plan.mixed <= least + self.spare);
        let plan = plan.unwrap_or(Plan { runs: 0, plain: 0, mixed: least });
        self.spare = (self.spare + least).checked_sub(plan.runs + plan.plain + plan.mixed)?;
        let first = self.end + plan.runs;
        let mixed = first + plan.plain;
        (self.end..mixed).try_for_each(|_| self.add(strip, NONE))?;
        (0..plan.mixed).try_for_each(|_| self.add(strip, IN_TURN))?;
        let (mut run, mut counts, mut left) = (first - plan.runs, [0; LANES], 0);
        let mut put = |making: &mut Self, lane: usize, slot: usize| {
            let count = counts[lane];
            counts[lane] += 1;
            if count < plan.plain {
                return making.set([first + count, lane], slot, strip);
            }
            making.own(mixed + left / LANES, left % LANES, lane);
            making.set([mixed + left / LANES, left % LANES], slot, strip);
            left += 1;
        };
        let Some(keys) = keys else {
            for lane in 0..LANES {
                let row = graph.row(lane * strips + strip).iter();
                row.for_each(|&link| put(self, lane, slot(link, strips)));
            }
            return Some(mixed);
        };
        for links in together(keys) {
            if plan.runs > 0 && is_run(links, LANES * strips) {
                self.run(run, links, strip);
                run += 1;
            } else {
                links.iter().for_each(|&key| put(self, lane(key), led_to(key)));
            }
        }
        Some(mixed)
    }

    /// Adds an entry without links.
    fn add(&mut self, strip: usize, base: u32) -> Option<()> {
        let at = self.end;
        *self.columns.get_mut(at)? = core::array::from_fn(|lane| (LANES * strip + lane) as u32);
        (self.bases[at], self.below[at]) = (base, 0);
        self.end += 1;
        Some(())
    }

    /// Puts links that lie one behind the other into an entry.
    fn run(&mut self, at: usize, links: &[u32], strip: usize) {
        let Some(&first) = links.first() else { return };
        let base = led_to(first) - lane(first);
        self.bases[at] = base as u32;
        links.iter().for_each(|&key| self.set([at, lane(key)], led_to(key), strip));
        // Where there is no link nothing comes of it.
        let below = (0..LANES).filter(|&lane| base + lane < LANES * strip);
        below.for_each(|lane| self.below[at] |= 1 << lane);
    }

    fn set(&mut self, [at, lane]: [usize; 2], other: usize, strip: usize) {
        self.columns[at][lane] = other as u32;
        let there = other / LANES;
        self.below[at] |= u32::from(there < strip) << lane | u32::from(there == strip) << (LANES + lane);
    }

    /// Says whose link a mixed entry has in a lane.
    fn own(&mut self, at: usize, lane: usize, owner: usize) {
        let base = &mut self.bases[at];
        *base = *base & !(7 << (3 * lane)) | (owner as u32) << (3 * lane);
    }
}

/// The number of links of a strip's rows, one of so many strips.
fn count(graph: &Graph<'_>, [strip, strips]: [usize; 2]) -> usize {
    (0..LANES).map(|lane| graph.row(lane * strips + strip).len()).sum()
}

/// The place of a row, of so many strips.
fn slot(row: u32, strips: usize) -> usize {
    LANES * (row as usize % strips) + row as usize / strips
}

/// The links of a strip's rows, if there is room for all: each a number that says where the first of eight would lead that lie one behind the other,
/// eight more than its place, so that it is not below zero; and in which lane it is. They are in order.
fn sorted<'k>(graph: &Graph<'_>, [strip, strips]: [usize; 2], keys: &'k mut [u32]) -> Option<&'k [u32]> {
    let mut count = 0;
    for lane in 0..LANES {
        for &link in graph.row(lane * strips + strip) {
            *keys.get_mut(count)? = (LANES * (slot(link, strips) + LANES - lane) + lane) as u32;
            count += 1;
        }
    }
    let keys = &mut keys[..count];
    keys.sort_unstable();
    Some(keys)
}

/// The lane of a link, and the place that it leads to.
fn lane(key: u32) -> usize {
    key as usize % LANES
}

fn led_to(key: u32) -> usize {
    key as usize / LANES + lane(key) - LANES
}

/// Those that would lie one behind the other.
fn together(keys: &[u32]) -> impl Iterator<Item = &[u32]> {
    keys.chunk_by(|one, other| one / LANES as u32 == other / LANES as u32)
}

/// Tells whether links are taken as they lie, one behind the other, of so many places.
fn is_run(links: &[u32], slots: usize) -> bool {
    let first = links.first().map_or(0, |&key| key as usize / LANES);
    links.len() >= RUN && (LANES..=slots).contains(&first)
}
