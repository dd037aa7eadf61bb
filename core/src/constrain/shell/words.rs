//! Words of memory taken for structs.

/// As many whole structs as there are in so many words.
pub(super) fn structs<S: bytemuck::Pod>(words: &mut [u32]) -> &mut [S] {
    let size = size_of::<S>() / 4;
    let count = words.len() / size;
    bytemuck::cast_slice_mut(&mut words[..count * size])
}
