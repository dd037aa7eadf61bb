//! The memory of contacts between sheets: what lasts through a step, and what a sub-step is worked out in.

use super::super::{Bodies, Demand, Words};
use super::contact::{Contact, Surface};
use super::near::{self, Near};
use super::rest::{Edge, KEPT, LEARNING, Rest};
use super::tree::{self, Tree};
use crate::memory::{take, take_vectors};
use glam::Vec3;

/// Contacts with each other that there is room for, for each particle, and with scenery.
const ROOM: [usize; 2] = [10, 2];
/// Contacts that there is room for besides.
const SPARE: usize = 32;
/// The row of a particle that is not there.
pub(super) const NOBODY: u32 = u32::MAX;

/// How long the lists are.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Counts {
    pub(super) contacts: u32,
    pub(super) surfaces: u32,
    pub(super) edges: u32,
    /// Half the thickness at all particles, if they are of one sheet, and it is the same at all; else no number \[m\].
    half: f32,
}

impl Counts {
    /// Notes what is the same at all particles.
    pub(super) fn compare(&mut self, rest: &Rest<'_>) {
        self.half = rest.uniform().unwrap_or(f32::NAN);
    }

    /// The half thickness at all particles, if they are of one sheet, and it is the same at all.
    pub(super) fn uniform(&self) -> Option<f32> {
        Some(self.half).filter(|half| !half.is_nan())
    }
}

/// The words that last through a step, by places in the list of particles.
pub(super) struct Kept<'m> {
    pub(super) counts: &'m mut Counts,
    pub(super) rows: &'m mut [u32],
    /// Inverse masses; zero for what does not move \[1/kg\].
    pub(super) weight: &'m mut [f32],
    /// Velocities before anything was kept apart \[m/s\].
    pub(super) pushed: &'m mut [Vec3],
    /// How far off the scenery is, at the least \[m\].
    pub(super) clear: &'m mut [f32],
    /// 1 if its way through the sub-step may pass through the scenery, plus 2 if a face is listed near it in the sub-step.
    pub(super) followed: &'m mut [u32],
    /// The edges of all triangles.
    pub(super) edges: &'m mut [Edge],
    pub(super) contacts: &'m mut [Contact],
    pub(super) surfaces: &'m mut [Surface],
    /// The lists of who may come near whom; none where too little memory is lent for that.
    pub(super) near: Option<Near<'m>>,
}

/// What a sub-step is worked out in.
pub(super) struct Work<'m> {
    /// Where particles are, where they were at the sub-step's beginning, and the places about which their turning counts \[m\].
    pub(super) now: &'m mut [Vec3],
    pub(super) from: &'m mut [Vec3],
    pub(super) arm: &'m mut [Vec3],
    /// How far they have been moved \[m\].
    pub(super) moved: &'m mut [Vec3],
    /// Where they were when it was last looked who is near whom, and how far from there they may go \[m\].
    pub(super) searched: &'m mut [Vec3],
    pub(super) room: &'m mut [f32],
    /// What each is bound to where sheets move as one, and 1 for whom the scenery holds.
    pub(super) zone: &'m mut [u32],
    pub(super) held: &'m mut [u32],
    /// The lowest of those whose sheets have come to touch each other in the sub-step.
    pub(super) group: &'m mut [u32],
    /// The contacts of before.
    pub(super) old: &'m mut [Contact],
    /// How far each has left the way that lists expect \[m\].
    pub(super) strays: &'m mut [f32],
    pub(super) tree: Tree<'m>,
}

/// Words of a thing.
const fn words<T>() -> usize {
    size_of::<T>() / 4
}

fn room(particles: usize) -> [usize; 2] {
    ROOM.map(|room| room.saturating_mul(particles).saturating_add(SPARE))
}

/// The memory that so many particles and triangles ask for.
pub(super) fn demand([particles, triangles]: [usize; 2]) -> Demand {
    let each = |count: usize, words: usize| count.saturating_mul(words);
    let sum = |parts: [usize; 3]| Words { per_row: 0, fixed: parts.into_iter().fold(0, usize::saturating_add) };
    let [contacts, surfaces] = room(particles);
    let contacts = each(contacts, words::<Contact>());
    let surfaces = each(surfaces, words::<Surface>());
    let kept = sum([KEPT[0], each(particles, KEPT[1]), each(triangles, KEPT[2])]);
    let edges = each(triangles, 3 * words::<Edge>());
    let lasting = sum([words::<Counts>(), each(particles, 7), edges]).fixed;
    let step = sum([lasting.saturating_add(near::words(particles)), contacts, surfaces]);
    let learning = sum([0, each(particles, LEARNING[0]), each(triangles, LEARNING[1])]);
    let working = sum([each(particles, 20), contacts, tree::words([particles, triangles])]);
    Demand { kept, step, scratch: learning.or(working), ..Demand::NONE }
}

impl<'m> Kept<'m> {
    /// None: the memory is too small.
    pub(super) fn of(step: &'m mut [u32], [particles, triangles]: [usize; 2]) -> Option<Self> {
        let mut rest = step;
        let counts = bytemuck::cast_slice_mut(take(&mut rest, words::<Counts>())).first_mut()?;
        let rows = take(&mut rest, particles);
        let weight = bytemuck::cast_slice_mut(take(&mut rest, particles));
        let pushed = take_vectors(&mut rest, particles);
        let clear = bytemuck::cast_slice_mut(take(&mut rest, particles));
        let followed = take(&mut rest, particles);
        let edges = bytemuck::try_cast_slice_mut(take(&mut rest, 3 * triangles * words::<Edge>())).ok()?;
        let [contacts, surfaces] = room(particles);
        let contacts = bytemuck::try_cast_slice_mut(take(&mut rest, contacts * words::<Contact>())).ok()?;
        let surfaces = bytemuck::try_cast_slice_mut(take(&mut rest, surfaces * words::<Surface>())).ok()?;
        let near = Near::of(rest, particles);
        Some(Self { counts, rows, weight, pushed, clear, followed, edges, contacts, surfaces, near })
    }

    /// The contacts of now with each other, and those with scenery.
    pub(super) fn lists(&mut self) -> (&mut [Contact], &mut [Surface]) {
        let Counts { contacts, surfaces, .. } = *self.counts;
        (&mut self.contacts[..contacts as usize], &mut self.surfaces[..surfaces as usize])
    }
}

impl<'m> Work<'m> {
    /// None: the memory is too small.
    pub(super) fn of(scratch: &'m mut [u32], [particles, triangles]: [usize; 2]) -> Option<Self> {
        let mut rest = scratch;
        let [now, from, arm, moved, searched] = core::array::from_fn(|_| take_vectors(&mut rest, particles));
        let [room_of, strays] = core::array::from_fn(|_| bytemuck::cast_slice_mut(take(&mut rest, particles)));
        let [zone, held, group] = core::array::from_fn(|_| take(&mut rest, particles));
        let old = take(&mut rest, room(particles)[0] * words::<Contact>());
        let old = bytemuck::try_cast_slice_mut(old).ok()?;
        if rest.len() < tree::words([particles, triangles]) {
            return None;
        }
        Some(Self {
            now,
            from,
            arm,
            moved,
            searched,
            room: room_of,
            zone,
            held,
            group,
            old,
            strays,
            tree: Tree::of(&mut rest, [particles, triangles]),
        })
    }

    /// Moves a particle on.
    pub(super) fn shift(&mut self, i: usize, by: Vec3) {
        self.now[i] += by;
        self.moved[i] += by;
    }

    /// Moves a particle to a place.
    pub(super) fn put(&mut self, i: usize, place: Vec3) {
        self.moved[i] += place - self.now[i];
        self.now[i] = place;
    }

    /// Takes in where all are. Whoever is not finite is not there.
    pub(super) fn gather(&mut self, bodies: &Bodies<'_>, particles: &[u32], kept: &mut Kept<'_>) {
        let h = bodies.substep.seconds();
        for (i, &number) in particles.iter().enumerate() {
            let found = bodies.row_of_start(number);
            let sound = |row: usize| {
                bodies.position[row].is_finite()
                    && bodies.velocity[row].is_finite()
                    && bodies.before[0][row].is_finite()
            };
            let found = found.filter(|&row| sound(row));
            kept.rows[i] = found.map_or(NOBODY, |row| row as u32);
            let [now, from, velocity] =
                found.map_or([Vec3::NAN; 3], |row| [bodies.position[row], bodies.before[0][row], bodies.velocity[row]]);
            let inverse = found.map_or(0.0, |row| bodies.inverse_mass[row]);
            kept.weight[i] = if inverse > 0.0 && inverse < f32::INFINITY { inverse } else { 0.0 };
            kept.pushed[i] = velocity;
            (self.now[i], self.from[i], self.arm[i]) = (now, from, now - velocity * h);
            self.moved[i] = Vec3::ZERO;
        }
    }
}
