//! What there is to draw, as plain numbers for buffers of a graphics card.

use js_sys::Float32Array;
use pointmass::Color;
use pointmass::draw::{
    Instance, Line, Lock, Sprite, StrandLight, Vertex, View, back_to_front, body, solids, springs, sprites, strands,
    surface,
};
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
    let boxes = model.constraints.1.boxes.iter().filter(|of| of.hull.is_none());
    let list: Vec<_> = boxes.filter_map(|of| body(state, of, &model.particles)).collect();
    instances(&list)
}

/// The triangles of cloths and of hulls, 30 numbers each.
pub(crate) fn surfaces_of(state: &State<'_>, model: &Model) -> Float32Array {
    let cloths = model.patches.iter().flat_map(|patch| {
        let mut vertices = vec![Vertex::NONE; patch.count as usize];
        let mut triangles = vec![[0; 3]; patch.triangles.len()];
        let (_, count) = surface(state, &patch.lend(), &mut vertices, &mut triangles);
        triangles.truncate(count);
        triangles.into_iter().map(move |corners| corners.map(|corner| vertices[corner as usize]))
    });
    let hulls = model.constraints.1.boxes.iter().filter_map(|of| {
        let (corners, triangles) = model.surface(of)?;
        let Instance { center, axes, color, .. } = body(state, of, &model.particles)?;
        let triangles = triangles.into_iter().map(|ends| {
            let [a, b, c] = ends.map(|corner| center + axes * (corners[corner as usize] / of.half));
            let normal = (b - a).cross(c - a).normalize_or_zero();
            [a, b, c].map(|place| Vertex { place, normal, color })
        });
        Some(triangles.collect::<Vec<_>>())
    });
    packed(cloths.chain(hulls.flatten()).map(|corners| {
        let corners = corners.map(|Vertex { place, normal, color }| {
            joined::<10>(&[&place.to_array(), &normal.to_array(), &shares(color)])
        });
        joined::<30>(&[corners.as_flattened()])
    }))
}

/// The segments of strands, 16 numbers each.
pub(crate) fn strands_of(state: &State<'_>, model: &Model, light: &StrandLight) -> Float32Array {
    let segments = |lock: &Lock| (lock.count as usize).saturating_mul(lock.points as usize);
    let mut list = vec![Line::NONE; model.locks.iter().map(segments).sum()];
    let mut count = 0;
    for lock in &model.locks {
        count += strands(state, lock, light, &mut list[count..]).0;
    }
    lines(&list[..count])
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
