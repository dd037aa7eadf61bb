//! Eight rows of a matrix side by side, so that products and sweeps go through them in lanes.
//!
//! All rows are cut into eight parts of as many one behind the other, and a strip has one row of each part: those beside each other in a lane
//! follow each other in the mesh, those beside each other in a strip are far apart. So a sweep through one strip after the other
//! is one of Gauss and Seidel's method, and the rows that those of a strip are linked with most often are those of another.

use super::mesh::Graph;
use crate::lanes::{Eight, LANES, Vectors};
use crate::memory::take;

/// Where nothing is.
pub(super) const NONE: u32 = u32::MAX;
/// So many of eight rows have to be linked with rows that lie one behind the other for these to be taken as they lie.
const RUN: u32 = 4;
/// The most links that the rows of a strip may have: who is linked with hundreds is not solved in strips.
const KEYS: usize = 512;
/// A bit for each lane.
pub(super) const ALL: u32 = (1 << LANES) - 1;

/// Who is linked with whom, in strips of eight rows: an entry has one link of each, or none, and names the row itself then. Rows are named by
/// their places: the lane in the strip, and eight times the strip.
#[derive(Clone, Copy, Default)]
pub(super) struct Strips<'m> {
    /// Where the entries of each strip begin, and where the last one's end.
    starts: &'m [u32],
    /// The first of eight rows that lie one behind the other as their links do, if they do.
    bases: &'m [u32],
    /// A bit for each link to a row of an earlier strip, and one after these for each to one of the same.
    below: &'m [u32],
    columns: &'m [[u32; LANES]],
}

/// Entries for so many links: rows with fewer than their neighbours leave places empty.
pub(super) fn entries(links: usize) -> usize {
    links / 4 + links / 8 + 16
}

/// Words for so many rows and entries.
pub(super) fn words(rows: usize, entries: usize) -> usize {
    rows.div_ceil(LANES) + 1 + (2 + LANES) * entries
}

impl<'m> Strips<'m> {
    pub(super) fn of(rows: usize, entries: usize, words: &'m [u32]) -> Self {
        let mut rest = words;
        let mut next = |len: usize| {
            let (first, others) = rest.split_at(rest.len().min(len));
            rest = others;
            first
        };
        let (starts, bases, below) = (next(rows.div_ceil(LANES) + 1), next(entries), next(entries));
        Self { starts, bases, below, columns: bytemuck::cast_slice(next(LANES * entries)) }
    }

    /// Puts the links of a graph into words; tells whether there is room.
    pub(super) fn make(graph: &Graph<'_>, entries: usize, words: &mut [u32]) -> Option<()> {
        let rows = graph.starts.len().saturating_sub(1);
        let mut rest = words;
        let starts = take(&mut rest, rows.div_ceil(LANES) + 1);
        let [bases, below] = [0, 1].map(|_| take(&mut rest, entries));
        let columns = bytemuck::cast_slice_mut(take(&mut rest, LANES * entries));
        let mut making = Making { bases, below, columns, end: 0 };
        let strips = rows.div_ceil(LANES);
        for (strip, start) in starts.iter_mut().enumerate() {
            *start = making.end as u32;
            if strip < strips {
                making.strip(graph, strip)?;
            }
        }
        Some(())
    }

    /// The number of entries.
    pub(super) fn entries(&self) -> usize {
        self.starts.last().map_or(0, |&end| end as usize)
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The entries of a strip.
    #[inline(always)]
    pub(super) fn range(&self, strip: usize) -> core::ops::Range<usize> {
        match (self.starts.get(strip), self.starts.get(strip + 1)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
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

    /// The entry that has the link of two rows, and its lane.
    pub(super) fn place(&self, row: usize, other: u32) -> Option<(usize, usize)> {
        let ((strip, lane), (there, beside)) = (self.at(row), self.at(other as usize));
        let other = (LANES * there + beside) as u32;
        let entry = self.range(strip).find(|&entry| self.columns(entry).get(lane) == Some(&other))?;
        (other != (LANES * strip + lane) as u32).then_some((entry, lane))
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

/// Entries as they are made.
struct Making<'w> {
    bases: &'w mut [u32],
    below: &'w mut [u32],
    columns: &'w mut [[u32; LANES]],
    end: usize,
}

impl Making<'_> {
    /// Adds the entries of a strip: first those whose links lie one behind the other, then the others as they come.
    fn strip(&mut self, graph: &Graph<'_>, strip: usize) -> Option<()> {
        let strips = (graph.starts.len() - 1).div_ceil(LANES);
        let is_run = |base: i64, lanes: u32| {
            base >= 0 && base + LANES as i64 <= (LANES * strips) as i64 && lanes.count_ones() >= RUN
        };
        let (mut runs, mut others, mut all) = (0, [0; LANES], [0; LANES]);
        each(graph, [strip, strips], |base, lanes| {
            let run = is_run(base, lanes);
            runs += usize::from(run);
            for lane in (0..LANES).filter(|lane| lanes & 1 << lane != 0) {
                all[lane] += 1;
                others[lane] += usize::from(!run);
            }
            Some(())
        })?;
        // Where few go together, each has its own places: as many as whoever has most.
        let most = |counts: [usize; LANES]| counts.into_iter().fold(0, usize::max);
        let pays = 2 * (runs + most(others)) <= 3 * most(all);
        let is_run = |base: i64, lanes: u32| pays && is_run(base, lanes);
        each(graph, [strip, strips], |base, lanes| {
            if is_run(base, lanes) {
                let at = self.add(strip)?;
                self.bases[at] = base as u32;
                (0..LANES).filter(|lane| lanes & 1 << lane != 0).for_each(|lane| self.set(at, lane, base, strip));
                // Where there is no link nothing comes of it.
                let below = (0..LANES).filter(|&lane| base + (lane as i64) < (LANES * strip) as i64);
                below.for_each(|lane| self.below[at] |= 1 << lane);
            }
            Some(())
        })?;
        let (others, mut counts) = (self.end, [0; LANES]);
        each(graph, [strip, strips], |base, lanes| {
            for lane in (0..LANES).filter(|lane| !is_run(base, lanes) && lanes & 1 << lane != 0) {
                let at = others + counts[lane];
                counts[lane] += 1;
                if at == self.end {
                    self.add(strip)?;
                }
                self.set(at, lane, base, strip);
            }
            Some(())
        })
    }

    /// Adds an entry without links.
    fn add(&mut self, strip: usize) -> Option<usize> {
        let at = self.end;
        *self.columns.get_mut(at)? = core::array::from_fn(|lane| (LANES * strip + lane) as u32);
        (self.bases[at], self.below[at]) = (NONE, 0);
        self.end += 1;
        Some(at)
    }

    fn set(&mut self, at: usize, lane: usize, base: i64, strip: usize) {
        let other = (base + lane as i64) as usize;
        self.columns[at][lane] = other as u32;
        let there = other / LANES;
        self.below[at] |= u32::from(there < strip) << lane | u32::from(there == strip) << (LANES + lane);
    }
}

/// Tells of the links of a strip's rows, one of so many strips, where the first of eight would lead that lie one behind the other, and which of
/// them there are: from the least on.
fn each(graph: &Graph<'_>, [strip, strips]: [usize; 2], mut visit: impl FnMut(i64, u32) -> Option<()>) -> Option<()> {
    let mut keys = [(i64::MAX, 0); KEYS];
    let mut count = 0;
    for lane in 0..LANES {
        for &link in graph.row(lane * strips + strip) {
            let link = link as usize;
            let key = keys.get_mut(count)?;
            *key = ((LANES * (link % strips) + link / strips) as i64 - lane as i64, 1 << lane);
            count += 1;
        }
    }
    let mut last = i64::MIN;
    loop {
        let (mut least, mut lanes) = (i64::MAX, 0);
        for &(base, lane) in &keys[..count] {
            if base > last && base < least {
                (least, lanes) = (base, 0);
            }
            lanes |= if base == least { lane } else { 0 };
        }
        if lanes == 0 {
            return Some(());
        }
        visit(least, lanes)?;
        last = least;
    }
}
