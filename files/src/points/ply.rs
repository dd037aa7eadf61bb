//! PLY point clouds and meshes, text and binary of both byte orders: the vertices are the points.

use super::{Fault, Rows};
use crate::meshes::MAX_BYTES;
use crate::meshes::ply::{Point, Skipped, split};
use std::io::{BufRead, Read};

/// Refuses what is larger than any file that is read whole.
pub(super) fn check_size(bytes: u64) -> Result<(), Fault> {
    let limit = MAX_BYTES >> 20;
    match bytes > MAX_BYTES {
        true => {
            Err(Fault::new(format!("is larger than {limit} MiB, the most that is read of this format; thin it out")))
        }
        false => Ok(()),
    }
}

pub(super) fn read(mut file: impl BufRead) -> Result<Rows, Fault> {
    // The library that reads the elements wants to see where they end.
    let mut bytes = Vec::new();
    file.by_ref().take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    check_size(bytes.len() as u64)?;
    let (header, mut payload) = split(&bytes)?;
    let has = |axis: &str| header.elements.get("vertex").is_some_and(|vertex| vertex.properties.contains_key(axis));
    if !has("x") || !has("y") {
        return Err(Fault::new("header: expected an element `vertex` with properties x, y and z"));
    }
    let mut rows = Rows::default();
    for element in header.elements.values() {
        for number in 1..=element.count {
            // Nothing is stored for an element without properties, so it would be read forever.
            if element.properties.is_empty() {
                break;
            }
            if element.name == "vertex" {
                let Point(row) = payload.next(element, number)?;
                rows.push(row).map_err(Fault::new)?;
            } else {
                let Skipped = payload.next(element, number)?;
            }
        }
        if element.name == "vertex" {
            break;
        }
    }
    Ok(rows)
}
