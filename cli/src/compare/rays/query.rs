//! The segments that are held against a mesh.

use super::super::distribution::direction;
use super::super::workload::Workload;
use super::surface::Surface;
use pointmass::Vec3;
use pointmass::rng::Stream;
use pointmass::shape::{Segment, Surface as _};

/// The length of a short step, as a part of the mesh's diagonal.
const STEP: f32 = 0.01;
/// The radius of a ball likewise, if nobody says.
const BALL: f32 = 0.001;

/// Segments of one kind.
#[derive(Clone, Debug)]
pub struct Query {
    /// Which: one of [`Workload::OF_MESHES`].
    pub workload: Workload,
    /// The segments, in the order in which they are asked.
    pub segments: Vec<Segment>,
    /// Their ends, for those who know no segments of ours.
    pub(super) ends: Vec<[[f32; 3]; 2]>,
}

impl Query {
    /// So many segments of every kind; balls have a radius of a thousandth of the mesh's diagonal if nobody says.
    #[must_use]
    pub fn all(surface: &Surface, n: usize, radius: Option<f32>, seed: u64) -> Vec<Self> {
        let radius = ball(surface, radius);
        let short: Vec<_> = (0..n as u32).map(|serial| short(surface, serial, seed)).collect();
        let long = (0..n as u32).map(|serial| long(surface, serial, seed)).collect();
        let balls = short.iter().map(|segment| Segment { radius, ..*segment }).collect();
        let sorted = sorted(&short);
        Workload::OF_MESHES
            .into_iter()
            .zip([short, sorted, long, balls])
            .map(|(kind, all)| Self::new(kind, all))
            .collect()
    }

    fn new(workload: Workload, segments: Vec<Segment>) -> Self {
        Self {
            workload,
            ends: segments.iter().map(|segment| [segment.from.to_array(), segment.to.to_array()]).collect(),
            segments,
        }
    }
}

/// The radius of balls \[m\].
pub(super) fn ball(surface: &Surface, wanted: Option<f32>) -> f32 {
    wanted.unwrap_or(BALL * surface.size)
}

/// Apart from the streams of points and of each other.
fn stream(kind: u32, serial: u32, seed: u64) -> Stream {
    Stream::new(seed, (1 << 19) + kind, serial)
}

/// A step from a place within a step of the surface, evenly in the ball of places, in any direction.
fn short(surface: &Surface, serial: u32, seed: u64) -> Segment {
    let stream = stream(0, serial, seed);
    let ([a, b], [c, part]) = (stream.units(0), stream.units(1));
    let step = STEP * surface.size;
    let from = surface.mesh.sample([a, b, c]).point + direction(stream.units(2)) * (step * part.cbrt());
    Segment::new(from, from + direction(stream.units(3)) * step)
}

/// From one place of the sphere around the mesh's box to another.
fn long(surface: &Surface, serial: u32, seed: u64) -> Segment {
    let stream = stream(1, serial, seed);
    let bounds = surface.mesh.bounds();
    let [from, to] = [0, 1].map(|end| bounds.center() + direction(stream.units(end)) * (0.5 * surface.size));
    Segment::new(from, to)
}

/// In the order of a Morton curve through their beginnings (Morton 1966).
fn sorted(segments: &[Segment]) -> Vec<Segment> {
    let ends = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = segments.iter().fold(ends, |(low, high), one| (low.min(one.from), high.max(one.from)));
    /// The range of each coordinate.
    const DIGITS: u32 = 20;
    let scale = ((1u32 << DIGITS) - 1) as f32 / (high - low).max_element().max(f32::MIN_POSITIVE);
    let code = |segment: &Segment| {
        let cell = ((segment.from - low) * scale).to_array().map(|x| x as u64);
        let spread = |x: u64| (0..DIGITS).fold(0, |code, digit| code | (x >> digit & 1) << (3 * digit));
        spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
    };
    let mut segments = segments.to_vec();
    segments.sort_by_cached_key(code);
    segments
}
