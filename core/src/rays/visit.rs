//! A walk to the pieces in whatever boxes somebody enters: several rays at once, a cone, what a camera sees.

use super::{Cost, Pieces};
use crate::shape::Aabb;

/// Whoever goes through a structure, see [`Index::visit`](super::Index::visit).
///
/// ```
/// use pointmass::rays::{Solids, Structure, Visitor};
/// use pointmass::shape::{Aabb, Sphere};
/// use pointmass::Vec3;
///
/// /// Counts what is at least partly above a height.
/// struct Above(f32, usize);
///
/// impl Visitor for Above {
///     fn enters(&mut self, bounds: &Aabb) -> bool {
///         bounds.max.y > self.0
///     }
///     fn visit(&mut self, _: usize) {
///         self.1 += 1;
///     }
/// }
///
/// let stack: [Sphere; 10] = core::array::from_fn(|i| Sphere { center: Vec3::Y * i as f32, radius: 0.5 });
/// let mut memory = [0; Structure::Bvh.words(10)];
/// let index = Structure::Bvh.build(&Solids(&stack), &mut memory)?;
/// let mut above = Above(6.6, 0);
/// index.visit(&Solids(&stack), &mut above);
/// assert_eq!(above.1, 3);
/// # Ok::<(), pointmass::rays::TooSmall>(())
/// ```
pub trait Visitor {
    /// Tells whether it has business in a box: that of a piece, of a part of a piece, or one around several. It has wherever the box shares
    /// a point with what it looks for, and may have elsewhere.
    fn enters(&mut self, bounds: &Aabb) -> bool;

    /// It has come to a piece, and may have less business from then on.
    fn visit(&mut self, piece: usize);
}

/// A walk.
pub(super) struct Visit<'v, P: ?Sized, V> {
    pub(super) pieces: &'v P,
    pub(super) visitor: &'v mut V,
    pub(super) cost: Cost,
}

impl<P: Pieces + ?Sized, V: Visitor> Visit<'_, P, V> {
    /// Comes to a piece, if its own box is entered. Nobody enters one that is not finite.
    #[inline(always)]
    pub(super) fn ask(&mut self, piece: usize) {
        let bounds = self.pieces.box_of(piece);
        if bounds.min.is_finite() && bounds.max.is_finite() && self.visitor.enters(&bounds) {
            self.meet(piece);
        }
    }

    /// Comes to a piece whose own box is entered.
    #[inline(always)]
    pub(super) fn meet(&mut self, piece: usize) {
        self.cost.tests += 1;
        self.visitor.visit(piece);
    }
}
