//! Forces between neighbours, along the line that joins them.

mod laws;

use super::near::add_up;
#[cfg(feature = "std")]
use super::near::{sum_of_pairs, wide_between};
use super::{Force, Needs, Perturbation, State};
use crate::index::{Nearby, Neighbours};
use crate::lanes::{self, Eight, Kernel, LANES};
use crate::math::max;
use core::ops::Range;
use glam::Vec3;
pub use laws::{LennardJones, PowerLaw, Weight};
use wide::f32x8;

/// Neighbours that come at once.
const RUN: usize = Neighbours::RUN;

/// How two particles act on each other along the line that joins them.
///
/// It has to treat the two alike: with both exchanged it gives the same, bit by bit, so that action and reaction cancel.
pub trait RadialLaw: Sync {
    /// The distance beyond which they do not act on each other \[m\].
    fn reach(&self) -> f32;

    /// The force that draws them together over their distance \[N/m\], below zero if it pushes them apart: the force on
    /// one is this times the way to the other. `square` is the distance squared \[m²\], above zero.
    fn pull(&self, square: f32, pair: &Pair) -> f32;

    /// The same of one particle and several others, side by side: a law whose loops compilers make vectors of is several times as
    /// fast. Bit by bit what [`RadialLaw::pull`] gives, of squares above zero; behind the last of the others it may be anything.
    fn pulls(&self, run: &Run<'_>, pull: &mut [f32; RUN]) {
        for (k, (pull, &square)) in pull.iter_mut().zip(run.square).enumerate().take(run.others.len()) {
            *pull = if square > 0.0 { self.pull(square, &run.pair(k)) } else { 0.0 };
        }
    }

    /// How fast the force that draws them together grows with their distance \[N/m\], for implicit methods. Zero leaves
    /// it out.
    fn stiffness(&self, square: f32, pair: &Pair) -> f32 {
        let _ = (square, pair);
        0.0
    }

    /// The potential energy \[J\] of the two, zero beyond the reach: its slope by the distance is the force.
    #[cfg(feature = "std")]
    fn energy(&self, square: f64, pair: &Pair) -> f64 {
        let _ = (square, pair);
        0.0
    }

    /// Its name in reports.
    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "neighbours"
    }
}

/// The masses and charges of two particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Their masses \[kg\].
    pub mass: [f32; 2],
    /// Their charges \[C\].
    pub charge: [f32; 2],
}

/// A particle and several others, by their rows.
#[derive(Clone, Copy)]
#[allow(missing_debug_implementations)]
pub struct Run<'a> {
    /// The particle.
    pub row: usize,
    /// The others, 32 at the most.
    pub others: &'a [u32],
    /// Distances squared \[m²\], and zeros up to the next multiple of eight; zero for what coincides and is left out.
    pub square: &'a [f32; RUN],
    /// The state of all particles.
    pub state: &'a State<'a>,
}

impl Run<'_> {
    /// The particle and one of the others.
    #[inline(always)]
    #[must_use]
    pub fn pair(&self, k: usize) -> Pair {
        Pair::of(self.state, [self.row, self.others[k] as usize])
    }
}

impl Pair {
    #[inline(always)]
    fn of(state: &State<'_>, rows: [usize; 2]) -> Self {
        Self { mass: rows.map(|row| state.mass[row]), charge: rows.map(|row| state.charge[row]) }
    }
}

/// All particles within a law's reach of each other act on each other by it.
///
/// Neighbours are found by the scene's index, or without one by looking at all. Two that coincide, or are so close that
/// the force is beyond an `f32`, do not act on each other. In a [periodic room](crate::index::Periodic) they act
/// through its sides.
///
/// ```
/// use pointmass::force::{Pair, Radial, RadialLaw};
///
/// /// Balls of 1 m that push each other apart with 100 N per metre that they overlap.
/// struct Soft;
/// impl RadialLaw for Soft {
///     fn reach(&self) -> f32 {
///         1.0
///     }
///     fn pull(&self, square: f32, _: &Pair) -> f32 {
///         let d = pointmass::math::sqrt(square);
///         100.0 * (d - 1.0) / d
///     }
/// }
/// let scene = pointmass::Scene { forces: &Radial(Soft), ..pointmass::Scene::EMPTY };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Radial<L>(pub L);

/// The way to a neighbour \[m\], its square, and how stiff the two are along and across it \[N/m\].
struct PairStiffness {
    toward: Vec3,
    square: f32,
    along: f32,
    across: f32,
}

/// What some neighbours do to a row that pull at it so.
struct Sum<'a> {
    nearby: &'a Nearby,
    pull: &'a [f32; RUN],
}

impl Kernel for Sum<'_> {
    type Output = Vec3;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Vec3 {
        let ([x, y, z], square) = (self.nearby.toward(), self.nearby.square());
        let (zero, infinity) = (like.all(0.0), like.all(f32::INFINITY));
        let mut sum = [zero; 3];
        for first in (0..self.nearby.rows().len()).step_by(LANES) {
            let (pull, square) = (block(like, self.pull, first), block(like, square, first));
            let terms = [block(like, x, first) * pull, block(like, y, first) * pull, block(like, z, first) * pull];
            let finite = |term: F| term.abs().simd_lt(infinity);
            let counts = square.simd_gt(zero) & finite(terms[0]) & finite(terms[1]) & finite(terms[2]);
            for (sum, term) in sum.iter_mut().zip(terms) {
                *sum = *sum + (term & counts);
            }
        }
        let [x, y, z] = sum;
        let total = |sum: F| lanes::total(f32x8::new(sum.to_array()));
        Vec3::new(total(x), total(y), total(z))
    }
}

/// Eight of a column.
#[inline(always)]
fn block<F: Eight>(like: F, column: &[f32; RUN], first: usize) -> F {
    like.of(column[first..].first_chunk().copied().unwrap_or_default())
}

/// Sums that wait to be added to totals: rows come in no order of memory, and many totals are fetched at once in less time than it
/// takes to wait for each in turn.
struct Sums<'t> {
    first: usize,
    total: &'t mut [Vec3],
    waiting: [(usize, Vec3); WAITING],
    len: usize,
}

/// Sums that wait at the most.
const WAITING: usize = if cfg!(one_by_one) { 1 } else { 64 };

impl<'t> Sums<'t> {
    /// None yet, for the totals of rows from `first` on.
    fn new(first: usize, total: &'t mut [Vec3]) -> Self {
        Self { first, total, waiting: [(0, Vec3::ZERO); WAITING], len: 0 }
    }

    /// Adds one to the total of a row.
    #[inline(always)]
    fn add(&mut self, row: usize, sum: Vec3) {
        self.waiting[self.len % WAITING] = (row, sum);
        self.len += 1;
        if self.len == WAITING {
            self.flush();
        }
    }

    /// Adds those that wait, in the order in which they came.
    fn flush(&mut self) {
        for &(row, sum) in &self.waiting[..self.len] {
            if let Some(total) = self.total.get_mut(row.wrapping_sub(self.first)) {
                *total += sum;
            }
        }
        self.len = 0;
    }
}

impl<L: RadialLaw> Radial<L> {
    /// Sums what some neighbours do to a row, in lanes. Those that coincide with it, and those that are not finite, are
    /// left out, so that they harm nobody else.
    #[inline]
    fn sum(&self, state: &State<'_>, row: usize, nearby: &Nearby) -> Vec3 {
        let mut pull = [0.0; RUN];
        self.0.pulls(&Run { row, others: nearby.rows(), square: nearby.square(), state }, &mut pull);
        lanes::run(Sum { nearby, pull: &pull })
    }

    /// About a pair of neighbours; none if they coincide.
    #[inline(always)]
    fn pair_stiffness(&self, state: &State<'_>, rows: [usize; 2]) -> Option<PairStiffness> {
        let toward = state.between(rows[0], rows[1]);
        let square = toward.dot(toward);
        if !(square > 0.0) {
            return None;
        }
        let [along, across] = self.stiffness(square, &Pair::of(state, rows));
        Some(PairStiffness { toward, square, along, across })
    }

    /// Stiffness along the line and across it \[N/m\]. Parts that would drive apart what is displaced are left out, as of
    /// springs.
    fn stiffness(&self, square: f32, pair: &Pair) -> [f32; 2] {
        [max(self.0.stiffness(square, pair), 0.0), max(self.0.pull(square, pair), 0.0)]
    }
}

impl<L: RadialLaw> Force for Radial<L> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let mut sums = Sums::new(rows.start, total);
        state.near.of(rows, self.0.reach(), &mut |row, nearby| sums.add(row, self.sum(state, row, nearby)));
        sums.flush();
    }

    fn needs(&self) -> Needs {
        Needs::within(self.0.reach())
    }

    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let all = 0..total.len();
        add_up(state, self.0.reach(), all, total, |row, other| {
            let Some(PairStiffness { toward, square, along, across }) = self.pair_stiffness(state, [row, other]) else {
                return Vec3::ZERO;
            };
            let apart = change.along[other] - change.along[row];
            let axial = toward * (toward.dot(apart) / square);
            (axial * (along - across) + apart * across) * change.position
        });
    }

    fn add_stiffness(&self, state: &State<'_>, [position, _]: [f32; 2], total: &mut [Vec3]) {
        let all = 0..total.len();
        add_up(state, self.0.reach(), all, total, |row, other| {
            let Some(PairStiffness { toward, square, along, across }) = self.pair_stiffness(state, [row, other]) else {
                return Vec3::ZERO;
            };
            (toward * toward * ((along - across) / square) + Vec3::splat(across)) * position
        });
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        sum_of_pairs(state, self.0.reach(), |row, other| {
            let square = wide_between(state, row, other).iter().map(|x| x * x).sum();
            if square > 0.0 { self.0.energy(square, &Pair::of(state, [row, other])) } else { 0.0 }
        })
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        self.0.name()
    }
}

impl<L: RadialLaw + ?Sized> RadialLaw for &L {
    fn reach(&self) -> f32 {
        (**self).reach()
    }
    fn pull(&self, square: f32, pair: &Pair) -> f32 {
        (**self).pull(square, pair)
    }
    fn pulls(&self, run: &Run<'_>, pull: &mut [f32; RUN]) {
        (**self).pulls(run, pull);
    }
    fn stiffness(&self, square: f32, pair: &Pair) -> f32 {
        (**self).stiffness(square, pair)
    }
    #[cfg(feature = "std")]
    fn energy(&self, square: f64, pair: &Pair) -> f64 {
        (**self).energy(square, pair)
    }
    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        (**self).name()
    }
}
