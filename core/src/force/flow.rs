//! How air moves: a velocity at every place and instant.

use crate::composed::stands_for;
use crate::math::{sin_cos_turns, unit};
use crate::time::Time;
use glam::Vec3;

/// A field of velocities.
///
/// A tuple, slice, reference or box of flows is a flow: their sum.
pub trait Flow: Sync {
    /// The velocity at a place and an instant \[m/s\]. It has to be the same bits on every target: see
    /// [`math`](crate::math).
    fn velocity(&self, place: Vec3, time: Time) -> Vec3;

    /// The velocity at an instant if it is the same everywhere, so that it is worked out once for all.
    fn everywhere(&self, time: Time) -> Option<Vec3> {
        let _ = time;
        None
    }
}

/// The same velocity everywhere and always.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Uniform {
    /// It \[m/s\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
}

impl Flow for Uniform {
    fn velocity(&self, _: Vec3, _: Time) -> Vec3 {
        self.velocity
    }
    fn everywhere(&self, _: Time) -> Option<Vec3> {
        Some(self.velocity)
    }
}

/// The same velocity everywhere, whose strength swings: w = velocity × (1 + amplitude g(t)), with g from −1 to 1 the sum of
/// 0.5, 0.3 and 0.2 times three sines, of the frequency, (1 + √5)/2 times it and √7 times it, so that it never repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gusts {
    /// The mean velocity \[m/s\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// As a share of it: below 1 it never turns round.
    pub amplitude: f32,
    /// Gusts per second \[Hz\].
    pub frequency: f32,
}

impl Flow for Gusts {
    fn velocity(&self, _: Vec3, time: Time) -> Vec3 {
        let swing = |ratio: f32| sin_cos_turns(time.turns(self.frequency * ratio)).0;
        let g = 0.5 * swing(1.0) + 0.3 * swing(1.618_034) + 0.2 * swing(2.645_751_3);
        self.velocity * (1.0 + self.amplitude * g)
    }
    fn everywhere(&self, time: Time) -> Option<Vec3> {
        Some(self.velocity(Vec3::ZERO, time))
    }
}

/// A whirl about an axis: |w| = 2 speed (r/core) / (1 + (r/core)²), r being the distance from the axis, anticlockwise seen
/// from where the axis points (Scully 1975; n = 1 of Vatistas, "A Simpler Model for Concentrated Vortices", 1991).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Vortex {
    /// A point on the axis \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub center: Vec3,
    /// The axis's direction.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub axis: Vec3,
    /// The greatest speed \[m/s\], that at the core's radius; below zero it turns the other way.
    pub speed: f32,
    /// The core's radius \[m\].
    pub core: f32,
}

impl Flow for Vortex {
    fn velocity(&self, place: Vec3, _: Time) -> Vec3 {
        let round = unit(self.axis).cross(place - self.center);
        let square = self.core * self.core + round.dot(round);
        if square > 0.0 { round * (2.0 * self.speed * self.core / square) } else { Vec3::ZERO }
    }
}

impl Flow for () {
    fn velocity(&self, _: Vec3, _: Time) -> Vec3 {
        Vec3::ZERO
    }
    fn everywhere(&self, _: Time) -> Option<Vec3> {
        Some(Vec3::ZERO)
    }
}

stands_for! {
    Flow {
        fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
            (**self).velocity(place, time)
        }
        fn everywhere(&self, time: Time) -> Option<Vec3> {
            (**self).everywhere(time)
        }
    }
}

impl<T: Flow> Flow for [T] {
    fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
        self.iter().fold(Vec3::ZERO, |sum, flow| sum + flow.velocity(place, time))
    }
    fn everywhere(&self, time: Time) -> Option<Vec3> {
        self.iter().try_fold(Vec3::ZERO, |sum, flow| Some(sum + flow.everywhere(time)?))
    }
}

/// Makes a list of flows a flow: their sum.
macro_rules! lists {
    ($($(#[$meta:meta])* [$($parameter:tt)*] $list:ty;)+) => {$(
        $(#[$meta])*
        impl<T: Flow, $($parameter)*> Flow for $list {
            fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
                self[..].velocity(place, time)
            }
            fn everywhere(&self, time: Time) -> Option<Vec3> {
                self[..].everywhere(time)
            }
        }
    )+};
}
lists! {
    [const N: usize] [T; N];
    [const N: usize] heapless::Vec<T, N>;
    #[cfg(feature = "alloc")]
    [] alloc::vec::Vec<T>;
}

macro_rules! tuples {
    ($($name:ident)+) => {
        #[allow(non_snake_case)]
        impl<$($name: Flow),+> Flow for ($($name,)+) {
            fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
                let ($($name,)+) = self;
                Vec3::ZERO $(+ $name.velocity(place, time))+
            }
            fn everywhere(&self, time: Time) -> Option<Vec3> {
                let ($($name,)+) = self;
                Some(Vec3::ZERO $(+ $name.everywhere(time)?)+)
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
