//! Surfaces between particles, such as cloth: smooth, and torn where its springs are.

use super::Looks;
use crate::force::State;
use crate::math::{length, unit};
use crate::particles::{Color, Particle};
use glam::Vec3;

/// A corner of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Its place \[m\].
    pub place: Vec3,
    /// The unit normal of the surface there, the mean of the triangles around by their areas; zero where there are none, or areas beyond
    /// numbers.
    pub normal: Vec3,
    /// Its colour: red, green, blue in sRGB, and opacity.
    pub color: Color,
}

impl Vertex {
    /// Nothing that can be seen, to fill a buffer with.
    pub const NONE: Self = Self { place: Vec3::ZERO, normal: Vec3::ZERO, color: [0; 4] };
}

/// The particles that a surface spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<'a> {
    /// The number that its first corner has in the scene's start.
    pub first: u32,
    /// How many corners it has; they follow each other there.
    pub count: u32,
    /// Its triangles, by corners counted from 0, seen anticlockwise from outside.
    pub triangles: &'a [[u32; 3]],
}

/// Writes a surface's corners, and those of its triangles that are there, in their order; returns the numbers of both. A triangle is
/// gone if one of its corners is, or a spring along one of its edges has broken.
///
/// What finds no room is left out: triangles as well, whose corners do. `triangles` needs as many entries as the patch has.
///
/// ```
/// use pointmass::draw::{Patch, Vertex, surface};
/// use pointmass::{Heap, Particle, Scene, Sheet, System, Vec3};
///
/// let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [2, 2] };
/// let start: Vec<_> = sheet.particles(Particle::REST).collect();
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let all: Vec<_> = sheet.triangles().collect();
/// let patch = Patch { first: 0, count: 9, triangles: &all };
/// let (mut vertices, mut triangles) = ([Vertex::NONE; 9], [[0; 3]; 8]);
/// assert_eq!(surface(&system.state(&scene), &patch, &mut vertices, &mut triangles), (9, 8));
/// assert!(vertices.iter().all(|vertex| vertex.normal.y.abs() == 1.0)); // It lies flat.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn surface(
    state: &State<'_>,
    patch: &Patch<'_>,
    vertices: &mut [Vertex],
    triangles: &mut [[u32; 3]],
) -> (usize, usize) {
    let Patch { first, count, triangles: all } = *patch;
    let count = vertices.len().min(count as usize);
    let vertices = &mut vertices[..count];
    let row = |corner: u32| state.springs.row(first.checked_add(corner)?);
    let mut looks = Looks::of(state);
    for (vertex, corner) in vertices.iter_mut().zip(0..) {
        *vertex = row(corner).map_or(Vertex::NONE, |row| {
            let color = looks.color(row).unwrap_or([0; 4]);
            Vertex { place: state.position[row], normal: Vec3::ZERO, color }
        });
    }
    let may_tear = state.springs.springs.iter().any(|spring| spring.breaks_at.is_some());
    let torn = |[a, b, c]: [u32; 3]| {
        let torn = |a: u32, b: u32| state.springs.is_torn(first + a, first + b);
        may_tear && (torn(a, b) || torn(b, c) || torn(c, a))
    };
    let is_there = |corners: [u32; 3]| corners.iter().all(|&corner| (corner as usize) < count && row(corner).is_some());
    let mut kept = 0;
    for &corners in all.iter().filter(|&&corners| is_there(corners) && !torn(corners)) {
        let Some(room) = triangles.get_mut(kept) else { break };
        *room = corners;
        kept += 1;
        let [a, b, c] = corners.map(|corner| vertices[corner as usize].place);
        let normal = (b - a).cross(c - a);
        corners.iter().for_each(|&corner| vertices[corner as usize].normal += normal);
    }
    // The areas of what has exploded are beyond numbers.
    vertices
        .iter_mut()
        .for_each(|vertex| vertex.normal = Some(unit(vertex.normal)).filter(|n| n.is_finite()).unwrap_or_default());
    (count, kept)
}

/// Writes the strains of a surface's corners: of the edges of its `triangles` there by which it is stretched (> 0) or pressed together (< 0) the
/// most, as a share of their lengths among what the scene starts with; zero where there are none. [`strained`](super::strained) has colours for them.
///
/// ```
/// use pointmass::draw::{Patch, Vertex, strains, surface};
/// use pointmass::{Heap, Particle, Scene, Sheet, System, Vec3};
///
/// let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [1, 1] };
/// let begun: Vec<_> = sheet.particles(Particle::REST).collect();
/// let wide: Vec<_> = begun.iter().map(|p| Particle { position: p.position * Vec3::new(1.5, 1.0, 1.0), ..*p }).collect();
/// let scene = Scene { start: &wide, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let all: Vec<_> = sheet.triangles().collect();
/// let patch = Patch { first: 0, count: 4, triangles: &all };
/// let (mut vertices, mut triangles, mut found) = ([Vertex::NONE; 4], [[0; 3]; 2], [0.0; 4]);
/// surface(&system.state(&scene), &patch, &mut vertices, &mut triangles);
/// strains(&patch, &begun, &vertices, &triangles, &mut found);
/// assert_eq!(found, [0.5; 4]);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn strains(patch: &Patch<'_>, start: &[Particle], vertices: &[Vertex], triangles: &[[u32; 3]], into: &mut [f32]) {
    into.fill(0.0);
    let begun = |corner: u32| Some(start.get(patch.first.checked_add(corner)? as usize)?.position);
    let now = |corner: u32| Some(vertices.get(corner as usize)?.place);
    let strain = |a: u32, b: u32| {
        let rest = length(begun(b)? - begun(a)?);
        let strain = length(now(b)? - now(a)?) / rest - 1.0;
        strain.is_finite().then_some(strain)
    };
    for &[a, b, c] in triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            let Some(strain) = strain(a, b) else { continue };
            for corner in [a, b] {
                if let Some(most) = into.get_mut(corner as usize).filter(|most| most.abs() < strain.abs()) {
                    *most = strain;
                }
            }
        }
    }
}
