//! Things with a shape in a scene file, placed where their groups take them: each mesh is read once.

use super::references::color;
use super::{Files, SceneError, SceneFile, beside};
use crate::emit::Emitter;
use crate::force::{ForceKind, Goal, Sink};
use crate::motion::MotionBuf;
use crate::rays;
use crate::shape::{Affine, MeshBuf, Moving, Placed, Scenery, Shape};
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;
use glam::Vec3;

/// A shape whose mesh, if it is one, has been read.
type Loaded = Shape<Arc<MeshBuf>>;

/// The things that particles bounce off.
pub(super) type Colliders = Scenery<Moving<Placed<Loaded>, MotionBuf>>;

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

/// Puts things where they stand, and keeps the meshes that it has read, by name.
pub(super) struct Placing<'a> {
    loaded: BTreeMap<String, Arc<MeshBuf>>,
    pub(super) path: &'a str,
    files: &'a mut dyn Files,
    /// How those with more than a few triangles are organised.
    index: rays::Structure,
}

impl<'a> Placing<'a> {
    pub(super) fn new(path: &'a str, files: &'a mut dyn Files, index: rays::Structure) -> Self {
        Self { loaded: BTreeMap::new(), path, files, index }
    }

    pub(super) fn shape(&mut self, at: &str, shape: &Shape<String>) -> Result<Loaded, SceneError> {
        shape.with_mesh(|name| self.load(at, name))
    }

    /// The shape of what stands at a place in the file, where its groups take it.
    fn moved(&mut self, at: &str, shape: &Shape<String>, to_world: &Affine) -> Result<Loaded, SceneError> {
        let moved = self.shape(&format!("{at}.shape"), shape)?.moved(to_world, self.index);
        moved.map_err(|message| SceneError::value(format!("{at}.group"), message).in_file(self.path))
    }

    pub(super) fn load(&mut self, at: &str, name: &str) -> Result<Arc<MeshBuf>, SceneError> {
        if let Some(mesh) = self.loaded.get(name) {
            return Ok(mesh.clone());
        }
        let mesh = self.files.mesh(&beside(self.path, name));
        let mesh = mesh.map_err(|message| SceneError::value(at, message).in_file(self.path))?;
        let mesh = Arc::new(mesh.organised(self.index));
        self.loaded.insert(name.to_string(), mesh.clone());
        Ok(mesh)
    }

    pub(super) fn emitters(&mut self, file: &SceneFile) -> Result<Vec<Emitter<Loaded, Option<MotionBuf>>>, SceneError> {
        let emitters = file.emitters.iter().enumerate().map(|(i, emitter)| {
            let to_world = placement(file, emitter.group);
            let shape = self.moved(&format!("emitters[{i}]"), &emitter.shape, &to_world)?;
            Ok(with_shape(emitter, shape, &to_world, file))
        });
        emitters.collect()
    }

    pub(super) fn sinks(&mut self, file: &SceneFile) -> Result<Vec<Sink<Arc<MeshBuf>>>, SceneError> {
        let sinks = file.sinks.iter().enumerate().map(|(i, sink)| {
            let shape = self.moved(&format!("sinks[{i}]"), &sink.shape, &placement(file, sink.group))?;
            let Sink { intensity, ca, la, qa, softening, .. } = *sink;
            Ok(Sink { shape, group: None, intensity, ca, la, qa, softening })
        });
        sinks.collect()
    }

    pub(super) fn goals(&mut self, file: &SceneFile) -> Result<Vec<Goal<Arc<MeshBuf>>>, SceneError> {
        let goals = file.goals.iter().enumerate().map(|(i, goal)| {
            let shape = self.moved(&format!("goals[{i}]"), &goal.shape, &placement(file, goal.group))?;
            let against = goal.against.or_else(|| Some(gravity(file)));
            let Goal { start, arrive, release, settle, material, .. } = *goal;
            Ok(Goal { shape, group: None, start, arrive, release, settle, against, material })
        });
        goals.collect()
    }

    pub(super) fn scenery(&mut self, file: &SceneFile) -> Result<Vec<Solid>, SceneError> {
        let scenery = file.scenery.iter().enumerate().map(|(i, item)| {
            let shape = self.shape(&format!("scenery[{i}].shape"), &item.shape)?;
            let material = item.material.or_else(|| file.material_of(item.group));
            let motion = item.motion.clone().unwrap_or_default();
            Ok(Solid { shape, to_world: placement(file, item.group), material, motion })
        });
        scenery.collect()
    }

    /// The shapes that particles are drawn as, by the numbers of their materials.
    pub(super) fn forms(&mut self, file: &SceneFile) -> Result<Vec<Option<Loaded>>, SceneError> {
        let forms = file.materials.iter().enumerate().map(|(i, material)| {
            let form = material.shape.as_ref().map(|shape| &shape.form);
            form.map(|form| self.shape(&format!("materials[{i}].shape.form"), form)).transpose()
        });
        forms.collect()
    }
}

/// Makes of scenery what particles bounce off: all but lines.
pub(super) fn colliders(scenery: &[Solid], has_balls: bool) -> Result<Colliders, SceneError> {
    let solid = scenery.iter().enumerate().filter(|(_, solid)| !matches!(solid.shape, Shape::Line(_)));
    let colliders = solid.map(|(i, solid)| {
        let refuse = |message: &str| SceneError::value(format!("scenery[{i}].group"), message);
        if has_balls && !solid.shape.meets_balls(&solid.to_world) {
            return Err(refuse("its groups squash what is round: particles with a radius can only meet it as a mesh"));
        }
        let placed = Placed::new(solid.shape.clone(), solid.to_world);
        let placed = placed.map(|placed| placed.made_of(solid.material));
        let moving = placed.map(|placed| Moving::new(placed.clone(), &placed.bounds(), solid.motion.clone()));
        moving
            .map(|moving| (moving.clone(), moving.reach()))
            .ok_or_else(|| refuse("its groups together flatten space: there is no inverse"))
    });
    Ok(Scenery::new(colliders.collect::<Result<_, _>>()?))
}

/// The uniform acceleration of all.
fn gravity(file: &SceneFile) -> Vec3 {
    let of =
        |force: &ForceKind| if let ForceKind::Gravity(gravity) = force { gravity.acceleration } else { Vec3::ZERO };
    file.forces.iter().map(of).sum()
}

/// The product of the transforms of all groups around.
pub(super) fn placement(file: &SceneFile, group: Option<u32>) -> Affine {
    file.chain(group).iter().fold(Affine::IDENTITY, |outer, &index| {
        let inner = file.groups.get(index as usize).and_then(|group| group.affine().ok());
        outer.after(&inner.unwrap_or(Affine::IDENTITY))
    })
}

/// An emitter of the file, its shape being where its groups take it.
fn with_shape(
    emitter: &Emitter<Shape<String>, Option<MotionBuf>>,
    shape: Loaded,
    to_world: &Affine,
    file: &SceneFile,
) -> Emitter<Loaded, Option<MotionBuf>> {
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
