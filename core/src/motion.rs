//! Motion by script: how scenery, emitters and whoever is attached go where nothing stops them.

mod frame;
mod keys;

pub(crate) use frame::EVERYWHERE;
pub use frame::Frame;
pub use keys::{Key, Keys};

/// A motion with keys on the heap, as scene files have it.
#[cfg(feature = "alloc")]
pub type MotionBuf = Motion<alloc::vec::Vec<Key>>;

use crate::math::{high, largest, length, low, sin_cos_turns, unit};
use crate::shape::{Aabb, Affine};
use crate::time::Time;
use core::f32::consts::TAU;
use glam::{Mat3, Vec3};

/// Something that moves as it likes, as a rigid body, whatever happens to it: at each instant it says where.
///
/// ```
/// use pointmass::motion::{Frame, Script};
/// use pointmass::{Mat3, Time, Vec3};
///
/// /// Falls from its place without end.
/// struct Falls;
///
/// impl Script for Falls {
///     fn frame(&self, at: Time) -> Frame {
///         let (t, g) = (at.seconds(), Vec3::NEG_Y * 9.8);
///         Frame { place: g * (0.5 * t * t), velocity: g * t, acceleration: g, bend: 9.8, ..Frame::STILL }
///     }
/// }
///
/// let frame = Falls.frame(Time::from_seconds(1.0));
/// assert_eq!(frame.world(Vec3::X), Vec3::new(1.0, -4.9, 0.0));
/// assert_eq!(frame.velocity_at(Vec3::ZERO), Vec3::NEG_Y * 9.8);
/// ```
pub trait Script: Sync {
    /// Where everything is at an instant and how it moves there: a pure function of the instant.
    fn frame(&self, at: Time) -> Frame;

    /// Tells whether it never moves anything: nobody then asks where.
    fn is_still(&self) -> bool {
        false
    }

    /// A box around all that something within `bounds` ever reaches, seen from where its drift has brought it.
    fn reach(&self, bounds: &Aabb) -> Aabb {
        let _ = bounds;
        EVERYWHERE
    }

    /// The velocity at which all of that drifts along from time zero on \[m/s\].
    fn drift(&self) -> Vec3 {
        Vec3::ZERO
    }
}

impl Script for () {
    fn frame(&self, _: Time) -> Frame {
        Frame::STILL
    }
    fn is_still(&self) -> bool {
        true
    }
    fn reach(&self, bounds: &Aabb) -> Aabb {
        *bounds
    }
}

impl<T: Script + ?Sized> Script for &T {
    fn frame(&self, at: Time) -> Frame {
        (**self).frame(at)
    }
    fn is_still(&self) -> bool {
        (**self).is_still()
    }
    fn reach(&self, bounds: &Aabb) -> Aabb {
        (**self).reach(bounds)
    }
    fn drift(&self) -> Vec3 {
        (**self).drift()
    }
}

impl<T: Script> Script for Option<T> {
    fn frame(&self, at: Time) -> Frame {
        self.as_ref().map_or(Frame::STILL, |script| script.frame(at))
    }
    fn is_still(&self) -> bool {
        self.as_ref().is_none_or(Script::is_still)
    }
    fn reach(&self, bounds: &Aabb) -> Aabb {
        self.as_ref().map_or(*bounds, |script| script.reach(bounds))
    }
    fn drift(&self) -> Vec3 {
        self.as_ref().map_or(Vec3::ZERO, Script::drift)
    }
}

/// Motion in a closed form of the instant alone, as exact late as early: turning about an axis, swinging along a line, drifting, and
/// going from key to key, all at once.
///
/// At time t the point x of it is at pivot + K R(x − pivot) + swing sin 2π(frequency t + phase) + drift t + k, where R turns by
/// spin t about the axis, and keys say K and k.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        default,
        deny_unknown_fields,
        bound(serialize = "K: Keys + serde::Serialize", deserialize = "K: Keys + Default + serde::Deserialize<'de>")
    )
)]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(rename = "Motion", bound = "K: Keys + Default + schemars::JsonSchema + serde::Serialize")
)]
pub struct Motion<K = ()> {
    /// A point of the axis that it turns about \[m\]; it swings, drifts and follows the keys along.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub pivot: Vec3,
    /// The direction of that axis, of any length but zero; keys turn it along.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub axis: Vec3,
    /// Turns a second, counter-clockwise seen from where the axis points \[Hz\].
    pub spin: f32,
    /// How far it swings to either side, and along which line \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub swing: Vec3,
    /// Swings a second \[Hz\].
    pub frequency: f32,
    /// The part of a swing at which it begins: 0 in the middle, 0.25 at the far end.
    pub phase: f32,
    /// The velocity of its drift \[m/s\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub drift: Vec3,
    /// Places and rotations at given instants, in the order of these.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Keys::is_empty"))]
    pub keys: K,
    /// The time after which the keys begin again \[s\]; zero: never. The first and the last should be alike then.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "is_zero"))]
    pub period: f32,
}

#[cfg(feature = "serde")]
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(number: &f32) -> bool {
    *number == 0.0
}

impl Motion {
    /// None at all; its axis is y.
    pub const STILL: Self = Self::with_keys((), 0.0);
}

impl<K> Motion<K> {
    /// From key to key, and nothing else; again after each `period` \[s\], if that is not zero.
    pub const fn with_keys(keys: K, period: f32) -> Self {
        Self {
            pivot: Vec3::ZERO,
            axis: Vec3::Y,
            spin: 0.0,
            swing: Vec3::ZERO,
            frequency: 0.0,
            phase: 0.0,
            drift: Vec3::ZERO,
            keys,
            period,
        }
    }

    /// The turns of the spin by an instant, as a rotation.
    fn turned(&self, axis: Vec3, at: Time) -> Mat3 {
        if self.spin == 0.0 || axis == Vec3::ZERO {
            return Mat3::IDENTITY;
        }
        // Rodrigues' formula, column by column.
        let (sin, cos) = sin_cos_turns(at.turns(self.spin));
        let column = |v: Vec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
        Mat3::from_cols(column(Vec3::X), column(Vec3::Y), column(Vec3::Z))
    }
}

impl<K: Keys> Motion<K> {
    /// The transform by which it has moved everything at an instant.
    #[must_use]
    pub fn at(&self, instant: Time) -> Affine {
        self.frame(instant).affine()
    }

    /// Why it cannot be used, if it cannot.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        let vectors = [self.pivot, self.axis, self.swing, self.drift];
        let finite = vectors.iter().all(|v| v.is_finite())
            && [self.spin, self.frequency, self.phase].iter().all(|x| x.is_finite());
        if !finite || self.spin != 0.0 && unit(self.axis) == Vec3::ZERO {
            return Some("its numbers have to be finite, and its axis to have a direction if it turns");
        }
        keys::fault(self.keys.all(), self.period)
    }
}

impl<K: Keys> Script for Motion<K> {
    fn frame(&self, at: Time) -> Frame {
        let (sin, cos) = sin_cos_turns(at.turns(self.frequency) + self.phase);
        let pace = TAU * self.frequency;
        let axis = unit(self.axis);
        let free = Frame {
            turn: self.turned(axis, at),
            pivot: self.pivot,
            place: self.pivot + self.swing * sin + self.drift * at.seconds(),
            velocity: self.swing * (pace * cos) + self.drift,
            acceleration: self.swing * (-pace * pace * sin),
            spin: axis * (TAU * self.spin),
            spin_up: Vec3::ZERO,
            bend: length(self.swing) * pace * pace,
        };
        let keys = self.keys.all();
        if keys.is_empty() { free } else { keys::led(&free, keys, self.period, at) }
    }

    fn is_still(&self) -> bool {
        self.spin == 0.0 && self.swing == Vec3::ZERO && self.drift == Vec3::ZERO && self.keys.is_empty()
    }

    fn drift(&self) -> Vec3 {
        self.drift
    }

    fn reach(&self, bounds: &Aabb) -> Aabb {
        let Aabb { min, max } = *bounds;
        let keys = self.keys.all();
        let turns = self.spin != 0.0 || keys.iter().any(|key| key.rotation != Vec3::ZERO);
        let (min, max) = if turns {
            let corner = high((min - self.pivot).abs(), (max - self.pivot).abs());
            (self.pivot - length(corner), self.pivot + length(corner))
        } else {
            (min, max)
        };
        let swing = self.swing.abs();
        // What goes from key to key never goes beyond both.
        let first = keys.first().map_or(Vec3::ZERO, |key| key.place);
        let places = keys.iter().fold([first; 2], |[least, most], key| [low(least, key.place), high(most, key.place)]);
        let (min, max) = (min - swing + places[0], max + swing + places[1]);
        // Rounding turns and moves by a little; what is endless is everywhere.
        let far = high(low(max.abs(), Vec3::MAX), low(min.abs(), Vec3::MAX)) + self.pivot.abs();
        let room = (far + largest(places[0]) + largest(places[1])) * (16.0 * f32::EPSILON);
        let (min, max) = (min - room, max + room);
        if min.is_nan() || max.is_nan() { EVERYWHERE } else { Aabb { min, max } }
    }
}

impl<K: Default> Default for Motion<K> {
    fn default() -> Self {
        Self::with_keys(K::default(), 0.0)
    }
}
