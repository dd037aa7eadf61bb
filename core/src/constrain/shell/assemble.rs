//! The blocks of a shell's system, for its graphs.

use super::cycle::Levels;
use super::eights::{WIDE, at_rest, column, eight, vectors};
use super::finest::{BACK, Finest};
use super::folded::Settle;
use super::solver::Solver;
use crate::cloth::Hinge;
use crate::lanes::{self, Eight, Kernel, LANES, Vectors};

impl Solver<'_> {
    /// Puts M + h² K into the blocks of the finest graph, and of all others what comes of it. Of bending edges have a part, and the matrix of
    /// bending has the rest; of what is not thin blocks have only what each particle does to itself.
    pub(super) fn assemble(&mut self, levels: &mut Levels<'_>) {
        if levels.is_empty() {
            return;
        }
        let finest = &mut levels.finest;
        finest.blocks.as_flattened_mut().as_flattened_mut().fill(0.0);
        finest.whole.as_flattened_mut().as_flattened_mut().fill(0.0);
        let bending = self.bending() * self.step.rate;
        finest.bending = if self.thin { bending } else { 0.0 };
        if bending > 0.0 && !self.thin {
            lanes::widest(
                #[inline(always)]
                || (0..self.hinges.len()).for_each(|i| self.add_fold(finest, bending, i)),
            );
        }
        lanes::run(Membranes { solver: self, finest });
        lanes::run(Settle { finest, weight: self.vectors.weight });
        levels.sum();
        levels.press(self.walls, self.vectors.pressing());
    }

    /// Adds to a fold's triangles how their corners hold each other by its moment, and what these do to themselves.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn add_fold(&mut self, finest: &mut Finest<'_>, bending: f32, i: usize) {
        let (Some(hinge), Some(bend), Some(&fold)) = (self.hinges.get(i), self.bends.get(i), self.folds.get(i)) else {
            return;
        };
        let area = |face: u32| self.cells.get(face as usize).map_or(0.0, |cell| cell.area);
        let stiffness = bending * bend.stiffness(hinge.faces.map(area));
        for (corner, force) in hinge.corners().into_iter().zip(fold.forces(1.0)) {
            let ([x, y, z], (strip, lane)) = (force.to_array(), finest.links.strips.at(corner as usize));
            let Some(whole) = finest.whole.get_mut(strip) else { continue };
            for (own, number) in whole.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z]) {
                if let Some(own) = own.get_mut(lane) {
                    *own += stiffness * number;
                }
            }
        }
        self.hold(hinge, [0, 1].map(|side| fold.held(side, [0.0; 2])));
    }

    /// Adds to a hinge's triangles how their corners hold each other: on each side those of the edge, its first corner and the far one, its second and
    /// that.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn hold(&mut self, hinge: &Hinge, held: [[f32; 3]; 2]) {
        for (side, [across, first, second]) in held.into_iter().enumerate() {
            let (face, far) = (hinge.faces[side] as usize, hinge.far[side]);
            let (Some(&[a, b, c]), Some(strain)) = (self.triangles.get(face), self.strains.get_mut(face)) else {
                continue;
            };
            // The corner behind the far one, and the edges from there on.
            let (next, [across_at, last, from]) = if a == far {
                (b, [1, 2, 0])
            } else if b == far {
                (c, [2, 0, 1])
            } else if c == far {
                (a, [0, 1, 2])
            } else {
                continue;
            };
            let [first, second] = if next == hinge.edge[0] { [first, second] } else { [second, first] };
            strain.held[across_at] += across;
            strain.held[from] += first;
            strain.held[last] += second;
        }
    }
}

/// Adds the blocks of all triangles' edges.
struct Membranes<'a, 's, 'f, 'm> {
    solver: &'a Solver<'s>,
    finest: &'f mut Finest<'m>,
}

impl Kernel for Membranes<'_, '_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        let triangles = self.solver.triangles.len();
        for first in (0..triangles).step_by(LANES) {
            if !(WIDE && self.add_eight(like, first)) {
                (first..triangles.min(first + LANES)).for_each(|i| self.add(i));
            }
        }
    }
}

impl Membranes<'_, '_, '_, '_> {
    fn add(&mut self, i: usize) {
        let Solver { params, ref step, cells, ref strains, .. } = *self.solver;
        let (Some(cell), Some(strain)) = (cells.get(i), strains.get(i)) else { return };
        let blocks = strain.blocks(cell, params, step);
        let Some(places) = self.finest.links.edges.get(i) else { return };
        let numbers = self.finest.blocks.as_flattened_mut().as_flattened_mut();
        for (&place, block) in places.iter().zip(blocks) {
            let block = if place & BACK == 0 { block } else { block.transpose() };
            add(numbers, place & !BACK, block.to_cols_array());
        }
    }

    /// Tells whether it has done so, by the operations of one in their order.
    #[inline(always)]
    fn add_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let Solver { params, ref step, cells, ref strains, .. } = *self.solver;
        let (Some(cells), Some(strains)) = (eight(cells, first), eight(strains, first)) else { return false };
        let Some(places) = eight(self.finest.links.edges, first) else { return false };
        let ([a, b, c, d], area) = at_rest(like, cells);
        let gain = [[lanes::negated(a + b), lanes::negated(c + d)], [a, c], [b, d]];
        let u = vectors!(like, strains, |strain| strain.along[0]);
        let v = vectors!(like, strains, |strain| strain.along[1]);
        let tension = column!(like, strains, |strain| strain.tension);
        let held = [
            column!(like, strains, |strain| strain.held[0]),
            column!(like, strains, |strain| strain.held[1]),
            column!(like, strains, |strain| strain.held[2]),
        ];
        let square = like.all(step.h * step.h);
        let (scale, rate) = (area * square, like.all(step.rate));
        let [warp, weft] = params.stretch;
        let stress =
            [scale * like.all(warp) * rate, scale * like.all(weft) * rate, scale * like.all(params.shear) * rate];
        let taut = like.all(0.25) * tension * area * square;
        let numbers = self.finest.blocks.as_flattened_mut().as_flattened_mut();
        // Spelled out: `map` of an array would be called, for other registers.
        let blocks = [
            block(stress, taut, held[0], [gain[0], gain[1]], [u, v]),
            block(stress, taut, held[1], [gain[1], gain[2]], [u, v]),
            block(stress, taut, held[2], [gain[2], gain[0]], [u, v]),
        ];
        for (lane, places) in places.iter().enumerate() {
            for (&place, block) in places.iter().zip(&blocks) {
                let mut one = [0.0; 9];
                for (number, lanes) in block.iter().enumerate() {
                    let turned = number / 3 + number % 3 * 3;
                    one[if place & BACK == 0 { number } else { turned }] = lanes[lane];
                }
                add(numbers, place & !BACK, one);
            }
        }
        true
    }
}

/// How two corners of eight triangles resist each other, as [`Strain::blocks`](super::membrane::Strain::blocks).
#[inline(always)]
fn block<F: Eight>(
    [warp, weft, shear]: [F; 3],
    taut: F,
    held: F,
    [[p, q], [r, s]]: [[F; 2]; 2],
    [u, v]: [Vectors<F>; 2],
) -> [[f32; LANES]; 9] {
    let (uu, vv) = (warp * p * r + shear * q * s, weft * q * s + shear * p * r);
    let (uv, vu) = (shear * q * r, shear * p * s);
    let (first, second) = (u * uu + v * vu, u * uv + v * vv);
    let own = taut * (p * r + q * s) + held;
    let ([ux, uy, uz], [vx, vy, vz]) = (u.0, v.0);
    let [a, b, c] = (first * ux + second * vx).0;
    let [d, e, f] = (first * uy + second * vy).0;
    let [g, h, i] = (first * uz + second * vz).0;
    let array = F::to_array;
    [array(a + own), array(b), array(c), array(d), array(e + own), array(f), array(g), array(h), array(i + own)]
}

/// Adds to a block whose first number is there.
#[inline(always)]
fn add(numbers: &mut [f32], place: u32, block: [f32; 9]) {
    let place = place as usize;
    if let Some(lane) = numbers.get_mut(place..).and_then(|rest| rest.first_chunk_mut::<{ 8 * LANES + 1 }>()) {
        for (i, number) in block.into_iter().enumerate() {
            lane[LANES * i] += number;
        }
    }
}
