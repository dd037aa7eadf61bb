//! Numbers and directions that vary from birth to birth.

use crate::math::{along, frame, max, scaled, sin_cos, sin_cos_turns, sqrt};
use crate::rng::Stream;
use glam::Vec3;

/// A number that varies: its mean, and how far it may be from that, evenly on both sides (Reeves, "Particle Systems",
/// SIGGRAPH 1983).
///
/// In a file a plain number, or `{"mean": 2, "half_width": 0.5}` for 1.5 to 2.5.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(into = "Number"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(with = "Number"))]
pub struct Varied {
    /// The middle.
    pub mean: f32,
    /// The largest difference from it.
    pub half_width: f32,
}

/// The directions in which births may leave, about the surface's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Spread {
    /// Uniform in solid angle within this angle \[rad\], 0 to π: cos α = 1 − u (1 − cos c).
    Uniform(f32),
    /// The lecture's recipe with this cutoff \[rad\]: sin α uniform in [0, sin c). It favours the middle, and beyond a
    /// right angle it folds back.
    Lecture(f32),
}

impl Varied {
    /// Always `mean`.
    #[must_use]
    pub const fn exactly(mean: f32) -> Self {
        Self { mean, half_width: 0.0 }
    }

    /// Uniform from mean − half_width to mean + half_width, as a number uniform in [0, 1) picks.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn pick(self, u: f32) -> f32 {
        if self.half_width == 0.0 { self.mean } else { self.mean + self.half_width * (2.0 * u - 1.0) }
    }

    /// The same by one of a pair of random numbers, which are drawn only if there is a half-width.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn draw(self, random: Stream, place: u32, which: usize) -> f32 {
        if self.half_width == 0.0 { self.mean } else { self.pick(random.units(place)[which]) }
    }
}

impl Spread {
    /// The direction about the unit vector `axis` that two numbers uniform in [0, 1) pick.
    #[must_use]
    pub fn direction(self, axis: Vec3, numbers: [f32; 2]) -> Vec3 {
        self.aim().direction(axis, numbers)
    }

    /// The same for whoever picks many.
    pub(super) fn aim(self) -> Aim {
        match self {
            Self::Uniform(0.0) | Self::Lecture(0.0) => Aim::Straight,
            Self::Uniform(cutoff) => Aim::Uniform { half: sin_cos(0.5 * cutoff).0 },
            Self::Lecture(cutoff) => Aim::Lecture { sin: sin_cos(cutoff).0 },
        }
    }
}

/// A spread, with what all its directions have in common.
#[derive(Clone, Copy)]
pub(super) enum Aim {
    Straight,
    /// Uniform in solid angle within a cutoff; the sine of half of it.
    Uniform {
        half: f32,
    },
    /// The lecture's, with the sine of its cutoff.
    Lecture {
        sin: f32,
    },
}

impl Aim {
    /// As [`Spread::direction`] has it.
    pub(super) fn direction(self, axis: Vec3, [u, v]: [f32; 2]) -> Vec3 {
        let (sin, cos) = match self {
            Self::Straight => return axis,
            Self::Uniform { half } => {
                // 1 − cos c = 2 sin²(c/2) keeps the digits of small angles.
                let drop = u * 2.0 * half * half;
                (sqrt(max(drop * (2.0 - drop), 0.0)), 1.0 - drop)
            }
            Self::Lecture { sin } => {
                let sin = u * sin;
                (sin, sqrt(max(1.0 - sin * sin, 0.0)))
            }
        };
        let (a, b) = frame(axis);
        let (along_b, along_a) = sin_cos_turns(v);
        along(scaled(axis, cos), along(scaled(a, along_a), b, along_b), sin)
    }
}

/// How a varied number is written.
#[cfg(feature = "serde")]
#[derive(serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum Number {
    Plain(f32),
    Varied(Range),
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct Range {
    mean: f32,
    #[serde(alias = "variance")]
    half_width: f32,
}

#[cfg(feature = "serde")]
impl From<Varied> for Number {
    fn from(Varied { mean, half_width }: Varied) -> Self {
        if half_width == 0.0 { Self::Plain(mean) } else { Self::Varied(Range { mean, half_width }) }
    }
}

/// By hand, so that errors say what is wrong with the range instead of that it is none.
#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Varied {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrRange)
    }
}

#[cfg(feature = "serde")]
struct NumberOrRange;

#[cfg(feature = "serde")]
impl<'de> serde::de::Visitor<'de> for NumberOrRange {
    type Value = Varied;

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("a number, or {\"mean\": ..., \"half_width\": ...}")
    }

    fn visit_f64<E>(self, mean: f64) -> Result<Varied, E> {
        Ok(Varied::exactly(mean as f32))
    }

    fn visit_i64<E>(self, mean: i64) -> Result<Varied, E> {
        Ok(Varied::exactly(mean as f32))
    }

    fn visit_u64<E>(self, mean: u64) -> Result<Varied, E> {
        Ok(Varied::exactly(mean as f32))
    }

    fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Varied, A::Error> {
        let range = serde::de::value::MapAccessDeserializer::new(map);
        let Range { mean, half_width } = serde::Deserialize::deserialize(range)?;
        Ok(Varied { mean, half_width })
    }
}
