//! What particles tell the bodies that they are of, and what these tell them: eight bodies side by side.

use super::super::{Bodies, CARRIED, SHIFTED};
use super::RigidBox;
use super::body::Body;
use super::kept::Kept;
use super::made::Made;
use super::pose::Pose;
use crate::lanes::{ABREAST, Eight, Kernel, LANES, Vectors, run};
use bytemuck::Zeroable;
use core::ops::Range;
use glam::Vec3;

/// A body whose particles have rows one behind the other.
#[derive(Clone, Copy)]
struct One {
    body: u32,
    /// The first row, and where the places of its particles begin.
    row: u32,
    place: u32,
}

/// As many bodies as go side by side, of equally many particles: four or a multiple of that.
#[derive(Default)]
struct Few {
    all: heapless::Vec<One, LANES>,
    /// The number of particles of each.
    count: u32,
}

/// Lets those that are awake take in what has been done to their particles.
pub(super) fn gather(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, boxes: &[RigidBox]) {
    let seconds = bodies.substep.seconds();
    each(bodies, kept, boxes, &mut |body| !body.sleeps(), &mut |bodies, kept, whom| match whom {
        Whom::One(body, of, places) => {
            kept.bodies[body].gather(bodies, Made { of, places: kept.places.get(places).unwrap_or_default() });
        }
        // Chips take them one by one.
        Whom::Few(few) if ABREAST > 1 => {
            let sums = run(Sums { bodies, all: kept.bodies, places: kept.places, few });
            for (one, sums) in few.all.iter().zip(sums) {
                let body = &mut kept.bodies[one.body as usize];
                body.begin();
                body.take(sums, seconds);
            }
        }
        Whom::Few(_) => {}
    });
}

/// Puts particles where those say that have news.
pub(super) fn tell(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, boxes: &[RigidBox]) {
    each(bodies, kept, boxes, &mut |body| body.has_news() && body.tells(), &mut |bodies, kept, whom| match whom {
        Whom::One(body, of, places) => {
            kept.bodies[body].tell(bodies, Made { of, places: kept.places.get(places).unwrap_or_default() });
        }
        Whom::Few(few) if ABREAST > 1 => run(Places { bodies, all: kept.bodies, places: kept.places, few }),
        Whom::Few(_) => {}
    });
}

/// Who is to do something: one body, and where the places of its particles are, or some.
enum Whom<'a> {
    One(usize, &'a RigidBox, Range<usize>),
    Few(&'a Few),
}

/// Calls up those that a condition holds for, as many side by side as may be.
fn each(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    boxes: &[RigidBox],
    which: &mut dyn FnMut(&mut Body) -> bool,
    visit: &mut dyn FnMut(&mut Bodies<'_>, &mut Kept<'_>, Whom<'_>),
) {
    let (mut few, mut end) = (Few::default(), 0);
    for (i, of) in boxes.iter().enumerate() {
        let (number, first) = (i + 1, end);
        end += 3 * of.count as usize;
        let Some(body) = kept.bodies.get_mut(number) else { continue };
        if !which(body) {
            continue;
        }
        let abreast = ABREAST > 1 && body.moves() && (of.count as usize).is_multiple_of(FOUR);
        let made = Made { of, places: &[] };
        let rows = made.run(bodies).filter(|_| abreast);
        // Those that share particles are called up one after the other, as they are on chips.
        let waits = rows.as_ref().is_some_and(|rows| few.takes(rows, of.count));
        if !few.all.is_empty() && !waits {
            visit(bodies, kept, Whom::Few(&few));
            few.all.clear();
        }
        let Some(rows) = rows else {
            visit(bodies, kept, Whom::One(number, of, first..end));
            continue;
        };
        few.count = of.count;
        let _ = few.all.push(One { body: number as u32, row: rows.start as u32, place: first as u32 });
    }
    if !few.all.is_empty() {
        visit(bodies, kept, Whom::Few(&few));
    }
}

/// Particles of each body that are looked at in one go, and the numbers of three coordinates each.
const FOUR: usize = 4;
const COORDINATES: usize = 3 * FOUR;

impl Few {
    /// Tells whether there is room for another of so many particles, which has none of theirs.
    fn takes(&self, rows: &Range<usize>, count: u32) -> bool {
        let is_apart = |one: &One| {
            let first = one.row as usize;
            rows.end <= first || first + self.count as usize <= rows.start
        };
        self.count == count && !self.all.is_full() && self.all.iter().all(is_apart)
    }

    /// Those bodies; `nobody` in lanes that are left.
    #[inline(always)]
    fn bodies<'a>(&self, all: &'a [Body], nobody: &'a Body) -> [&'a Body; LANES] {
        let mut bodies = [nobody; LANES];
        for (place, one) in bodies.iter_mut().zip(&self.all) {
            *place = all.get(one.body as usize).unwrap_or(nobody);
        }
        bodies
    }

    /// Three coordinates each of four particles of each body, which begin so far into a column for the first of its particles.
    #[inline(always)]
    fn four<F: Eight>(&self, like: F, column: &[f32], first: impl Fn(&One) -> usize) -> [Vectors<F>; FOUR] {
        let (mut a, mut b, mut c) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES], [[0.0; 4]; LANES]);
        for (lane, one) in self.all.iter().enumerate().take(LANES) {
            let numbers = column.get(first(one)..).and_then(|rest| rest.first_chunk::<COORDINATES>());
            if let Some(&[p, q, r, s, t, u, v, w, x, y, z, last]) = numbers {
                (a[lane], b[lane], c[lane]) = ([p, q, r, s], [t, u, v, w], [x, y, z, last]);
            }
        }
        let ([p, q, r, s], [t, u, v, w], [x, y, z, last]) = (like.quads_of(a), like.quads_of(b), like.quads_of(c));
        [Vectors([p, q, r]), Vectors([s, t, u]), Vectors([v, w, x]), Vectors([y, z, last])]
    }

    /// The masses of four particles of each body.
    #[inline(always)]
    fn masses<F: Eight>(&self, like: F, mass: &[f32], number: usize) -> [F; FOUR] {
        let mut rows = [[0.0; 4]; LANES];
        for (row, one) in rows.iter_mut().zip(&self.all) {
            let masses = mass.get(one.row as usize + number..).and_then(|rest| rest.first_chunk());
            *row = masses.copied().unwrap_or_default();
        }
        like.quads_of(rows)
    }
}

/// Sums up how far particles have gone from where their bodies say, and how their velocities and angular momenta differ, as [`Body::gather`] does.
struct Sums<'a, 'b> {
    bodies: &'a Bodies<'b>,
    all: &'a [Body],
    places: &'a [u32],
    few: &'a Few,
}

impl Kernel for Sums<'_, '_> {
    type Output = [[Vec3; 3]; LANES];
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let Self { bodies, all, places, few } = self;
        let nobody = Body::zeroed();
        let pose = Pose::of(like, &few.bodies(all, &nobody));
        let [at, moving] = [&*bodies.position, &*bodies.velocity].map(bytemuck::cast_slice);
        let (zero, places) = (like.all(0.0), bytemuck::cast_slice(places));
        let (mut way, mut push, mut torque) = (Vectors([zero; 3]), Vectors([zero; 3]), Vectors([zero; 3]));
        for number in (0..few.count as usize).step_by(FOUR) {
            let place = few.four(like, places, |one| one.place as usize + 3 * number);
            let position = few.four(like, at, |one| 3 * (one.row as usize + number));
            let velocity = few.four(like, moving, |one| 3 * (one.row as usize + number));
            let mass = few.masses(like, bodies.mass, number);
            for k in 0..FOUR {
                let arm = pose.arm(place[k]);
                let share = mass[k] * pose.motion.inverse_mass;
                let change = (velocity[k] - pose.motion.at(arm)) * share;
                way = way + (position[k] - (pose.center + arm)) * share;
                push = push + change;
                torque = torque + arm.cross(change);
            }
        }
        let (way, push, torque) = (way.rows(), push.rows(), torque.rows());
        let mut sums = [[Vec3::ZERO; 3]; LANES];
        for (lane, sums) in sums.iter_mut().enumerate() {
            *sums = [vector(way[lane]), vector(push[lane]), vector(torque[lane])];
        }
        sums
    }
}

/// Puts particles where their bodies say, as [`Body::tell`] does.
struct Places<'a, 'b> {
    bodies: &'a mut Bodies<'b>,
    all: &'a [Body],
    places: &'a [u32],
    few: &'a Few,
}

impl Kernel for Places<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { bodies, all, places, few } = self;
        let nobody = Body::zeroed();
        let pose = Pose::of(like, &few.bodies(all, &nobody));
        let places = bytemuck::cast_slice(places);
        for number in (0..few.count as usize).step_by(FOUR) {
            let arm = few.four(like, places, |one| one.place as usize + 3 * number);
            let (mut at, mut moving) = (arm, arm);
            for k in 0..FOUR {
                let arm = pose.arm(arm[k]);
                (at[k], moving[k]) = (pose.center + arm, pose.motion.at(arm));
            }
            put(few, number, at, bytemuck::cast_slice_mut(bodies.position));
            put(few, number, moving, bytemuck::cast_slice_mut(bodies.velocity));
        }
        for one in &few.all {
            let rows = one.row as usize..one.row as usize + few.count as usize;
            bodies.marks.get_mut(rows).unwrap_or_default().iter_mut().for_each(|mark| *mark |= SHIFTED | CARRIED);
        }
    }
}

/// Writes the coordinates of four particles of each body into a column, from the particle with a number on.
#[inline(always)]
fn put<F: Eight>(few: &Few, number: usize, vectors: [Vectors<F>; FOUR], column: &mut [f32]) {
    let [Vectors([p, q, r]), Vectors([s, t, u]), Vectors([v, w, x]), Vectors([y, z, last])] = vectors;
    let (a, b, c) = (F::rows_of([p, q, r, s]), F::rows_of([t, u, v, w]), F::rows_of([x, y, z, last]));
    for (lane, one) in few.all.iter().enumerate().take(LANES) {
        let first = 3 * (one.row as usize + number);
        if let Some(numbers) = column.get_mut(first..).and_then(|rest| rest.first_chunk_mut::<COORDINATES>()) {
            let ([p, q, r, s], [t, u, v, w], [x, y, z, last]) = (a[lane], b[lane], c[lane]);
            *numbers = [p, q, r, s, t, u, v, w, x, y, z, last];
        }
    }
}

#[inline(always)]
fn vector([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}
