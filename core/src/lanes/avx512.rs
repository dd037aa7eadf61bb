//! Sixteen numbers in one register of an x86-64 that has them, as two eights.

use super::Lanes;
use super::avx2::Wide;
use core::arch::x86_64::__m256;
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};
use fearless_simd::x86::{Avx2, Avx512};
use fearless_simd::{Bytes, ExtractToken, Select, SimdBase, SimdCombine, SimdFloat, SimdFrom, SimdMask, SimdSplit};
use fearless_simd::{f32x8, f32x16, mask32x16, u32x16};

/// Sixteen numbers, and leave to work with eight of them.
#[derive(Clone, Copy)]
pub(super) struct Broad(f32x16<Avx512>, Avx2);

impl Broad {
    #[inline(always)]
    pub(super) fn zero(avx512: Avx512, avx2: Avx2) -> Self {
        Self(f32x16::splat(avx512, 0.0), avx2)
    }

    #[inline(always)]
    fn bits(self) -> u32x16<Avx512> {
        self.0.bitcast()
    }

    #[inline(always)]
    fn with_mask(self, mask: mask32x16<Avx512>) -> Self {
        Self(mask.to_vector().bitcast(), self.1)
    }

    #[inline(always)]
    fn mask(self) -> mask32x16<Avx512> {
        mask32x16::from_vector(self.0.bitcast())
    }

    #[inline(always)]
    fn joined(self, low: Wide, high: Wide) -> Self {
        let avx512 = self.0.token();
        let [low, high] = [low.register(), high.register()];
        let [low, high] = [f32x8::simd_from(avx512, low), f32x8::simd_from(avx512, high)];
        Self(low.combine(high), self.1)
    }
}

macro_rules! numbers {
    ($($op:ident $name:ident)+) => {
        $(impl $op for Broad {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.0, other.0), self.1)
            }
        })+
    };
}
numbers!(Add add Sub sub Mul mul Div div);

macro_rules! bits {
    ($($op:ident $name:ident)+) => {
        $(impl $op for Broad {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.bits(), other.bits()).bitcast(), self.1)
            }
        })+
    };
}
bits!(BitAnd bitand BitOr bitor BitXor bitxor);

impl Lanes for Broad {
    type Part = Wide;
    const PARTS: usize = 2;
    #[inline(always)]
    fn of_parts<const N: usize>(self, mut part: impl FnMut(Wide, usize) -> [Wide; N]) -> [Self; N] {
        let like = Wide::zero(self.1);
        let (low, high, mut all) = (part(like, 0), part(like, 1), [self; N]);
        for (all, (low, high)) in all.iter_mut().zip(low.into_iter().zip(high)) {
            *all = self.joined(low, high);
        }
        all
    }
    #[inline(always)]
    fn part(self, nth: usize) -> Wide {
        let (low, high) = self.0.split();
        Wide::of_register(self.1, __m256::from(if nth == 0 { low } else { high }))
    }
    #[inline(always)]
    fn all(self, x: f32) -> Self {
        Self(f32x16::splat(self.0.token(), x), self.1)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1)
    }
    #[inline(always)]
    fn simd_eq(self, other: Self) -> Self {
        self.with_mask(self.0.simd_eq(other.0))
    }
    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self {
        self.with_mask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn simd_le(self, other: Self) -> Self {
        self.with_mask(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self {
        self.with_mask(self.0.simd_gt(other.0))
    }
    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self {
        self.with_mask(self.0.simd_ge(other.0))
    }
    #[inline(always)]
    fn select(self, a: Self, b: Self) -> Self {
        Self(self.mask().select(a.0, b.0), self.1)
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1)
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1)
    }
    // The instructions have the second of two that are equal, and where there is no number.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        self.most(other)
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        self.least(other)
    }
    #[inline(always)]
    fn to_bitmask(self) -> u32 {
        self.mask().to_bitmask() as u32
    }
}
