//! A column of numbers that need not exist: then all particles have the same one.

use core::ops::Deref;

/// A column of particles that an owner of memory may leave out, because all of them have the same in it.
#[derive(Debug)]
pub enum Column<'a, T> {
    /// One entry a row.
    Own(&'a mut [T]),
    /// What all have, as often as there are rows, and equal all over: only read, so it may lie in a chip's flash, and not in its memory.
    Common(&'a [T]),
}

impl<'a, T: Copy + PartialEq> Column<'a, T> {
    /// The same column, borrowed again.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn again(&mut self) -> Column<'_, T> {
        match self {
            Self::Own(rows) => Column::Own(rows),
            Self::Common(rows) => Column::Common(rows),
        }
    }

    /// All of it, for changing, if it exists; else no entries.
    pub fn own(&mut self) -> &mut [T] {
        match self {
            Self::Own(rows) => rows,
            Self::Common(_) => &mut [],
        }
    }

    /// Tells whether it exists.
    pub(crate) fn is_own(&self) -> bool {
        matches!(self, Self::Own(_))
    }

    /// Gives a row its number, if that may be in it, and says whether it may.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(crate) fn put(&mut self, row: usize, value: T) -> bool {
        match self {
            Self::Own(rows) => {
                rows[row] = value;
                true
            }
            // The first is in the cache, as it was asked for last time.
            Self::Common(rows) => rows.first() == Some(&value),
        }
    }

    /// Gives rows what others have, each `[from, to]`, one after the other.
    #[cfg_attr(one_by_one, inline(always))]
    pub(crate) fn move_rows(&mut self, moves: &[[u32; 2]]) {
        if let Self::Own(rows) = self {
            moves.iter().for_each(|[from, to]| rows[*to as usize] = rows[*from as usize]);
        }
    }
}

impl<T> Deref for Column<'_, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        match self {
            Self::Own(rows) => rows,
            Self::Common(rows) => rows,
        }
    }
}

impl<'a, T> From<&'a mut [T]> for Column<'a, T> {
    fn from(rows: &'a mut [T]) -> Self {
        Self::Own(rows)
    }
}

#[cfg(feature = "alloc")]
impl<'a, T> From<&'a mut alloc::vec::Vec<T>> for Column<'a, T> {
    fn from(rows: &'a mut alloc::vec::Vec<T>) -> Self {
        Self::Own(rows)
    }
}

impl<'a, T, const ROWS: usize> From<&'a mut [T; ROWS]> for Column<'a, T> {
    fn from(rows: &'a mut [T; ROWS]) -> Self {
        Self::Own(rows)
    }
}
