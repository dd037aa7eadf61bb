//! A declared scene made ready to run: meshes loaded, transforms multiplied out, colours settled.

use super::cloth::{PatchBuf, SheetContactsBuf};
use super::placing::{Placing, Solid, colliders};
use super::start::{Start, widest};
use super::{Files, Material, Response, Scene, SceneError, SceneFile};
use crate::collide::Meetings;
use crate::constrain::{ConstraintKind, Contacts, HullBuf, RigidBodies, RigidBox};
use crate::custom::CustomBuf;
use crate::draw::Lock;
use crate::emit::Emitter;
use crate::force::{ForceKind, Goal, Penalty, Sink, Spring};
use crate::index::{Periodic, Room, Structure};
use crate::integrate::Tuned;
use crate::memory::{Heap, Size};
use crate::motion::MotionBuf;
use crate::particles::Particle;
use crate::reap::ReaperKind;
use crate::shape::{MeshBuf, Moving, Placed, Scenery, Shape};
use crate::system::System;
use alloc::collections::{BTreeMap, TryReserveError};
use alloc::sync::Arc;
use alloc::vec::Vec;
use glam::Vec3;

/// Forces, the pull of sinks, what pushes balls apart, and what leads to goals.
pub type Forces = (Vec<ForceKind>, Vec<Sink<Arc<MeshBuf>>>, Vec<Penalty>, Vec<Goal<Arc<MeshBuf>>>);

/// The constraints of files, of cloths that are shells, of strands, ropes, soft bodies and ties, the rigid bodies, then contacts by position, and those of cloths.
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
    /// How many of the first constraints are listed in the file; those of its cloths, strands, ropes, soft bodies and ties follow.
    pub listed_constraints: usize,
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
    /// How often a particle may bounce in one sub-step.
    pub max_bounces: u32,
    /// The method.
    pub integrator: Tuned,
    /// How forces find neighbours, and the room through whose sides they do, if there is one.
    pub index: Periodic<Structure>,
    /// Where the particles and springs of each cloth begin among all.
    pub cloths: Vec<[usize; 2]>,
    /// Where the particles of each of the file's boxes begin among all.
    pub boxes: Vec<usize>,
    /// Where the particles of each of the file's ropes begin among all.
    pub ropes: Vec<usize>,
    /// Where the particles of each of the file's soft bodies begin among all.
    pub soft_bodies: Vec<usize>,
    /// The surfaces of cloths that have one.
    pub patches: Vec<PatchBuf>,
    /// The strands, then the ropes, to be drawn as curves.
    pub locks: Vec<Lock>,
    /// The meshes that rigid bodies were cut from, in their frames \[m\], by the numbers of their first hulls.
    pub surfaces: BTreeMap<u16, MeshBuf>,
    /// The shapes that particles are drawn as, by the numbers of their materials.
    pub shapes: Vec<Option<Shape<Arc<MeshBuf>>>>,
}

impl Model {
    /// Makes the scene of a file that lies at `path` ready to run.
    ///
    /// # Errors
    /// If a value cannot be used or a mesh cannot be read.
    pub fn load(file: &SceneFile, path: &str, files: &mut dyn Files) -> Result<Self, SceneError> {
        file.check().map_err(|error| error.in_file(path))?;
        let mut placed = Placing::new(path, files, file.run.collision_index);
        let start = Start::of(file, &mut placed)?;
        file.check_corners(start.particles.len()).map_err(|error| error.in_file(path))?;
        let (emitters, sinks, goals) = (placed.emitters(file)?, placed.sinks(file)?, placed.goals(file)?);
        let (scenery, shapes) = (placed.scenery(file)?, placed.forms(file)?);
        let widest = widest(&start.particles, &file.emitters);
        let pushes = file.contacts.iter().filter_map(|response| match response {
            Response::Force(penalty) => Some(penalty.reaching(2.0 * widest)),
            _ => None,
        });
        let pushes = pushes.collect();
        let colliders = colliders(&scenery, widest > 0.0).map_err(|error| error.in_file(path))?;
        let balls = start.balls(file);
        let forces = (file.forces.iter().cloned().chain(start.forces).collect(), sinks, pushes, goals);
        file.check_lengths(widest).map_err(|error| error.in_file(path))?;
        file.check_reach(&forces).map_err(|error| error.in_file(path))?;
        let room = file.room.map_or(Room::OPEN, |room| room.room());
        let index = Periodic { room, index: file.run.index };
        let constraints = file.constraints.iter().cloned().chain(start.constraints).collect();
        Ok(Self {
            particles: start.particles,
            springs: start.springs,
            emitters,
            colliders,
            forces,
            contacts: file.contacts,
            constraints: (
                constraints,
                RigidBodies { boxes: start.boxes, hulls: start.hulls, balls },
                file.contacts.and_then(|response| response.contacts()),
                start.contacts,
            ),
            listed_constraints: file.constraints.len(),
            substeps: file.substeps(),
            reapers: file.reapers.clone(),
            custom: file.custom.clone(),
            materials: file.materials.clone(),
            scenery,
            integrator: Tuned { method: file.run.integrator, tuning: file.run.tuning },
            index,
            max_bounces: file.run.max_bounces,
            cloths: start.cloths,
            boxes: start.blocks,
            ropes: start.ropes,
            soft_bodies: start.soft_bodies,
            patches: start.patches,
            locks: start.locks,
            surfaces: start.surfaces,
            shapes,
        })
    }

    /// The surface of a rigid body that is no box, in its frame \[m\]: corners, and triangles between them. It is that of the mesh that the body was
    /// cut from, or of all its hulls.
    #[must_use]
    pub fn surface(&self, body: &RigidBox) -> Option<(Vec<Vec3>, Vec<[u32; 3]>)> {
        let first = body.hull?;
        if let Some(mesh) = self.surfaces.get(&first) {
            return Some((mesh.vertices().to_vec(), mesh.triangles().to_vec()));
        }
        let first = usize::from(first);
        let hulls = self.constraints.1.hulls.get(first..first + usize::from(body.pieces))?;
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for hull in hulls.iter().map(HullBuf::lend) {
            let before = corners.len() as u32;
            corners.extend(hull.corners.iter().map(|&corner| hull.center + corner));
            for face in hull.faces {
                let (first, count) = (usize::from(face.first), usize::from(face.count));
                let list = hull.loops.get(first..first + count).unwrap_or_default();
                let number = |place: usize| before + u32::from(list[place]);
                triangles.extend((2..list.len()).map(|last| [number(0), number(last - 1), number(last)]));
            }
        }
        Some((corners, triangles))
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
            paths: Scene::EMPTY.paths,
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
        let size = scene.size_for(particles);
        Size { columns: size.columns + scene.list_columns(), ..size }
    }
}
