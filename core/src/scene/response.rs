//! The ways in which particles answer each other, by name.

use crate::collide::Meetings;
use crate::constrain::Contacts;
use crate::force::Penalty;

/// How particles that have a radius answer each other's touch, as files and the command line say it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Response {
    /// By impulses when they meet: for gases, billiards, cradles.
    Impulse {},
    /// By a force while they overlap: for study.
    Force(Penalty),
    /// By position in sub-steps: for heaps.
    Position(Position),
}

/// Contacts held by position, see [`Contacts`], and the sub-steps that they ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Position {
    /// Sub-steps of a step, 1 to 1000.
    pub substeps: u32,
    /// How far a contact gives way to a force \[m/N\]: zero is hard.
    pub compliance: f32,
}

impl Default for Position {
    fn default() -> Self {
        Self { substeps: 12, compliance: 0.0 }
    }
}

impl Response {
    /// The names of all.
    pub const NAMES: [&'static str; 3] = ["impulse", "force", "position"];

    /// Its name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Impulse {} => "impulse",
            Self::Force(_) => "force",
            Self::Position(_) => "position",
        }
    }

    /// That of a name with settings that suit steps of `dt` \[s\] and a lightest particle of `mass` \[kg\]: a force is as stiff
    /// as lets a hit of two such last eight steps.
    #[must_use]
    pub fn by_name(name: &str, dt: f32, mass: f32) -> Option<Self> {
        let frequency = core::f32::consts::PI / (8.0 * dt);
        let penalty = Penalty { stiffness: 0.5 * mass * frequency * frequency, damping: 0.1, ..Penalty::NONE };
        [Self::Impulse {}, Self::Force(penalty), Self::Position(Position::default())]
            .into_iter()
            .find(|response| response.name() == name)
    }

    /// The first of its settings that is wrong, and what that has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let positive = |x: f32| x > 0.0 && x < f32::INFINITY;
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        match self {
            Self::Impulse {} => None,
            Self::Force(Penalty { stiffness, .. }) if !positive(*stiffness) => {
                Some(("force.stiffness", "has to be above zero, in N/m"))
            }
            Self::Force(Penalty { damping, .. }) if !not_negative(*damping) => {
                Some(("force.damping", "must not be below zero"))
            }
            Self::Force(Penalty { reach, .. }) if !not_negative(*reach) => {
                Some(("force.reach", "must not be below zero, in m"))
            }
            Self::Force(Penalty { friction, .. }) => {
                let sound = not_negative(friction.static_) && not_negative(friction.kinetic);
                (!sound).then_some(("force.friction", "takes coefficients from 0 on"))
            }
            Self::Position(Position { substeps, .. }) if !(1..=1000).contains(substeps) => {
                Some(("position.substeps", "has to be from 1 to 1000"))
            }
            Self::Position(Position { compliance, .. }) => {
                (!not_negative(*compliance)).then_some(("position.compliance", "must not be below zero, in m/N"))
            }
        }
    }

    /// The contacts that hold them apart by position, if that is how they answer.
    #[must_use]
    pub fn contacts(&self) -> Option<Contacts> {
        match *self {
            Self::Position(Position { compliance, .. }) => Some(Contacts { compliance }),
            _ => None,
        }
    }

    /// The force between them, if that is how they answer.
    #[must_use]
    pub fn force(&self) -> Option<Penalty> {
        match *self {
            Self::Force(penalty) => Some(penalty),
            _ => None,
        }
    }

    /// The sub-steps that it asks for.
    #[must_use]
    pub fn substeps(&self) -> u32 {
        match *self {
            Self::Position(Position { substeps, .. }) => substeps,
            _ => 1,
        }
    }

    /// The answer of balls whose paths meet.
    #[must_use]
    pub fn meetings(&self) -> Meetings {
        match self {
            Self::Impulse {} => Meetings::IMPULSE,
            _ => Meetings::Through,
        }
    }
}
