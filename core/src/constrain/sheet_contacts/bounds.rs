//! Boxes around ways.

use super::rest::Face;
use crate::math::{largest, max};
use glam::Vec3;
use wide::f32x4;

/// The rounding of places and ways at the most, as a share of the largest coordinate.
pub(super) const ROUNDING: f32 = 5e-7;

/// Boxes around something at the beginning of a way and in its end, each with a number behind it that does not count.
///
/// Ways are straight, so what is apart along an axis at both ends, on the same side, is so all the way: what goes along together is told apart
/// however far it goes.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Bounds {
    pub(super) low: [[f32; 4]; 2],
    pub(super) high: [[f32; 4]; 2],
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: [[f32::INFINITY; 4]; 2], high: [[f32::NEG_INFINITY; 4]; 2] };

    /// So far around the way of a place; that has to be sound.
    pub(super) fn around(from: Vec3, to: Vec3, reach: f32) -> Self {
        let reach = reach + ROUNDING * max(largest(from), largest(to));
        let corner = |place: Vec3| [place.x, place.y, place.z, 0.0];
        Self { low: [corner(from - reach), corner(to - reach)], high: [corner(from + reach), corner(to + reach)] }
    }

    pub(super) fn is_empty(&self) -> bool {
        !(self.low[0][0] <= self.high[0][0])
    }

    /// Around the way of a triangle whose corners have these; none, if one of them has none.
    #[inline(always)]
    pub(super) fn of_face(face: &Face, corners: &[Self]) -> Self {
        let [a, b, c] = face.corners.map(|corner| corners.get(corner as usize).filter(|bounds| !bounds.is_empty()));
        match (a, b, c) {
            (Some(a), Some(b), Some(c)) => a.and(b).and(c),
            _ => Self::EMPTY,
        }
    }

    #[inline(always)]
    pub(super) fn and(&self, other: &Self) -> Self {
        let low = |end: usize| f32x4::new(self.low[end]).fast_min(f32x4::new(other.low[end])).to_array();
        let high = |end: usize| f32x4::new(self.high[end]).fast_max(f32x4::new(other.high[end])).to_array();
        Self { low: [low(0), low(1)], high: [high(0), high(1)] }
    }

    #[inline(always)]
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let above = |a: &Self, b: &Self| {
            let end = |end: usize| f32x4::new(a.low[end]).simd_gt(f32x4::new(b.high[end]));
            end(0) & end(1)
        };
        (above(self, other) | above(other, self)).to_bitmask() & 7 == 0
    }
}
