//! Randomness as a function: a newborn's numbers are drawn from (seed, emitter, serial), never from a sequence.
//!
//! Events elsewhere, in whatever order or on whatever thread, therefore never change a particle. The generator is
//! Threefry-2x32-20 (Salmon et al., "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011), which passes BigCrush and
//! needs nothing but 32-bit additions, rotations and exclusive ors.

use crate::lanes::widest;
use core::num::Wrapping;
use core::ops::{Add, BitXor};
use wide::u32x4;

/// The random numbers of one newborn, each addressed by its place.
#[derive(Clone, Copy, Debug)]
pub struct Stream {
    key: [u32; 2],
}

impl Stream {
    /// The stream of the `serial`-th birth of emitter number `emitter` under `seed`.
    #[must_use]
    pub fn new(seed: u64, emitter: u32, serial: u32) -> Self {
        Self { key: threefry([seed as u32, (seed >> 32) as u32], [emitter, serial]) }
    }

    /// A word of its own, beside all pairs: what a particle keeps of it as long as it lives.
    #[must_use]
    pub const fn name(&self) -> u32 {
        self.key[0]
    }

    /// Two independent words, the `place`-th pair of the stream.
    #[must_use]
    pub fn words(&self, place: u32) -> [u32; 2] {
        threefry(self.key, [place, 0])
    }

    /// Two numbers uniform in [0, 1), multiples of 2⁻²⁴.
    #[must_use]
    pub fn units(&self, place: u32) -> [f32; 2] {
        self.words(place).map(unit)
    }

    /// The same of four places, side by side.
    #[inline]
    pub(crate) fn units_of(&self, places: [u32; 4]) -> [[f32; 2]; 4] {
        if cfg!(one_by_one) {
            return places.map(|place| self.units(place));
        }
        let turned = |words: u32x4, turn| (words << turn) | (words >> (u32::BITS - turn));
        let key = self.key.map(u32x4::splat);
        let [x, y] = rounds(key, [u32x4::new(places), u32x4::ZERO], u32x4::splat, turned).map(u32x4::to_array);
        core::array::from_fn(|i| [unit(x[i]), unit(y[i])])
    }

    /// The streams of eight births of an emitter from the `serial`-th on, each with the same four pairs of numbers, side by side: one takes as
    /// long as eight, as each round waits for the one before.
    pub(crate) fn eight(seed: u64, emitter: u32, serial: u32, places: [u32; 4]) -> [(Self, [[f32; 2]; 4]); 8] {
        widest(
            #[inline(always)]
            || {
                let (mut streams, mut serials) = ([(Self { key: [0; 2] }, [[0.0; 2]; 4]); 8], Eight([serial; 8]));
                (0..).zip(&mut serials.0).for_each(|(nth, serial)| *serial = serial.wrapping_add(nth));
                let seed = [Eight([seed as u32; 8]), Eight([(seed >> 32) as u32; 8])];
                let keys = rounds(seed, [Eight([emitter; 8]), serials], |word| Eight([word; 8]), Eight::turned);
                for ((stream, _), (first, second)) in streams.iter_mut().zip(keys[0].0.iter().zip(&keys[1].0)) {
                    stream.key = [*first, *second];
                }
                for (nth, place) in places.into_iter().enumerate() {
                    let counter = [Eight([place; 8]), Eight([0; 8])];
                    let [x, y] = rounds(keys, counter, |word| Eight([word; 8]), Eight::turned);
                    for ((_, pairs), (x, y)) in streams.iter_mut().zip(x.0.iter().zip(&y.0)) {
                        pairs[nth] = [unit(*x), unit(*y)];
                    }
                }
                streams
            },
        )
    }
}

/// Words side by side, in whatever registers there are.
#[derive(Clone, Copy)]
struct Eight([u32; 8]);

impl Eight {
    #[inline(always)]
    fn turned(mut self, turn: u32) -> Self {
        self.0.iter_mut().for_each(|word| *word = word.rotate_left(turn));
        self
    }
}

impl Add for Eight {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(word, other)| *word = word.wrapping_add(other));
        self
    }
}

impl BitXor for Eight {
    type Output = Self;
    #[inline(always)]
    fn bitxor(mut self, other: Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(word, other)| *word ^= other);
        self
    }
}

/// The `place`-th word of a particle whose stream has this [`name`](Stream::name): the first is the name itself, which is
/// uniform already and costs nothing.
#[inline]
#[must_use]
pub fn later(name: u32, place: u32) -> u32 {
    if place == 0 { name } else { threefry([name, place], [0, 0])[0] }
}

/// The number in [0, 1) that a word stands for.
#[inline(always)]
fn unit(word: u32) -> f32 {
    (word >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Threefry-2x32 with 20 rounds: a bijection of `counter` for each `key`.
#[must_use]
pub fn threefry(key: [u32; 2], counter: [u32; 2]) -> [u32; 2] {
    let turned = |Wrapping(word): Wrapping<u32>, turn| Wrapping(word.rotate_left(turn));
    rounds(key.map(Wrapping), counter.map(Wrapping), Wrapping, turned).map(|Wrapping(word)| word)
}

/// The same of words, or of several side by side: `all` is one in each place, `turned` rotates them to the left.
#[inline(always)]
fn rounds<T: Copy + Add<Output = T> + BitXor<Output = T>>(
    key: [T; 2],
    [x, y]: [T; 2],
    all: impl Fn(u32) -> T,
    turned: impl Fn(T, u32) -> T,
) -> [T; 2] {
    let mut state = ([x + key[0], y + key[1]], [key[0], key[1], key[0] ^ key[1] ^ all(0x1BD1_1BDA)]);
    if cfg!(one_by_one) {
        (0..5).for_each(|group| state = four(state, group, &all, &turned));
    } else {
        // Written out, so that vectors turn by constants, which takes half the instructions.
        state = four(state, 0, &all, &turned);
        state = four(state, 1, &all, &turned);
        state = four(state, 2, &all, &turned);
        state = four(state, 3, &all, &turned);
        state = four(state, 4, &all, &turned);
    }
    state.0
}

/// Four rounds on two words, and what is put in behind them of three keys, which take turns.
#[inline(always)]
fn four<T: Copy + Add<Output = T> + BitXor<Output = T>>(
    ([mut x, mut y], [a, b, c]): ([T; 2], [T; 3]),
    group: u32,
    all: &impl Fn(u32) -> T,
    turned: &impl Fn(T, u32) -> T,
) -> ([T; 2], [T; 3]) {
    const ROTATIONS: [[u32; 4]; 2] = [[13, 15, 26, 6], [17, 29, 16, 24]];
    for turn in ROTATIONS[group as usize % 2] {
        x = x + y;
        y = turned(y, turn) ^ x;
    }
    // In turn, without a remainder: the smallest chips divide in software.
    ([x + b, y + (c + all(group + 1))], [b, c, a])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threefry_matches_the_reference_vectors() {
        // Known answers that the authors publish with Random123 (kat_vectors, threefry2x32 20).
        let cases = [
            ([0, 0], [0, 0], [0x6b20_0159, 0x99ba_4efe]),
            ([u32::MAX; 2], [u32::MAX; 2], [0x1cb9_96fc, 0xbb00_2be7]),
            ([0x1319_8a2e, 0x0370_7344], [0x243f_6a88, 0x85a3_08d3], [0xc492_3a9c, 0x483d_f7a0]),
        ];
        for (key, counter, expected) in cases {
            assert_eq!(threefry(key, counter), expected);
        }
    }

    #[test]
    fn four_places_side_by_side_hold_what_each_holds() {
        for serial in 0..100 {
            let (stream, places) = (Stream::new(11, 2, serial), [0, serial, 7, u32::MAX - serial]);
            assert_eq!(stream.units_of(places), places.map(|place| stream.units(place)));
            let (seed, serial) = (1 << 40 | 11, serial.wrapping_sub(5));
            for (ahead, (drawn, pairs)) in (0..).zip(Stream::eight(seed, 2, serial, places)) {
                let stream = Stream::new(seed, 2, serial.wrapping_add(ahead));
                assert_eq!((drawn.key, pairs), (stream.key, stream.units_of(places)));
            }
        }
    }

    #[test]
    fn streams_of_neighbours_are_uncorrelated() {
        let n = 20_000;
        let mut sum = 0.0;
        for serial in 0..n {
            let a = Stream::new(1, 0, serial).units(0)[0] - 0.5;
            let b = Stream::new(1, 0, serial + 1).units(0)[0] - 0.5;
            let c = Stream::new(1, 1, serial).units(0)[0] - 0.5;
            let d = Stream::new(2, 0, serial).units(0)[0] - 0.5;
            sum += f64::from(a * b + a * c + a * d);
        }
        // Three products of variance 1/144 each: five standard deviations.
        assert!(sum.abs() < 5.0 * (3.0 * f64::from(n) / 144.0f64).sqrt(), "{sum}");
    }

    #[test]
    fn words_after_birth_are_uncorrelated_with_each_other_and_with_those_of_the_birth() {
        let n = 20_000u32;
        let unit = |word: u32| f64::from(word) / 4_294_967_296.0 - 0.5;
        let mut sums = [0.0; 6];
        for serial in 0..n {
            let stream = Stream::new(3, 1, serial);
            let [a, b, c] = [0, 1, 2].map(|place| unit(later(stream.name(), place)));
            let next = unit(Stream::new(3, 1, serial + 1).name());
            let [d, e] = stream.words(0).map(unit);
            for (sum, product) in sums.iter_mut().zip([a * b, a * c, b * c, a * next, a * d, a * e]) {
                *sum += product;
            }
        }
        // Products of variance 1/144: five standard deviations.
        let most = 5.0 * (f64::from(n) / 144.0).sqrt();
        assert!(sums.iter().all(|sum| sum.abs() < most), "{sums:?}");
    }

    #[test]
    fn units_fill_the_interval_evenly() {
        let mut cells = [0u32; 64];
        for serial in 0..64_000 {
            for u in Stream::new(7, 3, serial).units(5) {
                assert!((0.0..1.0).contains(&u));
                cells[(u * 64.0) as usize] += 1;
            }
        }
        let chi2: f64 = cells.iter().map(|&n| (f64::from(n) - 2000.0).powi(2) / 2000.0).sum();
        assert!(chi2 < 103.4, "chi-squared of 63 degrees at 0.1 %: {chi2}");
    }
}
