//! What there is to draw, as plain numbers for buffers of a graphics card.

use crate::memory::{filled, floats, integers, reserved, room, words};
use js_sys::{Float32Array, Int32Array, Uint32Array};
use pointmass::draw::{
    Instance, Line, Lock, Looks, Sprite, StrandLight, Vertex, View, back_to_front, body, links_by_strain, solids,
    springs, sprites, strands, surface,
};
use pointmass::force::State;
use pointmass::material::Blend;
use pointmass::scene::Model;
use pointmass::{Color, RigidBox};
use wasm_bindgen::JsError;

/// The result of most calls: a list, or an error, if there is not enough memory for it.
pub(crate) type Listed<T = Float32Array> = Result<T, JsError>;

/// Bytes that a corner or a triangle of a body takes at most while it is drawn.
const CORNER: usize = 256;

/// Red, green, blue (sRGB) and opacity, each from 0 to 1.
fn shares(color: Color) -> [f32; 4] {
    color.map(|channel| f32::from(channel) / 255.0)
}

/// Writes lists, so many at most, one after the other into an array of `what`.
fn packed<const N: usize>(what: &str, most: usize, list: impl Iterator<Item = [f32; N]>) -> Listed {
    let mut numbers = reserved(most, what)?;
    numbers.extend(list.take(most));
    floats(numbers.as_flattened())
}

/// Several short lists as one.
fn joined<const N: usize>(parts: &[&[f32]]) -> [f32; N] {
    let mut all = parts.iter().flat_map(|part| part.iter().copied());
    std::array::from_fn(|_| all.next().unwrap_or(0.0))
}

/// The particles of the start that are drawn as something else: corners of surfaces, of bodies' boxes, and points of strands.
pub(crate) fn covered(model: &Model) -> Vec<bool> {
    let mut covered = vec![false; model.particles.len()];
    let patches = model.patches.iter().map(|patch| (patch.first, patch.count));
    let boxes = model.constraints.1.boxes.iter().map(|of| (of.first, of.count));
    let locks = model.locks.iter().map(|lock| (lock.first, lock.points.saturating_mul(lock.count)));
    for (first, count) in patches.chain(boxes).chain(locks) {
        let first = first as usize;
        let own = covered.get_mut(first..first.saturating_add(count as usize));
        own.unwrap_or_default().fill(true);
    }
    covered
}

/// The rows of those that are drawn as points or balls, as the command line's pictures have them; `serial` has the number of each row, and
/// `covered` those of the start that are drawn as something else.
pub(crate) fn points_of(state: &State<'_>, serial: &[u32], covered: &[bool]) -> Listed<Uint32Array> {
    let mut rows = reserved(serial.len(), "the points")?;
    let is_covered = |number: u32| covered.get(number as usize).is_some_and(|&covered| covered);
    let mut looks = Looks::of(state);
    let drawn = serial.iter().enumerate().filter(|&(row, &number)| !is_covered(number) && looks.is_dot(row));
    rows.extend(drawn.map(|(row, _)| row as u32));
    words(&rows)
}

/// The number of the material in each row, -1 for none.
pub(crate) fn materials_of(state: &State<'_>) -> Listed<Int32Array> {
    let mut list = reserved(state.material.len(), "the materials")?;
    list.extend(state.material.iter().map(|&number| i32::from(number) - 1));
    integers(&list)
}

/// The sprites of a state, the farthest from the eye first, 16 numbers each.
pub(crate) fn sprites_of(state: &State<'_>, view: &View) -> Listed {
    const WHAT: &str = "the sprites";
    let count = state.position.len();
    let (mut order, mut scratch) = (filled(0, count, WHAT)?, filled(0, count, WHAT)?);
    let mut list = filled(Sprite::NONE, count, WHAT)?;
    let (count, _) = sprites(state, view, &mut list);
    let order = back_to_front(&list[..count], view, &mut order, &mut scratch);
    let numbers = order.iter().map(|&index| {
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
    });
    packed(WHAT, count, numbers)
}

/// The shapes of a state, 17 numbers each.
pub(crate) fn shapes_of(state: &State<'_>) -> Listed {
    let mut list = filled(Instance::NONE, state.position.len(), "the shapes")?;
    let (count, _) = solids(state, &mut list);
    instances("the shapes", &list[..count])
}

/// The rigid boxes of a state, 17 numbers each.
pub(crate) fn boxes_of(state: &State<'_>, model: &Model) -> Listed {
    let all = &model.constraints.1.boxes;
    let mut list = reserved(all.len(), "the boxes")?;
    let boxes = all.iter().filter(|of| of.hull.is_none());
    list.extend(boxes.filter_map(|of| body(state, of, &model.particles)));
    instances("the boxes", &list)
}

/// The triangles of cloths and of hulls, 30 numbers each.
pub(crate) fn surfaces_of(state: &State<'_>, model: &Model) -> Listed {
    const WHAT: &str = "the surfaces";
    let mut list: Vec<[f32; 30]> = Vec::new();
    let mut add = |triangles: &[[Vertex; 3]]| {
        // The list grows to twice its room and is copied then.
        let more = reserved::<[f32; 30]>(2 * (list.len() + triangles.len()), WHAT)?;
        drop(more);
        list.extend(triangles.iter().map(flattened));
        Ok::<(), JsError>(())
    };
    for patch in &model.patches {
        let mut vertices = filled(Vertex::NONE, patch.count as usize, WHAT)?;
        let mut triangles = filled([0; 3], patch.triangles.len(), WHAT)?;
        let (_, count) = surface(state, &patch.lend(), &mut vertices, &mut triangles);
        let mut corners = reserved(count, WHAT)?;
        corners.extend(triangles[..count].iter().map(|triangle| triangle.map(|corner| vertices[corner as usize])));
        add(&corners)?;
    }
    let corners = model.surfaces.values().map(|mesh| mesh.vertices().len() + mesh.triangles().len()).max();
    for of in model.constraints.1.boxes.iter().filter(|of| of.hull.is_some()) {
        room(corners.unwrap_or(0).saturating_mul(CORNER), WHAT)?;
        add(&hull(state, of, model))?;
    }
    floats(list.as_flattened())
}

/// The triangles of a body that is no box.
fn hull(state: &State<'_>, of: &RigidBox, model: &Model) -> Vec<[Vertex; 3]> {
    let Some((corners, triangles)) = model.surface(of) else { return Vec::new() };
    let Some(Instance { center, axes, color, .. }) = body(state, of, &model.particles) else { return Vec::new() };
    let triangles = triangles.into_iter().map(|ends| {
        let [a, b, c] = ends.map(|corner| center + axes * (corners[corner as usize] / of.half));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        [a, b, c].map(|place| Vertex { place, normal, color })
    });
    triangles.collect()
}

/// A triangle as numbers.
fn flattened(corners: &[Vertex; 3]) -> [f32; 30] {
    let corners = corners
        .map(|Vertex { place, normal, color }| joined::<10>(&[&place.to_array(), &normal.to_array(), &shares(color)]));
    joined::<30>(&[corners.as_flattened()])
}

/// The segments of strands, 16 numbers each.
pub(crate) fn strands_of(state: &State<'_>, model: &Model, light: &StrandLight) -> Listed {
    let segments = |lock: &Lock| (lock.count as usize).saturating_mul(lock.points as usize);
    let mut list = filled(Line::NONE, model.locks.iter().map(segments).sum(), "the strands")?;
    let mut count = 0;
    for lock in &model.locks {
        count += strands(state, lock, light, &mut list[count..]).0;
    }
    lines("the strands", &list[..count])
}

fn instances(what: &str, list: &[Instance]) -> Listed {
    let numbers = list.iter().map(|instance| {
        let Instance { center, axes, color, material } = *instance;
        // A box may have none, which is -1 as in the list of materials.
        let material = if material == u16::MAX { -1.0 } else { f32::from(material) };
        joined::<17>(&[&center.to_array(), &axes.to_cols_array(), &shares(color), &[material]])
    });
    packed(what, list.len(), numbers)
}

/// The springs of a state that hold, 16 numbers each.
pub(crate) fn springs_of(state: &State<'_>, full: f32) -> Listed {
    let mut list = filled(Line::NONE, state.springs.springs.len(), "the springs")?;
    let (count, _) = springs(state, full, &mut list);
    lines("the springs", &list[..count])
}

/// The links of constraints, 16 numbers each, but for those of ropes that are among the strands.
pub(crate) fn links_of(state: &State<'_>, model: &Model, full: f32) -> Listed {
    let ropes = model.locks.len().saturating_sub(model.ropes.len());
    let ropes = &model.locks[ropes..];
    let all = || model.constraints.0.iter().flat_map(|kind| kind.links().zip(kind.lengths()));
    let mut pairs = reserved(all().count(), "the links")?;
    pairs.extend(all().filter(|&(ends, _)| !is_segment(ropes, ends)));
    let mut list = filled(Line::NONE, pairs.len(), "the links")?;
    let (count, _) = links_by_strain(state, pairs.into_iter(), full, &mut list);
    lines("the links", &list[..count])
}

/// Tells whether a link is a segment of one of some ropes, of which each begins behind the one before.
fn is_segment(ropes: &[Lock], [a, b]: [u32; 2]) -> bool {
    let last = ropes.partition_point(|rope| rope.first <= a.min(b));
    let own = last.checked_sub(1).is_some_and(|last| a.max(b) - ropes[last].first < ropes[last].points);
    own && a.abs_diff(b) == 1
}

/// Lines, 16 numbers each.
pub(crate) fn lines(what: &str, list: &[Line]) -> Listed {
    let numbers = list.iter().map(|line| {
        let [from, to] = line.ends.map(|end| end.to_array());
        let [start, end] = line.colors.map(shares);
        joined::<16>(&[&from, &to, &line.widths, &start, &end])
    });
    packed(what, list.len(), numbers)
}
