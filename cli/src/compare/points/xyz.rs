//! XYZ: atoms, records one behind the other, each after its number of atoms; or bare lines of two or three numbers.

use super::{Cloud, Fault, Lines, number};
use crate::meshes::error::excerpt;
use std::io::BufRead;

pub(super) fn read(file: impl BufRead) -> Result<Cloud, Fault> {
    let (mut lines, mut cloud) = (Lines::new(file), Cloud::default());
    let mut atoms = None;
    while let Some(line) = lines.next()? {
        if line.is_empty() || line[0] == b'#' {
            continue;
        }
        atoms = count(line);
        if atoms.is_none() {
            let (point, row) = (bare(line), lines.number);
            push(&mut cloud, point, line_of(&lines), row)?;
        }
        break;
    }
    match atoms {
        Some(atoms) => records(&mut lines, &mut cloud, atoms)?,
        None => {
            while let Some(line) = lines.next()? {
                if !line.is_empty() && line[0] != b'#' {
                    let point = bare(line);
                    push(&mut cloud, point, line_of(&lines), lines.number)?;
                }
            }
        }
    }
    Ok(cloud)
}

fn line_of<R>(lines: &Lines<R>) -> &[u8] {
    &lines.line
}

fn push(cloud: &mut Cloud, point: Option<[f32; 3]>, line: &[u8], row: u64) -> Result<(), Fault> {
    let quoted = || excerpt(&String::from_utf8_lossy(line));
    let point = point.ok_or_else(|| Fault::at(row, format!("`{}`: expected the numbers x y z", quoted())))?;
    cloud.push(point).map_err(|message| Fault::at(row, message))
}

/// All records; the last is kept.
fn records(lines: &mut Lines<impl BufRead>, cloud: &mut Cloud, first: u64) -> Result<(), Fault> {
    let mut atoms = first;
    loop {
        let before = lines.next()?.map(place_column);
        let before = before.ok_or_else(|| Fault::at(lines.number, "the file ends here: expected a comment"))?;
        for atom in 1..=atoms {
            let Some(line) = lines.next()? else {
                let message = format!("the file ends here: expected atom {atom} of {atoms}; is it cut short?");
                return Err(Fault::at(lines.number, message));
            };
            let point = coordinates(words(line).skip(before));
            push(cloud, point, line_of(lines), lines.number)?;
        }
        loop {
            let Some(line) = lines.next()? else { return Ok(()) };
            if line.is_empty() {
                continue;
            }
            let next = count(line);
            atoms = next.ok_or_else(|| {
                let line = excerpt(&String::from_utf8_lossy(&lines.line));
                Fault::at(lines.number, format!("`{line}`: expected the number of atoms of another record"))
            })?;
            cloud.restart();
            break;
        }
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

/// The point of a bare line, with or without a species before it, planar if there are but two numbers.
fn bare(line: &[u8]) -> Option<[f32; 3]> {
    let species = words(line).next().is_some_and(|word| number(word).is_none());
    let rest = || words(line).skip(usize::from(species));
    match rest().nth(2) {
        Some(_) => coordinates(rest()),
        None => coordinates(rest().chain([&b"0"[..]])),
    }
}

fn coordinates<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<[f32; 3]> {
    let mut next = || number(words.next()?);
    Some([next()?, next()?, next()?])
}
