//! The finest graph's part of a shell's system, eight rows side by side: products, and sweeps of Gauss and Seidel's method.

use super::mesh::{Graph, Room};
use super::plate::Plate;
use super::strips::{self, ALL, NONE, Strips};
use super::sweep::Quad;
use crate::lanes::{Eight, Kernel, LANES, Vectors, mask_of};
use crate::memory::take;
use glam::Vec3;

/// The blocks of an entry: their columns one behind the other.
pub(super) type Block = [[f32; LANES]; 9];
/// The symmetric blocks of eight rows with themselves: xx, xy, xz, yy, yz, zz.
pub(super) type Own = [[f32; LANES]; 6];

/// The finest graph's part of the system.
#[derive(Default)]
pub(super) struct Finest<'m> {
    pub(super) links: Links<'m>,
    /// The row of the next graph that stands for each.
    pub(super) into: &'m [u32],
    /// The blocks of its links.
    pub(super) blocks: &'m mut [Block],
    /// Those of its rows with themselves before walls press; with these their inverses, zero for what does not move; and what is left of them
    /// where all go the same way.
    pub(super) whole: &'m mut [Own],
    pub(super) inverse: &'m mut [Own],
    /// What sweeps take them for more than they are, in each direction, by what rows of one strip do to each other.
    pub(super) soft: &'m mut [[f32; LANES]],
    pub(super) alone: &'m mut [Block],
    /// How it bends beyond what is in blocks, and so many times that: bending stiffness × h².
    pub(super) plate: Plate<'m>,
    pub(super) bending: f32,
    /// The right-hand side and the solution: three columns each.
    pub(super) r: &'m mut [f32],
    pub(super) x: &'m mut [f32],
}

/// Words for so many rows and entries.
pub(super) fn words(rows: usize, entries: usize) -> usize {
    let own = rows.div_ceil(LANES).saturating_mul(LANES * (1 + 2 * 6 + 9 + 2 * 3));
    entries.saturating_mul(9 * LANES).saturating_add(own)
}

/// Who is linked with whom, and what becomes of that.
#[derive(Clone, Copy, Default)]
pub(super) struct Links<'m> {
    pub(super) strips: Strips<'m>,
    /// Where in the next graph each link's block goes: to a link, or to a row's block with itself ([`WITHIN`]), or nowhere.
    pub(super) sums: &'m [[u32; LANES]],
    /// Where the blocks of a triangle's edges are, there and back: of their first numbers.
    pub(super) edges: &'m [[u32; 6]],
}

/// The bit that says that a block goes to a row with itself.
pub(super) const WITHIN: u32 = 1 << 31;

/// Words for what is known of links.
pub(super) fn pattern(room: &Room, triangles: usize) -> usize {
    let ([rows, _], entries) = (room.rows, strips::entries(room.rows[0], room.links[0]));
    if rows == 0 {
        return 0;
    }
    let sums = entries.saturating_mul(LANES);
    strips::words(rows, entries).saturating_add(sums).saturating_add(triangles.saturating_mul(6))
}

impl<'m> Links<'m> {
    pub(super) fn of(room: &Room, triangles: usize, words: &'m [u32]) -> Self {
        let ([rows, _], entries) = (room.rows, strips::entries(room.rows[0], room.links[0]));
        if words.len() < pattern(room, triangles) || rows == 0 {
            return Self::default();
        }
        let (strips, rest) = words.split_at(strips::words(rows, entries));
        let (sums, edges) = rest.split_at(LANES * entries);
        Self {
            strips: Strips::of(rows, entries, strips),
            sums: bytemuck::cast_slice(sums),
            edges: bytemuck::cast_slice(edges),
        }
    }

    /// Makes them; tells whether there is room.
    pub(super) fn make(
        room: &Room,
        graphs: &[Graph<'_>],
        triangles: &[[u32; 3]],
        words: &mut [u32],
        work: &mut [u32],
    ) -> Option<()> {
        let (&[fine, coarse, ..], entries) = (graphs, strips::entries(room.rows[0], room.links[0])) else {
            return None;
        };
        let (head, rest) = words.split_at_mut_checked(strips::words(room.rows[0], entries))?;
        Strips::make(&fine, entries, head, work)?;
        let strips = Strips::of(room.rows[0], entries, head);
        let (sums, edges) = rest.split_at_mut_checked(LANES * entries)?;
        let (sums, edges): (&mut [[u32; LANES]], &mut [[u32; 6]]) =
            (bytemuck::cast_slice_mut(sums), bytemuck::cast_slice_mut(edges));
        sums.as_flattened_mut().fill(NONE);
        for row in 0..room.rows[0] {
            for &other in fine.row(row) {
                let (Some((entry, lane)), Some(&into)) = (strips.place(row, other), fine.into.get(row)) else {
                    continue;
                };
                let group = *fine.into.get(other as usize)?;
                sums[entry][lane] = match coarse.link(into as usize, group) {
                    _ if group == into => WITHIN | into,
                    link => link.map_or(NONE, |link| link as u32),
                };
            }
        }
        let place = |from: u32, to: u32| {
            let (entry, lane) = strips.place(from as usize, to)?;
            u32::try_from(9 * LANES * entry + lane).ok()
        };
        for (places, corners) in edges.iter_mut().zip(triangles) {
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                places[2 * side] = place(from, to).unwrap_or(NONE);
                places[2 * side + 1] = place(to, from).unwrap_or(NONE);
            }
        }
        Some(())
    }
}

/// q = A p, by how far others go beside each: what is stiff would round to more than what is light.
pub(super) struct Product<'a, 'm> {
    pub(super) finest: &'a mut Finest<'m>,
    pub(super) p: &'a [Vec3],
    pub(super) q: &'a mut [Vec3],
}

impl Kernel for Product<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { finest, p, q } = self;
        finest.take(like, p);
        let Finest { links: Links { strips, .. }, blocks, alone, plate, bending, x, .. } = finest;
        let x = columns(x);
        for (strip, alone) in alone.iter().enumerate() {
            let own = load(like, x, LANES * strip);
            let mut sum = times(like, alone, own);
            let range = strips.range(strip);
            for (entry, block) in range.clone().zip(blocks.get(range).unwrap_or(&[])) {
                sum = sum + times(like, block, strips.vectors(like, x, entry) - own);
            }
            for entry in strips.mixed(strip) {
                let (Some(block), owners) = (blocks.get(entry), strips.owners(entry)) else { return };
                let ways = strips.vectors(like, x, entry) - owners.lent(like, own);
                sum = owners.add(like, sum, times(like, block, ways));
            }
            if *bending > 0.0 {
                sum = sum + plate.bend(like, x, strip, own) * like.all(*bending);
            }
            save(q, &strips.rows(strip), sum);
        }
    }
}

/// x = (D + L)⁻¹ r, L being what goes from one strip to a later one; and the residual after that, summed up for the next graph.
pub(super) struct Forth<'a, 'm> {
    pub(super) finest: &'a mut Finest<'m>,
    pub(super) r: &'a [Vec3],
    pub(super) next: Option<&'a mut [Quad]>,
}

impl Kernel for Forth<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { finest, r, next } = self;
        finest.keep(like, r);
        finest.x.fill(0.0);
        finest.forth(like);
        if let Some(next) = next {
            next.fill([0.0; 4]);
            finest.leave(like, next);
        }
    }
}

/// Adds the next graph's solution so many times, and sweeps back.
pub(super) struct Back<'a, 'm> {
    pub(super) finest: &'a mut Finest<'m>,
    pub(super) next: Option<&'a [Quad]>,
    pub(super) further: f32,
    pub(super) z: &'a mut [Vec3],
}

impl Kernel for Back<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { finest, next, further, z } = self;
        if let Some(next) = next {
            finest.add(like, next, like.all(further));
        }
        finest.back(like, z);
    }
}

impl<'m> Finest<'m> {
    /// In words, with how it bends.
    pub(super) fn of(into: &'m [u32], links: Links<'m>, plate: Plate<'m>, words: &mut &'m mut [u32]) -> Self {
        let strips = links.strips.len();
        let blocks = super::whole(take(words, 9 * LANES * links.strips.entries()));
        let [whole, inverse] = [0, 1].map(|_| super::whole(take(words, 6 * LANES * strips)));
        let (soft, alone) = (super::whole(take(words, LANES * strips)), super::whole(take(words, 9 * LANES * strips)));
        let [r, x] = [0, 1].map(|_| super::whole(take(words, 3 * LANES * strips)));
        Self { links, into, blocks, whole, inverse, soft, alone, plate, bending: 0.0, r, x }
    }
}

impl Finest<'_> {
    /// Puts vectors into the columns of the solution.
    #[inline(always)]
    fn take<F: Eight>(&mut self, like: F, p: &[Vec3]) {
        let mut x = columns_mut(self.x);
        for strip in 0..self.links.strips.len() {
            put(&mut x, LANES * strip, taken(like, p, &self.links.strips.rows(strip)));
        }
    }

    /// Puts vectors into those of the right-hand side.
    #[inline(always)]
    fn keep<F: Eight>(&mut self, like: F, r: &[Vec3]) {
        let mut to = columns_mut(self.r);
        for strip in 0..self.links.strips.len() {
            put(&mut to, LANES * strip, taken(like, r, &self.links.strips.rows(strip)));
        }
    }

    #[inline(always)]
    fn forth<F: Eight>(&mut self, like: F) {
        let Self { links: Links { strips, .. }, blocks, inverse, r, x, .. } = self;
        let (r, mut x) = (columns(r), columns_mut(x));
        for (strip, inverse) in inverse.iter().enumerate() {
            let mut left = load(like, r, LANES * strip);
            let range = strips.range(strip);
            for (entry, block) in range.clone().zip(blocks.get(range).unwrap_or(&[])) {
                // Who comes later is at zero still.
                if strips.below(entry) != 0 {
                    left = left - times(like, block, strips.vectors(like, shared(&x), entry));
                }
            }
            left = less_mixed(like, left, (strips, blocks), shared(&x), strip, false);
            put(&mut x, LANES * strip, own_times(like, inverse, left));
        }
    }

    #[inline(always)]
    fn leave<F: Eight>(&self, like: F, next: &mut [Quad]) {
        let x = columns(self.x);
        for strip in 0..self.links.strips.len() {
            let soft = self.soft.get(strip).map_or(
                like.all(0.0),
                #[inline(always)]
                |soft| like.of(*soft),
            );
            let mut left = load(like, x, LANES * strip) * soft;
            let range = self.links.strips.range(strip);
            for (entry, block) in range.clone().zip(self.blocks.get(range).unwrap_or(&[])) {
                let below = self.links.strips.below(entry);
                if below == ALL {
                    continue;
                }
                let mut others = self.links.strips.vectors(like, x, entry);
                if below != 0 {
                    others = others.masked(mask_of(like, !below));
                }
                left = left - times(like, block, others);
            }
            left = less_mixed(like, left, (&self.links.strips, self.blocks), x, strip, true);
            for (row, left) in self.links.strips.rows(strip).into_iter().zip(left.rows()) {
                if let Some(next) = self.into.get(row).and_then(|&group| next.get_mut(group as usize)) {
                    next.iter_mut().zip(left).for_each(|(next, left)| *next += left);
                }
            }
        }
    }

    #[inline(always)]
    fn add<F: Eight>(&mut self, like: F, next: &[Quad], further: F) {
        let mut x = columns_mut(self.x);
        for strip in 0..self.links.strips.len() {
            let mut all = [[0.0; 4]; LANES];
            for (all, row) in all.iter_mut().zip(self.links.strips.rows(strip)) {
                *all = self.into.get(row).and_then(|&group| next.get(group as usize)).copied().unwrap_or_default();
            }
            let own = load(like, shared(&x), LANES * strip);
            put(&mut x, LANES * strip, own + Vectors(like.columns_of(all)) * further);
        }
    }

    #[inline(always)]
    fn back<F: Eight>(&mut self, like: F, z: &mut [Vec3]) {
        let Self { links: Links { strips, .. }, blocks, inverse, soft, r, x, .. } = self;
        let (r, mut x) = (columns(r), columns_mut(x));
        for (strip, (inverse, soft)) in inverse.iter().zip(&**soft).enumerate().rev() {
            let mut left = load(like, r, LANES * strip) + load(like, shared(&x), LANES * strip) * like.of(*soft);
            let range = strips.range(strip);
            for (entry, block) in range.clone().zip(blocks.get(range).unwrap_or(&[])) {
                left = left - times(like, block, strips.vectors(like, shared(&x), entry));
            }
            left = less_mixed(like, left, (strips, blocks), shared(&x), strip, false);
            let own = own_times(like, inverse, left);
            put(&mut x, LANES * strip, own);
            save(z, &strips.rows(strip), own);
        }
    }
}

/// Takes from what is left of a strip's rows what its mixed entries do to them, or only that by rows that are not of earlier strips.
#[inline(always)]
fn less_mixed<F: Eight>(
    like: F,
    mut left: Vectors<F>,
    (strips, blocks): (&Strips<'_>, &[Block]),
    x: [&[f32]; 3],
    strip: usize,
    later: bool,
) -> Vectors<F> {
    for entry in strips.mixed(strip) {
        let Some(block) = blocks.get(entry) else { break };
        let mut others = strips.vectors(like, x, entry);
        if later {
            others = others.masked(mask_of(like, !strips.below(entry)));
        }
        left = strips.owners(entry).add(like, left, -times(like, block, others));
    }
    left
}

/// Three columns of so many numbers together.
#[inline(always)]
fn columns(all: &[f32]) -> [&[f32]; 3] {
    let (x, others) = all.split_at(all.len() / 3);
    let (y, z) = others.split_at(x.len());
    [x, y, z]
}

#[inline(always)]
fn columns_mut(all: &mut [f32]) -> [&mut [f32]; 3] {
    let (x, others) = all.split_at_mut(all.len() / 3);
    let (y, z) = others.split_at_mut(x.len());
    [x, y, z]
}

#[inline(always)]
fn shared<'x>([x, y, z]: &'x [&mut [f32]; 3]) -> [&'x [f32]; 3] {
    [x, y, z]
}

/// Eight numbers of a column from one on, if there are as many.
#[inline(always)]
pub(super) fn eight_of<F: Eight>(like: F, column: &[f32], first: usize) -> F {
    column.get(first..).and_then(|rest| rest.first_chunk()).map_or(like.all(0.0), |lanes| like.of(*lanes))
}

#[inline(always)]
fn load<F: Eight>(like: F, [x, y, z]: [&[f32]; 3], first: usize) -> Vectors<F> {
    Vectors([eight_of(like, x, first), eight_of(like, y, first), eight_of(like, z, first)])
}

#[inline(always)]
fn put<F: Eight>(to: &mut [&mut [f32]; 3], first: usize, vectors: Vectors<F>) {
    for (column, lanes) in to.iter_mut().zip(vectors.0) {
        if let Some(to) = column.get_mut(first..).and_then(|rest| rest.first_chunk_mut::<LANES>()) {
            *to = lanes.to_array();
        }
    }
}

/// The vectors of eight rows; zero, where there is no row.
#[inline(always)]
fn taken<F: Eight>(like: F, vectors: &[Vec3], of: &[usize; LANES]) -> Vectors<F> {
    let (mut rows, all) = ([[0.0; 4]; LANES], bytemuck::cast_slice::<_, f32>(vectors));
    for (row, &of) in rows.iter_mut().zip(of) {
        // The last number of each does not count.
        match all.get(3 * of..).and_then(|rest| rest.first_chunk()) {
            Some(quad) => *row = *quad,
            None => *row = vectors.get(of).map_or([0.0; 4], |v| [v.x, v.y, v.z, 0.0]),
        }
    }
    Vectors(like.columns_of(rows))
}

/// Puts vectors where eight rows are, or as many as there are.
#[inline(always)]
fn save<F: Eight>(to: &mut [Vec3], of: &[usize; LANES], vectors: Vectors<F>) {
    for (&row, [x, y, z, _]) in of.iter().zip(vectors.rows()) {
        if let Some(to) = to.get_mut(row) {
            *to = Vec3::new(x, y, z);
        }
    }
}

/// Blocks times vectors.
#[inline(always)]
fn times<F: Eight>(like: F, block: &Block, v: Vectors<F>) -> Vectors<F> {
    let [a, b, c, d, e, f, g, h, i] = block;
    Vectors([row(like, [a, d, g], v), row(like, [b, e, h], v), row(like, [c, f, i], v)])
}

/// Symmetric blocks times vectors.
#[inline(always)]
fn own_times<F: Eight>(like: F, [xx, xy, xz, yy, yz, zz]: &Own, v: Vectors<F>) -> Vectors<F> {
    Vectors([row(like, [xx, xy, xz], v), row(like, [xy, yy, yz], v), row(like, [xz, yz, zz], v)])
}

#[inline(always)]
fn row<F: Eight>(like: F, [a, b, c]: [&[f32; LANES]; 3], v: Vectors<F>) -> F {
    let [x, y, z] = v.0;
    like.of(*a) * x + like.of(*b) * y + like.of(*c) * z
}
