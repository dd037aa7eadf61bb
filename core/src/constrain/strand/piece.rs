//! A strand in a sub-step: the equations of its places, its material's turns and what pulls, bends and twists it.

use super::band::Band;
use super::bounded::Purse;
use super::frame::{Edge, Spin, bring, gradients, strain};
use super::joint::{Begun, Joint};
use super::params::StrandParams;
use crate::constrain::Bodies;
use crate::constrain::turn::{Turn, outer, solve};
use crate::math::{clamp, dot, length, max};
use bytemuck::Pod;
use glam::{Mat3, Vec3};

/// The equations that each point brings: its place, the pull in the edge before it, the bending and twisting at it, and the turn of that
/// edge's material about itself.
///
/// In this order, from the tip to the root, what each equation is solved for is known from the material or from masses, and never from a
/// small difference: stiffness may be as high as one likes (Vanderbei, "Symmetric quasidefinite matrices", SIAM J. Optimization 5, 1995).
pub(super) const EQUATIONS: usize = 8;
pub(super) const PULL: usize = 3;
pub(super) const BEND: usize = 4;
pub(super) const TURN: usize = 7;

/// How firmly the material's turns are held, as a share of what resists twisting: all of a free strand's turning as one is undetermined.
const HOLD: f32 = 1e-4;
/// How far a stiff edge gives way, as a share of what its ends do: an edge between ends that are held is undetermined.
const RIDGE: f32 = 1e-6;
/// How far the material of an edge may turn in a solution \[rad\].
const FARTHEST: f32 = 1.0;
/// As good as nothing, and not zero.
const NOTHING: f32 = 1e-30;

/// A part of a strand whose points all live, by its place among them from the tip on.
#[derive(Clone, Copy, Default)]
pub(super) struct Piece {
    /// The first of its joints among all.
    pub(super) first: usize,
    /// The number of its points.
    pub(super) count: usize,
    /// True if its first and its last edge do not turn about themselves.
    pub(super) held: [bool; 2],
    /// How fast these are turned about themselves \[rad/s\], right-handed about their direction from the tip to the root, if they are held or clamped.
    pub(super) turning: [f32; 2],
    /// The number of its strand, if it is the whole of that.
    pub(super) whole: Option<usize>,
    /// True if some of its points are fixed.
    pub(super) is_held: bool,
    /// True if nothing holds it, and nothing turns its ends.
    pub(super) is_free: bool,
    /// True if something holds it that stands still, and nothing turns its ends.
    pub(super) is_hung: bool,
}

impl Piece {
    /// Tells whether something turns an end of it that is held.
    pub(super) fn is_turned(&self) -> bool {
        self.held.into_iter().zip(self.turning).any(|(is_held, rate)| is_held && rate != 0.0)
    }

    /// Tells whether what rounding leaves of the ways of its points is kept: something holds it, so that velocities tell where they are to be, and nothing
    /// turns its ends, which may be as fast as numbers go.
    pub(super) fn keeps_rounding(&self) -> bool {
        self.is_held && self.turning == [0.0; 2]
    }

    /// Tells whether nothing gives it energy or takes it but forces and itself.
    pub(super) fn is_left_alone(&self) -> bool {
        self.is_free || self.is_hung
    }

    /// What is kept of its strand, if it is left alone: of a part of one nothing is kept, which has words of its own while it is solved.
    pub(super) fn purse<'m>(&self, purses: &'m mut [u32], own: &'m mut [u32]) -> Option<Purse<'m>> {
        if !self.is_left_alone() {
            return None;
        }
        match self.whole {
            Some(number) => Purse::of(purses, number),
            None => Purse::of(own, 0),
        }
    }
}

/// What all pieces have in common.
pub(super) struct Step<'a> {
    pub(super) params: &'a StrandParams,
    pub(super) h: f32,
}

impl Step<'_> {
    /// The seconds of a strain's rate that count as strain, in sub-steps.
    pub(super) fn lag(&self) -> f32 {
        self.params.damping / self.h
    }

    /// How far something of a stiffness gives way, × 1/h², without what damps it.
    fn softness(&self, stiffness: f32) -> f32 {
        1.0 / (stiffness * (self.h * self.h))
    }
}

/// How many edges from the tip on, and from the root, are turned about themselves, and how fast \[rad/s\].
#[derive(Clone, Copy, Default)]
struct Driven {
    edges: [usize; 2],
    rates: [f32; 2],
}

impl Driven {
    /// How fast an edge is turned that so many others are before, toward the tip and toward the root \[rad/s\].
    fn rate(&self, before: [usize; 2]) -> f32 {
        let of = |end: usize| if before[end] < self.edges[end] { self.rates[end] } else { 0.0 };
        of(0) + of(1)
    }
}

/// A point of a piece: the row it is in, and its inverse mass in units of that of the piece's mean.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub(super) row: usize,
    pub(super) weight: f32,
}

/// The equations of a piece, being written.
pub(super) struct Writer<'a, 'm, 'b, const LANES: usize> {
    pub(super) step: &'a Step<'a>,
    pub(super) band: &'a mut Band<'m, LANES>,
    pub(super) lane: usize,
    pub(super) bodies: &'a Bodies<'b>,
    pub(super) rows: &'a [u32],
    /// The mean mass of the points that move \[kg\].
    pub(super) mass: f32,
}

impl<const LANES: usize> Writer<'_, '_, '_, LANES>
where
    [f32; LANES]: Pod,
{
    pub(super) fn point(&self, number: usize) -> Point {
        let row = self.rows[number] as usize;
        Point { row, weight: self.bodies.inverse_mass[row] * self.mass }
    }

    fn add(&mut self, row: usize, column: usize, more: f32) {
        self.band.add(self.lane, row, column, more);
    }

    /// How far an edge of this length gives way, and over how many sub-steps it is damped: over no more than leave it as stiff as it is at rest, where
    /// it could not be told how far it gives way.
    pub(super) fn edge_softness(&self, rest: f32, ends: [Point; 2]) -> (f32, f32) {
        let least = RIDGE * (ends[0].weight + ends[1].weight);
        let Some(stretch) = self.step.params.stretch else { return (least, 0.0) };
        let still = rest * self.mass * self.step.softness(stretch);
        let soft = still / (1.0 + self.step.lag());
        if soft >= least { (soft, self.step.lag()) } else { (least, max(still / least - 1.0, 0.0)) }
    }

    /// How far this length of a strand gives way to being bent about the two axes of its section, and twisted.
    pub(super) fn bend_softness(&self, share: f32) -> [f32; 3] {
        let StrandParams { bending: [first, second], twisting, .. } = *self.step.params;
        let soft = |stiffness| share * self.mass * self.step.softness(stiffness) / (1.0 + self.step.lag());
        [first, second, twisting].map(soft)
    }

    /// Writes the equations of a piece but for what they ask for, and leaves in its joints, which were `begun` when the sub-step began, the frames of its
    /// edges where the method has moved them.
    pub(super) fn write(&mut self, piece: &Piece, joints: &mut [Joint], begun: &[Begun]) {
        let mut last: Option<Edge> = None;
        let driven = self.driven(piece);
        for number in 0..piece.count {
            self.inertia(number);
            let is_held = |edge: usize| edge == 0 && piece.held[0] || edge + 2 == piece.count && piece.held[1];
            let spun = || Spin::by(self.step.h * driven.rate([number, piece.count - 2 - number]));
            let ways = (number + 1 < piece.count).then(|| self.ways(number, joints, begun));
            let edge = ways.and_then(|ways| self.edge(number, &mut joints[number], ways, (is_held(number), spun())));
            if let (Some(first), Some(second)) = (&last, &edge) {
                let is_held = [number - 1, number].map(is_held);
                self.bend(number, [first, second], &joints[number - 1..=number], is_held);
            }
            last = edge;
        }
    }

    /// Which edges at the ends of a piece are turned about themselves: the first and the last if they are held, and all that is clamped there.
    fn driven(&self, piece: &Piece) -> Driven {
        if piece.turning == [0.0; 2] {
            return Driven::default();
        }
        let is_fixed = |&number: &usize| !(self.point(number).weight > 0.0);
        let fixed =
            [(0..piece.count).take_while(is_fixed).count(), (0..piece.count).rev().take_while(is_fixed).count()];
        let edges = [0, 1].map(|end| fixed[end].saturating_sub(1).max(usize::from(piece.held[end])));
        Driven { edges, rates: piece.turning }
    }

    /// The masses of a point.
    fn inertia(&mut self, number: usize) {
        let Point { weight, .. } = self.point(number);
        let mass = if weight > 0.0 { 1.0 / weight } else { 1.0 };
        for axis in 0..3 {
            let own = number * EQUATIONS + axis;
            // What its neighbours have added stays.
            self.add(own, own, mass - 1.0);
        }
    }

    /// The ways from a point to the next: now, less what their velocities make of it in the sub-step, and as that began.
    fn ways(&self, number: usize, joints: &[Joint], begun: &[Begun]) -> [Vec3; 3] {
        let next = number + 1;
        let [p, q] = [number, next].map(|end| self.point(end).row);
        let (x, v, x0) = (&*self.bodies.position, &*self.bodies.velocity, self.bodies.before[0]);
        let way = x[q] - x[p] + (joints[next].left - joints[number].left);
        let before = x0[q] - x0[p] + (begun[next].left - begun[number].left);
        [way, way - (v[q] - v[p]) * self.step.h, before]
    }

    /// The edge from a point to the next, which may be held or turned about itself: the pull in it, and what that resists to being moved across.
    fn edge(
        &mut self,
        number: usize,
        joint: &mut Joint,
        ways: [Vec3; 3],
        (is_held, spun): (bool, Option<Spin>),
    ) -> Option<Edge> {
        let (ends, h) = ([number, number + 1].map(|end| self.point(end)), self.step.h);
        let embedded = !(ends[0].weight + ends[1].weight > 0.0);
        let edge = Edge::of(Turn(joint.turn), ways, embedded, spun)?;
        joint.turn = edge.frame[0].0;
        if !is_held && !embedded {
            // Nothing but the material's stiffness holds it.
            let turn = (number + 1) * EQUATIONS + TURN;
            self.band.set(self.lane, turn, turn, NOTHING);
        }
        if embedded {
            return Some(edge);
        }
        let ((soft, _), tension) = (self.edge_softness(joint.length, ends), joint.tension);
        if !(soft < f32::INFINITY) {
            return Some(edge);
        }
        let own = (number + 1) * EQUATIONS + PULL;
        self.band.set(self.lane, own, own, -soft);
        // What is tense swings to and fro across: a quarter of that keeps any step stable, and takes nothing from the motion.
        let taut = 0.25 * h * h * max(tension, 0.0) / (self.mass * edge.length);
        let taut = if taut < f32::INFINITY { taut } else { 0.0 };
        for (axis, along) in edge.along.to_array().into_iter().enumerate() {
            let columns = [number, number + 1].map(|end| end * EQUATIONS + axis);
            for ((column, end), sign) in columns.into_iter().zip(ends).zip([-1.0, 1.0]) {
                if end.weight > 0.0 {
                    self.band.set(self.lane, own, column, sign * along);
                    self.add(column, column, taut);
                }
            }
            if ends[0].weight > 0.0 && ends[1].weight > 0.0 {
                self.band.set(self.lane, columns[0], columns[1], -taut);
            }
        }
        Some(edge)
    }

    /// The bending and twisting at a point between two edges.
    fn bend(&mut self, number: usize, edges: [&Edge; 2], joints: &[Joint], is_held: [bool; 2]) {
        let half = |i: usize| if edges[i].embedded { 0.0 } else { 0.5 * joints[i].length };
        let share = half(0) + half(1);
        let along = strain(edges[0].frame[1], edges[1].frame[1]);
        if !(share > 0.0 && along.is_finite()) {
            return;
        }
        let softness = self.bend_softness(share);
        for (k, gradient) in gradients(edges[1].frame[1], along).into_iter().enumerate() {
            let soft = softness[k];
            if !(soft < f32::INFINITY) {
                continue;
            }
            let own = number * EQUATIONS + BEND + k;
            self.band.set(self.lane, own, own, -soft);
            // A frame turns as its edge does, t × de / length, and about itself.
            let ways = edges.map(|edge| gradient.cross(edge.along) / edge.length);
            let pushes = [ways[0], -ways[0] - ways[1], ways[1]];
            for (point, push) in (number - 1..).zip(pushes) {
                if self.point(point).weight > 0.0 {
                    for (axis, push) in push.to_array().into_iter().enumerate() {
                        self.band.set(self.lane, own, point * EQUATIONS + axis, push);
                    }
                }
            }
            for (i, edge) in edges.into_iter().enumerate() {
                let turn = dot(gradient, edge.along) * [-1.0, 1.0][i];
                let column = (number + i) * EQUATIONS + TURN;
                if edge.embedded || is_held[i] || turn == 0.0 {
                    continue;
                }
                self.band.set(self.lane, own, column, turn);
                self.add(column, column, HOLD * turn * turn / soft);
            }
        }
    }
}

/// Moves the points of a piece as its system says, and turns the frames of its edges; nothing, where the solution is no number. Tells whether it is.
pub(super) fn act<const LANES: usize>(
    (band, lane): (&Band<'_, LANES>, usize),
    piece: &Piece,
    bodies: &mut Bodies<'_>,
    rows: &[u32],
    joints: &mut [Joint],
    mass: f32,
) -> bool
where
    [f32; LANES]: Pod,
{
    let equations = rows.len() * EQUATIONS;
    if !(0..equations).all(|row| band.answer(lane, row).is_finite()) {
        return false;
    }
    let shift = |number: usize| band.vector(lane, number * EQUATIONS);
    let [drift, turn, middle] = if piece.is_free { stray(bodies, rows, shift) } else { [Vec3::ZERO; 3] };
    let h = bodies.substep.seconds();
    for (number, &row) in rows.iter().enumerate() {
        let row = row as usize;
        if bodies.inverse_mass[row] > 0.0 {
            let place = bodies.position[row] - bodies.velocity[row] * h;
            let by = shift(number) - drift - turn.cross(place - middle);
            if piece.keeps_rounding() {
                bodies.shift_on(row, by, &mut joints[number].left);
            } else {
                bodies.shift(row, by);
            }
        }
    }
    for (number, ends) in rows.windows(2).enumerate() {
        let own = (number + 1) * EQUATIONS;
        let left = joints[number + 1].left - joints[number].left;
        let way = bodies.position[ends[1] as usize] - bodies.position[ends[0] as usize] + left;
        let joint = &mut joints[number];
        let direction = way / length(way);
        if direction.is_finite() {
            let turn = clamp(band.answer(lane, own + TURN), -FARTHEST, FARTHEST);
            joint.turn = bring(Turn(joint.turn), direction).on(direction * turn).0;
        }
        joint.tension += band.answer(lane, own + PULL) * mass / (h * h);
    }
    true
}

/// What shifts would change of the momenta of a piece that nothing holds: how far its middle would go, how it would turn as a whole about
/// where its middle was, and where that is. Forces within a strand change neither; rounding, and what is tense, would.
fn stray(bodies: &Bodies<'_>, rows: &[u32], shift: impl Fn(usize) -> Vec3) -> [Vec3; 3] {
    let none = [Vec3::ZERO; 3];
    let Some(&origin) = rows.first() else { return none };
    let (h, origin) = (bodies.substep.seconds(), origin as usize);
    let place = |row: usize| {
        bodies.position[row] - bodies.position[origin] - (bodies.velocity[row] - bodies.velocity[origin]) * h
    };
    let (mut mass, mut middle, mut drift) = (0.0, Vec3::ZERO, Vec3::ZERO);
    for (number, row) in rows.iter().map(|&row| row as usize).enumerate() {
        if !(bodies.inverse_mass[row] > 0.0) {
            return none;
        }
        mass += bodies.mass[row];
        middle += place(row) * bodies.mass[row];
        drift += shift(number) * bodies.mass[row];
    }
    let (middle, drift) = (middle / mass, drift / mass);
    let (mut torque, mut spread) = (Vec3::ZERO, Mat3::ZERO);
    for (number, row) in rows.iter().map(|&row| row as usize).enumerate() {
        let arm = place(row) - middle;
        torque += arm.cross(shift(number) - drift) * bodies.mass[row];
        spread += outer(arm, arm * bodies.mass[row]);
    }
    let origin = bodies.position[origin] - bodies.velocity[origin] * h;
    let all = [drift, solve(spread, torque), middle + origin];
    if all.iter().all(|part| part.is_finite()) { all } else { none }
}
