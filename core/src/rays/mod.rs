//! First hits of a path: one search, six ways to organise the pieces that stand in the way, the same answers from all.
//!
//! [`Pieces`] are things with boxes: the triangles of a mesh, the solids of a scene. A [`Structure`] sorts them once into
//! a slice of words that the caller lends; an [`Index`] reads such words, wherever they lie: on the heap, on the stack, or
//! as a constant in flash. It holds no pointers and no copy of the pieces, only their boxes and numbers.
//!
//! Every structure gives the identical [`Hit`](crate::shape::Hit) as looking at every piece: the earliest, of several at once that of the
//! piece with the lowest number. The proof has three parts. What a piece answers depends on the piece and the segment
//! alone. Its time is held within the span of time during which the segment is inside the piece's own box, widened by the
//! radius and by more than rounding can take; outside it is not asked. And a node's span is computed by the same
//! expression, `(plane − from) × inverse`, which rounding keeps in order: the span of a box that holds another holds its
//! span. So a node that is entered after the best time so far holds nothing better, to the last bit. Where a plane cuts a
//! piece's box (octree, kd-tree, grid), the spans of both parts overlap at the plane, so that every instant of the piece's
//! span is in that of a part.
//!
//! ```
//! use pointmass::rays::{Index, Structure};
//! use pointmass::shape::{Collider, Mesh, Segment};
//! use pointmass::Vec3;
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
//! let mesh = Mesh::new(&vertices, &[[0, 1, 2]], &mut [])?;
//! let mut memory = [0; Structure::Bvh.words(1)];
//! let index = Structure::Bvh.build(&mesh, &mut memory)?;
//! let down = Segment::new(Vec3::new(0.2, 0.2, 1.0), Vec3::new(0.2, 0.2, -1.0));
//! assert_eq!(index.first_hit(&mesh, &down).map(|hit| hit.time), Some(0.5));
//! // These words could be a constant of a program for a chip without a heap.
//! let again = Index::new(index.words())?;
//! assert_eq!(mesh.with_index(again)?.first_hit(&down), index.first_hit(&mesh, &down));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

mod bsp;
mod build;
mod bvh;
mod entries;
mod grid;
mod grow;
mod header;
mod index;
#[cfg(feature = "alloc")]
mod index_buf;
mod kd;
mod near;
mod nearest;
mod octree;
mod pieces;
mod probe;
mod split;
mod stats;
mod structure;
#[cfg(all(test, feature = "alloc"))]
mod tests;
mod tree;
mod visit;

pub use index::{Index, Unsound};
#[cfg(feature = "alloc")]
pub use index_buf::IndexBuf;
pub(crate) use nearest::{Closest, square_to};
pub use pieces::{Pieces, Solids};
pub(crate) use probe::{Best, Probe};
pub use stats::{Cost, Stats, TooSmall};
pub use structure::{Structure, UnknownStructure};
pub use visit::{Aabb8, Visitor};
