//! Laws by which neighbours act on each other.

use super::{Pair, RUN, RadialLaw, Run};
use crate::lanes::{self, Eight, Kernel, LANES};
use crate::math::sqrt;
use core::ops::Mul;

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
    fn power<T: Copy + Mul<Output = T>>(&self, inverse: T) -> T {
        let (mut power, mut factor) = (inverse, inverse);
        for bit in 0..8 - self.exponent.leading_zeros() {
            if self.exponent >> bit & 1 == 1 {
                power = power * factor;
            }
            factor = factor * factor;
        }
        power
    }
}

/// A power law of a particle and several others.
struct Pulls<'a> {
    law: &'a PowerLaw,
    run: &'a Run<'a>,
    pull: &'a mut [f32; RUN],
}

impl Kernel for Pulls<'_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let (Self { law, run, pull }, one) = (self, like.all(1.0));
        let (softening, strength) = (like.all(law.softening * law.softening), like.all(law.strength));
        let weights = match law.weight {
            Weight::One => None,
            Weight::Mass => Some((like.all(run.state.mass[run.row]), run.state.mass)),
            Weight::Charge => Some((like.all(run.state.charge[run.row]), run.state.charge)),
        };
        let blocks = pull.as_chunks_mut::<LANES>().0.iter_mut().zip(run.square.as_chunks::<LANES>().0);
        for ((pull, square), others) in blocks.zip(run.others.chunks(LANES)) {
            let power = law.power((one / (like.of(*square) + softening)).sqrt());
            let factor = match weights {
                None => strength,
                Some((own, weights)) => {
                    // Read one by one into registers: what is written one by one to memory cannot be read at once so soon.
                    let weight = |k: usize| others.get(k).and_then(|&other| weights.get(other as usize)).copied();
                    let weight = |k: usize| weight(k).unwrap_or(0.0);
                    let [a, b, c, d] = [weight(0), weight(1), weight(2), weight(3)];
                    strength * (own * like.of([a, b, c, d, weight(4), weight(5), weight(6), weight(7)]))
                }
            };
            *pull = (power * factor).to_array();
        }
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
        lanes::run(Pulls { law: self, run, pull });
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
