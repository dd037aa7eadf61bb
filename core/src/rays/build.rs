//! How pieces are sorted into words, by any of the structures.

use super::header::{Boxes, HEADER, Header};
use super::{Index, Pieces, Structure, TooSmall, bsp, bvh, grid, grow, kd, octree};

impl Structure {
    /// Words of memory, four bytes each, that building it takes for so many pieces; `usize::MAX` where it takes more.
    /// With less, leaves and cells are larger. What is needed afterwards is less, see [`Index::words`].
    #[must_use]
    pub const fn words(self, pieces: usize) -> usize {
        match self {
            Self::Brute => HEADER,
            Self::Grid => grid::words(pieces),
            Self::Octree | Self::Kd => grow::words(pieces, 48),
            Self::Bsp | Self::Bvh => grow::words(pieces, 22),
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
            Self::Octree => grow::build(self, &octree::Eighths, pieces, memory)?,
            Self::Kd => grow::build(self, &kd::Cheapest, pieces, memory)?,
            Self::Bsp => grow::build(self, &bsp::Planes, pieces, memory)?,
            Self::Bvh => grow::build(self, &bvh::Areas, pieces, memory)?,
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
