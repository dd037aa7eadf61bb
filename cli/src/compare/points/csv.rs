//! Tables: with a head line or without, fields parted by semicolons, tabs, commas or blanks.
//!
//! A row of points is a line, so lines are counted here and split by hand: the library that writes our tables counts an
//! empty line, and the second half of a Windows line end, to the row before.

use super::{Cloud, Fault, Lines, number};
use crate::meshes::error::excerpt;
use std::io::BufRead;

/// What columns of coordinates are called, by axis; the first are what `pointmass run --out` writes.
const NAMES: [[&str; 6]; 3] = [
    ["x", "position.x", "position_x", "pos.x", "pos_x", "px"],
    ["y", "position.y", "position_y", "pos.y", "pos_y", "py"],
    ["z", "position.z", "position_z", "pos.z", "pos_z", "pz"],
];

pub(super) fn read(file: impl BufRead) -> Result<Cloud, Fault> {
    let (mut lines, mut cloud) = (Lines::new(file), Cloud::default());
    let (mut delimiter, mut columns, mut is_first) = (None, None, true);
    let mut ends = Vec::new();
    while let Some(line) = lines.next()? {
        if line.is_empty() || line[0] == b'#' {
            continue;
        }
        let row = Row::split(line, *delimiter.get_or_insert_with(|| delimiter_of(line)), &mut ends);
        let told = if std::mem::take(&mut is_first) && row.is_head() {
            Columns::named(&row).map(|named| columns = named)
        } else {
            take(&row, &mut columns, &mut cloud)
        };
        told.map_err(|message| Fault::at(lines.number, message))?;
    }
    Ok(cloud)
}

/// Takes in the point of a row; the first such says where the columns are, if no head did.
fn take(row: &Row<'_>, columns: &mut Option<Columns>, cloud: &mut Cloud) -> Result<(), String> {
    let columns = match columns {
        Some(columns) => columns,
        None => columns.insert(Columns::numeric(row)?),
    };
    if columns.is_new_record(row) {
        cloud.restart();
    }
    cloud.push(columns.point(row)?)
}

/// What parts the fields of a line.
fn delimiter_of(line: &[u8]) -> u8 {
    [b';', b'\t', b',', b' '].into_iter().find(|delimiter| line.contains(delimiter)).unwrap_or(b',')
}

fn axis_of(field: &[u8]) -> Option<usize> {
    NAMES.iter().position(|names| names.iter().any(|name| name.as_bytes().eq_ignore_ascii_case(field)))
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

    /// A head names coordinates, or at least has no number in it.
    fn is_head(&self) -> bool {
        self.fields().any(|field| axis_of(field).is_some()) || !self.fields().any(|field| number(field).is_some())
    }

    /// The row, as it may be shown.
    fn quoted(&self) -> String {
        format!("`{}`", excerpt(&String::from_utf8_lossy(self.line)))
    }
}

/// Where coordinates are in a row.
struct Columns {
    /// None: all points have z = 0.
    axes: [Option<usize>; 3],
    /// Where the number of a record is, if there are several; and the one that was read last.
    step: Option<usize>,
    last: Vec<u8>,
}

impl Columns {
    /// By the names in a head; none if it has no names of coordinates at all.
    fn named(head: &Row<'_>) -> Result<Option<Self>, String> {
        let axes = [0, 1, 2].map(|axis| head.fields().position(|field| axis_of(field) == Some(axis)));
        let step = head.fields().position(|field| field.eq_ignore_ascii_case(b"step"));
        match axes {
            [None, None, None] => Ok(None),
            [Some(_), Some(_), _] => Ok(Some(Self { axes, step, last: Vec::new() })),
            _ => Err(format!("{}: expected columns x and y, and z if the points are not planar", head.quoted())),
        }
    }

    /// The first three that hold numbers, or the only two.
    fn numeric(row: &Row<'_>) -> Result<Self, String> {
        let numbers = row.fields().enumerate().filter(|(_, field)| number(field).is_some());
        let mut columns = numbers.map(|(column, _)| column);
        let axes = [columns.next(), columns.next(), columns.next()];
        match axes[1] {
            Some(_) => Ok(Self { axes, step: None, last: Vec::new() }),
            None => Err(format!("{}: expected two or three columns of numbers", row.quoted())),
        }
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

    fn point(&self, row: &Row<'_>) -> Result<[f32; 3], String> {
        let mut point = [0.0; 3];
        for (axis, coordinate) in point.iter_mut().enumerate() {
            let Some(column) = self.axes[axis] else { continue };
            let name = ["x", "y", "z"][axis];
            let field = row.get(column).ok_or_else(|| {
                let (fields, column) = (row.ends.len(), column + 1);
                format!("{}: {fields} fields: expected {name} in column {column}", row.quoted())
            })?;
            *coordinate = number(field).ok_or_else(|| {
                let value = excerpt(&String::from_utf8_lossy(field));
                format!("`{value}` in column {}: expected a number as {name}", column + 1)
            })?;
        }
        Ok(point)
    }
}
