//! How solids of scene files are filled with particles: at the crossings of a grid, as many as there is room for.

use crate::math::{floor, max};
use crate::shape::enclosed::Enclosed;
use crate::shape::{MeshBuf, Surface};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use glam::Vec3;

/// What soft bodies are.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum SoftForm {
    /// A box of these sides \[m\].
    Box(#[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))] Vec3),
    /// A closed triangle mesh by its file, relative to the scene's.
    Mesh(String),
}

/// A field of a soft body that cannot be used, and why.
pub(super) type Fault = (&'static str, String);

/// As many particles as the soft bodies of a scene may have.
pub(super) const MOST_OF_SOFT: u64 = 1 << 18;
/// As many places as are tried around a mesh.
const MOST_TRIED: u64 = 1 << 22;

/// What fills a solid.
pub(super) struct Filling {
    /// Where its particles are, from the centre of all of them \[m\].
    pub(super) places: Vec<Vec3>,
    /// The solid's volume \[m³\].
    pub(super) volume: f32,
    /// The sides of the upright box around it \[m\].
    pub(super) size: Vec3,
}

/// The cells of a box of these sides, as near to a spacing as whole numbers of them allow, and the sides of a cell.
pub(super) fn boxed(sides: Vec3, spacing: f32) -> ([u32; 3], Vec3) {
    let cells = (sides / spacing).to_array().map(|many| max(floor(many + 0.5), 1.0) as u32);
    (cells, sides / Vec3::from_array(cells.map(|n| n as f32)))
}

/// Fills a form, so many times as large as it says, at a spacing \[m\]; `mesh` is that of its file.
pub(super) fn filled(form: &SoftForm, mesh: Option<&MeshBuf>, scale: f32, spacing: f32) -> Result<Filling, Fault> {
    let (size, volume, middle, solid) = match (form, mesh) {
        (SoftForm::Box(sides), _) => {
            let size = *sides * scale;
            (size, size.x * size.y * size.z, Vec3::ZERO, None)
        }
        (SoftForm::Mesh(_), None) => return Err(("form", "has no mesh".into())),
        (SoftForm::Mesh(_), Some(mesh)) => {
            let bounds = mesh.bounds();
            let volume = volume(mesh)? * f64::from(scale) * f64::from(scale) * f64::from(scale);
            ((bounds.max - bounds.min) * scale, volume as f32, (bounds.min + bounds.max) * 0.5, Some(mesh))
        }
    };
    if !(size.is_finite() && volume.is_finite() && volume > 0.0) {
        return Err(("scale", format!("makes it {volume:?} m³ large, which 32-bit floats cannot tell")));
    }
    let (cells, side) = boxed(size, spacing);
    let tried = cells.iter().fold(1, |product: u64, &n| product.saturating_mul(u64::from(n)));
    let most = if solid.is_some() { MOST_TRIED } else { MOST_OF_SOFT };
    if tried > most {
        return Err((
            "spacing",
            format!("divides the box around it into {tried} cells, of which there may be {most}; take a wider one"),
        ));
    }
    // A mesh is filled by cubes, so that what it does is the same whichever way it lies.
    let side = if solid.is_some() { Vec3::splat(spacing) } else { side };
    let from_middle = |place: [u32; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| (place[axis] as f32 + 0.5 - 0.5 * cells[axis] as f32) * side[axis]);
        Vec3::new(x, y, z)
    };
    let [nx, ny, nz] = cells;
    let places = (0..ny).flat_map(|y| (0..nz).flat_map(move |z| (0..nx).map(move |x| [x, y, z])));
    let is_inside = |place: &Vec3| solid.is_none_or(|mesh| mesh.is_inside(middle + *place / scale));
    let most = MOST_OF_SOFT as usize;
    let mut places: Vec<Vec3> = places.map(from_middle).filter(is_inside).take(most + 1).collect();
    if places.len() > most {
        return Err(("spacing", format!("fills it with more than {most} particles; take a wider one")));
    }
    if solid.is_some() {
        let sum = |axis: usize| places.iter().map(|place| f64::from(place[axis])).sum::<f64>();
        let centre = [0, 1, 2].map(|axis| (sum(axis) / places.len().max(1) as f64) as f32);
        let centre = Vec3::from_array(centre);
        places.iter_mut().for_each(|place| *place -= centre);
    }
    Ok(Filling { places, volume, size })
}

/// The volume of a closed mesh \[m³\].
fn volume(mesh: &MeshBuf) -> Result<f64, Fault> {
    Enclosed::of(mesh).map(|solid| solid.volume).map_err(|error| ("form", error.to_string()))
}
