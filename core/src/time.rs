//! Simulated time, a whole number of 2⁻³² seconds.
//!
//! Whole numbers add without rounding, so a birth lies at the same instant however a run is cut into steps, and a
//! chip without double-precision hardware needs none.

use crate::math::divide;
use core::ops::{Add, Sub};

/// A point in simulated time, or a span of it, in units of 2⁻³² s (about 0.23 ns); spans 136 years.
///
/// Arithmetic saturates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Time(u64);

const TICKS_PER_SECOND: f32 = 4_294_967_296.0;

impl Time {
    /// The beginning.
    pub const ZERO: Self = Self(0);
    /// One second.
    pub const SECOND: Self = Self(1 << 32);
    /// Later than everything; when an immortal particle dies.
    pub const NEVER: Self = Self(u64::MAX);

    /// From units of 2⁻³² s.
    #[must_use]
    pub const fn from_ticks(ticks: u64) -> Self {
        Self(ticks)
    }

    /// In units of 2⁻³² s.
    #[must_use]
    pub const fn ticks(self) -> u64 {
        self.0
    }

    /// When frame `n` of `per_second` ends, to the nearest tick: what a loop at a steady rate steps to without drift.
    ///
    /// ```
    /// use pointmass::Time;
    /// assert_eq!(Time::frame(120, 60), Time::from_seconds(2.0));
    /// ```
    #[must_use]
    pub const fn frame(n: u64, per_second: u32) -> Self {
        let rate = if per_second == 0 { 1 } else { per_second as u64 };
        Self::over(((n as u128) << 32) + rate as u128 / 2, rate)
    }

    /// From seconds, to the nearest tick; negative numbers and NaN give zero, numbers too large `NEVER`.
    #[must_use]
    pub const fn from_seconds(seconds: f32) -> Self {
        Self(fixed_32(seconds))
    }

    /// As `from_seconds`, for hosts: a chip without double-precision hardware is better off without it.
    #[must_use]
    pub const fn from_seconds_f64(seconds: f64) -> Self {
        // The cast saturates and sends NaN to zero; adding a half makes it round.
        Self((seconds * 4_294_967_296.0 + 0.5) as u64)
    }

    /// In seconds, rounded to an `f32`.
    #[cfg_attr(one_by_one, inline(never))]
    #[must_use]
    pub const fn seconds(self) -> f32 {
        self.0 as f32 / TICKS_PER_SECOND
    }

    /// In seconds, rounded to an `f64`: for reports.
    #[must_use]
    pub const fn seconds_f64(self) -> f64 {
        self.0 as f64 / 4_294_967_296.0
    }

    /// How far a wheel of `frequency` turns a second \[Hz\] has turned by now, from 0 to 1 without the whole turns. Its speed
    /// is rounded to 2⁻³² turns a second, and counts in whole numbers, so that it is as exact late as early.
    #[must_use]
    pub const fn turns(self, frequency: f32) -> f32 {
        let forth = frequency >= 0.0;
        let speed = fixed_32(if forth { frequency } else { -frequency });
        // Both factors are in units of 2⁻³²: the low 64 bits of the product are what is left of whole turns.
        let turned = speed.wrapping_mul(self.0);
        let turned = if forth { turned } else { turned.wrapping_neg() };
        (turned >> 40) as f32 / 16_777_216.0
    }

    /// The first so many of so many equal parts of it, rounded down to a tick; nothing, if it is cut into none.
    #[must_use]
    pub const fn part(self, part: u32, of: u32) -> Self {
        if of == 0 {
            return Self::ZERO;
        }
        // By halves, none of which is beyond 64 bits.
        let (high, low) = ((self.0 >> 32) * part as u64, (self.0 & 0xFFFF_FFFF) * part as u64);
        Self::over(((high as u128) << 32) + low as u128, of as u64)
    }

    /// So many ticks, divided; the last instant, if that is beyond it.
    const fn over(ticks: u128, by: u64) -> Self {
        // As much as `by` times 2⁶⁴ has its quotient beyond.
        Self(if ticks >> 64 >= by as u128 { u64::MAX } else { divide(ticks, by).0 })
    }

    /// Half of it, rounded down to a tick.
    #[must_use]
    pub const fn half(self) -> Self {
        Self(self.0 / 2)
    }
}

impl Add for Time {
    type Output = Self;
    #[cfg_attr(one_by_one, inline(never))]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl Sub for Time {
    type Output = Self;
    #[cfg_attr(one_by_one, inline(never))]
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

/// `x` × 2³² to the nearest whole number, by its bits: exact, and free of double precision.
///
/// Negative numbers and NaN give zero, numbers too large `u64::MAX`.
#[must_use]
pub(crate) const fn fixed_32(x: f32) -> u64 {
    if !(x > 0.0) {
        return 0;
    }
    let bits = x.to_bits();
    let exponent = (bits >> 23) as i32;
    let mantissa = ((bits & 0x007F_FFFF) | if exponent == 0 { 0 } else { 0x0080_0000 }) as u64;
    // x = mantissa × 2^(exponent − 150), so x × 2³² shifts the mantissa by exponent − 118.
    let shift = exponent - 118;
    if shift > 40 {
        u64::MAX
    } else if shift >= 0 {
        mantissa << shift
    } else if shift > -32 {
        ((mantissa >> (-shift - 1)) + 1) >> 1
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_convert_to_the_nearest_tick() {
        for x in [0.0, 1.0, 0.5, 1.0 / 60.0, 0.001, 3.0e-9, 1.0e-10, 1.2e-10, 1e-38, 86_400.0, 4.0e9] {
            let expected = (f64::from(x) * 4_294_967_296.0).round() as u64;
            assert_eq!(Time::from_seconds(x).ticks(), expected, "{x}");
            assert_eq!(Time::from_seconds_f64(f64::from(x)).ticks(), expected, "{x}");
        }
        for x in [-1.0, -0.0, f32::NAN, f32::NEG_INFINITY] {
            assert_eq!(Time::from_seconds(x), Time::ZERO);
        }
        assert_eq!(Time::from_seconds(f32::INFINITY), Time::NEVER);
        assert_eq!(Time::from_seconds(1e20), Time::NEVER);
    }

    #[test]
    fn frames_do_not_drift() {
        assert_eq!(Time::frame(60 * 3600, 60), Time::from_seconds(3600.0));
        assert_eq!(Time::frame(7, 0), Time::from_seconds(7.0));
        let longest = (0..600).map(|n| Time::frame(n + 1, 60) - Time::frame(n, 60)).max();
        assert_eq!(longest.map(Time::ticks), Some(71_582_789));
    }

    #[test]
    fn arithmetic_saturates() {
        assert_eq!(Time::NEVER + Time::SECOND, Time::NEVER);
        assert_eq!(Time::ZERO - Time::SECOND, Time::ZERO);
        assert_eq!(Time::SECOND.part(7, 2), Time::from_seconds(3.5));
        assert_eq!([Time::NEVER.part(2, 1), Time::NEVER.part(u32::MAX, 1)], [Time::NEVER; 2]);
        assert_eq!([Time::NEVER.part(5, 5), Time::NEVER.part(2, 3)].map(Time::ticks), [u64::MAX, u64::MAX / 3 * 2]);
        assert_eq!(Time::NEVER.part(u32::MAX, 0), Time::ZERO);
    }
}
