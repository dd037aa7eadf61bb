//! What the equations of a strand ask for: once from where the method has brought it, and again from where their solution has.

use super::frame::{bring, strain};
use super::joint::{Begun, Joint};
use super::piece::{BEND, EQUATIONS, PULL, Piece, Step, TURN, Writer};
use crate::constrain::rate::braked_from;
use crate::constrain::turn::Turn;
use crate::math::length;
use bytemuck::Pod;

/// How long an edge is \[m\] and its frame: now, and as the solution of the sub-step before has left it. What others move after that, the strand takes
/// back in the next one: it is no motion that damping would count.
#[derive(Clone, Copy)]
struct Seen {
    length: [f32; 2],
    frame: [Turn; 2],
    /// True if both its ends are fixed.
    embedded: bool,
}

impl Step<'_> {
    /// What a strain asks for that is damped over so many sub-steps, having been another when this one began.
    fn asks([now, before]: [f32; 2], lag: f32) -> f32 {
        -(now + lag * (now - before)) / (1.0 + lag)
    }
}

impl<const LANES: usize> Writer<'_, '_, '_, LANES>
where
    [f32; LANES]: Pod,
{
    /// Writes what the equations of a piece ask for beyond what the solution so far, where there is one, has given them. Its joints were `begun`
    /// when the sub-step began.
    ///
    /// A solution takes edges for moving straight that turn: what gravity moves across an edge in a sub-step seems to stretch it, by half the square of that over
    /// its length. Where strains are damped so little is a jerk, and a strand would be held by it. Asking again from where the solution has brought
    /// it is a second step of Newton's method; the factors of the first one serve.
    pub(super) fn ask(&mut self, piece: &Piece, joints: &[Joint], begun: &[Begun]) {
        let mut last: Option<Seen> = None;
        for number in 0..piece.count {
            for equation in [0, 1, 2, TURN] {
                self.band.ask(self.lane, number * EQUATIONS + equation, 0.0);
            }
            let edge = (number + 1 < piece.count).then(|| self.seen(number, joints, begun));
            if let Some(edge) = edge {
                self.ask_of_edge(number, edge, &joints[number]);
                if let Some(last) = last {
                    self.ask_of_bend(number, [last, edge], &joints[number - 1..=number]);
                }
            }
            last = edge;
        }
    }

    /// The edge from a point to the next.
    fn seen(&self, number: usize, joints: &[Joint], begun: &[Begun]) -> Seen {
        let ends = [number, number + 1].map(|end| self.point(end));
        let [p, q] = ends.map(|end| end.row);
        let (x, x0, next) = (&*self.bodies.position, self.bodies.before[0], number + 1);
        let now = x[q] - x[p] + (joints[next].left - joints[number].left);
        let before = x0[q] - x0[p] + (begun[next].left - begun[number].left);
        let [before] = braked_from([before], [begun[number].was]);
        let (lengths, turn) = ([now, before].map(length), Turn(begun[number].turn));
        let direction = before / lengths[1];
        let begun = if direction.is_finite() { bring(turn, direction) } else { turn };
        let embedded = !(ends[0].weight + ends[1].weight > 0.0);
        Seen { length: lengths, frame: [Turn(joints[number].turn), begun], embedded }
    }

    /// What is left for an edge to ask for.
    fn ask_of_edge(&mut self, number: usize, edge: Seen, joint: &Joint) {
        let (soft, lag) = self.edge_softness(joint.length, [number, number + 1].map(|end| self.point(end)));
        let asked = Step::asks(edge.length.map(|length| length - joint.length), lag);
        if !edge.embedded {
            self.ask_for((number + 1) * EQUATIONS + PULL, asked, soft);
        }
    }

    /// What is left for the bending and twisting at a point between two edges to ask for.
    fn ask_of_bend(&mut self, number: usize, edges: [Seen; 2], joints: &[Joint]) {
        let half = |i: usize| if edges[i].embedded { 0.0 } else { 0.5 * joints[i].length };
        let softness = self.bend_softness(half(0) + half(1));
        let strains = [0, 1].map(|i| strain(edges[0].frame[i], edges[1].frame[i]) - joints[1].rest);
        for (k, soft) in softness.into_iter().enumerate() {
            let asked = Step::asks(strains.map(|strain| strain[k]), self.step.lag());
            self.ask_for(number * EQUATIONS + BEND + k, asked, soft);
        }
    }

    /// Asks for what an equation of this softness has not been given; for nothing, where there is no such equation.
    fn ask_for(&mut self, own: usize, asked: f32, soft: f32) {
        let left = asked + soft * self.band.answer(self.lane, own);
        let is_one = self.band.is_strain(self.lane, own) && left.is_finite();
        self.band.ask(self.lane, own, if is_one { left } else { 0.0 });
    }
}
