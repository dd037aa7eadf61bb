//! Groups that hang together: things that are bound to each other by twos, each to one of a lower number.

/// A thing that is bound to one of the same slice: a lower one, or itself if it is the lowest.
pub(crate) trait Bound {
    /// The number of the one that it is bound to.
    fn bound(&mut self) -> &mut u32;
}

impl Bound for u32 {
    fn bound(&mut self) -> &mut u32 {
        self
    }
}

/// The lowest of those that are bound to each other. Ways there are halved on the way.
pub(crate) fn root<T: Bound>(all: &mut [T], mut of: u32) -> u32 {
    loop {
        let next = *all[of as usize].bound();
        if next == of {
            return of;
        }
        let after = *all[next as usize].bound();
        *all[of as usize].bound() = after;
        of = after;
    }
}

/// Binds two, and so all that are bound to them.
pub(crate) fn unite<T: Bound>(all: &mut [T], a: u32, b: u32) {
    let (a, b) = (root(all, a), root(all, b));
    *all[a.max(b) as usize].bound() = a.min(b);
}
