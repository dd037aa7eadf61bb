//! How a step finds neighbours: in lists if they last, else in an index, else by looking at all pairs.

use super::lists::ListMemory;
use super::neighbours::Neighbours;
use super::{IndexChoice, SpatialIndex};
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
    pub(crate) index: &'a dyn IndexChoice,
    /// The index's memory, and that of lists, where there is some.
    pub(crate) memory: &'a mut [u32],
    pub(crate) lists: Option<ListMemory<'a>>,
    pub(crate) reach: f32,
}

/// The work to be done with neighbours once they can be looked up.
pub(crate) type Then<'a> = &'a mut dyn FnMut(Neighbours<'_>, Found);

/// Calls `then` with the neighbours of points, in lists if they last and there is room for them.
#[inline(never)]
pub(crate) fn find(search: Search<'_>, [points, velocity]: [&[Vec3]; 2], then: Then<'_>) {
    let Search { index, memory, lists, reach } = search;
    let room = index.room();
    let Some(mut lists) = lists else {
        return stream(index, memory, points, reach, then);
    };
    if cfg!(target_os = "none") {
        // A chip's indices do not answer in order.
        return stream(index, memory, points, reach, then);
    }
    if let Some(lists) = lists.kept(points, reach) {
        return then(Neighbours::listed(lists, points).in_room(room), Found::Kept);
    }
    let Some(skin) = lists.skin(points, velocity, reach) else {
        return stream(index, memory, points, reach, then);
    };
    index.with_index(memory, points, reach + skin, room, &mut |index| {
        let made = index.and_then(|index| lists.make(index, points, [reach, skin]));
        match made {
            Some(lists) => then(Neighbours::listed(lists, points).in_room(room), Found::Listed),
            None => then(Neighbours::by(index, points).in_room(room), how(index)),
        }
    });
}

/// Calls `then` with the neighbours of points by an index that is made for it.
fn stream(index: &dyn IndexChoice, memory: &mut [u32], points: &[Vec3], reach: f32, then: Then<'_>) {
    let room = index.room();
    index.with_index(memory, points, reach, room, &mut |index| {
        then(Neighbours::by(index, points).in_room(room), how(index));
    });
}

fn how(index: Option<&dyn SpatialIndex>) -> Found {
    if index.is_some() { Found::Streamed } else { Found::AllPairs }
}
