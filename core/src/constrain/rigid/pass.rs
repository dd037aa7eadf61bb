//! Passes over the points of all that touch: impulses that bring them to part as is wanted, and friction.
//!
//! Eight times two bodies that have nothing to do with each other go side by side. Which these are makes no difference to any of them: no velocity
//! is −0 when a sub-step begins ([`Body::gather`](super::body::Body::gather)), so impulses of zero, where others have more points, change no bit.

use super::body::Body;
use super::order::{Order, is_in_turn, is_scenery};
use super::pack::{Motion, Pack};
use super::solver::PASSES;
use super::touch::Touch;
use crate::lanes::{Eight, Kernel, mask_of};
use bytemuck::Zeroable;

/// All that touch, and how they are gone over.
pub(super) struct Passes<'a, 'b> {
    pub(super) bodies: &'a mut [Body],
    pub(super) order: &'a mut Order<'b>,
    /// How often at the most.
    pub(super) count: u32,
}

impl Kernel for Passes<'_, '_> {
    type Output = ();
    /// Goes over all so many times at the most, and over those again whose bodies have been changed since.
    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        for body in self.bodies.iter_mut() {
            body.changed = 0;
        }
        for pack in self.order.packs.iter_mut() {
            pack.seen.fill(0);
        }
        let mut clock = 0;
        for pass in 0..self.count {
            let before = clock;
            if pass == PASSES {
                self.leave_out();
            }
            for colour in self.order.colours() {
                clock = self.over(like, colour, clock);
            }
            if clock == before {
                return;
            }
        }
    }
}

impl Passes<'_, '_> {
    /// Goes over those of one colour that have something left to do, all at one tick, however many go side by side; returns the last tick.
    #[inline(always)]
    fn over<F: Eight>(&mut self, like: F, colour: usize, clock: u32) -> u32 {
        let (nobody, mut last, range) = (Body::zeroed(), clock, self.order.range(colour));
        for pack in self.order.packs.get_mut(range).unwrap_or_default() {
            // Those that may share a body are called up one by one.
            let turns = if is_in_turn(colour) { pack.len() } else { 1 };
            for turn in 0..turns {
                let called = if turns > 1 { 1 << turn } else { u32::MAX };
                let due = due(self.bodies, pack) & called;
                if due != 0 {
                    last = clock + 1;
                    go(like, (self.bodies, &nobody), (pack, due, is_scenery(colour)), last);
                }
            }
        }
        last
    }

    /// Leaves out of the passes to come who does not share in a blow.
    fn leave_out(&mut self) {
        let Self { bodies, order, .. } = self;
        let shares = |number: u32| bodies.get(number as usize).is_some_and(|body| body.bounces != 0);
        for pack in order.packs.iter_mut() {
            for lane in 0..pack.len() {
                if !(shares(pack.bodies[0][lane]) || shares(pack.bodies[1][lane])) {
                    pack.seen[lane] = u32::MAX;
                }
            }
        }
    }
}

/// A bit for each of a pack that has something left to do: of its bodies one has been changed since it was gone over.
#[inline(always)]
fn due(bodies: &[Body], pack: &Pack) -> u32 {
    let changed = |number: u32| bodies.get(number as usize).map_or(0, |body| body.changed);
    let mut due = 0;
    for lane in 0..pack.len() {
        let last = changed(pack.bodies[0][lane]).max(changed(pack.bodies[1][lane]));
        due |= u32::from(last >= pack.seen[lane]) << lane;
    }
    due
}

/// Goes over the points of those of a pack that are due once, and notes at which tick of the clock that was and whether it has changed the bodies.
#[inline(always)]
fn go<F: Eight>(
    like: F,
    (bodies, nobody): (&mut [Body], &Body),
    (pack, due, on_scenery): (&mut Pack, u32, bool),
    clock: u32,
) {
    let [a, b] = pack.gives;
    let motions = [
        Motion::of(like, &pack.side(0, bodies, if on_scenery { 0 } else { a & due }, nobody)),
        Motion::of(like, &pack.side(1, bodies, b & due, nobody)),
    ];
    let mut touch = Touch::of(like, pack, motions, on_scenery);
    touch.go(pack, mask_of(like, due));
    let changed = touch.is_changed.to_bitmask();
    for side in usize::from(on_scenery)..2 {
        let given = pack.gives[side] & due;
        touch.motions[side].tell(bodies, &pack.bodies[side], given);
        for (lane, &number) in pack.bodies[side].iter().enumerate() {
            if let Some(body) = bodies.get_mut(number as usize).filter(|_| (given & changed) >> lane & 1 != 0) {
                body.changed = clock;
            }
        }
    }
    for lane in (0..pack.len()).filter(|lane| due >> lane & 1 != 0) {
        pack.seen[lane] = clock;
    }
}
