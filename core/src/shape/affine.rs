//! Linear maps with a shift: turned, scaled, sheared and moved.

use super::Aabb;
use crate::math::{largest, length, max, min, unit};
use glam::{Mat3, Vec3};

/// A linear map and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Turning, scaling, shearing.
    pub linear: Mat3,
    /// The image of the origin \[m\].
    pub shift: Vec3,
}

/// How far lengths and angles may be off for a map to count as one that keeps shapes.
const EVEN: f32 = 1e-5;

impl Affine {
    /// Everything stays where it is.
    pub const IDENTITY: Self = Self { linear: Mat3::IDENTITY, shift: Vec3::ZERO };

    /// The image of a point.
    #[must_use]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.shift
    }

    /// A box around the image of a box; everything, if the box has no finite image.
    #[must_use]
    pub fn bounds(&self, bounds: &Aabb) -> Aabb {
        let Aabb { min, max } = *bounds;
        let corner = |i: u8| {
            let pick = |bit: u8, low: f32, high: f32| if i & bit == 0 { low } else { high };
            self.point(Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z)))
        };
        let image = Aabb::around((0..8).map(corner));
        let everything = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        if min.is_finite() && max.is_finite() { image } else { everything }
    }

    /// First `inner`, then this.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        Self { linear: self.linear * inner.linear, shift: self.point(inner.shift) }
    }

    /// The way back, if there is one.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let linear = self.linear.try_inverse()?;
        Some(Self { linear, shift: -(linear * self.shift) })
    }

    /// Tells whether all shapes stay what they are, perhaps in another size.
    pub(super) fn keeps_shapes(&self) -> bool {
        self.scale().is_some()
    }

    /// Tells whether shapes that are round about the y axis and upright stay so.
    pub(super) fn keeps_bases(&self) -> bool {
        self.stretch().is_some_and(|(scale, _)| is_even(scale.x, scale.z))
    }

    /// How much longer all lengths become, and within which share of them; `None` unless it keeps all shapes.
    pub(super) fn scale(&self) -> Option<[f32; 2]> {
        let [x, y, z] = self.lengths();
        let (least, most) = (min(min(x, y), z), max(max(x, y), z));
        let error = max((most - least) / most, self.skew());
        (error <= EVEN).then_some([(x + y + z) * (1.0 / 3.0), error])
    }

    /// How much wider and higher what is round about the y axis and upright becomes, the latter below zero if it is turned
    /// upside down; `None` unless it stays round and upright.
    #[cfg(feature = "alloc")]
    pub(super) fn upright(&self) -> Option<[f32; 2]> {
        let (lengths, _) = self.stretch()?;
        let up = unit(self.linear.y_axis).y;
        let stands = 1.0 - up.abs() <= EVEN * EVEN;
        (stands && is_even(lengths.x, lengths.z)).then_some([0.5 * (lengths.x + lengths.z), lengths.y * up])
    }

    /// It as a scaling along the axes, and what then turns and moves; `None` if right angles do not stay right.
    pub(super) fn stretch(&self) -> Option<(Vec3, Self)> {
        let [x, y, z] = self.lengths();
        let m = self.linear;
        let turn = Mat3::from_cols(m.x_axis / x, m.y_axis / y, m.z_axis / z);
        (self.skew() <= EVEN).then_some((Vec3::new(x, y, z), Self { linear: turn, ..*self }))
    }

    /// The lengths of the images of the unit vectors.
    pub(super) fn lengths(&self) -> [f32; 3] {
        [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis].map(length)
    }

    /// The largest cosine between images of the axes.
    fn skew(&self) -> f32 {
        let [x, y, z] = [self.linear.x_axis, self.linear.y_axis, self.linear.z_axis].map(unit);
        largest(Vec3::new(x.dot(y), y.dot(z), z.dot(x)))
    }
}

/// Tells whether two lengths are one.
fn is_even(a: f32, b: f32) -> bool {
    (a - b).abs() <= EVEN * max(a, b)
}
