//! The particles in order of what happens to them first, so that the next one is known.

/// The notes on a particle while the meetings of a step are worked through. Instants are counted from the step's
/// beginning in units that the step's length decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct NextEvent {
    /// When its present path began.
    pub(super) since: u32,
    /// When something happens to it next; [`NEVER`].
    pub(super) until: u32,
    /// The partner in that: another's row, [`WALL`], or one of the other marks.
    pub(super) partner: u32,
    /// How much had happened to that other when this was foreseen.
    pub(super) partner_turns: u32,
    /// How much has happened to this one.
    pub(super) turns: u32,
    /// Where its row stands in the queue.
    pub(super) place: u32,
    /// The row that stands at this place of the queue.
    pub(super) row: u32,
    /// Not zero: it has met as much as it may, and waits where it is for the step's end.
    pub(super) waits: u32,
    /// The number of others that it has found near it.
    pub(super) found: u32,
}

/// The mark of an instant at which nothing will happen.
pub(super) const NEVER: u32 = u32::MAX;
/// The mark of a partner that is a collider or a sink.
pub(super) const WALL: u32 = u32::MAX;
/// The mark of no partner.
pub(super) const NOBODY: u32 = u32::MAX - 1;
/// The mark of a partner that is no longer, or never was, to be reckoned with.
pub(super) const GONE: u32 = u32::MAX - 2;

/// A binary heap of rows in the particles' own events: every row has a place, and moves when its instant changes. Of
/// equal instants the lower row comes first.
#[derive(Debug)]
pub(super) struct Queue<'a> {
    events: &'a mut [NextEvent],
}

impl<'a> Queue<'a> {
    /// All rows with the instants that they have.
    pub(super) fn new(events: &'a mut [NextEvent]) -> Self {
        for (event, row) in events.iter_mut().zip(0..) {
            (event.place, event.row) = (row, row);
        }
        let mut queue = Self { events };
        for place in (0..queue.events.len() / 2).rev() {
            queue.sink(place);
        }
        queue
    }

    pub(super) fn event(&self, row: usize) -> &NextEvent {
        &self.events[row]
    }

    /// The row to which something happens first.
    pub(super) fn first(&self) -> Option<usize> {
        let row = self.events.first()?.row as usize;
        (self.events[row].until != NEVER).then_some(row)
    }

    /// Gives a row another event; its place is found anew.
    pub(super) fn set(&mut self, row: usize, event: NextEvent) {
        let NextEvent { place, row: stands, .. } = self.events[row];
        self.events[row] = NextEvent { place, row: stands, ..event };
        let place = self.rise(place as usize);
        self.sink(place);
    }

    fn key(&self, place: usize) -> (u32, u32) {
        let row = self.events[place].row;
        (self.events[row as usize].until, row)
    }

    fn swap(&mut self, a: usize, b: usize) {
        let (first, second) = (self.events[a].row, self.events[b].row);
        (self.events[a].row, self.events[b].row) = (second, first);
        (self.events[first as usize].place, self.events[second as usize].place) = (b as u32, a as u32);
    }

    fn rise(&mut self, mut place: usize) -> usize {
        while place > 0 && self.key(place) < self.key((place - 1) / 2) {
            self.swap(place, (place - 1) / 2);
            place = (place - 1) / 2;
        }
        place
    }

    fn sink(&mut self, mut place: usize) {
        loop {
            let children = (2 * place + 1)..(2 * place + 3).min(self.events.len());
            let Some(least) = children.min_by_key(|&child| self.key(child)) else { return };
            if self.key(place) <= self.key(least) {
                return;
            }
            self.swap(place, least);
            place = least;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;

    #[test]
    fn the_least_is_always_first() {
        let random = |i: u64| (Stream::new(5, 1, i as u32).units(0)[0] * 100.0) as u32;
        let mut events = [NextEvent::default(); 37];
        events.iter_mut().zip(0..).for_each(|(event, i)| event.until = random(i));
        let mut known = events.map(|event| event.until);
        let mut queue = Queue::new(&mut events);
        for i in 0..2000 {
            let least = (0..37).min_by_key(|&row| (known[row], row)).expect("there are some");
            assert_eq!(queue.first(), Some(least));
            let row = if i % 2 == 0 { least } else { i as usize % 37 };
            known[row] = random(1000 + i);
            queue.set(row, NextEvent { until: known[row], ..*queue.event(row) });
        }
        (0..37).for_each(|row| queue.set(row, NextEvent { until: NEVER, ..*queue.event(row) }));
        assert_eq!(queue.first(), None);
    }
}
