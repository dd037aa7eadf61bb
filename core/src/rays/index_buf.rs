//! An index on the heap.

use super::{Index, Pieces, Structure};
use alloc::vec::Vec;

/// An [`Index`] that owns its words.
///
/// ```
/// use pointmass::rays::{IndexBuf, Solids, Structure};
/// use pointmass::shape::{Segment, Sphere};
/// use pointmass::Vec3;
///
/// let row: Vec<Sphere> = (0..100).map(|i| Sphere { center: Vec3::X * i as f32, radius: 0.25 }).collect();
/// let index = IndexBuf::new(Structure::Kd, &Solids(&row));
/// let along = Segment::new(Vec3::X * 50.5, Vec3::X * 51.5);
/// assert_eq!(index.view().first_hit(&Solids(&row), &along).map(|hit| hit.time), Some(0.25));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IndexBuf(Vec<u32>);

impl IndexBuf {
    /// Sorts pieces as a structure does, in n log n time; [`Index::BRUTE`] of more than can be numbered, 2³⁰.
    #[must_use]
    pub fn new<P: Pieces + ?Sized>(structure: Structure, pieces: &P) -> Self {
        let mut words = alloc::vec![0; structure.words(pieces.count())];
        let used = structure.build(pieces, &mut words).map_or(0, |index| index.words().len());
        words.truncate(used);
        words.shrink_to_fit();
        Self(words)
    }

    /// The same, borrowed.
    #[must_use]
    pub fn view(&self) -> Index<'_> {
        Index::trusted(&self.0)
    }
}
