//! The index of a state, made once for all who ask who is near in it: births, forces, deaths.

use super::facts::ARE_KEPT;
use super::{Facts, IndexChoice, SpatialIndex};
use crate::math::max;
use core::marker::PhantomData;
use glam::Vec3;

/// The facts on an index that lies in a system's memory.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Record {
    /// The radius that is asked for by who looks the farthest \[m\].
    reach: f32,
    /// One of the next.
    kind: u32,
    /// Words that it was built in.
    words: u32,
    facts: Facts,
}

/// There is none; its rows are the particles'; they are those of names that stay when particles change their rows.
const NONE: u32 = 0;
const ROWS: u32 = 1;
const NAMED: u32 = 2;

/// Words of a record.
const RECORD: usize = size_of::<Record>() / 4;

/// Words of what is known of the index of a state beside its own: a whole number of vectors.
pub(crate) const fn index_words() -> usize {
    if ARE_KEPT { RECORD.next_multiple_of(3) } else { 0 }
}

/// The memory of an index that is left alone from one who asks to the next: a record of it, and its words. Empty, there is none, and chips
/// never have any: they are spared the words to say so.
#[derive(Debug)]
pub(crate) struct Lasting<'a>(#[cfg(not(target_os = "none"))] &'a mut [u32], PhantomData<&'a mut [u32]>);

impl<'a> Lasting<'a> {
    /// None.
    pub(crate) fn none() -> Self {
        Self(
            #[cfg(not(target_os = "none"))]
            &mut [],
            PhantomData,
        )
    }

    /// In words, of which the first are for the record.
    #[cfg(not(target_os = "none"))]
    pub(crate) fn of(words: &'a mut [u32]) -> Self {
        Self(words, PhantomData)
    }

    /// None, on a chip.
    #[cfg(target_os = "none")]
    pub(crate) fn of(_: &'a mut [u32]) -> Self {
        Self::none()
    }

    /// The same, lent on.
    #[cfg(not(target_os = "none"))]
    pub(crate) fn again(&mut self) -> Lasting<'_> {
        Lasting::of(self.0)
    }

    /// The same, lent on.
    #[cfg(target_os = "none")]
    pub(crate) fn again(&mut self) -> Lasting<'_> {
        Self::none()
    }

    /// The record, and the words of the index.
    #[cfg(not(target_os = "none"))]
    fn parts(&mut self) -> Option<(&mut Record, &mut [u32])> {
        let (head, words) = self.0.split_at_mut_checked(index_words())?;
        Some((bytemuck::cast_slice_mut(head.get_mut(..RECORD)?).first_mut()?, words))
    }

    /// None.
    #[cfg(target_os = "none")]
    fn parts(&mut self) -> Option<(&mut Record, &mut [u32])> {
        None
    }
}

/// The particles of a state in an index.
pub(crate) struct StateIndex<'a> {
    choice: &'a dyn IndexChoice,
    /// Memory that is used for other things in between, where there is none that lasts.
    words: &'a mut [u32],
    lasting: Lasting<'a>,
}

impl<'a> StateIndex<'a> {
    /// An index by a choice in memory that lasts, if there is any, else in some that does not.
    pub(crate) fn new(choice: &'a dyn IndexChoice, words: &'a mut [u32], lasting: Lasting<'a>) -> Self {
        Self { choice, words, lasting }
    }

    /// The same, lent on.
    pub(crate) fn again(&mut self) -> StateIndex<'_> {
        StateIndex { choice: self.choice, words: self.words, lasting: self.lasting.again() }
    }

    /// The choice of the index.
    pub(crate) fn choice(&self) -> &'a dyn IndexChoice {
        self.choice
    }

    /// Says how far the farthest look of those who will ask \[m\], and whether memory has been left alone so far: else there is no index.
    pub(crate) fn begin(&mut self, reach: f32, is_intact: &mut bool) {
        if let Some((record, _)) = self.lasting.parts() {
            let kind = if *is_intact { record.kind } else { NONE };
            (record.reach, record.kind, *is_intact) = (reach, kind, true);
        }
    }

    /// Tells whether there is an index.
    pub(crate) fn is_there(&mut self) -> bool {
        self.lasting.parts().is_some_and(|(record, _)| record.kind != NONE)
    }

    /// Calls `then` with these points in an index, or with none if there is no memory for it: in that which is there, if it is of these points, else in one
    /// that is made for them, with this reach or more \[m\].
    pub(crate) fn with(&mut self, points: &[Vec3], reach: f32, then: &mut dyn FnMut(Option<&dyn SpatialIndex>)) {
        if ARE_KEPT && self.take_up(points, &mut |index| then(Some(index))) {
            return;
        }
        let (choice, room) = (self.choice, self.choice.room());
        // No more memory than these points call for: more would make another structure.
        let call_for = 3 * choice.columns() * points.len();
        let Some((record, words)) = self.lasting.parts() else {
            let words = call_for.min(self.words.len());
            return choice.with_index(&mut self.words[..words], points, reach, room, then);
        };
        let (len, mut facts) = (call_for.min(words.len()), None);
        choice.with_index(&mut words[..len], points, max(record.reach, reach), room, &mut |index| {
            facts = index.and_then(SpatialIndex::facts);
            then(index);
        });
        if let Some(facts) = facts {
            *record = Record { kind: ROWS, words: len as u32, facts, ..*record };
        }
    }

    /// The same only if the index that is there is of these points, or of these and of others that are not finite any more. Says whether it
    /// is; if not, there is none any more.
    pub(crate) fn take_up(&mut self, points: &[Vec3], then: &mut dyn FnMut(&dyn SpatialIndex)) -> bool {
        self.renumber(points, &mut Some, then)
    }

    fn renumber(
        &mut self,
        points: &[Vec3],
        row_of: &mut dyn FnMut(u32) -> Option<u32>,
        then: &mut dyn FnMut(&dyn SpatialIndex),
    ) -> bool {
        let Some((record, words)) = self.lasting.parts().filter(|(record, _)| record.kind != NONE) else {
            return false;
        };
        record.kind = NONE;
        let Some(words) = words.get_mut(..record.words as usize) else { return false };
        self.choice.reopen(words, self.choice.room(), &mut |index| {
            if record.kind == NONE && index.take_up(&record.facts, points, row_of) {
                (record.kind, record.facts) = (ROWS, index.facts().unwrap_or(record.facts));
                then(index);
            }
        });
        record.kind != NONE
    }

    /// Gives the rows of the index that is there names that stay when they change. They have to be kept for [`follow`](Self::follow).
    pub(crate) fn name(&mut self, names: &mut [u32], slots: &[u32]) {
        if let Some((record, _)) = self.lasting.parts().filter(|(record, _)| record.kind == ROWS) {
            names.iter_mut().zip(slots).for_each(|(name, slot)| *name = *slot);
            record.kind = NAMED;
        }
    }

    /// Strikes out of it those who have gone since, and gives the others the rows in which they are.
    pub(crate) fn follow(&mut self, points: &[Vec3], names: &[u32], row_of: &dyn Fn(u32) -> Option<u32>) {
        if self.lasting.parts().is_some_and(|(record, _)| record.kind == NAMED) {
            self.renumber(points, &mut |row| row_of(*names.get(row as usize)?), &mut |_| {});
        }
    }
}
