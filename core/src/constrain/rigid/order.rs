//! The order in which all that touch are gone over: those that share no moving body side by side.

use super::body::Body;
use super::manifold::Manifold;
use super::scenery::DIRECTIONS;
use crate::lanes::ABREAST;
use core::ops::Range;

/// Colours of pairs: those of one share no moving body. Those that find none of the others have the last, one after the other.
const COLOURS: usize = 24;

/// All of some colours: first pairs, then the scenery.
const ALL: usize = COLOURS + DIRECTIONS;

/// The points of all that touch and are not asleep, colour by colour.
pub(super) struct Order<'a> {
    pairs: &'a mut [Manifold],
    scenery: &'a mut [Manifold],
    /// Their numbers: the pairs, then those of the scenery.
    numbers: &'a [u32],
    /// Where the colours begin.
    starts: &'a [u32; ALL + 1],
}

/// The order alone.
pub(super) struct Numbers<'a> {
    numbers: &'a mut [u32],
    starts: [u32; ALL + 1],
}

impl<'a> Numbers<'a> {
    /// Colours pairs and scenery one after the other: each gets the first colour that neither of its bodies has yet. `memory` is a word for each.
    pub(super) fn of(bodies: &mut [Body], [pairs, scenery]: [&mut [Manifold]; 2], memory: &'a mut [u32]) -> Self {
        bodies.iter_mut().for_each(|body| body.colours = 0);
        let mut starts = [0u32; ALL + 1];
        for manifold in pairs.iter_mut() {
            manifold.colour = u32::MAX;
            if is_active(bodies, manifold) {
                let colour = free(bodies, manifold.bodies);
                manifold.colour = colour as u32;
                starts[colour + 1] += 1;
            }
        }
        for (body, slots) in bodies[1..].iter().zip(scenery.chunks_exact_mut(DIRECTIONS)) {
            for (direction, slot) in slots.iter_mut().enumerate().filter(|(_, slot)| slot.count > 0 && body.is_awake())
            {
                let colour = COLOURS + direction;
                slot.colour = colour as u32;
                starts[colour + 1] += 1;
            }
        }
        for colour in 0..ALL {
            starts[colour + 1] += starts[colour];
        }
        let mut next = starts;
        let mut put = |number: usize, manifold: &Manifold| {
            let Some(next) = next.get_mut(manifold.colour as usize) else { return };
            if let Some(place) = memory.get_mut(*next as usize) {
                *place = number as u32;
            }
            *next += 1;
        };
        pairs.iter().enumerate().for_each(|(number, manifold)| put(number, manifold));
        let awake = bodies[1..].iter().enumerate().filter(|(_, body)| body.is_awake());
        for number in awake.flat_map(|(body, _)| DIRECTIONS * body..DIRECTIONS * (body + 1)) {
            if let Some(slot) = scenery.get(number).filter(|slot| slot.count > 0) {
                put(pairs.len() + number, slot);
            }
        }
        Self { numbers: memory, starts }
    }

    /// The same with what it is the order of.
    pub(super) fn with<'b>(&'b self, [pairs, scenery]: [&'b mut [Manifold]; 2]) -> Order<'b> {
        let count = (self.starts[ALL] as usize).min(self.numbers.len());
        Order { pairs, scenery, numbers: &self.numbers[..count], starts: &self.starts }
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

impl Order<'_> {
    /// The number of those in it.
    pub(super) fn len(&self) -> usize {
        self.numbers.len()
    }

    pub(super) fn colours(&self) -> usize {
        ALL
    }

    /// Those of a colour, by their numbers in the order.
    pub(super) fn range(&self, colour: usize) -> Range<usize> {
        let at = |colour: usize| self.starts.get(colour).map_or(0, |&start| start as usize);
        at(colour)..at(colour + 1)
    }

    /// The number of those of a colour that may go side by side.
    pub(super) fn side_by_side(&self, colour: usize) -> usize {
        if colour + 1 == COLOURS { 1 } else { ABREAST }
    }

    #[inline(always)]
    pub(super) fn get(&self, number: usize) -> Option<&Manifold> {
        let number = *self.numbers.get(number)? as usize;
        self.pairs.get(number).or_else(|| self.scenery.get(number - self.pairs.len()))
    }

    #[inline(always)]
    pub(super) fn get_mut(&mut self, number: usize) -> Option<&mut Manifold> {
        let number = *self.numbers.get(number)? as usize;
        let pairs = self.pairs.len();
        self.pairs.get_mut(number).or_else(|| self.scenery.get_mut(number.wrapping_sub(pairs)))
    }
}
