//! Remarks on forces that look for what nobody has, and on what no force looks for.

use crate::emit::Varied;
use crate::force::{ForceKind, Weight};
use crate::scene::SceneFile;
use alloc::format;
use alloc::string::String;
use core::fmt::Arguments;

impl SceneFile {
    /// Remarks on the first drag and the first charge of a list where no force looks at them.
    pub(super) fn add_unread(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        if !self.forces.iter().any(|force| matches!(force, ForceKind::Drag(_) | ForceKind::Wind(_))) {
            let mut look = |list: &str, drags: &mut dyn Iterator<Item = f32>| {
                let Some((i, drag)) = drags.enumerate().find(|(_, drag)| *drag != 0.0) else { return };
                let nothing = format!(
                    "{drag} brakes nobody, for no force looks at it; add drag or wind to the forces, or take 0"
                );
                add(format_args!("{list}[{i}].drag"), Some(nothing));
            };
            look("particles", &mut self.particles.iter().map(|particle| particle.drag));
            look("emitters", &mut self.emitters.iter().map(|emitter| largest(emitter.drag)));
            look("boxes", &mut self.boxes.iter().map(|boxes| boxes.drag));
        }
        if !self.forces.iter().any(by_charge) {
            let mut look = |list: &str, charges: &mut dyn Iterator<Item = f32>| {
                let Some((i, charge)) = charges.enumerate().find(|(_, charge)| *charge != 0.0) else { return };
                let nothing =
                    format!("{charge} C does nothing, for no force looks at it; add coulomb to the forces, or take 0");
                add(format_args!("{list}[{i}].charge"), Some(nothing));
            };
            look("particles", &mut self.particles.iter().map(|particle| particle.charge));
            look("emitters", &mut self.emitters.iter().map(|emitter| largest(emitter.charge)));
        }
    }

    /// Remarks on forces that do nothing in this scene, act twice, or too late.
    pub(super) fn add_forces(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        // A program may put others into a scene that begins with nobody.
        let is_peopled = !self.particles.is_empty() || !self.emitters.is_empty();
        let (idle_wind, uncharged) = (is_peopled && !self.has_drag(), is_peopled && !self.has_charges());
        for (i, force) in self.forces.iter().enumerate() {
            match force {
                ForceKind::Wind(wind) if wind.coefficient.is_none() && idle_wind => {
                    let nobody = "without one it brakes by each particle's own drag, and nobody has any; say this, or drag of particles and emitters";
                    add(format_args!("forces[{i}].wind.coefficient"), Some(nobody.into()));
                }
                force if by_charge(force) && uncharged => {
                    let nobody = "nobody has a charge, so it does nothing; give particles or emitters one".into();
                    add(format_args!("forces[{i}].{}", force.kind()), Some(nobody));
                }
                ForceKind::LennardJones(law) if law.0.cutoff <= law.0.sigma => {
                    let (cutoff, sigma) = (law.0.cutoff, law.0.sigma);
                    let inner = format!(
                        "{cutoff} m is within sigma, {sigma} m, where they repel each other more and more, so that none of their pull is left; 2.5 sigma is usual"
                    );
                    add(format_args!("forces[{i}].lennard_jones.cutoff"), Some(inner));
                }
                _ => {}
            }
        }
        if let Some((i, remark)) = self.doubled_drag() {
            add(format_args!("forces[{i}].drag"), Some(remark.into()));
        }
        for (i, goal) in self.goals.iter().enumerate() {
            add(format_args!("goals[{i}].start"), self.too_late(goal.start, "it leads nobody"));
        }
    }

    /// The drag in still air that acts beside a wind on the same coefficients, or beside another drag, by its place in the list of forces, and what to do.
    fn doubled_drag(&self) -> Option<(usize, &'static str)> {
        let blows = |force: &ForceKind| matches!(force, ForceKind::Wind(wind) if wind.coefficient.is_none());
        let mut drags = self.forces.iter().enumerate().filter(|(_, force)| matches!(force, ForceKind::Drag(_)));
        let (first, second) = (drags.next()?.0, drags.next());
        if self.forces.iter().any(blows) {
            return Some((
                first,
                "wind brakes by the same coefficients, as seen from the moving air: both together brake twice; leave this one out, or give the wind a coefficient",
            ));
        }
        Some((second?.0, "it stands among the forces twice and brakes twice; leave one out"))
    }

    /// Tells whether anybody may have a coefficient of drag, or surfaces on which wind acts otherwise.
    fn has_drag(&self) -> bool {
        let bodies = [self.cloths.len(), self.strands.len(), self.ropes.len(), self.soft_bodies.len()];
        bodies != [0; 4]
            || self.particles.iter().any(|particle| particle.drag != 0.0)
            || self.emitters.iter().any(|emitter| largest(emitter.drag) != 0.0)
            || self.boxes.iter().any(|boxes| boxes.drag != 0.0)
    }

    fn has_charges(&self) -> bool {
        self.particles.iter().any(|particle| particle.charge != 0.0)
            || self.emitters.iter().any(|emitter| largest(emitter.charge) != 0.0)
    }
}

/// The number of all that births may have that differs most from zero.
fn largest(Varied { mean, half_width }: Varied) -> f32 {
    if mean < 0.0 { mean - half_width.abs() } else { mean + half_width.abs() }
}

/// Tells whether a force goes by charges.
fn by_charge(force: &ForceKind) -> bool {
    match force {
        ForceKind::Coulomb(_) => true,
        ForceKind::PowerLaw(law) => law.0.weight == Weight::Charge,
        _ => false,
    }
}
