//! Blows that JavaScript is told of.

use crate::memory;
use pointmass::{Attention, Id, Impact, Observer, Time, Vec3};
use wasm_bindgen::prelude::*;

/// Numbers of a blow.
pub(crate) const NUMBERS: usize = 12;
/// The id of scenery.
const SCENERY: u32 = u32::MAX;

/// Notes blows while the world goes on.
#[derive(Debug, Default)]
pub(crate) struct Blows {
    /// The speed from which on they are noted \[m/s\].
    least: f32,
    /// There is room for as many as are noted at the most.
    noted: Vec<Impact>,
    most: usize,
    missed: u32,
}

impl Blows {
    /// Listens from now on to blows of `least` m/s and more, `most` of them at a time.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub(crate) fn listen(&mut self, least: f32, most: u32) -> Result<(), JsError> {
        let noted = memory::reserved(most as usize, "so many blows")?;
        *self = Self { least, noted, most: most as usize, missed: 0 };
        Ok(())
    }

    /// The observer that watches steps for it.
    pub(crate) fn observer(&mut self) -> &mut dyn Observer {
        self
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.noted.clear();
        self.missed = 0;
    }

    /// The number of blows beyond those that there is room for.
    pub(crate) fn missed(&self) -> u32 {
        self.missed
    }

    /// Where, the other's normal, by how much the velocity has changed, how fast they came together, the mass, and how long ago from `now`.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub(crate) fn numbers(&self, now: Time) -> Result<Vec<f32>, JsError> {
        let mut list = memory::reserved(NUMBERS * self.noted.len(), "the blows")?;
        for blow in &self.noted {
            let ago = now.seconds_f64() - blow.time.seconds_f64();
            list.extend([blow.place, blow.normal, blow.after - blow.before].iter().flat_map(Vec3::to_array));
            list.extend([blow.closing, blow.mass, ago as f32]);
        }
        Ok(list)
    }

    /// The ids of who is struck, and of whom it met.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub(crate) fn ids(&self) -> Result<Vec<u32>, JsError> {
        let mut list = memory::reserved(2 * self.noted.len(), "the blows")?;
        list.extend(self.noted.iter().flat_map(|blow| [blow.id.serial(), blow.other.map_or(SCENERY, Id::serial)]));
        Ok(list)
    }

    fn note(&mut self, blow: &Impact) {
        // Steps may tell of blows though nobody listens.
        if self.most == 0 || !(blow.closing >= self.least) {
            return;
        }
        if self.noted.len() < self.most {
            self.noted.push(*blow);
        } else {
            self.missed = self.missed.saturating_add(1);
        }
    }
}

impl Observer for Blows {
    fn attention(&self) -> Attention {
        if self.most > 0 { Attention::Events } else { Attention::Nothing }
    }

    fn hit(&mut self, hit: &Impact) {
        self.note(hit);
    }

    fn touched(&mut self, touch: &Impact) {
        self.note(touch);
    }
}
