//! The pieces near a box, in the order of their numbers whatever the structure.

use super::{Cost, Pieces};
use crate::shape::Aabb;

/// The largest number of pieces gathered at a time; where there are more, the structure is asked again.
const AT_ONCE: usize = 64;

/// The lowest numbers from some number on, each once.
pub(super) struct Gathered {
    from: usize,
    numbers: heapless::Vec<u32, AT_ONCE>,
    /// True if there are higher numbers, too.
    more: bool,
    pub(super) cost: Cost,
}

impl Gathered {
    /// Takes a piece in, if its box shares a point with another.
    pub(super) fn ask<P: Pieces + ?Sized>(&mut self, pieces: &P, bounds: &Aabb, piece: usize) {
        self.cost.tests += 1;
        if piece < self.from || !meets(&pieces.box_of(piece), bounds) {
            return;
        }
        // One that cells list twice is there already.
        let Err(place) = self.numbers.binary_search(&(piece as u32)) else {
            return;
        };
        if self.numbers.is_full() {
            self.more = true;
            if place == AT_ONCE {
                return;
            }
            self.numbers.pop();
        }
        let _ = self.numbers.insert(place, piece as u32);
    }
}

/// Visits what `gather` finds in ascending order.
pub(super) fn in_order(mut gather: impl FnMut(&mut Gathered), visit: &mut dyn FnMut(usize)) -> Cost {
    let mut found = Gathered { from: 0, numbers: heapless::Vec::new(), more: true, cost: Cost::default() };
    while found.more {
        found.more = false;
        found.numbers.clear();
        gather(&mut found);
        found.numbers.iter().for_each(|&piece| visit(piece as usize));
        found.from = found.numbers.last().map_or(0, |&last| last as usize + 1);
    }
    found.cost
}

/// Tells whether two boxes share a point. One that is not finite shares none.
#[inline(always)]
pub(super) fn meets(a: &Aabb, b: &Aabb) -> bool {
    a.min.is_finite() && a.max.is_finite() && a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
