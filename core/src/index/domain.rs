//! How points are placed in an index: wrapped into a periodic domain, scaled where squares would leave an `f32`.

use super::Room;
use super::region::widened;
use crate::math::{self, largest, max, min};
use glam::Vec3;

/// All coordinates in an index are smaller than this, so that no square of a distance is beyond an `f32`: 2⁶¹.
pub(super) const FAR: f32 = 2_305_843_009_213_693_952.0;

/// A domain: all of space, or a box whose opposite faces are one and the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Domain {
    room: Room,
    /// A power of two that brings coordinates into the middle of an `f32`'s range.
    scale: f32,
}

/// Which image of the points is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Image {
    /// The points themselves.
    Itself,
    /// The points moved by so much.
    Moved(Vec3),
    /// The nearest image of each point, in a domain of these sides: each side of the difference is taken into
    /// (-side/2, side/2].
    Nearest(Vec3),
}

impl Image {
    /// How far the points are moved.
    #[inline(always)]
    pub(super) fn moved(self) -> Vec3 {
        if let Self::Moved(by) = self { by } else { Vec3::ZERO }
    }
}

impl Domain {
    pub(super) const OPEN: Self = Self { room: Room::OPEN, scale: 1.0 };

    /// A room.
    pub(super) const fn of(room: Room) -> Self {
        Self { room, scale: 1.0 }
    }

    pub(super) const fn room(&self) -> &Room {
        &self.room
    }

    pub(super) const fn scale(&self) -> f32 {
        self.scale
    }

    /// The same at another scale.
    pub(super) const fn at_scale(self, scale: f32) -> Self {
        Self { scale, ..self }
    }

    /// Chooses the scale for points like these.
    pub(super) fn fit(&mut self, points: &[Vec3]) {
        let sound = points.iter().filter(|point| point.is_finite());
        let most = if self.room.is_open() {
            sound.fold(0.0, |most, point| max(largest(*point), most))
        } else {
            sound.fold(largest(self.room.sides()), |most, point| max(largest(self.room.offset(*point)), most))
        };
        let exponent = ((most.to_bits() >> 23) as i32 - 127).clamp(-126, 126);
        let usual = most == 0.0 || (-30..=60).contains(&exponent);
        self.scale = if usual { 1.0 } else { f32::from_bits(((127 - exponent) as u32) << 23) };
    }

    /// Where a point is in the index.
    #[inline(always)]
    pub(super) fn place(&self, point: Vec3) -> Vec3 {
        if self.room.is_open() { point * self.scale } else { self.room.offset(point) * self.scale }
    }

    /// A length in the index.
    pub(super) fn length(&self, length: f32) -> f32 {
        length * self.scale
    }

    /// A length outside of it.
    pub(super) fn unscaled(&self, length: f32) -> f32 {
        length / self.scale
    }

    /// Half of the shortest side, in the index: within less, a point is met in one of its images only. Zero if its
    /// square is beyond an `f32`, infinite if the domain is open.
    pub(super) fn half(&self) -> f32 {
        let side = |side: f32| if side == 0.0 { f32::INFINITY } else { side * self.scale * 0.5 };
        let half = min(side(self.room.sides().x), min(side(self.room.sides().y), side(self.room.sides().z)));
        if half * half >= f32::MIN_POSITIVE { half } else { 0.0 }
    }

    /// The image in which any point may be looked at.
    pub(super) fn image_of_all(&self) -> Image {
        if self.room.is_open() { Image::Itself } else { Image::Nearest(self.room.sides() * self.scale) }
    }

    /// Visits the images of the points that can come within `radius`, less than half of a side, of a box.
    pub(super) fn images(&self, low: Vec3, high: Vec3, radius: f32, mut visit: impl FnMut(Image)) {
        if self.room.is_open() {
            return visit(Image::Itself);
        }
        let sides = (self.room.sides() * self.scale).to_array();
        let across = |axis: usize, sign: i32| {
            let (low, high, side) = (low[axis], high[axis], sides[axis]);
            let reach = widened(radius, low, high, side);
            match sign {
                0 => true,
                _ if side == 0.0 => false,
                1 => high + reach >= side,
                _ => low <= reach,
            }
        };
        for code in 0..27 {
            let signs = [code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1];
            if (0..3).all(|axis| across(axis, signs[axis])) {
                // A point met beyond the upper face is one near the lower face, moved up by a side.
                let side = |axis: usize| signs[axis] as f32 * sides[axis];
                visit(Image::Moved(Vec3::new(side(0), side(1), side(2))));
            }
        }
    }
}

/// The box around some points; inside out if there are none.
#[inline(always)]
pub(super) fn around(points: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    points.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], point| {
        [math::low(point, low), math::high(point, high)]
    })
}

/// Makes an index in open space or in a periodic box, by its `in_domain`.
macro_rules! constructors {
    () => {
        /// An empty one in so much memory, see [`Structure::words`](super::Structure::words).
        #[must_use]
        pub fn new(memory: &'m mut [u32]) -> Self {
            Self::in_domain(memory, Domain::OPEN)
        }

        /// An empty one in a box from `low` on with these sides \[m\], whose opposite faces are one. Sides that are zero
        /// are open; points outside are wrapped in.
        #[must_use]
        pub fn periodic(memory: &'m mut [u32], low: Vec3, sides: Vec3) -> Self {
            Self::in_domain(memory, Domain::of(crate::index::Room::new(low, sides)))
        }

        /// An empty one in a room, or in all of space.
        #[must_use]
        pub fn in_room(memory: &'m mut [u32], room: Option<&crate::index::Room>) -> Self {
            Self::in_domain(memory, room.map_or(Domain::OPEN, |room| Domain::of(*room)))
        }
    };
}
pub(super) use constructors;
