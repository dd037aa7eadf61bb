//! Particles as pictures that stand in space: plain lists, for whatever draws them.

use super::{Appearance, Looks, fill};
use crate::force::State;
use crate::material::{Blend, Facing, Property};
use crate::math::{frame, max, sin_cos, sin_cos_turns, sqrt, unit};
use crate::particles::{Color, WHITE};
use glam::Vec3;

/// A picture that stands in space: a parallelogram about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprite {
    /// Its middle \[m\].
    pub center: Vec3,
    /// The way from there to the middle of its right side \[m\].
    pub right: Vec3,
    /// The way from there to the middle of its top \[m\].
    pub up: Vec3,
    /// The colour that its picture is multiplied by: red, green, blue in sRGB, and opacity.
    pub color: Color,
    /// The number of its material.
    pub material: u16,
    /// The frame of the material's flipbook, from 0.
    pub frame: u16,
    /// How it is laid over what is behind it.
    pub blend: Blend,
}

impl Sprite {
    /// Nothing that can be seen, to fill a buffer with.
    pub const NONE: Self = Self {
        center: Vec3::ZERO,
        right: Vec3::ZERO,
        up: Vec3::ZERO,
        color: WHITE,
        material: 0,
        frame: 0,
        blend: Blend::Alpha,
    };
}

/// The place from which sprites are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye \[m\].
    pub eye: Vec3,
    /// The direction that is up in the picture, of any length.
    pub up: Vec3,
}

/// The sprite of the particle in a row; none, where its material has no picture, it has no size, or it is out of sight altogether.
///
/// The same bits on every machine.
#[must_use]
pub fn sprite(state: &State<'_>, row: usize, view: &View) -> Option<Sprite> {
    of_row(&mut Looks::of(state), row, view)
}

fn of_row(looks: &mut Looks<'_, '_>, row: usize, view: &View) -> Option<Sprite> {
    let (number, material) = looks.material(row)?;
    let look = material.sprite?;
    let Appearance { diameter, color, rotation, frame, .. } = looks.appearance(row)?;
    let state = looks.state;
    let (half, center) = (0.5 * diameter, state.position[row]);
    if !(half > 0.0) || color[3] == 0 {
        return None;
    }
    let (right, up) = match look.facing {
        Facing::Free => tumbled(state.key[row], rotation),
        Facing::Camera => turned(facing(view.eye - center, view.up), rotation),
        Facing::Velocity => turned(facing(view.eye - center, state.velocity[row]), rotation),
    };
    Some(Sprite { center, right: right * half, up: up * half, color, material: number, frame, blend: look.blend })
}

/// Writes the sprites of all particles that have one, in the order of rows, as far as there is room; returns their number and how many
/// were left out.
///
/// ```
/// use pointmass::draw::{Sprite, View, back_to_front, sprites};
/// use pointmass::material::{Blend, Facing, Material, SpriteMaterial};
/// use pointmass::{ContactMaterial, Heap, Particle, Scene, System, Vec3};
///
/// let puff = SpriteMaterial { frames: 1, rate: 0.0, blend: Blend::Alpha, facing: Facing::Camera };
/// let materials = [Material { size: 0.2, sprite: Some(puff), ..Material::of(ContactMaterial::default()) }];
/// let start = [1.0, 3.0, 2.0].map(|z| Particle { position: Vec3::NEG_Z * z, material: Some(0), ..Particle::REST });
/// let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
///
/// let view = View { eye: Vec3::ZERO, up: Vec3::Y };
/// let (mut drawn, mut order, mut scratch) = ([Sprite::NONE; 8], [0; 8], [0; 8]);
/// let (count, left_out) = sprites(&system.state(&scene), &view, &mut drawn);
/// let order = back_to_front(&drawn[..count], &view, &mut order, &mut scratch);
/// assert_eq!((order, left_out), (&[1, 2, 0][..], 0));
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn sprites(state: &State<'_>, view: &View, into: &mut [Sprite]) -> (usize, usize) {
    let mut looks = Looks::of(state);
    fill((0..state.position.len()).filter_map(|row| of_row(&mut looks, row, view)), into)
}

/// The order in which sprites have to be drawn, the farthest first, those at one distance in the order of the list: a radix sort, in
/// time that grows with their number and nothing else. `order` and `scratch` need a word for each sprite; what finds no room is left out.
pub fn back_to_front<'o>(sprites: &[Sprite], view: &View, order: &'o mut [u32], scratch: &mut [u32]) -> &'o [u32] {
    let count = sprites.len().min(order.len()).min(scratch.len());
    let (order, scratch) = (&mut order[..count], &mut scratch[..count]);
    for (place, index) in order.iter_mut().zip(0..) {
        *place = index;
    }
    // Numbers that are not below zero are in the order of their bits.
    let key = |index: u32| {
        let way = sprites[index as usize].center - view.eye;
        !(way.x * way.x + way.y * way.y + way.z * way.z).to_bits()
    };
    for shift in [0, 16] {
        pass(order, scratch, |index| key(index) >> shift & 0xff);
        pass(scratch, order, |index| key(index) >> (shift + 8) & 0xff);
    }
    order
}

/// Sorts indices by one byte of their keys, stably.
fn pass(from: &[u32], to: &mut [u32], digit: impl Fn(u32) -> u32) {
    let mut starts = [0u32; 257];
    for &index in from {
        starts[digit(index) as usize + 1] += 1;
    }
    for byte in 0..256 {
        starts[byte + 1] += starts[byte];
    }
    for &index in from {
        let next = &mut starts[digit(index) as usize];
        to[*next as usize] = index;
        *next += 1;
    }
}

/// The right and the top of what faces along `toward`, its top as near to `up` as it can be.
fn facing(toward: Vec3, up: Vec3) -> (Vec3, Vec3) {
    let normal = unit(toward);
    let right = unit(up.cross(normal));
    if right == Vec3::ZERO {
        return frame(if normal == Vec3::ZERO { Vec3::Z } else { normal });
    }
    (right, normal.cross(right))
}

/// The same turned anticlockwise, as seen from the front.
fn turned((right, up): (Vec3, Vec3), angle: f32) -> (Vec3, Vec3) {
    if angle == 0.0 {
        return (right, up);
    }
    let (sin, cos) = sin_cos(angle);
    (right * cos + up * sin, up * cos - right * sin)
}

/// The right and the top of what has turned by an angle about an axis in its plane that is a particle's own.
pub(super) fn tumbled(key: u32, angle: f32) -> (Vec3, Vec3) {
    let height = 2.0 * Property::AxisHeight.between(key) - 1.0;
    let (sin, cos) = sin_cos_turns(Property::AxisAngle.between(key));
    let around = sqrt(max(1.0 - height * height, 0.0));
    let axis = unit(Vec3::new(around * cos, around * sin, height));
    let (x, y) = frame(axis);
    let (sin, cos) = sin_cos(angle);
    (x * cos + y * sin, axis)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_faces_the_eye_faces_it() {
        let eye = Vec3::new(3.0, -2.0, 5.0);
        for i in 0..1000u16 {
            let t = f32::from(i);
            let center = Vec3::new((t * 0.7).sin() * 9.0, (t * 1.3).cos() * 4.0, (t * 0.37).sin() * 7.0);
            let up = Vec3::new((t * 0.11).cos(), 1.0, (t * 0.23).sin());
            let (right, top) = turned(facing(eye - center, up), t * 0.1);
            let toward = (eye - center).normalize();
            assert!(right.cross(top).dot(toward) > 1.0 - 1e-5, "{center}");
            assert!(right.dot(top).abs() < 1e-6 && right.dot(toward).abs() < 1e-5);
            let (right, top) = facing(eye - center, up);
            assert!(right.dot(up).abs() < 1e-5 && top.dot(up) > 0.0);
        }
        // From straight above there is no up, and still a picture.
        let (right, top) = facing(Vec3::Y, Vec3::Y);
        assert!((right.cross(top) - Vec3::Y).length() < 1e-6);
        let (right, top) = tumbled(77, 1.0);
        assert!((right.length() - 1.0).abs() < 1e-5 && right.dot(top).abs() < 1e-6);
    }

    #[test]
    fn the_farthest_come_first_and_equals_keep_their_order() {
        let view = View { eye: Vec3::new(1.0, 2.0, 3.0), up: Vec3::Y };
        for count in [0usize, 1, 2, 300, 5000] {
            let place = |i: usize| Vec3::new((i * i % 17) as f32, (i * 7 % 5) as f32, (i % 3) as f32);
            let list: std::vec::Vec<_> = (0..count).map(|i| Sprite { center: place(i), ..Sprite::NONE }).collect();
            let (mut order, mut scratch) = (std::vec![0; count + 3], std::vec![9; count]);
            let order = back_to_front(&list, &view, &mut order, &mut scratch);
            let mut exact: std::vec::Vec<_> = (0..count as u32).collect();
            let distance = |&i: &u32| (list[i as usize].center - view.eye).length_squared();
            exact.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
            assert_eq!(order, exact);
        }
    }
}
