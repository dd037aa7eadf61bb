//! Scenes and meshes from disk.

use crate::formats::SceneFormat;
use crate::meshes::{self, MAX_BYTES};
use crate::{Failure, Outcome, warn};
use pointmass::scene::{Files, SceneFile, read_scn};
use pointmass::shape::MeshBuf;
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
}

/// Reads a scene file and prints its warnings.
///
/// # Errors
/// If it cannot be read, with file, line and column where there are such.
pub fn scene(path: &Path) -> Outcome<SceneFile> {
    let text = text(path)?;
    let name = path.to_string_lossy();
    let is_json = match SceneFormat::of(path) {
        Some(format) => format == SceneFormat::Json,
        None => text.trim_start().starts_with('{'),
    };
    if is_json {
        return Ok(SceneFile::from_json(&name, &text)?);
    }
    let (scene, warnings) = read_scn(&name, &text, &mut Disk)?;
    warn(&warnings);
    Ok(scene)
}

fn text(path: &Path) -> Outcome<String> {
    let fail = |error: std::io::Error| Failure::io(path, &error);
    if path.is_dir() {
        return Err(Failure::new(format!("{}: is a directory, expected a scene file", path.display())));
    }
    let too_large = || {
        let limit = MAX_BYTES >> 20;
        Failure::new(format!("{}: larger than {limit} MB, which no scene should be; it was not read", path.display()))
    };
    let file = File::open(path).map_err(fail)?;
    if file.metadata().map_err(fail)?.len() > MAX_BYTES {
        return Err(too_large());
    }
    // What is no plain file has no length beforehand.
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(too_large());
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..good].iter().filter(|&&b| b == b'\n').count();
        Failure::new(format!("{}:{line}: not a text: byte {good} is not UTF-8", path.display()))
    })
}
