//! The columns that a recording holds of each particle, decided by the scene, so that they are the same in every record.

use super::frame::Kinds;
use super::solids::Solid;
use crate::outcome::{Failure, Outcome};
use pointmass::constrain::ConstraintKind;
use pointmass::scene::{Files, Form, Model, SceneFile, beside};
use pointmass::{Particle, Varied};
use std::collections::HashSet;

/// The plan of a recording.
#[derive(Debug)]
pub struct Plan {
    /// True if some particles have a radius.
    pub(super) radius: bool,
    /// True if some particles die of age.
    pub(super) remaining: bool,
    /// True if some particles never move.
    pub(super) fixed: bool,
    /// True if some particles have a coefficient of drag.
    pub(super) drag: bool,
    /// True if some particles have a charge.
    pub(super) charge: bool,
    /// True if some particles have another elasticity than those of which nothing is said.
    pub(super) elasticity: bool,
    /// True if some particles have a material.
    pub(super) material: bool,
    /// True if some particles may have another colour than opaque white.
    pub(super) color: bool,
    /// The triangles of cloths and shells, by their particles' numbers in the scene's start.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Whether each spring of the scene is an edge; those of cloths with triangles are not.
    pub(super) edges: Vec<bool>,
    /// The links of ropes, rods, strings and strands, by their ends' numbers in the scene's start.
    pub(super) links: Vec<[u32; 2]>,
    /// The rigid bodies.
    pub(super) solids: Vec<Solid>,
}

impl Plan {
    /// The plan for a scene, whose cloths may be meshes in files beside it, by its name.
    ///
    /// # Errors
    /// If such a mesh cannot be read any more.
    pub fn of(file: &SceneFile, model: &Model, scene: &str, files: &mut dyn Files) -> Outcome<Self> {
        let any = |has: &dyn Fn(&Particle) -> bool| model.particles.iter().any(has);
        let emitters = &model.emitters;
        let usual = Particle::REST.elasticity;
        let material = any(&|p| p.material.is_some()) || emitters.iter().any(|e| e.material.is_some());
        let dies = |life: Varied| life.mean + life.half_width.abs() > 0.0;
        let remaining = any(&|p| p.lifetime > 0.0) || emitters.iter().any(|e| dies(e.lifetime));
        let tinted = any(&|p| p.color.is_some()) || emitters.iter().any(|e| e.color.is_some());
        let mut plan = Self {
            radius: model.has_balls(),
            remaining,
            fixed: any(&|p| p.fixed) || emitters.iter().any(|e| e.fixed),
            drag: any(&|p| p.drag != 0.0) || emitters.iter().any(|e| !is_exactly(e.drag, 0.0)),
            charge: any(&|p| p.charge != 0.0) || emitters.iter().any(|e| !is_exactly(e.charge, 0.0)),
            elasticity: any(&|p| p.elasticity != usual) || emitters.iter().any(|e| !is_exactly(e.elasticity, usual)),
            material,
            // Who dies of age fades.
            color: material || remaining || tinted || emitters.iter().any(|e| e.color_half_width != [0; 4]),
            triangles: Vec::new(),
            edges: vec![true; model.springs.len()],
            links: Vec::new(),
            solids: Solid::all(model),
        };
        plan.add_faces(file, model, scene, files)?;
        plan.add_bonds(&model.constraints.0);
        Ok(plan)
    }

    /// What joins particles.
    pub(super) fn kinds(&self) -> Kinds {
        Kinds { faces: !self.triangles.is_empty(), edges: !self.links.is_empty() || self.edges.contains(&true) }
    }

    /// Puts in the triangles of cloths, in place of their springs.
    fn add_faces(&mut self, file: &SceneFile, model: &Model, scene: &str, files: &mut dyn Files) -> Outcome {
        let ends = model.cloths.iter().skip(1).map(|&[_, spring]| spring).chain([model.springs.len()]);
        for ((cloth, &[first, spring]), end) in file.cloths.iter().zip(&model.cloths).zip(ends) {
            let triangles: Vec<_> = match &cloth.form {
                Form::Sheet(sheet) => sheet.triangles().collect(),
                Form::Mesh(mesh) => files.mesh(&beside(scene, mesh)).map_err(Failure::new)?.triangles().to_vec(),
            };
            self.edges[spring..end].fill(triangles.is_empty());
            self.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| first as u32 + corner)));
        }
        Ok(())
    }

    /// Puts in what constraints bind together: links, and triangles that are not there already.
    fn add_bonds(&mut self, constraints: &[ConstraintKind]) {
        self.links.extend(constraints.iter().flat_map(ConstraintKind::links));
        let mut there: HashSet<_> = self.triangles.iter().copied().collect();
        let triangles = constraints.iter().flat_map(ConstraintKind::triangles);
        self.triangles.extend(triangles.filter(|triangle| there.insert(*triangle)));
    }
}

/// Whether births have no other value than this one.
fn is_exactly(range: Varied, value: f32) -> bool {
    range.mean == value && range.half_width == 0.0
}
