//! `pointmass convert`: translates a scene between the formats.

use crate::formats::{SceneFormat, named};
use crate::load::{self, Reading};
use crate::outcome::{Failure, Outcome, warn};
use pointmass::scene::{SceneFile, write_scn};
use pointmass_files::whole::{Outs, existing_folder_of};
use std::path::{Path, PathBuf};

/// Arguments of `convert`.
#[derive(Debug, clap::Args)]
pub(crate) struct Convert {
    /// The scene to read: .scn or .json, or - for standard input
    pub(crate) from: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// The scene to write: .scn or .json
    #[arg(value_parser = named::<SceneFormat>)]
    pub(crate) to: (PathBuf, SceneFormat),
}

/// Converts a scene; warns of what the other format cannot say.
pub(crate) fn convert(args: &Convert) -> Outcome {
    let (mut scene, source) = load::declared(&args.from, args.reading.unknown())?;
    scene.check().map_err(|error| source.told(error))?;
    rebase(&mut scene, &folder(&args.from)?, &folder(&args.to.0)?);
    let outs = Outs::create(std::slice::from_ref(&args.to), None)?;
    outs.write(|format| match format {
        SceneFormat::Json => Ok(scene.to_json()),
        SceneFormat::Scn => {
            let (text, warnings) = write_scn(&scene);
            warn(&warnings);
            Ok(text)
        }
    })
}

/// The folder a file lies in, wherever the names lead.
fn folder(path: &Path) -> Outcome<PathBuf> {
    let folder = existing_folder_of(path)?;
    folder.canonicalize().map_err(|error| Failure::io(folder, &error))
}

/// Names every file relative to the folder `to` that was named relative to the folder `from`.
fn rebase(scene: &mut SceneFile, from: &Path, to: &Path) {
    for name in scene.file_names_mut().filter(|name| Path::new(name).is_relative()) {
        // What is there goes by its real name, without detours.
        let file = from.join(&*name);
        let file = file.canonicalize().unwrap_or(file);
        let path = pathdiff::diff_paths(&file, to).unwrap_or(file);
        *name = path.to_string_lossy().into_owned();
    }
}
