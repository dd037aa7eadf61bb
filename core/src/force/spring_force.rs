//! The springs of a scene, as a step calls upon them: their sum is a force; they are sorted by their ends, and break.

#[cfg(feature = "std")]
use super::near::wide_between;
use super::spring::{BROKEN, place_in};
use super::{Force, Held, Perturbation, Spring, Springs, State};
use crate::collide::LeadCode;
use crate::composed::stands_for;
use crate::math::{length, max};
use core::ops::Range;
use glam::Vec3;

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

stands_for! {
    SpringList {
        fn list(&self) -> &[Spring] {
            (**self).list()
        }
        fn code(&self) -> Option<SpringCode> {
            (**self).code()
        }
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

/// The sum of springs, as a force.
pub(crate) type SpringForce = for<'s> fn(&'s Springs<'s>) -> &'s dyn Force;

/// The functions that springs call for in a step. A program without springs does not carry them about.
#[derive(Clone, Copy, Debug)]
pub struct SpringCode {
    /// Their sum, as a force.
    pub(crate) force: SpringForce,
    /// Tells lists apart by how many springs there are and by their ends; of none it is zero.
    pub(crate) name: fn(&[Spring]) -> u32,
    /// Sorts them by their ends.
    pub(crate) sort: fn(&[Spring], &mut [u32], &mut [u32]),
    /// Counts those that lack an end.
    pub(crate) lacking: fn(&Springs<'_>) -> u64,
    /// Counts those that hold the particle in a row.
    pub(crate) held_by: fn(&Springs<'_>, usize) -> u64,
    /// Breaks those that are stretched too far, and says how many if any can: of the state, and the springs by their ends.
    pub(crate) snap: fn(&State<'_>, &mut [u32]) -> Option<u64>,
    /// The code that leaves their method alone along surfaces that particles meet.
    pub(crate) lead: LeadCode,
}

impl SpringCode {
    /// All of it.
    pub const ALL: Self = Self {
        force: |springs| springs,
        name: name_of,
        sort: sort_by_ends,
        lacking: |table| table.lacking(),
        held_by: |table, row| table.held_by(row),
        snap,
        lead: LeadCode::ALL,
    };
}

impl Spring {
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
/// Both are all zeros before.
fn sort_by_ends(springs: &[Spring], last: &mut [u32], incident: &mut [u32]) {
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
}

/// The name of a list, a sum over its springs of their places and ends, mixed. It is asked for in each step, so no term waits for another.
fn name_of(springs: &[Spring]) -> u32 {
    let mixed = |(place, spring): (usize, &Spring)| {
        let [a, b] = spring.ends;
        let ends = a.wrapping_mul(0x9e37_79b1) ^ b;
        let mixed = ends.wrapping_add(place as u32).wrapping_mul(0x85eb_ca6b);
        (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d)
    };
    let sum = springs.iter().enumerate().map(mixed).fold(springs.len() as u32, u32::wrapping_add);
    if springs.is_empty() { 0 } else { sum.max(1) }
}
