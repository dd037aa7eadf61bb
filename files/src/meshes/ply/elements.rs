//! Elements of a PLY file, as far as meshes and clouds take them.

use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};

/// Names of the list of a face's corners.
pub(super) const LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The position of a vertex; planar if it has no z.
pub(crate) struct Point(pub(crate) [f64; 3]);

impl PropertyAccess for Point {
    fn new() -> Self {
        Self([0.0; 3])
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name) else {
            return PropertyAccessResult::Ignored;
        };
        // Of the types there are, only the double is rounded by the library, and whole numbers of 32 bits.
        let number = match value {
            Property::Double(number) => Some(number),
            Property::Int(number) => Some(f64::from(number)),
            Property::UInt(number) => Some(f64::from(number)),
            other => other.to_f32_lossy().map(f64::from),
        };
        let Some(number) = number else { return PropertyAccessResult::UnsupportedType };
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

/// An element that nobody has a use for.
pub(crate) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
