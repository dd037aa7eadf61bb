//! Rows that go past a flat face side by side, and where they are put.

use super::TileSweep;
use crate::collide::packet::{CLOSE, Outcome, Paths, Riders};
use crate::collide::tile::Tile;
use crate::collide::waiting::{Packet, Queue, Start, ones, side_by_side};
use crate::lanes::{Eight, Kernel, LANES, Vectors, not, run_at_length};
use crate::material::on_surface;
use crate::math::max;
use crate::shape::Face;
use glam::Vec3;

/// A bit for each row of a packet.
const ALL: u32 = (1 << LANES) - 1;

/// Rows, eight by eight, that may lie on a face; of the last eight so many are present.
struct Lie<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    eights: &'t [[u32; LANES]],
    last: usize,
    face: &'t Face,
}

/// Rows that may bounce off a face, and where they were.
struct Bounce<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    packet: Packet<'t>,
    starts: &'t [Start; LANES],
    face: &'t Face,
}

/// Terms that all packets have in common.
#[derive(Clone, Copy)]
pub(super) struct Terms {
    /// How long they take \[s\].
    time: f32,
    /// As [`Riders`] have it.
    are_close: bool,
    /// True if all are finite, and end where their velocities take them.
    have_leapt: bool,
    swing: bool,
}

/// The rows of a packet that are to be followed alone, and those that neither are nor have come to the end of the step: a bit each.
#[derive(Default)]
pub(super) struct Unsettled {
    pub(super) left: u32,
    pub(super) others: u32,
}

impl<const POINTS: bool> Kernel for Lie<'_, '_, '_, POINTS> {
    /// The number of packets that have gone, and the unsettled rows of the last: packets behind it wait for these.
    type Output = (usize, Unsettled);
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> (usize, Unsettled) {
        let Self { of, eights, last, face } = self;
        let (first, terms) = (of.first, of.terms());
        let (mut farthest, mut gone) = (like.all(0.0), (eights.len(), Unsettled::default()));
        for (nth, rows) in eights.iter().enumerate() {
            let packet = Packet { rows, len: if nth + 1 == eights.len() { last } else { LANES } };
            let (riders, paths) = of.packet::<F, true, POINTS>(like, rows, first, None, terms, face.material());
            let outcome = riders.lie(&paths, face, packet.present());
            farthest = outcome.farthest.most(farthest);
            let unsettled = of.settle(&packet, first, &outcome);
            if unsettled.left | unsettled.others != 0 {
                gone = (nth + 1, unsettled);
                break;
            }
        }
        of.reach(farthest.largest_lane());
        gone
    }
}

impl<const POINTS: bool> Kernel for Bounce<'_, '_, '_, POINTS> {
    type Output = Unsettled;
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Unsettled {
        let Self { of, packet, starts, face } = self;
        let (riders, paths) =
            of.packet::<F, false, POINTS>(like, packet.rows, 0, Some(starts), of.terms(), face.material());
        let Tile { dt, ref obstacles, .. } = *of.tile;
        let outcome = riders.bounce(&paths, face, packet.present(), dt, obstacles.max_bounces);
        of.reach(outcome.farthest.largest_lane());
        of.settle(&packet, 0, &outcome)
    }
}

impl TileSweep<'_, '_> {
    /// Lets those who lie on the face do so, eight by eight and so many in the end; the others bounce.
    pub(super) fn lie(&mut self, mut eights: &[[u32; LANES]], last: usize, face: &Face, bouncing: &mut Queue) {
        while !eights.is_empty() {
            let (gone, Unsettled { left, others }) = match self.are_points {
                true => run_at_length(Lie::<true> { of: self, eights, last, face }),
                false => run_at_length(Lie::<false> { of: self, eights, last, face }),
            };
            let (those, rest) = eights.split_at(gone);
            if let Some(rows) = those.last() {
                ones(left).for_each(|lane| self.follow(rows[lane % LANES] as usize));
                ones(others).for_each(|lane| self.wait(rows[lane % LANES], face, bouncing));
            }
            eights = rest;
        }
    }

    /// Lets a row wait to bounce off the face, until there are eight.
    #[inline(always)]
    pub(super) fn wait(&mut self, row: u32, face: &Face, bouncing: &mut Queue) {
        if bouncing.push(row, self.start_of(row as usize)) {
            self.bounce(face, bouncing);
        }
    }

    /// Lets those bounce off the face who wait, if they do so a few times.
    #[inline(never)]
    pub(super) fn bounce(&mut self, face: &Face, bouncing: &mut Queue) {
        let Some((packet, starts)) = bouncing.take() else { return };
        let unsettled = match self.are_points {
            true => run_at_length(Bounce::<true> { of: self, packet, starts, face }),
            false => run_at_length(Bounce::<false> { of: self, packet, starts, face }),
        };
        for lane in ones(unsettled.left).map(|lane| lane % LANES) {
            let [[x, y, z, _], [u, v, w, _]] = starts[lane];
            let start = Some([Vec3::new(x, y, z), Vec3::new(u, v, w)]);
            self.follow_from(packet.rows[lane] as usize, start, self.tile.obstacles.colliders, self.known());
        }
    }

    /// No coordinate of those who are put somewhere is beyond this \[m\].
    #[inline(always)]
    pub(super) fn reach(&mut self, farthest: f32) {
        if let Some(reached) = &mut self.tile.reached {
            reached.place = max(reached.place, farthest);
        }
    }

    /// Puts rows where they have come to, none of which is before the `first`, and says which are left.
    #[inline(always)]
    pub(super) fn settle<F: Eight>(&mut self, packet: &Packet<'_>, first: usize, outcome: &Outcome<F>) -> Unsettled {
        let present = packet.present();
        self.report.hits += u64::from(outcome.hits);
        let (position, velocity) = (&mut self.tile.position[first..], &mut self.tile.velocity[first..]);
        let velocity = &mut velocity[..position.len()];
        let [places, velocities] = outcome.ends.map(Vectors::rows);
        let rows = places_from(first, packet.rows);
        let lanes = rows.iter().zip(&places).zip(&velocities);
        if outcome.settled == ALL {
            for ((row, place), speed) in lanes {
                put(position, velocity, *row, [place, speed]);
            }
        } else {
            for (i, ((row, place), speed)) in lanes.enumerate() {
                // Who is missing is the first over again.
                if outcome.settled >> i & 1 != 0 {
                    put(position, velocity, *row, [place, speed]);
                }
            }
        }
        Unsettled { left: outcome.left & present, others: present & !(outcome.settled | outcome.left) }
    }

    /// Terms that all packets have in common.
    #[inline(always)]
    pub(super) fn terms(&self) -> Terms {
        let Tile { reached, dt, .. } = *self.tile;
        let time = dt.seconds();
        let are_close = reached.is_some_and(|to| to.place + 100.0 * to.speed * time <= CLOSE);
        Terms { time, are_close, have_leapt: reached.is_some(), swing: self.tile.obstacles.lead.is_some() }
    }

    /// Rows side by side, none of which is before the `first`, nor the tile's last; of some it is known where they started. Of those who may
    /// lie on a face, only what that takes is read.
    #[inline(always)]
    pub(super) fn packet<F: Eight, const LIES: bool, const POINTS: bool>(
        &self,
        like: F,
        rows: &[u32; LANES],
        first: usize,
        starts: Option<&[Start; LANES]>,
        Terms { time, are_close, have_leapt, swing }: Terms,
        material: Option<u16>,
    ) -> (Riders<F, POINTS>, Paths<F>) {
        let Tile { attributes: ref m, ref position, ref velocity, .. } = *self.tile;
        let (at, last) = (&places_from(first, rows), position.len() - 1 - first);
        let column = |column: &[f32]| {
            let (mut lanes, column) = ([0.0; LANES], &column[first..][..last]);
            lanes.iter_mut().zip(at).for_each(|(lane, &row)| *lane = column[row]);
            lanes
        };
        // Rows that have leapt are finite, and such as are held have stayed as they were, which is not how something falls onto a face.
        let [x0, v0] = match starts {
            Some(starts) => side_by_side(like, starts),
            None => {
                let [x, v] = self.past.start;
                [Vectors::gather(like, x, last, at), Vectors::gather(like, v, last, at)]
            }
        };
        let v1 = Vectors::gather(like, &velocity[first..], last, at);
        let x1 = if LIES && have_leapt { x0 } else { Vectors::gather(like, &position[first..], last, at) };
        let paths = Paths { x0, v0, x1, v1, time: like.all(time) };
        let mut are_free = like.all(f32::from_bits(u32::MAX));
        if !(LIES && have_leapt) {
            are_free = paths.are_finite() & not(like.of(column(m.inverse_mass)).simd_eq(like.all(0.0)));
        }
        let (mut elasticity, mut at_rest, mut kinetic) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        if !LIES || self.has_materials {
            elasticity = column(m.elasticity);
        }
        if self.has_materials {
            [elasticity, at_rest, kinetic] = self.mixed(rows, material, &elasticity);
        }
        let riders = Riders {
            are_free,
            are_close,
            swing,
            radius: if POINTS { like.all(0.0) } else { like.of(column(m.lives.radius)) },
            elasticity: like.of(elasticity),
            at_rest: like.of(at_rest),
            kinetic: like.of(kinetic),
        };
        (riders, paths)
    }

    /// The elasticities of rows on a surface, and the coefficients of friction at rest and in motion.
    #[inline(never)]
    fn mixed(&self, rows: &[u32; LANES], material: Option<u16>, elasticity: &[f32; LANES]) -> [[f32; LANES]; 3] {
        let mut mixed = [[0.0; LANES]; 3];
        let [bounces, at_rest, kinetic] = &mut mixed;
        for (i, (&row, &elasticity)) in rows.iter().zip(elasticity).enumerate() {
            let own = self.tile.attributes.lives.material[row as usize].checked_sub(1);
            let mixed = on_surface(self.tile.obstacles.materials, elasticity, own, material);
            (bounces[i], at_rest[i], kinetic[i]) = (mixed.elasticity, mixed.friction.static_, mixed.friction.kinetic);
        }
        mixed
    }
}

/// Rows counted from the first, before which none of them is.
#[inline(always)]
fn places_from(first: usize, [a, b, c, d, e, f, g, h]: &[u32; LANES]) -> [usize; LANES] {
    let from = |row: &u32| (*row as usize).wrapping_sub(first);
    [from(a), from(b), from(c), from(d), from(e), from(f), from(g), from(h)]
}

/// Puts a row to a place, with a velocity: three numbers of each.
#[inline(always)]
fn put(position: &mut [Vec3], velocity: &mut [Vec3], row: usize, [[x, y, z, _], [u, v, w, _]]: [&[f32; 4]; 2]) {
    (position[row], velocity[row]) = (Vec3::new(*x, *y, *z), Vec3::new(*u, *v, *w));
}
