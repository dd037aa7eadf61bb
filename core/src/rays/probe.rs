//! A segment made ready to be held against boxes, and the best hit so far.

use super::visit::Aabb8;
use super::{Cost, Pieces};
use crate::math::{high, low};
use crate::shape::{Aabb, Hit, Segment};
use glam::Vec3;
use wide::f32x8;

/// A segment, prepared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe<'s> {
    pub(super) segment: &'s Segment,
    /// One over each coordinate of its step, never infinite and never zero.
    inverse: [f32; 3],
    /// Where it comes from, moved against the room around boxes: for the plane it meets first, and for the other.
    near_from: [f32; 3],
    far_from: [f32; 3],
    /// True if it runs down an axis: then the upper plane comes first.
    pub(super) down: [bool; 3],
    /// How far from a box it is still inside \[m\], and how much of that is for rounding.
    room: f32,
    rounding: f32,
}

/// Steps shorter than this count as none along their axis: the inverse would be infinite.
const STILL: f32 = 1e-37;

impl<'s> Probe<'s> {
    /// Nothing, if the segment can meet nothing: it has no length, or is not finite.
    pub(crate) fn new(segment: &'s Segment, reach: f32) -> Option<Self> {
        let step = segment.step();
        // Twice what a hit may be off by, and what it takes to be moved by a room.
        let rounding = 2.0 * segment.slack(reach);
        let room = segment.radius + rounding;
        let sound = segment.from.is_finite() && step.is_finite() && segment.radius >= 0.0 && room < f32::INFINITY;
        if !sound || step == Vec3::ZERO {
            return None;
        }
        let inverse = step.to_array().map(|step| if step.abs() < STILL { 1.0 / STILL } else { 1.0 / step });
        let down = inverse.map(|inverse| inverse < 0.0);
        let from = segment.from.to_array();
        let moved = |by: f32| core::array::from_fn(|i| if down[i] { from[i] - by } else { from[i] + by });
        Some(Self { segment, inverse, near_from: moved(room), far_from: moved(-room), down, room, rounding })
    }

    /// From when to when it is inside a slab between two planes across an axis, with room; the two ends may be in the
    /// wrong order, if it is not.
    #[inline(always)]
    pub(super) fn slab(&self, axis: usize, low: f32, high: f32) -> (f32, f32) {
        let (near, far) = if self.down[axis] { (high, low) } else { (low, high) };
        ((near - self.near_from[axis]) * self.inverse[axis], (far - self.far_from[axis]) * self.inverse[axis])
    }

    /// From when to when it is inside a box with room, within [0, 1].
    #[inline(always)]
    pub(super) fn span(&self, bounds: &Aabb) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (0.0, 1.0);
        for axis in 0..3 {
            let (near, far) = self.slab(axis, bounds.min[axis], bounds.max[axis]);
            (enter, leave) = (if near > enter { near } else { enter }, if far < leave { far } else { leave });
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// The same for eight boxes; which of them it meets not after `best`.
    #[inline(always)]
    pub(super) fn spans(&self, boxes: &Aabb8, best: f32) -> (f32x8, f32x8, u32) {
        let (mut enter, mut leave) = (f32x8::ZERO, f32x8::ONE);
        for axis in 0..3 {
            let (low, high) = (&boxes.min[axis], &boxes.max[axis]);
            let (near, far) = if self.down[axis] { (high, low) } else { (low, high) };
            let inverse = f32x8::splat(self.inverse[axis]);
            let near = (f32x8::new(*near) - f32x8::splat(self.near_from[axis])) * inverse;
            let far = (f32x8::new(*far) - f32x8::splat(self.far_from[axis])) * inverse;
            (enter, leave) = (near.fast_max(enter), far.fast_min(leave));
        }
        let limit = leave.fast_min(f32x8::splat(best));
        (enter, leave, enter.simd_le(limit).to_bitmask())
    }

    /// The box around all it touches, with room.
    pub(super) fn bounds(&self) -> Aabb {
        self.between(0.0, 1.0)
    }

    /// The box around all it touches between two instants, with room: whatever box it is in during one of them by its
    /// span, this shares a point with.
    pub(super) fn between(&self, start: f32, end: f32) -> Aabb {
        let (a, b) = (self.segment.at(start), self.segment.at(end));
        let room = self.room + self.rounding;
        Aabb { min: low(a, b) - room, max: high(a, b) + room }
    }
}

/// The earliest hit so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best {
    pub(crate) time: f32,
    piece: u32,
    pub(crate) hit: Option<Hit>,
    pub(super) cost: Cost,
}

impl Best {
    pub(crate) const NONE: Self = Self { time: 1.0, piece: u32::MAX, hit: None, cost: Cost { visits: 0, tests: 0 } };

    /// Asks a piece by its own box.
    #[inline(always)]
    pub(crate) fn ask<P: Pieces + ?Sized>(&mut self, pieces: &P, probe: &Probe<'_>, piece: usize) {
        let bounds = pieces.box_of(piece);
        let finite = bounds.min.is_finite() && bounds.max.is_finite();
        if let Some(span) = probe.span(&bounds).filter(|span| finite && span.0 <= self.time) {
            self.meet(pieces, probe, piece, span);
        }
    }

    /// Asks a piece whose own box the segment is in during this span.
    #[inline(always)]
    pub(super) fn meet<P: Pieces + ?Sized>(
        &mut self,
        pieces: &P,
        probe: &Probe<'_>,
        piece: usize,
        (enter, leave): (f32, f32),
    ) {
        self.cost.tests += 1;
        let Some(hit) = pieces.hit(piece, probe.segment) else {
            return;
        };
        // Whichever zero the bounds are, the time does not become a negative one.
        let time = if hit.time < enter {
            enter
        } else if hit.time > leave {
            leave + 0.0
        } else {
            hit.time
        };
        let number = piece as u32;
        if time < self.time || (time == self.time && number < self.piece) {
            *self = Self { time, piece: number, hit: Some(Hit { time, ..hit }), ..*self };
        }
    }
}
