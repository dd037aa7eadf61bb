//! What a mesh takes from the elements of a PLY file.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// What the list of a face's corners is called.
pub(super) const LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The position of a vertex.
pub(super) struct Point(pub(super) [f32; 3]);

impl PropertyAccess for Point {
    fn new() -> Self {
        Self([0.0; 3])
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name) else {
            return PropertyAccessResult::Ignored;
        };
        let Some(number) = value.to_f32_lossy() else { return PropertyAccessResult::UnsupportedType };
        self.0[axis] = number;
        PropertyAccessResult::Set
    }
}

/// The corners of a face.
pub(super) struct Face(pub(super) Option<Property>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(None)
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !LISTS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = Some(value);
        PropertyAccessResult::Set
    }
}

/// An element that a mesh has no use for.
pub(crate) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
