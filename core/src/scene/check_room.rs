//! Checks that what is in a room whose opposite faces are one can be in it.

use super::numbers::{Checked, finite, zero_or_more};
use super::{PeriodicRoom, SceneError, SceneFile};
use crate::constrain::ConstraintKind;
use crate::force::{Force, ForceKind, Spring};
use crate::math::max;
use alloc::format;
use alloc::string::String;

impl SceneFile {
    /// Checks that a room can be what it is to be, and that nothing in it acts as if it had no sides.
    pub(super) fn check_room(&self) -> Checked {
        let Some(PeriodicRoom { low, sides }) = self.room else { return Ok(()) };
        finite("room.low", &low)?;
        sides.iter().try_for_each(|&side| zero_or_more("room.sides", side))?;
        if sides == [0.0; 3] {
            return Err(SceneError::value("room.sides", "are all zero: leave the room out, or give it a side"));
        }
        if let Some((at, what)) = self.straight() {
            return Err(SceneError::value(at, format!("{what} cannot act through the sides of the scene's room")));
        }
        Ok(())
    }

    /// Checks that of two particles within `reach` \[m\] of each other one way is the shortest.
    pub(super) fn check_reach(&self, forces: &dyn Force) -> Checked {
        let (reach, half) = (forces.needs().reach, self.room.map_or(f32::INFINITY, |room| room.room().half()));
        if reach < half {
            return Ok(());
        }
        let message = format!("are too short: forces reach {reach} m, and have to reach less than half of each side");
        Err(SceneError::value("room.sides", message))
    }

    /// Checks that what keeps particles at distances, and balls as wide as so much \[m\], find one way the shortest.
    pub(super) fn check_lengths(&self, widest: f32) -> Checked {
        let Some(half) = self.room.map(|room| room.room().half()) else { return Ok(()) };
        if self.contacts.is_some() && !(2.0 * widest < half) {
            let message =
                format!("are too short: balls are {} m wide, and have to be less than half of each side", 2.0 * widest);
            return Err(SceneError::value("room.sides", message));
        }
        let bound =
            |of: &ConstraintKind| of.links().zip(of.lengths()).fold(0.0, |longest, (_, length)| max(longest, length));
        let constraints = self.constraints.iter().enumerate().map(|(i, one)| ("constraints", i, bound(one)));
        let longest =
            |spring: &Spring| spring.rest_length * (1.0 + spring.drive.map_or(0.0, |drive| drive.amplitude.abs()));
        let springs = self.springs.iter().enumerate().map(|(i, spring)| ("springs", i, longest(spring)));
        for (name, i, length) in constraints.chain(springs) {
            if !(length < half) {
                let message = format!(
                    "keeps particles {length} m apart: in the scene's room that has to be less than half of each side"
                );
                return Err(SceneError::value(format!("{name}[{i}]"), message));
            }
        }
        Ok(())
    }

    /// The first part of the scene that acts along straight ways alone.
    fn straight(&self) -> Option<(String, &'static str)> {
        let far = |force: &ForceKind| match force {
            ForceKind::MutualGravity(_) => Some("a force that reaches any distance (a power_law has a reach)"),
            ForceKind::Coulomb(_) => {
                Some("a force that reaches any distance (a power_law between charges has a reach)")
            }
            ForceKind::Pressure(_) | ForceKind::Aerodynamics(_) => Some("surfaces of particles"),
            ForceKind::CylinderDrag(_) => Some("segments between particles"),
            _ => None,
        };
        let force = self.forces.iter().enumerate().find_map(|(i, force)| Some((format!("forces[{i}]"), far(force)?)));
        let part = |name: &str, is_empty: bool, what| (!is_empty).then(|| (format!("{name}[0]"), what));
        let mut constraints = self.constraints.iter().enumerate();
        let constraint = constraints.find_map(|(i, one)| Some((format!("constraints[{i}]"), one.straight()?)));
        force
            .or(constraint)
            .or(part("cloths", self.cloths.is_empty(), "surfaces of particles"))
            .or(part("boxes", self.boxes.is_empty(), "rigid bodies"))
            .or(part("strands", self.strands.is_empty(), "strands"))
            .or(part("soft_bodies", self.soft_bodies.is_empty(), "clusters"))
            .or(part("ropes", self.ropes.is_empty(), "ropes of their own (a rope among the constraints can)"))
    }
}
