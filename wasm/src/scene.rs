//! Scenes and particles as they are given, read.

use crate::arguments::{Given, UNWRITTEN};
use crate::files::Files;
use crate::{memory, path};
use pointmass::Particle;
use pointmass::scene::{Material, Model, Reading, SceneError, SceneFile, Solid, Unknown, read_scn_with};
use pointmass::shape::Shape;
use wasm_bindgen::JsError;

/// What a scene is called in messages.
const NAME: &str = "scene";

/// A scene made ready to run.
pub(crate) struct Loaded {
    pub(crate) file: SceneFile,
    pub(crate) model: Model,
    /// Warnings and remarks.
    pub(crate) warnings: Vec<String>,
}

impl Loaded {
    /// Reads a scene, with the files that it names.
    ///
    /// # Errors
    /// If it cannot be used, or there is not enough memory.
    pub(crate) fn new(given: &Given, files: &mut Files) -> Result<Self, JsError> {
        let (Given::Text(text) | Given::Object(text)) = given;
        memory::room_to_read(text)?;
        let (file, warnings) = match given {
            Given::Object(text) => object(text)?,
            Given::Text(text) if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') => {
                let file = SceneFile::from_json(NAME, text)?;
                let warnings = remarks(&file, SceneFile::former_names(text));
                (file, warnings)
            }
            Given::Text(text) => {
                let Reading { scene, warnings, remarks } = read_scn_with(NAME, text, files, Unknown::Refuse)?;
                (scene, [warnings, remarks].concat())
            }
        };
        // What is no number that can be used needs no room.
        file.check().map_err(|error| error.in_file(NAME))?;
        memory::room_to_build(&file, files)?;
        let model = Model::load(&file, NAME, files)?;
        Ok(Self { file, model, warnings })
    }
}

/// A scene that was given as an object: what is said of it has paths, no lines and columns, which nobody has seen.
fn object(text: &str) -> Result<(SceneFile, Vec<String>), JsError> {
    let file = SceneFile::from_json(NAME, text).map_err(|error| in_object(text, error))?;
    let names = SceneFile::former_names(text).into_iter().map(|remark| {
        let place = remark.split_once(": ").and_then(|(place, rest)| {
            let column: usize = place.strip_prefix("1:")?.parse().ok()?;
            Some((SceneFile::path_in_json(text, column.saturating_sub(1)), rest))
        });
        match place {
            Some((at, rest)) if at.is_empty() => format!(" {rest}"),
            Some((at, rest)) => format!("{at}: {rest}"),
            None => remark,
        }
    });
    let warnings = remarks(&file, names.collect());
    Ok((file, warnings))
}

/// All remarks on a scene: former names, and what it hardly means.
fn remarks(file: &SceneFile, former: Vec<String>) -> Vec<String> {
    former.into_iter().chain(file.remarks()).map(|remark| format!("{NAME}:{remark}")).collect()
}

/// How a message begins about a name that stands alone.
const ALONE: &str = "a name alone";

/// An error in the text of an object, by its path there.
fn in_object(text: &str, error: SceneError) -> SceneError {
    let SceneError { file, place, mut message } = error;
    for name in UNWRITTEN {
        message = message.replace(&format!("invalid type: string \"{name}\""), &format!("invalid value: {name}"));
    }
    // Of a name that stands alone it is known only when what follows has been seen.
    let shown = if message.starts_with(ALONE) { path::before_quote(text, &place) } else { None };
    let place = shown.or_else(|| path::of_place(text, &place)).unwrap_or(place);
    SceneError { file, place, message }
}

/// A particle that was given as an object for a running world: read and checked as one of the scene's list.
///
/// # Errors
/// If it cannot be used.
pub(crate) fn particle(json: &str, model: &mut Model) -> Result<Particle, JsError> {
    let text = format!("{{\"particles\":[{json}]}}");
    memory::room_to_read(&text)?;
    let told = |error: SceneError| {
        let place = error.place.replacen("particles[0]", "particle", 1);
        JsError::new(&SceneError { file: String::new(), place, ..error }.to_string())
    };
    let mut file = SceneFile::from_json("", &text).map_err(|error| told(in_object(&text, error)))?;
    // The materials are lent to the check, which does not change them.
    std::mem::swap(&mut file.materials, &mut model.materials);
    let checked = file.check();
    std::mem::swap(&mut file.materials, &mut model.materials);
    checked.map_err(told)?;
    let mut particle = file.particles.first().copied().unwrap_or_default();
    fits(&particle, model).map_err(|message| told(SceneError::value("particles[0].radius", message)))?;
    let material = particle.material.and_then(|number| model.materials.get(usize::from(number)));
    particle.color = particle.color.or(material.map(Material::color));
    Ok(particle)
}

/// Checks that the scene can do with a ball as wide as a particle: it was checked for those that it has itself.
fn fits(particle: &Particle, model: &Model) -> Result<(), String> {
    let width = 2.0 * particle.radius;
    if !(width > 0.0) {
        return Ok(());
    }
    if model.contacts.is_some() && !(width < model.index.room.half()) {
        return Err(format!("has to be less than a quarter of each side of the room, not {}", particle.radius));
    }
    // Lines are drawn, and nobody meets them.
    let squashes = |solid: &Solid| !matches!(solid.shape, Shape::Line(_)) && !solid.shape.meets_balls(&solid.to_world);
    let squashed = model.scenery.iter().position(squashes);
    squashed.map_or(Ok(()), |i| {
        Err(format!("has to be zero: scenery[{i}] is squashed by its groups, and only points meet that"))
    })
}
