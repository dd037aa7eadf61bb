//! XYZ: atoms, records one behind the other, each after its number of atoms; or bare lines of two or three numbers.

use super::{Fault, Lines, Rows, number};
use std::io::BufRead;

pub(super) fn read(file: impl BufRead) -> Result<Rows, Fault> {
    let (mut lines, mut rows, mut shape) = (Lines::new(file), Rows::default(), None);
    while let Some((_, line)) = lines.next()? {
        if line.is_empty() || line[0] == b'#' {
            continue;
        }
        if let Some(atoms) = count(line).filter(|_| shape.is_none()) {
            records(&mut lines, &mut rows, atoms)?;
            break;
        }
        // As many columns as the first line has, or a word lost from any would be taken for another kind of line.
        let row = bare(line).filter(|(_, found)| *shape.get_or_insert(*found) == *found).map(|(row, _)| row);
        push(&mut rows, row, &lines)?;
    }
    Ok(rows)
}

fn push<R: BufRead>(rows: &mut Rows, row: Option<[f64; 3]>, lines: &Lines<R>) -> Result<(), Fault> {
    let told = match row {
        Some(row) => rows.push(row),
        None => Err(format!("`{}`: expected the numbers x y z", lines.shown())),
    };
    told.map_err(|message| Fault::at(lines.number, message))
}

/// All records; the last is kept.
fn records(lines: &mut Lines<impl BufRead>, rows: &mut Rows, mut atoms: u64) -> Result<(), Fault> {
    loop {
        let before = lines.next()?.map(|(_, line)| place_column(line));
        let before = before.ok_or_else(|| Fault::at(lines.number, "the file ends here: expected a comment"))?;
        for atom in 1..=atoms {
            let Some((_, line)) = lines.next()? else {
                let message = format!("the file ends here: expected atom {atom} of {atoms}; is it cut short?");
                return Err(Fault::at(lines.number, message));
            };
            let row = coordinates(words(line).skip(before));
            push(rows, row, lines)?;
        }
        let next = loop {
            match lines.next()? {
                None => return Ok(()),
                Some((_, [])) => {}
                Some((_, line)) => break count(line),
            }
        };
        let Some(next) = next else {
            let message = format!("`{}`: expected the number of atoms of another record", lines.shown());
            return Err(Fault::at(lines.number, message));
        };
        atoms = next;
        rows.restart();
    }
}

/// A line that is a whole number and nothing else.
fn count(line: &[u8]) -> Option<u64> {
    std::str::from_utf8(line).ok()?.parse().ok()
}

/// How many words come before the position: as `Properties=species:S:1:pos:R:3` says, else the species.
fn place_column(comment: &[u8]) -> usize {
    let comment = String::from_utf8_lossy(comment);
    let told = comment.split_whitespace().find_map(|word| word.strip_prefix("Properties="));
    let mut before = 0usize;
    let fields: Vec<&str> = told.unwrap_or_default().trim_matches('"').split(':').collect();
    for field in fields.chunks_exact(3) {
        if field[0] == "pos" {
            return before;
        }
        before = before.saturating_add(field[2].parse().unwrap_or(1));
    }
    1
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|byte| byte.is_ascii_whitespace() || *byte == b',').filter(|word| !word.is_empty())
}

/// The words of a bare line: a species before the numbers, and but two of these.
#[derive(Clone, Copy, PartialEq)]
struct Shape {
    has_species: bool,
    is_planar: bool,
}

fn bare(line: &[u8]) -> Option<([f64; 3], Shape)> {
    let has_species = words(line).next().is_some_and(|word| number(word).is_none());
    let rest = || words(line).skip(usize::from(has_species));
    let is_planar = rest().nth(2).is_none();
    let row = if is_planar { coordinates(rest().chain([&b"0"[..]])) } else { coordinates(rest()) };
    Some((row?, Shape { has_species, is_planar }))
}

fn coordinates<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<[f64; 3]> {
    let mut next = || number(words.next()?);
    Some([next()?, next()?, next()?])
}
