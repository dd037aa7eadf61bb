//! Sums over all pairs of points in double precision: what sums over far groups are held against.

use crate::points::Spread;
use crate::{Random, f64s, gap};
use pointmass::Vec3;
use pointmass::index::{BarnesHut, Cost, Opening};

/// Points with weights.
#[derive(Clone, Debug)]
pub struct Charges {
    /// Where they are.
    pub points: Vec<Vec3>,
    /// Their masses, or charges of both signs.
    pub weights: Vec<f32>,
}

/// A sum over all pairs.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    /// Σ w d⃗ / (d² + s²)^{3/2}.
    pub sum: [f64; 3],
    /// The magnitudes of its terms, added.
    pub size: f64,
}

/// How far sums are from those over all pairs.
#[derive(Clone, Copy, Debug)]
pub struct Off {
    /// Root mean square of |Δ| / |exact|.
    pub rms: f64,
    /// The largest of them.
    pub largest: f64,
    /// Root mean square of |Δ|, over that of |exact|: where sums nearly vanish, the others say little.
    pub overall: f64,
    /// The largest |Δ| over the magnitudes of all terms, added.
    pub share: f64,
}

/// Memory that was in use before.
#[must_use]
pub fn used(words: usize) -> Vec<u32> {
    (0..words).map(|i| 0xdead_beef ^ (i as u32).wrapping_mul(0x9e37_79b9)).collect()
}

/// The bits of a vector.
#[must_use]
pub fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(f32::to_bits)
}

impl Charges {
    /// So many points with masses between 0.5 and 2.
    #[must_use]
    pub fn masses(spread: Spread, n: usize, seed: u64) -> Self {
        let mut random = Random::new(seed ^ 77);
        Self { points: spread.points(n, seed), weights: (0..n).map(|_| random.magnitude(0.5, 2.0)).collect() }
    }

    /// So many points, every other one with a negative weight.
    #[must_use]
    pub fn signed(spread: Spread, n: usize, seed: u64) -> Self {
        let mut charges = Self::masses(spread, n, seed);
        charges.weights.iter_mut().step_by(2).for_each(|weight| *weight = -*weight);
        charges
    }

    /// The same with coordinates and weights multiplied.
    #[must_use]
    pub fn scaled(&self, length: f32, weight: f32) -> Self {
        Self {
            points: self.points.iter().map(|&point| point * length).collect(),
            weights: self.weights.iter().map(|&w| w * weight).collect(),
        }
    }

    /// The sum at a row; what is not finite is left out.
    #[must_use]
    pub fn exact(&self, row: usize, softening: f32) -> Exact {
        let (place, square) = (f64s(self.points[row]), f64::from(softening) * f64::from(softening));
        let mut exact = Exact { sum: [0.0; 3], size: 0.0 };
        for (point, &weight) in self.points.iter().zip(&self.weights) {
            let at = f64s(*point);
            let d = [at[0] - place[0], at[1] - place[1], at[2] - place[2]];
            let r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            if point.is_finite() && weight.is_finite() && r2 > 0.0 {
                let w = f64::from(weight) / ((r2 + square) * (r2 + square).sqrt());
                (0..3).for_each(|axis| exact.sum[axis] += w * d[axis]);
                exact.size += w.abs() * r2.sqrt();
            }
        }
        exact
    }

    /// A tree of them in memory that has enough room.
    ///
    /// # Panics
    /// If they do not fit.
    #[must_use]
    pub fn tree<'m>(&self, memory: &'m mut Vec<u32>) -> BarnesHut<'m> {
        *memory = used(BarnesHut::words(self.points.len() + 8));
        let mut tree = BarnesHut::new(memory);
        tree.build(&self.points, &self.weights).expect("there is room");
        tree
    }

    /// The sums by row, none for those left out.
    ///
    /// # Panics
    /// If a row is visited twice.
    #[must_use]
    pub fn sums(&self, law: Opening) -> Vec<Option<Vec3>> {
        let (mut memory, n) = (vec![], self.points.len());
        let mut sums = vec![None; n];
        let cost = collect(&self.tree(&mut memory), law, 0..n, &mut sums);
        assert_eq!(cost.found as usize, sums.iter().flatten().count());
        sums
    }

    /// Holds the sums of every `stride`-th row against those over all pairs.
    ///
    /// # Panics
    /// If a row has no sum that should have one, or the other way round.
    #[must_use]
    pub fn off(&self, law: Opening, stride: usize) -> Off {
        self.off_by(&self.sums(law), law.softening, stride)
    }

    /// The same of any sums.
    ///
    /// # Panics
    /// As `off`.
    #[must_use]
    pub fn off_by(&self, sums: &[Option<Vec3>], softening: f32, stride: usize) -> Off {
        let (mut squares, mut wrong, mut whole, mut count) = (0.0, 0.0, 0.0, 0.0);
        let (mut largest, mut share) = (0.0f64, 0.0f64);
        for (row, sum) in sums.iter().enumerate().step_by(stride) {
            assert_eq!(sum.is_some(), self.points[row].is_finite(), "row {row}");
            let Some(sum) = sum else { continue };
            let exact = self.exact(row, softening);
            let (off, length) = (gap(f64s(*sum), exact.sum), gap(exact.sum, [0.0; 3]));
            // A number that is none counts as infinitely wrong.
            let off = if off.is_finite() { off } else { f64::INFINITY };
            let ratio = if off == 0.0 { 0.0 } else { off / length };
            squares += ratio * ratio;
            largest = largest.max(ratio);
            share = share.max(if off == 0.0 { 0.0 } else { off / exact.size });
            wrong += off * off;
            whole += length * length;
            count += 1.0;
        }
        let overall = if wrong == 0.0 { 0.0 } else { (wrong / whole).sqrt() };
        Off { rms: (squares / f64::max(count, 1.0)).sqrt(), largest, overall, share }
    }
}

/// Asks for the sums of some rows, and returns what that took.
///
/// # Panics
/// If a row is visited twice, or one that was not asked for.
pub fn collect(tree: &BarnesHut<'_>, law: Opening, rows: core::ops::Range<usize>, sums: &mut [Option<Vec3>]) -> Cost {
    tree.field(law, rows.clone(), &mut |row, sum| {
        assert!(rows.contains(&row) && sums[row].is_none(), "row {row} of {rows:?}");
        sums[row] = Some(sum);
    })
}
