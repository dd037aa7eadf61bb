//! Which index a scene's forces find their neighbours by.

use super::{Grid, Kd, SpatialIndex, Structure};
use glam::Vec3;

/// Makes an index of a step's particles in memory of the system.
///
/// `()` makes none, and forces look at all pairs; a [`Structure`] is chosen by name; [`InGrid`] and [`InKd`] by type, so that
/// firmware carries no other.
///
/// ```
/// use pointmass::index::{Hash, IndexChoice, SpatialIndex, Structure};
/// use pointmass::Vec3;
///
/// /// Hashed cells for many points, all pairs for a few.
/// struct ForMany;
///
/// impl IndexChoice for ForMany {
///     fn columns(&self) -> usize {
///         Structure::Hash.words(1000).div_ceil(3000)
///     }
///     fn with_index(
///         &self,
///         memory: &mut [u32],
///         points: &[Vec3],
///         reach: f32,
///         then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
///     ) {
///         let mut hash = Hash::new(memory);
///         let built = points.len() > 100 && hash.build(points, reach).is_ok();
///         then(if built { Some(&hash) } else { None });
///     }
/// }
///
/// let (points, mut memory) = ([Vec3::ZERO; 200], [0; 9000]);
/// ForMany.with_index(&mut memory, &points, 0.1, &mut |index| {
///     assert_eq!(index.map(|index| index.count(Vec3::ZERO, 0.1).found), Some(200));
/// });
/// ```
pub trait IndexChoice: Sync {
    /// Vectors of memory that it takes for each particle. With few particles they may not do: then there is no index.
    fn columns(&self) -> usize;

    /// Calls `then` with the points in an index, or with none if it has no room for them.
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    );
}

/// Vectors a point that so many words for a thousand points take.
const fn columns(words_for_1000: usize) -> usize {
    words_for_1000.div_ceil(3000)
}

impl IndexChoice for () {
    fn columns(&self) -> usize {
        0
    }
    fn with_index(&self, _: &mut [u32], _: &[Vec3], _: f32, then: &mut dyn FnMut(Option<&dyn SpatialIndex>)) {
        then(None);
    }
}

impl IndexChoice for Structure {
    fn columns(&self) -> usize {
        columns(self.words(1000))
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        let mut index = self.index(memory);
        let built = index.build(points, reach).is_ok();
        then(built.then_some(&index));
    }
}

macro_rules! by_type {
    ($($(#[$doc:meta])* $name:ident = $index:ident;)+) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl IndexChoice for $name {
            fn columns(&self) -> usize {
                const { columns(Structure::$index.words(1000)) }
            }
            fn with_index(&self, memory: &mut [u32], points: &[Vec3], reach: f32, then: &mut dyn FnMut(Option<&dyn SpatialIndex>)) {
                let mut index = $index::new(memory);
                let built = index.build(points, reach).is_ok();
                then(built.then_some(&index));
            }
        }
    )+};
}
by_type! {
    /// A grid: for particles that are spread evenly.
    InGrid = Grid;
    /// A kd-tree: for particles that cluster.
    InKd = Kd;
}
