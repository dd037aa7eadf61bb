//! Tables: made once, laid out by `terminal` and `page`, and written as CSV for other programs.

use crate::outcome::{Failure, Outcome};

/// A table by its columns, of which the first names the rows.
#[derive(Debug, Default)]
pub(crate) struct Table(pub(crate) Vec<Column>);

/// A column of a table.
#[derive(Debug)]
pub(crate) struct Column {
    pub(crate) head: String,
    /// Whether it holds words, which begin at the left and may take several lines.
    pub(crate) has_words: bool,
    pub(crate) cells: Vec<Cell>,
}

/// The contents of a cell; nothing, where there is nothing to say.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    text: Option<String>,
    /// A lesser number behind it.
    pub(crate) aside: Option<String>,
    pub(crate) is_best: bool,
}

impl Cell {
    /// A number with a lesser one behind it.
    pub(crate) fn with(text: String, aside: String) -> Self {
        Self { text: Some(text), aside: Some(aside), is_best: false }
    }

    /// Marks it, if it is the best.
    pub(crate) fn best(self, is_best: bool) -> Self {
        Self { is_best, ..self }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self { text: Some(text.into()), ..Self::default() }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { text: Some(text), ..Self::default() }
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map(Into::into).unwrap_or_default()
    }
}

/// Numbers with all their digits, for other programs.
macro_rules! whole_cells {
    ($($number:ty)*) => { $(impl From<$number> for Cell {
        fn from(number: $number) -> Self {
            let text = serde_json::to_string(&number).ok().filter(|text| text != "null");
            text.unwrap_or_else(|| number.to_string()).into()
        }
    })* };
}
whole_cells!(f32 f64 u64 usize bool);

impl Table {
    /// Adds a column of numbers.
    pub(crate) fn column<C: Into<Cell>>(&mut self, head: impl Into<String>, cells: impl IntoIterator<Item = C>) {
        let cells = cells.into_iter().map(Into::into).collect();
        self.0.push(Column { head: head.into(), has_words: self.0.is_empty(), cells });
    }

    /// Adds a column of words.
    pub(crate) fn words<C: Into<Cell>>(&mut self, head: impl Into<String>, cells: impl IntoIterator<Item = C>) {
        self.column(head, cells);
        self.0.iter_mut().next_back().into_iter().for_each(|column| column.has_words = true);
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = impl Iterator<Item = &Cell>> {
        let rows = self.0.first().map_or(0, |column| column.cells.len());
        (0..rows).map(|row| self.0.iter().filter_map(move |column| column.cells.get(row)))
    }

    /// The table for other programs: a head line, then a line a row.
    pub(crate) fn csv(&self) -> Outcome<String> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.0.iter().map(|column| &column.head))?;
        for row in self.rows() {
            writer.write_record(row.map(|cell| cell.text.as_deref().unwrap_or_default()))?;
        }
        let bytes = writer.into_inner().map_err(|error| Failure::new(error.to_string()))?;
        Ok(String::from_utf8(bytes)?)
    }
}

impl Column {
    /// The sign that stands where there is nothing.
    pub(crate) fn shown<'a>(&self, cell: &'a Cell) -> &'a str {
        cell.text.as_deref().unwrap_or(if self.has_words { "" } else { "-" })
    }
}
