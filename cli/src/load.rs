//! Scenes and meshes from disk.

use crate::formats::{SceneFormat, format_of};
use crate::locate::{located, with_path};
use crate::outcome::{Failure, Outcome, warn};
use pointmass::scene::{self, Model, SceneError, SceneFile, Unknown, read_scn_with};
pub use pointmass_files::disk::Disk;
pub(crate) use pointmass_files::disk::name;
use pointmass_files::disk::text;
use pointmass_files::whole::is_standard;
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

/// Where a scene was read from.
pub(crate) struct Source {
    name: String,
    /// The text, where its values can be found by their paths.
    json: Option<String>,
}

impl Source {
    /// The scene, ready to run.
    ///
    /// # Errors
    /// If a value cannot be used or a mesh cannot be read, with the file and the line of the value.
    pub(crate) fn model(&self, file: &SceneFile) -> Result<Model, SceneError> {
        Model::load(file, &self.name, &mut Disk).map_err(|error| self.told(error))
    }

    /// An error in the scene with the file, and the line of the value that it names.
    pub(crate) fn told(&self, error: SceneError) -> SceneError {
        let error = error.in_file(&self.name);
        match &self.json {
            Some(json) if error.file == self.name => located(error, json),
            _ => error,
        }
    }
}

/// Reads a scene file and prints its warnings.
///
/// # Errors
/// If it cannot be read, with file, line and column where there are such.
pub fn scene(path: &Path) -> Outcome<SceneFile> {
    Ok(scene_with(path, Unknown::Refuse, |dt| dt)?.0)
}

/// The same, which may pass over commands that are `unknown` in `.scn`, and where it was read from. What it remarks on goes by the step that is made of that in the
/// file \[s\].
///
/// # Errors
/// As of [`scene()`].
pub(crate) fn scene_with(path: &Path, unknown: Unknown, step: impl FnOnce(f64) -> f64) -> Outcome<(SceneFile, Source)> {
    let (scene::Reading { scene, warnings, remarks }, source) = read(path, unknown, step)?;
    warn(&[warnings, remarks].concat());
    Ok((scene, source))
}

/// The same for those who only translate it, without remarks on what it says.
///
/// # Errors
/// As of [`scene()`].
pub(crate) fn declared(path: &Path, unknown: Unknown) -> Outcome<(SceneFile, Source)> {
    let (scene::Reading { scene, warnings, .. }, source) = read(path, unknown, |dt| dt)?;
    warn(&warnings);
    Ok((scene, source))
}

fn read(path: &Path, unknown: Unknown, step: impl FnOnce(f64) -> f64) -> Outcome<(scene::Reading, Source)> {
    let format = format_of::<SceneFormat>(path);
    if format.is_none() && path.is_file() && !is_standard(path) {
        let path = path.display();
        return Err(Failure::new(format!("{path}: expected a scene, whose name ends in .json or .scn")));
    }
    let (text, name) = (text(path)?, name(path));
    // A pipe and standard input have no name to tell by.
    let is_json = format.map_or_else(|| text.trim_start().starts_with('{'), |format| format == SceneFormat::Json);
    if !is_json {
        let reading = read_scn_with(&name, &text, &mut Disk, unknown).map_err(hinted)?;
        return Ok((reading, Source { name: name.into_owned(), json: None }));
    }
    let mut scene = SceneFile::from_json(&name, &text).map_err(|error| with_path(error, &text))?;
    let declared = scene.run.dt;
    scene.run.dt = step(declared);
    let remarks = SceneFile::former_names(&text).into_iter().chain(scene.remarks());
    scene.run.dt = declared;
    let remarks = remarks.chain(lost_textures(&scene, path)).map(|remark| format!("{name}:{remark}")).collect();
    let source = Source { name: name.into_owned(), json: Some(text) };
    Ok((scene::Reading { scene, warnings: Vec::new(), remarks }, source))
}

/// Remarks on textures that are not beside a scene.
fn lost_textures(scene: &SceneFile, path: &Path) -> impl Iterator<Item = String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let named = scene.materials.iter().enumerate().filter_map(|(i, material)| Some((i, material.texture.as_ref()?)));
    let lost = named.filter(move |(_, texture)| !folder.join(texture).is_file());
    lost.map(|(i, texture)| format!("materials[{i}].texture: there is no texture file '{texture}'"))
}

/// How to go on where a command is unknown.
fn hinted(error: SceneError) -> SceneError {
    let is_unknown = error.message.starts_with("unknown command");
    let hint = if is_unknown { "; --skip-unknown passes over such commands" } else { "" };
    SceneError { message: error.message + hint, ..error }
}
