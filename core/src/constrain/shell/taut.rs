//! Edges of a shell that have come out longer than its linear system knows of.

use super::membrane::Cell;
use super::solver::{NOBODY, Solver, Vectors};
use crate::constrain::{Bodies, walls};
use crate::math::{length, max, sqrt};
use glam::Vec3;

/// Passes over all edges, at the most.
const PASSES: u32 = 8;
/// The share of an edge's length by which they leave it too long.
const SLACK: f32 = 1e-3;

impl Solver<'_> {
    /// Shortens, by equal and opposite shifts, the edges that have turned so far that what is solved along the directions of the sub-step's
    /// beginning leaves them longer than they are at rest and than it means them to be.
    pub(super) fn tighten(&mut self, bodies: &Bodies<'_>) {
        let Vectors { shift, p, .. } = &mut self.vectors;
        p.copy_from_slice(shift);
        for _ in 0..PASSES {
            let mut some = false;
            for i in 0..self.triangles.len() {
                some |= self.shorten(i, bodies);
            }
            if !some {
                return;
            }
            walls::keep(self.walls, bodies, self.vectors.shift);
        }
    }

    /// Shortens the edges of a triangle; tells whether it had to.
    fn shorten(&mut self, i: usize, bodies: &Bodies<'_>) -> bool {
        let (Some(&corners), Some(cell)) = (self.triangles.get(i), self.cells.get(i)) else { return false };
        if !(cell.area > 0.0) {
            return false;
        }
        let mut some = false;
        for side in 0..3 {
            let edge = [corners[side] as usize, corners[(side + 1) % 3] as usize];
            some |= self.shorten_edge(edge, |this| this.cells.get(i).map_or(0.0, |cell| cell.rest(side)), bodies);
        }
        some
    }

    fn shorten_edge(&mut self, [a, b]: [usize; 2], rest: impl Fn(&Self) -> f32, bodies: &Bodies<'_>) -> bool {
        let Vectors { rows, weight, shift, p: solved, .. } = &self.vectors;
        let (Some(&first), Some(&second)) = (rows.get(a), rows.get(b)) else { return false };
        let ease = weight[a] + weight[b];
        if first == NOBODY || second == NOBODY || !(ease > 0.0) {
            return false;
        }
        let between = |of: &[Vec3]| of[second as usize] - of[first as usize];
        let way = between(bodies.position);
        let now = way + (shift[b] - shift[a]);
        let before = between(bodies.before[0]);
        let far = length(now);
        let meant = length(way) + before.dot(solved[b] - solved[a]) / length(before);
        if !(far > meant * (1.0 + SLACK)) {
            return false;
        }
        let most = max(meant, rest(self));
        if !(far > most * (1.0 + SLACK)) {
            return false;
        }
        let by = now * ((far - most) / (far * ease));
        let Vectors { weight, shift, .. } = &mut self.vectors;
        shift[a] += by * weight[a];
        shift[b] -= by * weight[b];
        true
    }
}

impl Cell {
    /// The length of one of its edges at rest.
    fn rest(&self, side: usize) -> f32 {
        let [a, b, c, d] = self.inverse;
        let twice = 2.0 * self.area;
        let (e, f) = ([d * twice, -b * twice], [-c * twice, a * twice]);
        let [x, y] = match side {
            0 => e,
            1 => [f[0] - e[0], f[1] - e[1]],
            _ => f,
        };
        sqrt(x * x + y * y)
    }
}
