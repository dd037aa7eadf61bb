//! Damped springs between particles of the scene's start.

use super::{Force, State};
use crate::math::length;
use core::ops::Range;
use glam::Vec3;

/// A damped spring: on its first end acts k (d − rest) + kd (v₂ − v₁)·d̂ toward the second, and the opposite on that.
///
/// It damps along itself only. A spring whose ends coincide has no direction and does nothing; one that has lost an
/// end does nothing either.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Spring {
    /// The particles it joins, by their place in the scene's start.
    pub ends: [u32; 2],
    /// The length at which it neither pulls nor pushes \[m\].
    pub rest_length: f32,
    /// Stiffness k \[N/m\].
    pub ks: f32,
    /// Damping kd \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub kd: f32,
}

/// The scene's springs and where their ends are now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Springs<'a> {
    /// The springs of the scene.
    pub springs: &'a [Spring],
    /// How many particles the scene starts with.
    pub(crate) start: u32,
    pub(crate) serial: &'a [u32],
    pub(crate) row_of: &'a [u32],
    pub(crate) last_spring: &'a [u32],
    pub(crate) incident: &'a [u32],
}

impl<'a> Springs<'a> {
    /// The springs at the particle in `row`, each with the number of its other end.
    fn at(&self, row: usize) -> impl Iterator<Item = (&'a Spring, u32)> {
        let Self { springs, incident, last_spring, .. } = *self;
        let number = self.serial.get(row).copied().filter(|&number| self.row(number) == Some(row));
        let range = number.and_then(|n| {
            let first = if n == 0 { 0 } else { *last_spring.get(n as usize - 1)? };
            Some(first as usize..*last_spring.get(n as usize)? as usize)
        });
        let list = range.and_then(|range| incident.get(range)).unwrap_or_default();
        list.iter().filter_map(move |&i| springs.get(i as usize)).map(move |spring| {
            let [a, b] = spring.ends;
            (spring, if Some(a) == number { b } else { a })
        })
    }

    /// The row of the particle that was number `number` at the start, if it lives.
    fn row(&self, number: u32) -> Option<usize> {
        // The start was put in first, so its slots are its numbers; a slot given again has another serial, and beyond
        // those that found room there are none.
        let row = *self.row_of.get(number as usize)? as usize;
        (number < self.start && self.serial.get(row) == Some(&number)).then_some(row)
    }

    /// The rows of both ends of every spring that still has them.
    pub fn ends(&self) -> impl Iterator<Item = [usize; 2]> {
        self.springs.iter().filter_map(|spring| Some([self.row(spring.ends[0])?, self.row(spring.ends[1])?]))
    }

    /// How many springs the particle in `row` holds whose other end lives.
    pub(crate) fn held_by(&self, row: usize) -> u64 {
        let other_row = |(_, other)| self.row(other).filter(|&other| other != row);
        self.at(row).filter_map(other_row).count() as u64
    }
}

impl Force for Springs<'_> {
    /// Each particle gathers from its own list, in the springs' order.
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        if self.springs.is_empty() {
            return;
        }
        for (total, row) in total.iter_mut().zip(rows) {
            for (spring, other) in self.at(row) {
                let Some(other) = self.row(other) else { continue };
                let toward = state.position[other] - state.position[row];
                let d = length(toward);
                if d > 0.0 {
                    let along = toward / d;
                    let closing = (state.velocity[other] - state.velocity[row]).dot(along);
                    let pull = spring.ks * (d - spring.rest_length) + spring.kd * closing;
                    // An end that is not finite goes at the end of the step, and goes alone.
                    *total += if pull.abs() < f32::INFINITY { along * pull } else { Vec3::ZERO };
                }
            }
        }
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let ends = |s: &Spring| Some((self.row(s.ends[0])?, self.row(s.ends[1])?));
        let stored = |s: &Spring| {
            let (a, b) = ends(s)?;
            let d = (state.position[a] - state.position[b]).to_array().map(f64::from);
            let stretch = libm::sqrt(d.iter().map(|d| d * d).sum()) - f64::from(s.rest_length);
            Some(0.5 * f64::from(s.ks) * stretch * stretch)
        };
        self.springs.iter().filter_map(stored).sum()
    }
}

/// Sorts the springs by the particles at their ends: `incident[last[n − 1]..last[n]]` are those of number n.
pub(crate) fn sort_by_ends(springs: &[Spring], last: &mut [u32], incident: &mut [u32]) {
    let ends = || springs.iter().enumerate().flat_map(|(i, s)| s.ends.map(|end| (i as u32, end as usize)));
    last.fill(0);
    for (_, end) in ends() {
        if let Some(count) = last.get_mut(end) {
            *count += 1;
        }
    }
    let mut sum = 0;
    for count in last.iter_mut() {
        sum += *count;
        *count = sum - *count;
    }
    // Each entry is now where its list begins, and moves to where it ends as the list fills.
    for (spring, end) in ends() {
        let Some(place) = last.get_mut(end) else { continue };
        if let Some(slot) = incident.get_mut(*place as usize) {
            *slot = spring;
            *place += 1;
        }
    }
}
