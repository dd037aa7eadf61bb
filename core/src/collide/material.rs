//! How materials feel to what touches them.

use crate::force::Friction;
use crate::math::{max, sqrt};

/// How a material feels to what touches it.
///
/// Where two things touch, the coefficients that count are the geometric means of theirs; a side that says nothing
/// leaves it to the other, and where neither does there is no friction. A particle always has an elasticity of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContactMaterial {
    /// The share of the normal speed that a particle keeps in a hit, 0 to 1.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub elasticity: Option<f32>,
    /// Dry friction.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub friction: Option<Friction>,
}

impl ContactMaterial {
    /// Whether it says nothing.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        *self == Self::default()
    }

    /// Whether its numbers can be used: an elasticity from 0 to 1, coefficients of friction from 0 on.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.fault().is_none()
    }

    /// The first number that cannot be used: which, what it is, and what it has to be.
    pub(crate) fn fault(&self) -> Option<(&'static str, f32, &'static str)> {
        let elasticity = self.elasticity.unwrap_or(0.0);
        if !(0.0..=1.0).contains(&elasticity) {
            return Some(("elasticity", elasticity, "has to be from 0 to 1"));
        }
        let Friction { static_, kinetic } = self.friction.unwrap_or(Friction::NONE);
        [("friction.static", static_), ("friction.kinetic", kinetic)]
            .into_iter()
            .find(|(_, mu)| !(0.0..f32::INFINITY).contains(mu))
            .map(|(name, mu)| (name, mu, "has to be zero or more"))
    }
}

/// What two things that touch do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mixed {
    pub(crate) elasticity: f32,
    pub(crate) friction: Friction,
}

/// The material with a number, of all.
fn of(contact_materials: &[ContactMaterial], material: Option<u16>) -> ContactMaterial {
    material.and_then(|number| contact_materials.get(usize::from(number))).copied().unwrap_or_default()
}

/// A particle of this elasticity and material on a surface of that material.
pub(crate) fn on_surface(
    contact_materials: &[ContactMaterial],
    elasticity: f32,
    own: Option<u16>,
    surface: Option<u16>,
) -> Mixed {
    let surface = of(contact_materials, surface);
    let elasticity = surface.elasticity.map_or(elasticity, |other| sqrt(elasticity * other));
    Mixed { elasticity, friction: friction(of(contact_materials, own), surface) }
}

/// Two particles with their elasticities and materials.
pub(crate) fn of_two(contact_materials: &[ContactMaterial], elasticity: [f32; 2], material: [Option<u16>; 2]) -> Mixed {
    let [a, b] = elasticity;
    // Of two that are alike just theirs, to the bit. What is no number bounces nobody.
    let elasticity = if a == b { a } else { sqrt(max(a * b, 0.0)) };
    Mixed { elasticity, friction: friction(of(contact_materials, material[0]), of(contact_materials, material[1])) }
}

fn friction(a: ContactMaterial, b: ContactMaterial) -> Friction {
    match (a.friction, b.friction) {
        (Some(a), Some(b)) => Friction { static_: sqrt(a.static_ * b.static_), kinetic: sqrt(a.kinetic * b.kinetic) },
        (a, b) => a.or(b).unwrap_or(Friction::NONE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_that_says_nothing_leaves_it_to_the_other() {
        let rubber = Friction { static_: 0.9, kinetic: 0.8 };
        let ice = Friction { static_: 0.1, kinetic: 0.05 };
        let mixed = |friction| ContactMaterial { elasticity: None, friction };
        let contact_materials = [
            mixed(Some(rubber)),
            mixed(Some(ice)),
            mixed(None),
            ContactMaterial { elasticity: Some(0.4), friction: None },
        ];
        let on = |own, surface| on_surface(&contact_materials, 0.9, own, surface);
        assert_eq!(on(None, None), Mixed { elasticity: 0.9, friction: Friction::NONE });
        assert_eq!(on(Some(0), Some(2)).friction, rubber);
        assert_eq!(on(Some(7), Some(1)).friction, ice);
        assert!((on(Some(0), Some(1)).friction.static_ - 0.3).abs() < 1e-6);
        assert!((on(None, Some(3)).elasticity - 0.6).abs() < 1e-6);
        assert_eq!(of_two(&contact_materials, [0.9, 0.9], [None, None]).elasticity, 0.9);
        assert!((of_two(&contact_materials, [0.9, 0.4], [None, Some(0)]).elasticity - 0.6).abs() < 1e-6);
    }
}
