//! What a scene's step asks for in memory, and where each part of it lies. Nothing else knows.

use glam::Vec3;

/// What a step works with: how many columns of vectors, one vector a particle, each part of it asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Demand {
    /// Places and velocities of the step's beginning, two or none.
    pub(crate) start: usize,
    /// What contacts keep through the step.
    pub(crate) held: usize,
    /// Trees of masses and charges.
    pub(crate) trees: usize,
    /// An index of who is near.
    pub(crate) near: usize,
    /// The method.
    pub(crate) method: usize,
    /// Contacts, when the method has done its work.
    pub(crate) contacts: usize,
}

impl Demand {
    /// All of it, in columns.
    pub(crate) fn columns(&self) -> usize {
        let Self { start, held, trees, near, method, contacts } = *self;
        let moving = method.saturating_add(trees).saturating_add(near);
        moving.max(contacts).saturating_add(start).saturating_add(held)
    }
}

/// Where the parts of a demand lie in memory for so many particles: one behind the other; what is over is scratch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    demand: Demand,
    capacity: usize,
}

/// The parts of the memory that a step works with.
#[derive(Debug)]
pub(crate) struct Shares<'m> {
    /// Where all were at the step's beginning \[m\], and how fast \[m/s\]; empty if nobody asks.
    pub(crate) start: [&'m mut [Vec3]; 2],
    /// What contacts keep through the step.
    pub(crate) held: &'m mut [Vec3],
    /// For the trees of masses and charges.
    pub(crate) trees: &'m mut [u32],
    /// For the index of who is near.
    pub(crate) near: &'m mut [u32],
    /// For the method, or for whatever is at work.
    pub(crate) scratch: &'m mut [Vec3],
}

/// What a step remembers of its beginning, for reading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Past<'m> {
    pub(crate) start: [&'m [Vec3]; 2],
    pub(crate) held: &'m [Vec3],
}

impl Layout {
    pub(crate) fn of(demand: Demand, capacity: usize) -> Self {
        Self { demand, capacity }
    }

    /// The shares while the method moves all.
    pub(crate) fn moving<'m>(&self, work: &'m mut [Vec3]) -> Shares<'m> {
        let shares = self.meeting(work);
        let (trees, rest) = cut(shares.scratch, self.demand.trees * self.capacity);
        let (near, scratch) = cut(rest, self.demand.near * self.capacity);
        Shares { trees: bytemuck::cast_slice_mut(trees), near: bytemuck::cast_slice_mut(near), scratch, ..shares }
    }

    /// The shares when all have been moved: trees and index are no longer needed.
    pub(crate) fn meeting<'m>(&self, work: &'m mut [Vec3]) -> Shares<'m> {
        let (start, rest) = cut(work, self.demand.start * self.capacity);
        let (held, scratch) = cut(rest, self.demand.held * self.capacity);
        let middle = start.len() / 2;
        Shares { start: start.split_at_mut(middle).into(), held, trees: &mut [], near: &mut [], scratch }
    }

    /// What is remembered of a step's beginning.
    pub(crate) fn past<'m>(&self, work: &'m [Vec3]) -> Past<'m> {
        let (start, rest) = work.split_at(self.demand.start * self.capacity);
        Past { start: start.split_at(start.len() / 2).into(), held: &rest[..self.demand.held * self.capacity] }
    }
}

/// The first so many, or all that there are.
fn cut(memory: &mut [Vec3], len: usize) -> (&mut [Vec3], &mut [Vec3]) {
    memory.split_at_mut(len.min(memory.len()))
}
