//! Checks of a declared scene's forces.

use super::numbers::{Checked, above_zero, check_direction, finite, zero_or_more};
use super::{SceneError, SceneFile};
use crate::force::{FlowKind, ForceKind, PowerLaw};
use alloc::format;

/// The largest exponent of a power law.
const MAX_EXPONENT: u8 = 12;

/// The longest softening: its square has to be a number.
const MAX_LENGTH: f32 = 1e18;

impl SceneFile {
    /// Checks that the corners of closed meshes are among `count` particles of the start.
    pub(super) fn check_corners(&self, count: usize) -> Checked {
        for (i, constraint) in self.constraints.iter().enumerate() {
            if let Some(end) = constraint.ends().find(|&&end| end as usize >= count) {
                let message = format!("particle {end} is out of range; there are {count}, from 0");
                return Err(SceneError::value(format!("constraints[{i}]"), message));
            }
        }
        for (i, force) in self.forces.iter().enumerate() {
            let (name, size, corners) = match force {
                ForceKind::Pressure(pressure) => ("triangles", 3, pressure.triangles.as_flattened()),
                ForceKind::Aerodynamics(air) => ("triangles", 3, air.triangles.as_flattened()),
                ForceKind::CylinderDrag(air) => ("segments", 2, air.segments.as_flattened()),
                _ => continue,
            };
            if let Some((k, corner)) = corners.iter().enumerate().find(|&(_, &corner)| corner as usize >= count) {
                let message = format!("particle {corner} is out of range; there are {count}, from 0");
                return Err(SceneError::value(format!("forces[{i}].{name}[{}]", k / size), message));
            }
        }
        Ok(())
    }
}

/// The names in recordings of the engine's own attributes.
const OWN: &str = "step time id x y z vx vy vz mass age radius remaining fixed drag charge elasticity material red green \
    blue alpha color velocity transparency species pos velo faces edges";

impl SceneFile {
    /// Checks columns of a user's own, and that forces name those that are there.
    pub(super) fn check_custom(&self) -> Checked {
        let is_word = |name: &str| {
            let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
            name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(letters)
        };
        for (i, custom) in self.custom.iter().enumerate() {
            let (at, name) = (format!("custom[{i}]"), &custom.name);
            let refuse = |message| Err(SceneError::value(format!("{at}.name"), message));
            if !is_word(name) {
                return refuse(format!(
                    "has to begin with a letter and go on with letters, digits and _, not \"{name}\""
                ));
            }
            if OWN.split(' ').any(|own| own == name) || self.custom[..i].iter().any(|other| other.name == *name) {
                return refuse(format!("there is a \"{name}\" already: choose another name"));
            }
            finite(&format!("{at}.newborn"), &[custom.newborn])?;
            finite(&format!("{at}.start"), &custom.start)?;
        }
        for (i, force) in self.forces.iter().enumerate() {
            let ForceKind::Relaxation(relaxation) = force else { continue };
            if !self.custom.iter().any(|custom| custom.name == relaxation.column) {
                let message = format!("there is no \"{}\" in the scene's list `custom`", relaxation.column);
                return Err(SceneError::value(format!("forces[{i}].column"), message));
            }
        }
        Ok(())
    }
}

/// Checks the numbers of a force.
pub(super) fn check_force(at: &str, force: &ForceKind) -> Checked {
    let name = |name: &str| format!("{at}.{name}");
    match force {
        ForceKind::Gravity(g) => finite(&name("acceleration"), &g.acceleration.to_array()),
        ForceKind::Drag(_) => Ok(()),
        ForceKind::MutualGravity(m) => {
            finite(&name("constant"), &[m.constant])?;
            length(&name("softening"), m.softening)?;
            zero_or_more(&name("theta"), m.theta)
        }
        ForceKind::QuadraticDrag(d) => zero_or_more(&name("coefficient"), d.coefficient),
        ForceKind::Coulomb(c) => finite(&name("constant"), &[c.constant])
            .and_then(|()| length(&name("softening"), c.softening))
            .and_then(|()| zero_or_more(&name("theta"), c.theta)),
        ForceKind::Wind(wind) => {
            zero_or_more(&name("coefficient"), wind.coefficient.unwrap_or(0.0))?;
            check_flows(&name, &wind.field)
        }
        ForceKind::Aerodynamics(air) => {
            let numbers =
                [("density", air.density), ("drag", air.drag), ("lift", air.lift), ("friction", air.friction)];
            numbers.into_iter().try_for_each(|(field, number)| zero_or_more(&name(field), number))?;
            check_flows(&name, &air.field)
        }
        ForceKind::CylinderDrag(air) => {
            above_zero(&name("diameter"), air.diameter)?;
            let numbers = [("density", air.density), ("viscosity", air.viscosity), ("friction", air.friction)];
            numbers.into_iter().try_for_each(|(field, number)| zero_or_more(&name(field), number))?;
            check_flows(&name, &air.field)
        }
        ForceKind::LennardJones(law) => finite(&name("epsilon"), &[law.0.epsilon])
            .and_then(|()| above_zero(&name("sigma"), law.0.sigma))
            .and_then(|()| reach(&name("cutoff"), law.0.cutoff)),
        ForceKind::PowerLaw(law) => check_power(&name, &law.0),
        ForceKind::Viscosity(v) => {
            zero_or_more(&name("coefficient"), v.coefficient)?;
            reach(&name("reach"), v.reach)
        }
        ForceKind::Relaxation(relaxation) => {
            finite(&name("toward"), &[relaxation.toward])?;
            zero_or_more(&name("rate"), relaxation.rate)
        }
        ForceKind::Pressure(pressure) => {
            zero_or_more(&name("amount"), pressure.amount)?;
            finite(&name("outside"), &[pressure.outside])
        }
    }
}

fn length(at: &str, length: f32) -> Checked {
    zero_or_more(at, length)?;
    if length <= MAX_LENGTH {
        return Ok(());
    }
    Err(SceneError::value(at, format!("has to be {MAX_LENGTH:e} m at most, not {length:e}")))
}

fn reach(at: &str, reach: f32) -> Checked {
    above_zero(at, reach)?;
    length(at, reach)
}

fn check_power(name: &dyn Fn(&str) -> alloc::string::String, law: &PowerLaw) -> Checked {
    finite(&name("strength"), &[law.strength])?;
    if law.exponent > MAX_EXPONENT {
        let message = format!("has to be from 0 to {MAX_EXPONENT}, not {}", law.exponent);
        return Err(SceneError::value(name("exponent"), message));
    }
    length(&name("softening"), law.softening)?;
    reach(&name("reach"), law.reach)
}

fn check_flows(name: &dyn Fn(&str) -> alloc::string::String, flows: &[FlowKind]) -> Checked {
    let mut flows = flows.iter().enumerate();
    flows.try_for_each(|(i, flow)| check_flow(&name(&format!("field[{i}]")), flow))
}

fn check_flow(at: &str, flow: &FlowKind) -> Checked {
    match flow {
        FlowKind::Uniform(flow) => finite(&format!("{at}.velocity"), &flow.velocity.to_array()),
        FlowKind::Gusts(flow) => {
            finite(&format!("{at}.velocity"), &flow.velocity.to_array())?;
            finite(&format!("{at}.amplitude"), &[flow.amplitude])?;
            zero_or_more(&format!("{at}.frequency"), flow.frequency)
        }
        FlowKind::Vortex(flow) => {
            finite(&format!("{at}.center"), &flow.center.to_array())?;
            check_direction(&format!("{at}.axis"), flow.axis)?;
            finite(&format!("{at}.speed"), &[flow.speed])?;
            above_zero(&format!("{at}.core"), flow.core)
        }
        FlowKind::Curl(flow) => {
            finite(&format!("{at}.speed"), &[flow.speed])?;
            finite(&format!("{at}.drift"), &flow.drift.to_array())?;
            above_zero(&format!("{at}.scale"), flow.scale)
        }
    }
}
