//! Strain in the plane of triangles.

use super::ShellParams;
use super::step::Step;
use crate::constrain::thread::warp_and_weft;
use crate::math::{dot, max, sqrt};
use glam::{Mat3, Vec3};

/// A triangle at rest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Cell {
    /// The inverse of its edges from the first corner in coordinates along warp and weft, by columns \[1/m\].
    pub(super) inverse: [f32; 4],
    /// Its area \[m²\].
    pub(super) area: f32,
}

/// A triangle in a sub-step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Strain {
    /// What warp and weft have become at the sub-step's beginning, for each metre of them.
    pub(super) along: [Vec3; 2],
    /// The largest pull in it, or zero where it is only pressed \[N/m\].
    pub(super) tension: f32,
    /// Its curvature, or the change of that: along warp, weft, and √2 times that between them \[1/m\].
    pub(super) curvature: [f32; 3],
    /// The tension that its folds hold along its edges × h²: from the first corner to the second, to the third, and back \[kg\]; once all
    /// is solved, how long these edges may be at the most \[m\].
    pub(super) held: [f32; 3],
}

impl Cell {
    pub(super) const NONE: Self = Self { inverse: [0.0; 4], area: 0.0 };

    pub(super) fn at_rest(edges: [Vec3; 2], warp: Vec3) -> Self {
        let Some([u, v]) = warp_and_weft(edges, warp) else { return Self::NONE };
        let [a, b] = edges.map(|edge| [dot(edge, u), dot(edge, v)]);
        let twice = a[0] * b[1] - b[0] * a[1];
        let inverse = [b[1], -a[1], -b[0], a[0]].map(|x| x / twice);
        let sound = twice > 0.0 && inverse.iter().all(|x| x.is_finite());
        if sound { Self { inverse, area: 0.5 * twice } } else { Self::NONE }
    }

    /// Its corners at rest along warp and weft, from the first \[m\].
    pub(super) fn places(&self) -> [[f32; 2]; 3] {
        let [a, b, c, d] = self.inverse;
        let twice = 2.0 * self.area;
        [[0.0; 2], [d * twice, -b * twice], [-c * twice, a * twice]]
    }

    /// The square of its longest edge in those of a square of twice its area; 2 for half a square.
    pub(super) fn slenderness(&self) -> f32 {
        let [a, b, c] = self.places();
        let square = |a: [f32; 2], b: [f32; 2]| (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
        max(max(square(a, b), square(b, c)), square(c, a)) / (2.0 * self.area)
    }

    /// What warp and weft become where the edges are these.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn deform(&self, [e, f]: [Vec3; 2]) -> [Vec3; 2] {
        let [a, b, c, d] = self.inverse;
        [e * a + f * b, e * c + f * d]
    }

    /// The energy of its strains where its edges are these \[J\].
    pub(super) fn energy(&self, params: &ShellParams, edges: [Vec3; 2]) -> f32 {
        let strain = green(self.deform(edges));
        let [warp, weft, shear] = self.stress(params, 1.0, strain);
        0.5 * (warp * strain[0] + weft * strain[1] + shear * strain[2])
    }

    /// The forces on the second and the third corner of the stresses along warp and weft; that on the first is against both.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn forces(&self, [p, q]: [Vec3; 2]) -> [Vec3; 2] {
        let [a, b, c, d] = self.inverse;
        [p * a + q * c, p * b + q * d]
    }

    /// Stresses × area × h² of strains along warp, weft, and of the angle between them.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn stress(&self, params: &ShellParams, h: f32, strain: [f32; 3]) -> [f32; 3] {
        let scale = self.area * (h * h);
        let [warp, weft] = params.stretch;
        [scale * warp * strain[0], scale * weft * strain[1], scale * params.shear * strain[2]]
    }
}

impl Strain {
    pub(super) const NONE: Self = Self { along: [Vec3::ZERO; 2], tension: 0.0, curvature: [0.0; 3], held: [0.0; 3] };

    /// The triangle with these edges now, along others, and as it was as the sub-step began; with the push × h² on its second and
    /// third corner.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn of(
        cell: &Cell,
        params: &ShellParams,
        step: &Step,
        [now, along, before]: [[Vec3; 2]; 3],
    ) -> (Self, [Vec3; 2]) {
        let (h, strain, earlier) = (step.h, green(cell.deform(now)), green(cell.deform(before)));
        let stress = cell.stress(params, 1.0, strain);
        let mut this = Self { along: cell.deform(along), ..Self::NONE };
        let total: [f32; 3] = core::array::from_fn(|i| step.felt(strain[i], earlier[i]));
        let push = this.push(cell, cell.stress(params, h, total)).map(|push| -push);
        // The larger eigenvalue of the stresses.
        let (half, mean) = (0.5 * (stress[0] - stress[1]), 0.5 * (stress[0] + stress[1]));
        this.tension = max(mean + sqrt(half * half + stress[2] * stress[2]), 0.0) / cell.area;
        let sound = cell.area > 0.0 && this.tension < f32::INFINITY && push.iter().all(|push| push.is_finite());
        if sound { (this, push) } else { (Self::NONE, [Vec3::ZERO; 2]) }
    }

    /// How strains change as warp and weft do, along the directions of the beginning.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn rate(&self, [du, dv]: [Vec3; 2]) -> [f32; 3] {
        let [u, v] = self.along;
        [dot(u, du), dot(v, dv), dot(u, dv) + dot(v, du)]
    }

    /// The forces of stresses on the second and the third corner, inward where it is stretched.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn push(&self, cell: &Cell, [warp, weft, shear]: [f32; 3]) -> [Vec3; 2] {
        let [u, v] = self.along;
        cell.forces([u * warp + v * shear, v * weft + u * shear])
    }

    /// The resistance × h² to a change of the edges, against it on the second and the third corner.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn resist(&self, cell: &Cell, params: &ShellParams, step: &Step, edges: [Vec3; 2]) -> [Vec3; 2] {
        let change = cell.deform(edges);
        let [warp, weft, shear] = cell.stress(params, step.h, self.rate(change));
        let [a, b] = self.push(cell, [warp * step.rate, weft * step.rate, shear * step.rate]);
        // What is tense swings to and fro across: a quarter of that keeps any step stable, and takes nothing from the motion
        // (Newmark's β = 1/4 for these forces).
        let taut = 0.25 * self.tension * cell.area * (step.h * step.h);
        let [c, d] = cell.forces([change[0] * taut, change[1] * taut]);
        [a + c, b + d]
    }

    /// How its corners resist each other × h²: the blocks of the first and the second, the second and the third, the third and the first.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn blocks(&self, cell: &Cell, params: &ShellParams, step: &Step) -> [Mat3; 3] {
        let [a, b, c, d] = cell.inverse;
        // What warp and weft gain as each corner goes.
        let gain = [[-(a + b), -(c + d)], [a, c], [b, d]];
        let [warp, weft, shear] = cell.stress(params, step.h, [step.rate; 3]);
        let taut = 0.25 * self.tension * cell.area * (step.h * step.h);
        let [u, v] = self.along;
        let mut blocks = [Mat3::ZERO; 3];
        for (i, block) in blocks.iter_mut().enumerate() {
            let j = (i + 1) % 3;
            let ([p, q], [r, s]) = (gain[i], gain[j]);
            let (uu, vv) = (warp * p * r + shear * q * s, weft * q * s + shear * p * r);
            // The block's rows are those of the first corner.
            let (uv, vu) = (shear * q * r, shear * p * s);
            let (first, second) = (u * uu + v * vu, u * uv + v * vv);
            let own = Mat3::from_diagonal(Vec3::splat(taut * (p * r + q * s) + self.held[i]));
            let [x, y, z] = [first * u.x + second * v.x, first * u.y + second * v.y, first * u.z + second * v.z];
            *block = Mat3::from_cols(x, y, z) + own;
        }
        blocks
    }
}

/// Green's strain along warp and weft, and twice that between them.
#[cfg_attr(not(one_by_one), inline(always))]
fn green([u, v]: [Vec3; 2]) -> [f32; 3] {
    [0.5 * (dot(u, u) - 1.0), 0.5 * (dot(v, v) - 1.0), dot(u, v)]
}
