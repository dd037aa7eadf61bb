//! Strands as thin lit curves.

use super::{Line, Looks, fill};
use crate::force::State;
use crate::math::{dot, max, min, sqrt, unit};
use crate::particles::{Color, WHITE};
use glam::Vec3;

/// Strands of equally many points each, which are particles of the scene's start one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lock {
    /// The first of its particles, by its place in the scene's start.
    pub first: u32,
    /// The points of each strand.
    pub points: u32,
    /// The number of strands.
    pub count: u32,
    /// How wide they are drawn \[m\]; zero: about a pixel.
    pub width: f32,
}

/// The light on strands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandLight {
    /// The direction in which it shines.
    pub direction: Vec3,
    /// Where the eye is \[m\].
    pub eye: Vec3,
    /// The share of their colour that they have where it does not shine on them, from 0 to 1.
    pub ambient: f32,
    /// How bright they gleam, from 0 to 1.
    pub gloss: f32,
}

impl StrandLight {
    /// A colour as a strand in a direction has it in this light: a thin cylinder is bright where the light falls across it, and gleams
    /// toward all eyes on a cone about it (Kajiya and Kay, "Rendering fur with three dimensional textures", SIGGRAPH 1989, with an
    /// exponent of 32).
    #[must_use]
    pub fn shade(&self, color: Color, place: Vec3, along: Vec3) -> Color {
        let [t, l, e] = [unit(along), -unit(self.direction), unit(self.eye - place)];
        let sine = |cosine: f32| sqrt(max(1.0 - cosine * cosine, 0.0));
        let [a, b] = [dot(t, l), dot(t, e)];
        let diffuse = self.ambient + (1.0 - self.ambient) * sine(a);
        // The light goes on beyond the strand.
        let mut gleam = max(sine(a) * sine(b) - a * b, 0.0);
        for _ in 0..5 {
            gleam *= gleam;
        }
        let [red, green, blue, opacity] = color;
        // The casts saturate.
        let lit = |channel: u8| (min(f32::from(channel) * diffuse + 255.0 * self.gloss * gleam, 255.0) + 0.5) as u8;
        [lit(red), lit(green), lit(blue), opacity]
    }
}

/// Writes the segments of strands as lines, strand by strand and each from its root to its tip, as far as both ends live and there is
/// room, in the colours of their particles and in a light. Returns their number and how many were left out.
///
/// ```
/// use pointmass::draw::{Line, Lock, StrandLight, strands};
/// use pointmass::{Heap, Particle, Scene, System, Vec3};
///
/// let start = [0.0, 1.0, 2.0].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let lock = Lock { first: 0, points: 3, count: 1, width: 1e-3 };
/// let light = StrandLight { direction: Vec3::NEG_Y, eye: Vec3::Z * 9.0, ambient: 0.3, gloss: 0.0 };
/// let mut lines = [Line::NONE; 2];
/// assert_eq!(strands(&system.state(&scene), &lock, &light, &mut lines), (2, 0));
/// assert!(lines[1].ends == [Vec3::X, Vec3::X * 2.0] && lines[1].colors[0] == [255; 4]); // The light falls across it.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub fn strands(state: &State<'_>, lock: &Lock, light: &StrandLight, into: &mut [Line]) -> (usize, usize) {
    let segments = lock.points.saturating_sub(1);
    // Nobody is there beyond the start.
    let (count, start) = (if segments > 0 { lock.count } else { 0 }, state.springs.start);
    let bases = (0..count).map_while(|strand| lock.first.checked_add(strand.checked_mul(lock.points)?));
    let bases = bases.take_while(|&base| base < start);
    let numbers = bases.flat_map(|base| (0..segments.min(start - base)).map(move |i| (base, i)));
    let mut looks = Looks::of(state);
    let line = |(base, i): (u32, u32)| {
        let row = |i: u32| state.springs.row(base.checked_add(i)?);
        let rows = [row(i)?, row(i + 1)?];
        // At each end the direction is that from neighbour to neighbour.
        let beside = [i.checked_sub(1).and_then(row), Some(i + 2).filter(|&i| i < lock.points).and_then(row)];
        let place = |row: usize| state.position[row];
        let ways = [
            place(rows[1]) - beside[0].map_or(place(rows[0]), place),
            beside[1].map_or(place(rows[1]), place) - place(rows[0]),
        ];
        let mut color = |end: usize| {
            let plain = looks.color(rows[end]).unwrap_or(WHITE);
            light.shade(plain, place(rows[end]), ways[end])
        };
        Some(Line { ends: rows.map(place), widths: [lock.width; 2], colors: [color(0), color(1)] })
    };
    fill(numbers.filter_map(line), into)
}
