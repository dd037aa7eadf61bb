//! Arrays as NumPy saves them: N x 3 or N x 2, single or double precision, in either order.
//!
//! The format is that of NEP 1: a magic word, a version, the length of a head, and the head, a Python dictionary of which
//! three entries matter. The crates that read it multiply the sides of the array unchecked and bring a parser of all
//! Python literals with them.

use super::{Fault, MOST, Rows};
use crate::outcome::excerpt;
use std::io::{BufRead, ErrorKind};

const MAGIC: &[u8] = b"\x93NUMPY";
/// The longest head, in bytes; NumPy itself warns beyond 10000.
const LONGEST: usize = 1 << 16;
/// Rows that are read at a time.
const CHUNK: usize = 4096;

pub(super) fn read(mut file: impl BufRead) -> Result<Rows, Fault> {
    let head = Head::read(&mut file)?;
    let mut rows = Rows::default();
    if !head.by_columns {
        head.numbers(&mut file, head.columns, &mut |numbers| {
            let mut numbers = numbers.chunks_exact(head.columns);
            numbers.try_for_each(|row| rows.push([row[0], row[1], row.get(2).copied().unwrap_or(0.0)]))
        })?;
        return Ok(rows);
    }
    // All x come first, then all y, then all z.
    let mut all: Vec<[f64; 3]> = Vec::new();
    for axis in 0..head.columns {
        let mut row = 0;
        head.numbers(&mut file, 1, &mut |numbers| {
            if axis == 0 {
                all.extend(numbers.iter().map(|x| [*x, 0.0, 0.0]));
            } else {
                all[row..].iter_mut().zip(numbers).for_each(|(to, x)| to[axis] = *x);
            }
            row += numbers.len();
            if all.len() > MOST {
                Err(format!("more than {MOST} points: expected fewer; thin them out"))
            } else {
                Ok(())
            }
        })?;
    }
    all.into_iter().try_for_each(|row| rows.push(row)).map_err(Fault::new)?;
    Ok(rows)
}

/// The form of the array.
#[derive(Debug, PartialEq)]
struct Head {
    big_endian: bool,
    /// Bytes of a number: 4 or 8.
    size: usize,
    by_columns: bool,
    rows: u64,
    columns: usize,
}

impl Head {
    fn read(file: &mut impl BufRead) -> Result<Self, Fault> {
        let cut = |_| Fault::new("the head ends early: is it cut short?");
        let mut start = [0; 8];
        file.read_exact(&mut start).map_err(cut)?;
        if !start.starts_with(MAGIC) {
            return Err(Fault::new("expected an array as numpy.save writes it: it does not begin with \\x93NUMPY"));
        }
        let mut length = [0; 4];
        let wide = if start[6] == 1 { 2 } else { 4 };
        file.read_exact(&mut length[..wide]).map_err(cut)?;
        let length = u32::from_le_bytes(length) as usize;
        if length > LONGEST {
            return Err(Fault::new(format!("has a head of {length} bytes: expected {LONGEST} at most")));
        }
        let mut head = vec![0; length];
        file.read_exact(&mut head).map_err(cut)?;
        Self::parse(&String::from_utf8_lossy(&head)).map_err(|message| Fault::new(format!("head: {message}")))
    }

    /// `{'descr': '<f8', 'fortran_order': False, 'shape': (100, 3), }`
    fn parse(head: &str) -> Result<Self, String> {
        let entry = |key: &str| {
            let (_, rest) = head.split_once(&format!("'{key}'"))?;
            rest.trim_start().strip_prefix(':').map(str::trim_start)
        };
        let missing = |key: &str| format!("`{}`: expected an entry '{key}'", excerpt(head));
        let kind = entry("descr").ok_or_else(|| missing("descr"))?;
        let (big_endian, size) = match kind.get(..5).unwrap_or_default() {
            "'<f4'" | "'=f4'" => (false, 4),
            "'<f8'" | "'=f8'" => (false, 8),
            "'>f4'" => (true, 4),
            "'>f8'" => (true, 8),
            _ => {
                let kind = kind.split(", '").next().unwrap_or_default();
                return Err(format!("type {}: expected float32 or float64; see numpy's astype", excerpt(kind)));
            }
        };
        let by_columns = entry("fortran_order").ok_or_else(|| missing("fortran_order"))?.starts_with("True");
        let shape =
            entry("shape").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).ok_or_else(|| missing("shape"))?.0;
        let sides: Option<Vec<u64>> =
            shape.split(',').map(str::trim).filter(|side| !side.is_empty()).map(|side| side.parse().ok()).collect();
        match sides.as_deref() {
            Some(&[rows, columns @ (2 | 3)]) => {
                Ok(Self { big_endian, size, by_columns, rows, columns: columns as usize })
            }
            _ => Err(format!("shape ({}): expected (N, 3) or (N, 2)", excerpt(shape))),
        }
    }

    /// Reads `width` numbers of every row and visits them in chunks.
    fn numbers(
        &self,
        file: &mut impl BufRead,
        width: usize,
        visit: &mut dyn FnMut(&[f64]) -> Result<(), String>,
    ) -> Result<(), Fault> {
        let rows = self.rows;
        let mut bytes = vec![0; CHUNK * width * self.size];
        let mut numbers = Vec::with_capacity(CHUNK * width);
        let mut row = 0;
        while row < rows {
            let some = (rows - row).min(CHUNK as u64) as usize;
            let bytes = &mut bytes[..some * width * self.size];
            file.read_exact(bytes).map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => {
                    let last = row + some as u64;
                    Fault::new(format!("the file ends before row {last} of {rows}: is it cut short?"))
                }
                _ => error.into(),
            })?;
            numbers.clear();
            numbers.extend(bytes.chunks_exact(self.size).map(|number| self.number(number)));
            visit(&numbers).map_err(Fault::new)?;
            row += some as u64;
        }
        Ok(())
    }

    fn number(&self, bytes: &[u8]) -> f64 {
        // Little-endian from here on.
        let mut little = [0; 8];
        for (i, to) in little[..self.size].iter_mut().enumerate() {
            *to = bytes[if self.big_endian { self.size - 1 - i } else { i }];
        }
        match self.size {
            4 => f64::from(f32::from_bits(u64::from_le_bytes(little) as u32)),
            _ => f64::from_le_bytes(little),
        }
    }
}
