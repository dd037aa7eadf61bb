//! The trails of particles: where they have been, from a ring of places each in memory that is lent.

use super::{Line, appearance, fill};
use crate::force::State;
use crate::index::image_beside;
use crate::material::TrailMaterial;
use crate::math::min;
use crate::particles::Color;
use crate::time::Time;
use glam::Vec3;

/// A place on a trail, and when the particle was there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    place: Vec3,
    time: Time,
}

impl Knot {
    /// Nowhere, to fill a buffer with.
    pub const NONE: Self = Self { place: Vec3::ZERO, time: Time::ZERO };
}

/// Whose trail lies in a part of the memory, and how much of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ring {
    serial: u32,
    /// The number of knots that are known, and where the newest is.
    count: u32,
    newest: u32,
}

impl Ring {
    /// Nobody's, to fill a buffer with.
    pub const NONE: Self = Self { serial: 0, count: 0, newest: 0 };
}

/// The trails of all particles whose material leaves one.
///
/// Each slot has a ring and an equal share of the knots, so that memory is bounded whatever happens. Knots lie at equal times, as far as
/// whoever looks on does so often enough; when a slot is taken again, its ring begins anew. Looking changes nothing: the memory is not
/// the system's, nor in its hash.
///
/// ```
/// use pointmass::draw::{Knot, Line, Ring, Trails};
/// use pointmass::material::TrailMaterial;
/// use pointmass::{Heap, Particle, Scene, System, Time, Vec3};
///
/// let start = [Particle { velocity: Vec3::X * 3.0, ..Particle::REST }];
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let (mut rings, mut knots) = ([Ring::NONE], [Knot::NONE; 32]);
/// let all = TrailMaterial { seconds: 0.5, width: 0.0 };
/// let mut trails = Trails::new(&mut rings, &mut knots, Some(all));
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
///     trails.look(&system.state(&scene));
/// }
/// let mut lines = [Line::NONE; 32];
/// let (count, left_out) = trails.lines(&system.state(&scene), &mut lines);
/// let length: f32 = lines[..count].iter().map(|line| line.ends[0].distance(line.ends[1])).sum();
/// assert!((length - 1.5).abs() < 1e-4 && left_out == 0); // The way of half a second.
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Debug)]
pub struct Trails<'m> {
    rings: &'m mut [Ring],
    knots: &'m mut [Knot],
    /// The trail of those whose material says nothing of one, if they leave one.
    others: Option<TrailMaterial>,
}

impl<'m> Trails<'m> {
    /// The trails that lie in memory, none where it is filled with [`Ring::NONE`] and [`Knot::NONE`]. Each of as many slots as there are rings
    /// has its share of the knots: at least three, better thirty. Particles whose material says nothing of a trail leave the one for
    /// `others`, if there is any.
    #[must_use]
    pub const fn new(rings: &'m mut [Ring], knots: &'m mut [Knot], others: Option<TrailMaterial>) -> Self {
        Self { rings, knots, others }
    }

    /// The knots of each ring.
    fn share(&self) -> usize {
        self.knots.len().checked_div(self.rings.len()).unwrap_or(0)
    }

    /// The trail that the particle in a row leaves.
    fn trail(&self, state: &State<'_>, row: usize) -> Option<TrailMaterial> {
        let material = state.material.get(row).and_then(|number| number.checked_sub(1));
        let own = material.and_then(|number| state.materials.get(usize::from(number)));
        own.and_then(|own| own.trail).or(self.others).filter(|trail| trail.seconds > 0.0)
    }

    /// Remembers where particles are, to be called after each step, or picture; returns how many leave a trail and have no ring.
    pub fn look(&mut self, state: &State<'_>) -> usize {
        let share = self.share();
        let mut left_out = 0;
        for row in 0..state.position.len() {
            let Some((trail, id)) = self.trail(state, row).zip(state.id(row)) else { continue };
            let slot = id.slot as usize;
            let Some(ring) = self.rings.get_mut(slot).filter(|_| share >= 3) else {
                left_out += 1;
                continue;
            };
            // A knot more than the spaces between, and one on which it ends.
            let spacing = Time::from_seconds(trail.seconds).part(1, (share - 2).min(1 << 16) as u32);
            ring.add(&mut self.knots[slot * share..][..share], id.serial, state, row, spacing);
        }
        left_out
    }

    /// Writes the trails as lines, in the order of rows and each from its particle backward, as far as there is room; returns their
    /// number and how many were left out. Each ends where the particle was as long ago as its material says.
    pub fn lines(&self, state: &State<'_>, into: &mut [Line]) -> (usize, usize) {
        fill((0..state.position.len()).flat_map(|row| self.of_row(state, row)), into)
    }

    /// The lines of the trail of the particle in a row.
    fn of_row(&self, state: &State<'_>, row: usize) -> impl Iterator<Item = Line> {
        let (share, room) = (self.share(), state.near.room());
        let known = || {
            let (trail, id) = self.trail(state, row).zip(state.id(row))?;
            let slot = id.slot as usize;
            let ring = *self.rings.get(slot)?;
            let knots = self.knots.get(slot * share..)?.get(..share)?;
            let color = appearance(state, row)?.color;
            (ring.serial == id.serial && ring.count > 0 && color[3] > 0).then_some((trail, ring, knots, color))
        };
        known().into_iter().flat_map(move |(trail, ring, knots, color)| {
            let head = Knot { place: state.position[row], time: state.time };
            let pen = Pen { trail, color, now: state.time };
            let mut from = head;
            ring.backward(knots).map_while(move |to| {
                // Whoever has left a room at one side and come in at the other has gone on straight.
                let to = Knot { place: image_beside(room, from.place, to.place), ..to };
                let line = pen.line(from, to)?;
                from = to;
                Some(line)
            })
        })
    }
}

impl Ring {
    /// Puts the place of a row on the ring, if it is its turn.
    fn add(&mut self, knots: &mut [Knot], serial: u32, state: &State<'_>, row: usize, spacing: Time) {
        let (place, time) = (state.position[row], state.time);
        let newest = knots[self.newest as usize];
        // A slot that is taken again, a run that begins anew, and what is lost leave no streak.
        if self.serial != serial || self.count == 0 || time < newest.time || !place.is_finite() {
            *self = Self { serial, count: u32::from(place.is_finite()), newest: 0 };
        } else if time - newest.time >= spacing {
            self.newest = (self.newest + 1) % knots.len() as u32;
            self.count = (self.count + 1).min(knots.len() as u32);
        } else {
            return;
        }
        knots[self.newest as usize] = Knot { place, time };
    }

    /// Its knots, the newest first.
    fn backward(self, knots: &[Knot]) -> impl Iterator<Item = Knot> {
        let [newest, count, len] = [self.newest as usize, self.count as usize, knots.len()];
        (0..count).map(move |i| knots[(newest + len - i) % len])
    }
}

/// How a trail is drawn at an instant.
#[derive(Clone, Copy)]
struct Pen {
    trail: TrailMaterial,
    color: Color,
    now: Time,
}

impl Pen {
    /// The line from one knot back to another, cut where the trail ends; none, where it has ended.
    fn line(&self, from: Knot, to: Knot) -> Option<Line> {
        let [newer, older] = [from, to].map(|knot| (self.now - knot.time).seconds() / self.trail.seconds);
        if !(newer < 1.0) {
            return None;
        }
        let cut = || from.place + (to.place - from.place) * ((1.0 - newer) / (older - newer));
        // The next line begins where this one ends, to the bit.
        let ends = [from.place, if older > 1.0 { cut() } else { to.place }];
        let left = [1.0 - newer, 1.0 - min(older, 1.0)];
        let faded = |left: f32| {
            let [red, green, blue, alpha] = self.color;
            [red, green, blue, (f32::from(alpha) * left + 0.5) as u8]
        };
        Some(Line { ends, widths: left.map(|left| self.trail.width * left), colors: left.map(faded) })
    }
}
