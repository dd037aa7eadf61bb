//! Who is near whom: from lists that last for a while, from an index, or by looking at all; to the same bits.

use super::SpatialIndex;
use super::lists::Lists;
use crate::lanes::LANES;
use core::fmt;
use core::ops::Range;
use glam::Vec3;

const RUN: usize = Neighbours::RUN;
/// How many a row may have that are sorted on the stack.
const MOST: usize = if cfg!(target_os = "none") { 64 } else { 512 };

/// Some points, and who of them is near whom.
///
/// The neighbours of a row come in ascending order, in runs of 32 but for the last, so that sums over them have the same bits
/// whatever finds them.
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    points: &'a [Vec3],
    source: Source<'a>,
}

/// What finds them.
#[derive(Clone, Copy)]
enum Source<'a> {
    All,
    Index(&'a dyn SpatialIndex),
    Lists(Lists<'a>),
}

impl<'a> Neighbours<'a> {
    /// Neighbours that are handed over at once.
    pub const RUN: usize = 32;

    /// Found by looking at all points.
    #[must_use]
    pub const fn among(points: &'a [Vec3]) -> Self {
        Self { points, source: Source::All }
    }

    /// Found by an index of these points, if there is one.
    #[must_use]
    pub fn by(index: Option<&'a dyn SpatialIndex>, points: &'a [Vec3]) -> Self {
        Self { points, source: index.map_or(Source::All, Source::Index) }
    }

    /// Found in lists of these points.
    pub(crate) const fn listed(lists: Lists<'a>, points: &'a [Vec3]) -> Self {
        Self { points, source: Source::Lists(lists) }
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
            Source::Lists(lists) if lists.reaches(reach) => lists.of(rows, reach, visit),
            Source::Index(index) => self.by_index(index, rows, reach, visit),
            _ => rows.for_each(|row| self.by_all(row, reach, visit)),
        }
    }

    /// How many points lie within `radius` \[m\] of a place, whoever lies there included.
    #[must_use]
    pub fn count_within(&self, place: Vec3, radius: f32) -> u64 {
        match self.source {
            Source::Index(index) => index.count(place, radius).found,
            _ => count_of(self.points, place, radius),
        }
    }

    /// Whether any division of the rows costs as much as all of them together.
    #[cfg(feature = "rayon")]
    pub(crate) fn can_be_divided(&self) -> bool {
        !matches!(self.source, Source::Index(_))
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
        let mut finish = |row: Option<usize>, found: &mut [u32; MOST], len: usize| match row {
            Some(row) if len <= MOST => {
                found[..len].sort_unstable();
                // Whom the index has found is near, whatever its scale.
                in_runs(self.at(row), found[..len].iter().map(|&other| self.other(other)), f32::INFINITY, visit);
            }
            // Of so many there are a good part of all points.
            Some(row) => self.by_all(row, reach, &mut *visit),
            None => {}
        };
        index.neighbours(reach, &mut |row, others| {
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

    /// The neighbours of one row, found by looking at all others.
    fn by_all(&self, row: usize, reach: f32, visit: &mut dyn FnMut(usize, &Nearby)) {
        let all = (0..self.points.len() as u32).filter(|&other| other as usize != row);
        in_runs(self.at(row), all.map(|other| self.other(other)), reach, visit);
    }

    fn at(&self, row: usize) -> (usize, Vec3) {
        (row, self.points[row])
    }

    fn other(&self, row: u32) -> (u32, Vec3) {
        (row, self.points[row as usize])
    }
}

impl fmt::Debug for Neighbours<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Neighbours").field("points", &self.points.len()).finish_non_exhaustive()
    }
}

/// Others that are near a row, with the ways to them.
#[derive(Clone, Debug)]
pub struct Nearby {
    rows: [u32; RUN],
    toward: [[f32; RUN]; 3],
    square: [f32; RUN],
    len: usize,
}

impl Nearby {
    const NOBODY: Self = Self { rows: [0; RUN], toward: [[0.0; RUN]; 3], square: [0.0; RUN], len: 0 };

    /// Their rows, in ascending order.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows[..self.len]
    }

    /// The ways to them \[m\], coordinate by coordinate. Behind the last there are zeros up to the next multiple of eight.
    #[must_use]
    pub fn toward(&self) -> [&[f32; RUN]; 3] {
        self.toward.each_ref()
    }

    /// Their distances squared \[m²\], and zeros likewise.
    #[must_use]
    pub fn square(&self) -> &[f32; RUN] {
        &self.square
    }

    /// Puts another to a place, and says whether it stays there: it is near.
    #[inline(always)]
    fn put(&mut self, k: usize, other: u32, d: Vec3, most: f32) -> bool {
        let square = d.x * d.x + d.y * d.y + d.z * d.z;
        self.rows[k] = other;
        (self.toward[0][k], self.toward[1][k], self.toward[2][k]) = (d.x, d.y, d.z);
        self.square[k] = square;
        square <= most
    }

    /// Hands the first `len` over.
    #[inline]
    fn hand_over(&mut self, len: usize, row: usize, visit: &mut dyn FnMut(usize, &Self)) {
        if len > 0 {
            for k in len..len.next_multiple_of(LANES) {
                self.square[k] = 0.0;
                self.toward.iter_mut().for_each(|toward| toward[k] = 0.0);
            }
            self.len = len;
            visit(row, self);
        }
    }
}

/// Visits a row at a place with those of some others that are within `reach` of it, in their order.
#[inline]
pub(super) fn in_runs(
    (row, place): (usize, Vec3),
    others: impl Iterator<Item = (u32, Vec3)>,
    reach: f32,
    visit: &mut dyn FnMut(usize, &Nearby),
) {
    let (mut nearby, mut len, square) = (Nearby::NOBODY, 0, reach * reach);
    for (other, at) in others {
        // Written before it is known whether it stays, so that there is no branch to guess.
        len += usize::from(nearby.put(len % RUN, other, at - place, square));
        if len == RUN {
            nearby.hand_over(len, row, visit);
            len = 0;
        }
    }
    nearby.hand_over(len, row, visit);
}

/// How many of these points lie within `radius` \[m\] of a place.
pub(crate) fn count_of(points: &[Vec3], place: Vec3, radius: f32) -> u64 {
    let square = radius * radius;
    let is_near = |&&point: &&Vec3| {
        let d = point - place;
        d.x * d.x + d.y * d.y + d.z * d.z <= square
    };
    if radius >= 0.0 { points.iter().filter(is_near).count() as u64 } else { 0 }
}
