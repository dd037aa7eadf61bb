//! Forces between neighbours, along the line that joins them.

use super::near::add_up;
#[cfg(feature = "std")]
use super::near::{sum_of_pairs, wide_between};
use super::{Force, Needs, Perturbation, State};
use crate::index::{Nearby, Neighbours};
use crate::lanes::{self, LANES};
use crate::math::{max, sqrt};
use core::ops::{MulAssign, Range};
use glam::Vec3;
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
            *pull = self.pull(square, &run.pair(k));
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

impl<L: RadialLaw> Radial<L> {
    /// Sums what some neighbours do to a row, in lanes. Those that coincide with it, and those that are not finite, are
    /// left out, so that they harm nobody else.
    #[inline]
    fn sum(&self, state: &State<'_>, row: usize, nearby: &Nearby) -> Vec3 {
        let ([x, y, z], square, mut pull) = (nearby.toward(), nearby.square(), [0.0; RUN]);
        self.0.pulls(&Run { row, others: nearby.rows(), square, state }, &mut pull);
        let len = nearby.rows().len();
        let mut sum = [f32x8::ZERO; 3];
        for first in (0..len).step_by(LANES) {
            let block = |column: &[f32; RUN]| f32x8::new(column[first..].first_chunk().copied().unwrap_or_default());
            let pull = block(&pull);
            let terms = [x, y, z].map(|way| block(way) * pull);
            let finite = f32x8::splat(f32::INFINITY);
            let counts = terms
                .iter()
                .fold(block(square).simd_gt(f32x8::ZERO), |counts, term| counts & term.abs().simd_lt(finite));
            for (sum, term) in sum.iter_mut().zip(terms) {
                *sum += term & counts;
            }
        }
        Vec3::from_array(sum.map(lanes::total))
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
        let first = rows.start;
        state.near.of(rows, self.0.reach(), &mut |row, nearby| {
            if let Some(total) = total.get_mut(row - first) {
                // Rows come in no order of memory: it is fetched while the sum is made.
                let before = *total;
                *total = before + self.sum(state, row, nearby);
            }
        });
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

/// Atoms without charge (Lennard-Jones 1924): energy 4 ε ((σ/d)¹² − (σ/d)⁶), shifted to zero at the cutoff. They rest
/// 2^{1/6} σ = 1.1225 σ apart, where it takes ε to part them.
///
/// At the cutoff the force jumps to zero, by 0.039 ε/σ where that is 2.5 σ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LennardJones {
    /// Depth of the well ε \[J\].
    pub epsilon: f32,
    /// The distance σ at which they neither lost nor gained energy \[m\].
    pub sigma: f32,
    /// Beyond this distance nothing acts \[m\]; 2.5 σ is usual.
    pub cutoff: f32,
}

impl RadialLaw for LennardJones {
    fn reach(&self) -> f32 {
        self.cutoff
    }

    #[inline]
    fn pull(&self, square: f32, _: &Pair) -> f32 {
        let s2 = self.sigma * self.sigma / square;
        let s6 = s2 * s2 * s2;
        24.0 * self.epsilon * s6 * (1.0 - 2.0 * s6) / square
    }

    fn pulls(&self, run: &Run<'_>, pull: &mut [f32; RUN]) {
        let whole = run.others.len().next_multiple_of(LANES).min(RUN);
        let nobody = Pair { mass: [0.0; 2], charge: [0.0; 2] };
        for (pull, &square) in pull[..whole].iter_mut().zip(run.square) {
            *pull = self.pull(square, &nobody);
        }
    }

    fn stiffness(&self, square: f32, _: &Pair) -> f32 {
        let s2 = self.sigma * self.sigma / square;
        let s6 = s2 * s2 * s2;
        24.0 * self.epsilon * s6 * (26.0 * s6 - 7.0) / square
    }

    #[cfg(feature = "std")]
    fn energy(&self, square: f64, _: &Pair) -> f64 {
        let at = |square: f64| {
            let s6 = (f64::from(self.sigma).powi(2) / square).powi(3);
            4.0 * f64::from(self.epsilon) * s6 * (s6 - 1.0)
        };
        at(square) - at(f64::from(self.cutoff).powi(2))
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "Lennard-Jones"
    }
}

/// Neighbours attract each other with c w₁ w₂ / Dⁿ, D² = d² + s², s being the softening: f = c w₁ w₂ d⃗ / Dⁿ⁺¹. Its
/// energy is zero at its reach, where the force jumps to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PowerLaw {
    /// The strength c: the force \[N\] at a distance of 1 m between weights of 1; below zero it repels.
    pub strength: f32,
    /// The exponent n, from 0, the same force at any distance, to 12.
    pub exponent: u8,
    /// Softening length s \[m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub softening: f32,
    /// Beyond this distance nothing acts \[m\].
    pub reach: f32,
    /// The quantities that the weights w are.
    #[cfg_attr(feature = "serde", serde(default))]
    pub weight: Weight,
}

/// The quantity that a force between two particles is proportional to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Weight {
    /// Nothing: all particles count alike.
    #[default]
    One,
    /// Both masses \[kg\].
    Mass,
    /// Both charges \[C\]. Where the strength is above zero, equal signs attract each other.
    Charge,
}

impl PowerLaw {
    /// c w₁ w₂.
    #[inline(always)]
    fn strength(&self, pair: &Pair) -> f32 {
        let [a, b] = match self.weight {
            Weight::One => return self.strength,
            Weight::Mass => pair.mass,
            Weight::Charge => pair.charge,
        };
        self.strength * (a * b)
    }

    /// 1 / D² and 1 / Dⁿ⁺¹.
    #[inline(always)]
    fn inverse(&self, square: f32) -> [f32; 2] {
        let inverse_square = 1.0 / (square + self.softening * self.softening);
        [inverse_square, self.power(sqrt(inverse_square))]
    }

    /// 1 / Dⁿ⁺¹ of 1 / D, or of several side by side.
    #[inline(always)]
    fn power<T: Copy + MulAssign>(&self, inverse: T) -> T {
        let (mut power, mut factor) = (inverse, inverse);
        for bit in 0..8 - self.exponent.leading_zeros() {
            if self.exponent >> bit & 1 == 1 {
                power *= factor;
            }
            factor *= factor;
        }
        power
    }
}

impl RadialLaw for PowerLaw {
    fn reach(&self) -> f32 {
        self.reach
    }

    #[inline]
    fn pull(&self, square: f32, pair: &Pair) -> f32 {
        self.strength(pair) * self.inverse(square)[1]
    }

    fn pulls(&self, run: &Run<'_>, pull: &mut [f32; RUN]) {
        let softening = f32x8::splat(self.softening * self.softening);
        let blocks = pull.as_chunks_mut::<LANES>().0.iter_mut().zip(run.square.as_chunks::<LANES>().0);
        for (pull, square) in blocks.take(run.others.len().div_ceil(LANES)) {
            let inverse = lanes::sqrt(f32x8::ONE / (f32x8::new(*square) + softening));
            *pull = self.power(inverse).to_array();
        }
        let weights = match self.weight {
            Weight::One => return pull.iter_mut().for_each(|pull| *pull *= self.strength),
            Weight::Mass => run.state.mass,
            Weight::Charge => run.state.charge,
        };
        let own = weights[run.row];
        for (pull, &other) in pull.iter_mut().zip(run.others) {
            *pull *= self.strength * (own * weights[other as usize]);
        }
    }

    fn stiffness(&self, square: f32, pair: &Pair) -> f32 {
        let [inverse_square, power] = self.inverse(square);
        self.strength(pair) * power * (1.0 - (f32::from(self.exponent) + 1.0) * square * inverse_square)
    }

    #[cfg(feature = "std")]
    fn energy(&self, square: f64, pair: &Pair) -> f64 {
        let softened = |square: f64| libm::sqrt(square + f64::from(self.softening).powi(2));
        let (d, end) = (softened(square), softened(f64::from(self.reach).powi(2)));
        let n = i32::from(self.exponent);
        let work = if n == 1 { libm::log(d / end) } else { (d.powi(1 - n) - end.powi(1 - n)) / f64::from(1 - n) };
        f64::from(self.strength(pair)) * work
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "power law"
    }
}
