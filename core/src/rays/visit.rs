//! A walk to the pieces in whatever boxes somebody enters: several rays at once, a cone, what a camera sees.

use super::{Cost, Pieces};
use crate::shape::Aabb;
use core::ops::ControlFlow;
use glam::Vec3;

/// Eight boxes side by side: for each axis their lower and their upper planes \[m\].
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Aabb8 {
    /// The least coordinates, an array for each axis.
    pub min: [[f32; 8]; 3],
    /// The greatest.
    pub max: [[f32; 8]; 3],
}

impl Aabb8 {
    /// Boxes that nothing is in.
    pub const EMPTY: Self = Self { min: [[f32::INFINITY; 8]; 3], max: [[f32::NEG_INFINITY; 8]; 3] };

    /// One of the boxes.
    ///
    /// # Panics
    /// If there is no such lane.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, lane: usize) -> Aabb {
        let corner = |planes: &[[f32; 8]; 3]| Vec3::from(planes.each_ref().map(|planes| planes[lane]));
        Aabb { min: corner(&self.min), max: corner(&self.max) }
    }

    /// Sets one of the boxes.
    pub(super) fn set(&mut self, lane: usize, bounds: &Aabb) {
        for axis in 0..3 {
            self.min[axis][lane] = bounds.min[axis];
            self.max[axis][lane] = bounds.max[axis];
        }
    }
}

/// Whoever goes through a structure, see [`Index::visit`](super::Index::visit).
///
/// ```
/// use core::ops::ControlFlow;
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
///     fn visit(&mut self, _: usize) -> ControlFlow<()> {
///         self.1 += 1;
///         ControlFlow::Continue(())
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

    /// Tells in which of eight boxes it has business, by bits from the lowest on; what it says of lanes without a box does not matter.
    /// As many calls of [`enters`](Self::enters), where it says nothing else.
    #[inline(always)]
    fn enters_which(&mut self, boxes: &Aabb8) -> u32 {
        (0..8).fold(0, |which, lane| which | (u32::from(self.enters(&boxes.get(lane))) << lane))
    }

    /// It has come to a piece, and may have less business from then on; none at all where it breaks off. Boxes that it entered before are
    /// not asked about again.
    fn visit(&mut self, piece: usize) -> ControlFlow<()>;
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
    pub(super) fn ask(&mut self, piece: usize) -> ControlFlow<()> {
        let bounds = self.pieces.box_of(piece);
        if bounds.min.is_finite() && bounds.max.is_finite() && self.visitor.enters(&bounds) {
            return self.meet(piece);
        }
        ControlFlow::Continue(())
    }

    /// Comes to a piece whose own box is entered.
    #[inline(always)]
    pub(super) fn meet(&mut self, piece: usize) -> ControlFlow<()> {
        self.cost.tests += 1;
        self.visitor.visit(piece)
    }
}
