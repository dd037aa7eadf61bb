//! Triangle meshes from files: OFF, OBJ, STL, PLY and the ink of PNG, told apart by the file's extension.
//!
//! Whatever the bytes are, the answer is a mesh or one line saying what is wrong with the file: nothing here panics,
//! and nothing is allocated because a header promises it.

mod obj;
mod off;
mod picture;
pub(crate) mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod text;

use crate::fault::Fault;
use crate::outcome::{Outcome, hint};
use pointmass::Vec3;
use pointmass::shape::{BadMesh, MeshBuf};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The largest file that is read, in bytes.
pub const MAX_BYTES: u64 = 256 << 20;

/// A triangle mesh: at least one triangle, finite coordinates, every index in range.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// The points that the triangles join.
    pub vertices: Vec<[f32; 3]>,
    /// Three indices into `vertices` each, in the order in which the file lists the corners.
    pub triangles: Vec<[u32; 3]>,
}

impl MeshData {
    /// The mesh to collide with.
    ///
    /// # Errors
    /// If an index is out of range or a coordinate is not finite, which no file's are.
    pub fn solid(self) -> Result<MeshBuf, BadMesh> {
        MeshBuf::new(self.vertices.into_iter().map(Vec3::from).collect(), self.triangles)
    }

    /// Adds a polygon as a fan of triangles around its first corner.
    fn add_polygon(&mut self, corners: &[u32]) {
        let [first, others @ ..] = corners else { return };
        self.triangles.extend(others.windows(2).map(|edge| [*first, edge[0], edge[1]]));
    }
}

/// Reads a mesh from a file.
///
/// # Errors
///
/// Where the extension is unknown, the file can't be read or is larger than [`MAX_BYTES`], or [`parse`] refuses it.
pub fn load(path: &Path) -> Outcome<MeshData> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    // Before the file is opened, so that a wrong name is reported even where there is no such file.
    let mesh = reader(&extension).and_then(|reader| read(reader, &bytes_of(path)?));
    mesh.map_err(|fault| fault.of(path.display()))
}

/// Reads a mesh from the bytes of a file; `extension` says which format they are in.
///
/// # Errors
///
/// Where the extension is unknown, the bytes are not in its format, there are more than [`MAX_BYTES`] of them, a
/// coordinate is not a finite `f32`, a face names a vertex that isn't there, or there is no triangle at all.
pub fn parse(name_for_messages: &str, extension: &str, bytes: &[u8]) -> Outcome<MeshData> {
    reader(extension).and_then(|reader| read(reader, bytes)).map_err(|fault| fault.of(name_for_messages))
}

type Reader = fn(&[u8]) -> Result<MeshData, Fault>;

const READERS: [(&str, Reader); 5] =
    [("off", off::read), ("obj", obj::read), ("stl", stl::read), ("ply", ply::read), ("png", picture::read)];

fn reader(extension: &str) -> Result<Reader, Fault> {
    let known = READERS.iter().find(|(name, _)| name.eq_ignore_ascii_case(extension));
    known.map(|(_, reader)| *reader).ok_or_else(|| {
        let names: Vec<_> = READERS.iter().map(|(name, _)| format!(".{name}")).collect();
        let found =
            if extension.is_empty() { "no extension".into() } else { format!("unknown extension .{extension}") };
        Fault::new(format!("{found}: a mesh is one of {}", names.join(", ")))
    })
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, Fault> {
    let unreadable = |error: std::io::Error| Fault::new(format!("can't be read: {error}{}", hint(path, &error)));
    let file = File::open(path).map_err(unreadable)?;
    let facts = file.metadata().map_err(unreadable)?;
    if facts.is_dir() {
        return Err(Fault::new("is a directory: name a mesh file"));
    }
    check_size(facts.len())?;
    let mut bytes = Vec::new();
    // A pipe or a device has no length to check beforehand, so the reading itself is bounded too.
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    Ok(bytes)
}

fn read(reader: Reader, bytes: &[u8]) -> Result<MeshData, Fault> {
    check_size(bytes.len() as u64)?;
    if bytes.is_empty() {
        return Err(Fault::new("is empty: expected a mesh"));
    }
    let mesh = reader(bytes)?;
    if mesh.triangles.is_empty() {
        return Err(Fault::new("has no triangles: a mesh needs at least one face"));
    }
    Ok(mesh)
}

fn check_size(bytes: u64) -> Result<(), Fault> {
    if bytes > MAX_BYTES {
        let limit = MAX_BYTES >> 20;
        return Err(Fault::new(format!("has {bytes} bytes: at most {limit} MiB are read; simplify the mesh")));
    }
    Ok(())
}
