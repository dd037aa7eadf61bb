//! Lists of neighbours made by several threads.
//!
//! Each makes the lists of points that follow each other in the index, so that what is near a group of them is looked for once. When forces
//! are summed, each has a share of the rows instead. So that it finds the lists of these, and none but these, one after the other in memory,
//! points are numbered share by share, and each thread writes the lists of each share apart.

use super::making::{Making, NO_POINT, Parts};
use super::sorted::Entry;
use super::wrapped_in;
use crate::division::Division;
use core::ops::Range;
use glam::Vec3;

/// Points that are worth a thread's while.
const SHARE: usize = 2048;
/// The largest number of shares of the rows whose lists lie apart: the more there are, the less of what is near a point is near in memory.
const PARTS: usize = 8;
/// The lists of a share are written in pieces of this part of the room that there would be for them.
const PIECES: usize = 16;

impl Making<'_> {
    /// As [`make`](Self::make), by all threads of the pool that this one belongs to; none if there is too little room, or too few points.
    pub(super) fn make_side_by_side(&self, parts: &mut Parts<'_>) -> Option<usize> {
        let threads = Division::among_threads(self.points.len(), SHARE).parts();
        if threads < 2 {
            return None;
        }
        let Parts { spans, made, places, entries } = parts;
        let len = self.points.len();
        // Where it is kept later where points were, their numbers and the spans of their lists lie until then, in the order of the index.
        let (numbers, listed) = bytemuck::cast_slice_mut::<Vec3, u32>(made).split_at_mut_checked(len)?;
        let listed: &mut [[u32; 2]] = bytemuck::try_cast_slice_mut(listed).ok()?;
        let shares = Shares::new(Division::new(len, threads.min(PARTS)));
        self.number(&shares, numbers, places)?;
        listed.fill([0; 2]);
        let points = 0..self.index.order().len().min(len);
        let filling = Filling { making: *self, shares: &shares, numbers };
        filling.side_by_side(points, listed, (0, entries), threads)?;
        for (number, span) in numbers.iter().zip(listed) {
            *spans.get_mut(*number as usize)? = *span;
        }
        self.take_places(places, made, threads);
        Some(shares.parts)
    }

    /// Numbers all points, given in the order of the index: those of each share of the rows after those of the share before. Says whose
    /// each place is.
    fn number(&self, shares: &Shares, numbers: &mut [u32], places: &mut [Entry]) -> Option<()> {
        let (mut next, mut count) = (shares.starts, 0);
        for (number, row) in numbers.iter_mut().zip(self.rows()) {
            self.points.get(row as usize)?;
            let next = &mut next[shares.of(row)];
            *number = *next;
            places.get_mut(*next as usize)?.row = row;
            *next += 1;
            count += 1;
        }
        // An index that has a row twice, and others never, does not number all.
        let are_full = (0..PARTS).all(|share| next[share] == shares.ends[share]);
        (are_full && count == self.points.len()).then_some(())
    }

    /// Keeps where all are, by so many threads.
    fn take_places(&self, places: &mut [Entry], made: &mut [Vec3], threads: usize) {
        if threads < 2 {
            for (place, made) in places.iter_mut().zip(made) {
                *made = wrapped_in(self.room, self.points[place.row as usize]);
                place.x = made.to_array();
            }
            return;
        }
        let len = Division::new(places.len(), threads).start(threads / 2);
        let ((front, back), made) = (places.split_at_mut(len), made.split_at_mut(len));
        rayon::join(
            || self.take_places(front, made.0, threads / 2),
            || self.take_places(back, made.1, threads - threads / 2),
        );
    }
}

/// Shares of the rows.
struct Shares {
    /// The rows with which they begin and end.
    starts: [u32; PARTS],
    ends: [u32; PARTS],
    /// The number of them.
    parts: usize,
}

impl Shares {
    fn new(division: Division) -> Self {
        let start = |part: usize| division.start(part.min(division.parts())) as u32;
        let starts = core::array::from_fn(start);
        Self { starts, ends: core::array::from_fn(|part| start(part + 1)), parts: division.parts() }
    }

    /// The share in which a row is.
    fn of(&self, row: u32) -> usize {
        self.ends.iter().map(|&end| usize::from(row >= end)).sum::<usize>() % PARTS
    }
}

/// How lists are filled in by several threads.
struct Filling<'a> {
    making: Making<'a>,
    shares: &'a Shares,
    /// The numbers of points, in the order of the index.
    numbers: &'a [u32],
}

impl Filling<'_> {
    /// Fills in the lists of some points by so many threads, each with its part of the points and of the room, whose entries are those from
    /// `first` on; none if there is too little.
    fn side_by_side(
        &self,
        points: Range<usize>,
        spans: &mut [[u32; 2]],
        (first, entries): (usize, &mut [u32]),
        threads: usize,
    ) -> Option<()> {
        if threads < 2 {
            return self.one_by_one(points, spans, (first, entries));
        }
        let middle = |whole: usize| Division::new(whole, threads).start(threads / 2);
        let (len, room) = (middle(points.len()), middle(entries.len()));
        let (front, back) = spans.split_at_mut(len);
        let (front_room, back_room) = entries.split_at_mut(room);
        let middle = points.start + len;
        let (front, back) = rayon::join(
            || self.side_by_side(points.start..middle, front, (first, front_room), threads / 2),
            || self.side_by_side(middle..points.end, back, (first + room, back_room), threads - threads / 2),
        );
        front.and(back)
    }

    /// The same by one thread.
    fn one_by_one(
        &self,
        points: Range<usize>,
        spans: &mut [[u32; 2]],
        (first, entries): (usize, &mut [u32]),
    ) -> Option<()> {
        let (mut next, start, mut fits) = (0, points.start, true);
        let mut pieces = Pieces::new(entries, self.shares.parts);
        let all = self.making.index.in_order(points, self.making.radius, &mut |point, others| {
            let place = point.wrapping_sub(start);
            let number = self.numbers.get(point).copied().unwrap_or(NO_POINT);
            match spans.get_mut(place).zip(pieces.take(self.shares.of(number), others.len())) {
                Some((span, (at, room))) if place >= next => {
                    next = place + 1;
                    *span = [first + at, first + at + others.len()].map(|at| at as u32);
                    for (entry, other) in room.iter_mut().zip(others) {
                        *entry = self.numbers.get(*other as usize).copied().unwrap_or(NO_POINT);
                    }
                }
                _ => fits = false,
            }
        });
        (all && fits).then_some(())
    }
}

/// Room for lists, given out in pieces to shares of the rows.
struct Pieces<'e> {
    entries: &'e mut [u32],
    /// The size of a piece, and what has been given out.
    size: usize,
    given: usize,
    /// What is left of each share's last piece.
    left: [Range<usize>; PARTS],
}

impl<'e> Pieces<'e> {
    fn new(entries: &'e mut [u32], shares: usize) -> Self {
        let size = entries.len() / (PIECES * shares);
        Self { entries, size, given: 0, left: [const { 0..0 }; PARTS] }
    }

    /// Room of a share for a list so long, and where it begins; none if there is none.
    fn take(&mut self, share: usize, len: usize) -> Option<(usize, &mut [u32])> {
        let left = self.left.get_mut(share)?;
        if left.len() < len {
            let end = self.given.saturating_add(self.size.max(len)).min(self.entries.len());
            // A piece goes on where none has been given out since.
            *left = if left.end == self.given { left.start } else { self.given }..end;
            self.given = end;
        }
        let (at, end) = (left.start, left.start + len);
        if end > left.end {
            return None;
        }
        left.start = end;
        Some((at, self.entries.get_mut(at..end)?))
    }
}

#[cfg(test)]
mod tests {
    use super::{PARTS, Pieces};

    #[test]
    fn pieces_lie_apart_and_leave_little_room() {
        for shares in 1..=PARTS {
            let (mut owners, mut entries) = (std::vec![None; 20_000], std::vec![0; 20_000]);
            let mut pieces = Pieces::new(&mut entries, shares);
            let mut seed = 7_u32;
            let mut number = || {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 16) as usize
            };
            let (mut taken, mut share) = (0, 0);
            loop {
                // Now one share has its turn for long, now all have.
                share = if number() % 64 < 60 { share } else { number() % shares };
                let len = number() % 60;
                let Some((at, room)) = pieces.take(share, len) else { break };
                assert_eq!(room.len(), len);
                for owner in &mut owners[at..at + len] {
                    assert_eq!(owner.replace(share), None, "{shares} shares");
                }
                taken += len;
            }
            assert!(taken > 20_000 * 9 / 10 - 60 * (16 + 1) * shares, "{taken} of {shares} shares");
        }
    }
}
