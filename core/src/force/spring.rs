//! Damped springs between particles of the scene's start, and where their ends are.

use crate::math::sin_cos_turns;
use crate::memory::{Columns, Status};
use crate::time::Time;
use core::ops::Range;

/// A damped spring: on its first end acts k (d − rest) + kd (v₂ − v₁)·d̂ toward the second, and the opposite on that.
///
/// It damps along itself only. A spring whose ends coincide has no direction and does nothing; one that has lost an
/// end, or is broken, does nothing either.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Spring {
    /// The particles it joins, by their place in the scene's start. Changed ends make another list of springs ([`Scene::springs`](crate::Scene::springs)).
    pub ends: [u32; 2],
    /// The length at which it neither pulls nor pushes \[m\].
    pub rest_length: f32,
    /// Stiffness k \[N/m\].
    pub ks: f32,
    /// Damping kd \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub kd: f32,
    /// The drive that changes its rest length over time, as a muscle does.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub drive: Option<Drive>,
    /// It breaks, for ever, where a step ends with it so many times as long as at rest.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub breaks_at: Option<f32>,
}

/// A rest length that swings: rest × (1 + amplitude sin 2π (frequency t + phase)).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Drive {
    /// As a share of the rest length.
    pub amplitude: f32,
    /// Swings per second \[Hz\].
    pub frequency: f32,
    /// Where it begins, in turns: a quarter is the longest.
    #[cfg_attr(feature = "serde", serde(default))]
    pub phase: f32,
}

impl Drive {
    /// Sine and cosine of its angle. The phase is counted in whole numbers, so it does not fade as time goes on.
    fn angle(&self, time: Time) -> (f32, f32) {
        sin_cos_turns(time.turns(self.frequency) + self.phase)
    }
}

impl Spring {
    /// A spring that does not damp, swing or break.
    #[must_use]
    pub const fn new(ends: [u32; 2], rest_length: f32, ks: f32) -> Self {
        Self { ends, rest_length, ks, kd: 0.0, drive: None, breaks_at: None }
    }

    /// The same with a damping \[N s/m\].
    #[must_use]
    pub const fn damped(self, kd: f32) -> Self {
        Self { kd, ..self }
    }

    /// Its rest length at an instant \[m\].
    #[must_use]
    pub fn rest(&self, time: Time) -> f32 {
        self.drive.map_or(self.rest_length, |drive| self.rest_length * (1.0 + drive.amplitude * drive.angle(time).0))
    }

    /// How fast its rest length grows at an instant \[m/s\].
    #[cfg(feature = "std")]
    pub(super) fn lengthening(&self, time: Time) -> f64 {
        self.drive.map_or(0.0, |drive| {
            let turning = f64::from(drive.frequency) * core::f64::consts::TAU;
            f64::from(self.rest_length) * f64::from(drive.amplitude) * turning * f64::from(drive.angle(time).1)
        })
    }
}

/// Marks a broken spring in the lists of its ends.
pub(super) const BROKEN: u32 = 1 << 31;

/// Tells whether an entry in a list of springs is that of a broken one.
pub(crate) const fn is_broken(entry: u32) -> bool {
    entry & BROKEN != 0
}

/// Where a spring's number stands in a particle's list, which is in the order of the springs, if it does.
pub(super) fn place_in(list: &[u32], number: usize) -> usize {
    list.partition_point(|entry| ((entry & !BROKEN) as usize) < number)
}

/// The scene's springs and where their ends are now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Springs<'a> {
    /// The springs of the scene.
    pub springs: &'a [Spring],
    /// The number of particles that the scene starts with.
    pub(crate) start: u32,
    pub(crate) serial: &'a [u32],
    pub(crate) row_of: &'a [u32],
    pub(crate) last_spring: &'a [u32],
    pub(crate) incident: &'a [u32],
}

/// A spring that holds, where it is.
#[derive(Clone, Copy, Debug)]
pub struct Held<'a> {
    /// Its place in the scene's list.
    pub number: usize,
    /// Itself.
    pub spring: &'a Spring,
    /// The rows of its ends.
    pub rows: [usize; 2],
}

impl<'a> Columns<'a> {
    /// Springs, and where their ends are now.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn springs(&self, springs: &'a [Spring], status: &Status) -> Springs<'a> {
        let Columns { serial, row_of, last_spring, incident, .. } = *self;
        Springs { springs, start: status.start, serial: &serial[..status.len], row_of, last_spring, incident }
    }
}

impl<'a> Springs<'a> {
    /// Where the list of a particle's springs lies, by its number.
    pub(super) fn list(last_spring: &[u32], number: u32) -> Range<usize> {
        let n = number as usize;
        let first = n.checked_sub(1).map_or(Some(0), |before| last_spring.get(before).copied());
        let last = last_spring.get(n).copied();
        first.zip(last).map_or(0..0, |(first, last)| first as usize..last as usize)
    }

    /// The springs that hold at the particle in `row`, each with the number of its other end.
    pub(super) fn at(&self, row: usize) -> impl Iterator<Item = (&'a Spring, u32)> {
        let Self { springs, incident, last_spring, .. } = *self;
        let number = self.serial.get(row).copied().filter(|&number| self.row(number) == Some(row));
        let list = number.and_then(|number| incident.get(Self::list(last_spring, number))).unwrap_or_default();
        // A broken spring's number is beyond them all.
        list.iter().filter_map(move |&i| springs.get(i as usize)).map(move |spring| {
            let [a, b] = spring.ends;
            (spring, if Some(a) == number { b } else { a })
        })
    }

    /// The row of the particle that was number `number` at the start, if it lives.
    #[must_use]
    pub fn row(&self, number: u32) -> Option<usize> {
        // The start was put in first, so its slots are its numbers; a slot given again has another serial, and beyond
        // those that found room there are none.
        let row = *self.row_of.get(number as usize)? as usize;
        (number < self.start && self.serial.get(row) == Some(&number)).then_some(row)
    }

    /// Tells whether the spring of this number in the scene's list is broken.
    #[must_use]
    pub fn is_broken(&self, number: usize) -> bool {
        let Some(spring) = self.springs.get(number) else { return false };
        let list = self.incident.get(Self::list(self.last_spring, spring.ends[0])).unwrap_or_default();
        list.get(place_in(list, number)).is_some_and(|&entry| entry == number as u32 | BROKEN)
    }

    /// Tells whether a spring that joined two particles of the start is broken.
    pub(crate) fn is_torn(&self, a: u32, b: u32) -> bool {
        let list = self.incident.get(Self::list(self.last_spring, a)).unwrap_or_default();
        list.iter().filter(|&&entry| entry & BROKEN != 0).any(|entry| {
            let spring = self.springs.get((entry & !BROKEN) as usize);
            spring.is_some_and(|spring| spring.ends == [a, b] || spring.ends == [b, a])
        })
    }

    /// The springs that hold.
    pub fn held(&self) -> impl Iterator<Item = Held<'a>> {
        let this = *self;
        this.springs.iter().enumerate().filter_map(move |(number, spring)| {
            let rows = [this.row(spring.ends[0])?, this.row(spring.ends[1])?];
            let broken = spring.breaks_at.is_some() && this.is_broken(number);
            (!broken && rows[0] != rows[1]).then_some(Held { number, spring, rows })
        })
    }

    /// The rows of both ends of every spring that holds.
    pub fn ends(&self) -> impl Iterator<Item = [usize; 2]> {
        self.held().map(|held| held.rows)
    }

    /// Counts the springs of which an end does not live.
    pub(super) fn lacking(&self) -> u64 {
        let lacks = |spring: &&Spring| spring.ends.iter().any(|&end| self.row(end).is_none());
        self.springs.iter().filter(lacks).count() as u64
    }

    /// Counts the springs that hold the particle in `row`.
    pub(super) fn held_by(&self, row: usize) -> u64 {
        let other_row = |(_, other)| self.row(other).filter(|&other| other != row);
        self.at(row).filter_map(other_row).count() as u64
    }
}
