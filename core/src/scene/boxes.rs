//! Rigid boxes and other bodies in scene files: one, or a block of many that differ by chance.

use crate::constrain::{CompoundBuf, CompoundError, HullError, RigidBox};
use crate::math::{high, length, low, sin_cos, unit};
use crate::particles::{Color, Particle};
use crate::rng::Stream;
use crate::shape::MeshBuf;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use glam::Vec3;

/// Solid boxes, dice or stones that collide as such, each of eight particles (see [`RigidBodies`](crate::RigidBodies)). The particles follow the
/// scene's own and those of cloths, in order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Boxes {
    /// What they are: a box unless it says otherwise, the convex hull of some points, or a body of several pieces, which need not be convex.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "BoxForm::is_box"))]
    pub form: BoxForm,
    /// The lengths of a box's sides \[m\]; of the sides of the upright box around another form, which is stretched to fill it. Without them points and
    /// meshes are as large as they are; a box or a die needs them.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[f32; 3]>"))]
    pub sides: Option<Vec3>,
    /// The mass of each \[kg\], in place of `density`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub mass: f32,
    /// The mass of a cubic metre of what they are made of \[kg/m³\], in place of `mass`.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub density: Option<f32>,
    /// Where the middle of the first is, its centre of mass \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// How many there are along x, y and z.
    #[cfg_attr(feature = "serde", serde(default = "one"))]
    pub count: [u32; 3],
    /// From one's middle to the next one's along x, y and z \[m\]; without it the sides, so that they touch.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[f32; 3]>"))]
    pub spacing: Option<Vec3>,
    /// How each is turned: by the length of this \[rad\], about its direction.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub turn: Vec3,
    /// How each moves to begin with \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// How each turns to begin with \[rad/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub spin: Vec3,
    /// By how much each may differ from that.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub scatter: Option<Scatter>,
    /// By how much a side along x, y and z is heavier than the one across, from −1 to 1: loaded dice.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub load: Vec3,
    /// True if they never move.
    #[cfg_attr(feature = "serde", serde(default))]
    pub fixed: bool,
    /// Coefficient of linear drag of each box \[kg/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: f32,
    /// The share of the normal speed that they keep when they hit something.
    #[cfg_attr(feature = "serde", serde(default))]
    pub elasticity: f32,
    /// Number of the material in the scene, if they have one.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Their colours, one after the other and again from the first; without any, that of their material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub colors: Vec<Color>,
}

/// The form of boxes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum BoxForm {
    /// A box, or a die of six faces.
    #[default]
    Box,
    /// A die of four triangles.
    Tetrahedron,
    /// A die of eight triangles.
    Octahedron,
    /// A die of twelve pentagons.
    Dodecahedron,
    /// A die of twenty triangles.
    Icosahedron,
    /// The convex hull of these points.
    #[cfg_attr(feature = "schema", schemars(with = "alloc::vec::Vec<[f32; 3]>"))]
    Points(Vec<Vec3>),
    /// The convex hull of a triangle mesh by its file, relative to the scene's.
    Mesh(String),
    /// The convex hulls of several groups of points, together: they may touch, as the two arms of an L, or overlap, where the mass counts twice.
    #[cfg_attr(feature = "schema", schemars(with = "alloc::vec::Vec<alloc::vec::Vec<[f32; 3]>>"))]
    Pieces(Vec<Vec<Vec3>>),
    /// A closed triangle mesh as it is, with its hollows and holes.
    Solid(SolidMesh),
}

/// A closed triangle mesh that bodies have the form of: cut into convex pieces when the scene is loaded, with the mass, centre and inertia of the mesh
/// itself.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SolidMesh {
    /// Its file, relative to the scene's.
    pub mesh: String,
    /// How far the pieces may be off its surface \[m\].
    pub within: f32,
    /// How many pieces there may be, from 1 to 255.
    #[cfg_attr(feature = "serde", serde(default = "many"))]
    pub pieces: u16,
}

impl BoxForm {
    #[cfg(feature = "serde")]
    fn is_box(&self) -> bool {
        *self == Self::Box
    }

    /// Tells whether it says itself how large it is.
    pub(super) fn has_size(&self) -> bool {
        matches!(self, Self::Points(_) | Self::Mesh(_) | Self::Pieces(_) | Self::Solid(_))
    }

    /// The file of its mesh, if it has one.
    pub(super) fn file(&self) -> Option<&str> {
        match self {
            Self::Mesh(name) => Some(name),
            Self::Solid(solid) => Some(&solid.mesh),
            _ => None,
        }
    }

    /// The points whose convex hulls its pieces are; `mesh` is that of its file. A box has none.
    fn points(&self, mesh: Option<&MeshBuf>) -> Option<Vec<Vec<Vec3>>> {
        /// The golden ratio.
        const PHI: f32 = 1.618_034;
        let signs = |x: f32, y: f32, z: f32| {
            (0..8).map(move |i| {
                let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
                Vec3::new(x * sign(0), y * sign(1), z * sign(2))
            })
        };
        // Both signs of nothing are one: a hull does not mind points twice.
        let turned = |y: f32, z: f32| signs(0.0, y, z).chain(signs(z, 0.0, y)).chain(signs(y, z, 0.0));
        let points = match self {
            Self::Box => return None,
            Self::Pieces(pieces) => return Some(pieces.clone()),
            Self::Tetrahedron => signs(1.0, 1.0, 1.0).filter(|v| v.x * v.y * v.z > 0.0).collect(),
            Self::Octahedron => turned(0.0, 1.0).collect(),
            Self::Dodecahedron => signs(1.0, 1.0, 1.0).chain(turned(1.0 / PHI, PHI)).collect(),
            Self::Icosahedron => turned(1.0, PHI).collect(),
            Self::Points(points) => points.clone(),
            Self::Mesh(_) | Self::Solid(_) => mesh?.vertices().to_vec(),
        };
        Some(Vec::from([points]))
    }
}

/// How much boxes differ by chance: along each axis evenly between less and more by so much.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Scatter {
    /// In place \[m\].
    pub position: f32,
    /// In turn \[rad\].
    pub turn: f32,
    /// In velocity \[m/s\].
    pub velocity: f32,
    /// In rate of turning \[rad/s\].
    pub spin: f32,
    /// Another number makes another throw.
    pub seed: u32,
}

/// As many pieces as a mesh is cut into where a scene says nothing.
#[cfg(feature = "serde")]
const fn many() -> u16 {
    64
}

/// Tells whether a mass is left out.
#[cfg(feature = "serde")]
fn is_zero(mass: &f32) -> bool {
    *mass == 0.0
}

/// One box.
#[cfg(feature = "serde")]
const fn one() -> [u32; 3] {
    [1; 3]
}

impl Boxes {
    /// How many there are.
    pub(super) fn number(&self) -> u64 {
        self.count.iter().fold(1, |product: u64, &n| product.saturating_mul(u64::from(n)))
    }

    /// How many particles they are.
    pub(super) fn particles(&self) -> u64 {
        self.number().saturating_mul(8)
    }

    /// The form of each, if they are no boxes, and the mesh that it was cut from, about its centre of mass; `mesh` is that of its file.
    pub(super) fn compound(&self, mesh: Option<&MeshBuf>) -> Option<Result<(CompoundBuf, Option<MeshBuf>), String>> {
        let mut pieces = self.form.points(mesh)?;
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let all = || pieces.iter().flatten();
        let (least, most) = all().fold(start, |(a, b), &point| (low(a, point), high(b, point)));
        let (middle, stretch) = ((least + most) * 0.5, self.sides.map_or(Vec3::ONE, |sides| sides / (most - least)));
        if !(all().all(|point| point.is_finite()) && stretch.is_finite()) {
            let error = if (least - most).is_finite() { HullError::Flat } else { HullError::NotFinite };
            return Some(Err(error.to_string()));
        }
        pieces.iter_mut().flatten().for_each(|point| *point = (*point - middle) * stretch);
        let told = |error: CompoundError| match error {
            CompoundError::Hull(_, error) if pieces.len() == 1 => error.to_string(),
            error => error.to_string(),
        };
        let (BoxForm::Solid(solid), Some(mesh)) = (&self.form, mesh) else {
            return Some(CompoundBuf::of(&pieces).map(|form| (form, None)).map_err(told));
        };
        let sized = |places: Vec<Vec3>| MeshBuf::new(places, mesh.triangles().to_vec()).map_err(|bad| bad.to_string());
        let cut = sized(pieces[0].clone()).and_then(|sized| {
            CompoundBuf::of_mesh(&sized, solid.within, usize::from(solid.pieces)).map_err(|error| error.to_string())
        });
        Some(cut.and_then(|form| {
            let places = pieces[0].iter().map(|&place| place - form.center()).collect();
            Ok((form, Some(sized(places)?)))
        }))
    }

    /// The sides of the upright box around one \[m\]; `mesh` is that of its file. None, if that is not said, or not known without the mesh.
    pub(super) fn size(&self, mesh: Option<&MeshBuf>) -> Option<Vec3> {
        self.sides.or_else(|| {
            let points = self.form.points(mesh).filter(|_| self.form.has_size())?;
            let all = points.iter().flatten().copied();
            Some(all.clone().reduce(high)? - all.reduce(low)?)
        })
    }

    /// The mass of each \[kg\]; none, if that is not known without its mesh.
    pub(super) fn weight(&self) -> Option<f32> {
        let Some(density) = self.density else { return Some(self.mass) };
        let volume = match self.compound(None) {
            None => self.sides.filter(|_| self.form == BoxForm::Box)?.to_array().iter().product(),
            Some(form) => form.ok()?.0.volume(),
        };
        Some(density * volume)
    }

    /// Its particles and bodies of such a size \[m\], the first particle having number `first` in the scene's start; `form` is that of each, and the
    /// number of its first hull.
    pub(super) fn make(
        &self,
        first: u32,
        size: Vec3,
        form: Option<(u16, &CompoundBuf)>,
    ) -> (Vec<Particle>, Vec<RigidBox>) {
        let [nx, ny, nz] = self.count;
        let volume = form.map_or_else(|| size.to_array().iter().product(), |(_, form)| form.volume());
        let mass = self.density.map_or(self.mass, |density| density * volume);
        let places = (0..ny).flat_map(|y| (0..nz).flat_map(move |z| (0..nx).map(move |x| [x, y, z])));
        let (mut particles, mut bodies) = (Vec::new(), Vec::new());
        for (number, place) in places.enumerate() {
            let (mut body, whole, spin) = self.body(number as u32, place, first + particles.len() as u32, size);
            let whole = Particle { mass, ..whole };
            if let Some((number, form)) = form {
                let RigidBox { half, pieces, .. } = RigidBox::with_compound(form, number, body.center, body.first);
                body = RigidBox { hull: Some(number), half, pieces, ..body };
            }
            let solid = form.map_or_else(|| body.solid(whole), |(_, form)| body.solid_compound(form, whole));
            let load = |i: usize, axis: usize| if i >> axis & 1 == 1 { self.load[axis] } else { -self.load[axis] };
            particles.extend(solid.into_iter().enumerate().map(|(i, corner)| Particle {
                velocity: corner.velocity + spin.cross(corner.position - body.center),
                mass: corner.mass * (0..3).map(|axis| 1.0 + load(i, axis)).product::<f32>(),
                ..corner
            }));
            bodies.push(body);
        }
        (particles, bodies)
    }

    /// The box with a number, its particles in one but for their mass, and how it turns.
    fn body(&self, number: u32, place: [u32; 3], first: u32, size: Vec3) -> (RigidBox, Particle, Vec3) {
        let chance = self.scatter.unwrap_or_default();
        let stream = Stream::new(u64::from(chance.seed), u32::MAX, number);
        let vary = |place: u32, by: f32| {
            let ([x, y], [z, _]) = (stream.units(2 * place), stream.units(2 * place + 1));
            (Vec3::new(x, y, z) * 2.0 - 1.0) * by
        };
        let step = self.spacing.unwrap_or(size) * Vec3::from_array(place.map(|n| n as f32));
        let turn = self.turn + vary(1, chance.turn);
        let (sin, cos) = sin_cos(0.5 * length(turn));
        let [x, y, z] = (unit(turn) * sin).to_array();
        let center = self.position + step + vary(0, chance.position);
        let body = RigidBox { turn: [x, y, z, cos], ..RigidBox::new(size * 0.5, center, first) };
        let color = (!self.colors.is_empty()).then(|| self.colors[number as usize % self.colors.len()]);
        let whole = Particle {
            velocity: self.velocity + vary(2, chance.velocity),
            drag: self.drag * 0.125,
            elasticity: self.elasticity,
            material: self.material,
            fixed: self.fixed,
            color,
            ..Particle::REST
        };
        (body, whole, self.spin + vary(3, chance.spin))
    }
}
