//! Files for scenes that name others: in a browser there is no disk to find them on.

use crate::memory::{has_room, own_floats, own_words, room, room_for_little};
use js_sys::{Float32Array, JsString, Uint32Array};
use pointmass::Vec3;
use pointmass::scene::Files as SceneFiles;
use pointmass::shape::MeshBuf;
use std::collections::BTreeMap;
use std::rc::Rc;
use wasm_bindgen::prelude::*;

/// The files that a scene refers to by name: meshes, and texts it includes. Fill it before loading the scene.
#[wasm_bindgen]
#[derive(Clone, Debug, Default)]
pub struct Files {
    texts: BTreeMap<String, Rc<str>>,
    meshes: BTreeMap<String, Rc<MeshBuf>>,
    /// Bytes of text that have been read.
    read: usize,
}

/// Bytes of text that a scene may have in all, each include counted: two files that include the next twice grow without
/// measure.
pub(crate) const MOST_TEXT: usize = 32 << 20;

/// Vertices or triangles that a mesh may have.
const MOST_CORNERS: u32 = 1 << 23;

/// Bytes that a vertex and a triangle of a mesh take at most, with an index over them.
const EACH: usize = 512;

/// Bytes that an entry takes at most, besides its name.
const ENTRY: usize = 256;

#[wasm_bindgen]
impl Files {
    /// No files.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Result<Files, JsError> {
        room_for_little()?;
        Ok(Self::default())
    }

    /// A text that scenes include under this name.
    ///
    /// # Errors
    /// If it is too long.
    #[wasm_bindgen(js_name = addText)]
    pub fn add_text(&mut self, name: &JsString, text: &JsString) -> Result<(), JsError> {
        let (name, text) = (short("a file", name)?, long(text)?);
        self.texts.insert(name, text.into());
        Ok(())
    }

    /// A mesh that scenes name so: coordinates (three to a vertex) and indices (three to a triangle).
    ///
    /// # Errors
    /// If the lists are no multiple of three long, a coordinate is not finite or an index out of range, or they are too
    /// long.
    #[wasm_bindgen(js_name = addMesh)]
    pub fn add_mesh(
        &mut self,
        name: &JsString,
        coordinates: &Float32Array,
        indices: &Uint32Array,
    ) -> Result<(), JsError> {
        let name = short("a file", name)?;
        let refuse = |what: &str| JsError::new(&format!("{name}: {what}"));
        let arrays = own_floats(coordinates).zip(own_words(indices));
        let (coordinates, indices) = arrays.ok_or_else(|| {
            refuse("coordinates have to be a Float32Array, and indices a Uint32Array, that can be read and copied")
        })?;
        let (vertices, triangles) = (coordinates.length() / 3, indices.length() / 3);
        if !(coordinates.length().is_multiple_of(3) && indices.length().is_multiple_of(3)) {
            return Err(refuse("coordinates and indices have to come in threes"));
        }
        if vertices.max(triangles) > MOST_CORNERS {
            return Err(refuse(&format!("a mesh may have {MOST_CORNERS} vertices and as many triangles")));
        }
        room(EACH * (vertices + triangles) as usize, &name)?;
        let vertices = coordinates.to_vec().as_chunks::<3>().0.iter().copied().map(Vec3::from).collect();
        let mesh = MeshBuf::new(vertices, indices.to_vec().as_chunks::<3>().0.to_vec());
        let mesh = mesh.map_err(|error| refuse(&error.to_string()))?;
        self.meshes.insert(name.clone(), mesh.into());
        Ok(())
    }

    /// The same files once more: a world takes a copy of what it is given. It costs next to nothing.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(js_name = clone, skip_typescript)]
    pub fn copy(&self) -> Result<Files, JsError> {
        let names = self.texts.keys().chain(self.meshes.keys()).map(|name| name.len() + ENTRY).sum();
        room(names, "the files")?;
        Ok(self.clone())
    }
}

impl Files {
    /// The number of vertices and triangles of a mesh, added; none, if it is not there.
    pub(crate) fn corners(&self, name: &str) -> usize {
        self.meshes.get(name).map_or(0, |mesh| mesh.vertices().len() + mesh.triangles().len())
    }
}

impl SceneFiles for Files {
    fn text(&mut self, path: &str) -> Result<String, String> {
        let Some(text) = self.texts.get(path) else {
            return Err(match self.meshes.contains_key(path) {
                true => format!("'{path}' was added to the files as a mesh; a text is added by addText"),
                false => format!("no text '{path}' was added to the files"),
            });
        };
        self.read = self.read.saturating_add(text.len());
        if self.read > MOST_TEXT {
            return Err(format!("'{path}' makes more than {} MiB of text, includes counted", MOST_TEXT >> 20));
        }
        if !has_room(text.len().saturating_mul(12)) {
            return Err(format!("there is not enough memory for '{path}'"));
        }
        Ok(text.to_string())
    }

    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        let Some(mesh) = self.meshes.get(path) else {
            return Err(match self.texts.contains_key(path) {
                true => format!(
                    "'{path}' was added to the files as a text; a mesh is added by addMesh, as coordinates and indices"
                ),
                false => format!("no mesh '{path}' was added to the files"),
            });
        };
        if !has_room(EACH * (mesh.vertices().len() + mesh.triangles().len())) {
            return Err(format!("there is not enough memory for '{path}'"));
        }
        Ok((**mesh).clone())
    }

    fn exists(&mut self, path: &str) -> bool {
        self.meshes.contains_key(path) || self.texts.contains_key(path)
    }
}

/// A name, of `what`.
pub(crate) fn short(what: &str, name: &JsString) -> Result<String, JsError> {
    const LONGEST: u32 = 4096;
    if !name.is_string() {
        return Err(JsError::new(&format!("the name of {what} has to be a string")));
    }
    // A long one would have to be copied to be looked at.
    if name.length() > LONGEST {
        return Err(JsError::new(&format!("the name of {what} may have {LONGEST} characters")));
    }
    room_for_little()?;
    Ok(String::from(name))
}

/// A text, as UTF-8.
pub(crate) fn long(text: &JsString) -> Result<String, JsError> {
    if !text.is_string() {
        return Err(JsError::new("a text has to be a string"));
    }
    let length = text.length() as usize;
    if length > MOST_TEXT {
        return Err(JsError::new(&format!("the text has {length} characters; at most {MOST_TEXT} are read")));
    }
    // A UTF-16 unit becomes three bytes at most, in memory that grows once.
    room(6 * length, "the text")?;
    Ok(String::from(text))
}
