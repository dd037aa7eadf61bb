//! The memory of bodies: what is kept of them from sub-step to sub-step, and how much they ask for.

use super::ball::Ball;
use super::body::Body;
use super::manifold::{DIRECTIONS, Manifold};
use super::moving::Moving;
use super::order::packs_of;
use super::pack::Pack;
use crate::constrain::Words;
use crate::memory::take;
use glam::Vec3;

/// Pairs of near bodies that there is room for, for each body.
const PAIRS: usize = 12;
/// Pairs of bodies whose balls are near that there is room for, for each body.
const CANDIDATES: usize = 24;
/// Pairs of pieces that there is room for besides, for each piece of a body beyond its first.
const AMONG_PIECES: usize = 12;
/// Pairs of a ball and a body that there is room for, for each ball.
const NEAR: usize = 2;

/// What forces did to bodies in the last sub-step in which all of them lay as one.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Lain {
    /// The change of their velocities \[m/s\], in so long \[s\]; zero: they did not.
    pub(super) change: Vec3,
    pub(super) h: f32,
    /// How far the method may have moved them beyond that \[m\].
    pub(super) far: f32,
}

impl Lain {
    /// Tells whether forces do the same again, to the bit.
    pub(super) fn is_so(&self, change: Vec3, h: f32) -> bool {
        self.h > 0.0
            && self.h.to_bits() == h.to_bits()
            && self.change.to_array().map(f32::to_bits) == change.to_array().map(f32::to_bits)
    }
}

/// The rest that is kept of them.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Lists {
    /// The name of whose all that is.
    pub(super) name: u32,
    /// Pairs in the list.
    pub(super) pairs: u32,
    /// 1 if there is a list.
    pub(super) known: u32,
    /// 1 if any body is awake.
    pub(super) awake: u32,
    /// The number of pairs that press on each other, and of places of the scenery on bodies; none known where the list is new.
    pub(super) presses: [u32; 2],
    pub(super) counted: u32,
    /// How all have lain as one in the last sub-step, if they have.
    pub(super) lain: Lain,
}

/// The memory of bodies in its parts.
pub(super) struct Kept<'a> {
    pub(super) lists: &'a mut Lists,
    /// The world, the scene's bodies, then the balls near them.
    pub(super) bodies: &'a mut [Body],
    pub(super) pairs: &'a mut [Manifold],
    /// So many for each body as it can be pressed in directions.
    pub(super) scenery: &'a mut [Manifold],
    /// The balls near bodies.
    pub(super) balls: &'a mut [Ball],
    /// The places of all particles, of one body after the other.
    pub(super) places: &'a mut [u32],
}

/// The numbers of bodies, of their particles, of balls that may be near them, and of pieces beyond one for each body.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    pub(super) bodies: usize,
    pub(super) particles: usize,
    pub(super) balls: usize,
    pub(super) more: usize,
}

/// Words of a thing.
pub(super) const fn words<T>() -> usize {
    size_of::<T>() / 4
}

impl Sizes {
    /// The number of pairs there is room for.
    fn pairs(&self) -> usize {
        let Self { bodies, balls, more, .. } = *self;
        let among = bodies.saturating_mul(PAIRS).min(bodies.saturating_mul(bodies.saturating_sub(1)) / 2);
        let pieces = if bodies.saturating_add(balls) > 1 { more.saturating_mul(AMONG_PIECES) } else { 0 };
        among.saturating_add(balls.saturating_mul(NEAR)).saturating_add(pieces)
    }

    /// The number of pairs that may be looked at for that.
    pub(super) fn candidates(&self) -> usize {
        self.bodies.saturating_mul(CANDIDATES).saturating_add(self.balls.saturating_mul(NEAR))
    }

    /// The words kept of them, and those to work with.
    pub(super) fn demand(&self) -> [Words; 2] {
        let each = |count: usize, words: usize| count.saturating_mul(words);
        let all = self.bodies.saturating_add(self.balls);
        let kept = words::<Lists>()
            .saturating_add(each(all.saturating_add(1), words::<Body>()))
            .saturating_add(each(self.pairs(), words::<Manifold>()))
            .saturating_add(each(all, DIRECTIONS * words::<Manifold>()))
            .saturating_add(each(self.balls, words::<Ball>()))
            .saturating_add(each(self.particles, 3));
        let listing = each(self.pairs(), words::<Manifold>())
            .saturating_add(each(self.bodies, 3))
            .saturating_add(each(self.candidates(), 2));
        let touching = self.pairs().saturating_add(each(all, DIRECTIONS));
        let solving = each(packs_of(self.pairs(), all, self.more), words::<Pack>())
            .saturating_add(touching)
            .saturating_add(each(all.saturating_add(1), words::<Moving>()));
        let scratch = listing.max(solving);
        let per_row = usize::from(self.balls > 0);
        [Words { per_row: 0, fixed: kept }, Words { per_row, fixed: scratch }]
    }
}

impl<'a> Kept<'a> {
    /// None: the memory is too small.
    pub(super) fn of(mut memory: &'a mut [u32], sizes: Sizes) -> Option<Self> {
        let all = sizes.bodies + sizes.balls;
        let lists = bytemuck::try_cast_slice_mut(take(&mut memory, words::<Lists>())).ok()?.first_mut()?;
        let bodies = bytemuck::try_cast_slice_mut(take(&mut memory, (all + 1) * words::<Body>())).ok()?;
        let pairs = bytemuck::try_cast_slice_mut(take(&mut memory, sizes.pairs() * words::<Manifold>())).ok()?;
        let scenery = take(&mut memory, all * DIRECTIONS * words::<Manifold>());
        let scenery = bytemuck::try_cast_slice_mut(scenery).ok()?;
        let balls = bytemuck::try_cast_slice_mut(take(&mut memory, sizes.balls * words::<Ball>())).ok()?;
        Some(Self { lists, bodies, pairs, scenery, balls, places: memory })
    }

    /// The number of the first ball: the scene's bodies come before.
    pub(super) fn first_ball(&self) -> usize {
        self.bodies.len() - self.balls.len()
    }
}
