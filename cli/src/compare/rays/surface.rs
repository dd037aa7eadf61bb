//! Where triangles come from: made up, or a file.

use super::super::args::Compare;
use super::made::Made;
use crate::outcome::{Failure, Outcome};
use crate::parse::sorted;
use crate::report::words::thousands;
use pointmass::shape::{MeshBuf, Surface as _};
use pointmass_files::meshes::{self, MeshData};
use pointmass_files::outcome::excerpt;
use std::path::Path;

/// About how many triangles are made up if nobody says: as many as the Stanford bunny has, roughly.
pub(super) const TRIANGLES: usize = 60_000;

/// A mesh to be compared on.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Its description.
    pub about: String,
    /// Its triangles, without an index.
    pub mesh: MeshBuf,
    /// The diagonal of its box \[m\].
    pub size: f32,
}

/// All that the arguments name, each in all its sizes, ascending.
pub(super) fn surfaces(args: &Compare) -> Outcome<Vec<Surface>> {
    if let Some(path) = &args.mesh {
        return Surface::read(path).map(|surface| vec![surface]);
    }
    let made = sorted(&args.surface, &[Made::Knot, Made::Terrain]);
    let sizes = sorted(&args.triangles, &[TRIANGLES]);
    made.into_iter().flat_map(|made| sizes.iter().map(move |n| Surface::made(made, *n))).collect()
}

impl Surface {
    /// From a file: OFF, OBJ, STL or PLY.
    ///
    /// # Errors
    /// If it cannot be read, with file and line where there is one, or is too large or small to be measured.
    pub fn read(path: &Path) -> Outcome<Self> {
        let data = meshes::load(path)?;
        let (vertices, shown) = (thousands(data.vertices.len()), excerpt(&path.to_string_lossy()));
        let about = format!("{} triangles between {vertices} vertices of {shown}", thousands(data.triangles.len()));
        let name = excerpt(&path.file_name().unwrap_or_default().to_string_lossy());
        Self::new(&shown, name, about, data)
    }

    /// Made up, of about so many triangles.
    ///
    /// # Errors
    /// None that are known.
    pub fn made(made: Made, triangles: usize) -> Outcome<Self> {
        Self::new(made.name(), made.name().into(), made.describe().into(), made.mesh(triangles))
    }

    pub(super) fn new(path: &str, name: String, about: String, data: MeshData) -> Outcome<Self> {
        let mesh = data.solid().map_err(|error| Failure::new(format!("{path}: {error}")))?;
        let bounds = mesh.bounds();
        let sides = [0, 1, 2].map(|axis| f64::from(bounds.max[axis]) - f64::from(bounds.min[axis]));
        let size = sides.iter().map(|side| side * side).sum::<f64>().sqrt();
        // Steps and balls are parts of it, whose squares have to be numbers.
        match (1e-12..1e15).contains(&size) {
            true => Ok(Self { name, about, mesh, size: size as f32 }),
            false => Err(Failure::new(format!(
                "{path}: the mesh is {size:.1e} across: expected from 1e-12 to 1e15; scale it"
            ))),
        }
    }
}
