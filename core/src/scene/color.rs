//! The colour that particles of a material are drawn in.

use crate::particles::Color;

/// The colour of particles of a material: diffuse, or emitted where that is black.
pub(super) fn shown(diffuse: [f32; 3], emission: [f32; 3]) -> Color {
    let [r, g, b] = if diffuse == [0.0; 3] { emission } else { diffuse };
    // The casts saturate.
    let byte = |x: f32| (x * 255.0 + 0.5) as u8;
    [byte(r), byte(g), byte(b), 255]
}
