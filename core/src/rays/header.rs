//! The first words of an index: what it is, and how to tell whether it is sound.

use super::{Pieces, Stats, Structure};
use crate::shape::Aabb;

/// Words of it. All that follows comes in units of eight words.
pub(super) const HEADER: usize = 16;
pub(super) const UNIT: usize = 8;

/// "ray1", the version of the layout.
const MAGIC: u32 = 0x7261_7931;

/// The description of an index; all numbers are words, so that it can lie in flash.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Header {
    magic: u32,
    structure: u32,
    /// Words in all.
    pub(super) words: u32,
    pub(super) pieces: u32,
    pub(super) skipped: u32,
    pub(super) references: u32,
    pub(super) nodes: u32,
    pub(super) depth: u32,
    pub(super) fullest: u32,
    pub(super) crowded: u32,
    /// The hash of the pieces' boxes.
    pub(super) boxes: u32,
    /// The hash of all words but this one.
    pub(super) sum: u32,
    spare: [u32; 4],
}

impl Header {
    pub(super) fn new(structure: Structure) -> Self {
        Self { magic: MAGIC, structure: structure as u32, words: HEADER as u32, ..Self::default() }
    }

    /// The header at the beginning of these words, if there are enough for one.
    pub(super) fn of(words: &[u32]) -> Option<&Self> {
        words.first_chunk::<HEADER>().map(bytemuck::cast_ref)
    }

    pub(super) fn structure(&self) -> Option<Structure> {
        let found = Structure::ALL.get(self.structure as usize).copied();
        found.filter(|_| self.magic == MAGIC)
    }

    /// Writes it before the words it belongs to, with its sum; returns all of them.
    pub(super) fn write(mut self, words: &mut [u32]) -> &[u32] {
        let used = (self.words as usize).min(words.len());
        let words = &mut words[..used];
        if let Some((head, rest)) = words.split_first_chunk_mut::<HEADER>() {
            self.sum = sum(&self, rest);
            *head = bytemuck::cast(self);
        }
        words
    }

    /// Tells whether all words are those that were written.
    pub(super) fn is_whole(&self, words: &[u32]) -> bool {
        self.words as usize == words.len() && words.get(HEADER..).is_some_and(|rest| sum(self, rest) == self.sum)
    }

    pub(super) fn stats(&self) -> Stats {
        let [pieces, skipped, references, nodes, depth, fullest, crowded] =
            [self.pieces, self.skipped, self.references, self.nodes, self.depth, self.fullest, self.crowded]
                .map(|n| n as usize);
        Stats { pieces, skipped, references, nodes, depth, fullest, crowded, bytes: 4 * self.words as usize }
    }
}

/// The hash of Fowler, Noll and Vo over words instead of bytes.
#[inline(always)]
fn mix(hash: u32, word: u32) -> u32 {
    (hash ^ word).wrapping_mul(0x0100_0193)
}

const START: u32 = 0x811C_9DC5;

/// The hash of a header without its sum, and of the words that follow: eight hashes side by side, then one of those.
fn sum(header: &Header, rest: &[u32]) -> u32 {
    let head: [u32; HEADER] = bytemuck::cast(Header { sum: 0, ..*header });
    let mut lanes = [START; UNIT];
    for chunk in rest.as_chunks::<UNIT>().0 {
        for (lane, word) in lanes.iter_mut().zip(chunk) {
            *lane = mix(*lane, *word);
        }
    }
    head.into_iter().chain(lanes).fold(START, mix)
}

/// The hash of boxes, taken one after the other.
#[derive(Clone, Copy)]
pub(super) struct Boxes([u32; 6]);

impl Boxes {
    pub(super) const NONE: Self = Self([START; 6]);

    pub(super) fn add(&mut self, bounds: &Aabb) {
        let planes = [bounds.min.x, bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z];
        for (lane, plane) in self.0.iter_mut().zip(planes) {
            *lane = mix(*lane, plane.to_bits());
        }
    }

    pub(super) fn hash(self) -> u32 {
        self.0.into_iter().fold(START, mix)
    }

    pub(super) fn of<P: Pieces + ?Sized>(pieces: &P) -> u32 {
        let mut boxes = Self::NONE;
        (0..pieces.count()).for_each(|piece| boxes.add(&pieces.box_of(piece)));
        boxes.hash()
    }
}
