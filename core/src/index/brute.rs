//! No structure at all: every query looks at every point. What the others are held against.

use super::domain::{Domain, Image};
use super::search::{Partition, Region, Run, Search};
use super::sorted::Sorted;
use super::{Cost, Neighbour, SpatialIndex, Stats, TooSmall, answers};
use core::ops::Range;
use glam::Vec3;

/// All points in the order they came in. The best choice for some hundred points.
#[derive(Debug)]
pub struct Brute<'m> {
    sorted: Sorted<'m>,
}

impl<'m> Brute<'m> {
    /// An empty one in so much memory, see [`Structure::words`](super::Structure::words).
    #[must_use]
    pub fn new(memory: &'m mut [u32]) -> Self {
        Self::within_domain(memory, Domain::OPEN)
    }

    /// An empty one in a box from `low` on with these sides \[m\], whose opposite faces are one. Sides that are zero are
    /// open; points outside are wrapped in.
    #[must_use]
    pub fn periodic(memory: &'m mut [u32], low: Vec3, sides: Vec3) -> Self {
        Self::within_domain(memory, Domain::periodic(low, sides))
    }

    fn within_domain(memory: &'m mut [u32], domain: Domain) -> Self {
        let capacity = Sorted::capacity_of(memory.len());
        Self { sorted: Sorted::new(memory, capacity, domain).0 }
    }
}

impl Partition for Brute<'_> {
    fn sorted(&self) -> &Sorted<'_> {
        &self.sorted
    }
    fn groups(&self, visit: &mut impl FnMut(Range<usize>, u32)) {
        visit(0..self.sorted.len, 0);
    }
    fn near(&self, _: &Region, _: Image, _: f32, visit: &mut impl FnMut(Run) -> bool) -> u64 {
        visit(Run { slots: 0..self.sorted.len, low: self.sorted.low, high: self.sorted.high, frame: 0 });
        1
    }
    fn stride(&self) -> f32 {
        f32::INFINITY
    }
}

impl SpatialIndex for Brute<'_> {
    fn build(&mut self, points: &[Vec3], _: f32) -> Result<(), TooSmall> {
        self.sorted.take(points)?;
        self.sorted.spread();
        Ok(())
    }
    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.build(points, 0.0)
    }
    fn stats(&self) -> Stats {
        Stats { nodes: 1, fullest: self.sorted.len, ..self.sorted.stats() }
    }
    answers!();
}
