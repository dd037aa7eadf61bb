//! A number by itself among kernels for eight: for chips without vectors, where seven lanes that stand for nothing would cost as much as one
//! that does.

use super::{Eight, LANES, Lanes};
use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// The first of eight lanes; nobody asks for the others.
#[derive(Clone, Copy)]
pub(crate) struct One(pub(crate) f32);

impl One {
    fn mask(holds: bool) -> Self {
        Self(f32::from_bits(if holds { u32::MAX } else { 0 }))
    }
}

macro_rules! numbers {
    ($($op:ident $name:ident)+) => {
        $(impl $op for One {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self($op::$name(self.0, other.0))
            }
        })+
    };
}
numbers!(Add add Sub sub Mul mul Div div);

macro_rules! bits {
    ($($op:ident $name:ident)+) => {
        $(impl $op for One {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                Self(f32::from_bits($op::$name(self.0.to_bits(), other.0.to_bits())))
            }
        })+
    };
}
bits!(BitAnd bitand BitOr bitor BitXor bitxor);

impl Lanes for One {
    type Part = Self;
    const PARTS: usize = 1;
    fn of_parts<const N: usize>(self, mut part: impl FnMut(Self, usize) -> [Self; N]) -> [Self; N] {
        part(self, 0)
    }
    fn part(self, _: usize) -> Self {
        self
    }
    fn all(self, x: f32) -> Self {
        Self(x)
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn sqrt(self) -> Self {
        Self(crate::math::sqrt(self.0))
    }
    fn simd_eq(self, other: Self) -> Self {
        Self::mask(self.0 == other.0)
    }
    fn simd_lt(self, other: Self) -> Self {
        Self::mask(self.0 < other.0)
    }
    fn simd_le(self, other: Self) -> Self {
        Self::mask(self.0 <= other.0)
    }
    fn simd_gt(self, other: Self) -> Self {
        Self::mask(self.0 > other.0)
    }
    fn simd_ge(self, other: Self) -> Self {
        Self::mask(self.0 >= other.0)
    }
    fn select(self, a: Self, b: Self) -> Self {
        if self.0.to_bits() == 0 { b } else { a }
    }
    fn least(self, other: Self) -> Self {
        Self(if self.0 < other.0 { self.0 } else { other.0 })
    }
    fn most(self, other: Self) -> Self {
        Self(if self.0 > other.0 { self.0 } else { other.0 })
    }
    fn to_bitmask(self) -> u32 {
        u32::from(self.0.to_bits() != 0)
    }
}

impl Eight for One {
    fn of(self, lanes: [f32; LANES]) -> Self {
        Self(lanes[0])
    }
    fn to_array(self) -> [f32; LANES] {
        [self.0; LANES]
    }
    fn quads_of(self, rows: [[f32; 4]; LANES]) -> [Self; 4] {
        rows[0].map(Self)
    }
    fn vectors_of([x, y, z]: [Self; 3]) -> [[f32; 4]; LANES] {
        [[x.0, y.0, z.0, z.0]; LANES]
    }
    fn rows_of([x, y, z, w]: [Self; 4]) -> [[f32; 4]; LANES] {
        [[x.0, y.0, z.0, w.0]; LANES]
    }
}
