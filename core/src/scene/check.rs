//! Checks of a declared scene: every number is finite, every reference is to something that is there.

use super::check_force::check_force;
use super::check_shape::check_shape;
use super::numbers::{Checked, above_zero, check_breaking, check_direction, finite, zero_or_more};
use super::references::MAX_GROUPS;
use super::remarks::MOST_SUBSTEPS;
use super::{Boxes, Cord, SceneError, SceneFile};
use crate::constrain::ConstraintKind;
use crate::emit::{Emitter, Spread, Varied, WhereSparse};
use crate::force::Spring;
use crate::motion::{Motion, MotionBuf};
use crate::particles::Particle;
use crate::reap::ReaperKind;
use crate::shape::Shape;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use glam::Vec3;

/// The largest number of births a second: rates are kept as fixed-point numbers.
const MAX_RATE: f32 = 4e9;

impl SceneFile {
    /// Checks every value.
    ///
    /// # Errors
    /// The first that cannot be used, by its path in the file.
    pub fn check(&self) -> Checked {
        self.check_run()?;
        for (i, particle) in self.particles.iter().enumerate() {
            let at = format!("particles[{i}]");
            check_particle(&at, particle)?;
            self.check_material(&at, particle.material)?;
        }
        if let Some((at, message)) = self.contacts.and_then(|response| response.fault()) {
            return Err(SceneError::value(format!("contacts.{at}"), message));
        }
        for (i, constraint) in self.constraints.iter().enumerate() {
            if let Some((at, message)) = constraint.fault() {
                let kind = if let ConstraintKind::TiedRope(_) = constraint { "tied_rope" } else { constraint.name() };
                return Err(SceneError::value(format!("constraints[{i}].{kind}.{at}"), message));
            }
        }
        for (i, spring) in self.springs.iter().enumerate() {
            self.check_spring(&format!("springs[{i}]"), spring)?;
        }
        self.check_fabrics()?;
        self.check_boxes()?;
        self.check_strands()?;
        self.check_ropes()?;
        self.check_soft_bodies()?;
        for (i, emitter) in self.emitters.iter().enumerate() {
            self.check_emitter(&format!("emitters[{i}]"), emitter)?;
            self.check_group(&format!("emitters[{i}]"), emitter.group)?;
        }
        for (i, sink) in self.sinks.iter().enumerate() {
            finite(&format!("sinks[{i}]"), &[sink.intensity, sink.ca, sink.la, sink.qa])?;
            zero_or_more(&format!("sinks[{i}].softening"), sink.softening)?;
            check_shape(&format!("sinks[{i}].shape"), &sink.shape)?;
            self.check_group(&format!("sinks[{i}]"), sink.group)?;
        }
        self.check_goals()?;
        for (i, force) in self.forces.iter().enumerate() {
            check_force(&format!("forces[{i}]"), force)?;
        }
        self.check_custom()?;
        for (i, reaper) in self.reapers.iter().enumerate() {
            match reaper {
                ReaperKind::Chance(chance) => zero_or_more(&format!("reapers[{i}].rate"), chance.rate)?,
                ReaperKind::Dense(dense) => zero_or_more(&format!("reapers[{i}].radius"), dense.radius)?,
            }
        }
        // The number of particles that cloths, strands and soft bodies bring is known when their meshes have been read.
        if self.cloths.is_empty() && self.strands.is_empty() && self.soft_bodies.is_empty() {
            let boxes: u64 = self.boxes.iter().map(Boxes::particles).sum();
            let ropes: u64 = self.ropes.iter().map(Cord::particles).sum();
            self.check_corners(self.particles.len().saturating_add((boxes + ropes) as usize))?;
        }
        self.check_room()?;
        self.check_scenery()?;
        self.check_look()
    }

    fn check_spring(&self, at: &str, spring: &Spring) -> Checked {
        for (name, number) in [("rest_length", spring.rest_length), ("ks", spring.ks), ("kd", spring.kd)] {
            finite(&format!("{at}.{name}"), &[number])?;
        }
        if let Some(drive) = spring.drive {
            finite(&format!("{at}.drive"), &[drive.amplitude, drive.frequency, drive.phase])?;
            if !(drive.amplitude.abs() < 1.0) {
                return Err(SceneError::value(
                    format!("{at}.drive.amplitude"),
                    format!("has to be within -1 and 1, a share of the rest length, not {}", drive.amplitude),
                ));
            }
        }
        if spring.breaks_at.is_some() && !(spring.rest_length > 0.0) {
            return Err(SceneError::value(format!("{at}.breaks_at"), "needs a rest_length above zero"));
        }
        check_breaking(&format!("{at}.breaks_at"), spring.breaks_at)?;
        if let Some(end) = spring.ends.iter().find(|&&end| end as usize >= self.particles.len()) {
            let count = self.particles.len();
            return Err(SceneError::value(at, format!("particle {end} is out of range; there are {count}, from 0")));
        }
        Ok(())
    }

    fn check_run(&self) -> Checked {
        let run = &self.run;
        let longest = f64::from(1u32 << 31);
        // Time itself has steps of 0.23 ns.
        if !(run.dt >= 1e-9 && run.dt < longest) {
            let message = format!("has to be from 1e-9 s to below 2^31 s, not {:?} s", run.dt);
            return Err(SceneError::value("run.dt", message));
        }
        if !(run.duration >= 0.0 && run.duration < longest) {
            let message = format!("has to be from zero to below 2^31 s, not {:?} s", run.duration);
            return Err(SceneError::value("run.duration", message));
        }
        if !(1..=MOST_SUBSTEPS).contains(&run.substeps) {
            let message = format!("has to be from 1 to {MOST_SUBSTEPS}, not {}", run.substeps);
            return Err(SceneError::value("run.substeps", message));
        }
        if !(1..=10_000).contains(&run.max_bounces) {
            let message = format!("has to be from 1 to 10000, not {}", run.max_bounces);
            return Err(SceneError::value("run.max_bounces", message));
        }
        let tuning = &run.tuning;
        for (name, value) in
            [("tolerance", tuning.tolerance), ("smallest", tuning.smallest), ("residual", tuning.residual)]
        {
            if !(value > 0.0 && value < f32::INFINITY) {
                return Err(SceneError::value(
                    format!("run.tuning.{name}"),
                    format!("has to be above zero, not {value}"),
                ));
            }
        }
        if tuning.inner.chooses_steps() {
            return Err(SceneError::value(
                "run.tuning.inner",
                format!("has to be a method that takes steps as they come, such as rk4, not {}", tuning.inner),
            ));
        }
        for (name, value, most) in [
            ("attempts", tuning.attempts, 1 << 20),
            ("newton", tuning.newton, 64),
            ("iterations", tuning.iterations, 100_000),
        ] {
            if !(1..=most).contains(&value) {
                return Err(SceneError::value(
                    format!("run.tuning.{name}"),
                    format!("has to be from 1 to {most}, not {value}"),
                ));
            }
        }
        Ok(())
    }

    fn check_emitter(&self, at: &str, emitter: &Emitter<Shape<String>, Option<MotionBuf>>) -> Checked {
        if !(emitter.rate >= 0.0 && emitter.rate <= MAX_RATE) {
            let message = format!("has to be from zero to {MAX_RATE:e}, not {}", emitter.rate);
            return Err(SceneError::value(format!("{at}.rate"), message));
        }
        check_varied(at, emitter)?;
        if let Some(message) = emitter.motion.as_ref().and_then(Motion::fault) {
            return Err(SceneError::value(format!("{at}.motion"), message));
        }
        let (Spread::Uniform(cutoff) | Spread::Lecture(cutoff)) = emitter.spread;
        finite(&format!("{at}.spread"), &[cutoff])?;
        finite(at, &[emitter.start, emitter.stop.unwrap_or(0.0), emitter.inherit])?;
        finite(&format!("{at}.velocity"), &emitter.velocity.to_array())?;
        if let Some(direction) = emitter.direction {
            check_direction(&format!("{at}.direction"), direction)?;
        }
        if let Some(WhereSparse { radius, .. }) = emitter.where_sparse {
            zero_or_more(&format!("{at}.where_sparse.radius"), radius)?;
        }
        let is_open =
            matches!(emitter.shape, Shape::Line(_) | Shape::Circle(_) | Shape::Triangle(_) | Shape::HeightField(_));
        if emitter.inside && is_open {
            return Err(SceneError::value(
                format!("{at}.inside"),
                "needs a closed shape: box, sphere, cylinder, cone, capsule or mesh",
            ));
        }
        if let Some(burst) = &emitter.burst {
            finite(&format!("{at}.burst.at"), &[burst.at])?;
            zero_or_more(&format!("{at}.burst.every"), burst.every)?;
        }
        if matches!(emitter.shape, Shape::Plane(_)) {
            return Err(SceneError::value(format!("{at}.shape"), "a plane is infinite and cannot give birth"));
        }
        check_shape(&format!("{at}.shape"), &emitter.shape)?;
        self.check_material(at, emitter.material)
    }

    fn check_scenery(&self) -> Checked {
        let mut depths: Vec<usize> = Vec::with_capacity(self.groups.len());
        for (i, group) in self.groups.iter().enumerate() {
            let at = format!("groups[{i}]");
            if let Err(message) = group.affine() {
                return Err(SceneError::value(format!("{at}.matrix"), message));
            }
            if group.parent.is_some_and(|parent| parent as usize >= i) {
                return Err(SceneError::value(format!("{at}.parent"), "has to be an earlier group"));
            }
            depths.push(1 + group.parent.map_or(0, |parent| depths[parent as usize]));
            if depths[i] > MAX_GROUPS {
                let message = format!("groups stand more than {MAX_GROUPS} deep in each other");
                return Err(SceneError::value(format!("{at}.parent"), message));
            }
            self.check_material(&at, group.material)?;
        }
        for (i, item) in self.scenery.iter().enumerate() {
            let at = format!("scenery[{i}]");
            check_shape(&format!("{at}.shape"), &item.shape)?;
            self.check_material(&at, item.material)?;
            if let Some(message) = item.motion.as_ref().and_then(Motion::fault) {
                return Err(SceneError::value(format!("{at}.motion"), message));
            }
            self.check_group(&at, item.group)?;
        }
        Ok(())
    }

    fn check_goals(&self) -> Checked {
        for (i, goal) in self.goals.iter().enumerate() {
            let at = format!("goals[{i}]");
            let against = goal.against.unwrap_or(Vec3::ZERO).to_array();
            finite(&at, &[goal.start, goal.arrive, goal.release.unwrap_or(0.0)])?;
            finite(&format!("{at}.against"), &against)?;
            above_zero(&format!("{at}.settle"), goal.settle)?;
            let later =
                [("arrive", Some(goal.arrive), "start", goal.start), ("release", goal.release, "arrive", goal.arrive)];
            for (name, instant, other, before) in later {
                if instant.is_some_and(|instant| instant < before) {
                    let message = format!("{} s is before {other}, {before} s", instant.unwrap_or(0.0));
                    return Err(SceneError::value(format!("{at}.{name}"), message));
                }
            }
            check_shape(&format!("{at}.shape"), &goal.shape)?;
            self.check_group(&at, goal.group)?;
            self.check_material(&at, goal.material)?;
        }
        Ok(())
    }
}

/// Checks the numbers of a particle.
fn check_particle(at: &str, particle: &Particle) -> Checked {
    if particle.is_sound() {
        return Ok(());
    }
    let Particle { position, velocity, radius, mass, fixed, drag, charge, elasticity, lifetime, .. } = *particle;
    finite(&format!("{at}.position"), &position.to_array())?;
    finite(&format!("{at}.velocity"), &velocity.to_array())?;
    for (name, number) in [("drag", drag), ("charge", charge), ("elasticity", elasticity), ("lifetime", lifetime)] {
        finite(&format!("{at}.{name}"), &[number])?;
    }
    zero_or_more(&format!("{at}.radius"), radius)?;
    let of_mass = format!("{at}.mass");
    if fixed {
        return zero_or_more(&of_mass, mass);
    }
    finite(&of_mass, &[mass])?;
    let message = format!("has to be above zero (3e-39 kg at least) unless the particle is `fixed`, not {mass}");
    Err(SceneError::value(of_mass, message))
}

/// The numbers of births that may vary, by their names.
pub(super) fn varied<S, M>(emitter: &Emitter<S, M>) -> [(&'static str, Varied); 7] {
    let Emitter { speed, radius, mass, drag, charge, elasticity, lifetime, .. } = *emitter;
    [
        ("speed", speed),
        ("radius", radius),
        ("mass", mass),
        ("drag", drag),
        ("charge", charge),
        ("elasticity", elasticity),
        ("lifetime", lifetime),
    ]
}

/// Checks the numbers that births vary by.
fn check_varied(at: &str, emitter: &Emitter<Shape<String>, Option<MotionBuf>>) -> Checked {
    for (name, Varied { mean, half_width }) in varied(emitter) {
        finite(&format!("{at}.{name}"), &[mean, half_width])?;
        if !(mean - half_width).is_finite() || !(mean + half_width).is_finite() {
            let message = format!("{mean:?} ± {half_width:?} goes beyond the range of a 32-bit float");
            return Err(SceneError::value(format!("{at}.{name}"), message));
        }
    }
    let Emitter { mass, radius, .. } = emitter;
    let lightest = mass.mean - mass.half_width.abs();
    if !emitter.fixed && !(lightest > 3e-39) {
        return Err(SceneError::value(format!("{at}.mass"), "has to be above zero, the half_width counted in"));
    }
    if !(lightest >= 0.0) {
        return Err(SceneError::value(format!("{at}.mass"), "must not be below zero, the half_width counted in"));
    }
    if !(radius.mean - radius.half_width.abs() >= 0.0) {
        return Err(SceneError::value(format!("{at}.radius"), "must not be below zero, the half_width counted in"));
    }
    Ok(())
}
