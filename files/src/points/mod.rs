//! Points from files: CSV, PLY, XYZ and NPY, told apart by the end of their names.
//!
//! Whatever the bytes are, the answer is points or one line saying what is wrong with the file, in which row. Nothing is
//! allocated because a head promises it. Rows that are not finite as `f32` are skipped and counted. Coordinates far from
//! zero, as those of a survey are, are moved to it in double precision first.

mod csv;
mod npy;
mod ply;
#[cfg(test)]
mod tests;
mod xyz;

use crate::fault::Fault;
use crate::formats::PointsFormat;
use crate::outcome::excerpt;
use crate::outcome::{Failure, Outcome};
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
    /// Where the file has what is the origin here.
    pub origin: [f64; 3],
    /// Rows left out because they are not finite.
    pub skipped: usize,
    /// Records that came before, of a file that has several; only the last is kept.
    pub earlier: usize,
    /// The columns that were taken as x, y and z, from 1 on, where no head names them.
    pub columns: Vec<usize>,
}

/// Rows as they are read, before they are rounded.
#[derive(Debug, Default)]
struct Rows {
    rows: Vec<[f64; 3]>,
    skipped: usize,
    earlier: usize,
    columns: Vec<usize>,
}

impl Rows {
    /// Takes a row in, or counts it as skipped.
    fn push(&mut self, row: [f64; 3]) -> Result<(), String> {
        if !row.iter().all(|x| (*x as f32).is_finite()) {
            self.skipped += 1;
        } else if self.rows.len() < MOST {
            self.rows.push(row);
        } else {
            return Err(format!("more than {MOST} points: expected fewer; thin them out"));
        }
        Ok(())
    }

    /// Forgets the rows, for another record begins.
    fn restart(&mut self) {
        self.rows.clear();
        self.skipped = 0;
        self.earlier += 1;
    }

    /// Rounds them to single precision, after a move to where it is fine enough.
    fn settle(self) -> Cloud {
        let origin = [0, 1, 2].map(|axis| origin(self.rows.iter().map(|row| row[axis])));
        let [a, b, c] = origin;
        let points = self.rows.iter().map(|[x, y, z]| Vec3::new((x - a) as f32, (y - b) as f32, (z - c) as f32));
        Cloud { points: points.collect(), origin, skipped: self.skipped, earlier: self.earlier, columns: self.columns }
    }
}

/// A round number in the middle of coordinates that are so far from zero that rounding them as they are would lose three
/// binary digits or more; zero for others, and for those that are not rounded at all.
fn origin(coordinates: impl Iterator<Item = f64> + Clone) -> f64 {
    let bounds = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = coordinates.clone().fold(bounds, |(low, high), x| (low.min(x), high.max(x)));
    let (extent, farthest) = (high - low, high.abs().max(low.abs()));
    let is_far = extent > 0.0 && farthest > 4.0 * extent;
    if !is_far || coordinates.clone().all(|x| f64::from(x as f32) == x) {
        return 0.0;
    }
    // Powers with a positive exponent are whole numbers, so that the result has few decimals.
    let digits = extent.log10().floor().clamp(-300.0, 300.0) as i32;
    let (middle, power) = (low + extent / 2.0, 10f64.powi(digits.abs()));
    if digits < 0 { (middle * power).round() / power } else { (middle / power).round() * power }
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
    let length = file.metadata().map_or(0, |facts| facts.len());
    if format == PointsFormat::Ply {
        ply::check_size(length).map_err(|fault| fault.of(path.display()))?;
    }
    let cloud = read(BufReader::with_capacity(1 << 18, file), format).map_err(|fault| fault.of(path.display()))?;
    if cloud.points.len() < 2 {
        let found = if cloud.points.is_empty() { "no finite point" } else { "one finite point" };
        let skipped = if cloud.skipped > 0 { format!(" and {} that are not", cloud.skipped) } else { String::new() };
        return Err(Failure::new(format!("{}: has {found}{skipped}: expected two or more", path.display())));
    }
    Ok(cloud)
}

fn read(mut file: impl BufRead, format: PointsFormat) -> Result<Cloud, Fault> {
    if file.fill_buf()?.is_empty() {
        return Err(Fault::new("is empty: expected points"));
    }
    let rows = match format {
        PointsFormat::Csv => csv::read(file),
        PointsFormat::Ply => ply::read(file),
        PointsFormat::Xyz => xyz::read(file),
        PointsFormat::Npy => npy::read(file),
    };
    rows.map(Rows::settle)
}

/// A number as tables spell it: `nan` and `inf` are numbers, and so is what an `f32` cannot hold.
fn number(word: &[u8]) -> Option<f64> {
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

    /// The next line, however short, and its number.
    fn next(&mut self) -> Result<Option<(u64, &[u8])>, Fault> {
        self.line.clear();
        let read = (&mut self.from).take(LONGEST).read_until(b'\n', &mut self.line)?;
        self.number += 1;
        if read as u64 == LONGEST {
            return Err(Fault::at(self.number, "expected a line of less than 1 MiB"));
        }
        let line = self.line.strip_prefix(b"\xef\xbb\xbf").filter(|_| self.number == 1).unwrap_or(&self.line);
        let line = line.trim_ascii();
        if self.number == 1 {
            is_text(line).map_err(|message| Fault::at(1, message))?;
        }
        Ok((read > 0).then_some((self.number, line)))
    }

    /// The line that was read last, as it may be shown.
    fn shown(&self) -> String {
        excerpt(&String::from_utf8_lossy(&self.line))
    }
}

/// Whether the first line of a file looks like one of text with line ends as they are known here.
fn is_text(line: &[u8]) -> Result<(), &'static str> {
    match line {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Err("is UTF-16: expected UTF-8; save it anew as that"),
        _ if line.contains(&0) => Err("is no text: expected a table of numbers"),
        _ if line.contains(&b'\r') => Err("lines end with \\r alone: expected \\n or \\r\\n; save it anew with these"),
        _ => Ok(()),
    }
}
