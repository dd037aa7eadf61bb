//! Lists of neighbours in the making.

use super::sorted::Entry;
use super::{Room, SpatialIndex, wrapped_in};
use glam::Vec3;

/// The number of no point.
pub(super) const NO_POINT: u32 = u32::MAX;

/// The parts of memory for lists.
pub(super) struct Parts<'a> {
    /// Where among the entries each point's list begins and ends.
    pub(super) spans: &'a mut [[u32; 2]],
    /// Where they were when the lists were made.
    pub(super) made: &'a mut [Vec3],
    /// Where they are, and their rows.
    pub(super) places: &'a mut [Entry],
    /// The numbers of the near, in ascending order of rows.
    pub(super) entries: &'a mut [u32],
}

/// How lists are made.
#[derive(Clone, Copy)]
pub(super) struct Making<'a> {
    pub(super) index: &'a dyn SpatialIndex,
    pub(super) points: &'a [Vec3],
    pub(super) radius: f32,
    pub(super) room: Option<&'a Room>,
}

impl Making<'_> {
    /// Makes them, and says in how many shares of the rows they lie one after the other; none if there is no room.
    pub(super) fn make(&self, parts: &mut Parts<'_>) -> Option<usize> {
        #[cfg(feature = "rayon")]
        if let Some(shares) = self.make_side_by_side(parts) {
            return Some(shares);
        }
        self.make_one_by_one(parts)
    }

    /// All rows in the index's order, those behind that are in none: whoever is not finite is watched as well, as it may come near others.
    pub(super) fn rows(&self) -> impl Iterator<Item = u32> {
        let absent = (0..).zip(self.points).filter(|(_, point)| !point.is_finite()).map(|(row, _)| row);
        self.index.order().iter().copied().chain(absent)
    }

    /// The place of a row.
    fn place(&self, row: u32) -> Option<Entry> {
        let x = wrapped_in(self.room, *self.points.get(row as usize)?).to_array();
        Some(Entry { x, row })
    }

    /// Makes all lists in the order of the index.
    fn make_one_by_one(&self, Parts { spans, made, places, entries }: &mut Parts<'_>) -> Option<usize> {
        let mut count = 0;
        for ((made, place), row) in made.iter_mut().zip(places.iter_mut()).zip(self.rows()) {
            *place = self.place(row)?;
            *made = Vec3::from_array(place.x);
            count += 1;
        }
        if count < self.points.len() {
            return None;
        }
        spans.fill([0; 2]);
        let points = 0..self.index.order().len().min(count);
        let (mut next, mut len, mut fits) = (0, 0, true);
        let all = self.index.in_order(points, self.radius, &mut |point, others| {
            let end = len + others.len();
            match spans.get_mut(point).zip(entries.get_mut(len..end)) {
                Some((span, room)) if point >= next => {
                    next = point + 1;
                    *span = [len, end].map(|at| at as u32);
                    room.copy_from_slice(others);
                    len = end;
                }
                _ => fits = false,
            }
        });
        (all && fits).then_some(1)
    }
}
