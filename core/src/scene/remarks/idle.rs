//! Remarks on parts of a scene that do nothing.

use crate::constrain::{ConstraintKind, Strands};
use crate::force::ForceKind;
use crate::motion::MotionBuf;
use crate::reap::ReaperKind;
use crate::scene::{Growth, SceneFile};
use crate::shape::Shape;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Arguments;
use glam::Vec3;

impl SceneFile {
    /// Remarks on parts that do nothing.
    pub(super) fn add_idle(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, constraint) in self.constraints.iter().enumerate() {
            if let ConstraintKind::Distance(distance) = constraint {
                let [a, b] = distance.ends;
                let itself = (a == b).then(|| format!("it holds particle {a} to itself, so it does nothing"));
                add(format_args!("constraints[{i}].distance.ends"), itself);
            }
            let ConstraintKind::Strands(strands) = constraint else { continue };
            for (end, name) in ["root", "tip"].into_iter().enumerate() {
                let nothing =
                    || format!("no {name} is held or clamped by two fixed neighbours, so nothing is turned there");
                add(format_args!("constraints[{i}].strands.turning"), self.is_idly_turned(strands, end).then(nothing));
            }
        }
        for (i, tuft) in self.strands.iter().enumerate() {
            let loose = tuft.motion.is_some() && tuft.fixed.is_empty() && matches!(tuft.form, Growth::Curve(_));
            let nothing = || "none of its points is fixed, so nothing follows it".into();
            add(format_args!("strands[{i}].motion"), loose.then(nothing));
            let loose = tuft.attach.is_some() && tuft.fixed.is_empty() && matches!(tuft.form, Growth::Curve(_));
            let nothing = || "none of its points is fixed, so nothing of it is tied; name them in fixed".into();
            add(format_args!("strands[{i}].attach"), loose.then(nothing));
        }
        for (i, cord) in self.ropes.iter().enumerate() {
            let nothing = || "none of its points is fixed, so nothing follows it".into();
            add(format_args!("ropes[{i}].motion"), (cord.motion.is_some() && cord.fixed.is_empty()).then(nothing));
        }
        for (i, sink) in self.sinks.iter().enumerate() {
            let idle = sink.intensity != 0.0 && [sink.ca, sink.la, sink.qa] == [0.0; 3];
            let nothing = || "it divides by ca, la and qa, which are all zero, so it pulls nobody".into();
            add(format_args!("sinks[{i}].intensity"), idle.then(nothing));
            let endless = sink.intensity != 0.0 && !idle && [sink.ca, sink.softening] == [0.0; 2];
            let bounded = || {
                "0 leaves its pull without bound at its surface, from which energies count, so these are infinite; say softening, or another ca".into()
            };
            add(format_args!("sinks[{i}].ca"), endless.then(bounded));
        }
        for (i, reaper) in self.reapers.iter().enumerate() {
            let narrow = matches!(reaper, ReaperKind::Dense(dense) if dense.radius == 0.0);
            let nobody = || "nobody is within 0 m of another who is not in the same place".into();
            add(format_args!("reapers[{i}].dense.radius"), narrow.then(nobody));
        }
        for (i, boxes) in self.boxes.iter().enumerate() {
            let none = || "0 of them along an axis are none at all".into();
            add(format_args!("boxes[{i}].count"), boxes.count.contains(&0).then(none));
            let stays = || "they are fixed, and stay where they are".into();
            add(format_args!("boxes[{i}].velocity"), (boxes.fixed && boxes.velocity != Vec3::ZERO).then(stays));
            add(format_args!("boxes[{i}].spin"), (boxes.fixed && boxes.spin != Vec3::ZERO).then(stays));
        }
        for (i, goal) in self.goals.iter().enumerate() {
            let infinite = matches!(goal.shape, Shape::Plane(_));
            let point = || "a plane is infinite, so all are led to its one point".into();
            add(format_args!("goals[{i}].shape"), infinite.then(point));
        }
        self.add_unbound(add);
        self.add_swings(add);
        self.add_lives(add);
    }

    /// Remarks on constraints and forces that name nobody.
    fn add_unbound(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, constraint) in self.constraints.iter().enumerate() {
            let nobody = constraint.ends().next().is_none();
            let nothing = || "it names no particles, so it does nothing".into();
            add(format_args!("constraints[{i}].{}", constraint.name()), nobody.then(nothing));
        }
        for (i, force) in self.forces.iter().enumerate() {
            let (nobody, of) = match force {
                ForceKind::Pressure(gas) => (gas.triangles.is_empty(), "pressure.triangles"),
                ForceKind::Aerodynamics(air) => (air.triangles.is_empty(), "aerodynamics.triangles"),
                ForceKind::CylinderDrag(air) => (air.segments.is_empty(), "cylinder_drag.segments"),
                _ => (false, ""),
            };
            let nothing = || "it has none, so it pushes nobody".into();
            add(format_args!("forces[{i}].{of}"), nobody.then(nothing));
        }
    }

    /// Remarks on motions that say how far to swing, and not how often.
    fn add_swings(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let still = |motion: &Option<MotionBuf>| {
            let idle = |motion: &MotionBuf| motion.swing != Vec3::ZERO && [motion.frequency, motion.phase] == [0.0; 2];
            let nothing = || "0 swings nothing; say how often a second".into();
            motion.as_ref().is_some_and(idle).then(nothing)
        };
        let mut look = |list: &str, motions: &mut dyn Iterator<Item = &Option<MotionBuf>>| {
            for (i, motion) in motions.enumerate() {
                add(format_args!("{list}[{i}].motion.frequency"), still(motion));
            }
        };
        look("emitters", &mut self.emitters.iter().map(|emitter| &emitter.motion));
        look("scenery", &mut self.scenery.iter().map(|item| &item.motion));
        look("strands", &mut self.strands.iter().map(|tuft| &tuft.motion));
        look("ropes", &mut self.ropes.iter().map(|cord| &cord.motion));
        look("soft_bodies", &mut self.soft_bodies.iter().map(|body| &body.motion));
    }

    /// Remarks on curves over the lives of particles that all live for ever, and so stay at the beginning of these.
    fn add_lives(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, material) in self.materials.iter().enumerate() {
            let of = |number: &Option<u16>| number.is_some_and(|number| usize::from(number) == i);
            let own = self.particles.iter().filter(|particle| of(&particle.material)).map(|particle| particle.lifetime);
            let born = self.emitters.iter().filter(|emitter| of(&emitter.material));
            let longest = own.chain(born.map(|emitter| emitter.lifetime.mean + emitter.lifetime.half_width.abs()));
            // Who has the material of a group may live by other rules, and whose material nobody has is none to remark on.
            let longest = longest.fold(f32::NEG_INFINITY, f32::max);
            if longest > 0.0 || longest == f32::NEG_INFINITY {
                continue;
            }
            let frozen = material.life.over_lives();
            let stays = "it goes over a life, and whoever is of this material lives for ever, so it stays as it begins; give particles a lifetime, or say \"over\": \"seconds\"";
            for name in frozen {
                add(format_args!("materials[{i}].life.{name}"), Some(stays.into()));
            }
        }
    }

    /// Tells whether strands turn an end, root or tip, that is neither held nor clamped in any of them: one of the two particles there, of the file's
    /// own, is not fixed.
    fn is_idly_turned(&self, strands: &Strands<Vec<u32>, Vec<u32>>, end: usize) -> bool {
        let is_free = |&at: &usize| {
            let number = strands.particles.get(at).and_then(|&number| usize::try_from(number).ok());
            number.and_then(|number| self.particles.get(number)).is_some_and(|particle| !particle.fixed)
        };
        let is_loose = |[first, last]: [usize; 2]| {
            let edge = if end == 0 { [first, first + 1] } else { [last - 1, last.saturating_sub(2)] };
            edge.iter().any(is_free)
        };
        strands.turning[end] != 0.0 && !strands.held[end] && strands.strands().all(is_loose)
    }
}
