//! Dry friction, for whatever makes contacts.

use crate::math::{length, scaled};
use glam::Vec3;

/// Coulomb's law of dry friction between two surfaces: it holds what slides up to a share of what presses them together.
///
/// It is a law alone: contacts ask it, once for each, with what they know.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Friction {
    /// The static coefficient: the share of the pressing force up to which a particle at rest stays so.
    #[cfg_attr(feature = "serde", serde(rename = "static", alias = "resting"))]
    pub static_: f32,
    /// The dynamic coefficient, usually the smaller one: the share of the pressing force that holds a particle which
    /// slides.
    #[cfg_attr(feature = "serde", serde(alias = "sliding"))]
    pub kinetic: f32,
}

impl Friction {
    /// No friction.
    pub const NONE: Self = Self { static_: 0.0, kinetic: 0.0 };

    /// The change of velocity \[m/s\] by which friction answers a `slip` along the surface \[m/s\] while the surface gives a
    /// change of velocity of `press` along its normal \[m/s\]: it takes all of the slip if it can, never more, and never
    /// turns it round.
    #[must_use]
    pub fn answer(&self, slip: Vec3, press: f32) -> Vec3 {
        let speed = length(slip);
        if !(speed > 0.0 && press > 0.0) {
            return Vec3::ZERO;
        }
        let held = self.kinetic * press;
        if speed <= self.static_ * press || speed <= held { -slip } else { scaled(slip, -held / speed) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_holds_slows_and_never_drives() {
        let ice = Friction { static_: 0.5, kinetic: 0.3 };
        let slip = Vec3::new(3.0, 0.0, 4.0);
        assert_eq!(ice.answer(slip, 10.1), -slip);
        assert_eq!(ice.answer(slip, 10.0), -slip);
        assert!((ice.answer(slip, 9.9) + slip * (0.3 * 9.9 / 5.0)).length() < 1e-6);
        for press in [0.0, -1.0, f32::NAN] {
            assert_eq!(ice.answer(slip, press), Vec3::ZERO);
        }
        for friction in [Friction::NONE, ice, Friction { static_: 0.1, kinetic: 9.0 }] {
            for i in 0..100 {
                let after = slip + friction.answer(slip, i as f32 * 0.2);
                assert!(after.dot(slip) >= 0.0 && after.length() <= slip.length());
            }
        }
    }
}
