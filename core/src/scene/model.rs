//! A declared scene made ready to run: meshes loaded, transforms multiplied out, colours settled.

use super::Response;
use super::Scene;
use super::{BoxForm, Files, Form, Growth, Material, SceneError, SceneFile, beside};
use crate::collide::Meetings;
use crate::constrain::{ConstraintKind, Contacts, HullBuf, RigidBodies, RigidBox, SheetContacts};
use crate::custom::CustomBuf;
use crate::draw::{Lock, Patch};
use crate::emit::Emitter;
use crate::force::{ForceKind, Goal, Penalty, Sink, Spring};
use crate::index::{Periodic, Room, Structure};
use crate::integrate::Tuned;
use crate::math::max;
use crate::memory::{Heap, Size};
use crate::motion::MotionBuf;
use crate::particles::{Color, Particle};
use crate::rays;
use crate::reap::ReaperKind;
use crate::shape::{Affine, MeshBuf, Moving, Placed, Scenery, Shape};
use crate::system::System;
use alloc::collections::{BTreeMap, TryReserveError};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;
use glam::Vec3;

/// Forces, the pull of sinks, what pushes balls apart, and what leads to goals.
pub type Forces = (Vec<ForceKind>, Vec<Sink<Arc<MeshBuf>>>, Vec<Penalty>, Vec<Goal<Arc<MeshBuf>>>);

/// The contacts of cloths with each other.
pub type SheetContactsBuf = SheetContacts<Vec<u32>, Vec<[u32; 3]>, Vec<f32>>;

/// The constraints of files, of cloths that are shells and of strands, the rigid bodies, then contacts by position, and those of cloths.
pub type Constraints =
    (Vec<ConstraintKind>, RigidBodies<Vec<RigidBox>, Vec<HullBuf>>, Option<Contacts>, SheetContactsBuf);

/// A scene file made ready to run, owned: lend it to a system with [`Model::scene`].
#[derive(Clone, Debug)]
pub struct Model {
    /// The particles it begins with.
    pub particles: Vec<Particle>,
    /// Springs between them.
    pub springs: Vec<Spring>,
    /// Emitters, which bring further particles into the world.
    pub emitters: Vec<Emitter<Shape<Arc<MeshBuf>>, Option<MotionBuf>>>,
    /// The forces on them, in this order.
    pub forces: Forces,
    /// How those that have a radius answer each other's touch.
    pub contacts: Option<Response>,
    /// What binds them and keeps them apart.
    pub constraints: Constraints,
    /// Parts that each step is cut into.
    pub substeps: u32,
    /// The things that they bounce off.
    pub colliders: Scenery<Moving<Placed<Shape<Arc<MeshBuf>>>, MotionBuf>>,
    /// The other rules by which they die, beside age and sinks.
    pub reapers: Vec<ReaperKind>,
    /// The numbers that each particle has beside the engine's own attributes.
    pub custom: Vec<CustomBuf>,
    /// The materials of particles and surfaces, by numbers.
    pub materials: Vec<Material>,
    /// The solids that are drawn.
    pub scenery: Vec<Solid>,
    /// How often a particle may bounce in one step.
    pub max_bounces: u32,
    /// The method.
    pub integrator: Tuned,
    /// How forces find neighbours, and the room through whose sides they do, if there is one.
    pub index: Periodic<Structure>,
    /// Where the particles and springs of each cloth begin among all.
    pub cloths: Vec<[usize; 2]>,
    /// Where the particles of each of the file's boxes begin among all.
    pub boxes: Vec<usize>,
    /// The surfaces of cloths that have one.
    pub patches: Vec<PatchBuf>,
    /// The strands, to be drawn as curves.
    pub locks: Vec<Lock>,
    /// The shapes that particles are drawn as, by the numbers of their materials.
    pub shapes: Vec<Option<Shape<Arc<MeshBuf>>>>,
}

/// The particles that a surface spans: a [`Patch`] that owns its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchBuf {
    /// The number that its first corner has among all particles.
    pub first: u32,
    /// The number of its corners.
    pub count: u32,
    /// Its triangles, by corners counted from 0.
    pub triangles: Vec<[u32; 3]>,
    /// The number of its material, if it has one.
    pub material: Option<u16>,
}

impl PatchBuf {
    /// It, lent.
    #[must_use]
    pub fn lend(&self) -> Patch<'_> {
        Patch { first: self.first, count: self.count, triangles: &self.triangles }
    }
}

/// A piece of scenery where it stands.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its shape.
    pub shape: Shape<Arc<MeshBuf>>,
    /// Where it stands.
    pub to_world: Affine,
    /// Its material's number, if it has one.
    pub material: Option<u16>,
    /// How it moves from there.
    pub motion: MotionBuf,
}

impl Model {
    /// Makes the scene of a file that lies at `path` ready to run.
    ///
    /// # Errors
    /// If a value cannot be used or a mesh cannot be read.
    pub fn load(file: &SceneFile, path: &str, files: &mut dyn Files) -> Result<Self, SceneError> {
        file.check().map_err(|error| error.in_file(path))?;
        let mut meshes = Meshes { loaded: BTreeMap::new(), path, files, index: file.run.collision_index };
        let start = Start::of(file, &mut meshes)?;
        file.check_corners(start.particles.len()).map_err(|error| error.in_file(path))?;
        let mut emitters = Vec::with_capacity(file.emitters.len());
        for (i, emitter) in file.emitters.iter().enumerate() {
            let to_world = placement(file, emitter.group);
            let shape = meshes.moved(&format!("emitters[{i}]"), &emitter.shape, &to_world)?;
            emitters.push(with_shape(emitter, shape, &to_world, file));
        }
        let mut sinks = Vec::with_capacity(file.sinks.len());
        for (i, sink) in file.sinks.iter().enumerate() {
            let shape = meshes.moved(&format!("sinks[{i}]"), &sink.shape, &placement(file, sink.group))?;
            let Sink { intensity, ca, la, qa, softening, .. } = *sink;
            sinks.push(Sink { shape, group: None, intensity, ca, la, qa, softening });
        }
        let mut goals = Vec::with_capacity(file.goals.len());
        for (i, goal) in file.goals.iter().enumerate() {
            let shape = meshes.moved(&format!("goals[{i}]"), &goal.shape, &placement(file, goal.group))?;
            let against = goal.against.or_else(|| Some(gravity(file)));
            let Goal { start, arrive, release, settle, material, .. } = *goal;
            goals.push(Goal { shape, group: None, start, arrive, release, settle, against, material });
        }
        let mut scenery = Vec::with_capacity(file.scenery.len());
        for (i, item) in file.scenery.iter().enumerate() {
            let shape = meshes.shape(&format!("scenery[{i}].shape"), &item.shape)?;
            let material = item.material.or_else(|| file.material_of(item.group));
            let motion = item.motion.clone().unwrap_or_default();
            scenery.push(Solid { shape, to_world: placement(file, item.group), material, motion });
        }
        let shapes = file.materials.iter().enumerate().map(|(i, material)| {
            let form = material.shape.as_ref().map(|shape| &shape.form);
            form.map(|form| meshes.shape(&format!("materials[{i}].shape.form"), form)).transpose()
        });
        let shapes = shapes.collect::<Result<_, _>>()?;
        let pushes = file.contacts.iter().filter_map(|response| match response {
            Response::Force(penalty) => Some(penalty.reaching(2.0 * widest(&start.particles, &file.emitters))),
            _ => None,
        });
        let pushes = pushes.collect();
        let solid = scenery.iter().enumerate().filter(|(_, solid)| !matches!(solid.shape, Shape::Line(_)));
        let has_balls = widest(&start.particles, &file.emitters) > 0.0;
        let colliders = solid.map(|(i, solid)| {
            if has_balls && !solid.shape.meets_balls(&solid.to_world) {
                let message = "its groups squash what is round: particles with a radius can only meet it as a mesh";
                return Err(SceneError::value(format!("scenery[{i}].group"), message).in_file(path));
            }
            let placed = Placed::new(solid.shape.clone(), solid.to_world);
            let placed = placed.map(|placed| placed.made_of(solid.material));
            let moving = placed.map(|placed| Moving::new(placed.clone(), &placed.bounds(), solid.motion.clone()));
            moving.map(|moving| (moving.clone(), moving.reach())).ok_or_else(|| {
                let message = "its groups together flatten space: there is no inverse";
                SceneError::value(format!("scenery[{i}].group"), message).in_file(path)
            })
        });
        let balls = balls(file, &start);
        let forces = (file.forces.iter().cloned().chain(start.forces).collect(), sinks, pushes, goals);
        file.check_reach(&forces).map_err(|error| error.in_file(path))?;
        let room = file.room.map_or(Room::OPEN, |room| room.room());
        let index = Periodic { room, index: file.run.index };
        let constraints = file.constraints.iter().cloned().chain(start.constraints).collect();
        Ok(Self {
            particles: start.particles,
            springs: start.springs,
            emitters,
            colliders: Scenery::new(colliders.collect::<Result<_, _>>()?),
            forces,
            contacts: file.contacts,
            constraints: (
                constraints,
                RigidBodies { boxes: start.boxes, hulls: start.hulls, balls },
                file.contacts.and_then(|response| response.contacts()),
                start.contacts,
            ),
            substeps: file.run.substeps.max(file.contacts.map_or(1, |response| response.substeps())),
            reapers: file.reapers.clone(),
            custom: file.custom.clone(),
            materials: file.materials.clone(),
            scenery,
            integrator: Tuned { method: file.run.integrator, tuning: file.run.tuning },
            index,
            max_bounces: file.run.max_bounces,
            cloths: start.cloths,
            boxes: start.blocks,
            patches: start.patches,
            locks: start.locks,
            shapes,
        })
    }

    /// Tells whether particles may have a radius: some of those it begins with, or some that are born.
    #[must_use]
    pub fn has_balls(&self) -> bool {
        widest(&self.particles, &self.emitters) > 0.0
    }

    /// The scene, for a system to step through. A program adds what is its own: `Scene { forces: &(&model.forces, Mine), ..model.scene() }`.
    #[must_use]
    pub fn scene(&self) -> Scene<'_> {
        Scene {
            start: &self.particles,
            springs: &self.springs,
            emitters: &self.emitters,
            forces: &self.forces,
            colliders: &self.colliders,
            sinks: &self.forces.1,
            reapers: &self.reapers,
            custom: &self.custom,
            materials: &self.materials,
            constraints: &self.constraints,
            substeps: self.substeps,
            meetings: self.contacts.map_or(Meetings::Through, |response| response.meetings()),
            max_bounces: self.max_bounces,
            integrator: &self.integrator,
            index: &self.index,
        }
    }

    /// A system at the scene's beginning, with room for `particles` alive at once, or for all that it begins with if these are more.
    ///
    /// ```
    /// use pointmass::Time;
    /// use pointmass::scene::{Model, SceneFile};
    ///
    /// let text = r#"{"particles": [{}], "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}]}"#;
    /// let model = Model::load(&SceneFile::from_json("drop.json", text)?, "drop.json", &mut ())?;
    /// let mut system = model.system(100, 1)?;
    /// system.step_to(&model.scene(), Time::from_seconds(1.0));
    /// assert!(system.particles().position[0].y < -4.8);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn system(&self, particles: usize, seed: u64) -> Result<System<Heap>, TryReserveError> {
        let mut system = System::with(Heap::try_new(self.size(particles.max(self.particles.len())))?);
        // Memory of that size is enough.
        let _ = system.start(&self.scene(), seed);
        Ok(system)
    }

    /// The memory it needs for `particles` alive at once, lists of neighbours included.
    #[must_use]
    pub fn size(&self, particles: usize) -> Size {
        let scene = self.scene();
        Size { particles, columns: scene.columns_with_lists(), ..scene.size() }
    }
}

/// Meshes by name, each read once.
struct Meshes<'a> {
    loaded: BTreeMap<String, Arc<MeshBuf>>,
    path: &'a str,
    files: &'a mut dyn Files,
    /// How those with more than a few triangles are organised.
    index: rays::Structure,
}

impl Meshes<'_> {
    fn shape(&mut self, at: &str, shape: &Shape<String>) -> Result<Shape<Arc<MeshBuf>>, SceneError> {
        shape.with_mesh(|name| self.load(at, name))
    }

    /// The shape of what stands at a place in the file, where its groups take it.
    fn moved(&mut self, at: &str, shape: &Shape<String>, to_world: &Affine) -> Result<Shape<Arc<MeshBuf>>, SceneError> {
        let moved = self.shape(&format!("{at}.shape"), shape)?.moved(to_world, self.index);
        moved.map_err(|message| SceneError::value(format!("{at}.group"), message).in_file(self.path))
    }

    fn load(&mut self, at: &str, name: &str) -> Result<Arc<MeshBuf>, SceneError> {
        if let Some(mesh) = self.loaded.get(name) {
            return Ok(mesh.clone());
        }
        let mesh = self.files.mesh(&beside(self.path, name));
        let mesh = mesh.map_err(|message| SceneError::value(at, message).in_file(self.path))?;
        let mesh = Arc::new(mesh.organised(self.index));
        self.loaded.insert(name.to_string(), mesh.clone());
        Ok(mesh)
    }
}

/// A scene's own particles, springs and forces, with those of its cloths and boxes.
struct Start {
    particles: Vec<Particle>,
    springs: Vec<Spring>,
    /// Those of gas in cloths, and of the air around them.
    forces: Vec<ForceKind>,
    /// What holds those together that are shells, and strands.
    constraints: Vec<ConstraintKind>,
    /// Where they begin.
    cloths: Vec<[usize; 2]>,
    patches: Vec<PatchBuf>,
    boxes: Vec<RigidBox>,
    /// Where those of each of the file's boxes begin.
    blocks: Vec<usize>,
    /// The contacts of those that have a thickness.
    contacts: SheetContactsBuf,
    locks: Vec<Lock>,
    hulls: Vec<HullBuf>,
}

impl Start {
    fn of(file: &SceneFile, meshes: &mut Meshes<'_>) -> Result<Self, SceneError> {
        let mut start = Self {
            particles: file.particles.clone(),
            springs: file.springs.clone(),
            forces: Vec::new(),
            constraints: Vec::new(),
            cloths: Vec::new(),
            patches: Vec::new(),
            boxes: Vec::new(),
            blocks: Vec::new(),
            contacts: SheetContacts { particles: Vec::new(), triangles: Vec::new(), thickness: Vec::new() },
            locks: Vec::new(),
            hulls: Vec::new(),
        };
        for (i, cloth) in file.cloths.iter().enumerate() {
            let mesh = match &cloth.form {
                Form::Mesh(name) => Some(meshes.load(&format!("cloths[{i}].form"), name)?),
                Form::Sheet(_) => None,
            };
            let first = start.particles.len() as u32;
            let (particles, springs) = cloth.make(mesh.as_deref(), first);
            let refuse = |field: &str, message: String| {
                Err(SceneError::value(format!("cloths[{i}].{field}"), message).in_file(meshes.path))
            };
            if particles.iter().any(|particle| !particle.position.is_finite()) {
                return refuse("form", "reaches beyond the range of a 32-bit float".into());
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
            start.constraints.extend(cloth.shell(mesh.as_deref(), first, particles.len() as u32));
            cloth.touch(mesh.as_deref(), first, particles.len() as u32, &mut start.contacts);
            start.cloths.push([start.particles.len(), start.springs.len()]);
            start.particles.extend(particles);
            start.springs.extend(springs);
            start.patches.extend(cloth.patch(mesh.as_deref(), first));
            start.forces.extend(cloth.pressure(mesh.as_deref(), first).map(ForceKind::Pressure));
            start.forces.extend(cloth.aerodynamics(mesh.as_deref(), first, &file.forces));
        }
        for (i, boxes) in file.boxes.iter().enumerate() {
            let mesh = match &boxes.form {
                BoxForm::Mesh(name) => Some(meshes.load(&format!("boxes[{i}].form"), name)?),
                _ => None,
            };
            let hull = boxes.hull(mesh.as_deref()).transpose();
            let hull = hull.map_err(|error| {
                SceneError::value(format!("boxes[{i}].form"), error.to_string()).in_file(meshes.path)
            })?;
            let number = start.hulls.len() as u16;
            let lent = hull.as_ref().map(|hull| (number, hull.lend()));
            let (particles, bodies) = boxes.make(start.particles.len() as u32, lent);
            start.hulls.extend(hull);
            if !particles.iter().all(Particle::is_sound) {
                let message = "leaves some particles too little mass, or puts them beyond the range of a 32-bit float";
                return Err(SceneError::value(format!("boxes[{i}]"), message).in_file(meshes.path));
            }
            start.blocks.push(start.particles.len());
            start.particles.extend(particles);
            start.boxes.extend(bodies);
        }
        start.grow(file, meshes)?;
        for particle in &mut start.particles {
            particle.color = color(file, particle.color, particle.material);
        }
        Ok(start)
    }

    /// Adds the strands.
    fn grow(&mut self, file: &SceneFile, meshes: &mut Meshes<'_>) -> Result<(), SceneError> {
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
            self.constraints.extend(grown.constraints);
            self.locks.push(grown.lock);
        }
        Ok(())
    }
}

/// The largest radius that a particle of the scene may have \[m\].
fn widest<S, M>(particles: &[Particle], emitters: &[Emitter<S, M>]) -> f32 {
    let born = emitters.iter().map(|emitter| emitter.radius.mean + emitter.radius.half_width.abs());
    particles.iter().map(|particle| particle.radius).chain(born).fold(0.0, max)
}

/// Loose balls that may be near bodies at a time: all that there may be, but no more than 64 for each body, or 1,024 if that is more.
fn balls(file: &SceneFile, start: &Start) -> u32 {
    let loose = start.particles.iter().filter(|particle| particle.radius > 0.0).count();
    let born = if widest(&[], &file.emitters) > 0.0 { u32::MAX } else { 0 };
    let most = start.boxes.len().saturating_mul(64).max(1024);
    if start.boxes.is_empty() { 0 } else { born.max(loose as u32).min(most as u32) }
}

/// The uniform acceleration of all.
fn gravity(file: &SceneFile) -> Vec3 {
    let of =
        |force: &ForceKind| if let ForceKind::Gravity(gravity) = force { gravity.acceleration } else { Vec3::ZERO };
    file.forces.iter().map(of).sum()
}

/// The product of the transforms of all groups around.
fn placement(file: &SceneFile, group: Option<u32>) -> Affine {
    file.chain(group).iter().fold(Affine::IDENTITY, |outer, &index| {
        let inner = file.groups.get(index as usize).and_then(|group| group.affine().ok());
        outer.after(&inner.unwrap_or(Affine::IDENTITY))
    })
}

fn color(file: &SceneFile, own: Option<Color>, material: Option<u16>) -> Option<Color> {
    own.or_else(|| Some(file.materials.get(usize::from(material?))?.color()))
}

fn with_shape(
    emitter: &Emitter<Shape<String>, Option<MotionBuf>>,
    shape: Shape<Arc<MeshBuf>>,
    to_world: &Affine,
    file: &SceneFile,
) -> Emitter<Shape<Arc<MeshBuf>>, Option<MotionBuf>> {
    let Emitter { inside, where_sparse, rate, burst, start, stop, speed, direction, spread, velocity, inherit, .. } =
        *emitter;
    let Emitter {
        radius, mass, fixed, drag, charge, elasticity, lifetime, material, color: own, color_half_width, ..
    } = *emitter;
    let material = material.or_else(|| file.material_of(emitter.group));
    let color = color(file, own, material);
    let (direction, velocity) = (direction.map(|d| to_world.linear * d), to_world.linear * velocity);
    Emitter {
        shape,
        inside,
        where_sparse,
        group: None,
        rate,
        burst,
        start,
        stop,
        speed,
        direction,
        spread,
        velocity,
        motion: emitter.motion.clone(),
        inherit,
        radius,
        mass,
        fixed,
        drag,
        charge,
        elasticity,
        lifetime,
        material,
        color,
        color_half_width,
    }
}
