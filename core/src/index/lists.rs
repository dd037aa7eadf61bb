//! Lists of neighbours that last until somebody has gone half their skin (Verlet, "Computer 'Experiments' on Classical
//! Fluids", Phys. Rev. 159, 1967).

use super::making::{Making, NO_POINT, Parts};
use super::nearby::{NOBODY, Nearby};
use super::sorted::Entry;
use super::{Room, SpatialIndex, between, wrapped_in};
use crate::division::Division;
use crate::lanes::{self, Eight, Kernel, LANES};
use crate::math::{largest, max, sqrt};
use crate::rows::farthest;
use core::array;
use core::ops::Range;
use glam::Vec3;

/// Words of a point's own: where its list begins and ends, where it was when the lists were made, where it is, and its row.
const OWN: usize = 9;
/// Lists whose entries are fetched together, and room for these.
const BATCH: usize = 16;
const ROOM: usize = 1024;
/// Points that it is worth a thread's while to follow.
#[cfg(feature = "rayon")]
const FOLLOWED: usize = 4096;
/// Steps that go by without lists after these have been of no use.
const PAUSE: u8 = 16;
/// Within what the squares of coordinates and of radii are numbers \[m\].
const TAME: Range<f32> = 1e-15..1e15;

/// The facts known of the lists in a system's memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Listed {
    /// Points that they are of.
    points: u32,
    /// The radius that they are good for, and how far anybody may go meanwhile \[m\].
    reach: f32,
    max_travel: f32,
    /// The number of particles that had come and gone when they were made.
    changes: u32,
    /// Words that were lent for them: others are not theirs.
    words: usize,
    /// How often they have been of use, and how many more times there are to be none.
    uses: u16,
    pause: u8,
    /// The parts of the rows whose lists follow each other; none before there are lists, so that an empty system is nothing but zeros.
    parts: u8,
}

/// The memory of lists, and what is known of them.
pub(crate) struct ListMemory<'a> {
    words: &'a mut [u32],
    listed: &'a mut Listed,
    /// The number of particles that have come and gone.
    changes: u32,
    /// How long a step is \[s\].
    step: f32,
    /// The room that points lie in, if there is one.
    room: Option<&'a Room>,
}

/// Lists, for reading. Points are numbered anew, in the order of the index: what is near in space is near in memory. Where threads share
/// the rows, the points of one's share come before those of the next.
#[derive(Clone, Copy)]
pub(crate) struct Lists<'a> {
    reach: f32,
    /// The shares: since all rows have a number, those of a share have the numbers that are its rows.
    division: Division,
    /// Where among the entries each point's list begins and ends.
    spans: &'a [[u32; 2]],
    /// Where they are, and their rows.
    places: &'a [Entry],
    /// The numbers of the near, in ascending order of rows.
    entries: &'a [u32],
}

impl Listed {
    /// None.
    pub(crate) const NONE: Self =
        Self { points: 0, reach: 0.0, max_travel: 0.0, changes: 0, words: 0, uses: 0, pause: 0, parts: 0 };
}

impl Lists<'_> {
    /// Tells whether they hold all neighbours within this distance.
    pub(super) fn reaches(&self, reach: f32) -> bool {
        reach <= self.reach
    }

    /// As [`Neighbours::of`](super::Neighbours::of).
    pub(super) fn of(
        &self,
        rows: Range<usize>,
        reach: f32,
        room: Option<&Room>,
        visit: &mut dyn FnMut(usize, &Nearby),
    ) {
        lanes::run(Walk { lists: *self, rows, reach, room, visit });
    }

    /// The points of eight entries from one on, of which the first so many are asked for.
    #[inline(always)]
    fn eight(&self, entries: &[u32], at: usize) -> [Entry; LANES] {
        let mut last = [NO_POINT; LANES];
        let rest = entries.get(at..).unwrap_or_default();
        let eight = rest.first_chunk().unwrap_or_else(
            #[cold]
            || {
                last[..rest.len()].copy_from_slice(rest);
                &last
            },
        );
        let place_of = |lane: usize| *self.places.get(eight[lane] as usize).unwrap_or(&NOBODY);
        array::from_fn(place_of)
    }

    /// The numbers among which those of some rows are.
    fn numbers_of(&self, rows: &Range<usize>) -> Range<usize> {
        let starts = |part: &usize| self.division.start(*part);
        let first = (1..self.division.parts()).rev().find(|part| starts(part) <= rows.start).unwrap_or(0);
        let last = (first + 1..self.division.parts()).find(|part| starts(part) >= rows.end);
        starts(&first)..starts(&last.unwrap_or(self.division.parts()))
    }

    /// The entries of the lists of some points, and the number of the first: those of `rows` are fetched from memory all at once, if there is room
    /// for them, which takes less than to wait for each list in turn.
    fn fetched<'r>(
        &'r self,
        (spans, places): (&[[u32; 2]], &[Entry]),
        (rows, are_many): (&Range<usize>, bool),
        room: &'r mut [u32; ROOM],
    ) -> (&'r [u32], usize) {
        let [start, end] = match spans {
            [[start, end]] | [[start, _], .., [_, end]] => [*start as usize, *end as usize],
            [] => [0; 2],
        };
        // Who is in no index has no list; if he is the last, these do not end with his.
        let entries = self.entries.get(start..end).filter(|entries| !entries.is_empty());
        match entries.and_then(|entries| room.get_mut(..entries.len()).zip(Some(entries))) {
            Some((front, entries)) => {
                if are_many {
                    front.copy_from_slice(entries);
                    return (room, start);
                }
                // Where many threads share the rows, the others are no concern of this one. Up to a few, all lists in a stream take less time
                // than every other one.
                for (span, _) in spans.iter().zip(places).filter(|(_, place)| rows.contains(&(place.row as usize))) {
                    let [from, to] = span.map(|at| (at as usize).wrapping_sub(start));
                    if let Some((front, list)) = front.get_mut(from..to).zip(entries.get(from..to)) {
                        front.copy_from_slice(list);
                    }
                }
                (room, start)
            }
            None => (self.entries, 0),
        }
    }
}

/// A walk along the lists.
struct Walk<'w> {
    lists: Lists<'w>,
    rows: Range<usize>,
    reach: f32,
    room: Option<&'w Room>,
    visit: &'w mut dyn FnMut(usize, &Nearby),
}

impl Kernel for Walk<'_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { lists, rows, reach, room, visit } = self;
        let (mut nearby, mut fetched) = (Nearby::NOBODY, [0; ROOM]);
        let within = (reach, room.map(|room| room.side_by_side(like)));
        let numbers = lists.numbers_of(&rows);
        let are_many = 3 * rows.len() >= numbers.len();
        let (spans, places) =
            (lists.spans.get(numbers.clone()).unwrap_or_default(), lists.places.get(numbers).unwrap_or_default());
        for (spans, places) in spans.chunks(BATCH).zip(places.chunks(BATCH)) {
            let (entries, first) = lists.fetched((spans, places), (&rows, are_many), &mut fetched);
            for (span, place) in spans.iter().zip(places) {
                let (row, [start, end]) = (place.row as usize, span.map(|at| (at as usize).wrapping_sub(first)));
                if rows.contains(&row) {
                    // What follows the list is read as well, but does not count.
                    let others = (start..end).step_by(LANES).map(|at| (lists.eight(entries, at), end - at));
                    nearby.gather(like, (row, Vec3::from_array(place.x)), others, within, visit);
                }
            }
        }
    }
}

impl<'a> ListMemory<'a> {
    /// Memory for lists; those in it count no longer if it is not the same as before.
    pub(crate) fn new(
        words: &'a mut [u32],
        listed: &'a mut Listed,
        changes: u32,
        step: f32,
        room: Option<&'a Room>,
    ) -> Self {
        if listed.words != words.len() {
            *listed = Listed::NONE;
        }
        Self { words, listed, changes, step, room }
    }

    /// The same, lent on.
    pub(crate) fn again(&mut self) -> ListMemory<'_> {
        ListMemory { words: self.words, listed: self.listed, ..*self }
    }

    /// The lists, if they are still good for these points.
    pub(crate) fn kept(&mut self, points: &[Vec3], reach: f32) -> Option<Lists<'_>> {
        let Listed { points: len, reach: listed, max_travel, changes, .. } = *self.listed;
        let is_same = len as usize == points.len() && listed == reach && changes == self.changes && max_travel > 0.0;
        if !is_same || !self.follow(points, max_travel) {
            return None;
        }
        self.listed.uses = self.listed.uses.saturating_add(1);
        Some(self.read())
    }

    /// How much farther than `reach` lists should look that are made now; none, if they would not last. A way in a step that is a
    /// share a of the reach asks for about √a of it: a wider skin takes more looks, a narrower one more lists.
    pub(crate) fn skin(&mut self, points: &[Vec3], velocity: &[Vec3], reach: f32) -> Option<f32> {
        let was_of_use = self.listed.points == 0 || self.listed.uses > 1;
        self.listed.points = 0;
        if !was_of_use && self.listed.pause == 0 {
            self.listed.pause = PAUSE;
        }
        if self.listed.pause > 0 {
            self.listed.pause -= 1;
            return None;
        }
        let is_tame = TAME.contains(&reach) && farthest(points) < TAME.end;
        let share = max(2.0 * farthest(velocity) * self.step / reach, 4e-4);
        (is_tame && share < 0.25 && self.words.len() > OWN * points.len()).then(|| reach * sqrt(share))
    }

    /// Lists of all within `reach` and the skin, by an index; none if there is no room.
    pub(crate) fn make(
        &mut self,
        index: &dyn SpatialIndex,
        points: &[Vec3],
        [reach, skin]: [f32; 2],
    ) -> Option<Lists<'_>> {
        let radius = reach + skin + self.room.map_or(0.0, Room::slack);
        let making = Making { index, points, radius, room: self.room };
        let made = making.make(&mut parts(self.words, points.len()));
        // Not again as soon, if there is no room.
        self.listed.pause = if made.is_some() { 0 } else { PAUSE };
        let (parts, changes, words, uses, pause) = (made? as u8, self.changes, self.words.len(), 1, 0);
        // Half of the skin each, less what rounding may come to.
        let size = max(farthest(points), self.room.map_or(0.0, |room| largest(room.sides())));
        let max_travel = 0.499 * skin - 4.0 * f32::EPSILON * size;
        *self.listed = Listed { points: points.len() as u32, reach, max_travel, changes, words, uses, pause, parts };
        Some(self.read())
    }

    fn read(&mut self) -> Lists<'_> {
        let Listed { points, reach, parts: shares, .. } = *self.listed;
        let Parts { spans, places, entries, .. } = parts(self.words, points as usize);
        let division = Division::new(points as usize, shares as usize);
        Lists { reach, division, spans, places, entries }
    }

    /// Takes up where all are, and says whether nobody has gone farther than they may.
    fn follow(&mut self, points: &[Vec3], max_travel: f32) -> bool {
        let Parts { made, places, .. } = parts(self.words, points.len());
        Following { points, room: self.room, square: max_travel * max_travel }.all(places, made)
    }
}

/// How it is followed where points are.
#[derive(Clone, Copy)]
struct Following<'a> {
    points: &'a [Vec3],
    room: Option<&'a Room>,
    /// The square of the way that they may have gone since lists were made.
    square: f32,
}

impl Following<'_> {
    /// Takes up where points are, and says whether none has gone farther than it may; with the feature `rayon` on all threads of a pool.
    fn all(&self, places: &mut [Entry], made: &[Vec3]) -> bool {
        #[cfg(feature = "rayon")]
        return self.side_by_side(places, made, Division::among_threads(places.len(), FOLLOWED).parts());
        #[cfg(not(feature = "rayon"))]
        return self.one_by_one(places, made);
    }

    /// The same by so many threads.
    #[cfg(feature = "rayon")]
    fn side_by_side(&self, places: &mut [Entry], made: &[Vec3], threads: usize) -> bool {
        if threads < 2 {
            return self.one_by_one(places, made);
        }
        let len = Division::new(places.len(), threads).start(threads / 2);
        let ((front, back), made) = (places.split_at_mut(len), made.split_at(len));
        let (front, back) = rayon::join(
            || self.side_by_side(front, made.0, threads / 2),
            || self.side_by_side(back, made.1, threads - threads / 2),
        );
        front && back
    }

    /// The same by one thread.
    fn one_by_one(&self, places: &mut [Entry], made: &[Vec3]) -> bool {
        let mut any = 0;
        for (place, made) in places.iter_mut().zip(made) {
            let at = wrapped_in(self.room, self.points[place.row as usize]);
            place.x = at.to_array();
            let d = between(self.room, *made, at);
            any |= u32::from(!(d.x * d.x + d.y * d.y + d.z * d.z <= self.square));
        }
        any == 0
    }
}

/// The parts of memory for lists of so many points.
fn parts(words: &mut [u32], points: usize) -> Parts<'_> {
    let (spans, rest) = words.split_at_mut(2 * points);
    let (made, rest) = rest.split_at_mut(3 * points);
    let (places, entries) = rest.split_at_mut(4 * points);
    // A span tells of no more.
    let len = entries.len().min(u32::MAX as usize);
    Parts {
        spans: bytemuck::cast_slice_mut(spans),
        made: bytemuck::cast_slice_mut(made),
        places: bytemuck::cast_slice_mut(places),
        entries: &mut entries[..len],
    }
}
