//! The forces of a shell where the method has moved it, and the directions in which they act, eight triangles or folds side by side: by the
//! operations of one, in their order, so that the bits are the same.

use super::corners::{add_all, add_pair};
use super::eights::{WIDE, all_corners, at_rest, column, eight, eight_mut, gathered, vector};
use super::fold::{Fold, RestFold, TOGETHER, curve, moment};
use super::membrane::{Cell, Strain};
use super::resist::{columns, spread};
use super::solver::{Solver, Vectors as Columns};
use super::step::Step;
use super::{Bodies, ShellParams};
use crate::constrain::rate::{all_braked_from, braked_from};
use crate::lanes::{self, Eight, Kernel, LANES, Vectors};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use glam::Vec3;

/// Makes all strains and folds, and adds their forces × h² to the residuals. Where particles are, how fast they go and where they were left is found in
/// the first directions, what comes of these, and the shifts, which nobody needs yet; what is not there is no number.
pub(super) struct Linearise<'a, 'm> {
    pub(super) solver: &'a mut Solver<'m>,
}

impl Solver<'_> {
    /// The forces where all are, and the directions in which they act.
    pub(super) fn linearise(&mut self, bodies: &Bodies<'_>) {
        let columns = [&*bodies.position, &*bodies.velocity, bodies.before[0]];
        let Columns { rows, shift, p, q, .. } = &mut self.vectors;
        let own = [&mut **p, &mut **q, &mut **shift];
        for (to, column) in own.into_iter().zip(columns) {
            for (to, &row) in to.iter_mut().zip(&**rows) {
                *to = column.get(row as usize).copied().unwrap_or(Vec3::NAN);
            }
        }
        lanes::run(Linearise { solver: self });
        self.vectors.shift.fill(Vec3::ZERO);
    }

    /// Takes forces anew where all have been moved who need another step of Newton's method, and walls as pressing none of these yet. The shift of whoever is
    /// done is no number.
    pub(super) fn go_on_from(&mut self, bodies: &Bodies<'_>) {
        let Columns { weight, r, met, pressing, .. } = &mut self.vectors;
        for (i, r) in r.iter_mut().enumerate() {
            *r = Vec3::ZERO;
            if pressing[i] == 1 && weight[i] > 0.0 {
                let braked = self.walls.get_mut(i).map_or(Vec3::ZERO, |wall| wall.begin_again(bodies));
                *r = -met[i] / weight[i] - braked;
            }
        }
        self.linearise(bodies);
        let Columns { r, shift, pressing, .. } = &mut self.vectors;
        for ((r, shift), &needs) in r.iter_mut().zip(&mut **shift).zip(&**pressing) {
            (*r, *shift) = if needs == 1 { (*r, Vec3::ZERO) } else { (Vec3::ZERO, Vec3::NAN) };
        }
        self.list_walls();
    }

    /// Takes forces anew where all have been moved, along the directions of the beginning: what is left to ask for, and no shift. What they have been moved
    /// by is put where they went last.
    pub(super) fn ask_again(&mut self, bodies: &Bodies<'_>) {
        let h = self.step.h;
        core::mem::swap(&mut self.vectors.shift, &mut self.last);
        let Columns { rows, weight, shift: begun, r, p, q, .. } = &mut self.vectors;
        for (i, (&row, &shift)) in rows.iter().zip(&*self.last).enumerate() {
            let at = |column: &[Vec3]| column.get(row as usize).copied().unwrap_or(Vec3::NAN);
            (p[i], q[i], begun[i]) =
                (at(bodies.position) + shift, at(bodies.velocity) + shift / h, at(bodies.before[0]));
            r[i] = if weight[i] > 0.0 { -shift / weight[i] } else { Vec3::ZERO };
        }
        lanes::run(Linearise { solver: self });
        self.vectors.shift.fill(Vec3::ZERO);
    }
}

impl Kernel for Linearise<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        let (triangles, hinges) = (self.solver.triangles.len(), self.solver.hinges.len());
        for first in (0..triangles).step_by(LANES) {
            if !(WIDE && self.strain_eight(like, first)) {
                (first..triangles.min(first + LANES)).for_each(|i| self.strain(i));
            }
        }
        for first in (0..hinges).step_by(LANES) {
            if !(WIDE && self.fold_eight(like, first)) {
                (first..hinges.min(first + LANES)).for_each(|i| self.fold(i));
            }
        }
        for first in (0..hinges).step_by(LANES) {
            if !(WIDE && self.open_eight(like, first)) {
                (first..hinges.min(first + LANES)).for_each(|i| self.open(i));
            }
        }
        let vectors = &mut self.solver.vectors;
        for (r, &weight) in vectors.r.iter_mut().zip(&*vectors.weight) {
            *r = if weight > 0.0 { *r } else { Vec3::ZERO };
        }
    }
}

impl Linearise<'_, '_> {
    /// Where all are, how fast they go, and where they were.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn columns(&self) -> [&[Vec3]; 3] {
        let Columns { shift, p, q, .. } = &self.solver.vectors;
        [p, q, shift]
    }

    /// From one particle to others: now, along what forces act, and as it was.
    #[cfg_attr(not(one_by_one), inline(always))]
    fn ways<const N: usize>(&self, from: usize, to: [usize; N]) -> [[Vec3; N]; 3] {
        let ([x, v, x0], left, h) = (self.columns(), &*self.solver.left, self.solver.step.h);
        let between = |column: &[Vec3]| to.map(|to| column[to] - column[from]);
        let (now, speed, mut before) = (between(x), between(v), between(x0));
        if !left.is_empty() {
            before = braked_from(before, between(left));
        }
        [now, core::array::from_fn(|i| now[i] - speed[i] * h), before]
    }

    fn strain(&mut self, i: usize) {
        let (Some(&corners), Some(cell)) = (self.solver.triangles.get(i), self.solver.cells.get(i)) else { return };
        let mut strain = Strain::NONE;
        if self.solver.vectors.living(corners).is_some() {
            let [a, b, c] = corners.map(|corner| corner as usize);
            let (now, push) = Strain::of(cell, self.solver.params, &self.solver.step, self.ways(a, [b, c]));
            strain = now;
            add_pair(self.solver.vectors.r, corners, push);
        }
        if let Some(to) = self.solver.strains.get_mut(i) {
            *to = strain;
        }
    }

    fn fold(&mut self, i: usize) {
        let (Some(hinge), Some(bend)) = (self.solver.hinges.get(i), self.solver.bends.get(i)) else { return };
        let mut fold = Fold::NONE;
        if self.solver.vectors.living(hinge.corners()).is_some() {
            let [a, b, c, d] = hinge.corners().map(|corner| corner as usize);
            let (now, open) = Fold::of(bend, &self.solver.step, self.ways(a, [b, c, d]));
            fold = now;
            curve(self.solver.strains, hinge, bend, open);
        }
        if let Some(to) = self.solver.folds.get_mut(i) {
            *to = fold;
        }
    }

    fn open(&mut self, i: usize) {
        let Solver { hinges, bends, cells, ref strains, .. } = *self.solver;
        let bending = self.solver.bending();
        let (Some(hinge), Some(bend), Some(fold)) = (hinges.get(i), bends.get(i), self.solver.folds.get_mut(i)) else {
            return;
        };
        let moment = moment(strains, cells, hinge, bend, bending);
        *fold = fold.with_moment(moment);
        let fold = *fold;
        add_all(self.solver.vectors.r, hinge.corners(), fold.forces(-moment));
        if self.solver.thin {
            let stiffness = self.solver.step.rate * bending * bend.stiffness(hinge.faces.map(|face| area(cells, face)));
            let excess = stiffness * fold.excess(bend);
            let held = [0, 1].map(|side| fold.held(side, [excess, stiffness * fold.slip(bend, side)]));
            self.solver.hold(hinge, held);
        }
    }

    /// Ways from the first corners of eight to the others, as [`Linearise::ways`].
    #[inline(always)]
    fn ways_of<F: Eight, const N: usize>(&self, like: F, corners: &[[u32; N]; LANES]) -> Option<[[Vectors<F>; N]; 3]> {
        let ([x, v, x0], h) = (self.columns(), like.all(self.solver.step.h));
        let mut now = gathered::<F, N>(like, x, corners)?;
        let (mut speed, mut before) = (gathered::<F, N>(like, v, corners)?, gathered::<F, N>(like, x0, corners)?);
        for column in [&mut now, &mut speed, &mut before] {
            from_first(column);
        }
        if !self.solver.left.is_empty() {
            let mut left = gathered::<F, N>(like, self.solver.left, corners)?;
            from_first(&mut left);
            before = all_braked_from(like, before, left);
        }
        let mut along = now;
        for ((along, &now), &speed) in along.iter_mut().zip(&now).zip(&speed) {
            *along = now - speed * h;
        }
        Some([now, along, before])
    }

    /// Tells whether it has done so, as all that go over eight.
    #[inline(always)]
    fn strain_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(corners), Some(cells)) = (eight(self.solver.triangles, first), eight(self.solver.cells, first))
        else {
            return false;
        };
        let Some(ways) = self.ways_of(like, corners) else { return false };
        let Some(strains) = eight_mut(self.solver.strains, first) else { return false };
        let (inverse, area) = at_rest(like, cells);
        let (along, tension, push, sound) = strain_of(like, self.solver.params, &self.solver.step, area, inverse, ways);
        let (u, v, tension) = (along[0].rows(), along[1].rows(), tension.to_array());
        let (f, g) = (push[0].rows(), push[1].rows());
        for (i, strain) in strains.iter_mut().enumerate() {
            let sound = sound & 1 << i != 0;
            let along = [vector(u[i]), vector(v[i])];
            *strain = if sound { Strain { along, tension: tension[i], ..Strain::NONE } } else { Strain::NONE };
            let push = if sound { [vector(f[i]), vector(g[i])] } else { [Vec3::ZERO; 2] };
            add_pair(self.solver.vectors.r, corners[i], push);
        }
        true
    }

    #[inline(always)]
    fn fold_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(hinges), Some(bends)) = (eight(self.solver.hinges, first), eight(self.solver.bends, first)) else {
            return false;
        };
        let Some(ways) = self.ways_of(like, &all_corners(hinges)) else { return false };
        let Some(folds) = eight_mut(self.solver.folds, first) else { return false };
        let rest = [column!(like, bends, |bend| bend.angle), column!(like, bends, |bend| bend.most)];
        let (slope, foot, open, sound) = fold_of(like, &self.solver.step, rest, ways);
        let (m, n) = (slope[0].rows(), slope[1].rows());
        let (x, y, open) = (foot[0].to_array(), foot[1].to_array(), open.to_array());
        for i in 0..LANES {
            let acts = bends[i].acts() && sound & 1 << i != 0;
            let fold = Fold { slope: [vector(m[i]), vector(n[i])], foot: [x[i], y[i]], moment: 0.0 };
            folds[i] = if acts { fold } else { Fold::NONE };
            curve(self.solver.strains, &hinges[i], &bends[i], if acts { open[i] } else { 0.0 });
        }
        true
    }

    #[inline(always)]
    fn open_eight<F: Eight>(&mut self, like: F, first: usize) -> bool {
        let (Some(hinges), Some(bends)) = (eight(self.solver.hinges, first), eight(self.solver.bends, first)) else {
            return false;
        };
        let (bending, cells) = (self.solver.bending(), self.solver.cells);
        let mut moments = [0.0; LANES];
        for (i, sum) in moments.iter_mut().enumerate() {
            *sum = moment(self.solver.strains, cells, &hinges[i], &bends[i], bending);
        }
        let Some(folds) = eight_mut(self.solver.folds, first) else { return false };
        for (fold, &moment) in folds.iter_mut().zip(&moments) {
            *fold = fold.with_moment(moment);
        }
        let folds = &*folds;
        let ((foot, slope), moments) = (columns(like, folds), like.of(moments));
        let against = lanes::negated(moments);
        let [a, b, c, d] = spread([slope[0] * against, slope[1] * against], foot, like.all(1.0));
        let [a, b, c, d] = [a.rows(), b.rows(), c.rows(), d.rows()];
        for (i, hinge) in hinges.iter().enumerate() {
            add_all(self.solver.vectors.r, hinge.corners(), [vector(a[i]), vector(b[i]), vector(c[i]), vector(d[i])]);
        }
        if self.solver.thin {
            let mut stiffness = [0.0; LANES];
            for ((to, hinge), bend) in stiffness.iter_mut().zip(hinges).zip(bends) {
                let areas = [area(cells, hinge.faces[0]), area(cells, hinge.faces[1])];
                *to = self.solver.step.rate * bending * bend.stiffness(areas);
            }
            let held = held_of(like, bends, (foot, slope), moments.abs(), like.of(stiffness));
            let [[a, b, c], [d, e, f]] = held;
            let arrays = [a.to_array(), b.to_array(), c.to_array(), d.to_array(), e.to_array(), f.to_array()];
            for (i, hinge) in hinges.iter().enumerate() {
                let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(
                    #[inline(always)]
                    |of: usize| arrays[of][i],
                );
                self.solver.hold(hinge, [[a, b, c], [d, e, f]]);
            }
        }
        true
    }
}

/// Makes places ways from the first.
#[inline(always)]
fn from_first<F: Eight>(places: &mut [Vectors<F>]) {
    let first = places[0];
    for place in places {
        *place = *place - first;
    }
}

/// The area of a triangle at rest \[m²\].
#[cfg_attr(not(one_by_one), inline(always))]
fn area(cells: &[Cell], face: u32) -> f32 {
    cells.get(face as usize).map_or(0.0, |cell| cell.area)
}

/// As [`Fold::held`] for both sides, with what the matrix of bending lacks.
#[inline(always)]
fn held_of<F: Eight>(
    like: F,
    bends: &[RestFold; LANES],
    ([x, y], [m, n]): ([F; 2], [Vectors<F>; 2]),
    moment: F,
    stiffness: F,
) -> [[F; 3]; 2] {
    let (zero, one, few) = (like.all(0.0), like.all(1.0), like.all(TOGETHER));
    let (a, b) = (m.dot(m), n.dot(n));
    let sharp = lanes::min(lanes::max(one - m.dot(n) / (a * b).sqrt(), zero), like.all(2.0));
    let steep = [column!(like, bends, |bend| bend.steep(0)), column!(like, bends, |bend| bend.steep(1))];
    let narrow = lanes::max(a / steep[0], b / steep[1]) - one;
    let excess = stiffness * (few * (sharp + lanes::max(narrow, zero)));
    let (p, q) = (x - column!(like, bends, |bend| bend.foot[0]), y - column!(like, bends, |bend| bend.foot[1]));
    let slips = [stiffness * (few * (p * p)), stiffness * (few * (q * q))];
    let hold = like.all(0.25) * moment + excess;
    let (first, second) = (hold * a, hold * b);
    [
        [x * (one - x) * first - slips[0] * a, lanes::negated((one - x) * first), lanes::negated(x * first)],
        [y * (one - y) * second - slips[1] * b, lanes::negated((one - y) * second), lanes::negated(y * second)],
    ]
}

/// As [`Strain::of`]: warp and weft, tension, the push, and a bit for each of eight that is sound.
#[inline(always)]
fn strain_of<F: Eight>(
    like: F,
    params: &ShellParams,
    step: &Step,
    area: F,
    [a, b, c, d]: [F; 4],
    [now, along, before]: [[Vectors<F>; 3]; 3],
) -> ([Vectors<F>; 2], F, [Vectors<F>; 2], u32) {
    let inverse = [a, b, c, d];
    let (half, zero) = (like.all(0.5), like.all(0.0));
    let (strain, earlier) = (green(like, deform(inverse, now)), green(like, deform(inverse, before)));
    let [u, v] = deform(inverse, along);
    let mut felt_as = strain;
    for (felt_as, before) in felt_as.iter_mut().zip(earlier) {
        *felt_as = felt(like, step, *felt_as, before);
    }
    let [warp, weft, shear] = stress(params, area * like.all(step.h * step.h), felt_as);
    let (p, q) = (u * warp + v * shear, v * weft + u * shear);
    let push = [-(p * a + q * c), -(p * b + q * d)];
    let [x, y, z] = stress(params, area, strain);
    let (differ, mean) = (half * (x - y), half * (x + y));
    let tension = lanes::max(mean + (differ * differ + z * z).sqrt(), zero) / area;
    let most = like.all(f32::INFINITY);
    let sound = area.simd_gt(zero) & tension.simd_lt(most) & is_finite(push[0]) & is_finite(push[1]);
    ([u, v], tension, push, sound.to_bitmask())
}

#[inline(always)]
pub(super) fn deform<F: Eight>([a, b, c, d]: [F; 4], [_, e, f]: [Vectors<F>; 3]) -> [Vectors<F>; 2] {
    [e * a + f * b, e * c + f * d]
}

#[inline(always)]
pub(super) fn green<F: Eight>(like: F, [u, v]: [Vectors<F>; 2]) -> [F; 3] {
    let (half, one) = (like.all(0.5), like.all(1.0));
    [half * (u.dot(u) - one), half * (v.dot(v) - one), u.dot(v)]
}

/// Stresses × `scale`, an area by which they act.
#[inline(always)]
pub(super) fn stress<F: Eight>(params: &ShellParams, scale: F, [warp, weft, shear]: [F; 3]) -> [F; 3] {
    let [first, second] = params.stretch;
    [scale * scale.all(first) * warp, scale * scale.all(second) * weft, scale * scale.all(params.shear) * shear]
}

/// As [`Fold::of`]: the slopes, the feet, how far open it is, and a bit for each of eight that is sound.
#[inline(always)]
fn fold_of<F: Eight>(
    like: F,
    step: &Step,
    [rest, most]: [F; 2],
    [now, along, before]: [[Vectors<F>; 4]; 3],
) -> ([Vectors<F>; 2], [F; 2], F, u32) {
    let [_, e, f, g] = along;
    let edge = e.length();
    let [m, n] = normals(along);
    let slope = [m * (edge / m.dot(m)), n * (edge / n.dot(n))];
    let foot = [f.dot(e) / (edge * edge), g.dot(e) / (edge * edge)];
    let acting = lanes::min(most / fastest(like, slope, foot), like.all(1.0));
    let slope = slope.map(
        #[inline(always)]
        |slope| slope * acting,
    );
    let angle = fold_angle(like, now);
    let mut open = turn(like, angle - rest);
    if step.lag > 0.0 {
        open = felt(like, step, open, open - turn(like, angle - fold_angle(like, before)));
    }
    open = open * acting;
    let most = like.all(f32::INFINITY);
    let feet = foot[0].abs().simd_lt(most) & foot[1].abs().simd_lt(most);
    let sound = is_finite(slope[0]) & is_finite(slope[1]) & feet & open.abs().simd_lt(most);
    (slope, foot, open, sound.to_bitmask())
}

/// As [`Step::felt`].
#[inline(always)]
fn felt<F: Eight>(like: F, step: &Step, now: F, before: F) -> F {
    now + like.all(step.lag / step.h) * (now - before)
}

#[inline(always)]
fn normals<F: Eight>([_, e, f, g]: [Vectors<F>; 4]) -> [Vectors<F>; 2] {
    [e.cross(f), g.cross(e)]
}

#[inline(always)]
fn fold_angle<F: Eight>(like: F, ways: [Vectors<F>; 4]) -> F {
    let [m, n] = normals(ways);
    let (m, n) = (m / m.length(), n / n.length());
    angle(like, m.dot(n), n.cross(m).dot(ways[1]) / ways[1].length())
}

#[inline(always)]
fn fastest<F: Eight>(like: F, slope: [Vectors<F>; 2], foot: [F; 2]) -> F {
    let one = like.all(1.0);
    let [a, b] = [0, 1].map(
        #[inline(always)]
        |side| {
            let (x, y) = (foot[side], one - foot[side]);
            slope[side].dot(slope[side]) * lanes::max(lanes::max(x * x, y * y), one)
        },
    );
    lanes::max(a, b)
}

#[inline(always)]
fn turn<F: Eight>(like: F, angle: F) -> F {
    let (half, whole) = (like.all(PI), like.all(TAU));
    let up = angle.simd_lt(like.all(-PI)).select(angle + whole, angle);
    angle.simd_gt(half).select(angle - whole, up)
}

#[inline(always)]
fn is_finite<F: Eight>(v: Vectors<F>) -> F {
    let [x, y, z] = v.0;
    let most = x.all(f32::INFINITY);
    x.abs().simd_lt(most) & y.abs().simd_lt(most) & z.abs().simd_lt(most)
}

/// As [`crate::math::angle`].
#[inline(always)]
fn angle<F: Eight>(like: F, x: F, y: F) -> F {
    let (one, zero) = (like.all(1.0), like.all(0.0));
    let (wide, high) = (x.abs(), y.abs());
    let steep = high.simd_gt(wide);
    let (less, more) = (steep.select(wide, high), steep.select(high, wide));
    let slope = less / more;
    let far = slope.simd_gt(like.all(0.414_213_56));
    let start = far.select(like.all(FRAC_PI_4), zero);
    let t = far.select((slope - one) / (slope + one), slope);
    let z = t * t;
    let series = like.all(-0.138_776_86) + z * like.all(0.080_537_44);
    let series = like.all(-0.333_329_5) + z * (like.all(0.199_777_1) + z * series);
    let eighth = start + (t + t * z * series);
    let quarter = steep.select(like.all(FRAC_PI_2) - eighth, eighth);
    let half = x.simd_lt(zero).select(like.all(PI) - quarter, quarter);
    more.simd_gt(zero).select(y.simd_lt(zero).select(lanes::negated(half), half), zero)
}
