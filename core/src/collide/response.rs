//! The ways in which particles answer each other, by name.

use super::contacts::{Contacts, Passage, Stage};
use super::{Impulse, Projection};
use crate::force::Penalty;
use crate::index::Arrange;
use glam::Vec3;

/// How particles that have a radius answer each other's touch, as files and the command line say it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Response {
    /// By impulses when they meet: for gases, billiards, cradles.
    Impulse(Impulse),
    /// By a force while they overlap: for study.
    Force(Penalty),
    /// By position in sub-steps: for heaps.
    Position(Projection),
}

impl Response {
    /// The names of all.
    pub const NAMES: [&'static str; 3] = ["impulse", "force", "position"];

    /// Its name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Impulse(_) => "impulse",
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
        [Self::Impulse(Impulse {}), Self::Force(penalty), Self::Position(Projection::default())]
            .into_iter()
            .find(|response| response.name() == name)
    }

    /// What is wrong with its settings: which, and what they have to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let positive = |x: f32| x > 0.0 && x < f32::INFINITY;
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        match self {
            Self::Impulse(_) => None,
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
                let sound = not_negative(friction.resting) && not_negative(friction.sliding);
                (!sound).then_some(("force.friction", "takes coefficients from 0 on"))
            }
            Self::Position(Projection { substeps, .. }) if !(1..=1000).contains(substeps) => {
                Some(("position.substeps", "has to be from 1 to 1000"))
            }
            Self::Position(Projection { compliance, .. }) => {
                (!not_negative(*compliance)).then_some(("position.compliance", "must not be below zero, in m/N"))
            }
        }
    }

    /// What moves particles, if it is not a force.
    fn contacts(&self) -> &dyn Contacts {
        match self {
            Self::Impulse(impulse) => impulse,
            Self::Force(_) => &(),
            Self::Position(projection) => projection,
        }
    }
}

impl Contacts for Response {
    fn is_empty(&self) -> bool {
        self.contacts().is_empty()
    }
    fn held(&self, index: &dyn Arrange) -> usize {
        self.contacts().held(index)
    }
    fn scratch(&self, index: &dyn Arrange) -> usize {
        self.contacts().scratch(index)
    }
    fn substeps(&self) -> u32 {
        self.contacts().substeps()
    }
    fn gather(&self, stage: &mut Stage<'_>, scratch: &mut [u32]) {
        self.contacts().gather(stage, scratch);
    }
    fn begin<'h>(&self, held: &'h mut [Vec3], position: &[Vec3], velocity: &[Vec3]) -> Option<[&'h [Vec3]; 2]> {
        self.contacts().begin(held, position, velocity)
    }
    fn project(&self, stage: &mut Stage<'_>) {
        self.contacts().project(stage);
    }
    fn has_moved(&self, held: &[Vec3], row: usize) -> bool {
        self.contacts().has_moved(held, row)
    }
    fn follow(&self, passage: Passage<'_, '_>) {
        self.contacts().follow(passage);
    }
}
