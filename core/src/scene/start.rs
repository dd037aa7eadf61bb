//! The particles and springs that a scene begins with: its own, and those of its cloths, boxes, strands, ropes and soft bodies.

use super::filling::MOST_OF_SOFT;
use super::placing::Placing;
use super::references::color;
use super::{Body, Form, Growth, PatchBuf, SceneError, SceneFile, SheetContactsBuf, SoftForm};
use crate::constrain::{ConstraintKind, HullBuf, RigidBox, SheetContacts, TiedRope};
use crate::draw::Lock;
use crate::emit::Emitter;
use crate::force::{ForceKind, Spring};
use crate::math::max;
use crate::particles::Particle;
use crate::shape::MeshBuf;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// As many pieces as the bodies of a scene may have that are no boxes: they take about 10 kB each.
const MOST_PIECES: u64 = 1 << 16;

/// A root of strands that is to be tied: the number of these, the particle, and the body.
type Root = (usize, u32, Body);

/// A scene's own particles, springs and forces, with those of its cloths and boxes.
pub(super) struct Start {
    pub(super) particles: Vec<Particle>,
    pub(super) springs: Vec<Spring>,
    /// Those of gas in cloths, and of the air around them.
    pub(super) forces: Vec<ForceKind>,
    /// The constraints that hold shells and strands together.
    pub(super) constraints: Vec<ConstraintKind>,
    /// Where they begin.
    pub(super) cloths: Vec<[usize; 2]>,
    pub(super) patches: Vec<PatchBuf>,
    /// Where the particles of cloths end.
    pub(super) woven: usize,
    /// The surfaces of cloths that something is tied to, by their first particles.
    pub(super) skins: BTreeMap<u32, MeshBuf>,
    pub(super) boxes: Vec<RigidBox>,
    /// Where those of each of the file's boxes begin.
    pub(super) blocks: Vec<usize>,
    /// The contacts of those that have a thickness.
    pub(super) contacts: SheetContactsBuf,
    pub(super) locks: Vec<Lock>,
    pub(super) hulls: Vec<HullBuf>,
    /// The meshes that bodies were cut from, in their frames, by the numbers of their first hulls.
    pub(super) surfaces: BTreeMap<u16, MeshBuf>,
    /// The number of the scene's own particles, and where those of each rope begin.
    pub(super) own: u32,
    pub(super) ropes: Vec<usize>,
    /// Where those of each soft body begin.
    pub(super) soft_bodies: Vec<usize>,
}

impl Start {
    pub(super) fn of(file: &SceneFile, meshes: &mut Placing<'_>) -> Result<Self, SceneError> {
        let mut start = Self {
            particles: file.particles.clone(),
            springs: file.springs.clone(),
            forces: Vec::new(),
            constraints: Vec::new(),
            cloths: Vec::new(),
            patches: Vec::new(),
            woven: 0,
            skins: BTreeMap::new(),
            boxes: Vec::new(),
            blocks: Vec::new(),
            contacts: SheetContacts { particles: Vec::new(), triangles: Vec::new(), thickness: Vec::new() },
            locks: Vec::new(),
            hulls: Vec::new(),
            surfaces: BTreeMap::new(),
            own: file.particles.len() as u32,
            ropes: Vec::new(),
            soft_bodies: Vec::new(),
        };
        start.add_cloths(file, meshes)?;
        start.woven = start.particles.len();
        start.add_boxes(file, meshes)?;
        let roots = start.add_strands(file, meshes)?;
        start.add_ropes(file, meshes.path)?;
        start.add_soft_bodies(file, meshes)?;
        start.tie_roots(&roots, meshes.path)?;
        start.add_ties(&file.ties).map_err(|(at, message)| SceneError::value(at, message).in_file(meshes.path))?;
        for particle in &mut start.particles {
            particle.color = color(file, particle.color, particle.material);
        }
        Ok(start)
    }

    fn add_cloths(&mut self, file: &SceneFile, meshes: &mut Placing<'_>) -> Result<(), SceneError> {
        for (i, cloth) in file.cloths.iter().enumerate() {
            let mesh = match &cloth.form {
                Form::Mesh(name) => Some(meshes.load(&format!("cloths[{i}].form"), name)?),
                Form::Sheet(_) => None,
            };
            let first = self.particles.len() as u32;
            let (mut particles, springs) = cloth.make(mesh.as_deref(), first);
            if let Some(thickness) = cloth.thickness.filter(|_| !file.boxes.is_empty()) {
                // To bodies its particles are balls, as thick as it is.
                particles.iter_mut().for_each(|particle| particle.radius = 0.5 * thickness);
                let shortest = cloth.shortest_edge(mesh.as_deref(), &particles);
                if file.contacts.is_some() && !(0.9999 * thickness <= shortest) {
                    let message = format!(
                        "has to be at most {shortest:?}, its shortest edge in m: with boxes and contacts in a scene its particles are balls, \
                         which would drive each other apart"
                    );
                    return Err(SceneError::value(format!("cloths[{i}].thickness"), message).in_file(meshes.path));
                }
            }
            let refuse = |field: &str, message: String| {
                Err(SceneError::value(format!("cloths[{i}].{field}"), message).in_file(meshes.path))
            };
            if particles.iter().any(|particle| !particle.position.is_finite()) {
                return refuse("form", "reaches beyond the range of a 32-bit float".into());
            }
            if let Some(leak) = cloth.leak(mesh.as_deref()) {
                return refuse("gas", leak);
            }
            if let Some(particle) = particles.iter().find(|particle| !particle.is_sound()) {
                return refuse("mass", format!("leaves {:e} kg to each particle, too little", particle.mass));
            }
            if let Some(number) = cloth.fixed.iter().find(|&&number| number as usize >= particles.len()) {
                return refuse(
                    "fixed",
                    format!("particle {number} is out of range; there are {}, from 0", particles.len()),
                );
            }
            self.constraints.extend(cloth.shell(mesh.as_deref(), first, particles.len() as u32));
            self.constraints.extend(cloth.strain_limits(mesh.as_deref(), first));
            cloth.touch(mesh.as_deref(), first, particles.len() as u32, &mut self.contacts);
            self.cloths.push([self.particles.len(), self.springs.len()]);
            self.particles.extend(particles);
            self.springs.extend(springs);
            self.patches.extend(cloth.patch(mesh.as_deref(), first));
            self.forces.extend(cloth.pressure(mesh.as_deref(), first).map(ForceKind::Pressure));
            self.forces.extend(cloth.aerodynamics(mesh.as_deref(), first, &file.forces));
        }
        Ok(())
    }

    fn add_boxes(&mut self, file: &SceneFile, meshes: &mut Placing<'_>) -> Result<(), SceneError> {
        let mut pieces = 0;
        for (i, boxes) in file.boxes.iter().enumerate() {
            let at = || format!("boxes[{i}].form");
            let mesh = boxes.form.file().map(|name| meshes.load(&at(), name)).transpose()?;
            let form = boxes.compound(mesh.as_deref()).transpose();
            let form = form.map_err(|error| SceneError::value(at(), error).in_file(meshes.path))?;
            let number = self.hulls.len() as u16;
            let lent = form.as_ref().map(|(form, _)| (number, form));
            let size = boxes.size(mesh.as_deref()).unwrap_or_default();
            let (particles, bodies) = boxes.make(self.particles.len() as u32, size, lent);
            if let Some((form, surface)) = form {
                self.hulls.extend_from_slice(form.pieces());
                pieces += boxes.number().saturating_mul(form.pieces().len() as u64);
                self.surfaces.extend(surface.map(|surface| (number, surface)));
            }
            if pieces > MOST_PIECES || self.hulls.len() > usize::from(u16::MAX) {
                let message = format!("makes too many pieces; the bodies of a scene may have {MOST_PIECES}");
                return Err(SceneError::value(at(), message).in_file(meshes.path));
            }
            if !particles.iter().all(Particle::is_sound) {
                let message = "leaves some particles too little mass or too much, or puts them beyond the range of a 32-bit float";
                return Err(SceneError::value(format!("boxes[{i}]"), message).in_file(meshes.path));
            }
            self.blocks.push(self.particles.len());
            self.particles.extend(particles);
            self.boxes.extend(bodies);
        }
        Ok(())
    }

    /// Adds all strands; tells whose roots are to be tied to what: the strands' number, the root's, and the body.
    fn add_strands(&mut self, file: &SceneFile, meshes: &mut Placing<'_>) -> Result<Vec<Root>, SceneError> {
        let mut roots = Vec::new();
        for (i, tuft) in file.strands.iter().enumerate() {
            let shape = match &tuft.form {
                Growth::On(field) => Some(meshes.shape(&format!("strands[{i}].form.on.shape"), &field.shape)?),
                Growth::Curve(_) => None,
            };
            let grown = tuft.make(shape.as_ref(), self.particles.len() as u32);
            if !grown.particles.iter().all(Particle::is_sound) {
                let message = "leaves some points too little mass, or puts them beyond the range of a 32-bit float";
                return Err(SceneError::value(format!("strands[{i}]"), message).in_file(meshes.path));
            }
            self.particles.extend(grown.particles);
            self.forces.extend(tuft.air_drag(&grown.lock, &file.forces));
            self.constraints.extend(grown.constraints);
            self.locks.push(grown.lock);
            let tied = tuft.attach.into_iter().flat_map(|body| grown.roots.iter().map(move |&root| (i, root, body)));
            roots.extend(tied);
        }
        Ok(roots)
    }

    /// Ties the roots of strands, when all bodies are there.
    fn tie_roots(&mut self, roots: &[Root], path: &str) -> Result<(), SceneError> {
        for &(i, root, body) in roots {
            let tied = self.tie(root, body, [0.0; 2]);
            tied.map_err(|why| SceneError::value(format!("strands[{i}].attach"), why).in_file(path))?;
        }
        Ok(())
    }

    fn add_ropes(&mut self, file: &SceneFile, path: &str) -> Result<(), SceneError> {
        let mut last = Vec::new();
        for (i, cord) in file.ropes.iter().enumerate() {
            let first = self.particles.len() as u32;
            let laid = cord.make(first);
            if !laid.particles.iter().all(Particle::is_sound) {
                let message = "leaves some points too little mass, or puts them beyond the range of a 32-bit float";
                return Err(SceneError::value(format!("ropes[{i}]"), message).in_file(path));
            }
            self.ropes.push(self.particles.len());
            self.particles.extend(laid.particles);
            self.forces.extend(cord.air_drag(&laid.lock, &file.forces));
            self.constraints.extend(laid.constraints);
            self.locks.push(laid.lock);
            last.push(self.constraints.len() - 1);
        }
        // One may be tied to another that comes later.
        for (i, cord) in file.ropes.iter().enumerate() {
            let mut ends = [None, None];
            for (k, point) in [0, cord.segments].into_iter().enumerate() {
                let Some(to) = cord.ends[k] else { continue };
                let tied = self.tied(self.ropes[i] as u32 + point, to, [0.0; 2]);
                let wrong = |why| SceneError::value(format!("ropes[{i}].ends[{k}]"), why).in_file(path);
                ends[k] = Some(tied.map_err(wrong)?);
            }
            if let (ConstraintKind::Rope(rope), true) = (&self.constraints[last[i]], ends.iter().any(Option::is_some)) {
                self.constraints[last[i]] = ConstraintKind::TiedRope(TiedRope { rope: rope.clone(), ends });
            }
        }
        Ok(())
    }

    fn add_soft_bodies(&mut self, file: &SceneFile, meshes: &mut Placing<'_>) -> Result<(), SceneError> {
        let begin = self.particles.len();
        for (i, body) in file.soft_bodies.iter().enumerate() {
            let at = |field: &str| format!("soft_bodies[{i}].{field}");
            let mesh = match &body.form {
                SoftForm::Mesh(name) => Some(meshes.load(&at("form"), name)?),
                SoftForm::Box(_) => None,
            };
            let refuse = |field: &str, message: &str| SceneError::value(at(field), message).in_file(meshes.path);
            let made = body.make(mesh.as_deref(), self.particles.len() as u32);
            let made = made.map_err(|(field, message)| refuse(field, &message))?;
            if !made.particles.iter().all(Particle::is_sound) {
                let message = "leaves each particle too little mass, or puts some beyond the range of a 32-bit float";
                return Err(refuse("density", message));
            }
            self.soft_bodies.push(self.particles.len());
            self.particles.extend(made.particles);
            self.constraints.extend(made.constraints);
            if (self.particles.len() - begin) as u64 > MOST_OF_SOFT {
                let message =
                    format!("makes too many particles; soft bodies may have {MOST_OF_SOFT}: take a wider one");
                return Err(refuse("spacing", &message));
            }
        }
        Ok(())
    }

    /// The first particle of a cloth, and their number.
    pub(super) fn cloth_span(&self, number: usize) -> Option<[u32; 2]> {
        let [first, _] = *self.cloths.get(number)?;
        let end = self.cloths.get(number + 1).map_or(self.woven, |&[next, _]| next);
        Some([first as u32, (end - first) as u32])
    }

    /// Loose balls that may be near bodies at a time: all that there may be, but no more than 64 for each body, or 1,024 if that is more.
    pub(super) fn balls(&self, file: &SceneFile) -> u32 {
        let loose = self.particles.iter().filter(|particle| particle.radius > 0.0).count();
        let born = if widest(&[], &file.emitters) > 0.0 { u32::MAX } else { 0 };
        let most = self.boxes.len().saturating_mul(64).max(1024);
        if self.boxes.is_empty() { 0 } else { born.max(loose as u32).min(most as u32) }
    }
}

/// The largest radius that a particle of the scene may have \[m\].
pub(super) fn widest<S, M>(particles: &[Particle], emitters: &[Emitter<S, M>]) -> f32 {
    let born = emitters.iter().map(|emitter| emitter.radius.mean + emitter.radius.half_width.abs());
    particles.iter().map(|particle| particle.radius).chain(born).fold(0.0, max)
}
