//! Passes over the points of all that touch: impulses that bring them to part as is wanted, and friction.
//!
//! Eight times two bodies that have nothing to do with each other go side by side. Which these are makes no difference to any of them: no velocity
//! is −0 when a sub-step begins ([`Body::gather`](super::body::Body::gather)), so impulses of zero, where others have more points, change no bit.

use super::body::Body;
use super::order::{Order, is_in_turn, is_scenery};
use super::pack::{Motion, Pack, lanes};
use super::solver::PASSES;
use super::touch::Touch;
use crate::lanes::{ABREAST, Eight, Kernel, mask_of};
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
        let (range, on_scenery, tick) = (self.order.range(colour), is_scenery(colour), clock + 1);
        let packs = self.order.packs.get_mut(range).unwrap_or_default();
        if is_in_turn(colour) {
            return in_turn(like, self.bodies, packs, clock);
        }
        let (mut last, mut waits) = (clock, None::<(usize, u32)>);
        for number in 0..packs.len() {
            let due = due(self.bodies, &packs[number]);
            if due == 0 {
                continue;
            }
            last = tick;
            let Some((other, others)) = waits.replace((number, due)) else { continue };
            match packs.get_disjoint_mut([other, number]) {
                Ok([one, two]) if ABREAST > 1 && one.most == two.most => {
                    go_both(like, self.bodies, [(one, others), (two, due)], on_scenery, tick);
                    waits = None;
                }
                _ => go(like, self.bodies, (&mut packs[other], others), on_scenery, tick),
            }
        }
        if let Some((number, due)) = waits {
            go(like, self.bodies, (&mut packs[number], due), on_scenery, tick);
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
    for lane in 0..ABREAST {
        let last = changed(pack.bodies[0][lane]).max(changed(pack.bodies[1][lane]));
        due |= u32::from(last >= pack.seen[lane]) << lane;
    }
    due & pack.everyone()
}

/// Goes over those that may share bodies, which are called up one by one.
#[inline(never)]
fn in_turn<F: Eight>(like: F, bodies: &mut [Body], packs: &mut [Pack], clock: u32) -> u32 {
    let mut last = clock;
    for pack in packs {
        for turn in 0..pack.len() {
            let due = due(bodies, pack) & 1 << turn;
            if due != 0 {
                last = clock + 1;
                go(like, bodies, (pack, due), false, last);
            }
        }
    }
    last
}

/// Goes over the points of those of a pack that are due once, and notes at which tick of the clock that was and whether it has changed the bodies.
#[inline(always)]
fn go<F: Eight>(like: F, bodies: &mut [Body], (pack, due): (&mut Pack, u32), on_scenery: bool, clock: u32) {
    let mut touch = begin(like, bodies, pack, on_scenery);
    touch.press_evenly(pack);
    for i in pack.numbers() {
        touch.press(pack, i);
    }
    end(&touch, bodies, (pack, due), clock);
}

/// The same of two packs that have nothing to do with each other, and as many points: one's impulses are computed while the other's wait for a root.
#[inline(always)]
fn go_both<F: Eight>(
    like: F,
    bodies: &mut [Body],
    [(one, due), (two, others)]: [(&mut Pack, u32); 2],
    on_scenery: bool,
    clock: u32,
) {
    let mut touch = begin(like, bodies, one, on_scenery);
    let mut other = begin(like, bodies, two, on_scenery);
    touch.press_evenly(one);
    other.press_evenly(two);
    for i in one.numbers() {
        touch.press(one, i);
        other.press(two, i);
    }
    end(&touch, bodies, (one, due), clock);
    end(&other, bodies, (two, others), clock);
}

/// Takes the bodies of a pack as they move.
#[inline(always)]
fn begin<F: Eight>(like: F, bodies: &[Body], pack: &Pack, on_scenery: bool) -> Touch<F> {
    let nobody = Body::zeroed();
    let second = Motion::of(like, &pack.pushed(1, bodies, &nobody));
    // Nobody asks how the scenery moves.
    let first = if on_scenery { second } else { Motion::of(like, &pack.pushed(0, bodies, &nobody)) };
    Touch::of(like, pack, [first, second], on_scenery)
}

/// Writes down what has been done to those of a pack that are due.
#[inline(always)]
fn end<F: Eight>(touch: &Touch<F>, bodies: &mut [Body], (pack, due): (&mut Pack, u32), clock: u32) {
    touch.save(pack, mask_of(touch.is_changed, due));
    let changed = touch.is_changed.to_bitmask();
    for side in usize::from(touch.on_scenery)..2 {
        let given = pack.gives[side] & due;
        touch.motions[side].tell(bodies, &pack.bodies[side], given);
        for lane in lanes(given & changed) {
            if let Some(body) = bodies.get_mut(pack.bodies[side][lane] as usize) {
                body.changed = clock;
            }
        }
    }
    for (lane, seen) in pack.seen.iter_mut().enumerate() {
        *seen = if due >> lane & 1 != 0 { clock } else { *seen };
    }
}
