//! Loose balls among bodies: particles with a radius that are near one are bodies themselves for as long as they are.

use super::super::Bodies;
use super::ball::{Ball, CAME, FREE, LEAVES, STAYS};
use super::body::Body;
use super::forms::Forms;
use super::kept::Kept;
use super::manifold::DIRECTIONS;
use super::scenery;
use crate::math::{length, max};
use glam::Vec3;

/// The row belongs to nobody.
const NOBODY: u32 = 0;
/// The row belongs to a body.
const MEMBER: u32 = u32::MAX;

/// Where balls look for bodies.
pub(super) struct Around<'a> {
    /// The middles of the bodies \[m\].
    pub(super) middles: &'a [Vec3],
    /// How far a body reaches from its middle at the most, with how far it may go before the lists are made anew \[m\].
    pub(super) widest: f32,
    /// A word for each row.
    pub(super) rows: &'a mut [u32],
}

/// Lets balls that may touch bodies before the lists are made anew be bodies, after the others. Who was one keeps its number. Calls `meet` with
/// the numbers of a body and of a ball that are near each other.
pub(super) fn invite(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    forms: Forms<'_>,
    around: Around<'_>,
    meet: &mut dyn FnMut([u32; 2]),
) {
    let Around { middles, widest, rows } = around;
    let Kept { balls, bodies: all, .. } = &mut *kept;
    let first = all.len() - balls.len();
    sort_out(bodies, balls, forms, rows, first);
    let (mut fastest, mut thickest) = (0.0, 0.0);
    for row in (0..bodies.len()).filter(|&row| rows[row] != MEMBER && bodies.radius[row] > 0.0) {
        fastest = max(fastest, length(bodies.velocity[row]));
        thickest = max(thickest, bodies.radius[row]);
    }
    // What the world keeps as its `max_travel` is how far any ball may go before the lists are made anew.
    let max_travel = 1.25 * fastest * bodies.substep.step.seconds() + 0.1 * thickest;
    all[0].max_travel = max_travel;
    let (mut free, mut left_out) = (0, 0);
    let Bodies { near, position, radius, slot, serial, .. } = &mut *bodies;
    near.ask(middles, widest + thickest + max_travel, &mut |ask| {
        for row in 0..position.len() {
            if rows[row] == MEMBER || !(radius[row] > 0.0) {
                continue;
            }
            ask(position[row], &mut |body| {
                let (number, of) = (body + 1, &all[body as usize + 1]);
                let far = forms.gap(number, of, of.place(position[row])) - radius[row];
                if !(far <= of.max_travel + max_travel) {
                    return;
                }
                if rows[row] == NOBODY {
                    while balls.get(free).is_some_and(|ball| ball.state != FREE) {
                        free += 1;
                    }
                    let Some(ball) = balls.get_mut(free) else {
                        left_out += 1;
                        return;
                    };
                    *ball = Ball { slot: slot[row], serial: serial[row], state: CAME };
                    rows[row] = (first + free) as u32;
                }
                let ball = &mut balls[rows[row] as usize - first];
                ball.state = if ball.state == CAME { CAME } else { STAYS };
                meet([number, rows[row]]);
            });
        }
    });
    bodies.report.caps.contacts += left_out;
    follow_all(bodies, kept);
}

/// Frees the numbers of balls that have left, and takes the others as they are.
fn follow_all(bodies: &Bodies<'_>, kept: &mut Kept<'_>) {
    let first = kept.first_ball();
    let Kept { balls, bodies: all, scenery, .. } = kept;
    let own = scenery.chunks_exact_mut(DIRECTIONS).skip(first - 1);
    for ((ball, body), slots) in balls.iter_mut().zip(&mut all[first..]).zip(own) {
        if ball.state == LEAVES {
            ball.state = FREE;
        }
        if ball.is_new() {
            // What pressed on another that had its number says nothing of it.
            scenery::clear(body, slots);
        }
        if let Some(row) = ball.row(bodies) {
            body.follow(bodies, row);
        } else {
            let met = body.met;
            *body = Body::world();
            body.met = met;
        }
    }
}

/// Takes the balls as they are, and tells whether any ball in the scene may have gone, at the end of a sub-step of `h` \[s\], farther than was
/// looked for.
pub(super) fn are_far(bodies: &Bodies<'_>, kept: &mut Kept<'_>, h: f32) -> bool {
    let mut fastest = 0.0;
    for row in 0..bodies.len() {
        if bodies.radius[row] > 0.0 {
            fastest = max(fastest, length(bodies.velocity[row]));
        }
    }
    kept.bodies[0].max_travel -= fastest * h;
    let first = kept.first_ball();
    for (ball, body) in kept.balls.iter().zip(&mut kept.bodies[first..]) {
        if let Some(row) = ball.row(bodies) {
            body.follow(bodies, row);
        }
    }
    !(kept.bodies[0].max_travel >= fastest * h)
}

/// Tells what each row is: of a body, a ball that was there before, by its number, or nobody.
fn sort_out(bodies: &Bodies<'_>, balls: &mut [Ball], forms: Forms<'_>, rows: &mut [u32], first: usize) {
    rows.fill(NOBODY);
    for of in forms.boxes {
        for number in of.first..of.first.saturating_add(of.count) {
            if let Some(row) = bodies.row_of_start(number) {
                rows[row] = MEMBER;
            }
        }
    }
    for (i, ball) in balls.iter_mut().enumerate() {
        match ball.row(bodies).filter(|&row| rows[row] == NOBODY) {
            Some(row) => (rows[row], ball.state) = ((first + i) as u32, LEAVES),
            None => ball.state = FREE,
        }
    }
}
