//! How a step finds neighbours: in lists if they last, else in an index, else by looking at all pairs.

use super::lists::ListMemory;
use super::neighbours::Neighbours;
use super::{Arrange, SpatialIndex};
use crate::force::Finding;
use glam::Vec3;

/// How neighbours have been found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// In lists made before.
    Kept,
    /// In lists made for it.
    Listed,
    /// In an index.
    Streamed,
    /// By looking at all pairs.
    AllPairs,
}

/// Finds neighbours: a function, so that a program with no force that names it does not carry it about.
#[derive(Clone, Copy)]
pub struct Listing(pub(crate) Finding);

/// What is done with neighbours.
pub(crate) type Then<'a> = &'a mut dyn FnMut(Neighbours<'_>, Found);

impl Listing {
    /// Lists that last until somebody has gone half their skin, where there is memory for them.
    pub const KEPT: Self = Self(|field, state, then| field.with_neighbours(state, then));
}

impl core::fmt::Debug for Listing {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Listing")
    }
}

/// Calls `then` with the neighbours of points, in lists if they last and there is room for them.
#[inline(never)]
pub(crate) fn list(
    index: &dyn Arrange,
    memory: &mut [u32],
    mut lists: ListMemory<'_>,
    [points, velocity]: [&[Vec3]; 2],
    reach: f32,
    then: Then<'_>,
) {
    if cfg!(target_os = "none") {
        // A chip's indices do not answer in order.
        return stream(index, memory, points, reach, then);
    }
    if let Some(lists) = lists.kept(points, reach) {
        return then(Neighbours::listed(lists, points), Found::Kept);
    }
    let Some(skin) = lists.skin(points, velocity, reach) else {
        return stream(index, memory, points, reach, then);
    };
    index.arrange(memory, points, reach + skin, &mut |index| {
        let made = index.and_then(|index| lists.make(index, points, [reach, skin]));
        match made {
            Some(lists) => then(Neighbours::listed(lists, points), Found::Listed),
            None => then(Neighbours::by(index, points), how(index)),
        }
    });
}

/// Calls `then` with the neighbours of points by an index that is made for it.
pub(crate) fn stream(index: &dyn Arrange, memory: &mut [u32], points: &[Vec3], reach: f32, then: Then<'_>) {
    index.arrange(memory, points, reach, &mut |index| then(Neighbours::by(index, points), how(index)));
}

fn how(index: Option<&dyn SpatialIndex>) -> Found {
    if index.is_some() { Found::Streamed } else { Found::AllPairs }
}
