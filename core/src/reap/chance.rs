//! Death by chance.

use super::{Cause, Reaper, Verdicts};
use crate::force::State;
use crate::math::ln;
use crate::rng::later;
use crate::time::Time;
use core::ops::Range;

/// Death at random, as likely at any age: of those of one age a share of exp(−`rate` t) is left after t. Radioactive nuclei
/// and atoms in an excited state die so, and sparks that go out one by one.
///
/// How long a particle has to live is a function of its own random numbers, so it dies at the same instant whatever the step,
/// and at the end of the step that holds this instant, unless age has ended it before. Several in a list choose independently,
/// so that their rates add up. Nothing is kept for it but the particle's key ([`State::word`]).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Chance {
    /// Deaths per second and particle \[1/s\]: the mean lifetime is one over it, and half are gone after 0.693 over it. Zero:
    /// nobody dies of it.
    pub rate: f32,
}

impl Chance {
    /// How long a particle with this random word has to live: −ln(u) / rate, u = (word + ½) / 2³² being uniform in (0, 1]
    /// (Devroye, Non-Uniform Random Variate Generation, 1986, section II.2.1).
    fn span(self, word: u32) -> Time {
        let u = (word as f32 + 0.5) * (1.0 / 4_294_967_296.0);
        Time::from_seconds(-ln(u) / self.rate)
    }
}

impl Reaper for Chance {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let place = verdicts.claim();
        if self.is_empty() {
            return;
        }
        let glance = Glance::of(self.rate);
        let keys = state.key[rows.clone()].iter().zip(&state.born[rows.clone()]);
        for (nth, ((&key, &born), &dies)) in keys.zip(&state.dies[rows]).enumerate() {
            let word = later(key, place);
            if glance.spares(word, state.time - born) {
                continue;
            }
            let end = born + self.span(word);
            if end <= state.time && end < dies {
                verdicts.end(nth, Cause::Chance);
            }
        }
    }

    fn is_empty(&self) -> bool {
        !(self.rate > 0.0)
    }
}

/// Tells most of those that live from the bits of their words, without a logarithm.
///
/// The bits of a float, read as a whole number, are a polygon through its binary logarithm, L ≤ 2²³ (log₂ x + 127) ≤ L +
/// 0.0861 × 2²³ (Mitchell, "Computer Multiplication and Division Using Binary Logarithms", 1962). So a lifetime is at least
/// 31.9139 − L / 2²³ + 127 half-lives. The bound used leaves 0.0009 half-lives for the roundings of L, of the age and of their
/// sum to an `f32`: 2⁻¹⁷ each at most where it matters.
#[derive(Clone, Copy, Debug)]
struct Glance {
    /// Half-lives in two ticks, in units of 2⁻²³.
    pace: f32,
}

impl Glance {
    const ALIVE: f32 = (31.913 + 127.0) * 8_388_608.0;

    fn of(rate: f32) -> Self {
        // 2²³ × 2⁻³¹ s, over ln 2.
        Self { pace: rate * (1.0 / (256.0 * core::f32::consts::LN_2)) }
    }

    /// Tells whether the particle that has this word is sure to live at this age.
    #[inline(always)]
    fn spares(self, word: u32, age: Time) -> bool {
        let bits = (word as f32 + 0.5).to_bits() as i32 as f32;
        // Halved, ticks are below 2⁶³: one instruction for a signed number. One more makes up for the rounding of short spans to
        // ticks.
        let age = (age.ticks() / 2) as i64 as f32 + 1.0;
        bits + self.pace * age < Self::ALIVE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::threefry;

    #[test]
    fn a_glance_spares_nobody_who_has_to_go() {
        for rate in [1e-9, 1e-3, 0.5, 1.0, 7.3, 1e4, 1e9, 1e30, f32::MAX, f32::INFINITY] {
            let (chance, glance) = (Chance { rate }, Glance::of(rate));
            for i in 0..40_000 {
                let [a, b] = threefry([1, 2], [i, 0]);
                // Small and large words as well as those between.
                let word = if i % 2 == 0 { a >> (b % 32) } else { !(a >> (b % 32)) };
                let span = chance.span(word).ticks();
                // A particle that outlives time itself never has to go.
                let ages = [span, span.saturating_add(1), span.saturating_add(span >> 20), u64::MAX];
                for age in ages.into_iter().filter(|_| span < u64::MAX) {
                    assert!(!glance.spares(word, Time::from_ticks(age)), "{rate} {word} {age}");
                }
            }
        }
    }

    #[test]
    fn a_glance_spares_most_of_those_who_live() {
        let (chance, glance) = (Chance { rate: 0.3 }, Glance::of(0.3));
        let (mut living, mut spared) = (0, 0);
        for i in 0..100_000 {
            let [word, other] = threefry([3, 4], [i, 0]);
            let age = chance.span(other);
            if age < chance.span(word) {
                living += 1;
                spared += u32::from(glance.spares(word, age));
            }
        }
        // The polygon is 0.057 half-lives off on average, within which 4 % die.
        assert!(living > 49_000 && spared * 100 > living * 95, "{spared} of {living}");
    }

    #[test]
    fn spans_are_logarithms() {
        for (word, rate) in [(0, 1.0), (u32::MAX, 1.0), (1 << 31, 2.0), (12_345, 0.25), (!12_345, 8.0)] {
            let u = (f64::from(word) + 0.5) / 4_294_967_296.0;
            let span = Chance { rate }.span(word).seconds_f64();
            // u is rounded to 2⁻²⁵, the quotient likewise, and time to a tick.
            let exact = -libm::log(u) / f64::from(rate);
            assert!((span - exact).abs() < 3e-7 * exact + 6e-8 / f64::from(rate) + 3e-10, "{word}: {span} {exact}");
        }
        assert_eq!(Chance { rate: 1e-30 }.span(77), Time::NEVER);
        assert_eq!(Chance { rate: f32::INFINITY }.span(77), Time::ZERO);
    }
}
