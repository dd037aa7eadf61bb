//! How particles that nothing holds move as a whole, and what rounding takes of that.

use super::inertia::Inertia;
use super::load::Load;
use super::turn::Turn;
use super::{Bodies, SHIFTED};
use crate::index::{Room, between};
use crate::math::{dot, largest, max, min, sqrt};
use glam::Vec3;

/// Words that a debt is kept in.
pub(super) const WORDS: usize = 3;
/// Sums that go on side by side, so that rounding does not grow with the number of particles.
const SUMS: usize = 8;
/// How many roundings of their places particles have to be off a line to be told from one.
const COARSE: f32 = 8.0 * f32::EPSILON;
/// By how many roundings of velocities changes may differ that are alike.
const ALIKE: f32 = 2.0 * f32::EPSILON;

/// Particles that nothing holds, by their rows, with what they bear: who has none is not there.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    rows: &'a [u32],
    mass: &'a [f32],
    loads: &'a [Load],
    place: &'a [Vec3],
    velocity: &'a [Vec3],
    room: Option<&'a Room>,
}

/// One of them.
pub(super) struct Member {
    /// Its place in the list.
    pub(super) number: usize,
    pub(super) mass: f32,
    /// The way to it from where a whole is told from \[m\].
    pub(super) way: Vec3,
    pub(super) velocity: Vec3,
}

impl<'a> Group<'a> {
    /// They as they are.
    pub(super) fn of(bodies: &'a Bodies<'_>, rows: &'a [u32]) -> Self {
        let Bodies { mass, loads, position, velocity, .. } = bodies;
        Self { rows, mass, loads, place: position, velocity, room: bodies.near.room() }
    }

    /// They where they were as the sub-step began, with the velocities that they have.
    pub(super) fn begun(bodies: &'a Bodies<'_>, rows: &'a [u32]) -> Self {
        Self { place: bodies.before[0], ..Self::of(bodies, rows) }
    }

    /// Visits those who are there, by the ways from a place, the shortest in a room.
    pub(super) fn from(self, origin: Vec3) -> impl Iterator<Item = Member> + Clone + 'a {
        self.rows.iter().enumerate().filter_map(move |(number, &row)| {
            let row = row as usize;
            let way = between(self.room, origin, *self.place.get(row)?);
            Some(Member {
                number,
                mass: self.mass[row] + self.loads.get(row).map_or(0.0, |load| load.mass),
                way,
                velocity: self.velocity[row],
            })
        })
    }

    /// The row of the first who is there.
    fn first(self) -> Option<usize> {
        self.rows.iter().map(|&row| row as usize).find(|&row| row < self.place.len())
    }

    /// The mass of all, and where their middle is from the first of them, and where that is.
    pub(super) fn middle(self) -> Option<(f32, Vec3, Vec3)> {
        let origin = self.place[self.first()?];
        let (mut mass, mut middle) = (0.0, Vec3::ZERO);
        for member in self.from(origin) {
            mass += member.mass;
            middle += member.way * member.mass;
        }
        Some((mass, middle / mass, origin))
    }

    /// How they move as a whole; none, if nobody is there.
    pub(super) fn whole(self) -> Option<Whole> {
        let ((mass, middle, origin), slide) = (self.middle()?, self.velocity[self.first()?]);
        let drift: Vec3 = self.from(origin).map(|member| (member.velocity - slide) * member.mass).sum();
        let drift = slide + drift / mass;
        let (mut spin, mut longest) = (Vec3::ZERO, Vec3::ZERO);
        for member in self.from(origin) {
            let arm = member.way - middle;
            spin += arm.cross(member.velocity - drift) * member.mass;
            longest = if dot(arm, arm) > dot(longest, longest) { arm } else { longest };
        }
        let places = self.rows.iter().filter_map(|&row| self.place.get(row as usize));
        let coarse = COARSE * places.map(|&place| largest(place)).fold(0.0, max);
        let arms = self.from(origin).map(|member| (member.mass, member.way - middle));
        let inertia = Inertia::of(arms, longest, coarse);
        Some(Whole { origin, middle, drift, spin, inertia })
    }

    /// Tells whether their velocities have changed all alike, to rounding, since they were these: nothing has turned them.
    pub(super) fn goes_on(self, before: &[Vec3]) -> bool {
        let speed = |&row: &u32| Some([*self.velocity.get(row as usize)?, *before.get(row as usize)?]);
        let speeds = || self.rows.iter().filter_map(speed);
        let Some([first, was]) = speeds().next() else { return false };
        let sizes = |[now, was]: [Vec3; 2]| largest(now) + largest(was);
        speeds().all(|[now, then]| {
            let rounding = ALIKE * (sizes([now, then]) + sizes([first, was]));
            largest((now - then) - (first - was)) <= rounding
        })
    }

    /// The energy of their motion, beside that of their middle.
    pub(super) fn energy(self, whole: &Whole) -> Energy {
        let (mut sums, omega) = ([[0.0; SUMS]; 3], whole.omega());
        for Member { number, mass, way, velocity, .. } in self.from(whole.origin) {
            let turning = omega.cross(way - whole.middle);
            let rest = velocity - whole.drift - turning;
            for (sums, [a, b]) in sums.iter_mut().zip([[turning; 2], [rest; 2], [turning * 2.0, rest]]) {
                sums[number % SUMS] += 0.5 * mass * dot(a, b);
            }
        }
        let [turning, rest, both] = sums.map(|sums| sums.iter().sum());
        Energy { turning, rest, both }
    }

    /// All of that \[J\].
    pub(super) fn moving(self) -> f32 {
        self.whole().map_or(0.0, |whole| self.energy(&whole).with(1.0))
    }
}

/// The motion of some particles as a whole.
#[derive(Clone, Copy)]
pub(super) struct Whole {
    /// Where places are told from, and where the middle of all masses is from there \[m\].
    pub(super) origin: Vec3,
    pub(super) middle: Vec3,
    /// The velocity of the middle \[m/s\].
    pub(super) drift: Vec3,
    /// The angular momentum about the middle \[kg m²/s\], and how hard they are to turn about that.
    spin: Vec3,
    inertia: Inertia,
}

impl Whole {
    /// How all of it would turn as a rigid body \[rad/s\].
    pub(super) fn omega(&self) -> Vec3 {
        self.turning_within(f32::INFINITY).0
    }

    /// The same with no more energy than `most`, and that energy \[J\].
    pub(super) fn turning_within(&self, most: f32) -> (Vec3, f32) {
        self.inertia.turning(self.spin, most)
    }

    /// The energy of turning as a rigid body of another's shape, by the same angular momentum \[J\]: the least that there is with that.
    pub(super) fn turning_as(&self, other: &Self) -> f32 {
        other.inertia.energy(self.spin)
    }

    /// The same where rounding has taken nothing of another's momenta.
    pub(super) fn with_momenta_of(self, other: &Self) -> Self {
        Self { drift: other.drift, spin: other.spin, ..self }
    }

    /// The same of a form that is turned so.
    pub(super) fn turned(self, turn: Turn) -> Self {
        Self { inertia: self.inertia.turned(turn), ..self }
    }
}

/// The energy of a motion, beside that of the middle: that of turning, of all besides, and what both have together, which is nothing but where all are
/// near one line \[J\].
#[derive(Clone, Copy)]
pub(super) struct Energy {
    pub(super) turning: f32,
    rest: f32,
    both: f32,
}

impl Energy {
    /// All of it, where such a share is left of what is no motion of a rigid body \[J\].
    pub(super) fn with(self, share: f32) -> f32 {
        self.turning + share * (self.both + share * self.rest)
    }

    /// The share that may be left where there is so much energy for it, and turning: the larger root.
    pub(super) fn share(self, left: f32) -> f32 {
        let half = 0.5 * self.both;
        let share = (sqrt(max(half * half + self.rest * left, 0.0)) - half) / self.rest;
        if share >= 0.0 { min(share, 1.0) } else { 1.0 }
    }
}

/// The angular momentum that particles should have beyond what they have: what velocities are too coarse for, what those on a line cannot carry about it,
/// and what they have no energy for. It is added to what they are given back when they have been solved the next time.
pub(super) struct Owed<'m>(pub(super) &'m mut [u32]);

impl Owed<'_> {
    fn all(&self) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.0.get(axis).copied().map_or(0.0, f32::from_bits));
        Vec3::new(x, y, z)
    }

    fn keep(&mut self, all: Vec3) {
        // Which bits a NaN has depends on the machine, and these words are in the hash.
        let all = if all.is_finite() { all } else { Vec3::ZERO };
        self.0.iter_mut().zip(all.to_array()).for_each(|(word, part)| *word = part.to_bits());
    }

    /// Forgets it: something holds what it is of.
    pub(super) fn forget(&mut self) {
        self.0.fill(0);
    }

    /// Turns those in some rows who lie on a line so that it lies across what they had before and are owed, where rounding has turned it out of that.
    pub(super) fn lay_across(&self, bodies: &mut Bodies<'_>, rows: &[u32], before: &Whole) {
        let Some(now) = Group::of(bodies, rows).whole() else { return };
        let Some(by) = now.inertia.aslant(before.spin + self.all()) else { return };
        let room = bodies.near.room();
        for row in rows.iter().map(|&row| row as usize) {
            let Some(&place) = bodies.position.get(row) else { continue };
            let by = by.cross(between(room, now.origin, place) - now.middle);
            if by.is_finite() {
                bodies.position[row] += by;
                bodies.marks[row] |= SHIFTED;
            }
        }
    }

    /// Gives back to those in some rows what they lack of the momenta that they are due, by turning as a whole: the angular momentum that they had before
    /// they were solved, and what they were owed then. Tells what they are due.
    pub(super) fn give_back(&self, bodies: &mut Bodies<'_>, rows: &[u32], before: Option<Whole>) -> Option<Whole> {
        let before = before?;
        let due = Whole { spin: before.spin + self.all(), ..before };
        turn_on(bodies, rows, &due);
        Some(due)
    }

    /// Owes them what they lack of what they are due at the end.
    pub(super) fn note(&mut self, bodies: &Bodies<'_>, rows: &[u32], due: Option<Whole>) {
        let lack = due.and_then(|due| Some(due.spin - Group::of(bodies, rows).whole()?.spin));
        self.keep(lack.unwrap_or(Vec3::ZERO));
    }
}

/// Turns those in some rows by what they lack of another's angular momentum.
pub(super) fn turn_on(bodies: &mut Bodies<'_>, rows: &[u32], other: &Whole) {
    let Some(now) = Group::of(bodies, rows).whole() else { return };
    let (omega, _) = now.inertia.turning(other.spin - now.spin, f32::INFINITY);
    turn(bodies, rows, &now, |arm| omega.cross(arm));
}

/// Adds to velocities what is told of each by its way from the middle.
fn turn(bodies: &mut Bodies<'_>, rows: &[u32], whole: &Whole, faster: impl Fn(Vec3) -> Vec3) {
    let room = bodies.near.room();
    for row in rows.iter().map(|&row| row as usize) {
        let Some(&place) = bodies.position.get(row) else { continue };
        let by = faster(between(room, whole.origin, place) - whole.middle);
        if by.is_finite() {
            bodies.velocity[row] += by;
        }
    }
}
