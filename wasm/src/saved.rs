//! States of a world that it can go back to.

use crate::clock::Clock;
use crate::memory;
use pointmass::draw::{Knot, Ring};
use pointmass::{Heap, System};
use wasm_bindgen::prelude::*;

/// All of a world that time changes.
#[derive(Debug)]
pub(crate) struct State {
    pub(crate) system: System<Heap>,
    pub(crate) clock: Clock,
    /// Twice the largest radius that has been put in \[m\].
    pub(crate) widest: f32,
    /// The memory of trails, where some material leaves one.
    pub(crate) rings: Vec<Ring>,
    pub(crate) knots: Vec<Knot>,
}

impl State {
    /// A copy.
    fn copy(&self) -> Result<Self, JsError> {
        const WHAT: &str = "one more state of the world";
        let system = self.system.try_clone().map_err(|_| memory::lacking(WHAT))?;
        let (rings, knots) = (memory::copied(&self.rings, WHAT)?, memory::copied(&self.knots, WHAT)?);
        Ok(Self { system, clock: self.clock, widest: self.widest, rings, knots })
    }

    /// Becomes like another in the memory that it has.
    fn go_back(&mut self, other: &Self) {
        self.system.clone_from(&other.system);
        (self.clock, self.widest) = (other.clock, other.widest);
        self.rings.clone_from(&other.rings);
        self.knots.clone_from(&other.knots);
    }
}

/// States that have been saved, by numbers of which none is given twice.
#[derive(Debug, Default)]
pub(crate) struct Saved {
    states: Vec<(u32, State)>,
    next: u32,
}

impl Saved {
    /// Saves a copy; returns its number.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub(crate) fn save(&mut self, state: &State) -> Result<u32, JsError> {
        memory::room_for_little()?;
        let copy = state.copy()?;
        self.states.push((self.next, copy));
        self.next = self.next.wrapping_add(1);
        Ok(self.next.wrapping_sub(1))
    }

    /// Makes a state like the one of a number.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn restore(&self, number: u32, state: &mut State) -> Result<(), JsError> {
        let saved = self.states.iter().find(|&&(known, _)| known == number);
        let (_, saved) =
            saved.ok_or_else(|| JsError::new(&format!("no state {number} is saved: save() gives the numbers")))?;
        state.go_back(saved);
        Ok(())
    }

    /// Gives back the memory of the one of a number; tells whether there was one.
    pub(crate) fn forget(&mut self, number: u32) -> bool {
        let place = self.states.iter().position(|&(known, _)| known == number);
        place.map(|place| self.states.swap_remove(place)).is_some()
    }
}
