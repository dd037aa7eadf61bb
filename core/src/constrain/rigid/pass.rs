//! Passes over the points of all that touch: impulses that bring them to part as is wanted, and friction.
//!
//! Eight times two bodies that have nothing to do with each other go side by side. Which these are makes no difference to any of them: no velocity
//! is −0 when a sub-step begins ([`Body::gather`](super::body::Body::gather)), so impulses of zero, where others have more points, change no bit.

use super::moving::Moving;
use super::order::{Order, is_in_turn, is_scenery};
use super::pack::Pack;
use super::touch::Touch;
use crate::lanes::{ABREAST, Eight, Kernel, load, max};

/// Passes at the most.
const PASSES: u32 = 8;

/// All that touch, and how they are gone over.
pub(super) struct Passes<'a, 'b> {
    pub(super) order: &'a mut Order<'b>,
}

impl Kernel for Passes<'_, '_> {
    type Output = ();
    /// Goes over all, and over those again whose bodies have been changed since.
    #[inline(always)]
    fn run<F: Eight>(mut self, like: F) {
        for pack in self.order.packs.iter_mut() {
            pack.seen.fill(0.0);
        }
        let mut clock = 0.0;
        for _ in 0..PASSES {
            let before = clock;
            for colour in self.order.colours() {
                clock = self.over(like, colour, clock);
            }
            if clock <= before {
                return;
            }
        }
    }
}

impl Passes<'_, '_> {
    /// Goes over those of one colour that have something left to do, all at one tick, however many go side by side; returns the last tick.
    #[inline(always)]
    fn over<F: Eight>(&mut self, like: F, colour: usize, clock: f32) -> f32 {
        let (range, on_scenery, tick) = (self.order.range(colour), is_scenery(colour), clock + 1.0);
        let Order { packs, moving, .. } = &mut *self.order;
        let packs = packs.get_mut(range).unwrap_or_default();
        if is_in_turn(colour) {
            return in_turn(like, moving, packs, clock);
        }
        let (mut last, mut waits) = (clock, None::<(usize, u32)>);
        for number in 0..packs.len() {
            let due = due(like, moving, &packs[number]);
            if due == 0 {
                continue;
            }
            last = tick;
            let Some((other, others)) = waits.replace((number, due)) else { continue };
            match packs.get_disjoint_mut([other, number]) {
                Ok([one, two]) if ABREAST > 1 && one.most == two.most => {
                    go_both(like, moving, [(one, others), (two, due)], on_scenery, tick);
                    waits = None;
                }
                _ => go(like, moving, (&mut packs[other], others), on_scenery, tick),
            }
        }
        if let Some((number, due)) = waits {
            go(like, moving, (&mut packs[number], due), on_scenery, tick);
        }
        last
    }
}

/// A bit for each of a pack that has something left to do: of its bodies one has been changed since it was gone over.
#[inline(always)]
fn due<F: Eight>(like: F, moving: &[Moving], pack: &Pack) -> u32 {
    let mut changed = [[0.0; ABREAST]; 2];
    for (changed, numbers) in changed.iter_mut().zip(&pack.bodies) {
        for (changed, &number) in changed.iter_mut().zip(numbers) {
            *changed = moving.get(number as usize).map_or(0.0, Moving::changed);
        }
    }
    let last = max(load(like, &changed[0]), load(like, &changed[1]));
    last.simd_ge(load(like, &pack.seen)).to_bitmask() & pack.everyone()
}

/// Goes over those that may share bodies, which are called up one by one.
#[inline(never)]
fn in_turn<F: Eight>(like: F, moving: &mut [Moving], packs: &mut [Pack], clock: f32) -> f32 {
    let mut last = clock;
    for pack in packs {
        for turn in 0..pack.len() {
            let due = due(like, moving, pack) & 1 << turn;
            if due != 0 {
                last = clock + 1.0;
                go(like, moving, (pack, due), false, last);
            }
        }
    }
    last
}

/// Goes over the points of those of a pack that are due once, and notes at which tick of the clock that was and whether it has changed the bodies.
#[inline(always)]
fn go<F: Eight>(like: F, moving: &mut [Moving], (pack, due): (&mut Pack, u32), on_scenery: bool, tick: f32) {
    let Some(mut touch) = Touch::of(like, pack, moving, due, on_scenery) else { return };
    touch.press_evenly(pack);
    for i in pack.numbers() {
        touch.press(pack, i);
    }
    touch.end(pack, moving, tick);
}

/// The same of two packs that have nothing to do with each other, and as many points: one's impulses are computed while the other's wait for a root.
#[inline(always)]
fn go_both<F: Eight>(
    like: F,
    moving: &mut [Moving],
    [(one, due), (two, others)]: [(&mut Pack, u32); 2],
    on_scenery: bool,
    tick: f32,
) {
    let Some(mut touch) = Touch::of(like, one, moving, due, on_scenery) else { return };
    let Some(mut other) = Touch::of(like, two, moving, others, on_scenery) else { return };
    touch.press_evenly(one);
    other.press_evenly(two);
    for i in one.numbers() {
        touch.press(one, i);
        other.press(two, i);
    }
    touch.end(one, moving, tick);
    other.end(two, moving, tick);
}
