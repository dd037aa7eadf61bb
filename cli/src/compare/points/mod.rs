//! Points from files: CSV, PLY, XYZ and NPY, told apart by the end of their names.
//!
//! Whatever the bytes are, the answer is points or one line saying what is wrong with the file, in which row. Nothing is
//! allocated because a head promises it. Rows that are not finite as `f32` are skipped and counted.

mod csv;
mod npy;
mod ply;
#[cfg(test)]
mod tests;
mod xyz;

use crate::formats::PointsFormat;
use crate::{Failure, Outcome};
use pointmass::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// The most points that are read.
const MOST: usize = 100_000_000;
/// The longest line of a text, in bytes.
const LONGEST: u64 = 1 << 20;

/// Points, and what was met on the way to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// All of them finite.
    pub points: Vec<Vec3>,
    /// Rows left out because they are not finite.
    pub skipped: usize,
    /// Records that came before, of a file that has several; only the last is kept.
    pub earlier: usize,
}

impl Cloud {
    /// Takes a point in, or counts it as skipped.
    fn push(&mut self, [x, y, z]: [f32; 3]) -> Result<(), String> {
        let point = Vec3::new(x, y, z);
        if !point.is_finite() {
            self.skipped += 1;
        } else if self.points.len() < MOST {
            self.points.push(point);
        } else {
            return Err(format!("more than {MOST} points: expected fewer; thin them out"));
        }
        Ok(())
    }

    /// Forgets the points, for another record begins.
    fn restart(&mut self) {
        self.points.clear();
        self.skipped = 0;
        self.earlier += 1;
    }
}

/// Reads points from a file.
///
/// # Errors
/// If it cannot be read, is not in the format, or has fewer than two finite points; with the row's number where there is
/// one.
pub fn load(path: &Path, format: PointsFormat) -> Outcome<Cloud> {
    if path.is_dir() {
        return Err(Failure::new(format!("{}: is a directory, expected a file of points", path.display())));
    }
    let file = File::open(path).map_err(|error| Failure::io(path, &error))?;
    let cloud = read(BufReader::with_capacity(1 << 18, file), format)
        .map_err(|fault| Failure::new(format!("{}{fault}", path.display())))?;
    if cloud.points.len() < 2 {
        let (found, skipped) = (cloud.points.len(), cloud.skipped);
        let skipped = if skipped > 0 { format!(" and {skipped} that are not finite") } else { String::new() };
        let path = path.display();
        return Err(Failure::new(format!("{path}: has {found} finite points{skipped}: expected two or more")));
    }
    Ok(cloud)
}

/// What is wrong with a file, to be put behind its name.
#[derive(Debug, PartialEq)]
struct Fault {
    row: Option<u64>,
    message: String,
}

impl Fault {
    fn new(message: impl Into<String>) -> Self {
        Self { row: None, message: message.into() }
    }

    fn at(row: u64, message: impl Into<String>) -> Self {
        Self { row: Some(row), message: message.into() }
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.row {
            Some(row) => write!(out, ":{row}: {}", self.message),
            None => write!(out, ": {}", self.message),
        }
    }
}

impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        Self::new(format!("can't be read: {error}"))
    }
}

fn read(mut file: impl BufRead, format: PointsFormat) -> Result<Cloud, Fault> {
    if file.fill_buf()?.is_empty() {
        return Err(Fault::new("is empty: expected points"));
    }
    match format {
        PointsFormat::Csv => csv::read(file),
        PointsFormat::Ply => ply::read(file),
        PointsFormat::Xyz => xyz::read(file),
        PointsFormat::Npy => npy::read(file),
    }
}

/// A number as tables spell it: `nan` and `inf` are numbers, and so is what an `f32` cannot hold.
fn number(word: &[u8]) -> Option<f32> {
    let text = std::str::from_utf8(word.trim_ascii()).ok()?;
    text.parse().ok()
}

/// Lines of a text, numbered from 1, without what is not UTF-8.
struct Lines<R> {
    from: R,
    line: Vec<u8>,
    number: u64,
}

impl<R: BufRead> Lines<R> {
    fn new(from: R) -> Self {
        Self { from, line: Vec::new(), number: 0 }
    }

    /// The next line, however short.
    fn next(&mut self) -> Result<Option<&[u8]>, Fault> {
        self.line.clear();
        let read = (&mut self.from).take(LONGEST).read_until(b'\n', &mut self.line)?;
        self.number += 1;
        if read as u64 == LONGEST {
            return Err(Fault::at(self.number, "expected a line of less than 1 MiB"));
        }
        let line = self.line.strip_prefix(b"\xef\xbb\xbf").filter(|_| self.number == 1).unwrap_or(&self.line);
        Ok((read > 0).then_some(line.trim_ascii()))
    }
}
