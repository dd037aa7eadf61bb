//! Triangles: their strains, and how each is held.

use crate::constrain::Bodies;
use crate::constrain::thread::warp_and_weft;
use crate::math::{dot, largest, length, max, min, sqrt};
use glam::Vec3;

/// The cosine of how far a triangle may turn: by 60°.
const COSINE: f32 = 0.5;

/// The share of its length at rest below which warp or weft is crushed: it then shears the more freely, the shorter it is.
const CRUSHED: f32 = 0.25;

/// How far a strain may be beyond its limit.
pub(super) const NEARLY: f32 = 1e-4;

/// What is kept of a triangle.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Cell {
    /// The inverse of its edges at rest in coordinates along warp and weft, by columns \[1/m\].
    pub(super) inverse: [f32; 4],
    /// Its area at rest \[m²\]; zero: it does nothing.
    pub(super) area: f32,
    /// The stress × area × h² in it along warp, weft and between them in the last sub-step, below zero where it pulls \[kg m²\].
    pub(super) stress: [f32; 3],
    /// Its strains as the last sub-step left them, and how far others have taken it beyond its limits since, as far as that has not been given back:
    /// below zero, if beyond the lower ones.
    pub(super) left: [f32; 3],
    pub(super) owed: [f32; 3],
}

/// A triangle before.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Past {
    /// Warp and weft as the sub-step began.
    pub(super) then: [Vec3; 2],
    /// Its stress before the last round, and in which direction that has gone on.
    pub(super) stress: [f32; 3],
    pub(super) direction: [f32; 3],
}

impl Past {
    pub(super) const NONE: Self = Self { then: [Vec3::ZERO; 2], stress: [0.0; 3], direction: [0.0; 3] };
}

impl Cell {
    /// A triangle at rest with these edges from its first corner.
    pub(super) fn at_rest([e, f]: [Vec3; 2], warp: Vec3) -> Self {
        const NONE: Cell =
            Cell { inverse: [0.0; 4], area: 0.0, stress: [0.0; 3], left: [1.0, 1.0, 0.0], owed: [0.0; 3] };
        let Some([u, v]) = warp_and_weft([e, f], warp) else { return NONE };
        let twice = length(e.cross(f));
        let [a, b] = [e, f].map(|edge| [dot(edge, u), dot(edge, v)]);
        let inverse = [b[1], -a[1], -b[0], a[0]].map(|x| x / twice);
        let is_sound = inverse.iter().all(|x| x.is_finite());
        if is_sound { Self { inverse, area: 0.5 * twice, ..NONE } } else { NONE }
    }

    /// What warp and weft have become where the edges are these.
    pub(super) fn deform(&self, [e, f]: [Vec3; 2]) -> [Vec3; 2] {
        let [a, b, c, d] = self.inverse;
        [e * a + f * b, e * c + f * d]
    }

    /// Notes how far others have taken it beyond its limits since it was left, where its edges are these.
    pub(super) fn owe(&mut self, edges: [Vec3; 2], ranges: [[f32; 2]; 3]) {
        let threads = self.deform(edges);
        for (kind, [low, high]) in ranges.into_iter().enumerate() {
            let value = strain(kind, threads).map_or(0.0, |(value, _)| value);
            let (beyond, left) = (excess(value, [low, high]), self.left[kind]);
            let more = excess(value, [min(low, left), max(high, left)]);
            let owed = self.owed[kind] + if more.abs() > NEARLY { more } else { 0.0 };
            // No more than it is beyond them.
            self.owed[kind] = if owed * beyond > 0.0 { max(min(owed, beyond.abs()), -beyond.abs()) } else { 0.0 };
        }
    }

    /// Notes how it is left.
    pub(super) fn leave(&mut self, edges: [Vec3; 2]) {
        let threads = self.deform(edges);
        self.left = [0, 1, 2].map(|kind| strain(kind, threads).map_or(0.0, |(value, _)| value));
    }

    /// A range, and a `share` of what it is beyond that by others.
    pub(super) fn wider(&self, kind: usize, [low, high]: [f32; 2], share: f32) -> [f32; 2] {
        let owed = share * self.owed[kind];
        [low + min(owed, 0.0), high + max(owed, 0.0)]
    }

    /// The slopes by the corners of what has these by warp and weft.
    fn slopes(&self, [p, q]: [Vec3; 2]) -> [Vec3; 3] {
        let [a, b, c, d] = self.inverse;
        let [second, third] = [p * a + q * c, p * b + q * d];
        [-(second + third), second, third]
    }

    /// The rounding of its strains, from where its corners are.
    fn rounding(&self, far: f32) -> f32 {
        let finest = self.inverse.iter().fold(0.0, |most, x| max(most, x.abs()));
        4.0 * f32::EPSILON * (1.0 + far * finest)
    }
}

/// The length of the warp or of the weft, or the sine of the angle of shear, and its slopes by warp and weft; none where it has none. What is
/// crushed to less than a part of its length counts as that long in the sine, whose slopes would have no bound.
fn strain(kind: usize, [u, v]: [Vec3; 2]) -> Option<(f32, [Vec3; 2])> {
    let [a, b] = [length(u), length(v)];
    let [along, across] = [u / a, v / b];
    let (value, slopes) = match kind {
        0 => (a, [along, Vec3::ZERO]),
        1 => (b, [Vec3::ZERO, across]),
        _ => {
            let [long, wide] = [max(a, CRUSHED), max(b, CRUSHED)];
            let [p, q] = [u / long, v / wide];
            let sine = dot(p, q);
            let slope = |other: Vec3, own: Vec3, far: f32| if far > CRUSHED { other - own * sine } else { other };
            (sine, [slope(q, p, a) / long, slope(p, q, b) / wide])
        }
    };
    slopes.iter().all(|slope| slope.is_finite()).then_some((value, slopes))
}

/// How far a strain is beyond a range: below zero, if below it.
fn excess(value: f32, [low, high]: [f32; 2]) -> f32 {
    min(value - low, 0.0) + max(value - high, 0.0)
}

/// The multiplier with which a strain is within its range, pulling alone at the upper end and pushing alone at the lower; `soft` is the
/// compliance for it, and `weight` what it moves by.
fn held(value: f32, [low, high]: [f32; 2], before: f32, weight: f32, soft: f32) -> f32 {
    let free = |limit: f32| before - (value - limit + soft * before) / (weight + soft);
    if before < 0.0 || before == 0.0 && value > high {
        min(free(high), 0.0)
    } else if before > 0.0 || value < low {
        max(free(low), 0.0)
    } else {
        0.0
    }
}

/// A triangle in a sub-step.
pub(super) struct Held<'m> {
    pub(super) rows: [usize; 3],
    pub(super) cell: &'m mut Cell,
    /// Warp and weft as the sub-step began.
    pub(super) then: [Vec3; 2],
    /// The kinetic energy that has come of what it has done \[J\].
    pub(super) gain: f32,
}

impl<'m> Held<'m> {
    pub(super) fn new(rows: [usize; 3], cell: &'m mut Cell, then: [Vec3; 2]) -> Self {
        Self { rows, cell, then, gain: 0.0 }
    }
}

impl Held<'_> {
    pub(super) fn edges(&self, x: &[Vec3]) -> [Vec3; 2] {
        let [a, b, c] = self.rows;
        [x[b] - x[a], x[c] - x[a]]
    }

    /// A strain, the slopes by the corners along which it acts, and by how much it changes for what acts along them; none where nothing moves.
    pub(super) fn line(&self, bodies: &Bodies<'_>, kind: usize) -> Option<(f32, [Vec3; 3], f32)> {
        let (value, slopes) = strain(kind, self.cell.deform(self.edges(bodies.position)))?;
        let now = self.cell.slopes(slopes);
        let by = |a: &[Vec3; 3], b: &[Vec3; 3]| {
            let each = |i: usize| bodies.inverse_mass[self.rows[i]] * dot(a[i], b[i]);
            each(0) + each(1) + each(2)
        };
        let plain = by(&now, &now);
        let first = strain(kind, self.then).map(|(_, slopes)| self.cell.slopes(slopes));
        let first = first.map(|first| (by(&now, &first), by(&first, &first), first));
        let turned = first.filter(|&(mixed, other, _)| mixed > COSINE * sqrt(plain) * sqrt(other));
        let (weight, slopes) = turned.map_or((plain, now), |(mixed, _, first)| (mixed, first));
        (weight > 0.0 && weight < f32::INFINITY).then_some((value, slopes, weight))
    }

    /// Moves its corners by a change of a multiplier.
    pub(super) fn act(&mut self, bodies: &mut Bodies<'_>, slopes: [Vec3; 3], change: f32) {
        let rate = 1.0 / bodies.substep.seconds();
        for (row, slope) in self.rows.into_iter().zip(slopes) {
            let weight = bodies.inverse_mass[row];
            if weight > 0.0 {
                let impulse = slope * (change * rate);
                self.gain += dot(bodies.velocity[row] + impulse * (0.5 * weight), impulse);
                bodies.shift(row, slope * (weight * change));
            }
        }
    }

    /// Calls for the impulses on its corners that its stresses are.
    pub(super) fn impulses(&self, bodies: &mut Bodies<'_>, then: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3)) {
        let rate = 1.0 / bodies.substep.seconds();
        for kind in (0..3).filter(|&kind| self.cell.stress[kind] != 0.0) {
            let Some((_, slopes, _)) = self.line(bodies, kind) else { continue };
            for (row, slope) in self.rows.into_iter().zip(slopes).filter(|&(row, _)| bodies.inverse_mass[row] > 0.0) {
                then(bodies, row, slope * (self.cell.stress[kind] * rate));
            }
        }
    }

    /// Moves its corners alone, to where a strain is within a range.
    pub(super) fn bring_back(&self, bodies: &mut Bodies<'_>, kind: usize, range: [f32; 2]) {
        let Some((value, slopes, weight)) = self.line(bodies, kind) else { return };
        let change = -excess(value, range) / weight;
        if change == 0.0 || !change.is_finite() {
            return;
        }
        for (row, slope) in self.rows.into_iter().zip(slopes) {
            bodies.position[row] += slope * (bodies.inverse_mass[row] * change);
        }
    }

    /// Adds to one of its stresses.
    pub(super) fn press(&mut self, bodies: &mut Bodies<'_>, kind: usize, change: f32) {
        if change == 0.0 || !change.is_finite() {
            return;
        }
        if let Some((_, slopes, _)) = self.line(bodies, kind) {
            self.act(bodies, slopes, change);
            self.cell.stress[kind] += change;
        }
    }

    /// Holds one of its strains within its range. Tells how far it was beyond what its stress answers for.
    pub(super) fn hold(&mut self, bodies: &mut Bodies<'_>, kind: usize, range: [f32; 2], soft: f32) -> f32 {
        let Some((value, slopes, weight)) = self.line(bodies, kind) else { return 0.0 };
        let before = self.cell.stress[kind];
        let after = held(value, range, before, weight, soft / self.cell.area);
        let change = after - before;
        if change == 0.0 || !change.is_finite() {
            return 0.0;
        }
        self.act(bodies, slopes, change);
        self.cell.stress[kind] = after;
        let far = self.rows.iter().fold(0.0, |most, &row| max(most, largest(bodies.position[row])));
        max((change * weight).abs() - self.cell.rounding(far), 0.0)
    }
}
