//! Scenes and meshes from disk.

use crate::formats::{SceneFormat, format_of};
use crate::meshes::{self, MAX_BYTES};
use crate::outcome::{Failure, Outcome, alike, warn};
use crate::whole::is_standard;
use pointmass::scene::{self, Files, SceneError, SceneFile, Unknown, read_scn_with};
use pointmass::shape::MeshBuf;
use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// How a scene is read.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct Reading {
    /// Pass over commands that .scn does not have, up to the next line that begins with one it has, with a warning each
    #[arg(long)]
    pub(crate) skip_unknown: bool,
}

impl Reading {
    /// The answer to a command that `.scn` does not have.
    pub(crate) fn unknown(self) -> Unknown {
        if self.skip_unknown { Unknown::Skip } else { Unknown::Refuse }
    }
}

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

/// Reads a scene file and prints its warnings.
///
/// # Errors
/// If it cannot be read, with file, line and column where there are such.
pub fn scene(path: &Path) -> Outcome<SceneFile> {
    scene_with(path, Unknown::Refuse)
}

/// The same, which may pass over commands that are `unknown` in `.scn`.
///
/// # Errors
/// As of [`scene()`].
pub fn scene_with(path: &Path, unknown: Unknown) -> Outcome<SceneFile> {
    let scene::Reading { scene, warnings, remarks } = read(path, unknown)?;
    warn(&[warnings, remarks].concat());
    Ok(scene)
}

/// The same for those who only translate it, without remarks on what it says.
///
/// # Errors
/// As of [`scene()`].
pub fn declared(path: &Path, unknown: Unknown) -> Outcome<SceneFile> {
    let scene::Reading { scene, warnings, .. } = read(path, unknown)?;
    warn(&warnings);
    Ok(scene)
}

/// The name of a scene in messages.
pub(crate) fn name(path: &Path) -> Cow<'_, str> {
    if is_standard(path) { "standard input".into() } else { path.to_string_lossy() }
}

fn read(path: &Path, unknown: Unknown) -> Outcome<scene::Reading> {
    let format = format_of::<SceneFormat>(path);
    if format.is_none() && path.is_file() && !is_standard(path) {
        let path = path.display();
        return Err(Failure::new(format!("{path}: expected a scene, whose name ends in .json or .scn")));
    }
    let (text, name) = (text(path)?, name(path));
    // A pipe and standard input have no name to tell by.
    let is_json = format.map_or_else(|| text.trim_start().starts_with('{'), |format| format == SceneFormat::Json);
    if !is_json {
        return Ok(read_scn_with(&name, &text, &mut Disk, unknown).map_err(hinted)?);
    }
    let scene = SceneFile::from_json(&name, &text)?;
    let remarks = SceneFile::former_names(&text).into_iter().chain(scene.remarks());
    let remarks = remarks.map(|remark| format!("{name}:{remark}")).collect();
    Ok(scene::Reading { scene, warnings: Vec::new(), remarks })
}

/// How to go on where a command is unknown.
fn hinted(error: SceneError) -> SceneError {
    let is_unknown = error.message.starts_with("unknown command");
    let hint = if is_unknown { "; --skip-unknown passes over such commands" } else { "" };
    SceneError { message: error.message + hint, ..error }
}

fn text(path: &Path) -> Outcome<String> {
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
