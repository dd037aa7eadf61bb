//! Lists of neighbours that last until somebody has gone half their skin (Verlet, "Computer 'Experiments' on Classical
//! Fluids", Phys. Rev. 159, 1967).

use super::SpatialIndex;
use super::neighbours::in_runs;
use crate::math::{max, sqrt};
use crate::rows::farthest;
use core::ops::Range;
use glam::Vec3;

/// Words of a point's own: where it was, where its list begins and ends, and its place in the order of the lists.
const OWN: usize = 6;
/// Steps that go by without lists after these have been of no use.
const PAUSE: u32 = 16;
/// Within what the squares of coordinates and of radii are numbers \[m\].
const TAME: Range<f32> = 1e-15..1e15;

/// What is known of the lists in a system's memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Listed {
    /// Points that they are of, and rows that have any.
    points: u32,
    rows: u32,
    /// The radius that they are good for, and how far anybody may go meanwhile \[m\].
    reach: f32,
    leash: f32,
    /// How many had come and gone before them.
    changes: u32,
    /// How often they have been of use, and how many more times there are to be none.
    uses: u32,
    pause: u32,
}

/// The memory of lists, and what is known of them.
pub(crate) struct ListMemory<'a> {
    pub(crate) words: &'a mut [u32],
    pub(crate) listed: &'a mut Listed,
    /// How many particles have come and gone.
    pub(crate) changes: u32,
    /// How long a step is \[s\].
    pub(crate) step: f32,
}

/// Lists, for reading.
#[derive(Clone, Copy)]
pub(crate) struct Lists<'a> {
    reach: f32,
    order: &'a [u32],
    spans: &'a [[u32; 2]],
    entries: &'a [u32],
}

impl Listed {
    /// None.
    pub(crate) const NONE: Self = Self { points: 0, rows: 0, reach: 0.0, leash: 0.0, changes: 0, uses: 0, pause: 0 };
}

impl Lists<'_> {
    /// Whether they hold all within so far.
    pub(super) fn reaches(&self, reach: f32) -> bool {
        reach <= self.reach
    }

    /// As [`Neighbours::of`](super::Neighbours::of).
    pub(super) fn of(&self, points: &[Vec3], rows: Range<usize>, reach: f32, visit: &mut dyn FnMut(usize, &[u32])) {
        for &row in self.order {
            let row = row as usize;
            if rows.contains(&row) {
                let [start, end] = self.spans[row].map(|at| at as usize);
                in_runs(points, row, self.entries[start..end].iter().copied(), reach, visit);
            }
        }
    }
}

impl ListMemory<'_> {
    /// The same, lent on.
    pub(crate) fn again(&mut self) -> ListMemory<'_> {
        ListMemory { words: self.words, listed: self.listed, ..*self }
    }

    /// The lists, if they are still good for these points.
    pub(crate) fn kept(&mut self, points: &[Vec3], reach: f32) -> Option<Lists<'_>> {
        let Listed { points: len, reach: listed, leash, changes, .. } = *self.listed;
        let is_same = len as usize == points.len() && listed == reach && changes == self.changes && leash > 0.0;
        if !is_same || !self.are_near(points, leash) {
            return None;
        }
        self.listed.uses += 1;
        Some(self.read(points.len()))
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
        let (places, rest) = self.words.split_at_mut(3 * points.len());
        let (spans, rest) = rest.split_at_mut(2 * points.len());
        let (order, entries) = rest.split_at_mut(points.len());
        bytemuck::cast_slice_mut(places).copy_from_slice(points);
        let spans: &mut [[u32; 2]] = bytemuck::cast_slice_mut(spans);
        let (mut rows, mut len, mut fits) = (0, 0, true);
        index.neighbours(reach + skin, &mut |row, others| {
            let is_next = rows == 0 || order[rows - 1] != row;
            if is_next {
                order[rows] = row;
                rows += 1;
                spans[row as usize] = [len as u32; 2];
            }
            fits &= len + others.len() <= entries.len();
            if fits {
                entries[len..len + others.len()].copy_from_slice(others);
                len += others.len();
                spans[row as usize][1] = len as u32;
            }
        });
        // Not again as soon, if there is no room.
        self.listed.uses = if fits { 0 } else { 1 };
        self.listed.pause = if fits { 0 } else { PAUSE };
        if !fits {
            return None;
        }
        for &row in &order[..rows] {
            let [start, end] = spans[row as usize].map(|at| at as usize);
            entries[start..end].sort_unstable();
        }
        let (changes, uses, pause) = (self.changes, 1, 0);
        // Half of the skin each, less what rounding may come to.
        let leash = 0.499 * skin - 4.0 * f32::EPSILON * farthest(points);
        *self.listed = Listed { points: points.len() as u32, rows: rows as u32, reach, leash, changes, uses, pause };
        Some(self.read(points.len()))
    }

    fn read(&self, points: usize) -> Lists<'_> {
        let (spans, rest) = self.words[3 * points..].split_at(2 * points);
        let (order, entries) = rest.split_at(points);
        let order = &order[..self.listed.rows as usize];
        Lists { reach: self.listed.reach, order, spans: bytemuck::cast_slice(spans), entries }
    }

    /// Whether nobody has gone farther than the leash.
    fn are_near(&self, points: &[Vec3], leash: f32) -> bool {
        let places: &[Vec3] = bytemuck::cast_slice(&self.words[..3 * points.len()]);
        let square = leash * leash;
        let far = |(&place, &point): (&Vec3, &Vec3)| {
            let d = point - place;
            u32::from(!(d.x * d.x + d.y * d.y + d.z * d.z <= square))
        };
        places.iter().zip(points).map(far).fold(0, |any, far| any | far) == 0
    }
}
