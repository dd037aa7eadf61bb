//! Lists of neighbours that last until somebody has gone half their skin (Verlet, "Computer 'Experiments' on Classical
//! Fluids", Phys. Rev. 159, 1967).

use super::SpatialIndex;
use super::nearby::{Nearby, in_runs};
use crate::math::{max, sqrt};
use crate::rows::farthest;
use core::ops::Range;
use glam::Vec3;

/// Words of a point's own: its row, where its list ends, where it was when the lists were made and where it is.
const OWN: usize = 8;
/// Steps that go by without lists after these have been of no use.
const PAUSE: u32 = 16;
/// Within what the squares of coordinates and of radii are numbers \[m\].
const TAME: Range<f32> = 1e-15..1e15;

/// What is known of the lists in a system's memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Listed {
    /// Points that they are of.
    points: u32,
    /// The radius that they are good for, and how far anybody may go meanwhile \[m\].
    reach: f32,
    leash: f32,
    /// How many had come and gone before them.
    changes: u32,
    /// Words that were lent for them: others are not theirs.
    words: usize,
    /// How often they have been of use, and how many more times there are to be none.
    uses: u32,
    pause: u32,
}

/// The memory of lists, and what is known of them.
pub(crate) struct ListMemory<'a> {
    words: &'a mut [u32],
    listed: &'a mut Listed,
    /// How many particles have come and gone.
    changes: u32,
    /// How long a step is \[s\].
    step: f32,
}

/// Lists, for reading. Points are numbered anew, in the order in which the index has visited them: what is near in
/// space is near in memory.
#[derive(Clone, Copy)]
pub(crate) struct Lists<'a> {
    reach: f32,
    /// Their rows.
    rows: &'a [u32],
    /// Where their lists end.
    ends: &'a [u32],
    /// Where they are.
    places: &'a [Vec3],
    /// The lists, one behind the other: in the order of rows.
    entries: &'a [u32],
}

/// The same, in the making.
struct Parts<'a> {
    rows: &'a mut [u32],
    ends: &'a mut [u32],
    made: &'a mut [Vec3],
    places: &'a mut [Vec3],
    entries: &'a mut [u32],
}

impl Listed {
    /// None.
    pub(crate) const NONE: Self = Self { points: 0, reach: 0.0, leash: 0.0, changes: 0, words: 0, uses: 0, pause: 0 };
}

impl Lists<'_> {
    /// Whether they hold all within so far.
    pub(super) fn reaches(&self, reach: f32) -> bool {
        reach <= self.reach
    }

    /// As [`Neighbours::of`](super::Neighbours::of).
    pub(super) fn of(&self, rows: Range<usize>, reach: f32, visit: &mut dyn FnMut(usize, &Nearby)) {
        let mut start = 0;
        for ((&row, &end), &place) in self.rows.iter().zip(self.ends).zip(self.places) {
            let (row, list) = (row as usize, &self.entries[start..end as usize]);
            start = end as usize;
            if rows.contains(&row) {
                let others = list.iter().map(|&other| (self.rows[other as usize], self.places[other as usize]));
                in_runs((row, place), others, reach, visit);
            }
        }
    }
}

impl<'a> ListMemory<'a> {
    /// Memory for lists; those in it count no longer if it is not the same as before.
    pub(crate) fn new(words: &'a mut [u32], listed: &'a mut Listed, changes: u32, step: f32) -> Self {
        if listed.words != words.len() {
            *listed = Listed::NONE;
        }
        Self { words, listed, changes, step }
    }

    /// The same, lent on.
    pub(crate) fn again(&mut self) -> ListMemory<'_> {
        ListMemory { words: self.words, listed: self.listed, ..*self }
    }

    /// The lists, if they are still good for these points.
    pub(crate) fn kept(&mut self, points: &[Vec3], reach: f32) -> Option<Lists<'_>> {
        let Listed { points: len, reach: listed, leash, changes, .. } = *self.listed;
        let is_same = len as usize == points.len() && listed == reach && changes == self.changes && leash > 0.0;
        if !is_same || !self.follow(points, leash) {
            return None;
        }
        self.listed.uses += 1;
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
        let Parts { rows, ends, made, places, entries } = parts(self.words, points.len());
        let (mut count, mut len, mut fits) = (0, 0, true);
        index.neighbours(reach + skin, &mut |row, others| {
            if count == 0 || rows[count - 1] != row {
                let Some(next) = rows.get_mut(count) else { return fits = false };
                *next = row;
                count += 1;
            }
            fits &= len + others.len() <= entries.len();
            if fits {
                entries[len..len + others.len()].copy_from_slice(others);
                len += others.len();
                ends[count - 1] = len as u32;
            }
        });
        // Not again as soon, if there is no room.
        self.listed.pause = if fits { 0 } else { PAUSE };
        if !fits {
            return None;
        }
        let numbers: &mut [u32] = bytemuck::cast_slice_mut(places);
        let numbers = &mut numbers[..points.len()];
        numbers.fill(u32::MAX);
        (0..).zip(&rows[..count]).for_each(|(number, &row)| numbers[row as usize] = number);
        // Whoever has no neighbours is watched as well: it may come near others.
        for row in (0..).take(points.len()).filter(|&row| numbers[row as usize] == u32::MAX) {
            // An index that comes back to a row has none for another.
            let (next, end) = rows.get_mut(count).zip(ends.get_mut(count))?;
            (*next, *end) = (row, len as u32);
            count += 1;
        }
        let mut start = 0;
        for &end in &*ends {
            let list = &mut entries[start..end as usize];
            list.sort_unstable();
            list.iter_mut().for_each(|other| *other = numbers[*other as usize]);
            start = end as usize;
        }
        for ((made, place), &row) in made.iter_mut().zip(places).zip(&*rows) {
            (*made, *place) = (points[row as usize], points[row as usize]);
        }
        let (changes, words, uses, pause) = (self.changes, self.words.len(), 1, 0);
        // Half of the skin each, less what rounding may come to.
        let leash = 0.499 * skin - 4.0 * f32::EPSILON * farthest(points);
        *self.listed = Listed { points: points.len() as u32, reach, leash, changes, words, uses, pause };
        Some(self.read())
    }

    fn read(&mut self) -> Lists<'_> {
        let Listed { points, reach, .. } = *self.listed;
        let Parts { rows, ends, places, entries, .. } = parts(self.words, points as usize);
        Lists { reach, rows, ends, places, entries }
    }

    /// Takes up where all are, and says whether nobody has gone farther than the leash.
    fn follow(&mut self, points: &[Vec3], leash: f32) -> bool {
        let square = leash * leash;
        let Parts { rows, made, places, .. } = parts(self.words, points.len());
        let mut any = 0;
        for ((place, made), &row) in places.iter_mut().zip(made).zip(&*rows) {
            *place = points[row as usize];
            let d = *place - *made;
            any |= u32::from(!(d.x * d.x + d.y * d.y + d.z * d.z <= square));
        }
        any == 0
    }
}

/// The parts of memory for lists of so many points.
fn parts(words: &mut [u32], points: usize) -> Parts<'_> {
    let (rows, rest) = words.split_at_mut(points);
    let (ends, rest) = rest.split_at_mut(points);
    let (made, rest) = rest.split_at_mut(3 * points);
    let (places, entries) = rest.split_at_mut(3 * points);
    Parts { rows, ends, made: bytemuck::cast_slice_mut(made), places: bytemuck::cast_slice_mut(places), entries }
}
