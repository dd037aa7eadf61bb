//! What there is to draw, as plain numbers for buffers of a graphics card.

use js_sys::Float32Array;
use pointmass::Color;
use pointmass::draw::{Instance, Line, Sprite, View, back_to_front, bodies, solids, springs, sprites};
use pointmass::force::State;
use pointmass::material::Blend;
use pointmass::scene::Model;

/// Red, green, blue (sRGB) and opacity, each from 0 to 1.
fn shares(color: Color) -> [f32; 4] {
    color.map(|channel| f32::from(channel) / 255.0)
}

/// Writes one list after the other into an array.
fn packed<const N: usize>(list: impl Iterator<Item = [f32; N]>) -> Float32Array {
    let numbers: Vec<_> = list.collect();
    Float32Array::from(numbers.as_flattened())
}

/// Several short lists as one.
fn joined<const N: usize>(parts: &[&[f32]]) -> [f32; N] {
    let mut all = parts.iter().flat_map(|part| part.iter().copied());
    std::array::from_fn(|_| all.next().unwrap_or(0.0))
}

/// The sprites of a state, the farthest from the eye first, 16 numbers each.
pub(crate) fn sprites_of(state: &State<'_>, view: &View) -> Float32Array {
    let count = state.position.len();
    let (mut list, mut order, mut scratch) = (vec![Sprite::NONE; count], vec![0; count], vec![0; count]);
    let (count, _) = sprites(state, view, &mut list);
    let order = back_to_front(&list[..count], view, &mut order, &mut scratch);
    packed(order.iter().map(|&index| {
        let Sprite { center, right, up, color, material, frame, blend } = list[index as usize];
        let blend = match blend {
            Blend::Alpha => 0.0,
            Blend::Premultiplied => 1.0,
            Blend::Additive => 2.0,
            Blend::Opaque => 3.0,
        };
        let rest = [f32::from(material), f32::from(frame), blend];
        let [center, right, up] = [center, right, up].map(|v| v.to_array());
        joined::<16>(&[&center, &right, &up, &shares(color), &rest])
    }))
}

/// The shapes of a state, 17 numbers each.
pub(crate) fn shapes_of(state: &State<'_>) -> Float32Array {
    let mut list = vec![Instance::NONE; state.position.len()];
    let (count, _) = solids(state, &mut list);
    instances(&list[..count])
}

/// The rigid boxes of a state, 17 numbers each.
pub(crate) fn boxes_of(state: &State<'_>, model: &Model) -> Float32Array {
    let boxes = &model.constraints.1.boxes;
    let mut list = vec![Instance::NONE; boxes.len()];
    let (count, _) = bodies(state, boxes, &model.particles, &mut list);
    instances(&list[..count])
}

fn instances(list: &[Instance]) -> Float32Array {
    packed(list.iter().map(|instance| {
        let Instance { center, axes, color, material } = *instance;
        joined::<17>(&[&center.to_array(), &axes.to_cols_array(), &shares(color), &[f32::from(material)]])
    }))
}

/// The springs of a state that hold, 16 numbers each.
pub(crate) fn springs_of(state: &State<'_>, full: f32) -> Float32Array {
    let mut list = vec![Line::NONE; state.springs.springs.len()];
    let (count, _) = springs(state, full, &mut list);
    lines(&list[..count])
}

/// Lines, 16 numbers each.
pub(crate) fn lines(list: &[Line]) -> Float32Array {
    packed(list.iter().map(|line| {
        let [from, to] = line.ends.map(|end| end.to_array());
        let [start, end] = line.colors.map(shares);
        joined::<16>(&[&from, &to, &line.widths, &start, &end])
    }))
}
