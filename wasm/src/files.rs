//! Files for scenes that name others: in a browser there is no disk to find them on.

use pointmass::Vec3;
use pointmass::scene::Files as SceneFiles;
use pointmass::shape::MeshBuf;
use std::collections::BTreeMap;
use wasm_bindgen::prelude::*;

/// What a scene refers to by name: meshes, and texts it includes. Fill it before loading the scene.
#[wasm_bindgen]
#[derive(Clone, Debug, Default)]
pub struct Files {
    texts: BTreeMap<String, String>,
    meshes: BTreeMap<String, MeshBuf>,
}

#[wasm_bindgen]
impl Files {
    /// No files.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A text that scenes include under this name.
    #[wasm_bindgen(js_name = addText)]
    pub fn add_text(&mut self, name: String, text: String) {
        self.texts.insert(name, text);
    }

    /// A mesh that scenes name so: coordinates (three to a vertex) and indices (three to a triangle).
    ///
    /// # Errors
    /// If the lists are no multiple of three long, a coordinate is not finite or an index out of range.
    #[wasm_bindgen(js_name = addMesh)]
    pub fn add_mesh(&mut self, name: String, coordinates: &[f32], indices: &[u32]) -> Result<(), JsError> {
        let ((vertices, a), (triangles, b)) = (coordinates.as_chunks::<3>(), indices.as_chunks::<3>());
        if !(a.is_empty() && b.is_empty()) {
            return Err(JsError::new(&format!("{name}: coordinates and indices have to come in threes")));
        }
        let vertices = vertices.iter().copied().map(Vec3::from).collect();
        let mesh = MeshBuf::new(vertices, triangles.to_vec());
        self.meshes.insert(name.clone(), mesh.map_err(|error| JsError::new(&format!("{name}: {error}")))?);
        Ok(())
    }
}

impl SceneFiles for Files {
    fn text(&mut self, path: &str) -> Result<String, String> {
        self.texts.get(path).cloned().ok_or_else(|| format!("no text '{path}' was added to the files"))
    }

    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        self.meshes.get(path).cloned().ok_or_else(|| format!("no mesh '{path}' was added to the files"))
    }

    fn exists(&mut self, path: &str) -> bool {
        self.meshes.contains_key(path) || self.texts.contains_key(path)
    }
}
