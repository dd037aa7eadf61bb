//! Hashes of what there is to draw: every target has to make the same lists.

use pointmass::draw::{
    Instance, Line, Lock, Patch, Sprite, StrandLight, Vertex, View, back_to_front, bodies, solids, sprites, strands,
    surface,
};
use pointmass::force::State;
use pointmass::{Fnv, Particle, RigidBox, Vec3};

const EYE: Vec3 = Vec3::new(1.0, 2.0, 3.0);

/// The list of at most `N` sprites, the farthest first.
#[inline(never)]
pub(crate) fn hash_sprites<const N: usize>(state: &State<'_>, hash: &mut Fnv) {
    let view = View { eye: EYE, up: Vec3::Y };
    let (mut drawn, mut order, mut scratch) = ([Sprite::NONE; N], [0; N], [0; N]);
    let (count, left_out) = sprites(state, &view, &mut drawn);
    hash.long(left_out as u64);
    for &index in back_to_front(&drawn[..count], &view, &mut order, &mut scratch) {
        let Sprite { center, right, up, color, frame, .. } = drawn[index as usize];
        [center, right, up].into_iter().flat_map(|v| v.to_array()).for_each(|x| hash.float(x));
        hash.bytes(&color);
        hash.long(frame.into());
    }
}

/// Lines, as many as a chip can spare the memory for.
#[inline(never)]
pub(crate) fn hash_lines(list: impl FnOnce(&mut [Line]) -> (usize, usize), hash: &mut Fnv) {
    let mut drawn = [Line::NONE; 32];
    let (count, left_out) = list(&mut drawn);
    hash.long(left_out as u64);
    for Line { ends, widths, colors } in &drawn[..count] {
        ends.iter().flat_map(Vec3::to_array).chain(*widths).for_each(|x| hash.float(x));
        hash.bytes(colors.as_flattened());
    }
}

/// Strands in a light.
#[inline(never)]
pub(crate) fn hash_strands(state: &State<'_>, lock: &Lock, hash: &mut Fnv) {
    let light = StrandLight { direction: Vec3::new(0.3, -1.0, 0.2), eye: EYE, ambient: 0.3, gloss: 0.6 };
    hash_lines(|into| strands(state, lock, &light, into), hash);
}

/// The shapes that at most `N` particles are drawn as.
#[inline(never)]
pub(crate) fn hash_solids<const N: usize>(state: &State<'_>, hash: &mut Fnv) {
    let mut drawn = [Instance::NONE; N];
    let (count, _) = solids(state, &mut drawn);
    hash_instances(&drawn[..count], hash);
}

/// The boxes of at most four rigid bodies.
#[inline(never)]
pub(crate) fn hash_bodies(state: &State<'_>, boxes: &[RigidBox], start: &[Particle], hash: &mut Fnv) {
    let mut drawn = [Instance::NONE; 4];
    let (count, _) = bodies(state, boxes, start, &mut drawn);
    hash.long(count as u64);
    hash_instances(&drawn[..count], hash);
}

fn hash_instances(drawn: &[Instance], hash: &mut Fnv) {
    for Instance { center, axes, color, .. } in drawn {
        center.to_array().into_iter().chain(axes.to_cols_array()).for_each(|x| hash.float(x));
        hash.bytes(color);
    }
}

/// A surface of `V` particles and at most `F` triangles, and the normals on it.
#[inline(never)]
pub(crate) fn hash_surface<const V: usize, const F: usize>(state: &State<'_>, patch: &Patch<'_>, hash: &mut Fnv) {
    let (mut vertices, mut triangles) = ([Vertex::NONE; V], [[0; 3]; F]);
    let (_, count) = surface(state, patch, &mut vertices, &mut triangles);
    hash.long(count as u64);
    vertices.iter().flat_map(|vertex| vertex.normal.to_array()).for_each(|x| hash.float(x));
}
