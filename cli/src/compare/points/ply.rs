//! PLY point clouds and meshes, text and binary of both byte orders: the vertices are the points.

use super::{Cloud, Fault};
use crate::meshes::ply::{Point, Skipped, split};
use std::io::BufRead;

pub(super) fn read(mut file: impl BufRead) -> Result<Cloud, Fault> {
    // The library that reads the elements wants to see where they end.
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let (header, mut payload) = split(&bytes)?;
    let has = |axis: &str| header.elements.get("vertex").is_some_and(|vertex| vertex.properties.contains_key(axis));
    if !has("x") || !has("y") {
        return Err(Fault::new("header: expected an element `vertex` with properties x, y and z"));
    }
    let mut cloud = Cloud::default();
    for element in header.elements.values() {
        for number in 1..=element.count {
            // Nothing is stored for an element without properties, so it would be read forever.
            if element.properties.is_empty() {
                break;
            }
            if element.name == "vertex" {
                let Point(point) = payload.next(element, number)?;
                cloud.push(point).map_err(Fault::new)?;
            } else {
                let Skipped = payload.next(element, number)?;
            }
        }
        if element.name == "vertex" {
            break;
        }
    }
    Ok(cloud)
}

impl From<crate::meshes::error::Fault> for Fault {
    fn from(fault: crate::meshes::error::Fault) -> Self {
        let (line, message) = fault.parts();
        Self { row: line.map(|line| line as u64), message }
    }
}
