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
pub struct Grip {
    /// The share of the normal speed that a particle keeps in a hit, 0 to 1.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub elasticity: Option<f32>,
    /// Dry friction.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub friction: Option<Friction>,
}

impl Grip {
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
        let Friction { resting, sliding } = self.friction.unwrap_or(Friction::NONE);
        [("friction.resting", resting), ("friction.sliding", sliding)]
            .into_iter()
            .find(|(_, mu)| !(0.0..f32::INFINITY).contains(mu))
            .map(|(name, mu)| (name, mu, "has to be zero or more"))
    }
}

/// What two things that touch do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Feel {
    pub(crate) elasticity: f32,
    pub(crate) friction: Friction,
}

/// The material with a number, of all.
fn grip(grips: &[Grip], material: Option<u16>) -> Grip {
    material.and_then(|number| grips.get(usize::from(number))).copied().unwrap_or_default()
}

/// A particle of this elasticity and material on a surface of that material.
pub(crate) fn on_surface(grips: &[Grip], elasticity: f32, own: Option<u16>, surface: Option<u16>) -> Feel {
    let surface = grip(grips, surface);
    let elasticity = surface.elasticity.map_or(elasticity, |other| sqrt(elasticity * other));
    Feel { elasticity, friction: friction(grip(grips, own), surface) }
}

/// Two particles with their elasticities and materials.
pub(crate) fn of_two(grips: &[Grip], elasticity: [f32; 2], material: [Option<u16>; 2]) -> Feel {
    let [a, b] = elasticity;
    // Of two that are alike just theirs, to the bit. What is no number bounces nobody.
    let elasticity = if a == b { a } else { sqrt(max(a * b, 0.0)) };
    Feel { elasticity, friction: friction(grip(grips, material[0]), grip(grips, material[1])) }
}

fn friction(a: Grip, b: Grip) -> Friction {
    match (a.friction, b.friction) {
        (Some(a), Some(b)) => Friction { resting: sqrt(a.resting * b.resting), sliding: sqrt(a.sliding * b.sliding) },
        (a, b) => a.or(b).unwrap_or(Friction::NONE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_that_says_nothing_leaves_it_to_the_other() {
        let rubber = Friction { resting: 0.9, sliding: 0.8 };
        let ice = Friction { resting: 0.1, sliding: 0.05 };
        let feel = |friction| Grip { elasticity: None, friction };
        let grips = [feel(Some(rubber)), feel(Some(ice)), feel(None), Grip { elasticity: Some(0.4), friction: None }];
        let on = |own, surface| on_surface(&grips, 0.9, own, surface);
        assert_eq!(on(None, None), Feel { elasticity: 0.9, friction: Friction::NONE });
        assert_eq!(on(Some(0), Some(2)).friction, rubber);
        assert_eq!(on(Some(7), Some(1)).friction, ice);
        assert!((on(Some(0), Some(1)).friction.resting - 0.3).abs() < 1e-6);
        assert!((on(None, Some(3)).elasticity - 0.6).abs() < 1e-6);
        assert_eq!(of_two(&grips, [0.9, 0.9], [None, None]).elasticity, 0.9);
        assert!((of_two(&grips, [0.9, 0.4], [None, Some(0)]).elasticity - 0.6).abs() < 1e-6);
    }
}
