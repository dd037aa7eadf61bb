//! Damped springs between particles of the scene's start.

#[cfg(feature = "std")]
use super::near::wide_between;
use super::{Force, Perturbation, State};
use crate::collide::LeadCode;
use crate::math::{length, max, sin_cos_turns};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// A damped spring: on its first end acts k (d − rest) + kd (v₂ − v₁)·d̂ toward the second, and the opposite on that.
///
/// It damps along itself only. A spring whose ends coincide has no direction and does nothing; one that has lost an
/// end, or is broken, does nothing either.
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
    fn lengthening(&self, time: Time) -> f64 {
        self.drive.map_or(0.0, |drive| {
            let turning = f64::from(drive.frequency) * core::f64::consts::TAU;
            f64::from(self.rest_length) * f64::from(drive.amplitude) * turning * f64::from(drive.angle(time).1)
        })
    }

    /// Tells whether it holds, as number `number` of the scene's list, but is stretched beyond what it bears.
    fn is_overstretched(&self, number: usize, table: &Springs<'_>, state: &State<'_>) -> bool {
        let Some(ratio) = self.breaks_at else { return false };
        let rows = table.row(self.ends[0]).zip(table.row(self.ends[1])).filter(|_| !table.is_broken(number));
        rows.is_some_and(|(a, b)| length(state.between(a, b)) > ratio * self.rest(state.time))
    }

    /// How its force changes with its ends, positions and velocities weighed. A spring that is pressed would push sideways;
    /// that is left out, so that no mode is unstable (Choi and Ko, "Stable but Responsive Cloth", SIGGRAPH 2002).
    fn pair_stiffness(
        &self,
        a: usize,
        b: usize,
        state: &State<'_>,
        [position, velocity]: [f32; 2],
    ) -> Option<PairStiffness> {
        let toward = state.between(a, b);
        let d = length(toward);
        if !(d > 0.0 && d < f32::INFINITY) {
            return None;
        }
        let across = max(self.ks * (1.0 - self.rest(state.time) / d), 0.0);
        let axial = (max(self.ks, 0.0) - across) * position + max(self.kd, 0.0) * velocity;
        Some(PairStiffness { along: toward / d, axial, across: across * position })
    }
}

/// A spring's stiffness and damping about a pose: more `axial` than `across`, which acts in all directions.
struct PairStiffness {
    along: Vec3,
    axial: f32,
    across: f32,
}

/// Marks a broken spring in the lists of its ends.
const BROKEN: u32 = 1 << 31;

/// Tells whether an entry in a list of springs is that of a broken one.
pub(crate) const fn is_broken(entry: u32) -> bool {
    entry & BROKEN != 0
}

/// Where a spring's number stands in a particle's list, which is in the order of the springs, if it does.
fn place_in(list: &[u32], number: usize) -> usize {
    list.partition_point(|entry| ((entry & !BROKEN) as usize) < number)
}

/// The springs of a scene: a list of them, or `()`, with which a program does not carry about what only springs call for.
///
/// Arrays, vectors and references of springs are lists of them.
pub trait SpringList: Sync {
    /// All of them.
    fn list(&self) -> &[Spring];

    /// The functions that they call for in a step.
    fn code(&self) -> Option<SpringCode> {
        Some(SpringCode::ALL)
    }
}

impl SpringList for () {
    fn list(&self) -> &[Spring] {
        &[]
    }
    fn code(&self) -> Option<SpringCode> {
        None
    }
}

impl<T: SpringList + ?Sized> SpringList for &T {
    fn list(&self) -> &[Spring] {
        (**self).list()
    }
    fn code(&self) -> Option<SpringCode> {
        (**self).code()
    }
}

impl SpringList for [Spring] {
    fn list(&self) -> &[Spring] {
        self
    }
}

impl<const N: usize> SpringList for [Spring; N] {
    fn list(&self) -> &[Spring] {
        self
    }
}

impl<const N: usize> SpringList for heapless::Vec<Spring, N> {
    fn list(&self) -> &[Spring] {
        self
    }
}

#[cfg(feature = "alloc")]
impl SpringList for alloc::vec::Vec<Spring> {
    fn list(&self) -> &[Spring] {
        self
    }
}

/// The functions that springs call for in a step. A program without springs does not carry them about.
#[derive(Clone, Copy, Debug)]
pub struct SpringCode {
    /// Their sum, as a force.
    pub(crate) force: for<'s> fn(&'s Springs<'s>) -> &'s dyn Force,
    /// Sorts them by their ends at the start, and counts those that lack one.
    pub(crate) sort: fn(&[Spring], &mut [u32], &mut [u32], u32) -> u64,
    /// Counts those that hold the particle in a row.
    pub(crate) held_by: fn(&Springs<'_>, usize) -> u64,
    /// Breaks those that are stretched too far, and says how many if any can: of the state, and the springs by their ends.
    pub(crate) snap: fn(&State<'_>, &mut [u32]) -> Option<u64>,
    /// What leaves their method alone along surfaces that particles meet.
    pub(crate) lead: LeadCode,
}

impl SpringCode {
    /// All of it.
    pub const ALL: Self = Self {
        force: |springs| springs,
        sort: sort_by_ends,
        held_by: |table, row| table.held_by(row),
        snap,
        lead: LeadCode::ALL,
    };
}

/// The scene's springs and where their ends are now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Springs<'a> {
    /// The springs of the scene.
    pub springs: &'a [Spring],
    pub(crate) code: Option<SpringCode>,
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

impl<'a> Springs<'a> {
    /// Where the list of a particle's springs lies, by its number.
    fn list(last_spring: &[u32], number: u32) -> Range<usize> {
        let n = number as usize;
        let first = n.checked_sub(1).map_or(Some(0), |before| last_spring.get(before).copied());
        let last = last_spring.get(n).copied();
        first.zip(last).map_or(0..0, |(first, last)| first as usize..last as usize)
    }

    /// The springs that hold at the particle in `row`, each with the number of its other end.
    fn at(&self, row: usize) -> impl Iterator<Item = (&'a Spring, u32)> {
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

    /// Their sum, where there may be any.
    pub(crate) fn force(&self) -> Option<&dyn Force> {
        self.code.map(|code| (code.force)(self))
    }

    /// Counts the springs that hold the particle in `row`.
    fn held_by(&self, row: usize) -> u64 {
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
                let toward = state.between(row, other);
                let d = length(toward);
                if d > 0.0 {
                    let along = toward / d;
                    let closing = (state.velocity[other] - state.velocity[row]).dot(along);
                    let pull = spring.ks * (d - spring.rest(state.time)) + spring.kd * closing;
                    // An end that is not finite goes at the end of the step, and goes alone.
                    *total += if pull.abs() < f32::INFINITY { along * pull } else { Vec3::ZERO };
                }
            }
        }
    }

    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        for Held { spring, rows: [a, b], .. } in self.held() {
            let Some(bend) = spring.pair_stiffness(a, b, state, [change.position, change.velocity]) else { continue };
            let apart = change.along[b] - change.along[a];
            let pull = bend.along * (bend.axial * apart.dot(bend.along)) + apart * bend.across;
            total[a] += pull;
            total[b] -= pull;
        }
    }

    fn add_stiffness(&self, state: &State<'_>, weights: [f32; 2], total: &mut [Vec3]) {
        for Held { spring, rows: [a, b], .. } in self.held() {
            let Some(bend) = spring.pair_stiffness(a, b, state, weights) else { continue };
            let diagonal = bend.along * bend.along * bend.axial + Vec3::splat(bend.across);
            total[a] += diagonal;
            total[b] += diagonal;
        }
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let stored = |held: Held<'_>| {
            let stretch = held.pose(state).0 - f64::from(held.spring.rest(state.time));
            0.5 * f64::from(held.spring.ks) * stretch * stretch
        };
        self.held().map(stored).sum()
    }

    /// The power \[W\] that damping takes and drives give.
    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        self.damping(state) + self.driving(state)
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "springs"
    }

    #[cfg(feature = "std")]
    fn account(&self, state: &State<'_>, visit: &mut dyn FnMut(super::Entry)) {
        visit(super::Entry { name: "springs", energy: self.energy(state), power: 0.0 });
        visit(super::Entry { name: "spring damping", energy: 0.0, power: self.damping(state) });
        visit(super::Entry { name: "spring drives", energy: 0.0, power: self.driving(state) });
    }
}

#[cfg(feature = "std")]
impl Springs<'_> {
    fn damping(&self, state: &State<'_>) -> f64 {
        self.held().map(|held| -f64::from(held.spring.kd) * held.pose(state).1 * held.pose(state).1).sum()
    }

    /// The power by which rest lengths change: −k (d − rest) rest'.
    fn driving(&self, state: &State<'_>) -> f64 {
        let given = |held: Held<'_>| {
            let Held { spring, .. } = held;
            let stretch = held.pose(state).0 - f64::from(spring.rest(state.time));
            -f64::from(spring.ks) * stretch * spring.lengthening(state.time)
        };
        self.held().filter(|held| held.spring.drive.is_some()).map(given).sum()
    }
}

#[cfg(feature = "std")]
impl Held<'_> {
    /// Its length \[m\] and how fast that grows \[m/s\].
    fn pose(&self, state: &State<'_>) -> (f64, f64) {
        let [a, b] = self.rows;
        let f = |v: Vec3| v.to_array().map(f64::from);
        let v = [f(state.velocity[a]), f(state.velocity[b])];
        let apart = wide_between(state, a, b);
        let length = libm::sqrt(apart.iter().map(|x| x * x).sum());
        let opening: f64 = apart.iter().zip(v[0].iter().zip(v[1])).map(|(x, (a, b))| x * (b - a)).sum();
        (length, if length > 0.0 { opening / length } else { 0.0 })
    }
}

fn snap(state: &State<'_>, incident: &mut [u32]) -> Option<u64> {
    let mut broken = None;
    let Springs { springs, last_spring, .. } = state.springs;
    for (number, spring) in springs.iter().enumerate().filter(|(_, spring)| spring.breaks_at.is_some()) {
        let broken = broken.get_or_insert(0);
        if spring.is_overstretched(number, &Springs { incident, ..state.springs }, state) {
            mark_broken(number, spring, last_spring, incident);
            *broken += 1;
        }
    }
    broken
}

/// Marks a spring as broken in the lists of both ends.
fn mark_broken(number: usize, spring: &Spring, last_spring: &[u32], incident: &mut [u32]) {
    for end in spring.ends {
        let list = incident.get_mut(Springs::list(last_spring, end)).unwrap_or_default();
        let place = place_in(list, number);
        // One that joins a particle to itself stands there twice.
        list.iter_mut().skip(place).take(2).filter(|e| **e == number as u32).for_each(|entry| *entry |= BROKEN);
    }
}

/// Sorts the springs by the particles at their ends: `incident[last[n − 1]..last[n]]` are those of number n.
/// Both are all zeros before. Returns how many lack an end, as only `start` particles have found room.
fn sort_by_ends(springs: &[Spring], last: &mut [u32], incident: &mut [u32], start: u32) -> u64 {
    let ends = || springs.iter().enumerate().flat_map(|(i, s)| s.ends.map(|end| (i as u32, end as usize)));
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
    springs.iter().filter(|spring| spring.ends.iter().any(|&end| end >= start)).count() as u64
}
