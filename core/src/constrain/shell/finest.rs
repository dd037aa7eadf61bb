//! The finest graph's part of a shell's system, eight rows side by side: products, and sweeps of Gauss and Seidel's method.

use super::mesh::{Graph, Room};
use super::parts::{Parts, PartsMut};
use super::plate::Plate;
use super::strips::{self, NONE, Place, Strips};
use super::sweep::Quad;
use super::words::structs;
use crate::lanes::{Eight, Kernel, LANES, Vectors};
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
    /// Those of its rows with themselves before walls press; with these their inverses, zero for what does not move.
    pub(super) whole: &'m mut [Own],
    pub(super) inverse: &'m mut [Own],
    /// What sweeps take them for more than they are, in each direction, by what rows of one strip do to each other.
    pub(super) soft: &'m mut [[f32; LANES]],
    /// Masses, zero of what does not move \[kg\]. That is at zero in each product and sweep, so that blocks of its links may be what they are.
    pub(super) mass: &'m mut [[f32; LANES]],
    /// How it bends beyond what is in blocks, and so many times that: bending stiffness × h².
    pub(super) plate: Plate<'m>,
    pub(super) bending: f32,
    /// The right-hand side, the solution, and what is left or comes of it: three columns each.
    pub(super) r: &'m mut [f32],
    pub(super) x: &'m mut [f32],
    pub(super) sum: &'m mut [f32],
}

/// Words for so many rows and entries.
pub(super) fn words(rows: usize, entries: usize) -> usize {
    let own = rows.div_ceil(LANES).saturating_mul(LANES * (2 + 2 * 6 + 3 * 3));
    entries.saturating_mul(9 * LANES).saturating_add(own)
}

/// Who is linked with whom, and what becomes of that.
#[derive(Clone, Copy, Default)]
pub(super) struct Links<'m> {
    pub(super) strips: Strips<'m>,
    /// Where in the next graph each link's block goes, there and back: to a link, or to a row's block with itself ([`WITHIN`]), or nowhere.
    pub(super) sums: &'m [[[u32; LANES]; 2]],
    /// Where the blocks of a triangle's edges are: of their first numbers, and whether they are there turned round ([`BACK`]).
    pub(super) edges: &'m [[u32; 3]],
}

/// The bit that says that a block goes to a row with itself.
pub(super) const WITHIN: u32 = 1 << 31;
/// The bit that says that a block is there as one from the edge's second corner.
pub(super) const BACK: u32 = 1 << 31;

/// Words for what is known of links.
pub(super) fn pattern(room: &Room, triangles: usize) -> usize {
    let ([rows, _], entries) = (room.rows, strips::entries(room.rows[0], room.links[0]));
    if rows == 0 {
        return 0;
    }
    let sums = entries.saturating_mul(2 * LANES);
    strips::words(rows, entries).saturating_add(sums).saturating_add(triangles.saturating_mul(3))
}

impl<'m> Links<'m> {
    pub(super) fn of(room: &Room, triangles: usize, words: &'m [u32]) -> Self {
        let ([rows, _], entries) = (room.rows, strips::entries(room.rows[0], room.links[0]));
        if words.len() < pattern(room, triangles) || rows == 0 {
            return Self::default();
        }
        let (strips, rest) = words.split_at(strips::words(rows, entries));
        let (sums, edges) = rest.split_at(2 * LANES * entries);
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
        let (sums, edges) = rest.split_at_mut_checked(2 * LANES * entries)?;
        let (sums, edges): (&mut [[[u32; LANES]; 2]], &mut [[u32; 3]]) =
            (bytemuck::cast_slice_mut(sums), bytemuck::cast_slice_mut(edges));
        sums.as_flattened_mut().as_flattened_mut().fill(NONE);
        for row in 0..room.rows[0] {
            for &other in fine.row(row) {
                let (Some(Place { entry, lane, back }), Some(&into)) = (strips.place(row, other), fine.into.get(row))
                else {
                    continue;
                };
                let group = *fine.into.get(other as usize)?;
                sums[entry][usize::from(back)][lane] = match coarse.link(into as usize, group) {
                    _ if group == into => WITHIN | into,
                    link => link.map_or(NONE, |link| link as u32),
                };
            }
        }
        let place = |from: u32, to: u32| {
            let Place { entry, lane, back } = strips.place(from as usize, to)?;
            let first = u32::try_from(9 * LANES * entry + lane).ok().filter(|first| first & BACK == 0)?;
            Some(if back { BACK | first } else { first })
        };
        for (places, corners) in edges.iter_mut().zip(triangles) {
            for (side, to) in places.iter_mut().enumerate() {
                *to = place(corners[side], corners[(side + 1) % 3]).unwrap_or(NONE);
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
        let Finest { links: Links { strips, .. }, blocks, mass, plate, bending, x, sum, .. } = finest;
        let (x, mut sum, bending) = (columns(x), columns_mut(sum), *bending);
        for (strip, mass) in mass.iter().enumerate() {
            let own = load(like, x, LANES * strip);
            put(&mut sum, LANES * strip, Vectors([like.all(0.0); 3]));
            let mut all = own * like.of(*mass);
            for (entry, block) in strips.each(strips.range(strip), blocks) {
                let ways = entry.vectors(like, x) - own;
                all = all + times(like, block, ways);
                entry.take_from(like, &mut sum, times_back(like, block, ways));
            }
            for (entry, block) in strips.each(strips.mixed(strip), blocks) {
                let ways = entry.vectors(like, x) - entry.owners().lent(like, own);
                all = entry.owners().add(like, all, times(like, block, ways));
                entry.take_from(like, &mut sum, times_back(like, block, ways));
            }
            if bending > 0.0 {
                all = all + plate.bend(like, (x, &mut sum), strip, own, like.all(bending));
            }
            let all = load(like, shared(&sum), LANES * strip) + all;
            put(&mut sum, LANES * strip, all);
        }
        // What later strips do to earlier ones is known in the end.
        let (mut to, sum) = (PartsMut::of(q, strips.len()), shared(&sum));
        for (strip, mass) in mass.iter().enumerate() {
            to.save(strip, load(like, sum, LANES * strip).masked(like.of(*mass).simd_gt(like.all(0.0))));
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
        finest.forth(like, r);
        if let Some(next) = next {
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
        let blocks = structs(take(words, 9 * LANES * links.strips.entries()));
        let [whole, inverse] = [0, 1].map(|_| structs(take(words, 6 * LANES * strips)));
        let [soft, mass] = [0, 1].map(|_| structs(take(words, LANES * strips)));
        let [r, x, sum] = [0, 1, 2].map(|_| structs(take(words, 3 * LANES * strips)));
        Self { links, into, blocks, whole, inverse, soft, mass, plate, bending: 0.0, r, x, sum }
    }
}

impl Finest<'_> {
    /// Puts vectors into the columns of the solution.
    #[inline(always)]
    fn take<F: Eight>(&mut self, like: F, p: &[Vec3]) {
        let (mut x, p) = (columns_mut(self.x), Parts::of(p, self.links.strips.len()));
        for (strip, mass) in self.mass.iter().enumerate() {
            let moves = like.of(*mass).simd_gt(like.all(0.0));
            put(&mut x, LANES * strip, p.load(like, strip).masked(moves));
        }
    }

    /// Sweeps forth, and keeps the right-hand side and what earlier rows feel of where later ones go.
    #[inline(always)]
    fn forth<F: Eight>(&mut self, like: F, right: &[Vec3]) {
        let Self { links: Links { strips, .. }, blocks, inverse, soft, r, x, sum, .. } = self;
        x.fill(0.0);
        let (mut r, mut x, mut sum) = (columns_mut(r), columns_mut(x), columns_mut(sum));
        let right = Parts::of(right, strips.len());
        for (strip, (inverse, soft)) in inverse.iter().zip(&**soft).enumerate() {
            let mut left = right.load(like, strip);
            put(&mut r, LANES * strip, left);
            put(&mut sum, LANES * strip, Vectors([like.all(0.0); 3]));
            for (entry, block) in strips.each(strips.range(strip), blocks) {
                left = left - times(like, block, entry.vectors(like, shared(&x)));
            }
            for (entry, block) in strips.each(strips.mixed(strip), blocks) {
                // Those of the strip itself are at zero still.
                let parts = times(like, block, entry.vectors(like, shared(&x)));
                left = entry.owners().add(like, left, -parts);
            }
            let own = own_times(like, inverse, left);
            put(&mut x, LANES * strip, own);
            let mut all = own * like.of(*soft);
            for (entry, block) in strips.each(strips.range(strip), blocks) {
                entry.take_from(like, &mut sum, times_back(like, block, own));
            }
            for (entry, block) in strips.each(strips.mixed(strip), blocks) {
                entry.take_from(like, &mut sum, times_back(like, block, entry.owners().lent(like, own)));
                if let Some(within) = entry.mask_within(like, strip) {
                    let parts = times(like, block, entry.vectors(like, shared(&x)));
                    all = entry.owners().add(like, all, -parts.masked(within));
                }
            }
            let all = load(like, shared(&sum), LANES * strip) + all;
            put(&mut sum, LANES * strip, all);
        }
    }

    /// Sums up for the next graph what is left.
    #[inline(always)]
    fn leave<F: Eight>(&self, like: F, next: &mut [Quad]) {
        next.fill([0.0; 4]);
        let sum = columns(self.sum);
        for (strip, mass) in self.mass.iter().enumerate() {
            let left = load(like, sum, LANES * strip).masked(like.of(*mass).simd_gt(like.all(0.0)));
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
        for (strip, mass) in self.mass.iter().enumerate() {
            let moves = like.of(*mass).simd_gt(like.all(0.0));
            let mut all = [[0.0; 4]; LANES];
            for (all, row) in all.iter_mut().zip(self.links.strips.rows(strip)) {
                *all = self.into.get(row).and_then(|&group| next.get(group as usize)).copied().unwrap_or_default();
            }
            let own = load(like, shared(&x), LANES * strip);
            put(&mut x, LANES * strip, (own + Vectors(like.columns_of(all)) * further).masked(moves));
        }
    }

    /// Sweeps back: takes from the right-hand side of earlier rows what later ones do to them.
    #[inline(always)]
    fn back<F: Eight>(&mut self, like: F, z: &mut [Vec3]) {
        let Self { links: Links { strips, .. }, blocks, inverse, soft, r, x, .. } = self;
        let (mut r, mut x, mut z) = (columns_mut(r), columns_mut(x), PartsMut::of(z, strips.len()));
        for (strip, (inverse, soft)) in inverse.iter().zip(&**soft).enumerate().rev() {
            let before = load(like, shared(&x), LANES * strip);
            let mut all = before * like.of(*soft);
            for (entry, block) in strips.each(strips.range(strip), blocks) {
                all = all - times(like, block, entry.vectors(like, shared(&x)));
            }
            for (entry, block) in strips.each(strips.mixed(strip), blocks) {
                let parts = times(like, block, entry.vectors(like, shared(&x)));
                all = entry.owners().add(like, all, -parts);
                if let Some(within) = entry.mask_within(like, strip) {
                    let parts = times_back(like, block, entry.owners().lent(like, before)).masked(within);
                    entry.take_from(like, &mut r, parts);
                }
            }
            let own = own_times(like, inverse, all + load(like, shared(&r), LANES * strip));
            put(&mut x, LANES * strip, own);
            z.save(strip, own);
            for (entry, block) in strips.each(strips.range(strip), blocks) {
                entry.take_from(like, &mut r, times_back(like, block, own));
            }
            for (entry, block) in strips.each(strips.mixed(strip), blocks) {
                entry.take_from(like, &mut r, times_back(like, block, entry.owners().lent(like, own)));
            }
        }
    }
}

/// Three columns of so many numbers together. They are cut to one length, so that one check does for all.
#[inline(always)]
fn columns(all: &[f32]) -> [&[f32]; 3] {
    let len = all.len() / 3;
    let (x, others) = all.split_at(len);
    let (y, z) = others.split_at(len);
    [x, y, &z[..len]]
}

#[inline(always)]
fn columns_mut(all: &mut [f32]) -> [&mut [f32]; 3] {
    let len = all.len() / 3;
    let (x, others) = all.split_at_mut(len);
    let (y, z) = others.split_at_mut(len);
    [x, y, &mut z[..len]]
}

#[inline(always)]
fn shared<'x>([x, y, z]: &'x [&mut [f32]; 3]) -> [&'x [f32]; 3] {
    [x, y, z]
}

/// Eight numbers of a column from one on, if there are as many.
#[inline(always)]
pub(super) fn eight_of<F: Eight>(like: F, column: &[f32], first: usize) -> F {
    column
        .get(first..first + LANES)
        .and_then(|lanes| lanes.first_chunk())
        .map_or(like.all(0.0), |lanes| like.of(*lanes))
}

#[inline(always)]
fn load<F: Eight>(like: F, [x, y, z]: [&[f32]; 3], first: usize) -> Vectors<F> {
    Vectors([eight_of(like, x, first), eight_of(like, y, first), eight_of(like, z, first)])
}

#[inline(always)]
fn put<F: Eight>(to: &mut [&mut [f32]; 3], first: usize, vectors: Vectors<F>) {
    for (column, lanes) in to.iter_mut().zip(vectors.0) {
        if let Some(to) = column.get_mut(first..first + LANES).and_then(|lanes| lanes.first_chunk_mut::<LANES>()) {
            *to = lanes.to_array();
        }
    }
}

/// Blocks times vectors.
#[inline(always)]
fn times<F: Eight>(like: F, block: &Block, v: Vectors<F>) -> Vectors<F> {
    let [a, b, c, d, e, f, g, h, i] = block;
    Vectors([row(like, [a, d, g], v), row(like, [b, e, h], v), row(like, [c, f, i], v)])
}

/// The same blocks turned round: what the links do to those at their other ends.
#[inline(always)]
fn times_back<F: Eight>(like: F, block: &Block, v: Vectors<F>) -> Vectors<F> {
    let [a, b, c, d, e, f, g, h, i] = block;
    Vectors([row(like, [a, b, c], v), row(like, [d, e, f], v), row(like, [g, h, i], v)])
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
