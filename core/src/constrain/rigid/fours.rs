//! Words of eight things side by side, read and written in fours.

use crate::lanes::{Eight, LANES};
use bytemuck::Pod;

/// Four words of a thing, as numbers.
#[inline(always)]
fn four<T: Pod>(of: &T, first: usize) -> [f32; 4] {
    let words: &[f32] = bytemuck::cast_slice(core::slice::from_ref(of));
    words.get(first..).and_then(|words| words.first_chunk()).copied().unwrap_or([0.0; 4])
}

/// Writes four words of a thing.
#[inline(always)]
pub(super) fn put<T: Pod>(to: &mut T, first: usize, four: [f32; 4]) {
    let words: &mut [f32] = bytemuck::cast_slice_mut(core::slice::from_mut(to));
    if let Some(words) = words.get_mut(first..).and_then(|words| words.first_chunk_mut()) {
        *words = four;
    }
}

/// Four words of each, from a place on.
#[inline(always)]
pub(super) fn fours<F: Eight, T: Pod>(like: F, all: &[&T; LANES], first: usize) -> [F; 4] {
    let mut rows = [[0.0; 4]; LANES];
    for (row, &of) in rows.iter_mut().zip(all) {
        *row = four(of, first);
    }
    like.quads_of(rows)
}
