//! How the links of a mesh are put into strips: those that lie one behind the other as runs, others by lanes of their own, the rest mixed.

use super::{IN_TURN, KEYS, NONE, Strips, ends};
use crate::constrain::shell::mesh::Graph;
use crate::lanes::LANES;
use crate::memory::take;

/// So many of eight rows have to be linked with rows that lie one behind the other for these to be taken as they lie.
const RUN: usize = 4;
/// The number of others that a mixed entry has to spare: what it adds up goes to its rows one by one.
const WORTH: usize = 3;

impl Strips<'_> {
    /// Puts the links of a graph into words, with others to work with; tells whether there is room, as there is for so many links as `entries`
    /// has been told.
    pub(in crate::constrain::shell) fn make(
        graph: &Graph<'_>,
        entries: usize,
        words: &mut [u32],
        work: &mut [u32],
    ) -> Option<()> {
        let rows = graph.starts.len().saturating_sub(1);
        let mut rest = words;
        let starts = take(&mut rest, ends(rows));
        let bases = take(&mut rest, entries);
        let columns = bytemuck::cast_slice_mut(take(&mut rest, entries.saturating_mul(LANES)));
        fill(graph, work.get_mut(..KEYS)?, starts, bases, columns)?;
        Some(())
    }
}

/// Puts the links of a graph into entries, and says where those of each strip begin, and the mixed ones among them.
fn fill(
    graph: &Graph<'_>,
    keys: &mut [u32],
    starts: &mut [u32],
    bases: &mut [u32],
    columns: &mut [[u32; LANES]],
) -> Option<()> {
    let strips = graph.starts.len().saturating_sub(1).div_ceil(LANES);
    let least: usize = (0..strips).map(|strip| count(graph, [strip, strips]).div_ceil(LANES)).sum();
    let spare = bases.len().checked_sub(least)?;
    let mut making = Making { bases, columns, end: 0, spare };
    for (strip, [start, mixed]) in starts.as_chunks_mut().0.iter_mut().enumerate() {
        *start = making.end as u32;
        *mixed = making.strip(graph, [strip, strips], keys)? as u32;
    }
    *starts.last_mut()? = making.end as u32;
    Some(())
}

/// Entries as they are made.
struct Making<'w> {
    bases: &'w mut [u32],
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
    /// By the keys of links to earlier strips, the number of those within the strip, and that of all places.
    fn of(keys: &[u32], within: usize, slots: usize) -> Self {
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
        let beyond = |plain: usize| others.iter().map(|&count| usize::saturating_sub(count, plain)).sum::<usize>();
        let mixed = |plain: usize| (within + beyond(plain)).div_ceil(LANES);
        let cost = |&plain: &usize| plain + WORTH * mixed(plain);
        // The most of those that cost the same.
        let plain = (0..=most(&others)).rev().min_by_key(cost).unwrap_or(0);
        Self { runs, plain, mixed: mixed(plain) }
    }
}

impl Making<'_> {
    /// Adds the entries of a strip, one of so many, and tells which is the first mixed one.
    fn strip(&mut self, graph: &Graph<'_>, [strip, strips]: [usize; 2], keys: &mut [u32]) -> Option<usize> {
        let least = count(graph, [strip, strips]).div_ceil(LANES);
        let is_within = |&(_, slot): &(usize, usize)| slot / LANES == strip;
        let within = kept(graph, [strip, strips]).filter(is_within).count();
        let keys = sorted(kept(graph, [strip, strips]).filter(|link| !is_within(link)), keys);
        let plan = keys.map(|keys| Plan::of(keys, within, LANES * strips));
        let plan = plan.filter(|plan| plan.runs + plan.plain + plan.mixed <= least + self.spare);
        let plan = plan.unwrap_or(Plan { runs: 0, plain: 0, mixed: least });
        self.spare = (self.spare + least).checked_sub(plan.runs + plan.plain + plan.mixed)?;
        let mut run = self.end;
        let plain = run + plan.runs;
        let mut filling = Filling { plain, mixed: plain + plan.plain, counts: [0; LANES], left: 0 };
        (run..filling.mixed).try_for_each(|_| self.add(strip, NONE))?;
        (0..plan.mixed).try_for_each(|_| self.add(strip, IN_TURN))?;
        let Some(keys) = keys else {
            kept(graph, [strip, strips]).for_each(|(lane, slot)| filling.mix(self, lane, slot));
            return Some(filling.mixed);
        };
        for links in together(keys) {
            if plan.runs > 0 && is_run(links, LANES * strips) {
                self.run(run, links);
                run += 1;
            } else {
                links.iter().for_each(|&key| filling.put(self, lane(key), led_to(key)));
            }
        }
        let within = kept(graph, [strip, strips]).filter(is_within);
        within.for_each(|(lane, slot)| filling.mix(self, lane, slot));
        Some(filling.mixed)
    }

    /// Adds an entry without links.
    fn add(&mut self, strip: usize, base: u32) -> Option<()> {
        let at = self.end;
        *self.columns.get_mut(at)? = core::array::from_fn(|lane| (LANES * strip + lane) as u32);
        self.bases[at] = base;
        self.end += 1;
        Some(())
    }

    /// Puts links that lie one behind the other into an entry. Where there is no link nothing comes of it.
    fn run(&mut self, at: usize, links: &[u32]) {
        let Some(&first) = links.first() else { return };
        self.bases[at] = (led_to(first) - lane(first)) as u32;
        links.iter().for_each(|&key| self.columns[at][lane(key)] = led_to(key) as u32);
    }

    /// Says whose link a mixed entry has in a lane.
    fn own(&mut self, at: usize, lane: usize, owner: usize) {
        let base = &mut self.bases[at];
        *base = *base & !(7 << (3 * lane)) | (owner as u32) << (3 * lane);
    }
}

/// Where the links of a strip go that are no runs: the first plain entry and the first mixed one, how many links each lane has had of the plain ones, and
/// how many are in mixed ones.
struct Filling {
    plain: usize,
    mixed: usize,
    counts: [usize; LANES],
    left: usize,
}

impl Filling {
    /// Puts a link into a plain entry, or where there is none left for its lane into a mixed one.
    fn put(&mut self, making: &mut Making<'_>, lane: usize, slot: usize) {
        let at = self.plain + self.counts[lane];
        if at >= self.mixed {
            return self.mix(making, lane, slot);
        }
        self.counts[lane] += 1;
        making.columns[at][lane] = slot as u32;
    }

    /// Puts a link into a mixed entry.
    fn mix(&mut self, making: &mut Making<'_>, lane: usize, slot: usize) {
        let (at, into) = (self.mixed + self.left / LANES, self.left % LANES);
        making.own(at, into, lane);
        making.columns[at][into] = slot as u32;
        self.left += 1;
    }
}

/// The links that a strip of so many keeps, each as the lane of its row and the place that it leads to: those to rows of earlier strips, and to those
/// of the same in earlier lanes.
fn kept<'g>(graph: &'g Graph<'_>, [strip, strips]: [usize; 2]) -> impl Iterator<Item = (usize, usize)> + 'g {
    (0..LANES).flat_map(move |lane| {
        let slots = graph.row(lane * strips + strip).iter().map(move |&link| slot(link, strips));
        slots.filter(move |&slot| slot < LANES * strip + lane).map(move |slot| (lane, slot))
    })
}

/// Their number.
fn count(graph: &Graph<'_>, strip: [usize; 2]) -> usize {
    kept(graph, strip).count()
}

/// The place of a row, of so many strips.
fn slot(row: u32, strips: usize) -> usize {
    LANES * (row as usize % strips) + row as usize / strips
}

/// Links, if there is room for all: each a number that says where the first of eight would lead that lie one behind the other,
/// eight more than its place, so that it is not below zero; and in which lane it is. They are in order.
fn sorted(links: impl Iterator<Item = (usize, usize)>, keys: &mut [u32]) -> Option<&[u32]> {
    let mut count = 0;
    for (lane, slot) in links {
        *keys.get_mut(count)? = (LANES * (slot + LANES - lane) + lane) as u32;
        count += 1;
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
