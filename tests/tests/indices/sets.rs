//! Sets of points and radii that come by chance.

use super::INF;
use pointmass::Vec3;
use pointmass_tests::points::{Spread, extent};
use pointmass_tests::{Random, f64s, gap};
use proptest::prelude::*;
use proptest::sample::select;

/// A set of points that fits into a line of a failed test's message.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Set {
    spread: Spread,
    n: usize,
    pub(crate) seed: u64,
    /// Factor.
    size: f32,
    /// How far from the origin, in sizes: coordinates are rounded the more.
    offset: f32,
    /// One in so many rows is the same as another, or not finite; zero: none.
    copies: usize,
    unsound: usize,
    /// One in so many is far off.
    strays: usize,
}

impl Set {
    pub(crate) fn points(self) -> Vec<Vec3> {
        let mut points = self.spread.points(self.n, self.seed);
        let mut random = Random::new(!self.seed);
        let offset = random.vector(self.offset);
        points.iter_mut().for_each(|point| *point = (*point + offset) * self.size);
        let (mut far, far_off) = (Random::new(self.seed ^ 1), self.size.min(1e30) * 1e4);
        let mut one_in = |n: usize| n > 0 && (random.word() as usize).is_multiple_of(n);
        for row in 0..self.n {
            if one_in(self.copies) {
                points[row] = points[row / 2];
            }
            if one_in(self.strays) {
                points[row] += far.vector(1.0) * far_off;
            }
            if one_in(self.unsound) {
                points[row][row % 3] = [f32::NAN, INF, -INF][row / 3 % 3];
            }
        }
        points
    }
}

pub(crate) fn sets(most: usize) -> impl Strategy<Value = Set> {
    let size = prop_oneof![4 => Just(1.0f32), 1 => select(&[0.1, 1e-12, 1e-30, 1e-41, 1e12, 1e30, 1e38][..])];
    let offset = select(&[0.0f32, 0.0, 0.0, 3.0, 1e3, 1e6][..]);
    let one_in = || select(&[0usize, 0, 30, 3][..]);
    let strays = select(&[0usize, 0, 0, 50, 7][..]);
    (select(&Spread::ALL[..]), 0..most, any::<u64>(), size, offset, one_in(), one_in(), strays).prop_map(
        |(spread, n, seed, size, offset, copies, unsound, strays)| {
            // The largest stay finite.
            let offset = if size > 1e37 { offset.min(2.0) } else { offset };
            Set { spread, n, seed, size, offset, copies, unsound, strays }
        },
    )
}

/// A radius for a set of points.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Radius {
    Is(f32),
    /// This part of the set's extent.
    Part(f32),
    /// The distance between two of its points, and so many units in the last place more.
    Gap(usize, usize, i32),
}

impl Radius {
    pub(crate) fn of(self, points: &[Vec3]) -> f32 {
        let at = |i: usize| points.get(i % points.len().max(1)).copied().unwrap_or_default();
        match self {
            Self::Is(radius) => radius,
            Self::Part(part) => extent(points) * part,
            Self::Gap(a, b, ulps) => {
                let gap = gap(f64s(at(a)), f64s(at(b))) as f32;
                if gap > 0.0 && gap < 1e38 { f32::from_bits(gap.to_bits().saturating_add_signed(ulps)) } else { 0.5 }
            }
        }
    }
}

pub(crate) fn radii() -> impl Strategy<Value = Radius> {
    prop_oneof![
        1 => select(&[0.0, 1e-30, 1e-3, INF][..]).prop_map(Radius::Is),
        3 => (-3.0f32..0.5).prop_map(|power| Radius::Part(10f32.powf(power))),
        2 => (any::<usize>(), any::<usize>(), -1..=1).prop_map(|(a, b, ulps)| Radius::Gap(a, b, ulps)),
    ]
}

/// Reaches to build with: none, the radius itself, and others.
pub(crate) fn reaches() -> impl Strategy<Value = f32> {
    select(&[0.0f32, 1.0, 1.0, 0.1, 10.0][..])
}
