//! Columns of a user's own: numbers with names that each particle carries along.

use crate::composed::stands_for;
use crate::memory::{Columns, Layout, Slices, Workspace};
use core::fmt;
use core::ops::Range;

/// A number with a name that each particle has beside the engine's own: its heat, its fuel, how worn it is.
///
/// The engine does nothing with it but keep it: it moves with its particle, and is in the system's hash. Whatever sees the
/// [`State`](crate::force::State) reads it; a force ([`Force::write`](crate::Force::write)), a constraint
/// ([`Bodies::custom`](crate::constrain::Bodies::custom)), an observer ([`Observer::write`](crate::Observer::write)) and
/// whoever owns the system ([`System::custom_mut`](crate::System::custom_mut)) change it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Custom<'a> {
    /// Its name.
    pub name: &'a str,
    /// The values of the scene's start, by the particles' numbers; those beyond have what newborns have.
    pub start: &'a [f32],
    /// The value of those that emitters bring.
    pub newborn: f32,
}

impl<'a> Custom<'a> {
    /// One that is zero.
    #[must_use]
    pub const fn new(name: &'a str) -> Self {
        Self { name, start: &[], newborn: 0.0 }
    }
}

/// The columns of a user's own that a scene has. A slice, vector, reference or box of them is one.
///
/// Numbers lie in memory by a column's place in the list. Names are for who asks: a system that goes on with a scene whose list has other names, or
/// the same in another order, has the numbers of before under these. Columns that come behind them hold whatever lay there, such as
/// what constraints keep.
pub trait CustomList: Sync {
    /// How many.
    fn count(&self) -> usize;

    /// One of them.
    fn get(&self, number: usize) -> Option<Custom<'_>>;

    /// The function that a step calls for them; none, where it is known that there never are any.
    fn code(&self) -> Option<CustomCode> {
        Some(CustomCode::ALL)
    }
}

/// The function that columns of a user's own call for in a step. A program without such columns does not carry it
/// about.
#[derive(Clone, Copy, Debug)]
pub struct CustomCode {
    /// Gives rows from one on what they begin with.
    pub(crate) give: fn(&dyn CustomList, &mut Slices<'_>, Newcomers<'_>),
}

impl CustomCode {
    /// All of it.
    pub const ALL: Self = Self { give };
}

/// Rows that have come in.
pub(crate) struct Newcomers<'a> {
    /// The first of them, and the number of all rows.
    pub(crate) first: usize,
    pub(crate) len: usize,
    /// Serials below are those of the scene's start.
    pub(crate) start: u32,
    pub(crate) layout: &'a Layout,
}

fn give(list: &dyn CustomList, memory: &mut Slices<'_>, rows: Newcomers<'_>) {
    let Newcomers { first, len, start, layout } = rows;
    let (serial, (values, _)) = (&memory.serial[..len], layout.kept(memory.kept));
    for (number, column) in values.chunks_mut(layout.capacity().max(1)).enumerate().take(list.count()) {
        let Some(custom) = list.get(number) else { continue };
        for (to, &serial) in column.iter_mut().zip(serial).skip(first) {
            let given = custom.start.get(serial as usize).filter(|_| serial < start);
            *to = given.copied().unwrap_or(custom.newborn);
        }
    }
}

impl Workspace<'_> {
    /// Columns of a user's own, for writing.
    pub(crate) fn custom_mut<'s>(&'s mut self, list: &'s dyn CustomList, layout: &Layout) -> CustomColumnsMut<'s> {
        let (capacity, len) = (self.capacity(), self.len());
        CustomColumnsMut::new(list, layout.kept(self.memory.kept).0, capacity, len)
    }

    /// Gives rows from `first` on what they begin with in columns of a user's own.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn give_custom(&mut self, list: &dyn CustomList, layout: &Layout, first: usize) {
        let Some(code) = list.code() else { return };
        let rows = Newcomers { first, len: self.len(), start: self.status.start, layout };
        (code.give)(list, self.memory, rows);
    }
}

impl CustomList for () {
    fn count(&self) -> usize {
        0
    }
    fn get(&self, _: usize) -> Option<Custom<'_>> {
        None
    }
    fn code(&self) -> Option<CustomCode> {
        None
    }
}

stands_for! {
    CustomList {
        fn count(&self) -> usize {
            (**self).count()
        }
        fn get(&self, number: usize) -> Option<Custom<'_>> {
            (**self).get(number)
        }
        fn code(&self) -> Option<CustomCode> {
            (**self).code()
        }
    }
}

impl CustomList for [Custom<'_>] {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<Custom<'_>> {
        <[_]>::get(self, number).copied()
    }
}

#[cfg(feature = "alloc")]
impl CustomList for alloc::vec::Vec<Custom<'_>> {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<Custom<'_>> {
        self.as_slice().get(number).copied()
    }
}

impl<const N: usize> CustomList for [Custom<'_>; N] {
    fn count(&self) -> usize {
        N
    }
    fn get(&self, number: usize) -> Option<Custom<'_>> {
        self.as_slice().get(number).copied()
    }
}

/// A column of a user's own, as files say it.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CustomBuf {
    /// Its name.
    pub name: alloc::string::String,
    /// The values of the scene's start, by the particles' places; those beyond have what newborns have.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "alloc::vec::Vec::is_empty"))]
    pub start: alloc::vec::Vec<f32>,
    /// The value of those that emitters bring.
    #[cfg_attr(feature = "serde", serde(default))]
    pub newborn: f32,
}

#[cfg(feature = "alloc")]
impl CustomList for alloc::vec::Vec<CustomBuf> {
    fn count(&self) -> usize {
        self.len()
    }
    fn get(&self, number: usize) -> Option<Custom<'_>> {
        let CustomBuf { name, start, newborn } = self.as_slice().get(number)?;
        Some(Custom { name, start, newborn: *newborn })
    }
}

/// The number of the column with a name.
fn number_of(list: &dyn CustomList, name: &str) -> Option<usize> {
    (0..list.count()).find(|&number| list.get(number).is_some_and(|custom| custom.name == name))
}

/// Columns of a user's own, for reading: one entry a row.
#[derive(Clone, Copy)]
pub struct CustomColumns<'a> {
    list: &'a dyn CustomList,
    /// All columns, one behind the other, and how long each is.
    values: &'a [f32],
    stride: usize,
    /// The rows that are seen.
    rows: [usize; 2],
}

/// Columns of a user's own, for writing: one entry a row.
pub struct CustomColumnsMut<'a> {
    list: &'a dyn CustomList,
    values: &'a mut [f32],
    stride: usize,
    len: usize,
}

impl<'a> CustomColumns<'a> {
    /// None.
    pub(crate) const NONE: CustomColumns<'static> = CustomColumns { list: &(), values: &[], stride: 0, rows: [0; 2] };

    /// Those of `len` rows, in columns of `stride` values.
    pub(crate) fn new(list: &'a dyn CustomList, values: &'a [f32], stride: usize, len: usize) -> Self {
        Self { list, values, stride, rows: [0, len] }
    }

    /// The same, at the beginning of what is kept.
    #[inline(never)]
    pub(crate) fn kept(list: &'a dyn CustomList, words: &'a [u32], stride: usize, len: usize) -> Self {
        let words = words.get(..list.count().saturating_mul(stride)).unwrap_or(&[]);
        Self::new(list, bytemuck::cast_slice(words), stride, len)
    }

    /// Those of the first `len` rows of a system.
    pub(crate) fn of(list: &'a dyn CustomList, memory: Columns<'a>, len: usize) -> Self {
        Self::kept(list, memory.kept, memory.capacity(), len)
    }

    /// The list that they are of.
    pub(crate) fn list(&self) -> &'a dyn CustomList {
        self.list
    }

    /// The column with a number, in the order in which the scene lists them; empty where there is none.
    #[must_use]
    pub fn column(&self, number: usize) -> &'a [f32] {
        let start = number.saturating_mul(self.stride);
        let [first, end] = self.rows.map(|row| start.saturating_add(row));
        self.values.get(first..end).unwrap_or(&[])
    }

    /// The column with a name, if there is one.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&'a [f32]> {
        number_of(self.list, name).map(|number| self.column(number))
    }

    /// The number of columns.
    #[must_use]
    pub fn count(&self) -> usize {
        self.list.count()
    }

    /// The name of a column.
    #[must_use]
    pub fn name(&self, number: usize) -> Option<&'a str> {
        self.list.get(number).map(|custom| custom.name)
    }

    /// Some of the rows.
    pub(crate) fn rows(&self, rows: Range<usize>) -> Self {
        let [first, end] = self.rows;
        let cut = |row: usize| (first + row).min(end);
        Self { rows: [cut(rows.start), cut(rows.end)], ..*self }
    }
}

impl<'a> CustomColumnsMut<'a> {
    /// Those of `len` rows, in columns of `stride` values.
    pub(crate) fn new(list: &'a dyn CustomList, values: &'a mut [f32], stride: usize, len: usize) -> Self {
        Self { list, values, stride, len }
    }

    /// The same for reading.
    #[must_use]
    pub fn read(&self) -> CustomColumns<'_> {
        CustomColumns::new(self.list, self.values, self.stride, self.len)
    }

    /// The column with a number, in the order in which the scene lists them; empty where there is none.
    pub fn column_mut(&mut self, number: usize) -> &mut [f32] {
        let start = number.saturating_mul(self.stride);
        self.values.get_mut(start..start.saturating_add(self.len)).unwrap_or(&mut [])
    }

    /// The column with a name, if there is one.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut [f32]> {
        number_of(self.list, name).map(|number| self.column_mut(number))
    }
}

impl fmt::Debug for CustomColumns<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = (0..self.count()).map(|number| (self.name(number).unwrap_or_default(), self.column(number)));
        f.debug_map().entries(columns).finish()
    }
}

impl fmt::Debug for CustomColumnsMut<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.read().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_found_by_name_and_number_and_cut_to_rows() {
        let list = [Custom::new("heat"), Custom { newborn: 2.0, start: &[5.0], ..Custom::new("fuel") }];
        let mut values = [1.0, 2.0, 3.0, 9.0, 4.0, 5.0, 6.0, 9.0];
        let mut columns = CustomColumnsMut::new(&list, &mut values, 4, 3);
        columns.get_mut("fuel").expect("it is there")[2] = 7.0;
        assert!(columns.get_mut("smoke").is_none() && columns.column_mut(2).is_empty());
        let read = columns.read();
        assert_eq!(read.get("heat"), Some(&[1.0, 2.0, 3.0][..]));
        assert_eq!(read.rows(1..3).get("fuel"), Some(&[5.0, 7.0][..]));
        assert_eq!(read.rows(1..3).rows(1..9).column(0), [3.0]);
        assert_eq!((read.count(), read.name(1), read.name(2)), (2, Some("fuel"), None));
        assert!(CustomColumns::NONE.column(0).is_empty() && CustomColumns::NONE.get("").is_none());
    }
}
