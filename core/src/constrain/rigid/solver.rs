//! What bodies that touch do to each other in a sub-step: impulses that hold them apart, and friction.

use super::body::Body;
use super::manifold::{Manifold, Point, middle};
use crate::collide::RESTING;
use crate::math::{aside, dot, length, max, min, sqrt};
use glam::Vec3;

/// Passes over those that bounce, for their points share one blow.
const BLOWS: u32 = 12;
/// Passes over all others.
const PASSES: u32 = 4;
/// The share of the last sub-step's impulses that the next one begins with: all of them would let towers swing.
const AGAIN: f32 = 0.9;
/// Passes over the points of two before those of the next two.
const WITHIN: u32 = 2;

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

/// Looks how two stand to each other: gaps, and how fast they come together.
pub(super) fn begin(bodies: &mut [Body], manifold: &mut Manifold) {
    let Some(mut pair) = Pair::of(bodies, manifold) else { return };
    pair.let_slide();
    pair.stand();
    for i in 0..pair.count {
        let speed = -pair.parting(i);
        pair.points[i].bounce = speed;
    }
}

/// Says how fast two that come together shall part, when forces have changed their velocities: the elastic answer to the speed at which they
/// meet, u² = u₀² + 2 a s over the gap s, so that a bounce neither gains nor loses by when in the sub-step it happens. Where it would be over
/// within a part of the step, they stay together.
pub(super) fn expect(bodies: &mut [Body], manifold: &mut Manifold, span: Span) {
    let elasticity = manifold.elasticity;
    let Some(pair) = Pair::of(bodies, manifold) else { return };
    // What forces make of the speed of either in a sub-step.
    let driven = pair.bodies.iter().map(|body| length(body.velocity - body.before[0])).fold(0.0, max);
    for i in 0..pair.count {
        let now = -pair.parting(i);
        let point = &mut pair.points[i];
        let before = point.bounce;
        let meets = sqrt(max(before * before + 2.0 * (now - before) / span.h * point.gap, 0.0));
        let bounce = if now > 0.0 { elasticity * meets } else { 0.0 };
        point.bounce = if 2.0 * bounce * span.h < RESTING * span.step * driven { 0.0 } else { bounce };
        point.calm = driven * span.step / span.h;
        if max(now.abs(), before.abs()) > point.calm {
            // What held the last sub-step says nothing of a blow.
            (point.pressed, point.held) = (0.0, Vec3::ZERO);
        }
    }
}

/// Gives two again most of what held them in the last sub-step.
pub(super) fn hold_on(bodies: &mut [Body], manifold: &mut Manifold) {
    let Some(mut pair) = Pair::of(bodies, manifold) else { return };
    for i in 0..pair.count {
        let Point { pressed, held, arms, .. } = pair.points[i];
        let (pressed, held) = (pressed * AGAIN, aside(held, pair.normal) * AGAIN);
        (pair.points[i].pressed, pair.points[i].held) = (pressed, held);
        pair.push(arms, pair.normal * pressed + held);
    }
}

/// Keeps all from passing into each other within the sub-step, by velocities: before they go.
pub(super) fn keep_apart(bodies: &mut [Body], manifolds: [&mut [Manifold]; 2], span: Span) {
    let [pairs, scenery] = manifolds;
    for _ in 0..PASSES {
        for manifold in pairs.iter_mut().chain(&mut *scenery) {
            let Some(mut pair) = Pair::of(bodies, manifold) else { continue };
            for _ in 0..WITHIN {
                pair.press_all(&mut |point| {
                    let share = if point.gap > 0.0 { 1.0 } else { RECOVERY };
                    -point.gap * share / span.h
                });
                pair.rub_all(RECOVERY / span.h);
            }
        }
    }
    for manifold in pairs.iter().chain(&*scenery) {
        if manifold.points().iter().any(|point| point.pressed > 0.0) {
            manifold.bodies.iter().for_each(|&body| bodies[body as usize].pressed = 1);
        }
    }
}

/// Lets all part as they shall, when they have gone: what overlaps is no reason to, elasticity is.
pub(super) fn part(bodies: &mut [Body], manifolds: [&mut [Manifold]; 2], span: Span) {
    let [pairs, scenery] = manifolds;
    let mut bounces = false;
    for manifold in pairs.iter_mut().chain(&mut *scenery) {
        if let Some(mut pair) = Pair::of(bodies, manifold) {
            pair.stand();
            for i in 0..pair.count {
                let closing = -pair.parting(i);
                let point = &mut pair.points[i];
                if !(point.pressed > 0.0 || point.gap <= 0.0) {
                    // Who does not touch yet closes the gap in the next sub-step at the most, or meets for a blow then.
                    let is_calm = closing <= point.calm;
                    point.bounce = if is_calm { -point.gap / span.h } else { f32::NEG_INFINITY };
                }
                bounces |= point.bounce > 0.0;
            }
        }
    }
    for _ in 0..if bounces { BLOWS } else { PASSES } {
        for manifold in pairs.iter_mut().chain(&mut *scenery) {
            let Some(mut pair) = Pair::of(bodies, manifold) else { continue };
            for _ in 0..WITHIN {
                pair.press_all(&mut |point| point.bounce);
                pair.rub_all(0.0);
            }
        }
    }
}

/// Two bodies, and where they touch.
struct Pair<'a> {
    bodies: [&'a mut Body; 2],
    /// From the first to the second, in the world.
    normal: Vec3,
    surface: Vec3,
    friction: [f32; 2],
    points: &'a mut [Point; 4],
    count: usize,
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
        let normal = bodies[0].rotation * manifold.normal;
        let Manifold { surface, friction, .. } = *manifold;
        Some(Self { bodies, normal, surface, friction, points: &mut manifold.points, count })
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
            point.mass = 1.0 / (a.yielding(point.arms[0], normal) + b.yielding(point.arms[1], normal));
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
        let ([a, b], arms) = (&self.bodies, self.points[i].arms);
        b.velocity_at(arms[1]) - a.velocity_at(arms[0]) - self.surface
    }

    fn parting(&self, i: usize) -> f32 {
        dot(self.slip(i), self.normal)
    }

    fn push(&mut self, arms: [Vec3; 2], impulse: Vec3) {
        let [a, b] = &mut self.bodies;
        a.push(arms[0], -impulse);
        b.push(arms[1], impulse);
    }

    /// Brings the speed at which they part to what is wanted, as far as pushing alone does it.
    fn press_all(&mut self, wanted: &mut dyn FnMut(&Point) -> f32) {
        self.press_evenly(wanted);
        for i in 0..self.count {
            let parting = self.parting(i);
            let point = &mut self.points[i];
            let pressed = max(point.pressed + (wanted(point) - parting) * point.mass, 0.0);
            let impulse = pressed - point.pressed;
            if impulse.is_finite() && impulse != 0.0 {
                point.pressed = pressed;
                let arms = point.arms;
                self.push(arms, self.normal * impulse);
            }
        }
    }

    /// Changes the impulses of all points that press, or should, by the same: what presses evenly, as a box that lies flat, is done with at
    /// once, whatever the order of points.
    fn press_evenly(&mut self, wanted: &mut dyn FnMut(&Point) -> f32) {
        let (mut lack, mut least, mut levers, mut number) = (0.0, f32::INFINITY, [Vec3::ZERO; 2], 0.0);
        let mut counts = [false; 4];
        for (i, counts) in counts.iter_mut().enumerate().take(self.count) {
            let missing = wanted(&self.points[i]) - self.parting(i);
            let Point { pressed, arms, .. } = self.points[i];
            *counts = missing > 0.0 || pressed > 0.0;
            if *counts {
                (lack, least, number) = (lack + missing, min(least, pressed), number + 1.0);
                levers[0] += arms[0];
                levers[1] += arms[1];
            }
        }
        if !(number > 1.0) {
            return;
        }
        let mean = levers.map(|lever| lever * (1.0 / number));
        let [a, b] = &self.bodies;
        let yielding = a.yielding(mean[0], self.normal) + b.yielding(mean[1], self.normal);
        let each = max(lack / (number * number * yielding), -least);
        if each.is_finite() && each != 0.0 {
            for (point, _) in self.points.iter_mut().zip(counts).filter(|&(_, counts)| counts) {
                point.pressed += each;
            }
            self.push(mean, self.normal * (each * number));
        }
    }

    /// Takes from their slip, and from what they have crept at so many times a second, what Coulomb's friction can, by all that presses.
    fn rub_all(&mut self, back: f32) {
        let [sticks, slides] = self.friction;
        if !(sticks + slides > 0.0) {
            return;
        }
        for i in 0..self.count {
            let Point { pressed, held, arms, crept, .. } = self.points[i];
            let slip = aside(self.slip(i), self.normal) + crept * back;
            let speed = length(slip);
            if !(speed > 0.0) {
                continue;
            }
            let along = slip * (1.0 / speed);
            let [a, b] = &self.bodies;
            let wanted = held - along * (speed / (a.yielding(arms[0], along) + b.yielding(arms[1], along)));
            let size = length(wanted);
            let holds = if size <= sticks * pressed { wanted } else { wanted * (min(slides * pressed, size) / size) };
            let change = holds - held;
            if change.is_finite() {
                self.points[i].held = holds;
                self.push(arms, change);
            }
        }
    }
}
