//! From a `.scn` text, with what it includes, to the declared scene.

use super::origins::{Origin, Origins};
use super::references::{MAX_GROUPS, MAX_MATERIALS};
use super::remarks::MOST;
use super::scn::{Command, Index, Located, Place, Problem, ScnError, Source, commands, known};
use super::{Camera, Files, Group, Item, Light, Material, SceneError, SceneFile, beside};
use crate::emit::{Emitter, Spread, Varied};
use crate::force::{Drag, ForceKind, Gravity, MutualGravity, Sink, Spring};
use crate::shape::Shape;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use glam::Vec3;

/// How deep files may include each other.
const MAX_INCLUDE_DEPTH: usize = 64;
/// The largest number of includes of a scene in all: two files that each include the next twice grow without measure.
const MAX_INCLUDES: usize = 4096;

/// A scene that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The scene as the files tell it.
    pub scene: SceneFile,
    /// Warnings of things that are not as they were written, or not there.
    pub warnings: Vec<String>,
    /// Remarks on what can be run but is hardly meant: what [`SceneFile::remarks`] finds, with line and column.
    pub remarks: Vec<String>,
}

/// The answer to a command that `.scn` does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unknown {
    /// It is an error.
    #[default]
    Refuse,
    /// It is passed over with a warning, up to the next line that begins with a command.
    Skip,
}

/// Reads a `.scn` text that lies at `path`, and what it includes; the strings are warnings.
///
/// Names of meshes and textures come out relative to `path`'s folder, includes are flattened.
///
/// # Errors
/// If anything in it is unknown, out of range, cut off or missing: with file, line and column.
pub fn read_scn(path: &str, text: &str, files: &mut dyn Files) -> Result<(SceneFile, Vec<String>), SceneError> {
    let Reading { scene, warnings, .. } = read_scn_with(path, text, files, Unknown::Refuse)?;
    Ok((scene, warnings))
}

/// The same, which may pass over commands that are `unknown`, and remarks on what is hardly meant.
///
/// # Errors
/// As of [`read_scn`].
pub fn read_scn_with(path: &str, text: &str, files: &mut dyn Files, unknown: Unknown) -> Result<Reading, SceneError> {
    let mut reader = Reader {
        files,
        unknown,
        skipped: 0,
        replaced: Vec::new(),
        origins: Origins::default(),
        root: path,
        scene: SceneFile::new(),
        gravity: None,
        warnings: Vec::new(),
        open: Vec::new(),
        includes: 0,
    };
    reader.file(path, text, "", None, &[])?;
    let gravity = reader.gravity.map(ForceKind::Gravity);
    let always = [ForceKind::Drag(Drag {}), ForceKind::MutualGravity(MutualGravity::NEWTON)];
    reader.scene.forces = gravity.into_iter().chain(always).collect();
    if reader.skipped > 0 {
        let (count, s) = (reader.skipped, if reader.skipped == 1 { "" } else { "s" });
        reader.warnings.insert(0, format!("{path}: {count} unknown command{s} passed over"));
    }
    let Reader { scene, warnings, replaced, origins, .. } = reader;
    let remarks = replaced.into_iter().chain(origins.place(&scene.remarks())).collect();
    Ok(Reading { scene, warnings, remarks })
}

struct Reader<'a> {
    files: &'a mut dyn Files,
    unknown: Unknown,
    /// Commands passed over.
    skipped: usize,
    root: &'a str,
    scene: SceneFile,
    gravity: Option<Gravity>,
    warnings: Vec<String>,
    /// Remarks on gravities that later ones take the place of.
    replaced: Vec<String>,
    /// Where the scene's parts come from.
    origins: Origins,
    /// The files being read, the outermost first.
    open: Vec<String>,
    includes: usize,
}

/// The things that the commands of one file refer to.
struct Scope<'a> {
    /// The file, as messages name it, and its number.
    path: &'a str,
    file: u32,
    /// Its name relative to the folder of the outermost file; empty for that itself.
    relative: &'a str,
    /// Its materials so far, or those of the including file as long as it has none.
    materials: Vec<u16>,
    borrowed: bool,
    /// Its particles so far.
    particles: Vec<u32>,
    /// Springs whose ends are still to be looked up.
    springs: Vec<([Index; 2], Spring, Place)>,
    /// The group it was included in.
    base: Option<u32>,
    /// The groups open in it, and where they began.
    groups: Vec<(u32, Place)>,
}

impl Scope<'_> {
    fn error(&self, place: Place, name: &str, message: impl core::fmt::Display) -> SceneError {
        SceneError::at(self.path, place.line as usize, place.column as usize, format!("{name}: {message}"))
    }

    fn group(&self) -> Option<u32> {
        self.groups.last().map(|&(group, _)| group).or(self.base)
    }

    /// The name of a file relative to the folder of the outermost file.
    fn named(&self, name: &str) -> String {
        if self.relative.is_empty() { name.to_string() } else { beside(self.relative, name) }
    }

    fn material(&self, name: &str, index: Index) -> Result<Option<u16>, SceneError> {
        let known = self.materials.len();
        match usize::try_from(index.value) {
            Ok(value) if value < known => Ok(Some(self.materials[value])),
            Err(_) if index.value == -1 => Ok(None),
            _ => {
                let range = match known {
                    0 => "there are none above it: expected -1".to_string(),
                    _ => format!("expected -1 to {}", known - 1),
                };
                Err(self.error(index.place, name, format!("material {} is out of range; {range}", index.value)))
            }
        }
    }
}

impl Reader<'_> {
    fn file(
        &mut self,
        path: &str,
        text: &str,
        relative: &str,
        base: Option<u32>,
        materials: &[u16],
    ) -> Result<(), SceneError> {
        self.open.push(path.to_string());
        let mut scope = Scope {
            path,
            file: self.origins.open(path),
            relative,
            materials: materials.to_vec(),
            borrowed: true,
            particles: Vec::new(),
            springs: Vec::new(),
            base,
            groups: Vec::new(),
        };
        let mut commands = commands(text);
        while let Some(command) = commands.next() {
            match command {
                Ok(located) => self.command(&mut scope, located)?,
                Err(error) if error.problem == Problem::UnknownCommand && self.unknown == Unknown::Skip => {
                    commands.resume_after(error.place);
                    self.skipped += 1;
                    if self.skipped <= MOST {
                        self.warnings.push(format!("{} is passed over", place_of(path, error)));
                    }
                }
                Err(error) => return Err(place_of(path, error)),
            }
        }
        if let Some(&(_, place)) = scope.groups.last() {
            return Err(scope.error(place, "begin", "the file ends before its 'end'"));
        }
        self.springs(&scope)?;
        self.open.pop();
        Ok(())
    }

    fn command(&mut self, scope: &mut Scope<'_>, located: Located<'_>) -> Result<(), SceneError> {
        let Located { place, name, command } = located;
        if let Some(list) = list_of(&command) {
            self.origins.note(list, Origin { file: scope.file, place, name: known(name) });
        }
        let scene = &mut self.scene;
        match command {
            Command::Particle { mut particle, material } => {
                particle.material = self.inherited(scope, scope.material(name, material)?);
                scope.particles.push(self.scene.particles.len() as u32);
                self.scene.particles.push(particle);
            }
            Command::Source(source) => self.source(scope, place, name, source)?,
            Command::Sink(Sink { shape, group, intensity, ca, la, qa, softening }) => {
                let shape = self.shape(scope, place, name, &shape)?;
                self.scene.sinks.push(Sink { shape, group, intensity, ca, la, qa, softening });
            }
            Command::Spring { ends, rest_length, ks, kd } => {
                scope.springs.push((ends, Spring { kd, ..Spring::new([0; 2], rest_length, ks) }, place));
            }
            Command::Gravity(acceleration) => self.gravity(scope, place, name, acceleration),
            Command::Scenery(piece) => {
                let material = scope.material(name, piece.material)?;
                let shape = self.shape(scope, place, name, &piece.shape)?;
                self.scene.scenery.push(Item { shape, material, group: scope.group(), motion: None });
            }
            Command::Begin { material, matrix } => self.begin(scope, place, material, matrix)?,
            Command::End => {
                if scope.groups.pop().is_none() {
                    return Err(scope.error(place, name, "there is no 'begin' it could end"));
                }
            }
            Command::Material { colors, shininess, refraction, texture } => {
                let texture = texture.map(|file| self.texture(scope, place, file));
                self.material(scope, place, Material { shininess, refraction, texture, ..colored(colors) })?;
            }
            Command::DirectionalLight([color, direction]) => scene.lights.push(Light::Directional { color, direction }),
            Command::PointLight([color, position, attenuation]) => {
                scene.lights.push(Light::Point { color, position, attenuation });
            }
            Command::SpotLight([color, position, direction, attenuation], [cutoff, dropoff]) => {
                scene.lights.push(Light::Spot { color, position, direction, attenuation, cutoff, dropoff });
            }
            Command::AreaLight([color, position, direction], radius, attenuation) => {
                scene.lights.push(Light::Area { color, position, direction, radius, attenuation });
            }
            Command::Camera([eye, towards, up, [xfov, near, far]]) => {
                scene.camera = Some(Camera { eye, towards, up, xfov, near, far, shutter: None });
            }
            Command::Ambient(color) => scene.ambient = color,
            Command::Background(color) => scene.background = color,
            Command::Include(file) => self.include(scope, place, file)?,
        }
        Ok(())
    }

    /// The gravity of a scene, which has one.
    fn gravity(&mut self, scope: &Scope<'_>, place: Place, name: &str, acceleration: Vec3) {
        if self.gravity.is_some() && self.replaced.len() < MOST {
            let only = scope.error(place, name, "it takes the place of the one before; a scene has one");
            self.replaced.push(only.to_string());
        }
        self.gravity = Some(Gravity { acceleration });
    }

    fn source(&mut self, scope: &Scope<'_>, place: Place, name: &str, source: Source<'_>) -> Result<(), SceneError> {
        let Source { newborn, material, rate, velocity, angle_cutoff, shape } = source;
        let shape = self.shape(scope, place, name, &shape)?;
        let material = self.inherited(scope, scope.material(name, material)?);
        self.scene.emitters.push(Emitter {
            speed: Varied::exactly(velocity),
            spread: Spread::Lecture(angle_cutoff),
            material,
            ..Emitter::moving(shape, rate, None).giving_birth_to(&newborn)
        });
        Ok(())
    }

    fn begin(
        &mut self,
        scope: &mut Scope<'_>,
        place: Place,
        material: Index,
        matrix: [[f32; 4]; 4],
    ) -> Result<(), SceneError> {
        let group = Group { matrix, material: scope.material("begin", material)?, parent: scope.group() };
        if let Err(message) = group.affine() {
            return Err(scope.error(place, "begin", message));
        }
        let depth = self.scene.chain(group.parent).len();
        if depth >= MAX_GROUPS {
            return Err(scope.error(place, "begin", format!("groups stand more than {MAX_GROUPS} deep in each other")));
        }
        scope.groups.push((self.scene.groups.len() as u32, place));
        self.scene.groups.push(group);
        Ok(())
    }

    fn material(&mut self, scope: &mut Scope<'_>, place: Place, material: Material) -> Result<(), SceneError> {
        let number = self.scene.materials.len() as u16;
        if usize::from(number) >= MAX_MATERIALS {
            return Err(scope.error(place, "material", format!("a scene has at most {MAX_MATERIALS}")));
        }
        if scope.borrowed {
            scope.materials.clear();
            scope.borrowed = false;
        }
        scope.materials.push(number);
        self.scene.materials.push(material);
        Ok(())
    }

    fn texture(&mut self, scope: &Scope<'_>, place: Place, file: &str) -> String {
        let texture = scope.named(file);
        if !self.files.exists(&beside(self.root, &texture)) {
            let error = scope.error(place, "material", self.missing("texture", file, &texture));
            self.warnings.push(error.to_string());
        }
        texture
    }

    /// That a file is not there, and whether another is, whose name differs in capitals.
    fn missing(&mut self, kind: &str, shown: &str, relative: &str) -> String {
        let hint = self.files.alike(&beside(self.root, relative)).map(|name| format!("; did you mean {name}?"));
        format!("there is no {kind} file '{shown}'{}", hint.unwrap_or_default())
    }

    fn include(&mut self, scope: &Scope<'_>, place: Place, file: &str) -> Result<(), SceneError> {
        let fail = |message: String| Err(scope.error(place, "include", message));
        let relative = scope.named(file);
        let path = beside(self.root, &relative);
        if self.open.iter().any(|open| beside(open, open.rsplit('/').next().unwrap_or("")) == path) {
            return fail(format!("'{file}' includes itself, directly or through others"));
        }
        self.includes += 1;
        if self.open.len() >= MAX_INCLUDE_DEPTH || self.includes > MAX_INCLUDES {
            return fail(format!(
                "too many includes: at most {MAX_INCLUDE_DEPTH} deep and {MAX_INCLUDES} in all are read"
            ));
        }
        let text = match self.files.text(&path) {
            Ok(text) => text,
            Err(message) => return fail(message),
        };
        self.file(&path, &text, &relative, scope.group(), &scope.materials)?;
        self.warnings.push(scope.error(place, "include", format!("'{file}' became part of the scene")).to_string());
        Ok(())
    }

    /// A shape with its mesh named relative to the outermost file.
    fn shape(
        &mut self,
        scope: &Scope<'_>,
        place: Place,
        name: &str,
        shape: &Shape<&str>,
    ) -> Result<Shape<String>, SceneError> {
        shape.with_mesh(|file| {
            let mesh = scope.named(file);
            let path = beside(self.root, &mesh);
            if self.files.exists(&path) {
                Ok(mesh)
            } else {
                Err(scope.error(place, name, self.missing("mesh", &path, &mesh)))
            }
        })
    }

    /// A material, or the one that the groups around give.
    fn inherited(&self, scope: &Scope<'_>, material: Option<u16>) -> Option<u16> {
        material.or_else(|| self.scene.material_of(scope.group()))
    }

    fn springs(&mut self, scope: &Scope<'_>) -> Result<(), SceneError> {
        for (ends, spring, place) in &scope.springs {
            let mut found = [0; 2];
            for (found, index) in found.iter_mut().zip(ends) {
                let particle = usize::try_from(index.value).ok().and_then(|i| scope.particles.get(i));
                let Some(&particle) = particle else {
                    let (value, count) = (index.value, scope.particles.len());
                    let message = format!("particle {value} is out of range; this file has {count}, from 0");
                    return Err(scope.error(index.place, "particle_spring", message));
                };
                *found = particle;
            }
            self.origins.note("springs", Origin { file: scope.file, place: *place, name: "particle_spring" });
            self.scene.springs.push(Spring { ends: found, ..*spring });
        }
        Ok(())
    }
}

/// The list of a scene that a command adds to, or what there is but one of that it says. Springs of a file are added when it ends, in their order.
fn list_of(command: &Command<'_>) -> Option<&'static str> {
    Some(match command {
        Command::Particle { .. } => "particles",
        Command::Source(_) => "emitters",
        Command::Sink(_) => "sinks",
        Command::Scenery(_) => "scenery",
        Command::Material { .. } => "materials",
        Command::DirectionalLight(_) | Command::PointLight(_) | Command::SpotLight(..) | Command::AreaLight(..) => {
            "lights"
        }
        Command::Ambient(_) => "ambient",
        Command::Background(_) => "background",
        Command::Gravity(_)
        | Command::Begin { .. }
        | Command::End
        | Command::Camera(_)
        | Command::Include(_)
        | Command::Spring { .. } => return None,
    })
}

/// An error in a file.
fn place_of(path: &str, error: ScnError<'_>) -> SceneError {
    SceneError::at(path, error.place.line as usize, error.place.column as usize, error)
}

fn colored([ambient, diffuse, specular, transmission, emission]: [[f32; 3]; 5]) -> Material {
    Material { ambient, diffuse, specular, transmission, emission, ..Material::default() }
}
