//! The solids that closed triangle meshes enclose: what lies inside an odd number of their shells.

use super::{MeshBuf, Surface};
use crate::math::{largest, length};
use alloc::vec::Vec;
use core::fmt;
use glam::Vec3;

/// A place \[m\], in double precision.
pub(crate) type Place = [f64; 3];

/// Why a mesh encloses no solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotSolid {
    /// A triangle is missing at the edge between these places \[m\].
    Open([Vec3; 2]),
    /// Two triangles run along the edge between these places the same way \[m\].
    Turned([Vec3; 2]),
    /// Two of its shells pass through each other, of which one has its first corner here \[m\].
    Crossing(Vec3),
    /// It encloses nothing.
    Empty,
}

impl fmt::Display for NotSolid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([from, to], what) = match self {
            Self::Open(edge) => (edge, "a triangle is missing there: close it"),
            Self::Turned(edge) => (edge, "both of its triangles run along it the same way: turn them alike"),
            Self::Crossing(place) => {
                return write!(f, "has shells that pass through each other, one of them from {place}: unite them");
            }
            Self::Empty => return f.write_str("is a mesh that encloses nothing"),
        };
        let [from, to] = [from, to].map(Vec3::to_array);
        write!(f, "is no closed mesh: at its edge from {from:?} to {to:?} {what}")
    }
}

impl core::error::Error for NotSolid {}

/// What a closed mesh encloses.
pub(crate) struct Enclosed {
    /// Where places of it are told from \[m\]: a corner, so that what lies far from the world's origin loses nothing.
    pub(crate) origin: Vec3,
    /// Its triangles, all of them anticlockwise as seen from outside.
    pub(crate) triangles: Vec<[Place; 3]>,
    /// Its volume \[m³\].
    pub(crate) volume: f64,
}

/// An edge of a triangle: its ends, the lower first, whether the triangle runs along it to the lower, and which it is.
type Side = ([[u32; 3]; 2], bool, u32);

impl Enclosed {
    /// The solid in a mesh, whichever side its triangles are seen from: of shells in each other every second one is a cavity. Corners in one place
    /// are one.
    pub(crate) fn of(mesh: &MeshBuf) -> Result<Self, NotSolid> {
        let vertices = mesh.vertices();
        let origin = vertices.first().copied().unwrap_or_default();
        let shells = shells(mesh)?;
        let mut triangles = Vec::with_capacity(mesh.triangles().len());
        let mut volume = 0.0;
        let way = |corner: u32| (vertices[corner as usize] - origin).to_array().map(f64::from);
        for (number, shell) in shells.iter().enumerate() {
            let faces = || shell.iter().map(|corners| corners.map(way));
            let six: f64 = faces().map(|[a, b, c]| dot(a, cross(b, c))).sum();
            let is_cavity = depth(vertices, &shells, number)? % 2 == 1;
            let size = if six < 0.0 { six / -6.0 } else { six / 6.0 };
            volume += if is_cavity { -size } else { size };
            let is_turned = (six < 0.0) != is_cavity;
            triangles.extend(faces().map(|[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] }));
        }
        if volume > 0.0 { Ok(Self { origin, triangles, volume }) } else { Err(NotSolid::Empty) }
    }
}

/// The triangles of a closed mesh, shell by shell: those that hang together by edges of two.
fn shells(mesh: &MeshBuf) -> Result<Vec<Vec<[u32; 3]>>, NotSolid> {
    let vertices = mesh.vertices();
    // Both zeros are one place.
    let place = |corner: u32| vertices[corner as usize].to_array().map(|x| (x + 0.0).to_bits());
    let mut sides: Vec<Side> = Vec::with_capacity(3 * mesh.triangles().len());
    for (number, &[a, b, c]) in (0..).zip(mesh.triangles()) {
        for [from, to] in [[a, b], [b, c], [c, a]].map(|edge| edge.map(place)) {
            if from != to {
                sides.push(([from.min(to), from.max(to)], from > to, number));
            }
        }
    }
    sides.sort_unstable();
    let mut shell: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    for edge in sides.chunk_by(|a, b| a.0 == b.0) {
        let back = edge.iter().filter(|side| side.1).count();
        let ends = edge[0].0.map(|end| Vec3::from_array(end.map(f32::from_bits)));
        if 2 * back != edge.len() {
            return Err(if edge.len() % 2 == 0 { NotSolid::Turned(ends) } else { NotSolid::Open(ends) });
        }
        if let [one, other] = edge {
            let [a, b] = [one.2, other.2].map(|number| root(&mut shell, number));
            shell[a.max(b) as usize] = a.min(b);
        }
    }
    // Where more meet, all belong together unless each shell there is closed by itself.
    for edge in sides.chunk_by(|a, b| a.0 == b.0).filter(|edge| edge.len() > 2) {
        let mut is_open = |side: &Side| {
            let own = root(&mut shell, side.2);
            let ways = edge.iter().filter(|other| root(&mut shell, other.2) == own).map(|other| other.1);
            let (back, all) = ways.fold((0, 0), |(back, all), is_back| (back + usize::from(is_back), all + 1));
            2 * back != all
        };
        if edge.iter().any(&mut is_open) {
            for side in edge {
                let [a, b] = [edge[0].2, side.2].map(|number| root(&mut shell, number));
                shell[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut shells: Vec<Vec<[u32; 3]>> = Vec::new();
    let mut places = alloc::collections::BTreeMap::new();
    for (number, &corners) in (0..).zip(mesh.triangles()) {
        let place = *places.entry(root(&mut shell, number)).or_insert(shells.len());
        if place == shells.len() {
            shells.push(Vec::new());
        }
        shells[place].push(corners);
    }
    Ok(shells)
}

/// The triangle that stands for all that a triangle hangs together with.
fn root(shell: &mut [u32], number: u32) -> u32 {
    let mut at = number;
    while shell[at as usize] != at {
        shell[at as usize] = shell[shell[at as usize] as usize];
        at = shell[at as usize];
    }
    at
}

/// As many triangles of a shell are held against another at the most.
const SAMPLES: usize = 64;
/// How near to a shell what touches it lies, as a share of its size.
const TOUCHING: f32 = 1e-5;

/// In how many of the other shells one lies.
fn depth(vertices: &[Vec3], shells: &[Vec<[u32; 3]>], number: usize) -> Result<usize, NotSolid> {
    let corner = |triangle: &[u32; 3], i: usize| vertices[triangle[i] as usize];
    let own = &shells[number];
    let mut depth = 0;
    for other in shells.iter().enumerate().filter(|&(i, _)| i != number).map(|(_, shell)| shell) {
        let Ok(mesh) = MeshBuf::new(vertices.to_vec(), other.clone()) else { continue };
        let corners = || other.iter().flat_map(|triangle| (0..3).map(move |i| corner(triangle, i)));
        let low = corners().fold(Vec3::INFINITY, crate::math::low);
        let high = corners().fold(Vec3::NEG_INFINITY, crate::math::high);
        let size = largest(high - low);
        let samples = own.iter().step_by(own.len().div_ceil(SAMPLES));
        let middles = samples.map(|triangle| (0..3).map(|i| corner(triangle, i) / 3.0).sum::<Vec3>());
        // What touches it says nothing of where the rest is.
        let (mut inside, mut all) = (0, 0);
        for middle in middles {
            let is_in_box = middle.cmpge(low).all() && middle.cmple(high).all();
            if is_in_box && length(mesh.nearest(middle) - middle) <= TOUCHING * size {
                continue;
            }
            all += 1;
            inside += usize::from(is_in_box && mesh.is_inside(middle));
        }
        if inside != 0 && inside != all {
            return Err(NotSolid::Crossing(corner(&own[0], 0)));
        }
        depth += usize::from(inside > 0);
    }
    Ok(depth)
}

pub(crate) fn dot([a, b, c]: Place, [x, y, z]: Place) -> f64 {
    a * x + b * y + c * z
}

pub(crate) fn cross([a, b, c]: Place, [x, y, z]: Place) -> Place {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

pub(crate) fn minus(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A place so far on the way from one to another.
pub(crate) fn between(from: Place, to: Place, share: f64) -> Place {
    core::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

/// The moments of what closed triangles enclose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    /// The volume \[m³\].
    pub(crate) volume: f64,
    /// The centroid \[m\].
    pub(crate) centroid: Place,
    /// ∫ x xᵀ over the volume, about the centroid \[m²\].
    pub(crate) spread: [Place; 3],
}

impl Moments {
    /// Those of closed triangles, by the tetrahedra between them and the origin (Mirtich, "Fast and Accurate Computation of Polyhedral Mass
    /// Properties", J. Graphics Tools 1, 1996; Tonon, "Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor", J. Math. Stat. 1, 2005).
    pub(crate) fn of(triangles: impl Iterator<Item = [Place; 3]>) -> Self {
        let (mut six, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        for [a, b, c] in triangles {
            let volume = dot(a, cross(b, c));
            let sum: Place = core::array::from_fn(|i| a[i] + b[i] + c[i]);
            six += volume;
            for i in 0..3 {
                first[i] += volume * sum[i];
                for j in 0..3 {
                    second[i][j] += volume * (sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
                }
            }
        }
        let centroid = first.map(|x| x * 0.25 / six);
        let spread =
            core::array::from_fn(|i| core::array::from_fn(|j| second[i][j] * 0.05 / six - centroid[i] * centroid[j]));
        Self { volume: six / 6.0, centroid, spread }
    }
}
