//! The shutter of a film's camera: where particles were when it opened.

use glam::Vec3;
use pointmass::Time;
use pointmass::force::State;
use std::collections::HashMap;

/// The places of particles at an instant, by their serials.
#[derive(Debug, Default)]
struct Places {
    time: Time,
    places: HashMap<u32, Vec3>,
}

/// A shutter that closes at the instant of each picture.
#[derive(Debug)]
pub(crate) struct Shutter {
    /// How long it is open \[s\].
    seconds: f64,
    opens: Time,
    /// The last that was seen while it was closed.
    closed: Places,
    /// The places as it opened, once that is over.
    opened: Option<HashMap<u32, Vec3>>,
}

impl Shutter {
    pub(crate) fn new(seconds: f64) -> Self {
        Self { seconds, opens: Time::ZERO, closed: Places::default(), opened: None }
    }

    /// How long it is open \[s\].
    pub(crate) fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Waits for the picture at an instant \[s\].
    pub(crate) fn wait_for(&mut self, instant: f64) {
        self.opens = Time::from_seconds_f64((instant - self.seconds).max(0.0));
        self.opened = None;
    }

    /// Looks on after each step. Between two steps particles go straight.
    pub(crate) fn look(&mut self, state: &State<'_>, serial: &[u32]) {
        if self.opened.is_some() && state.time > self.opens {
            return;
        }
        let places = || serial.iter().copied().zip(state.position.iter().copied());
        if state.time <= self.opens {
            self.closed = Places { time: state.time, places: places().collect() };
            return;
        }
        let Places { time, places: before } = &self.closed;
        let share = (self.opens - *time).seconds() / (state.time - *time).seconds();
        let opened = places().filter_map(|(serial, place)| Some((serial, before.get(&serial)?.lerp(place, share))));
        self.opened = Some(opened.collect());
    }

    /// Where the particle in a row was as the shutter opened; who has been born since, at its birth.
    pub(crate) fn opening(&self, state: &State<'_>, row: usize, serial: u32) -> Vec3 {
        let known = self.opened.as_ref().unwrap_or(&self.closed.places).get(&serial).copied();
        known.unwrap_or_else(|| {
            let since = state.born[row].max(self.opens).min(state.time);
            state.position[row] - state.velocity[row] * (state.time - since).seconds()
        })
    }

    /// A picture has been taken; what is there is known for the next one.
    pub(crate) fn close(&mut self, state: &State<'_>, serial: &[u32]) {
        let places = serial.iter().copied().zip(state.position.iter().copied()).collect();
        self.closed = Places { time: state.time, places };
    }
}
