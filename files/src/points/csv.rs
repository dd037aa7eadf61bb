//! Tables: with a head line or without, fields parted by semicolons, tabs, commas or blanks.
//!
//! A row of points is a line, so lines are counted here and split by hand: the library that writes our tables counts an
//! empty line, and the second half of a Windows line end, to the row before.

use super::{Fault, Lines, Rows, number};
use crate::outcome::excerpt;
use std::io::BufRead;

/// The names of columns of coordinates, by axis, the likeliest first; units in brackets may follow.
const NAMES: [&[&str]; 3] = [
    &["x", "position.x", "position_x", "pos.x", "pos_x", "px", "easting", "east"],
    &["y", "position.y", "position_y", "pos.y", "pos_y", "py", "northing", "north"],
    &["z", "position.z", "position_z", "pos.z", "pos_z", "pz", "elevation", "height"],
];

pub(super) fn read(file: impl BufRead) -> Result<Rows, Fault> {
    let (mut lines, mut table) = (Lines::new(file), Table::default());
    while let Some((number, line)) = lines.next()? {
        match line.strip_prefix(b"#").or_else(|| line.strip_prefix(b"//")) {
            Some(comment) => table.comment(comment),
            None if line.is_empty() => {}
            None => table.line(number, line)?,
        }
    }
    Ok(table.rows)
}

/// A table as far as it has been read.
#[derive(Default)]
struct Table {
    rows: Rows,
    is_begun: bool,
    delimiter: Option<u8>,
    columns: Option<Columns>,
    /// The names that a comment before the first row gives its columns, and how many these are.
    comment: Option<(Columns, usize)>,
    /// Where the fields of a line end; kept for its memory.
    ends: Vec<usize>,
}

impl Table {
    /// NumPy and CloudCompare write the head as a comment. Prose may have an x and a y in it too, but hardly side by side.
    fn comment(&mut self, comment: &[u8]) {
        if !self.is_begun {
            let row = Row::split(comment.trim_ascii(), delimiter_of(comment.trim_ascii()), &mut self.ends);
            let columns = Columns::named(&row).ok().flatten();
            let columns = columns.filter(|columns| columns.axes[1] == columns.axes[0].map(|x| x + 1));
            self.comment = columns.map(|columns| (columns, row.ends.len()));
        }
    }

    fn line(&mut self, number: u64, line: &[u8]) -> Result<(), Fault> {
        let row = Row::split(line, *self.delimiter.get_or_insert_with(|| delimiter_of(line)), &mut self.ends);
        let fault = |message| Fault::at(number, message);
        let is_first = !std::mem::replace(&mut self.is_begun, true);
        if is_first && row.is_head() {
            self.columns = Columns::named(&row).map_err(fault)?;
            return Ok(());
        }
        let columns = match &mut self.columns {
            Some(columns) => columns,
            none => {
                let commented = self.comment.take().filter(|(_, fields)| *fields == row.ends.len());
                let columns = match commented {
                    Some((columns, _)) => columns,
                    None => Columns::numeric(&row, number).map_err(fault)?,
                };
                if columns.guess.is_some() {
                    self.rows.columns = columns.axes.iter().flatten().map(|column| column + 1).collect();
                }
                none.insert(columns)
            }
        };
        if let Some(guess) = &columns.guess {
            guess.check(&row, number)?;
        }
        if columns.is_new_record(&row) {
            self.rows.restart();
        }
        columns.point(&row).and_then(|point| self.rows.push(point)).map_err(fault)
    }
}

/// The sign that parts the fields of a line.
fn delimiter_of(line: &[u8]) -> u8 {
    [b';', b'\t', b',', b' '].into_iter().find(|delimiter| line.contains(delimiter)).unwrap_or(b',')
}

/// A line and where its fields end.
struct Row<'a> {
    line: &'a [u8],
    ends: &'a [usize],
}

impl<'a> Row<'a> {
    /// Delimiters within quotes part nothing, and several blanks are one.
    fn split(line: &'a [u8], delimiter: u8, ends: &'a mut Vec<usize>) -> Self {
        ends.clear();
        let mut is_quoted = false;
        for (at, byte) in line.iter().enumerate() {
            is_quoted ^= *byte == b'"';
            let is_more_blank = delimiter == b' ' && at > 0 && line[at - 1] == b' ';
            if *byte == delimiter && !is_quoted && !is_more_blank {
                ends.push(at);
            }
        }
        ends.push(line.len());
        Self { line, ends }
    }

    /// A field without blanks and quotes around it.
    fn get(&self, column: usize) -> Option<&'a [u8]> {
        let start = if column == 0 { 0 } else { self.ends.get(column - 1)? + 1 };
        let field = self.line[start..*self.ends.get(column)?].trim_ascii();
        Some(field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field))
    }

    fn fields(&self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.ends.len()).filter_map(|column| self.get(column))
    }

    /// A head names x and y, or at least has nothing in it that begins as numbers do.
    fn is_head(&self) -> bool {
        let is_number = |field: &[u8]| {
            let digits = field.strip_prefix(b"-").or_else(|| field.strip_prefix(b"+")).unwrap_or(field);
            let digits = digits.strip_prefix(b".").unwrap_or(digits);
            digits.first().is_some_and(u8::is_ascii_digit) || number(field).is_some()
        };
        self.column_of(0).and(self.column_of(1)).is_some() || !self.fields().any(is_number)
    }

    /// Which column is called as an axis is.
    fn column_of(&self, axis: usize) -> Option<usize> {
        let bare = |field: &'a [u8]| {
            let end = field.iter().position(|byte| b"[(".contains(byte)).unwrap_or(field.len());
            field[..end].trim_ascii()
        };
        let find = |name: &&str| self.fields().position(|field| bare(field).eq_ignore_ascii_case(name.as_bytes()));
        NAMES[axis].iter().find_map(find)
    }

    /// The row, as it may be shown.
    fn quoted(&self) -> String {
        format!("`{}`", excerpt(&String::from_utf8_lossy(self.line)))
    }

    /// A field, as it may be shown.
    fn excerpt(&self, column: usize) -> String {
        excerpt(&String::from_utf8_lossy(self.get(column).unwrap_or_default()))
    }
}

/// Where coordinates are in a row.
struct Columns {
    /// None: all points have z = 0.
    axes: [Option<usize>; 3],
    /// How they were found, if no head names them.
    guess: Option<Guess>,
    /// Where the number of a record is, if there are several; and the one that was read last.
    step: Option<usize>,
    last: Vec<u8>,
}

impl Columns {
    /// By the names in a head; none if it has no names of coordinates at all.
    fn named(head: &Row<'_>) -> Result<Option<Self>, String> {
        let axes = [0, 1, 2].map(|axis| head.column_of(axis));
        let called = |name: &str| head.fields().position(|field| field.eq_ignore_ascii_case(name.as_bytes()));
        // Others have numbers of steps too, but no particles in them.
        let step = called("step").filter(|_| called("id").is_some());
        match axes {
            [None, None, None] => Ok(None),
            [Some(_), Some(_), _] => Ok(Some(Self { axes, guess: None, step, last: Vec::new() })),
            _ => Err(format!("{}: expected columns x and y, and z if the points are not planar", head.quoted())),
        }
    }

    /// The first three that hold numbers, or the only two.
    fn numeric(row: &Row<'_>, line: u64) -> Result<Self, String> {
        let is_number = |column: &usize| row.get(*column).and_then(number).is_some();
        let (numbers, words): (Vec<usize>, Vec<usize>) = (0..row.ends.len()).partition(is_number);
        let axes = [0, 1, 2].map(|axis| numbers.get(axis).copied());
        if axes[1].is_none() {
            return Err(format!("{}: expected two or three columns of numbers", row.quoted()));
        }
        let before = words.into_iter().filter(|word| axes[2].is_none_or(|z| *word < z));
        let words = before.map(|word| (word, row.excerpt(word))).collect();
        let fields = axes[2].is_none().then_some(row.ends.len());
        Ok(Self { axes, guess: Some(Guess { line, words, fields }), step: None, last: Vec::new() })
    }

    /// Whether the row is of another step than the one before.
    fn is_new_record(&mut self, row: &Row<'_>) -> bool {
        let Some(step) = self.step.and_then(|column| row.get(column)) else { return false };
        if self.last == step {
            return false;
        }
        let is_first = self.last.is_empty();
        self.last.clear();
        self.last.extend_from_slice(step);
        !is_first
    }

    fn point(&self, row: &Row<'_>) -> Result<[f64; 3], String> {
        let mut point = [0.0; 3];
        for (axis, coordinate) in point.iter_mut().enumerate() {
            let Some(column) = self.axes[axis] else { continue };
            let name = ["x", "y", "z"][axis];
            let field = row.get(column).ok_or_else(|| {
                let (fields, column) = (row.ends.len(), column + 1);
                format!("{}: {fields} fields: expected {name} in column {column}", row.quoted())
            })?;
            *coordinate = number(field).ok_or_else(|| {
                let commas = field.iter().filter(|byte| **byte == b',').count();
                let hint = if commas == 1 { ", with a decimal point" } else { "" };
                format!("`{}` in column {}: expected a number as {name}{hint}", row.excerpt(column), column + 1)
            })?;
        }
        Ok(point)
    }
}

/// The look of the first row, where nothing but that says which columns are coordinates; others have to look alike,
/// or a slip in the first row would be taken for a column of words.
struct Guess {
    line: u64,
    /// Columns without a number before that of z, or at all if there is none; and what is there.
    words: Vec<(usize, String)>,
    /// How many fields there are in every row, if the points are planar.
    fields: Option<usize>,
}

impl Guess {
    fn check(&self, row: &Row<'_>, line: u64) -> Result<(), Fault> {
        let is_number = |column| row.get(column).and_then(number).is_some_and(f64::is_finite);
        if let Some((column, word)) = self.words.iter().find(|(column, _)| is_number(*column)) {
            let column = column + 1;
            let message = format!(
                "`{word}` in column {column}: expected a number, as in line {line}; if it is none, name the columns x, y and \
                 z in a head line"
            );
            return Err(Fault::at(self.line, message));
        }
        match self.fields.filter(|fields| *fields != row.ends.len()) {
            None => Ok(()),
            Some(fields) => {
                let (found, first) = (row.ends.len(), self.line);
                Err(Fault::at(line, format!("{}: {found} fields: expected {fields}, as in line {first}", row.quoted())))
            }
        }
    }
}
