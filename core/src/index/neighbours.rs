//! Neighbours of particles: from lists that last for a while, from an index, or by looking at all; to the same bits.

use super::facts::ARE_KEPT;
use super::lists::Lists;
use super::nearby::{self, NOBODY, Nearby, Visit};
use super::room::Points;
use super::sorted::Entry;
use super::{Room, SpatialIndex, between, wrapped_in};
use crate::least;
use core::fmt;
use core::ops::Range;
use glam::Vec3;

/// The largest number of a row's neighbours that are sorted on the stack.
const MOST: usize = if cfg!(target_os = "none") { 64 } else { 512 };

/// Some points, and who of them is near whom.
///
/// The neighbours of a row come in ascending order, in runs of 32 but for the last, so that sums over them have the same bits
/// whatever finds them.
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    points: &'a [Vec3],
    source: Source<'a>,
    /// The room through whose sides they are near, if there is one.
    room: Option<&'a Room>,
}

/// The means by which neighbours are found.
#[derive(Clone, Copy)]
enum Source<'a> {
    All,
    Index(&'a dyn SpatialIndex),
    /// By an index of the first so many; the others are looked at one by one.
    First(&'a dyn SpatialIndex, usize),
    Lists(Lists<'a>),
}

impl<'a> Neighbours<'a> {
    /// Neighbours that are handed over at once.
    pub const RUN: usize = nearby::RUN;

    /// Found by looking at all points.
    #[must_use]
    pub const fn among(points: &'a [Vec3]) -> Self {
        Self { points, source: Source::All, room: None }
    }

    /// Found through the sides of a room, if there is one.
    #[must_use]
    pub const fn in_room(self, room: Option<&'a Room>) -> Self {
        Self { room, ..self }
    }

    /// The same room, and other points in it: found by looking at all.
    pub(crate) const fn at<'s>(&self, points: &'s [Vec3]) -> Neighbours<'s>
    where
        'a: 's,
    {
        Neighbours { points, source: Source::All, room: self.room }
    }

    /// The room through whose sides they are near, if there is one.
    #[must_use]
    pub const fn room(&self) -> Option<&'a Room> {
        self.room
    }

    /// Found by an index of these points, if there is one. Points that it has beyond these are near nobody.
    #[must_use]
    pub fn by(index: Option<&'a dyn SpatialIndex>, points: &'a [Vec3]) -> Self {
        Self { points, source: index.map_or(Source::All, Source::Index), room: None }
    }

    /// Found by an index of the first so many of these points, and by looking at the others.
    pub(crate) fn by_first(index: &'a dyn SpatialIndex, first: usize, points: &'a [Vec3]) -> Self {
        Self { points, source: Source::First(index, first.min(points.len())), room: None }
    }

    /// Found in lists of these points.
    pub(crate) const fn listed(lists: Lists<'a>, points: &'a [Vec3]) -> Self {
        Self { points, source: Source::Lists(lists), room: None }
    }

    /// Visits each of `rows` that has others within `reach` \[m\] with these, in ascending order, in runs of 32 and a last one
    /// that may be shorter; all runs of a row follow each other. Rows come in an order of the index's own. Points that are not
    /// finite are near nobody.
    ///
    /// Lists and indices are made for the reach that the scene's forces ask for, and answer a larger one by looking at all.
    pub fn of(&self, rows: Range<usize>, reach: f32, visit: &mut dyn FnMut(usize, &Nearby)) {
        let rows = rows.start..rows.end.min(self.points.len());
        match self.source {
            _ if !(reach > 0.0) => {}
            Source::Lists(lists) if lists.reaches(reach) => lists.of(rows, reach, self.room, visit),
            Source::Index(index) => self.by_index(index, rows, reach, visit),
            Source::First(index, first) if ARE_KEPT => {
                rows.for_each(|row| self.by_first_and_others(index, first, row, reach, visit));
            }
            _ => rows.for_each(|row| self.by_all(row, reach, visit)),
        }
    }

    /// Counts the points within `radius` \[m\] of a place, whoever lies there included.
    #[must_use]
    pub fn count_within(&self, place: Vec3, radius: f32) -> u64 {
        match (self.room, self.source) {
            (room, Source::First(index, first)) if ARE_KEPT => {
                let (points, others) = self.points.split_at(first);
                let first = Self { points, source: Source::Index(index), room };
                first.count_within(place, radius) + self.at(others).count_within(place, radius)
            }
            (Some(room), source) => {
                let index = if let Source::Index(index) = source { Some(index) } else { None };
                (room.code.0)(room, &Points { places: self.points, index }, place, radius)
            }
            (None, Source::Index(index)) => index.count(place, radius).found,
            (None, _) => count_of(self.points, place, radius),
        }
    }

    /// Tells whether all parts of the rows together cost no more than all rows at once, however they are divided.
    #[cfg(feature = "rayon")]
    pub(crate) fn can_be_divided(&self) -> bool {
        !matches!(self.source, Source::Index(_) | Source::First(..))
    }

    /// The neighbours by an index, which has them in an order of its own.
    #[inline(never)]
    fn by_index(
        &self,
        index: &dyn SpatialIndex,
        rows: Range<usize>,
        reach: f32,
        visit: &mut dyn FnMut(usize, &Nearby),
    ) {
        let (mut found, mut len, mut of) = ([0; MOST], 0, None);
        let mut nearby = Nearby::NOBODY;
        // In a room it looks a little farther, as ways are others there. Whom it has found is held against the reach once more: where somebody is so far off
        // that it has scaled places down, all others may be near each other to it.
        let farther = self.room.map_or(reach, |room| reach + room.slack());
        let mut finish = |row: Option<usize>, found: &mut [u32; MOST], len: usize| match row {
            Some(row) if len <= MOST => {
                found[..len].sort_unstable();
                let (own, others) = (self.place(row), found[..len].iter().map(|&other| self.entry(other)));
                Visit { own, others, reach, room: self.room, nearby: &mut nearby, visit }.pay();
            }
            Some(row) => self.by_lots(index, row, reach, &mut *visit),
            None => {}
        };
        index.neighbours(farther, &mut |row, others| {
            let row = row as usize;
            if !rows.contains(&row) {
                return;
            }
            if of != Some(row) {
                finish(of, &mut found, len);
                (of, len) = (Some(row), 0);
            }
            if let Some(room) = found.get_mut(len..len + others.len()) {
                room.copy_from_slice(others);
            }
            len += others.len();
        });
        finish(of, &mut found, len);
    }

    /// The neighbours of one row by an index of the first points, to whom the others are held one by one.
    #[inline(never)]
    fn by_first_and_others(
        &self,
        index: &dyn SpatialIndex,
        first: usize,
        row: usize,
        reach: f32,
        visit: &mut dyn FnMut(usize, &Nearby),
    ) {
        let (mut found, mut len, own, mut nearby) = ([0; MOST], 0, self.place(row), Nearby::NOBODY);
        let farther = self.room.map_or(reach, |room| reach + room.slack());
        index.within(own.1, farther, &mut |others| {
            for &other in others.iter().filter(|&&other| other as usize != row) {
                if let Some(room) = found.get_mut(len) {
                    *room = other;
                }
                len += 1;
            }
        });
        let Some(found) = found.get_mut(..len) else { return self.by_lots(index, row, reach, visit) };
        found.sort_unstable();
        let is_near = |&other: &usize| {
            let d = between(self.room, own.1, self.points[other]);
            other != row && d.x * d.x + d.y * d.y + d.z * d.z <= reach * reach
        };
        let rest = (first..self.points.len()).filter(is_near).map(|other| self.entry(other as u32));
        let others = found.iter().map(|&other| self.entry(other)).chain(rest);
        Visit { own, others, reach, room: self.room, nearby: &mut nearby, visit }.pay();
    }

    /// The neighbours of a row that has too many to be sorted at once: lot by lot, each of which is what comes next of all that the index finds again. Behind
    /// them come those who are not in the index.
    #[inline(never)]
    fn by_lots(&self, index: &dyn SpatialIndex, row: usize, reach: f32, visit: &mut dyn FnMut(usize, &Nearby)) {
        let (own, farther) = (self.place(row), self.room.map_or(reach, |room| reach + room.slack()));
        let next = |from: u32| {
            let (mut found, mut len) = ([0; MOST], 0);
            index.within(own.1, farther, &mut |others| {
                let is_next =
                    |&&other: &&u32| other >= from && other as usize != row && (other as usize) < self.points.len();
                for &other in others.iter().filter(is_next) {
                    least::put(&mut found, &mut len, other, |one, other| one < other);
                }
            });
            found[..len].sort_unstable();
            (found, len)
        };
        let (mut lot, mut taken) = (next(0), 0);
        let in_index = core::iter::from_fn(|| {
            if taken == MOST {
                (lot, taken) = (next(lot.0[MOST - 1] + 1), 0);
            }
            taken += 1;
            lot.0[..lot.1].get(taken - 1).map(|&other| self.entry(other))
        });
        let first = if let Source::First(_, first) = self.source { first } else { self.points.len() };
        let rest = (first..self.points.len()).filter(|&other| other != row).map(|other| self.entry(other as u32));
        let mut nearby = Nearby::NOBODY;
        Visit { own, others: in_index.chain(rest), reach, room: self.room, nearby: &mut nearby, visit }.pay();
    }

    /// The neighbours of one row, found by looking at all others.
    fn by_all(&self, row: usize, reach: f32, visit: &mut dyn FnMut(usize, &Nearby)) {
        let entry = |other| if other as usize == row { NOBODY } else { self.entry(other) };
        let (own, others, mut nearby) = (self.place(row), (0..self.points.len() as u32).map(entry), Nearby::NOBODY);
        Visit { own, others, reach, room: self.room, nearby: &mut nearby, visit }.pay();
    }

    fn place(&self, row: usize) -> (usize, Vec3) {
        // An index may have been made of more points; what is no number is near nobody.
        let point = self.points.get(row).copied().unwrap_or(Vec3::NAN);
        (row, wrapped_in(self.room, point))
    }

    fn entry(&self, row: u32) -> Entry {
        Entry { x: self.place(row as usize).1.to_array(), row }
    }
}

impl fmt::Debug for Neighbours<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Neighbours").field("points", &self.points.len()).finish_non_exhaustive()
    }
}

/// Counts those of these points that lie within `radius` \[m\] of a place.
fn count_of(points: &[Vec3], place: Vec3, radius: f32) -> u64 {
    let square = radius * radius;
    let is_near = |&&point: &&Vec3| {
        let d = point - place;
        d.x * d.x + d.y * d.y + d.z * d.z <= square
    };
    if radius >= 0.0 { points.iter().filter(is_near).count() as u64 } else { 0 }
}
