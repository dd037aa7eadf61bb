//! A column of vectors in eight parts, one behind the other, of which a strip has a row each.

use crate::lanes::{Eight, LANES, Vectors};
use glam::Vec3;

/// The eight parts of a column, each as long as the last one, and the numbers of the whole: what of the other seven is behind that is taken from there.
pub(super) struct Parts<'p> {
    parts: [&'p [f32]; LANES],
    all: &'p [f32],
    strips: usize,
}

/// The same to be changed: the last rows of the first seven parts lie apart.
pub(super) struct PartsMut<'p> {
    parts: [&'p mut [f32]; LANES],
    ends: [&'p mut [f32]; LANES],
}

/// The numbers that each part has for sure of so many, and there have to be so many to each of seven before.
fn least(numbers: usize, part: usize) -> usize {
    numbers.saturating_sub((LANES - 1) * part)
}

impl<'p> Parts<'p> {
    /// Those of rows in so many strips.
    #[inline(always)]
    pub(super) fn of(rows: &'p [Vec3], strips: usize) -> Self {
        let all: &[f32] = bytemuck::cast_slice(rows);
        let least = least(all.len(), 3 * strips);
        let part = |lane: usize| &all[(3 * lane * strips).min(all.len() - least)..][..least];
        Self { parts: core::array::from_fn(part), all, strips }
    }

    /// The vectors of a strip; zero, where there is no row.
    #[inline(always)]
    pub(super) fn load<F: Eight>(&self, like: F, strip: usize) -> Vectors<F> {
        let (mut rows, quad) = ([[0.0; 4]; LANES], 3 * strip..3 * strip + 4);
        for (lane, row) in rows.iter_mut().enumerate() {
            // The last number of each does not count.
            match self.parts[lane].get(quad.clone()).and_then(|quad| quad.first_chunk()) {
                Some(quad) => *row = *quad,
                None => *row = self.last(3 * (lane * self.strips + strip)),
            }
        }
        Vectors(like.columns_of(rows))
    }

    /// A vector by the number that it begins with.
    #[inline(never)]
    fn last(&self, first: usize) -> [f32; 4] {
        match self.all.get(first..first + 3) {
            Some(&[x, y, z]) => [x, y, z, 0.0],
            _ => [0.0; 4],
        }
    }
}

impl<'p> PartsMut<'p> {
    #[inline(always)]
    pub(super) fn of(rows: &'p mut [Vec3], strips: usize) -> Self {
        let mut all: &mut [f32] = bytemuck::cast_slice_mut(rows);
        let least = least(all.len(), 3 * strips);
        let [mut parts, mut ends]: [[&mut [f32]; LANES]; 2] =
            core::array::from_fn(|_| core::array::from_fn(|_| &mut [][..]));
        for (part, end) in parts.iter_mut().zip(&mut ends) {
            let (one, others) = all.split_at_mut(all.len().min(3 * strips));
            (*part, *end) = one.split_at_mut(least.min(one.len()));
            all = others;
        }
        Self { parts, ends }
    }

    /// Puts vectors where the rows of a strip are, or as many as there are.
    #[inline(always)]
    pub(super) fn save<F: Eight>(&mut self, strip: usize, vectors: Vectors<F>) {
        let own = 3 * strip..3 * strip + 3;
        for (lane, [x, y, z, _]) in vectors.rows().into_iter().enumerate() {
            match self.parts[lane].get_mut(own.clone()) {
                Some(to) => to.copy_from_slice(&[x, y, z]),
                None => self.save_last(lane, 3 * strip, [x, y, z]),
            }
        }
    }

    #[inline(never)]
    fn save_last(&mut self, lane: usize, first: usize, vector: [f32; 3]) {
        let from = first - self.parts[lane].len();
        if let Some(to) = self.ends[lane].get_mut(from..from + 3) {
            to.copy_from_slice(&vector);
        }
    }
}
