//! Eight numbers in one register of an x86-64 that has them.

use super::{COUNTS, Eight, HITS, LANES, Lanes};
use core::arch::x86_64::{__m256, __m256i, _mm256_permutevar8x32_ps, _mm256_shuffle_ps};
use core::arch::x86_64::{_mm256_unpackhi_ps, _mm256_unpacklo_ps};
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};
use fearless_simd::x86::Avx2;
use fearless_simd::{Bytes, ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdFrom, SimdInto, SimdMask};
use fearless_simd::{f32x4, f32x8, i32x8, mask32x8, u32x8};

// Compilers make a dozen instructions of what is one.
fearless_simd::kernel!(
    #[inline(always)]
    fn permuted(avx2: Avx2, lanes: __m256, order: __m256i) -> __m256 {
        _mm256_permutevar8x32_ps(lanes, order)
    }
);

// Four rows of four in each half of the registers, as columns.
fearless_simd::kernel!(
    #[inline(always)]
    fn turned(avx2: Avx2, a: __m256, b: __m256, c: __m256, d: __m256) -> [__m256; 4] {
        let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (last_ab, last_cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        let (x, y) = (_mm256_shuffle_ps::<0b01_00_01_00>(ab, cd), _mm256_shuffle_ps::<0b11_10_11_10>(ab, cd));
        let z = _mm256_shuffle_ps::<0b01_00_01_00>(last_ab, last_cd);
        [x, y, z, _mm256_shuffle_ps::<0b11_10_11_10>(last_ab, last_cd)]
    }
);

// Three columns as four rows in each half of the registers.
fearless_simd::kernel!(
    #[inline(always)]
    fn turned_back(avx2: Avx2, x: __m256, y: __m256, z: __m256) -> [__m256; 4] {
        let (low, high) = (_mm256_unpacklo_ps(x, y), _mm256_unpackhi_ps(x, y));
        let (a, b) = (_mm256_shuffle_ps::<0b00_00_01_00>(low, z), _mm256_shuffle_ps::<0b01_01_11_10>(low, z));
        [a, b, _mm256_shuffle_ps::<0b10_10_01_00>(high, z), _mm256_shuffle_ps::<0b11_11_11_10>(high, z)]
    }
);

#[inline(always)]
fn both(avx2: Avx2, low: [f32; 4], high: [f32; 4]) -> __m256 {
    avx2.combine_f32x4(f32x4::from_slice(avx2, &low), f32x4::from_slice(avx2, &high)).into()
}

#[inline(always)]
fn halves(avx2: Avx2, rows: __m256) -> [[f32; 4]; 2] {
    bytemuck::cast::<[f32; LANES], _>(f32x8::simd_from(avx2, rows).into())
}

#[derive(Clone, Copy)]
pub(crate) struct Wide(f32x8<Avx2>);

impl Wide {
    #[inline(always)]
    pub(super) fn zero(avx2: Avx2) -> Self {
        Self(f32x8::splat(avx2, 0.0))
    }

    #[inline(always)]
    pub(super) fn of_register(avx2: Avx2, register: __m256) -> Self {
        Self(register.simd_into(avx2))
    }

    #[inline(always)]
    pub(super) fn register(self) -> __m256 {
        self.0.into()
    }

    #[inline(always)]
    fn bits(self) -> u32x8<Avx2> {
        self.0.bitcast()
    }

    #[inline(always)]
    fn of_mask(mask: mask32x8<Avx2>) -> Self {
        Self(mask.to_vector().bitcast())
    }

    #[inline(always)]
    fn mask(self) -> mask32x8<Avx2> {
        mask32x8::from_vector(self.0.bitcast())
    }
}

macro_rules! numbers {
    ($($op:ident $name:ident)+) => {
        $(impl $op for Wide {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.0, other.0))
            }
        })+
    };
}
numbers!(Add add Sub sub Mul mul Div div);

macro_rules! bits {
    ($($op:ident $name:ident)+) => {
        $(impl $op for Wide {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.bits(), other.bits()).bitcast())
            }
        })+
    };
}
bits!(BitAnd bitand BitOr bitor BitXor bitxor);

impl Lanes for Wide {
    type Part = Self;
    const PARTS: usize = 1;
    #[inline(always)]
    fn of_parts<const N: usize>(self, mut part: impl FnMut(Self, usize) -> [Self; N]) -> [Self; N] {
        part(self, 0)
    }
    #[inline(always)]
    fn part(self, _: usize) -> Self {
        self
    }
    #[inline(always)]
    fn all(self, x: f32) -> Self {
        Self(f32x8::splat(self.0.token(), x))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn simd_eq(self, other: Self) -> Self {
        Self::of_mask(self.0.simd_eq(other.0))
    }
    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self {
        Self::of_mask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn simd_le(self, other: Self) -> Self {
        Self::of_mask(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self {
        Self::of_mask(self.0.simd_gt(other.0))
    }
    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self {
        Self::of_mask(self.0.simd_ge(other.0))
    }
    #[inline(always)]
    fn select(self, a: Self, b: Self) -> Self {
        Self(self.mask().select(a.0, b.0))
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    // The instructions have the second of two that are equal, and where there is no number.
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn to_bitmask(self) -> u32 {
        self.mask().to_bitmask() as u32
    }
}

impl Eight for Wide {
    #[inline(always)]
    fn of(self, lanes: [f32; LANES]) -> Self {
        Self(f32x8::from_slice(self.0.token(), &lanes))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        self.0.into()
    }
    #[inline(always)]
    fn thrice(self) -> [Self; 3] {
        let avx2 = self.0.token();
        let order = [[0, 0, 0, 1, 1, 1, 2, 2], [2, 3, 3, 3, 4, 4, 4, 5], [5, 5, 6, 6, 6, 7, 7, 7]];
        order.map(
            #[inline(always)]
            |order| Self(permuted(avx2, self.0.into(), i32x8::simd_from(avx2, order).into()).simd_into(avx2)),
        )
    }
    #[inline(always)]
    fn quads_of(self, rows: [[f32; 4]; LANES]) -> [Self; 4] {
        let avx2 = self.0.token();
        let [a, b, c, d, e, f, g, h] = rows;
        let [a, b] = [both(avx2, a, e), both(avx2, b, f)];
        let [c, d] = [both(avx2, c, g), both(avx2, d, h)];
        // Spelled out: `map` of an array would be called, for other registers.
        let [x, y, z, w] = turned(avx2, a, b, c, d);
        [Self(x.simd_into(avx2)), Self(y.simd_into(avx2)), Self(z.simd_into(avx2)), Self(w.simd_into(avx2))]
    }
    #[inline(always)]
    fn vectors_of([x, y, z]: [Self; 3]) -> [[f32; 4]; LANES] {
        let avx2 = x.0.token();
        let [ae, bf, cg, dh] = turned_back(avx2, x.0.into(), y.0.into(), z.0.into());
        let [[a, e], [b, f], [c, g], [d, h]] = [halves(avx2, ae), halves(avx2, bf), halves(avx2, cg), halves(avx2, dh)];
        [a, b, c, d, e, f, g, h]
    }
    #[inline(always)]
    fn rows_of([x, y, z, w]: [Self; 4]) -> [[f32; 4]; LANES] {
        let avx2 = x.0.token();
        let [ae, bf, cg, dh] = turned(avx2, x.0.into(), y.0.into(), z.0.into(), w.0.into());
        let [[a, e], [b, f], [c, g], [d, h]] = [halves(avx2, ae), halves(avx2, bf), halves(avx2, cg), halves(avx2, dh)];
        [a, b, c, d, e, f, g, h]
    }
    #[inline(always)]
    fn squeezed([x, y, z, w]: [Self; 4], hits: u32) -> ([Self; 4], usize) {
        let (avx2, hits) = (x.0.token(), hits as usize % HITS.len());
        let order: __m256i = u32x8::simd_from(avx2, HITS[hits]).into();
        let [x, y] = [permuted(avx2, x.0.into(), order), permuted(avx2, y.0.into(), order)];
        let [z, w] = [permuted(avx2, z.0.into(), order), permuted(avx2, w.0.into(), order)];
        let columns =
            [Self(x.simd_into(avx2)), Self(y.simd_into(avx2)), Self(z.simd_into(avx2)), Self(w.simd_into(avx2))];
        (columns, usize::from(COUNTS[hits]))
    }
}
