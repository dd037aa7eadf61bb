//! What is known of sheets at rest: where their particles were, how thick they are, and their triangles in an order in which near ones
//! follow each other.

use super::super::Bodies;
pub(super) use super::super::union::{root, unite};
use crate::math::{length, max, min};
use crate::memory::take;
use glam::Vec3;

/// Triangles that share a box.
pub(super) const BLOCK: usize = 4;

/// A triangle. Each particle and each edge counts as one triangle's own, so that no two meet twice.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Face {
    pub(super) corners: [u32; 3],
    /// A bit for each corner that is its own, then one for each edge, from that corner to the next.
    owns: u32,
}

impl Face {
    pub(super) fn owns_corner(&self, i: usize) -> bool {
        self.owns >> i & 1 != 0
    }

    pub(super) fn owns_edge(&self, i: usize) -> bool {
        self.owns >> (3 + i) & 1 != 0
    }

    pub(super) fn edge(&self, i: usize) -> [u32; 2] {
        let [a, b, c] = self.corners;
        match i {
            0 => [a, b],
            1 => [b, c],
            _ => [c, a],
        }
    }
}

/// An edge of a sheet.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    /// The square of its length at rest \[m²\].
    pub(super) least: f32,
}

/// Facts about all of them.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Facts {
    /// The name of whose all that is.
    name: u32,
    /// If the rest is known, 1 and how many particles were gone when it was last said whose own corners and edges are.
    known: u32,
    /// How far particles may be pushed before it has to be looked again who is near whom \[m\].
    pub(super) budget: f32,
}

/// The sheets at rest.
pub(super) struct Rest<'m> {
    pub(super) facts: &'m mut Facts,
    /// Where particles are.
    pub(super) places: &'m mut [Vec3],
    /// Half the thickness at each \[m\].
    pub(super) half: &'m mut [f32],
    /// The first particle of the sheet to which each belongs.
    pub(super) sheet: &'m mut [u32],
    pub(super) faces: &'m mut [Face],
}

/// The words of facts, of a particle, and of a triangle.
pub(super) const KEPT: [usize; 3] = [size_of::<Facts>() / 4, 5, size_of::<Face>() / 4];
/// The words of a particle and a triangle that it takes to learn.
pub(super) const LEARNING: [usize; 2] = [1, 9];

impl<'m> Rest<'m> {
    /// None: the memory is too small.
    pub(super) fn of(kept: &'m mut [u32], [particles, triangles]: [usize; 2]) -> Option<Self> {
        let mut rest = kept;
        let facts = bytemuck::cast_slice_mut(take(&mut rest, KEPT[0])).first_mut()?;
        let places = crate::memory::take_vectors(&mut rest, particles);
        let half = bytemuck::cast_slice_mut(take(&mut rest, particles));
        let sheet = take(&mut rest, particles);
        let faces = bytemuck::cast_slice_mut(rest.get_mut(..triangles * KEPT[2])?);
        Some(Self { facts, places, half, sheet, faces })
    }

    /// The half thickness at all particles, if they are of one sheet, and it is the same at all.
    pub(super) fn uniform(&self) -> Option<f32> {
        let (&half, &sheet) = (self.half.first()?, self.sheet.first()?);
        let alike = self.half.iter().all(|&other| other == half) && self.sheet.iter().all(|&other| other == sheet);
        alike.then_some(half)
    }

    /// Tells whether it has been learnt.
    pub(super) fn is_known(&self) -> bool {
        self.facts.known != 0
    }

    /// Half the thickness of a triangle where it is thickest.
    pub(super) fn widest(&self, face: &Face) -> f32 {
        let half = |corner: u32| self.half.get(corner as usize).copied().unwrap_or(0.0);
        face.corners.iter().fold(0.0, |most, &corner| max(half(corner), most))
    }

    /// Takes all that from where the particles are; of thicknesses the last holds for all further triangles.
    pub(super) fn learn(
        &mut self,
        particles: &[u32],
        triangles: &[[u32; 3]],
        thickness: &[f32],
        bodies: &Bodies<'_>,
        scratch: &mut [u32],
    ) {
        for (place, &number) in self.places.iter_mut().zip(particles) {
            *place = bodies.row_of_start(number).map_or(Vec3::NAN, |row| bodies.position[row]);
        }
        self.half.fill(0.0);
        let mut thinnest = f32::INFINITY;
        for (i, (face, &corners)) in self.faces.iter_mut().zip(triangles).enumerate() {
            *face = Face { corners, owns: 0 };
            let thickness = thickness.get(i).or(thickness.last()).copied().unwrap_or(0.0);
            thinnest = min(thickness, thinnest);
            for corner in corners {
                if let Some(half) = self.half.get_mut(corner as usize) {
                    *half = max(0.5 * thickness, *half);
                }
            }
        }
        self.part();
        self.sort();
        let known = 1 + gone(particles, bodies);
        let edge = self.give(particles, bodies, scratch);
        *self.facts = Facts { known, name: self.facts.name, budget: 0.25 * min(thinnest, edge) };
    }

    /// Gives corners and edges of triangles whose others have died since to those that are left, so that the rims of a tear are somebody's own; tells
    /// whether some have died.
    pub(super) fn bury(&mut self, particles: &[u32], bodies: &Bodies<'_>, scratch: &mut [u32]) -> bool {
        let known = 1 + gone(particles, bodies);
        if self.facts.known == known {
            return false;
        }
        self.facts.known = known;
        self.give(particles, bodies, scratch);
        true
    }

    /// Gives corners and edges to triangles all of whose particles are there. Returns the mean length of all edges \[m\].
    fn give(&mut self, particles: &[u32], bodies: &Bodies<'_>, scratch: &mut [u32]) -> f32 {
        let is_there = |i: usize| particles.get(i).is_some_and(|&number| bodies.row_of_start(number).is_some());
        self.own(is_there, scratch)
    }

    /// Finds the sheets: what hangs together.
    fn part(&mut self) {
        for (i, sheet) in self.sheet.iter_mut().enumerate() {
            *sheet = i as u32;
        }
        let there = self.sheet.len() as u32;
        for &Face { corners: [a, b, c], .. } in self.faces.iter().filter(|face| face.corners.iter().all(|&i| i < there))
        {
            unite(self.sheet, a, b);
            unite(self.sheet, a, c);
        }
        for i in 0..there {
            self.sheet[i as usize] = root(self.sheet, i);
        }
    }

    fn center(places: &[Vec3], face: &Face) -> Vec3 {
        face.corners
            .iter()
            .fold(Vec3::ZERO, |sum, &corner| sum + places.get(corner as usize).copied().unwrap_or(Vec3::NAN))
    }

    /// Halves the triangles across the longest side of the box around their middles, and the halves, down to blocks.
    fn sort(&mut self) {
        let Self { places, faces, .. } = self;
        let blocks = faces.len().div_ceil(BLOCK).next_power_of_two();
        let mut open = [[0; 2]; usize::BITS as usize];
        let (mut count, all) = (1, faces.len());
        open[0] = [0, blocks];
        while count > 0 {
            count -= 1;
            let [first, len] = open[count];
            let [low, middle, high] = [first, first + len / 2, first + len].map(|block| (block * BLOCK).min(all));
            if len == 1 {
                faces[low..high].sort_unstable_by_key(|face| face.corners);
                continue;
            }
            if middle < high {
                halve(&mut faces[low..high], middle - low, |face| Self::center(places, face));
                open[count] = [first + len / 2, len / 2];
                count += 1;
            }
            open[count] = [first, len / 2];
            count += 1;
        }
    }

    /// Says whose own corners and edges are: of triangles all of whose corners are there, where there are any; returns the mean length of all edges.
    fn own(&mut self, is_there: impl Fn(usize) -> bool, scratch: &mut [u32]) -> f32 {
        let Self { places, faces, .. } = self;
        let mut rest = scratch;
        let taken = take(&mut rest, places.len());
        for (i, taken) in taken.iter_mut().enumerate() {
            *taken = if is_there(i) { FREE } else { GONE };
        }
        let edges: &mut [[u32; 3]] = bytemuck::cast_slice_mut(take(&mut rest, 9 * faces.len()));
        for (number, face) in faces.iter_mut().enumerate() {
            face.owns = 0;
            let is_torn = !face.corners.iter().all(|&i| taken.get(i as usize).is_some_and(|&state| state != GONE));
            for i in 0..3 {
                let ([a, b], last) = (face.edge(i), if is_torn { TORN } else { 0 });
                if let Some(edge) = edges.get_mut(3 * number + i) {
                    *edge = [a.min(b), a.max(b), last | (3 * number + i) as u32];
                }
                if let Some(taken) = taken.get_mut(a as usize).filter(|taken| **taken == FREE && !is_torn) {
                    *taken = TAKEN;
                    face.owns |= 1 << i;
                }
            }
        }
        edges.sort_unstable();
        let (mut sum, mut count, mut last) = (0.0, 0.0, [u32::MAX; 2]);
        for &[a, b, number] in &*edges {
            if [a, b] == last || a == b {
                continue;
            }
            last = [a, b];
            let number = number & !TORN;
            faces[number as usize / 3].owns |= 8 << (number % 3);
            let [from, to] = last.map(|end| places.get(end as usize).copied().unwrap_or(Vec3::NAN));
            let long = length(to - from);
            if long < f32::INFINITY {
                sum += long;
                count += 1.0;
            }
        }
        sum / max(count, 1.0)
    }
}

/// The state of a corner: it is nobody's own yet, somebody's, or not there.
const FREE: u32 = 0;
const TAKEN: u32 = 1;
const GONE: u32 = 2;
/// The bit that says of an edge's number that its triangle has lost a corner: so it comes after those of others.
const TORN: u32 = 1 << 31;

/// The number of particles that are not there.
fn gone(particles: &[u32], bodies: &Bodies<'_>) -> u32 {
    particles.iter().filter(|&&number| bodies.row_of_start(number).is_none()).count() as u32
}

/// Puts the `middle` triangles first that lie lowest along the longest side of the box around the middles of all.
fn halve(faces: &mut [Face], middle: usize, center: impl Fn(&Face) -> Vec3) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for face in &*faces {
        let place = center(face);
        (low, high) = (crate::math::low(place, low), crate::math::high(place, high));
    }
    let [x, y, z] = (high - low).to_array();
    let axis = if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    };
    let along = |face: &Face| center(face).to_array()[axis];
    faces.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)).then(a.corners.cmp(&b.corners)));
}
