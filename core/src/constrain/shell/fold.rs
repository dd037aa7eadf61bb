//! Bending of triangles about their common edges.

use super::membrane::{Cell, Strain};
use super::step::Step;
use crate::cloth::Hinge;
use crate::constrain::thread::warp_and_weft;
use crate::math::{angle, dot, length, max, min, sqrt};
use core::f32::consts::{PI, TAU};
use glam::Vec3;

/// The folds of a triangle.
pub(super) const TOGETHER: f32 = 3.0;
/// So many times as fast as at rest, for each metre that a corner goes, an angle may change that acts in full: that of a triangle that collapses changes
/// without bound, and the less it can tell, the less it acts.
const STEEPER: f32 = 8.0;

/// A fold at rest.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct RestFold {
    /// The angle at rest \[rad\]; zero is flat.
    pub(super) angle: f32,
    /// The curvature of the triangle on each side for each radian of the angle: along warp, weft, and √2 times that between
    /// them \[1/m\]. Zero where the fold is degenerate.
    pub(super) curvature: [[f32; 3]; 2],
    /// How much more of the angle the second side takes than half: zero of two that are free; one or minus one where the first or the second is fixed.
    pub(super) aside: f32,
    /// The point of the edge beside the far corner of each, as a share of it.
    pub(super) foot: [f32; 2],
    /// The square of how fast the angle may change for each metre that a corner goes \[1/m²\]: where it is faster, the fold acts less.
    pub(super) most: f32,
}

/// A fold in a sub-step: how its angle changes as its corners move.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Fold {
    /// The change for each metre that the far corner of each triangle goes from the point of the edge beside it \[rad/m\].
    pub(super) slope: [Vec3; 2],
    /// How far along the edge these points are, as a share of it.
    pub(super) foot: [f32; 2],
    /// The moment in it × h², whatever its sign \[N m s²\].
    pub(super) moment: f32,
}

/// The normals of both triangles × twice the area, the edge from the first corner to the second and the ways from there to both far
/// corners being given.
#[cfg_attr(not(one_by_one), inline(always))]
fn normals([e, f, g]: [Vec3; 3]) -> [Vec3; 2] {
    [e.cross(f), g.cross(e)]
}

/// How the angle changes for each metre that each far corner goes from the edge.
#[cfg_attr(not(one_by_one), inline(always))]
fn slopes(ways: [Vec3; 3]) -> [Vec3; 2] {
    let edge = length(ways[0]);
    normals(ways).map(|normal| normal * (edge / dot(normal, normal)))
}

/// The angle of a fold, above zero where the far corners are on the side of the normals.
#[cfg_attr(not(one_by_one), inline(always))]
fn fold_angle(ways: [Vec3; 3]) -> f32 {
    let [m, n] = normals(ways).map(|normal| normal / length(normal));
    angle(dot(m, n), dot(n.cross(m), ways[0]) / length(ways[0]))
}

/// The square of how fast an angle changes for each metre that the corner goes for which that is fastest.
#[cfg_attr(not(one_by_one), inline(always))]
fn fastest(slope: [Vec3; 2], foot: [f32; 2]) -> f32 {
    let [a, b] = [0, 1].map(|side| {
        let (x, y) = (foot[side], 1.0 - foot[side]);
        dot(slope[side], slope[side]) * max(max(x * x, y * y), 1.0)
    });
    max(a, b)
}

/// An angle, by the nearer way round.
#[cfg_attr(not(one_by_one), inline(always))]
fn turn(angle: f32) -> f32 {
    if angle > PI {
        angle - TAU
    } else if angle < -PI {
        angle + TAU
    } else {
        angle
    }
}

impl RestFold {
    /// The fold with these ways from the first corner; `signs` say on which side each triangle's normal is, `fixed` whether all of it stays.
    ///
    /// A fold stands for how the halves beside it of both triangles bend. What is clamped bends on one side of its edge alone, and within that half by all
    /// of the angle.
    pub(super) fn at_rest(ways: [Vec3; 3], warp: Vec3, signs: [f32; 2], fixed: [bool; 2]) -> Self {
        let [e, f, g] = ways;
        let none = Self { angle: 0.0, curvature: [[0.0; 3]; 2], aside: 0.0, foot: [0.0; 2], most: 0.0 };
        let side = |far: Vec3, sign: f32| {
            let up = far - e * (dot(far, e) / dot(e, e));
            let height = length(up);
            let [u, v] = warp_and_weft([e, far], warp)?;
            let [x, y] = [dot(up, u) / height, dot(up, v) / height];
            Some([x * x, y * y, core::f32::consts::SQRT_2 * x * y].map(|part| sign * part / height))
        };
        let (Some(first), Some(second)) = (side(f, signs[0]), side(g, signs[1])) else { return none };
        let foot = [f, g].map(|far| dot(far, e) / dot(e, e));
        let most = STEEPER * STEEPER * fastest(slopes(ways), foot);
        let aside = if fixed[0] == fixed[1] { 0.0 } else { 2.0 * f32::from(fixed[0]) - 1.0 };
        let this = Self { angle: fold_angle(ways), curvature: [first, second], aside, foot, most };
        let numbers = this.curvature.iter().flatten().chain(&this.foot);
        let sound = this.angle.is_finite() && most.is_finite() && numbers.copied().all(f32::is_finite);
        if sound { this } else { none }
    }

    /// Tells whether it does anything.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn acts(&self) -> bool {
        self.curvature[0] != [0.0; 3]
    }

    /// The square of the curvature for each radian on a side \[1/m²\].
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn steep(&self, side: usize) -> f32 {
        let [a, b, c] = self.curvature[side];
        a * a + b * b + c * c
    }

    /// How much of the angle a side takes, in halves.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn share(&self, side: usize) -> f32 {
        if side == 0 { 1.0 - self.aside } else { 1.0 + self.aside }
    }

    /// How it resists a change of its angle where bending stiffness is one, by the areas of its triangles.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn stiffness(&self, areas: [f32; 2]) -> f32 {
        let [a, b] = [self.share(0), self.share(1)];
        areas[0] * (a * a * self.steep(0)) + areas[1] * (b * b * self.steep(1))
    }

    /// The larger of both.
    pub(super) fn steepness(&self) -> f32 {
        max(self.steep(0), self.steep(1))
    }

    /// Adds the curvature that a change of the angle makes to that of both triangles.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn curve(&self, side: usize, change: f32, curvature: &mut [f32; 3]) {
        let ([a, b, c], change) = (self.curvature[side], self.share(side) * change);
        curvature[0] += a * change;
        curvature[1] += b * change;
        curvature[2] += c * change;
    }

    /// The part that a triangle's curvature has in this fold's moment.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn moment(&self, side: usize, curvature: [f32; 3]) -> f32 {
        let [a, b, c] = self.curvature[side];
        self.share(side) * (a * curvature[0] + b * curvature[1] + c * curvature[2])
    }
}

impl Fold {
    pub(super) const NONE: Self = Self { slope: [Vec3::ZERO; 2], foot: [0.0; 2], moment: 0.0 };

    /// The fold with these ways now, along others, and as it was as the sub-step began; with its angle less that at rest, and what
    /// damping adds.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn of(bend: &RestFold, step: &Step, [now, along, before]: [[Vec3; 3]; 3]) -> (Self, f32) {
        let [e, f, g] = along;
        let (edge, slope) = (length(e), slopes(along));
        let foot = [dot(f, e), dot(g, e)].map(|along| along / (edge * edge));
        let acting = min(bend.most / fastest(slope, foot), 1.0);
        let this = Self { slope: slope.map(|slope| slope * acting), foot, moment: 0.0 };
        let angle = fold_angle(now);
        let open = turn(angle - bend.angle);
        let open = if step.lag > 0.0 { step.felt(open, open - turn(angle - fold_angle(before))) } else { open };
        let open = open * acting;
        if bend.acts() && this.is_finite() && open.is_finite() { (this, open) } else { (Self::NONE, 0.0) }
    }

    #[cfg_attr(not(one_by_one), inline(always))]
    fn is_finite(&self) -> bool {
        self.slope.iter().all(|slope| slope.is_finite()) && self.foot.iter().all(|foot| foot.is_finite())
    }

    /// The same, with a moment in it.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn with_moment(self, moment: f32) -> Self {
        Self { moment: moment.abs(), ..self }
    }

    /// How far the far corner of each side goes from the point of the edge beside it, where all four go so far.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn ways(&self, [a, b, c, d]: [Vec3; 4]) -> [Vec3; 2] {
        let [x, y] = self.foot;
        [c - a * (1.0 - x) - b * x, d - a * (1.0 - y) - b * y]
    }

    /// How the angle changes where its corners go so far.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn change(&self, corners: [Vec3; 4]) -> f32 {
        let [f, g] = self.ways(corners);
        dot(self.slope[0], f) + dot(self.slope[1], g)
    }

    /// The forces of a moment on its four corners, in the sense that opens it.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn forces(&self, moment: f32) -> [Vec3; 4] {
        self.spread([self.slope[0] * moment, self.slope[1] * moment])
    }

    /// The resistance × h² that moments turning with the triangles put up, as the tension of triangles does: an upper bound of
    /// a quarter of it.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn resist(&self, corners: [Vec3; 4]) -> [Vec3; 4] {
        let ([f, g], [m, n]) = (self.ways(corners), self.slope);
        self.spread([f * (0.25 * self.moment * dot(m, m)), g * (0.25 * self.moment * dot(n, n))])
    }

    /// The part of that which the corners on a side do to each other, and of what stiffness of its angle there is besides: those of the edge, the
    /// first of them and the far one, the second and that.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn held(&self, side: usize, [excess, slip]: [f32; 2]) -> [f32; 3] {
        let (x, slope) = (self.foot[side], self.slope[side]);
        let square = dot(slope, slope);
        let held = (0.25 * self.moment + excess) * square;
        [x * (1.0 - x) * held - slip * square, -(1.0 - x) * held, -x * held]
    }

    /// What the matrix of bending, which takes all normals for one and triangles for what they are at rest, may lack of its stiffness, as a share
    /// of that: its angle changes by m f + n g, and by ½ |m − n|² at the most of what f and g are alone where m and n are taken for one. The
    /// folds of a triangle act together.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn excess(&self, bend: &RestFold) -> f32 {
        let [m, n] = self.slope;
        let (a, b) = (dot(m, m), dot(n, n));
        // Of a fold that hardly acts rounding leaves no angle.
        let sharp = min(max(1.0 - dot(m, n) / sqrt(a * b), 0.0), 2.0);
        let narrow = max(a / bend.steep(0), b / bend.steep(1)) - 1.0;
        TOGETHER * (sharp + max(narrow, 0.0))
    }

    /// The same where the point beside a far corner has gone along the edge: for the way of the edge's corners from each other.
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(super) fn slip(&self, bend: &RestFold, side: usize) -> f32 {
        let slip = self.foot[side] - bend.foot[side];
        TOGETHER * (slip * slip)
    }

    /// Forces on both far corners, and against them on the edge.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn spread(&self, [c, d]: [Vec3; 2]) -> [Vec3; 4] {
        let [x, y] = self.foot;
        [-(c * (1.0 - x) + d * (1.0 - y)), -(c * x + d * y), c, d]
    }
}

/// Adds the curvature that a change of a fold's angle makes.
#[cfg_attr(not(one_by_one), inline(always))]
pub(super) fn curve(strains: &mut [Strain], hinge: &Hinge, bend: &RestFold, change: f32) {
    let [first, second] = hinge.faces;
    if let Some(strain) = strains.get_mut(first as usize) {
        bend.curve(0, change, &mut strain.curvature);
    }
    if let Some(strain) = strains.get_mut(second as usize) {
        bend.curve(1, change, &mut strain.curvature);
    }
}

/// The moment about an edge that the curvatures of its triangles make.
#[cfg_attr(not(one_by_one), inline(always))]
pub(super) fn moment(strains: &[Strain], cells: &[Cell], hinge: &Hinge, bend: &RestFold, bending: f32) -> f32 {
    let mut sum = 0.0;
    for (side, face) in hinge.faces.into_iter().enumerate() {
        if let (Some(strain), Some(cell)) = (strains.get(face as usize), cells.get(face as usize)) {
            sum += bend.moment(side, strain.curvature) * cell.area;
        }
    }
    sum * bending
}
