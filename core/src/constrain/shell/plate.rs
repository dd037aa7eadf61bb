//! The matrix of bending: of a shell that hardly stretches it is always the same, and one number for each two particles.

use super::ShellParams;
use super::fold::RestFold;
use super::membrane::Cell;
use super::mesh::{Graph, Room, link, sorted};
use super::strips::{self, Place, Strips};
use crate::cloth::Hinge;
use crate::lanes::{Eight, LANES, Vectors};
use crate::math::{max, min, sqrt};
use crate::memory::take;

/// Hinges of a triangle, and corners that they have together, at the most.
const SIDES: usize = 3;
const PATCH: usize = 4 * SIDES;
/// Triangles before another that are asked whether it is the same.
const ASKED: usize = 64;
/// The most that a thin shell resists bending, in its triangles, as a share of stretching.
const THIN: f32 = 0.05;
/// A particle is there, or it is not. Nothing is known of it before that is set.
const THERE: u32 = 1;
const GONE: u32 = 2;

/// How particles hold each other by bending, where bending stiffness is one: ½ xᵀ K x is the energy of positions x, for each coordinate by itself.
///
/// Folds change by the ways of four corners along normals. Of a sheet that bends and hardly stretches, how these ways count is what it is at
/// rest, and all that changes is where normals point: taken for all directions alike (Bergou et al., "A quadratic bending model for inextensible
/// surfaces", SGP 2006; here for the energy of triangles) the matrix never changes. What sharp folds do besides is added along edges: see
/// `assemble`.
///
/// Edges get a part of it that alone is as stiff as K where the mesh folds to and fro, so that sweeps through it know of bending and go no
/// farther than edges do.
#[derive(Default)]
pub(super) struct Plate<'m> {
    /// A word for each particle: it is there in the matrix, or not.
    roll: &'m mut [u32],
    /// The largest of the squares of the curvatures that a radian makes \[1/m²\] and of how slender their triangles are.
    steepest: &'m mut [f32],
    /// What edges do to particles by their places in strips, and along the links of the finest graph.
    pub(super) own: &'m mut [f32],
    pub(super) near: &'m mut [[f32; LANES]],
    /// The rest: who bends with each, and numbers.
    links: Strips<'m>,
    numbers: &'m mut [[f32; LANES]],
}

/// A shell at rest.
pub(super) struct Shape<'s> {
    pub(super) triangles: &'s [[u32; 3]],
    pub(super) cells: &'s [Cell],
    pub(super) hinges: &'s [Hinge],
    pub(super) bends: &'s [RestFold],
}

/// Words that a matrix is kept in.
pub(super) fn words(room: &Room) -> usize {
    let [rows, _] = room.rows;
    let padded = LANES * rows.div_ceil(LANES);
    let near = strips::entries(rows, room.links[0]).saturating_mul(LANES);
    let numbers = entries(room).saturating_mul(LANES);
    let own = padded.saturating_add(rows + 1);
    if rows == 0 { 0 } else { own.saturating_add(near).saturating_add(pattern(room)).saturating_add(numbers) }
}

/// Entries of those that bend together.
fn entries(room: &Room) -> usize {
    strips::entries(room.rows[0], room.far)
}

/// Words to find that with.
pub(super) fn scratch(room: &Room, [_, triangles, hinges]: [usize; 3]) -> usize {
    let [rows, _] = room.rows;
    let corners = hinges.saturating_mul(10).saturating_add(triangles).saturating_add(2 * rows);
    if rows == 0 { 0 } else { corners.saturating_add(room.far).saturating_add(strips::KEYS + 5) }
}

/// Words that say who bends together.
pub(super) fn pattern(room: &Room) -> usize {
    strips::words(room.rows[0], entries(room))
}

impl<'m> Plate<'m> {
    pub(super) fn of(room: &Room, words: &'m mut [u32]) -> Self {
        let ([rows, _], mut rest) = (room.rows, words);
        if rows == 0 {
            return Self::default();
        }
        let links = Strips::of(rows, entries(room), take(&mut rest, pattern(room)));
        let roll = take(&mut rest, rows);
        let padded = LANES * rows.div_ceil(LANES);
        let [steepest, own] = [1, padded].map(|len| bytemuck::cast_slice_mut(take(&mut rest, len)));
        let lanes = [strips::entries(rows, room.links[0]), entries(room)].map(|entries| entries.saturating_mul(LANES));
        let [near, numbers] = lanes.map(|len| bytemuck::cast_slice_mut(take(&mut rest, len)));
        Self { roll, steepest, own, near, links, numbers }
    }

    /// Bends the rows of a strip, `own` being their places: tells so many times what that does to them beyond what is in blocks, and takes what it does
    /// to others from the sums there.
    #[inline(always)]
    pub(super) fn bend<F: Eight>(
        &self,
        like: F,
        (x, sums): ([&[f32]; 3], &mut [&mut [f32]; 3]),
        strip: usize,
        own: Vectors<F>,
        bending: F,
    ) -> Vectors<F> {
        let mut sum = Vectors([like.all(0.0); 3]);
        for (entry, numbers) in self.links.each(self.links.range(strip), self.numbers) {
            let parts = (entry.vectors(like, x) - own) * (like.of(*numbers) * bending);
            sum = sum + parts;
            entry.take_from(like, sums, parts);
        }
        for (entry, numbers) in self.links.each(self.links.mixed(strip), self.numbers) {
            let ways = entry.vectors(like, x) - entry.owners().lent(like, own);
            let parts = ways * (like.of(*numbers) * bending);
            sum = entry.owners().add(like, sum, parts);
            entry.take_from(like, sums, parts);
        }
        sum
    }

    /// Tells whether a shell resists bending so much less than stretching that its triangles stay what they are at rest; what is slender is soon
    /// another.
    pub(super) fn is_thin(&self, params: &ShellParams) -> bool {
        let [warp, weft] = params.stretch;
        let steepest = self.steepest.first().copied().unwrap_or(f32::INFINITY);
        params.bending * steepest <= THIN * min(min(warp, weft), params.shear)
    }

    /// Makes the matrix, if other particles are there than when it was made: of each is said whether it is.
    pub(super) fn update(
        &mut self,
        graph: &Graph<'_>,
        edges: &Strips<'_>,
        shape: &Shape<'_>,
        particles: impl Iterator<Item = bool>,
        work: &mut [u32],
    ) {
        let mut same = true;
        for (was, is) in self.roll.iter_mut().zip(particles) {
            let is = if is { THERE } else { GONE };
            same &= core::mem::replace(was, is) == is;
        }
        if same || graph.rows() == 0 {
            return;
        }
        self.clear();
        let Some((first, hinges)) = shape.by_face(work) else { return };
        for (face, cell) in shape.cells.iter().enumerate() {
            let (Some(&from), Some(&to)) = (first.get(face), first.get(face + 1)) else { return };
            let mut patch = Patch::default();
            let slender = cell.slenderness();
            for &hinge in hinges.get(from as usize..to as usize).unwrap_or(&[]) {
                let steep = shape.bends.get(hinge as usize).map_or(0.0, RestFold::steepness);
                self.steepest[0] = max(steep * (slender * slender), self.steepest[0]);
                patch.take(shape, self.roll, face as u32, hinge as usize);
            }
            self.add(&patch, cell.area);
        }
        self.part(graph, edges);
        let all = self.own.iter().chain(self.near.as_flattened());
        if !all.chain(self.numbers.as_flattened()).all(|number| number.is_finite()) {
            // Which bits a NaN has depends on the machine, and these words are in the hash.
            self.clear();
            self.steepest[0] = f32::INFINITY;
        }
    }

    fn clear(&mut self) {
        for numbers in [&mut *self.own, self.near.as_flattened_mut(), self.numbers.as_flattened_mut()] {
            numbers.fill(0.0);
        }
        self.steepest[0] = 0.0;
    }

    /// Adds how the corners of a triangle's hinges hold each other.
    fn add(&mut self, patch: &Patch, area: f32) {
        let corners = || patch.corners.iter().zip(&patch.weights).take(patch.count);
        for (&row, [a, b, c]) in corners() {
            for (&other, [d, e, f]) in corners().filter(|&(&other, _)| other != row) {
                let number = area * (a * d + b * e + c * f);
                // So nothing comes of it where all go the same way.
                let slot = self.links.slot(row as usize);
                self.own[slot] -= number;
                if let Some(Place { entry, lane, back: false }) = self.links.place(row as usize, other) {
                    self.numbers[entry][lane] += number;
                }
            }
        }
    }

    /// Gives edges their part: what each particle does to itself is shared among its edges.
    fn part(&mut self, graph: &Graph<'_>, edges: &Strips<'_>) {
        let slot = |row: usize| edges.slot(row);
        let share = |own: &[f32], row: usize| own[slot(row)] / graph.range(row).len() as f32;
        for row in 0..self.roll.len() {
            for &other in graph.row(row) {
                if let Some(Place { entry, lane, back: false }) = edges.place(row, other)
                    && self.links.place(row, other).is_some()
                {
                    self.near[entry][lane] = -0.5 * (share(self.own, row) + share(self.own, other as usize));
                }
            }
        }
        for row in 0..self.roll.len() {
            self.own[slot(row)] = 0.0;
            for &other in graph.row(row) {
                let Some(Place { entry, lane, back }) = edges.place(row, other) else { continue };
                let near = self.near[entry][lane];
                self.own[slot(row)] -= near;
                if !back && let Some(Place { entry, lane, .. }) = self.links.place(row, other) {
                    self.numbers[entry][lane] -= near;
                }
            }
        }
    }
}

/// Finds who bends together: all corners of the hinges of each triangle. Tells whether there is room.
pub(super) fn find(room: &Room, shape: &Shape<'_>, words: &mut [u32], work: &mut [u32]) -> Option<()> {
    let (rows, mut rest) = (room.rows[0], work);
    let keys = take(&mut rest, strips::KEYS);
    let (starts, links) = (take(&mut rest, rows + 1), take(&mut rest, room.far));
    let corners = shape.hinges.iter().flat_map(|hinge| {
        hinge.corners().into_iter().flat_map(|corner| hinge.faces.map(|face| (corner as usize, face)))
    });
    let (work, others) = rest.split_at_mut_checked(rows + 2 + 8 * shape.hinges.len())?;
    let (begin, faces) = sorted(rows, corners, work)?;
    let (first, hinges) = shape.by_face(others)?;
    let made = link(starts, links, |row, add| {
        let faces = faces.get(begin[row] as usize..begin[row + 1] as usize)?;
        for (i, &face) in faces.iter().enumerate() {
            // Those of a hub are too many to ask for all: what is added twice is there once.
            if faces[i.saturating_sub(ASKED)..i].contains(&face) {
                continue;
            }
            let face = face as usize;
            let hinges = hinges.get(*first.get(face)? as usize..*first.get(face + 1)? as usize)?;
            if hinges.len() > SIDES {
                return None;
            }
            let hinges = hinges.iter().filter_map(|&hinge| shape.hinges.get(hinge as usize));
            for corner in hinges.flat_map(Hinge::corners) {
                add(corner)?;
            }
        }
        Some(())
    })?;
    Strips::make(&Graph { starts, links: &links[..made], into: &[] }, entries(room), words, keys)
}

impl Shape<'_> {
    /// Where the hinges of each triangle begin, and their numbers.
    fn by_face<'w>(&self, work: &'w mut [u32]) -> Option<(&'w [u32], &'w [u32])> {
        let numbered = self.hinges.iter().enumerate();
        let pairs = numbered.flat_map(|(hinge, of)| of.faces.map(|face| (face as usize, hinge as u32)));
        sorted(self.triangles.len(), pairs, work)
    }
}

/// The corners of a triangle's hinges, and the curvature that comes of each metre that one goes along the normal.
#[derive(Default)]
struct Patch {
    corners: [u32; PATCH],
    weights: [[f32; 3]; PATCH],
    count: usize,
}

impl Patch {
    /// Adds a hinge, if all of its corners are there.
    fn take(&mut self, shape: &Shape<'_>, roll: &[u32], face: u32, hinge: usize) {
        let (Some(hinge), Some(bend)) = (shape.hinges.get(hinge), shape.bends.get(hinge)) else { return };
        let gone = |corner: u32| roll.get(corner as usize).is_none_or(|&is| is == GONE);
        if hinge.corners().into_iter().any(gone) || !bend.acts() {
            return;
        }
        let [first, second] = [0, 1].map(|side| slopes(bend, side));
        let [a, b] = [first[0] + second[0], first[1] + second[1]];
        for (side, _) in (0..2).zip(hinge.faces).filter(|&(_, of)| of == face) {
            let curvature = bend.curvature[side];
            // Where the triangle's normal is against the fold's, the curvature changes its sign: all folds of a triangle are told along its own.
            let sign = if curvature[0] + curvature[1] < 0.0 { -1.0 } else { 1.0 } * bend.share(side);
            for (corner, slope) in hinge.corners().into_iter().zip([a, b, first[2], second[2]]) {
                self.add(corner, curvature.map(|part| part * (sign * slope)));
            }
        }
    }

    fn add(&mut self, corner: u32, curvature: [f32; 3]) {
        let known = self.corners[..self.count].iter().position(|&known| known == corner);
        let at = known.unwrap_or(self.count);
        let Some(weight) = self.weights.get_mut(at) else { return };
        self.corners[at] = corner;
        self.count = self.count.max(at + 1);
        weight.iter_mut().zip(curvature).for_each(|(sum, part)| *sum += part);
    }
}

/// How the angle of a hinge changes for each metre that the corners of its edge and the far one of a side go along that side's normal, at rest.
fn slopes(bend: &RestFold, side: usize) -> [f32; 3] {
    let slope = sqrt(bend.steep(side));
    let foot = bend.foot[side];
    [-(1.0 - foot) * slope, -foot * slope, slope]
}
