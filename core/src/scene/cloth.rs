//! Sheets and meshes of particles in scene files: what holds them together, and what they are made into.

use super::Isotropic;
use crate::cloth::{ClothSprings, Sheet, mesh_hinges, mesh_springs};
use crate::constrain::{ConstraintKind, SheetContacts, Shell, ShellParams, StrainLimitParams, StrainLimits};
use crate::draw::Patch;
use crate::force::{Aerodynamics, FlowKind, ForceKind, Pressure, Spring};
use crate::math::{length, min};
use crate::particles::{Color, Particle};
use crate::shape::enclosed::Enclosed;
use crate::shape::{MeshBuf, NotSolid};
use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use glam::Vec3;

/// Particles joined into a sheet, or into the form of a mesh, as a shell or by springs. They follow the scene's own particles, in
/// order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cloth {
    /// Its form.
    pub form: Form,
    /// The mass of all of it \[kg\], of which every particle has an equal share; in place of `density`.
    #[cfg_attr(feature = "serde", serde(default))]
    pub mass: f32,
    /// Its mass for each square metre \[kg/m²\], of which particles have shares by the triangles around them; in place of `mass`. What is
    /// `isotropic` may say that of a cubic metre there instead.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub density: Option<f32>,
    /// What it is made of, if it is a shell: its stiffness does not depend on the number of cells, nor on sub-steps.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub shell: Option<ShellParams>,
    /// What it is made of, if it is a sheet, by how far it stretches where it hangs by its own weight; in place of `shell`, and with a `density`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub hung: Option<Hung>,
    /// What it is made of, if that is the same in all directions, by its Young's modulus; in place of `shell`, for sheets and meshes.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub isotropic: Option<Isotropic>,
    /// How thick it is \[m\]: it then touches itself, the other cloths that have a thickness, and the scenery, without passing through
    /// any. Where there are `boxes`, its particles are balls of that diameter, to them and to all `contacts`. Without a thickness only its
    /// particles meet the scenery, and it passes through boxes.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub thickness: Option<f32>,
    /// How the air pushes it: that of all `wind` among the scene's forces, or still air.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub air: Option<Air>,
    /// Its springs, at rest in this form; beside a shell it needs none.
    #[cfg_attr(feature = "serde", serde(default, alias = "threads"))]
    pub springs: ClothSprings,
    /// Springs break where a step ends with them so many times as long as at rest.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub breaks_at: Option<f32>,
    /// How far its triangles stretch, shrink and shear at the most, if it is made of springs: these give what softness it has within.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub limits: Option<StrainLimitParams>,
    /// Gas inside, if it is a closed mesh seen from outside anticlockwise.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub gas: Option<Gas>,
    /// The particles that never move, by their number in this cloth from 0: along a sheet's first side first.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub fixed: Vec<u32>,
    /// How it moves to begin with \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// Coefficient of linear drag \[kg/s\] of each particle.
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: f32,
    /// The share of the normal speed that particles keep when they hit something.
    #[cfg_attr(feature = "serde", serde(default))]
    pub elasticity: f32,
    /// Number of the material in the scene, if it has one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Its colour; without one, that of its material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<Color>,
}

/// What a sheet is made of, by what can be seen of it where it hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hung {
    /// By how many percent it is longer where it hangs along its first side, and along its second, held by the whole edge above, by its own weight on
    /// Earth: the mean of the edge below is lower by that share of the side, about ρ g L / (2 k), however many cells it has. A metre of cotton has
    /// about 0.05, of jersey 1.
    pub stretch: [f32; 2],
    /// How stiff it is against shear, a share of the mean stiffness along both sides: half of that is what a material has that is the same in
    /// all directions, cloth has less.
    #[cfg_attr(feature = "serde", serde(default = "usual_shear"))]
    pub shear: f32,
    /// Bending stiffness \[N m\]: silk has about 1e-6, cotton 1e-5, denim 1e-4, paper 1e-3.
    #[cfg_attr(feature = "serde", serde(default))]
    pub bending: f32,
    /// How long stresses take to fade whose strain stands still \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

#[cfg(feature = "serde")]
const fn usual_shear() -> f32 {
    0.1
}

/// Standard gravity \[m/s²\].
const EARTH: f32 = 9.80665;

/// The weight over the stiffness of a sheet that hangs by an edge, so that it is longer by so many percent.
///
/// A shell that is stretched by a share e is pulled with k (1 + e) (e + e²/2) a metre (Saint-Venant and Kirchhoff). Where all of it hangs below that is
/// the weight, and the mean of the strain from there down to the other edge, ∫ x dT / T, is e (1 + 2 e + ¾ e²) / (2 + 3 e + e²).
fn hung_strain(percent: f32) -> f32 {
    let mean = 0.01 * percent;
    let mut e = 2.0 * mean;
    for _ in 0..40 {
        e = mean * (2.0 + 3.0 * e + e * e) / (1.0 + 2.0 * e + 0.75 * e * e);
    }
    (1.0 + e) * (e + 0.5 * e * e)
}

/// Air around a cloth: see [`Aerodynamics`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Air {
    /// Its density \[kg/m³\].
    pub density: f32,
    /// The coefficient of drag of a plate across the wind.
    pub drag: f32,
    /// The coefficient of lift, at 45° twice what it lifts by.
    pub lift: f32,
    /// The coefficient of drag of a plate along the wind.
    pub friction: f32,
}

impl Default for Air {
    fn default() -> Self {
        let Aerodynamics { density, drag, lift, friction, .. } = Aerodynamics::still(());
        Self { density, drag, lift, friction }
    }
}

/// Gas in a cloth: see [`Pressure`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gas {
    /// How much there is: n R T \[J\], which is pressure times volume.
    pub amount: f32,
    /// The pressure outside \[Pa\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub outside: f32,
}

/// The form of a cloth.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Form {
    /// A rectangle of cells.
    Sheet(Sheet),
    /// A triangle mesh by its file, relative to the scene's.
    Mesh(String),
}

/// The contacts of cloths with each other.
pub type SheetContactsBuf = SheetContacts<Vec<u32>, Vec<[u32; 3]>, Vec<f32>>;

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

/// The flows of all winds among a scene's forces.
pub(super) fn winds(forces: &[ForceKind]) -> Vec<FlowKind> {
    let winds = forces.iter().filter_map(|force| if let ForceKind::Wind(wind) = force { Some(wind) } else { None });
    winds.flat_map(|wind| wind.field.iter().copied()).collect()
}

impl Cloth {
    /// Its particles and springs, the first particle having number `first` in the scene's start; `mesh` is that of its form.
    pub(super) fn make(&self, mesh: Option<&MeshBuf>, first: u32) -> (Vec<Particle>, Vec<Spring>) {
        let (positions, springs): (Vec<Vec3>, Vec<Spring>) = match (&self.form, mesh) {
            (Form::Sheet(sheet), _) => (sheet.positions().collect(), sheet.springs(&self.springs, first).collect()),
            (Form::Mesh(_), Some(mesh)) => {
                (mesh.vertices().to_vec(), mesh_springs(mesh.vertices(), mesh.triangles(), &self.springs, first))
            }
            (Form::Mesh(_), None) => (Vec::new(), Vec::new()),
        };
        let density = self.by_area();
        let mass = if density.is_some() { 0.0 } else { self.mass / positions.len().max(1) as f32 };
        let like = Particle {
            mass,
            velocity: self.velocity,
            drag: self.drag,
            elasticity: self.elasticity,
            material: self.material,
            color: self.color,
            ..Particle::REST
        };
        let mut particles: Vec<_> = positions.into_iter().map(|position| Particle { position, ..like }).collect();
        for corners in density.iter().flat_map(|_| self.triangles(mesh)) {
            let [a, b, c] = corners.map(|corner| particles.get(corner as usize).map_or(Vec3::ZERO, |p| p.position));
            let third = density.unwrap_or(0.0) * length((b - a).cross(c - a)) / 6.0;
            for corner in corners {
                if let Some(particle) = particles.get_mut(corner as usize) {
                    particle.mass += third;
                }
            }
        }
        for &number in &self.fixed {
            if let Some(particle) = particles.get_mut(number as usize) {
                particle.fixed = true;
            }
        }
        (particles, springs.into_iter().map(|spring| Spring { breaks_at: self.breaks_at, ..spring }).collect())
    }

    /// The mass of a square metre of it \[kg/m²\], if it says that.
    pub(super) fn by_area(&self) -> Option<f32> {
        self.density.or_else(|| self.isotropic?.by_area())
    }

    /// Tells whether it is a shell.
    pub(super) fn is_shell(&self) -> bool {
        self.shell.is_some() || self.hung.is_some() || self.isotropic.is_some()
    }

    /// Tells whether it is nothing without triangles: one that weighs by its area, or a shell.
    pub(super) fn needs_triangles(&self) -> bool {
        self.by_area().is_some() || self.is_shell()
    }

    /// Its form, if that is a sheet.
    pub(super) fn sheet(&self) -> Option<&Sheet> {
        if let Form::Sheet(sheet) = &self.form { Some(sheet) } else { None }
    }

    /// Its triangles, by its particles counted from 0.
    fn triangles(&self, mesh: Option<&MeshBuf>) -> Vec<[u32; 3]> {
        match (&self.form, mesh) {
            (Form::Sheet(sheet), _) => sheet.triangles().collect(),
            (Form::Mesh(_), mesh) => mesh.map_or_else(Vec::new, |mesh| mesh.triangles().to_vec()),
        }
    }

    /// The length of its shortest edge \[m\].
    pub(super) fn shortest_edge(&self, mesh: Option<&MeshBuf>, particles: &[Particle]) -> f32 {
        let place = |corner: u32| particles.get(corner as usize).map_or(Vec3::INFINITY, |particle| particle.position);
        let edges = self.triangles(mesh).into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
        edges.map(|edge| length(place(edge[0]) - place(edge[1]))).fold(f32::INFINITY, min)
    }

    /// The mean mass of its particles \[kg\], if that is known before a mesh is read.
    pub(super) fn point_mass(&self) -> Option<f32> {
        let Form::Sheet(sheet) = &self.form else { return None };
        let [a, b] = sheet.sides;
        let area = length(a.cross(b));
        let whole = self.by_area().map_or(self.mass, |density| density * area);
        Some(whole / self.count().unwrap_or(1).max(1) as f32)
    }

    /// What it is made of, if it is a shell.
    pub(super) fn shell_params(&self) -> Option<ShellParams> {
        let stretch = |Hung { stretch, .. }: Hung| {
            let Form::Sheet(sheet) = &self.form else { return None };
            let weight = |side: usize| self.density.map(|density| density * EARTH * length(sheet.sides[side]));
            Some([weight(0)? / hung_strain(stretch[0]), weight(1)? / hung_strain(stretch[1])])
        };
        self.shell.or_else(|| self.isotropic.map(Isotropic::params)).or_else(|| {
            let of = self.hung?;
            let [warp, weft] = stretch(of)?;
            let shear = of.shear * (0.5 * warp + 0.5 * weft);
            Some(ShellParams { stretch: [warp, weft], shear, bending: of.bending, damping: of.damping })
        })
    }

    /// What holds it together, if it is a shell; its particles are those from `first` on, so many.
    pub(super) fn shell(&self, mesh: Option<&MeshBuf>, first: u32, count: u32) -> Option<ConstraintKind> {
        let params = self.shell_params()?;
        let triangles = self.triangles(mesh);
        let (warp, hinges) = match &self.form {
            Form::Sheet(sheet) => (sheet.sides[0], sheet.hinges().collect()),
            Form::Mesh(_) => (Vec3::X, mesh_hinges(&triangles)),
        };
        let particles = (first..first.saturating_add(count)).collect();
        Some(ConstraintKind::Shell(Shell { particles, triangles, hinges, warp, params }))
    }

    /// What keeps its strain within limits, if it has any; its first particle is this one.
    pub(super) fn strain_limits(&self, mesh: Option<&MeshBuf>, first: u32) -> Option<ConstraintKind> {
        let params = self.limits?;
        let warp = if let Form::Sheet(sheet) = &self.form { sheet.sides[0] } else { Vec3::X };
        let triangles = self.triangles(mesh).iter().map(|corners| corners.map(|corner| first + corner)).collect();
        Some(ConstraintKind::StrainLimits(StrainLimits { triangles, warp, params }))
    }

    /// Adds it to the sheets that touch each other, if it has a thickness; its particles are those from `first` on, so many.
    pub(super) fn touch(&self, mesh: Option<&MeshBuf>, first: u32, count: u32, contacts: &mut SheetContactsBuf) {
        let Some(thickness) = self.thickness else { return };
        let place = contacts.particles.len() as u32;
        contacts.particles.extend(first..first.saturating_add(count));
        contacts.triangles.extend(self.triangles(mesh).iter().map(|corners| corners.map(|corner| place + corner)));
        contacts.thickness.resize(contacts.triangles.len(), thickness);
    }

    /// The push of the air.
    pub(super) fn aerodynamics(&self, mesh: Option<&MeshBuf>, first: u32, forces: &[ForceKind]) -> Option<ForceKind> {
        let Air { density, drag, lift, friction } = self.air?;
        let triangles = self.triangles(mesh).iter().map(|corners| corners.map(|corner| first + corner)).collect();
        let field = winds(forces);
        Some(ForceKind::Aerodynamics(Aerodynamics { triangles, field, density, drag, lift, friction }))
    }

    /// The push of its gas.
    pub(super) fn pressure(&self, mesh: Option<&MeshBuf>, first: u32) -> Option<Pressure<Vec<[u32; 3]>>> {
        let Gas { amount, outside } = self.gas?;
        let triangles = mesh?.triangles().iter().map(|corners| corners.map(|corner| first + corner)).collect();
        Some(Pressure { triangles, amount, outside })
    }

    /// What keeps its mesh from holding gas, if it is to hold any.
    pub(super) fn leak(&self, mesh: Option<&MeshBuf>) -> Option<String> {
        let mesh = mesh.filter(|_| self.gas.is_some())?;
        match Enclosed::of(mesh) {
            // Shells that pass through each other hold theirs all the same.
            Ok(_) | Err(NotSolid::Crossing(_)) => {}
            Err(why) => return Some(format!("needs a closed mesh to be held by; this one {why}")),
        }
        let edges = || mesh.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let sides: BTreeSet<_> = edges().collect();
        let seams = edges().filter(|&[a, b]| !sides.contains(&[b, a])).count();
        if seams > 0 {
            return Some(format!(
                "needs triangles that share their corners; {seams} edges of this mesh have corners of their own in the same places, and \
                 come apart: join them"
            ));
        }
        let place = |corner: u32| mesh.vertices()[corner as usize] - mesh.vertices()[0];
        let volume = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(place);
            a.dot(b.cross(c))
        };
        let is_inside_out = mesh.triangles().iter().map(volume).sum::<f32>() < 0.0;
        is_inside_out
            .then(|| "needs a mesh seen from outside anticlockwise; this one is inside out: turn its triangles".into())
    }

    /// Its surface, if it has one.
    pub(super) fn patch(&self, mesh: Option<&MeshBuf>, first: u32) -> Option<PatchBuf> {
        let count = match (&self.form, mesh) {
            (Form::Sheet(sheet), _) => sheet.positions().count(),
            (Form::Mesh(_), mesh) => mesh?.vertices().len(),
        };
        let triangles = self.triangles(mesh);
        (!triangles.is_empty()).then_some(PatchBuf { first, count: count as u32, triangles, material: self.material })
    }

    /// The particles of a sheet; those of a mesh are known once it is read.
    pub(super) fn count(&self) -> Option<u64> {
        Some(self.sheet()?.cells.iter().fold(1, |product: u64, &n| product.saturating_mul(u64::from(n) + 1)))
    }
}
