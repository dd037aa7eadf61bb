//! Particles as shapes: where each stands and which way it points. Whoever draws has the shapes.

use super::sprite::tumbled;
use super::{Appearance, Looks, fill};
use crate::force::State;
use crate::material::Heading;
use crate::math::{frame, sin_cos, unit};
use crate::particles::{Color, WHITE};
use glam::{Mat3, Vec3};

/// A shape that stands in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The place of the shape's origin \[m\].
    pub center: Vec3,
    /// The images of its axes: a turn, times half of the particle's diameter, so that a shape from −1 to 1 is as wide as that.
    pub axes: Mat3,
    /// Its colour: red, green, blue in sRGB, and opacity.
    pub color: Color,
    /// The number of the particle's material, which says the shape.
    pub material: u16,
}

impl Instance {
    /// Nothing that can be seen, to fill a buffer with.
    pub const NONE: Self = Self { center: Vec3::ZERO, axes: Mat3::ZERO, color: WHITE, material: 0 };
}

/// The shape of the particle in a row; none, where its material has none, it has no size, or it is out of sight altogether.
///
/// The same bits on every machine.
#[must_use]
pub fn solid(state: &State<'_>, row: usize) -> Option<Instance> {
    of_row(&mut Looks::of(state), row)
}

fn of_row(looks: &mut Looks<'_, '_>, row: usize) -> Option<Instance> {
    let (number, material) = looks.material(row)?;
    let heading = material.heading?;
    let Appearance { diameter, color, rotation, .. } = looks.appearance(row)?;
    let state = looks.state;
    let half = 0.5 * diameter;
    if !(half > 0.0) || color[3] == 0 {
        return None;
    }
    let turn = match heading {
        Heading::Upright => about(Vec3::Y, rotation),
        Heading::Velocity => about(unit(state.velocity[row]), rotation),
        Heading::Free => {
            let (right, up) = tumbled(state.key[row], rotation);
            Mat3::from_cols(right, up, right.cross(up))
        }
    };
    Some(Instance { center: state.position[row], axes: turn * half, color, material: number })
}

/// Writes the shapes of all particles that have one, in the order of rows, as far as there is room; returns their number and how many
/// were left out.
///
/// ```
/// use pointmass::draw::{Instance, solids};
/// use pointmass::material::{Heading, Material};
/// use pointmass::{ContactMaterial, Heap, Particle, Scene, System, Vec3};
///
/// let dart = Material { heading: Some(Heading::Velocity), ..Material::of(ContactMaterial::default()) };
/// let start = [Particle { velocity: Vec3::X * 9.0, radius: 0.5, material: Some(0), ..Particle::REST }];
/// let scene = Scene { start: &start, materials: &[dart], ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let mut drawn = [Instance::NONE; 4];
/// assert_eq!(solids(&system.state(&scene), &mut drawn), (1, 0));
/// assert_eq!(drawn[0].axes.y_axis, Vec3::X * 0.5); // What is up in the shape points ahead.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn solids(state: &State<'_>, into: &mut [Instance]) -> (usize, usize) {
    let mut looks = Looks::of(state);
    fill((0..state.position.len()).filter_map(|row| of_row(&mut looks, row)), into)
}

/// The turn that takes y to an axis and turns by an angle about it, anticlockwise as seen from its tip. Without an axis it stays
/// upright.
fn about(axis: Vec3, angle: f32) -> Mat3 {
    let up = if axis == Vec3::ZERO { Vec3::Y } else { axis };
    let (x, z) = if up == Vec3::Y { (Vec3::X, Vec3::Z) } else { sides(up) };
    let (sin, cos) = sin_cos(angle);
    Mat3::from_cols(x * cos - z * sin, up, z * cos + x * sin)
}

/// Two more axes, of which x, the given one and z are right-handed.
fn sides(up: Vec3) -> (Vec3, Vec3) {
    let (a, b) = frame(up);
    if a.cross(up).dot(b) > 0.0 { (a, b) } else { (b, a) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_turns_and_point_where_they_should() {
        for i in 0..500u16 {
            let t = f32::from(i);
            let axis = unit(Vec3::new((t * 0.7).sin(), (t * 1.3).cos(), (t * 0.37).sin()));
            for turn in [about(axis, t), about(Vec3::Y, t), about(Vec3::ZERO, t)] {
                assert!((turn.determinant() - 1.0).abs() < 1e-5);
                assert!((turn.transpose() * turn).abs_diff_eq(Mat3::IDENTITY, 1e-5));
            }
            assert_eq!(about(axis, t).y_axis, axis);
        }
        // A quarter turn about y takes z to x, and x to −z.
        let quarter = about(Vec3::Y, core::f32::consts::FRAC_PI_2);
        assert!(quarter.z_axis.abs_diff_eq(Vec3::X, 1e-6) && quarter.x_axis.abs_diff_eq(Vec3::NEG_Z, 1e-6));
    }
}
