//! What an index knows beside what lies in its memory, by which it is taken up again there.

use super::Facts;
use super::domain::Domain;
use super::sorted::Sorted;
use core::array;
use glam::Vec3;

/// True if indices can be taken up again: chips without an operating system are spared the code.
pub(crate) const ARE_KEPT: bool = !cfg!(target_os = "none");

/// Words of what all structures know: their name, their domain, how many points there are and of how many rows, and the box around them.
const COMMON: usize = 16;
/// Words that are a structure's own.
pub(super) const OWN: usize = size_of::<Facts>() / 4 - COMMON;

impl Sorted<'_> {
    /// The facts on a structure of such a name, with those that are its own.
    pub(super) fn facts(&self, name: u32, own: [u32; OWN]) -> Option<Facts> {
        if !ARE_KEPT {
            return None;
        }
        let [low, high] = [self.low, self.high].map(|corner| corner.to_array().map(f32::to_bits));
        let counts = [name, self.len as u32, self.rows as u32];
        let mut words = counts.into_iter().chain(self.domain.words()).chain(low).chain(high).chain(own);
        Some(array::from_fn(|_| words.next().unwrap_or(0)))
    }

    /// Goes on from the facts on a structure of such a name in the same domain, and returns those that are its own.
    pub(super) fn restore(&mut self, name: u32, facts: &Facts) -> Option<[u32; OWN]> {
        let (&[its_name, len, rows, ref common @ ..], own) = facts.split_first_chunk::<COMMON>()?;
        let (&domain, corners) = common.split_first_chunk()?;
        let corner = |first: usize| Vec3::from_array(array::from_fn(|axis| f32::from_bits(corners[first + axis])));
        let fits = ARE_KEPT && its_name == name && len as usize <= self.capacity();
        self.domain = self.domain.scaled_as(domain).filter(|_| fits)?;
        (self.len, self.rows, self.low, self.high) = (len as usize, rows as usize, corner(0), corner(3));
        own.try_into().ok()
    }

    /// Gives each point the row of `points` that `row_of` finds for its own, and takes out those for which it finds none or one that is not
    /// finite; `starts` say where the structure's parts begin, in ascending order. Tells whether these are just the points that it holds then,
    /// placed as they would be in an index that is built of them.
    pub(super) fn renumber<'s>(
        &mut self,
        points: &[Vec3],
        row_of: &mut dyn FnMut(u32) -> Option<u32>,
        starts: impl Iterator<Item = &'s mut u32>,
    ) -> bool {
        let (mut kept, mut starts) = (0, starts.peekable());
        for slot in 0..self.len {
            while let Some(start) = starts.next_if(|start| **start as usize <= slot) {
                *start = kept as u32;
            }
            let (place, before) = (self.point(slot), self.order()[slot]);
            let Some(row) = row_of(before) else { continue };
            match points.get(row as usize) {
                Some(point) if !point.is_finite() => {}
                Some(point) if self.domain.place(*point) == place => {
                    if (kept, row) != (slot, before) {
                        self.put(kept, place, row);
                    }
                    kept += 1;
                }
                _ => return false,
            }
        }
        starts.for_each(|start| *start = kept as u32);
        (self.len, self.rows) = (kept, points.len());
        let mut domain = self.domain;
        domain.fit(points);
        domain == self.domain && kept == points.iter().filter(|point| point.is_finite()).count()
    }
}

impl Domain {
    /// Its room and its scale.
    fn words(&self) -> [u32; 7] {
        let [low, sides] = [self.room().low(), self.room().sides()].map(|corner| corner.to_array());
        let mut words = low.into_iter().chain(sides).chain([self.scale()]);
        array::from_fn(|_| words.next().unwrap_or(0.0).to_bits())
    }

    /// The same room at the scale of such words, if they are of the same.
    fn scaled_as(&self, words: [u32; 7]) -> Option<Self> {
        let scaled = self.at_scale(f32::from_bits(words[6]));
        (scaled.words() == words).then_some(scaled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::{Room, SpatialIndex, Structure};
    use crate::rng::Stream;

    const COUNT: usize = 300;

    fn cloud() -> [Vec3; COUNT] {
        array::from_fn(|i| {
            let ([x, y], [z, _]) = (Stream::new(1, 0, i as u32).units(0), Stream::new(1, 0, i as u32).units(1));
            Vec3::new(x, y, z * z)
        })
    }

    /// The numbers of points near places all over.
    fn counts(index: &dyn SpatialIndex) -> [u64; 64] {
        array::from_fn(|i| {
            let place = Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32) * 0.3;
            index.count(place, 0.1 + 0.01 * i as f32).found
        })
    }

    /// An index of `points` is built in memory, and taken up there for `others`, for which `row_of` finds the rows.
    fn is_taken_up(
        structure: Structure,
        room: Option<&Room>,
        [points, others]: [&[Vec3]; 2],
        row_of: &mut dyn FnMut(u32) -> Option<u32>,
    ) -> bool {
        let mut memory = [0; 6000];
        let mut index = structure.in_room(&mut memory, room);
        index.build(points, 0.1).expect("there is room");
        let facts = index.facts().expect("it can be taken up");
        let mut index = structure.in_room(&mut memory, room);
        let is_taken_up = index.take_up(&facts, others, row_of);
        if is_taken_up {
            let mut memory = [0; 6000];
            let mut anew = structure.in_room(&mut memory, room);
            anew.build(others, 0.1).expect("there is room");
            assert_eq!(counts(&index), counts(&anew), "{structure}");
            let [mut rows, mut expected] = [[0; COUNT]; 2];
            assert_eq!(index.counts(0.15, &mut rows).found, anew.counts(0.15, &mut expected).found);
            assert_eq!(rows, expected, "{structure}");
        }
        is_taken_up
    }

    #[test]
    fn an_index_is_taken_up_for_the_points_that_it_holds_alone() {
        let (points, room) = (cloud(), Room::new(Vec3::ZERO, Vec3::splat(1.5)));
        for &structure in Structure::ALL {
            for room in [None, Some(&room)] {
                let is = |others: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>| {
                    is_taken_up(structure, room, [&points, others], row_of)
                };
                assert!(is(&points, &mut Some));
                // Every third has gone, and the others have moved up.
                let left: heapless::Vec<_, COUNT> = (0..COUNT).filter(|i| i % 3 > 0).map(|i| points[i]).collect();
                let mut moved_up = |row: u32| (!row.is_multiple_of(3)).then(|| row - row / 3 - 1);
                assert!(is(&left, &mut moved_up));
                assert!(is(&[], &mut |_| None));
                // Who is nowhere is struck out as well.
                let mut some = points;
                some[7] = Vec3::NAN;
                assert!(is(&some, &mut Some));
                // One has moved, one is missing, one has come, or two have been exchanged.
                some[7] = points[7] + Vec3::X * 1e-6;
                assert!(!is(&some, &mut Some));
                assert!(!is(&points[..COUNT - 1], &mut Some));
                assert!(!is(&points, &mut |row| (row > 0).then_some(row)));
                let mut more = heapless::Vec::<_, { COUNT + 1 }>::from_slice(&points).expect("there is room");
                more.push(Vec3::ONE).expect("there is room");
                assert!(!is(&more, &mut Some));
                some = points;
                some.swap(3, 4);
                assert!(!is(&some, &mut Some));
            }
        }
    }

    #[test]
    fn an_index_is_not_taken_up_by_another() {
        let points = cloud();
        for &built in Structure::ALL {
            let mut memory = [0; 6000];
            let mut index = built.index(&mut memory);
            index.build(&points, 0.1).expect("there is room");
            let facts = index.facts().expect("it can be taken up");
            for &other in Structure::ALL.iter().filter(|&&other| other != built && other.words(9) != built.words(9)) {
                assert!(!other.index(&mut memory.clone()).take_up(&facts, &points, &mut Some), "{built} by {other}");
            }
            let rooms = [Room::new(Vec3::ZERO, Vec3::splat(2.0)), Room::new(Vec3::X, Vec3::Y)];
            for room in &rooms {
                assert!(!built.in_room(&mut memory.clone(), Some(room)).take_up(&facts, &points, &mut Some));
            }
        }
    }

    #[test]
    fn scales_are_those_of_the_points_that_are_left() {
        // One far off had all distances of the others count as zero.
        let mut points = cloud();
        points[0] = Vec3::X * 1e30;
        for &structure in Structure::ALL {
            assert!(is_taken_up(structure, None, [&points, &points], &mut Some), "{structure}");
            let rest = &mut |row: u32| row.checked_sub(1);
            assert!(!is_taken_up(structure, None, [&points, &points[1..]], rest), "{structure}");
        }
    }
}
