//! How a step finds neighbours: in lists if they last, else in an index, else by looking at all pairs.

use super::lists::ListMemory;
use super::neighbours::Neighbours;
use super::{SpatialIndex, StateIndex};
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

/// The means by which neighbours are looked up, and the distance within which they are.
pub(crate) struct Search<'a> {
    /// The index, and the memory of lists, where there is some.
    pub(crate) index: StateIndex<'a>,
    pub(crate) lists: Option<ListMemory<'a>>,
    pub(crate) reach: f32,
}

/// The work to be done with neighbours once they can be looked up.
pub(crate) type Then<'a> = &'a mut dyn FnMut(Neighbours<'_>, Found);

/// Calls `then` with the neighbours of points, in lists if they last and there is room for them.
#[inline(never)]
pub(crate) fn find(search: Search<'_>, [points, velocity]: [&[Vec3]; 2], then: Then<'_>) {
    let Search { mut index, lists, reach } = search;
    let room = index.choice().room();
    let Some(mut lists) = lists else {
        return stream(index, points, reach, then);
    };
    if cfg!(target_os = "none") {
        // A chip's indices do not answer in order.
        return stream(index, points, reach, then);
    }
    if let Some(lists) = lists.kept(points, reach) {
        return then(Neighbours::listed(lists, points).in_room(room), Found::Kept);
    }
    let Some(skin) = lists.skin(points, velocity, reach) else {
        return stream(index, points, reach, then);
    };
    index.with(points, reach + skin, &mut |index| {
        let made = index.and_then(|index| lists.make(index, points, [reach, skin]));
        match made {
            Some(lists) => then(Neighbours::listed(lists, points).in_room(room), Found::Listed),
            None => then(Neighbours::by(index, points).in_room(room), how(index)),
        }
    });
}

/// Calls `then` with the neighbours of points by their index.
fn stream(mut index: StateIndex<'_>, points: &[Vec3], reach: f32, then: Then<'_>) {
    let room = index.choice().room();
    index.with(points, reach, &mut |index| {
        then(Neighbours::by(index, points).in_room(room), how(index));
    });
}

fn how(index: Option<&dyn SpatialIndex>) -> Found {
    if index.is_some() { Found::Streamed } else { Found::AllPairs }
}
