//! What bodies that touch do to each other in a sub-step: impulses that hold them apart, and friction.

use super::body::Body;
use super::manifold::{Manifold, POINTS, Point, middle};
use super::order::Order;
use super::pass::Passes;
use crate::collide::RESTING;
use crate::lanes::run_abreast;
use crate::math::{aside, dot, length, max, sqrt};
use glam::Vec3;

/// Passes at the most where anything bounces, for the points of bodies that touch share one blow.
const BLOWS: u32 = 12;
/// Passes at the most where nothing does.
pub(super) const PASSES: u32 = 4;
/// A change of the speed at which two part is too small to go over their neighbours again for: it as a share of what the forces change their speeds
/// by in a sub-step, or of the speed that they shall part with.
pub(super) const SETTLED: f32 = 1e-2;
/// The share of the last sub-step's impulses that the next one begins with: all of them would let towers swing.
const AGAIN: f32 = 0.9;

/// The share of an overlap that is taken back in a sub-step.
const RECOVERY: f32 = 0.1;

/// The share of the friction there can be below which a point counts as held.
const HOLDS: f32 = 0.99;

/// A sub-step \[s\], and the step it is a part of.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) h: f32,
    pub(super) step: f32,
}

/// How fast two come together that may touch within a sub-step of `h` \[s\], driven as they were \[m/s\].
pub(super) fn meeting(bodies: &mut [Body], manifold: &mut Manifold, h: f32) -> Option<f32> {
    let mut pair = Pair::of(bodies, manifold)?;
    pair.stand();
    let [a, b] = [0, 1].map(|side| if pair.bodies[side].sleeps() { Vec3::ZERO } else { pair.bodies[side].drive[0] });
    let driven = 2.0 * h * dot(b - a, pair.normal);
    let may_touch = |&i: &usize| pair.points[i].gap + (pair.parting(i) + driven) * h <= 0.0;
    (0..pair.count).filter(may_touch).map(|i| -pair.parting(i)).reduce(max)
}

/// Looks how all stand to each other when forces have changed their velocities, and what impulses do to them, and says how fast they shall part.
pub(super) fn begin(bodies: &mut [Body], order: &mut Order<'_>, span: Span) {
    for number in 0..order.len() {
        let Some(manifold) = order.get_mut(number) else { continue };
        let elasticity = manifold.elasticity;
        let Some(mut pair) = Pair::of(bodies, manifold) else { continue };
        pair.let_slide();
        pair.stand();
        pair.weigh(RECOVERY / span.h);
        pair.expect(elasticity, span);
    }
}

/// Gives all again most of what held them in the last sub-step.
pub(super) fn hold_on(bodies: &mut [Body], order: &mut Order<'_>) {
    for number in 0..order.len() {
        let Some(manifold) = order.get_mut(number) else { continue };
        let Some(mut pair) = Pair::of(bodies, manifold) else { continue };
        for i in 0..pair.count {
            let Point { pressed, held, arms, .. } = pair.points[i];
            let (pressed, held) = (pressed * AGAIN, aside(held, pair.normal) * AGAIN);
            (pair.points[i].pressed, pair.points[i].held) = (pressed, held);
            pair.points[i].held_along = pair.along.map(|along| dot(held, along));
            pair.push(arms, pair.normal * pressed + held);
        }
    }
}

/// Keeps all from passing into each other within the sub-step, by velocities: before they go.
pub(super) fn keep_apart(bodies: &mut [Body], order: &mut Order<'_>) {
    run_abreast(Passes { bodies, order, count: PASSES });
}

/// Notes what presses on whom.
pub(super) fn mark_pressed(bodies: &mut [Body], order: &Order<'_>) {
    for number in 0..order.len() {
        let Some(manifold) = order.get(number) else { continue };
        if manifold.points().iter().any(|point| point.pressed > 0.0) {
            manifold.bodies.iter().for_each(|&body| bodies[body as usize].pressed = 1);
        }
    }
}

/// Lets all part as they shall, when they have gone: what overlaps is no reason to, elasticity is.
pub(super) fn part(bodies: &mut [Body], order: &mut Order<'_>, span: Span) {
    let mut bounces = false;
    bodies.iter_mut().for_each(|body| body.bounces = 0);
    for number in 0..order.len() {
        let Some(manifold) = order.get_mut(number) else { continue };
        let Some(mut pair) = Pair::of(bodies, manifold) else { continue };
        pair.stand();
        pair.ride(span.h);
        for i in 0..pair.count {
            let closing = -pair.parting(i);
            let point = &mut pair.points[i];
            point.wanted = point.bounce;
            if !(point.pressed > 0.0 || point.gap <= 0.0) {
                // Who does not touch yet closes the gap in the next sub-step at the most, or meets for a blow then.
                let is_calm = closing <= point.calm(span);
                point.wanted = if is_calm { -point.gap / span.h } else { f32::NEG_INFINITY };
            }
            if point.wanted > 0.0 {
                bounces = true;
                pair.bodies.iter_mut().for_each(|body| body.bounces = u32::from(body.moves()));
            }
        }
    }
    for number in 0..order.len() {
        if let Some(manifold) = order.get_mut(number) {
            manifold.lasts = manifold.bodies.iter().map(|&number| bodies[number as usize].bounces).fold(0, u32::max);
        }
    }
    run_abreast(Passes { bodies, order, count: if bounces { BLOWS } else { PASSES } });
}

/// Notes the friction at all points, for the next sub-step.
pub(super) fn remember(order: &mut Order<'_>) {
    for number in 0..order.len() {
        let Some(manifold) = order.get_mut(number) else { continue };
        let [u, v] = manifold.along;
        for point in &mut manifold.points[..(manifold.count as usize).min(POINTS)] {
            point.held = u * point.held_along[0] + v * point.held_along[1];
        }
        manifold.presses = u32::from(manifold.points().iter().any(|point| point.pressed > 0.0));
    }
}

/// Two bodies, and where they touch.
struct Pair<'a> {
    bodies: [&'a mut Body; 2],
    /// The first is the world.
    on_scenery: bool,
    /// Tells who is pushed: not one that sleeps and has been lain against since before.
    gives: [bool; 2],
    /// From the first to the second, in the world.
    normal: Vec3,
    friction: [f32; 2],
    points: &'a mut [Point; 4],
    count: usize,
    along: &'a mut [Vec3; 2],
}

impl<'a> Pair<'a> {
    /// None: they do not touch.
    fn of(bodies: &'a mut [Body], manifold: &'a mut Manifold) -> Option<Self> {
        let count = (manifold.count as usize).min(4);
        if count == 0 {
            return None;
        }
        let numbers = manifold.bodies.map(|number| number as usize);
        let bodies = bodies.get_disjoint_mut(numbers).ok()?;
        if !(bodies[0].is_awake() || bodies[1].is_awake()) {
            return None;
        }
        let normal = bodies[0].rotation * manifold.normal;
        let Manifold { friction, rested, .. } = *manifold;
        manifold.axis = normal;
        let gives = [0, 1].map(|side| bodies[side].gives(rested));
        Some(Self {
            bodies,
            on_scenery: numbers[0] == 0,
            gives,
            normal,
            friction,
            points: &mut manifold.points,
            count,
            along: &mut manifold.along,
        })
    }

    /// Follows the bodies' places.
    fn stand(&mut self) {
        let normal = self.normal;
        let [a, b] = &self.bodies;
        for point in &mut self.points[..self.count] {
            let spot = [a.point(point.places[0]), b.point(point.places[1])];
            let middle = middle(spot);
            point.gap = dot(normal, spot[1] - spot[0]);
            point.crept = aside(spot[1] - spot[0], normal);
            point.arms = [middle - a.center, middle - b.center];
        }
    }

    /// Leaves out of how far apart they are, and of what has crept, the way that the scenery has gone in a sub-step of `h` \[s\]; lets them slip as it
    /// moves from now on, and no longer back.
    fn ride(&mut self, h: f32) {
        let (on_scenery, normal, along) = (self.on_scenery, self.normal, *self.along);
        for point in &mut self.points[..self.count] {
            point.lag = [0.0; 2];
            if on_scenery && point.surface != Vec3::ZERO {
                point.gap -= point.lift * h;
                point.crept -= aside(point.surface, normal) * h;
                point.lag = along.map(|along| -dot(point.surface, along));
            }
        }
    }

    /// Finds what impulses at each point do to the speeds there; so many times a second what has crept is taken back.
    fn weigh(&mut self, back: f32) {
        let (on_scenery, normal, [a, b], gives) = (self.on_scenery, self.normal, &self.bodies, self.gives);
        let along = [across(normal), normal.cross(across(normal))];
        *self.along = along;
        let directions = [along[0], along[1], normal];
        for point in &mut self.points[..self.count] {
            let mut sum = [0.0; 6];
            for side in [0, 1].into_iter().filter(|&side| gives[side]) {
                let yields = [a, b][side].yields(point.arms[side], directions);
                sum.iter_mut().zip(yields).for_each(|(sum, yields)| *sum += yields);
            }
            let [uu, vv, nn, uv, un, vn] = sum;
            point.rub = [uu, 2.0 * uv, vv];
            point.answer = [un, vn];
            point.lag = along.map(|along| dot(point.crept, along) * back);
            if on_scenery && point.surface != Vec3::ZERO {
                point.lag = [0, 1].map(|k| point.lag[k] - dot(point.surface, along[k]));
            }
            point.mass = 1.0 / nn;
        }
    }

    /// Says how fast two that come together shall part: the elastic answer to the speed at which they meet, u² = u₀² + 2 a s over the gap s, so that
    /// a bounce neither gains nor loses by when in the sub-step it happens. Where it would be over within a part of the step, they stay together.
    fn expect(&mut self, elasticity: f32, span: Span) {
        // What forces make of the speed of either in a sub-step.
        let driven = self.bodies.iter().map(|body| length(body.velocity - body.before[0])).fold(0.0, max);
        for i in 0..self.count {
            let (before, now) = (-self.parting_before(i), -self.parting(i));
            let point = &mut self.points[i];
            let meets = sqrt(max(before * before + 2.0 * (now - before) / span.h * point.gap, 0.0));
            let bounce = if now > 0.0 { elasticity * meets } else { 0.0 };
            point.bounce = if 2.0 * bounce * span.h < RESTING * span.step * driven { 0.0 } else { bounce };
            point.driven = driven;
            point.wanted = -point.gap * if point.gap > 0.0 { 1.0 } else { RECOVERY } / span.h;
            if max(now.abs(), before.abs()) > point.calm(span) {
                // What held the last sub-step says nothing of a blow.
                (point.pressed, point.held) = (0.0, Vec3::ZERO);
            }
        }
    }

    /// Takes the places where points are that slide, or do not touch, for those where friction begins to hold them.
    fn let_slide(&mut self) {
        let [a, b] = &self.bodies;
        for point in &mut self.points[..self.count] {
            if !(length(point.held) < HOLDS * self.friction[1] * point.pressed) {
                let way = b.point(point.places[1]) - a.point(point.places[0]);
                point.places[0] += a.rotation.transpose() * aside(way, self.normal);
                point.crept = Vec3::ZERO;
            }
        }
    }

    /// How the second moves there as seen from the first \[m/s\].
    fn slip(&self, i: usize) -> Vec3 {
        let ([a, b], Point { arms, surface, .. }) = (&self.bodies, self.points[i]);
        b.velocity_at(arms[1]) - a.velocity_at(arms[0]) - surface
    }

    fn parting(&self, i: usize) -> f32 {
        dot(self.slip(i), self.normal)
    }

    /// The same as the sub-step began.
    fn parting_before(&self, i: usize) -> f32 {
        let ([a, b], Point { arms, surface, .. }) = (&self.bodies, self.points[i]);
        dot(b.velocity_before(arms[1]) - a.velocity_before(arms[0]) - surface, self.normal)
    }

    fn push(&mut self, arms: [Vec3; 2], impulse: Vec3) {
        let ([a, b], gives) = (&mut self.bodies, self.gives);
        if gives[0] {
            a.push(arms[0], -impulse);
        }
        if gives[1] {
            b.push(arms[1], impulse);
        }
    }
}

/// A unit vector across another.
fn across(normal: Vec3) -> Vec3 {
    let Vec3 { x, y, z } = normal;
    let side = if x.abs() < 0.6 { Vec3::new(0.0, -z, y) } else { Vec3::new(-y, x, 0.0) };
    side * (1.0 / length(side))
}
