//! Scenes, and what they name, from disk.

use crate::meshes::{self, MAX_BYTES};
use crate::outcome::{Failure, Outcome, alike};
use crate::whole::is_standard;
use pointmass::scene::Files;
use pointmass::shape::MeshBuf;
use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Files on disk, by path.
#[derive(Debug)]
pub struct Disk;

impl Files for Disk {
    fn text(&mut self, path: &str) -> Result<String, String> {
        text(Path::new(path)).map_err(|failure| failure.to_string())
    }

    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        let mesh = meshes::load(Path::new(path)).map_err(|error| error.to_string())?;
        mesh.solid().map_err(|error| format!("{path}: {error}"))
    }

    fn exists(&mut self, path: &str) -> bool {
        Path::new(path).is_file()
    }

    fn alike(&mut self, path: &str) -> Option<String> {
        alike(Path::new(path))
    }
}

/// The name of a scene in messages.
pub fn name(path: &Path) -> Cow<'_, str> {
    if is_standard(path) { "standard input".into() } else { path.to_string_lossy() }
}

/// The text of a scene; that of standard input for `-`.
///
/// # Errors
/// If it cannot be read, is larger than [`MAX_BYTES`] or no UTF-8.
pub fn text(path: &Path) -> Outcome<String> {
    let fail = |error: std::io::Error| Failure::io(Path::new(&*name(path)), &error);
    if path.is_dir() && !is_standard(path) {
        return Err(Failure::new(format!("{}: is a directory, expected a scene file", path.display())));
    }
    let too_large = || {
        let limit = MAX_BYTES >> 20;
        Failure::new(format!("{}: larger than {limit} MB, which no scene should be; it was not read", name(path)))
    };
    let source: Box<dyn Read> = if is_standard(path) {
        Box::new(std::io::stdin())
    } else {
        let file = File::open(path).map_err(fail)?;
        if file.metadata().map_err(fail)?.len() > MAX_BYTES {
            return Err(too_large());
        }
        Box::new(file)
    };
    // What is no plain file has no length beforehand.
    let mut bytes = Vec::new();
    source.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large());
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..good].iter().filter(|&&b| b == b'\n').count();
        Failure::new(format!("{}:{line}: not a text: byte {good} is not UTF-8", name(path)))
    })
}
