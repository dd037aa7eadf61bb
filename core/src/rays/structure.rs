//! The structures by name.

use super::header::{Boxes, HEADER, Header};
use super::{Index, Pieces, TooSmall, bsp, build, bvh, grid, kd, octree};
use crate::named::by_name;

/// How pieces are organised, by its name, as files and the command line say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "RayStructure"))]
pub enum Structure {
    /// No structure: every piece is looked at.
    Brute,
    /// Cells of one size.
    Grid,
    /// Cubes cut into eighths.
    Octree,
    /// Boxes cut by planes across the axes where that pays most.
    Kd,
    /// Parts cut by planes of any orientation.
    Bsp,
    /// Boxes cut where those of both parts become small.
    Bvh,
}

impl Structure {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Brute, Self::Grid, Self::Octree, Self::Kd, Self::Bsp, Self::Bvh];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Grid => "grid",
            Self::Octree => "octree",
            Self::Kd => "kd",
            Self::Bsp => "bsp",
            Self::Bvh => "bvh",
        }
    }

    /// Words of memory, four bytes each, that building it takes for so many pieces; `usize::MAX` where it takes more.
    /// With less, leaves and cells are larger. What is needed afterwards is less, see [`Index::words`].
    #[must_use]
    pub const fn words(self, pieces: usize) -> usize {
        match self {
            Self::Brute => HEADER,
            Self::Grid => grid::words(pieces),
            Self::Octree | Self::Kd => build::words(pieces, 48),
            Self::Bsp | Self::Bvh => build::words(pieces, 22),
        }
    }

    /// Sorts pieces into memory. Takes n log n time.
    ///
    /// # Errors
    /// If there is not even room for all of them in one leaf, or there are more than 2³⁰ pieces.
    pub fn build<'m, P: Pieces + ?Sized>(self, pieces: &P, memory: &'m mut [u32]) -> Result<Index<'m>, TooSmall> {
        let words = match self {
            Self::Brute => brute(pieces, memory)?,
            Self::Grid => grid::build(pieces, memory)?,
            Self::Octree => build::build(self, &octree::Eighths, pieces, memory)?,
            Self::Kd => build::build(self, &kd::Cheapest, pieces, memory)?,
            Self::Bsp => build::build(self, &bsp::Planes, pieces, memory)?,
            Self::Bvh => build::build(self, &bvh::Areas, pieces, memory)?,
        };
        Ok(Index::trusted(words))
    }
}

/// Nothing but a header.
fn brute<'m, P: Pieces + ?Sized>(pieces: &P, memory: &'m mut [u32]) -> Result<&'m [u32], TooSmall> {
    if memory.len() < HEADER {
        return Err(TooSmall { words: memory.len(), needed: HEADER });
    }
    let mut header = Header::new(Structure::Brute);
    (header.pieces, header.references, header.fullest) =
        (pieces.count() as u32, pieces.count() as u32, pieces.count() as u32);
    let finite = |piece: &usize| {
        let bounds = pieces.box_of(*piece);
        bounds.min.is_finite() && bounds.max.is_finite()
    };
    header.skipped = (pieces.count() - (0..pieces.count()).filter(finite).count()) as u32;
    header.boxes = Boxes::of(pieces);
    Ok(header.write(memory))
}

by_name!(Structure, UnknownStructure, "structure");
