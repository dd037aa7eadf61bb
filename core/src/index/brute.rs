//! No structure at all: every query looks at every point. What the others are held against.

use super::domain::{Domain, Image, constructors};
use super::facts::OWN;
use super::partition::Partition;
use super::region::{Region, Run};
use super::search::{Search, answers};
use super::sorted::Sorted;
use super::{Cost, Facts, Neighbour, SpatialIndex, Stats, TooSmall};
use core::ops::Range;
use glam::Vec3;

/// All points in the order they came in. The best choice for some hundred points.
#[derive(Debug)]
pub struct Brute<'m> {
    sorted: Sorted<'m>,
}

/// Tells its facts from those of other structures.
const NAME: u32 = u32::from_le_bytes(*b"all ");

impl<'m> Brute<'m> {
    constructors!();

    fn in_domain(memory: &'m mut [u32], domain: Domain) -> Self {
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
    fn facts(&self) -> Option<Facts> {
        self.sorted.facts(NAME, [0; OWN])
    }
    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        self.sorted.restore(NAME, facts).is_some() && self.sorted.renumber(points, row_of, core::iter::empty())
    }
    fn stats(&self) -> Stats {
        Stats { nodes: 1, fullest: self.sorted.len, ..self.sorted.stats() }
    }
    answers!();
}
