//! Whoever looks on is told of the blows that bodies give and take.

use super::super::Bodies;
use super::ball::Ball;
use super::forms::Forms;
use super::kept::Kept;
use super::manifold::{Manifold, Point};
use super::span::Span;
use crate::math::dot;
use crate::observe::{Attention, Impact};
use glam::Vec3;

/// Tells of all blows in the sub-step: of who came together faster than what rests does.
pub(super) fn all(bodies: &mut Bodies<'_>, kept: &Kept<'_>, forms: Forms<'_>, span: Span) {
    if bodies.observer.attention() == Attention::Nothing {
        return;
    }
    let pairs = &kept.pairs[..kept.lists.pairs as usize];
    for manifold in pairs.iter().chain(&*kept.scenery) {
        if let Some(blow) = Blow::of(manifold, kept, span) {
            blow.tell(bodies, kept, forms);
        }
    }
}

/// The hardest blow of two to each other in a sub-step.
struct Blow<'a> {
    manifold: &'a Manifold,
    /// From the first to the second.
    normal: Vec3,
    arms: [Vec3; 2],
    /// How the scenery moves there \[m/s\].
    surface: Vec3,
    /// How fast they came together \[m/s\].
    closing: f32,
}

impl<'a> Blow<'a> {
    fn of(manifold: &'a Manifold, kept: &Kept<'_>, span: Span) -> Option<Self> {
        let [a, b] = manifold.bodies.map(|number| &kept.bodies[number as usize]);
        let normal = a.rotation * manifold.normal;
        let mut hardest: Option<Self> = None;
        for point in manifold.points().iter().filter(|point| point.pressed > 0.0) {
            let Point { arms: [one, other], surface, .. } = *point;
            let slip = b.velocity_before(other) - a.velocity_before(one) - surface;
            let closing = -dot(slip, normal);
            if closing > point.calm(span) && hardest.as_ref().is_none_or(|blow| closing > blow.closing) {
                hardest = Some(Self { manifold, normal, arms: point.arms, surface, closing });
            }
        }
        hardest
    }

    fn tell(&self, bodies: &mut Bodies<'_>, kept: &Kept<'_>, forms: Forms<'_>) {
        let numbers = self.manifold.bodies;
        let rows = numbers.map(|number| row_of(bodies, kept, forms, number));
        for (side, normal) in [(0, -self.normal), (1, self.normal)] {
            let (Some(row), body) = (rows[side], &kept.bodies[numbers[side] as usize]) else { continue };
            let Some(id) = bodies.id(row).filter(|_| body.moves()) else { continue };
            let (arm, other) = (self.arms[side], rows[1 - side].and_then(|row| bodies.id(row)));
            let (before, after) = (body.velocity_before(arm), body.velocity_at(arm));
            let (mass, place, time) = (1.0 / body.inverse_mass, body.center + arm, bodies.substep.during[1]);
            let (closing, surface) = (self.closing, self.surface);
            bodies.tell(&Impact { id, row, other, mass, place, normal, closing, before, after, surface, time });
        }
    }
}

/// The row of a ball, or of the first particle of a body that lives; none: the world.
fn row_of(bodies: &Bodies<'_>, kept: &Kept<'_>, forms: Forms<'_>, number: u32) -> Option<usize> {
    let number = number.checked_sub(1)? as usize;
    match forms.boxes.get(number) {
        Some(of) => (of.first..of.first.saturating_add(of.count)).find_map(|particle| bodies.row_of_start(particle)),
        None => kept.balls.get(number - forms.boxes.len()).and_then(|ball| Ball::row(ball, bodies)),
    }
}
