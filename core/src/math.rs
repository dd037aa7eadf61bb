//! The few mathematical functions everybody here uses, each the same bits on every target: spread over their callers on hosts, and
//! in the flash of chips without an operating system once.
//!
//! `core` has no square root, and a platform's sine differs from machine to machine, so nothing else in the
//! crate calls a transcendental function on the path of a step.

use glam::Vec3;

/// Square root, correctly rounded on every target.
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(feature = "std")]
    return std::primitive::f32::sqrt(x);
    #[cfg(all(not(feature = "std"), all(target_os = "none", not(target_has_atomic = "32"))))]
    return root_by_bits(x);
    #[cfg(all(not(feature = "std"), not(all(target_os = "none", not(target_has_atomic = "32")))))]
    return libm::sqrtf(x);
}

/// The same by shifts and differences, one bit of the root after the other (as FDLIBM's `e_sqrtf.c`; Sun Microsystems, 1993): for the
/// smallest chips, those without a compare-and-swap, which have no wide multiplication either. There it is no slower than libm's, which
/// takes three times the flash.
#[cfg(any(test, all(target_os = "none", not(target_has_atomic = "32"))))]
#[inline(never)]
fn root_by_bits(x: f32) -> f32 {
    let bits = x.to_bits();
    if bits.wrapping_sub(1) >= f32::INFINITY.to_bits() - 1 {
        return if x < 0.0 { f32::NAN } else { x };
    }
    // x = mantissa × 2^(even exponent), the root's exponent being half of that, and its first bit of weight 2²⁴.
    let (mut exponent, mut mantissa) = ((bits >> 23) + 127, bits & 0x007F_FFFF | 0x0080_0000);
    if bits < 0x0080_0000 {
        (exponent, mantissa) = (exponent + 1, bits);
        while mantissa < 0x0080_0000 {
            (exponent, mantissa) = (exponent - 1, mantissa << 1);
        }
    }
    let mut rest = mantissa << (1 + (exponent & 1));
    let (mut root, mut twice, mut bit) = (0, 0, 1 << 24);
    while bit != 0 {
        let least = twice + bit;
        if least <= rest {
            twice = least + bit;
            rest -= least;
            root += bit;
        }
        rest <<= 1;
        bit >>= 1;
    }
    // The last bit is behind those of an f32, and no root lies halfway between two numbers.
    f32::from_bits(((exponent / 2) << 23) - 0x0080_0000 + ((root + (root & 1)) >> 1))
}

/// The product of two vectors, in the order x, y, z.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f32 {
    a.dot(b)
}

/// From a place so far along a direction: `place` + `direction` × `far`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn along(place: Vec3, direction: Vec3, far: f32) -> Vec3 {
    place + direction * far
}

/// From one place or velocity to another: `a` − `b`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn minus(a: Vec3, b: Vec3) -> Vec3 {
    a - b
}

/// The sum of two vectors: `a` + `b`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn plus(a: Vec3, b: Vec3) -> Vec3 {
    a + b
}

/// A vector so many times as long: `v` × `k`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn scaled(v: Vec3, k: f32) -> Vec3 {
    v * k
}

/// A vector over a number: `v` / `k`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn over(v: Vec3, k: f32) -> Vec3 {
    v / k
}

/// The same vector, number by number: what might overlap chips would copy by a routine of its own, which takes as much of their flash as a
/// whole phase of a step.
#[inline(always)]
#[must_use]
pub(crate) fn copied(v: Vec3) -> Vec3 {
    let [x, y, z] = v.to_array();
    Vec3::new(x, y, z)
}

/// Tells whether all coordinates of a vector are zero.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn is_zero(v: Vec3) -> bool {
    v == Vec3::ZERO
}

/// Length of a vector.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn length(v: Vec3) -> f32 {
    sqrt(dot(v, v))
}

/// The part of a vector that lies along a surface.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub(crate) fn aside(v: Vec3, normal: Vec3) -> Vec3 {
    v - normal * dot(v, normal)
}

/// `v` over its length; zero where it has none that an `f32` can hold.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline)]
#[must_use]
pub fn unit(v: Vec3) -> Vec3 {
    // Dividing by the largest coordinate first keeps the squares of tiny and huge vectors in range.
    let largest = max(max(v.x.abs(), v.y.abs()), v.z.abs());
    if !(largest > 0.0 && largest < f32::INFINITY) {
        return Vec3::ZERO;
    }
    let near_one = over(v, largest);
    over(near_one, length(near_one))
}

/// The larger of two numbers, the second where they are equal: unlike `f32::max` it treats −0 alike everywhere.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two numbers, the second where they are equal.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `x` held in `[low, high]`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn clamp(x: f32, low: f32, high: f32) -> f32 {
    min(max(x, low), high)
}

/// The lesser of each coordinate, as `min`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn low(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z))
}

/// The greater of each coordinate, as `max`.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline(always))]
#[must_use]
pub fn high(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z))
}

/// The largest coordinate's magnitude.
#[cfg_attr(one_by_one, inline(never))]
#[cfg_attr(not(one_by_one), inline)]
#[must_use]
pub fn largest(v: Vec3) -> f32 {
    max(max(v.x.abs(), v.y.abs()), v.z.abs())
}

/// The power of two that brings a positive length to between one and two, as far as there is one.
#[must_use]
pub(crate) fn power_to_one(length: f32) -> f32 {
    f32::from_bits((254 - (length.to_bits() >> 23).clamp(1, 253)) << 23)
}

/// The quotient of whole numbers and what is left over. The quotient has to be below 2⁶⁴, and the divisor not zero: else both
/// are meaningless.
///
/// Chips without an operating system divide bit by bit: it is asked for a few times in a step, and the routines of compilers
/// for numbers so wide take kilobytes.
#[must_use]
pub(crate) const fn divide(number: u128, by: u64) -> (u64, u64) {
    if cfg!(target_os = "none") {
        long_division(number, by)
    } else if by == 0 {
        (0, 0)
    } else if number >> 64 == 0 {
        (number as u64 / by, number as u64 % by)
    } else {
        let quotient = (number / by as u128) as u64;
        (quotient, (number as u64).wrapping_sub(quotient.wrapping_mul(by)))
    }
}

/// The quotient of two counts, the divisor not zero.
///
/// The smallest chips, those without a compare-and-swap, divide in software: there it is [`divide`], which they have anyway.
#[must_use]
pub(crate) const fn quotient(number: usize, by: usize) -> usize {
    if cfg!(all(target_os = "none", not(target_has_atomic = "32"))) {
        divide(number as u128, by as u64).0 as usize
    } else {
        number / by
    }
}

/// The same by shifts and differences.
#[inline(never)]
const fn long_division(number: u128, by: u64) -> (u64, u64) {
    let (mut rest, mut low) = ((number >> 64) as u64, number as u64);
    let mut bit = 0;
    while bit < 64 {
        let carry = rest >> 63 != 0;
        rest = rest << 1 | low >> 63;
        low <<= 1;
        if carry || rest >= by {
            rest = rest.wrapping_sub(by);
            low |= 1;
        }
        bit += 1;
    }
    (low, rest)
}

/// Cube root of a number above zero, to 1e-6 of it: an estimate by its bits, then Newton's method.
#[must_use]
pub fn cbrt(x: f32) -> f32 {
    if !(x > f32::MIN_POSITIVE && x < f32::INFINITY) {
        return if x >= f32::INFINITY { x } else { 0.0 };
    }
    let mut root = f32::from_bits(x.to_bits() / 3 + 0x2A51_4067);
    for _ in 0..3 {
        root = root * (2.0 / 3.0) + x / (3.0 * root * root);
    }
    root
}

/// Natural logarithm of a number from 1.2e-38 on, within 1.2e-7 of its value; −∞ below that and of no number.
///
/// The reduction and the polynomial of FDLIBM's `e_logf.c` (Sun Microsystems, 1993) in the coefficients of FreeBSD's:
/// x = 2^k (1 + f) with 1 + f from √½ to √2, s = f / (2 + f), and ln(1 + f) = f − f²/2 + s (f²/2 + R(s²)).
#[must_use]
pub fn ln(x: f32) -> f32 {
    const SQRT_HALF: u32 = 0x3F35_04F3;
    const LN2_HIGH: f32 = 6.931_381e-1;
    const LN2_LOW: f32 = 9.058_001e-6;
    if !(f32::MIN_POSITIVE..f32::INFINITY).contains(&x) {
        return if x >= f32::INFINITY { x } else { f32::NEG_INFINITY };
    }
    let bits = x.to_bits() + (0x3F80_0000 - SQRT_HALF);
    let k = (bits >> 23) as i32 as f32 - 127.0;
    let f = f32::from_bits((bits & 0x007F_FFFF) + SQRT_HALF) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let r = z * (6.666_666e-1 + z * (4.000_097_2e-1 + z * (2.849_878_7e-1 + z * 2.427_907_9e-1)));
    let half = 0.5 * f * f;
    s * (half + r) + k * LN2_LOW - half + f + k * LN2_HIGH
}

/// e^x, within 1.2e-7 of its value where that is 1.2e-38 or more; ∞ where it is beyond an `f32`, 0 where it is far below, and
/// no number of none.
///
/// x = k ln 2 + r with |r| ≤ ½ ln 2, the logarithm in two parts as in [`ln`], and the series of e^r up to the seventh power.
#[must_use]
pub fn exp(x: f32) -> f32 {
    const LN2_HIGH: f32 = 6.931_381e-1;
    const LN2_LOW: f32 = 9.058_001e-6;
    if !(x > -104.0 && x < 89.0) {
        return match x {
            x if x.is_nan() => x,
            x if x > 0.0 => f32::INFINITY,
            _ => 0.0,
        };
    }
    let k = floor(x * core::f32::consts::LOG2_E + 0.5);
    let r = (x - k * LN2_HIGH) - k * LN2_LOW;
    let tail = 8.333_333e-3 + r * (1.388_888_9e-3 + r * 1.984_127e-4);
    let series = 1.0 + (r + r * r * (0.5 + r * (1.666_666_7e-1 + r * (4.166_666_6e-2 + r * tail))));
    // By two powers of two, as one alone may be beyond an f32.
    let (half, power) = (k as i32 / 2, |k: i32| f32::from_bits(((k + 127) as u32) << 23));
    series * power(half) * power(k as i32 - half)
}

/// Sine and cosine of `turns` × 2π, within 1.2e-7 for up to a million turns.
///
/// Cephes' single-precision polynomials on an eighth of a turn, in `f32` alone: about 30 instructions with an FPU,
/// where libm's `sinf` goes through `f64`.
#[must_use]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let (quarter, number) = floored(turns * 4.0 + 0.5);
    let x = (turns - quarter * 0.25) * core::f32::consts::TAU;
    let z = x * x;
    let s = x + x * z * (-1.666_665_5e-1 + z * (8.332_161e-3 + z * -1.951_529_6e-4));
    let c = 1.0 - 0.5 * z + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    // By bits, as nobody guesses which quarter comes next: odd ones swap both, and each changes its sign twice in a turn.
    let quarter = number as u32;
    let (s, c) = if quarter & 1 == 0 { (s, c) } else { (c, s) };
    let signed = |x: f32, quarter: u32| f32::from_bits(x.to_bits() ^ (quarter & 2) << 30);
    (signed(s, quarter), signed(c, quarter.wrapping_add(1)))
}

/// Sine and cosine of an angle in radians, within 3e-7 for a few turns.
#[must_use]
pub fn sin_cos(radians: f32) -> (f32, f32) {
    sin_cos_turns(radians * (1.0 / core::f32::consts::TAU))
}

/// The angle from the first axis to the direction (x, y) \[rad\], from −π to π, within 3e-7; zero where there is no direction.
///
/// Cephes' single-precision polynomial on an eighth of a turn and half of that.
#[must_use]
pub fn angle(x: f32, y: f32) -> f32 {
    use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let (wide, high) = (x.abs(), y.abs());
    let steep = high > wide;
    let (less, more) = if steep { (wide, high) } else { (high, wide) };
    if !(more > 0.0) {
        return 0.0;
    }
    // The tangent is at most 1, and beyond that of a sixteenth of a turn it is taken from an eighth.
    let slope = less / more;
    let (start, t) = if slope > 0.414_213_56 { (FRAC_PI_4, (slope - 1.0) / (slope + 1.0)) } else { (0.0, slope) };
    let z = t * t;
    let series = -0.333_329_5 + z * (0.199_777_1 + z * (-0.138_776_86 + z * 0.080_537_44));
    let eighth = start + (t + t * z * series);
    let quarter = if steep { FRAC_PI_2 - eighth } else { eighth };
    let half = if x < 0.0 { PI - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

/// The largest whole number not above `x`; `x` itself beyond ±2³⁰.
#[inline]
#[must_use]
pub fn floor(x: f32) -> f32 {
    floored(x).0
}

/// The same as a number and as a whole one, which goes as far as there are such.
#[inline]
fn floored(x: f32) -> (f32, i32) {
    let number = x as i32;
    if !(x > -1_073_741_824.0 && x < 1_073_741_824.0) {
        return (x, number);
    }
    let whole = number as f32;
    if whole > x { (whole - 1.0, number - 1) } else { (whole, number) }
}

/// Two unit vectors that complete the unit vector `n` to a right-handed frame (Duff et al., "Building an
/// Orthonormal Basis, Revisited", JCGT 2017).
#[must_use]
pub fn frame(n: Vec3) -> (Vec3, Vec3) {
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    let tangent = Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    let bitangent = Vec3::new(b, sign + n.y * n.y * a, -n.y);
    (tangent, bitangent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_within_their_bound() {
        let around = (-40_000..=40_000).map(|i| sin_cos_turns(i as f32 / 80_000.0));
        for (y, x) in
            around.chain([(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, 1.0), (-3.0, -3.0), (1e-30, 1.0)])
        {
            for scale in [1.0, 1e-30, 1e30] {
                let exact = libm::atan2(f64::from(y * scale), f64::from(x * scale));
                let off = (f64::from(angle(x * scale, y * scale)) - exact).abs();
                // Half a turn to the left is half a turn to the right.
                assert!(off.min(core::f64::consts::TAU - off) < 3e-7, "({x}, {y}) × {scale}: {off}");
            }
        }
        assert_eq!(angle(0.0, 0.0), 0.0);
        for number in [f32::NAN, f32::INFINITY] {
            let _ = (angle(number, 1.0), angle(1.0, number), angle(number, number));
        }
    }

    #[test]
    fn sine_and_cosine_are_within_their_bound() {
        for i in -40_000..40_000 {
            let turns = i as f32 * 0.000_123;
            let (s, c) = sin_cos_turns(turns);
            let exact = f64::from(turns) * core::f64::consts::TAU;
            assert!((f64::from(s) - libm::sin(exact)).abs() < 1.2e-7, "sin at {turns} turns");
            assert!((f64::from(c) - libm::cos(exact)).abs() < 1.2e-7, "cos at {turns} turns");
        }
    }

    #[test]
    fn roots_bit_by_bit_are_those_of_the_host() {
        let edges = [0, 1, 2, 0x007F_FFFF, 0x0080_0000, 0x3F80_0000, 0x7F7F_FFFF, 0x7F80_0000, 0x8000_0000];
        for bits in edges.into_iter().chain((0..0x7F80_0000).step_by(2039)) {
            let x = f32::from_bits(bits);
            assert_eq!(root_by_bits(x).to_bits(), std::primitive::f32::sqrt(x).to_bits(), "{x:e}");
        }
        assert!(root_by_bits(-1.0).is_nan() && root_by_bits(f32::NAN).is_nan());
    }

    #[test]
    fn bit_by_bit_division_agrees_with_that_of_the_compiler() {
        for by in [1, 2, 3, 7, 30, 60, 1000, 1 << 32, (1 << 63) - 25, u64::MAX - 1, u64::MAX] {
            for low in [0, 1, 12_345_678_901_234, u64::MAX / 3, u64::MAX] {
                for high in [0, 1, by / 3, by / 2, by - 1].into_iter().filter(|&high| high < by) {
                    let number = u128::from(high) << 64 | u128::from(low);
                    let expected = ((number / u128::from(by)) as u64, (number % u128::from(by)) as u64);
                    assert_eq!(long_division(number, by), expected, "{number} over {by}");
                    assert_eq!(divide(number, by), expected);
                }
            }
        }
    }

    #[test]
    fn cube_roots_agree_with_libm() {
        for i in -120..120 {
            let x = libm::exp2f(i as f32 + 0.37);
            assert!((cbrt(x) / libm::cbrtf(x) - 1.0).abs() < 1e-6, "cube root of {x}");
        }
        assert_eq!([cbrt(0.0), cbrt(-1.0), cbrt(f32::INFINITY)], [0.0, 0.0, f32::INFINITY]);
    }

    #[test]
    fn logarithms_are_within_their_bound() {
        let near_one = (-3000..3000).map(|i| f32::from_bits((1f32.to_bits() as i32 + i) as u32));
        let everywhere = (0x0080_0000..0x7F80_0000).step_by(9973).map(f32::from_bits);
        for x in near_one.chain(everywhere) {
            let exact = libm::log(f64::from(x));
            assert!((f64::from(ln(x)) - exact).abs() <= 1.2e-7 * exact.abs(), "ln {x}: {} for {exact}", ln(x));
        }
        assert_eq!([ln(1.0), ln(f32::INFINITY)], [0.0, f32::INFINITY]);
        assert!([0.0, -1.0, 1e-40, f32::NAN].iter().all(|&x| ln(x) == f32::NEG_INFINITY));
    }

    #[test]
    fn exponentials_are_within_their_bound() {
        for i in -873_000..887_000 {
            let x = i as f32 * 1e-4;
            let exact = libm::exp(f64::from(x));
            assert!((f64::from(exp(x)) - exact).abs() <= 1.2e-7 * exact, "e^{x}: {} for {exact}", exp(x));
        }
        assert_eq!([exp(0.0), exp(-0.0), exp(90.0), exp(f32::INFINITY)], [1.0, 1.0, f32::INFINITY, f32::INFINITY]);
        assert_eq!([exp(-200.0), exp(f32::NEG_INFINITY)], [0.0; 2]);
        assert!(exp(f32::NAN).is_nan() && exp(-100.0) > 0.0 && exp(-100.0) < 1e-43);
    }

    #[test]
    fn floor_agrees_with_libm() {
        for x in [-2.5, -2.0, -0.5, -0.0, 0.0, 0.25, 1.0, 7.99, -1e9, 1e20, f32::INFINITY] {
            assert_eq!(floor(x), libm::floorf(x), "floor of {x}");
        }
        assert!(floor(f32::NAN).is_nan());
    }

    #[test]
    fn a_frame_is_orthonormal_and_right_handed() {
        for i in 0..1000 {
            let (s, c) = sin_cos_turns(i as f32 * 0.618_034);
            let z = -1.0 + 2.0 * (i as f32 + 0.5) / 1000.0;
            let r = sqrt(1.0 - z * z);
            let n = Vec3::new(r * c, r * s, z);
            let (t, b) = frame(n);
            for dot in [n.dot(t), n.dot(b), t.dot(b), length(t) - 1.0, length(b) - 1.0] {
                assert!(dot.abs() < 1e-6);
            }
            assert!((t.cross(b) - n).length() < 1e-6);
        }
    }

    #[test]
    fn unit_copes_with_any_length() {
        for scale in [1e-38, 1e-20, 1.0, 1e20, 3e38] {
            let u = unit(Vec3::new(0.6, -0.8, 0.0) * scale);
            assert!((length(u) - 1.0).abs() < 1e-6, "scale {scale}");
        }
        assert_eq!(unit(Vec3::ZERO), Vec3::ZERO);
        assert_eq!(unit(Vec3::splat(f32::NAN)), Vec3::ZERO);
    }
}
