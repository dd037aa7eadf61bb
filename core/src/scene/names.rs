//! The files that a scene names.

use super::{BoxForm, Form, Growth, Material, SceneFile, SoftForm, Sprite};
use crate::shape::Shape;
use alloc::string::String;

impl SceneFile {
    /// The names of all other files, relative to its own: of meshes, textures, pictures, and of its schema. Pictures that need no file are none, nor is
    /// an address on the web.
    pub fn file_names_mut(&mut self) -> impl Iterator<Item = &mut String> {
        let surfaces = self.strands.iter_mut().filter_map(|tuft| match &mut tuft.form {
            Growth::Curve(_) => None,
            Growth::On(field) => Some(&mut field.shape),
        });
        let shapes = (self.emitters.iter_mut().map(|emitter| &mut emitter.shape))
            .chain(self.sinks.iter_mut().map(|sink| &mut sink.shape))
            .chain(self.goals.iter_mut().map(|goal| &mut goal.shape))
            .chain(self.scenery.iter_mut().map(|item| &mut item.shape))
            .chain(surfaces);
        let cloths = self.cloths.iter_mut().filter_map(|cloth| match &mut cloth.form {
            Form::Sheet(_) => None,
            Form::Mesh(name) => Some(name),
        });
        let soft = self.soft_bodies.iter_mut().filter_map(|body| match &mut body.form {
            SoftForm::Box(_) => None,
            SoftForm::Mesh(name) => Some(name),
        });
        let solids = self.boxes.iter_mut().filter_map(|boxes| match &mut boxes.form {
            BoxForm::Mesh(name) => Some(name),
            BoxForm::Solid(solid) => Some(&mut solid.mesh),
            _ => None,
        });
        let schema = self.schema.as_mut().filter(|name| !name.contains("://"));
        let materials = self.materials.iter_mut().flat_map(looks);
        schema.into_iter().chain(shapes.filter_map(mesh)).chain(cloths).chain(soft).chain(solids).chain(materials)
    }
}

/// The files that particles and surfaces get their looks from.
fn looks(material: &mut Material) -> impl Iterator<Item = &mut String> {
    let picture = material.sprite.as_mut().map(|sprite| &mut sprite.picture);
    let picture = picture.filter(|picture| !Sprite::PICTURES.contains(&picture.as_str()));
    let form = material.shape.as_mut().and_then(|shape| mesh(&mut shape.form));
    material.texture.as_mut().into_iter().chain(picture).chain(form)
}

/// The file of a shape, if it is a mesh.
fn mesh(shape: &mut Shape<String>) -> Option<&mut String> {
    if let Shape::Mesh(name) = shape { Some(name) } else { None }
}
