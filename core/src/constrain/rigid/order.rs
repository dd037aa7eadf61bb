//! The order in which all that touch are gone over: those that share no moving body side by side.

use super::body::Body;
use super::manifold::{DIRECTIONS, Manifold, Manifolds, POINTS};
use super::moving::Moving;
use super::pack::Pack;
use crate::lanes::ABREAST;
use crate::memory::take;
use core::ops::Range;

/// Colours of pairs: those of one share no moving body. Those that find none of the others have the last, one after the other.
const COLOURS: usize = 24;

/// All of some colours: first pairs, then the scenery.
const ALL: usize = COLOURS + DIRECTIONS;

/// Those of a colour by how many points they have, most first: who go side by side then have about as many.
const SHELVES: usize = ALL * POINTS;

/// All that touch and are not asleep, packed colour by colour.
pub(super) struct Order<'a> {
    pub(super) packs: &'a mut [Pack],
    /// How all bodies move, while impulses change that.
    pub(super) moving: &'a mut [Moving],
    /// The numbers of all of them, in their order.
    pub(super) numbers: &'a [u32],
    /// Where the colours begin.
    starts: [u32; ALL + 1],
}

/// The packs that so many pairs of so many bodies fill at the most, with what of the scenery presses on these: each colour may leave one that is not
/// full, and pairs need fewer colours than two bodies have neighbours together, and pieces beyond one each.
pub(super) fn packs_of(pairs: usize, bodies: usize, more: usize) -> usize {
    let colours = if more > 0 { COLOURS } else { COLOURS.min(bodies.saturating_mul(2)) };
    pairs.min((pairs / ABREAST).saturating_add(colours)).saturating_add(DIRECTIONS * bodies.div_ceil(ABREAST))
}

impl<'a> Order<'a> {
    /// Colours pairs and scenery one after the other: each gets the first colour that neither of its bodies has yet. `memory` is how each
    /// body moves, a word for each of those, and the packs.
    pub(super) fn of(bodies: &mut [Body], manifolds: &mut Manifolds<'_>, mut memory: &'a mut [u32]) -> Self {
        let moving = take(&mut memory, bodies.len() * (size_of::<Moving>() / 4));
        let moving = bytemuck::try_cast_slice_mut(moving).unwrap_or_default();
        bodies.iter_mut().for_each(|body| body.colours = 0);
        let (mut starts, mut active) = ([0u32; SHELVES + 1], 0);
        for (number, manifold) in manifolds.pairs.iter_mut().enumerate() {
            if is_active(bodies, manifold) {
                let colour = free(bodies, manifold.bodies);
                manifold.colour = shelf(colour, manifold);
                starts[manifold.colour as usize + 1] += 1;
                // The last word of the memory stands for the first of them.
                if let Some(place) = memory.len().checked_sub(active + 1).and_then(|last| memory.get_mut(last)) {
                    *place = number as u32;
                }
                active += 1;
            }
        }
        for (body, slots) in bodies[1..].iter().zip(manifolds.scenery.chunks_exact_mut(DIRECTIONS)) {
            let met = if body.is_awake() { body.met as usize } else { 0 };
            for (direction, slot) in slots.iter_mut().enumerate().take(met) {
                slot.colour = shelf(COLOURS + direction, slot);
                starts[slot.colour as usize + 1] += 1;
            }
        }
        for shelf in 0..SHELVES {
            starts[shelf + 1] += starts[shelf];
        }
        let count = (starts[SHELVES] as usize).min(memory.len());
        let (numbers, rest) = memory.split_at_mut(count);
        let active = rest.len().saturating_sub(active)..rest.len();
        put_all(bodies, manifolds, (starts, rest.get(active).unwrap_or_default()), numbers);
        let room = rest.len() - rest.len() % (size_of::<Pack>() / 4);
        Self::packed(bodies, manifolds, (&starts, numbers), (moving, bytemuck::cast_slice_mut(&mut rest[..room])))
    }

    /// Puts them into packs, those of each colour into its own.
    fn packed(
        bodies: &[Body],
        manifolds: &Manifolds<'_>,
        (shelves, all): (&[u32; SHELVES + 1], &'a [u32]),
        (moving, packs): (&'a mut [Moving], &'a mut [Pack]),
    ) -> Self {
        let (mut starts, mut len) = ([0u32; ALL + 1], 0);
        for colour in 0..ALL {
            let range = shelves[colour * POINTS] as usize..shelves[(colour + 1) * POINTS] as usize;
            for numbers in all.get(range).unwrap_or_default().chunks(ABREAST) {
                let Some(pack) = packs.get_mut(len) else { continue };
                pack.fill(bodies, manifolds, numbers);
                len += 1;
            }
            starts[colour + 1] = len as u32;
        }
        Self { packs: &mut packs[..len], moving, numbers: all, starts }
    }

    pub(super) fn colours(&self) -> Range<usize> {
        0..ALL
    }

    /// The packs of a colour.
    pub(super) fn range(&self, colour: usize) -> Range<usize> {
        self.starts[colour] as usize..self.starts[colour + 1] as usize
    }
}

/// Tells whether those of a colour touch the scenery.
pub(super) fn is_scenery(colour: usize) -> bool {
    colour >= COLOURS
}

/// Tells whether those of a colour go one after the other, for they may share bodies.
pub(super) fn is_in_turn(colour: usize) -> bool {
    colour + 1 == COLOURS
}

/// Where one of a colour stands among all.
fn shelf(colour: usize, manifold: &Manifold) -> u32 {
    let missing = if is_in_turn(colour) { 0 } else { POINTS - manifold.points().len() };
    (colour * POINTS + missing) as u32
}

/// Writes the numbers of all that have a colour in the order of these: of the active pairs, the last of which comes first, and of the scenery.
fn put_all(
    bodies: &[Body],
    manifolds: &Manifolds<'_>,
    (mut next, active): ([u32; SHELVES + 1], &[u32]),
    numbers: &mut [u32],
) {
    let mut put = |number: usize, manifold: &Manifold| {
        let Some(next) = next.get_mut(manifold.colour as usize) else { return };
        if let Some(place) = numbers.get_mut(*next as usize) {
            *place = number as u32;
        }
        *next += 1;
    };
    let Manifolds { pairs, scenery } = manifolds;
    for &number in active.iter().rev() {
        pairs.get(number as usize).into_iter().for_each(|manifold| put(number as usize, manifold));
    }
    for (number, body) in bodies[1..].iter().enumerate().filter(|(_, body)| body.is_awake()) {
        for number in (DIRECTIONS * number..).take(body.met as usize) {
            scenery.get(number).into_iter().for_each(|slot| put(pairs.len() + number, slot));
        }
    }
}

/// Tells whether two touch and one of them is awake.
fn is_active(bodies: &[Body], manifold: &Manifold) -> bool {
    let is_awake = |&number: &u32| bodies.get(number as usize).is_some_and(Body::is_awake);
    manifold.count > 0 && manifold.bodies.iter().any(is_awake)
}

/// The first colour that neither of two has.
fn free(bodies: &mut [Body], numbers: [u32; 2]) -> usize {
    let numbers = numbers.map(|number| number as usize);
    let taken = bodies[numbers[0]].colours | bodies[numbers[1]].colours;
    let colour = (taken.trailing_ones() as usize).min(COLOURS - 1);
    for number in numbers {
        if bodies[number].moves() {
            bodies[number].colours |= 1 << colour;
        }
    }
    colour
}
