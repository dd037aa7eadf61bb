//! Checks of shapes.

use super::SceneError;
use super::numbers::{Checked, check_direction, finite};
use crate::shape::Shape;
use alloc::format;
use alloc::string::String;
use glam::Vec3;

/// Checks that a shape has numbers that it can have.
pub(super) fn check_shape(at: &str, shape: &Shape<String>) -> Checked {
    let rows = |rows: &[Vec3]| rows.iter().try_for_each(|row| finite(at, &row.to_array()));
    let sizes = |sizes: &[f32]| {
        finite(at, sizes)?;
        match sizes.iter().find(|&&size| size < 0.0) {
            Some(size) => Err(SceneError::value(at, format!("radius and height have to be zero or more, not {size}"))),
            None => Ok(()),
        }
    };
    match shape {
        Shape::Line(s) => rows(&[s.from, s.to]),
        Shape::Box(s) => rows(&[s.min, s.max]),
        Shape::Sphere(s) => rows(&[s.center]).and(sizes(&[s.radius])),
        Shape::Cylinder(s) => rows(&[s.center]).and(sizes(&[s.radius, s.height])),
        Shape::Cone(s) => rows(&[s.center]).and(sizes(&[s.radius, s.height])),
        Shape::Circle(s) => rows(&[s.center]).and(sizes(&[s.radius])).and(check_direction(at, s.normal)),
        Shape::Capsule(s) => rows(&[s.from, s.to]).and(sizes(&[s.radius])),
        Shape::Triangle(s) => rows(&s.corners),
        Shape::Plane(s) => rows(&[s.point]).and(check_direction(at, s.normal)),
        Shape::Mesh(_) | Shape::HeightField(_) => Ok(()),
    }
}
