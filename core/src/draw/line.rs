//! Lines: springs by their strain, velocities, the edges of boxes. Trails are made of them as well.

use super::{Looks, fill};
use crate::force::{Held, State};
use crate::index::image_beside;
use crate::math::{clamp, length};
use crate::particles::{Color, WHITE};
use crate::shape::Aabb;
use glam::Vec3;

/// A straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Its ends \[m\].
    pub ends: [Vec3; 2],
    /// Its width there \[m\]; zero: about a pixel.
    pub widths: [f32; 2],
    /// Its colours there: red, green, blue in sRGB, and opacity.
    pub colors: [Color; 2],
}

impl Line {
    /// Nothing that can be seen, to fill a buffer with.
    pub const NONE: Self = Self { ends: [Vec3::ZERO; 2], widths: [0.0; 2], colors: [[0; 4]; 2] };

    /// One of a single colour, about a pixel wide.
    #[must_use]
    pub const fn plain(ends: [Vec3; 2], color: Color) -> Self {
        Self { ends, widths: [0.0; 2], colors: [color; 2] }
    }
}

/// The colours of what is shorter than at rest, as long, and longer.
const SHORT: Color = [60, 110, 235, 255];
const SLACK: Color = [170, 170, 180, 255];
const LONG: Color = [235, 70, 50, 255];

/// Writes the springs that hold, in the scene's order, as far as there is room; returns their number and how many were left out.
///
/// They are grey at rest, the redder the longer and the bluer the shorter they are: all red where they are longer than at rest by a
/// share of `full`, above zero. Beside infinity they are all grey.
///
/// ```
/// use pointmass::draw::{Line, springs};
/// use pointmass::{Heap, Particle, Scene, Spring, System, Vec3};
///
/// let start = [0.0, 1.1].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
/// let scene = Scene { start: &start, springs: &&[Spring::new([0, 1], 1.0, 10.0)][..], ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let mut lines = [Line::NONE; 4];
/// assert_eq!(springs(&system.state(&scene), 0.1, &mut lines), (1, 0));
/// assert!(lines[0].colors[0][0] > 200 && lines[0].ends == [Vec3::ZERO, Vec3::X * 1.1]); // It is red.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn springs(state: &State<'_>, full: f32, into: &mut [Line]) -> (usize, usize) {
    let line = |Held { spring, rows: [a, b], .. }: Held<'_>| {
        let ends = ends(state, [a, b]);
        by_strain(ends, spring.rest(state.time), full)
    };
    fill(state.springs.held().map(line), into)
}

/// The line between two places that are so far apart at rest \[m\].
fn by_strain(ends: [Vec3; 2], rest: f32, full: f32) -> Line {
    let strain = if rest > 0.0 { length(ends[1] - ends[0]) / rest - 1.0 } else { 0.0 };
    Line::plain(ends, strained(strain / full))
}

/// Where two particles are, the second in the image that is nearest to the first.
fn ends(state: &State<'_>, [a, b]: [usize; 2]) -> [Vec3; 2] {
    let [a, b] = [state.position[a], state.position[b]];
    [a, image_beside(state.near.room(), a, b)]
}

/// Writes lines between pairs of particles, by their numbers in the scene's start, as far as both live and there is room: the links of
/// constraints, say. Returns their number and how many were left out.
pub fn links(
    state: &State<'_>,
    pairs: impl Iterator<Item = [u32; 2]>,
    color: Color,
    into: &mut [Line],
) -> (usize, usize) {
    let row = |number: u32| state.springs.row(number);
    let line = |rows| Line::plain(ends(state, rows), color);
    fill(pairs.filter_map(|[a, b]| Some(line([row(a)?, row(b)?]))), into)
}

/// Writes the lines that [`links`] does, in the colours that [`springs`] have by their strain, for pairs that come with how far apart they are at
/// rest \[m\]. Returns their number and how many were left out.
///
/// ```
/// use pointmass::draw::{Line, links_by_strain, strained};
/// use pointmass::{Heap, Particle, Scene, System, Vec3};
///
/// let start = [0.0, 1.1, 2.05].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let (rope, mut lines) = ([([0, 1], 1.0), ([1, 2], 1.0)], [Line::NONE; 2]);
/// assert_eq!(links_by_strain(&system.state(&scene), rope.into_iter(), 0.1, &mut lines), (2, 0));
/// assert_eq!(lines[0].colors, [strained(1.0); 2]); // It is longer by a tenth: all red.
/// assert!(lines[1].colors[0].into_iter().zip(strained(-0.5)).all(|(a, b)| a.abs_diff(b) < 2));
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn links_by_strain(
    state: &State<'_>,
    pairs: impl Iterator<Item = ([u32; 2], f32)>,
    full: f32,
    into: &mut [Line],
) -> (usize, usize) {
    let row = |number: u32| state.springs.row(number);
    let line = |rows, rest| by_strain(ends(state, rows), rest, full);
    fill(pairs.filter_map(|([a, b], rest)| Some(line([row(a)?, row(b)?], rest))), into)
}

/// The colour of a share of the full strain, −1 to 1: red where longer than at rest, blue where shorter, grey between.
#[must_use]
pub fn strained(share: f32) -> Color {
    let share = clamp(share, -1.0, 1.0);
    let (end, share) = if share < 0.0 { (SHORT, -share) } else { (LONG, share) };
    core::array::from_fn(|i| (f32::from(SLACK[i]) + (f32::from(end[i]) - f32::from(SLACK[i])) * share + 0.5) as u8)
}

/// Writes the ways that particles would go on in so many seconds, in the order of rows and in their colours, as far as there is room;
/// returns their number and how many were left out. They fade toward their ends.
pub fn velocities(state: &State<'_>, seconds: f32, into: &mut [Line]) -> (usize, usize) {
    let mut looks = Looks::of(state);
    let line = |row: usize| {
        let (from, way) = (state.position[row], state.velocity[row] * seconds);
        let color = looks.color(row).unwrap_or(WHITE);
        let [red, green, blue, alpha] = color;
        Line { ends: [from, from + way], widths: [0.0; 2], colors: [color, [red, green, blue, alpha / 4]] }
    };
    fill((0..state.position.len()).map(line), into)
}

/// The twelve edges of a box: of a cell of an index, or of what a collider reaches.
#[must_use]
pub fn edges(bounds: &Aabb, color: Color) -> [Line; 12] {
    let corner = |i: usize| {
        let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
        let Aabb { min, max } = *bounds;
        Vec3::new(pick(1, min.x, max.x), pick(2, min.y, max.y), pick(4, min.z, max.z))
    };
    // Along each axis, from each corner of the face where it is least.
    core::array::from_fn(|i| {
        let (axis, face) = (i / 4, i % 4);
        let low = (1 << axis) - 1;
        let from = face & low | (face & !low) << 1;
        Line::plain([corner(from), corner(from | 1 << axis)], color)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_each_of_its_edges_once() {
        let bounds = Aabb { min: Vec3::new(-1.0, 2.0, 3.0), max: Vec3::new(4.0, 8.0, 10.0) };
        let lines = edges(&bounds, WHITE);
        let total: f32 = lines.iter().map(|line| length(line.ends[1] - line.ends[0])).sum();
        assert_eq!(total, 4.0 * (5.0 + 6.0 + 7.0));
        let middles: std::collections::BTreeSet<_> =
            lines.iter().map(|line| ((line.ends[0] + line.ends[1]) * 2.0).to_array().map(|x| x as i32)).collect();
        assert_eq!(middles.len(), 12);
    }

    #[test]
    fn strain_has_its_color() {
        assert_eq!([-9.0, 0.0, 2.0, f32::NAN].map(strained).map(|color| color[3]), [255; 4]);
        assert_eq!([-9.0, -1.0, 0.0, 1.0, 2.0].map(strained), [SHORT, SHORT, SLACK, LONG, LONG]);
    }
}
