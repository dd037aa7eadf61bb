//! Rows that go past a flat face side by side, and where they are put.

use super::TileSweep;
use crate::collide::packet::{Airs, CLOSE, Medium, Outcome, Paths, Riders};
use crate::collide::tile::Tile;
use crate::collide::waiting::{Packet, Queue, Start, Waited, ones, side_by_side};
use crate::lanes::{BroadKernel, Eight, LANES, Lanes, PARTS, Vectors, not, run_broad};
use crate::material::on_surface;
use crate::math::max;
use crate::shape::Face;
use core::ops::Range;
use glam::Vec3;

/// A bit for each of eight rows.
pub(super) const ALL: u32 = (1 << LANES) - 1;

/// Rows, eight by eight, that may lie on a face, and how many they are.
struct Lie<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    eights: &'t [[u32; LANES]],
    len: usize,
    face: &'t Face,
}

/// Rows that may bounce off a face, and where they were.
struct Bounce<'t, 's, 'a, const POINTS: bool> {
    of: &'t mut TileSweep<'s, 'a>,
    waited: Waited<'t>,
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
    air: Weather,
}

/// The forces that a hit changes, as [`Medium`] has them.
#[derive(Clone, Copy)]
enum Weather {
    Thin,
    Steady(Vec3),
    Any,
}

/// The rows of a packet that are to be followed alone, and those that neither are nor have come to the end of the step: a bit each.
#[derive(Default)]
pub(super) struct Unsettled {
    pub(super) left: u64,
    pub(super) others: u64,
}

impl Unsettled {
    /// Counts in those of a packet that begins with one of the eights.
    #[inline(always)]
    pub(super) fn add(&mut self, packet: Self, nth: usize) {
        self.left |= packet.left << (LANES * nth);
        self.others |= packet.others << (LANES * nth);
    }
}

impl<const POINTS: bool> BroadKernel for Lie<'_, '_, '_, POINTS> {
    /// The eights of the packet that has gone last, and its unsettled rows: packets behind it wait for these.
    type Output = (Range<usize>, Unsettled);
    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> (Range<usize>, Unsettled) {
        let Self { of, eights, len, face } = self;
        let (first, terms) = (of.first, of.terms());
        let (mut farthest, mut last) = (like.all(0.0), (0..eights.len(), Unsettled::default()));
        for (nth, packet) in Packet::all::<F>(eights, len) {
            let (riders, paths) = of.packet::<F, true, POINTS>(like, &packet, first, None, terms, face.material());
            let outcome = riders.lie(&paths, face, packet.present());
            farthest = outcome.farthest.most(farthest);
            let unsettled = of.settle(&packet, first, &outcome);
            if unsettled.left | unsettled.others != 0 {
                last = (nth..eights.len().min(nth + F::PARTS), unsettled);
                break;
            }
        }
        of.reach(farthest.largest_lane());
        last
    }
}

impl<const POINTS: bool> BroadKernel for Bounce<'_, '_, '_, POINTS> {
    type Output = Unsettled;
    #[inline(always)]
    fn run<F: Lanes>(self, like: F) -> Unsettled {
        let Self { of, waited: Waited { rows, starts, len }, face } = self;
        let (terms, mut unsettled) = (of.terms(), Unsettled::default());
        let Tile { dt, ref obstacles, .. } = *of.tile;
        let max_bounces = obstacles.max_bounces;
        for (nth, packet) in Packet::all::<F>(rows, len) {
            let starts = Some([&starts[nth], &starts[nth + F::PARTS - 1]]);
            let (riders, paths) = of.packet::<F, false, POINTS>(like, &packet, 0, starts, terms, face.material());
            let outcome = riders.bounce(&paths, face, packet.present(), dt, max_bounces);
            of.reach(outcome.farthest.largest_lane());
            unsettled.add(of.settle(&packet, 0, &outcome), nth);
        }
        unsettled
    }
}

impl TileSweep<'_, '_> {
    /// Lets those who lie on the face do so, so many of them, eight by eight; the others bounce.
    pub(super) fn lie(&mut self, mut eights: &[[u32; LANES]], mut len: usize, face: &Face, bouncing: &mut Queue) {
        while !eights.is_empty() {
            let (last, Unsettled { left, others }) = match self.are_points {
                true => run_broad(Lie::<true> { of: self, eights, len, face }),
                false => run_broad(Lie::<false> { of: self, eights, len, face }),
            };
            let (gone, rest) = eights.split_at(last.end);
            let rows = gone[last.start..].as_flattened();
            ones(left).for_each(|lane| self.follow(rows[lane] as usize));
            ones(others).for_each(|lane| self.wait(rows[lane], face, bouncing));
            (eights, len) = (rest, len.saturating_sub(LANES * gone.len()));
        }
    }

    /// Lets a row wait to bounce off the face, until there are enough.
    #[inline(always)]
    pub(super) fn wait(&mut self, row: u32, face: &Face, bouncing: &mut Queue) {
        if bouncing.push(row, self.start_of(row as usize)) {
            self.bounce(face, bouncing);
        }
    }

    /// Lets those bounce off the face who wait, if they do so a few times.
    #[inline(never)]
    pub(super) fn bounce(&mut self, face: &Face, bouncing: &mut Queue) {
        let Some(waited) = bouncing.take() else { return };
        let unsettled = match self.are_points {
            true => run_broad(Bounce::<true> { of: self, waited, face }),
            false => run_broad(Bounce::<false> { of: self, waited, face }),
        };
        let (rows, starts) = (waited.rows.as_flattened(), waited.starts.as_flattened());
        for lane in ones(unsettled.left) {
            let [[x, y, z, _], [u, v, w, _]] = starts[lane];
            let start = Some([Vec3::new(x, y, z), Vec3::new(u, v, w)]);
            self.follow_from(rows[lane] as usize, start, self.tile.obstacles.colliders, self.known());
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
    pub(super) fn settle<F: Lanes>(&mut self, packet: &Packet<'_>, first: usize, outcome: &Outcome<F>) -> Unsettled {
        let present = packet.present();
        self.report.hits += u64::from(outcome.hits);
        let (position, velocity) = (&mut self.tile.position[first..], &mut self.tile.velocity[first..]);
        let velocity = &mut velocity[..position.len()];
        for (nth, rows) in packet.rows.iter().enumerate().take(F::PARTS) {
            let [x, v] = outcome.ends;
            let (places, velocities) = (x.part(nth).rows(), v.part(nth).rows());
            let (rows, settled) = (places_from(first, rows), outcome.settled >> (LANES * nth) & ALL);
            let lanes = rows.iter().zip(&places).zip(&velocities);
            if settled == ALL {
                for ((row, place), speed) in lanes {
                    put(position, velocity, *row, [place, speed]);
                }
            } else {
                for (i, ((row, place), speed)) in lanes.enumerate() {
                    // Who is missing is another over again.
                    if settled >> i & 1 != 0 {
                        put(position, velocity, *row, [place, speed]);
                    }
                }
            }
        }
        let others = present & !(outcome.settled | outcome.left);
        Unsettled { left: u64::from(outcome.left & present), others: u64::from(others) }
    }

    /// Terms that all packets have in common.
    #[inline(always)]
    pub(super) fn terms(&self) -> Terms {
        let Tile { reached, dt, .. } = *self.tile;
        let time = dt.seconds();
        let are_close = reached.is_some_and(|to| to.place + 100.0 * to.speed * time <= CLOSE);
        let air = match self.air.map(|air| air.steady) {
            None => Weather::Thin,
            Some(Some(steady)) => Weather::Steady(steady.acceleration.unwrap_or(Vec3::ZERO)),
            Some(None) => Weather::Any,
        };
        Terms { time, are_close, have_leapt: reached.is_some(), swing: self.tile.obstacles.lead.is_some(), air }
    }

    /// Rows side by side, none of which is before the `first`, nor the tile's last; of some it is known where they started. Of those who may
    /// lie on a face, only what that takes is read.
    #[inline(always)]
    pub(super) fn packet<F: Lanes, const LIES: bool, const POINTS: bool>(
        &self,
        like: F,
        packet: &Packet<'_>,
        first: usize,
        starts: Option<[&[Start; LANES]; PARTS]>,
        terms: Terms,
        material: Option<u16>,
    ) -> (Riders<F, POINTS>, Paths<F>) {
        // Eight by eight, so that no more rows are at hand than there are registers.
        let read = like.of_parts(
            #[inline(always)]
            |like, nth| {
                let (rows, starts) = (packet.rows[nth], starts.map(|starts| starts[nth]));
                self.read::<F::Part, LIES, POINTS>(like, rows, first, starts, terms, material)
            },
        );
        let [a, b, c, d, e, f, g, h, i, j, k, l, are_free, radius, elasticity, at_rest, kinetic] = read;
        let [x0, v0, x1, v1] = [Vectors([a, b, c]), Vectors([d, e, f]), Vectors([g, h, i]), Vectors([j, k, l])];
        let Terms { are_close, swing, time, .. } = terms;
        let air = match terms.air {
            Weather::Steady(gravity) if !LIES => Medium::Steady(self.airs(like, packet, first, gravity)),
            Weather::Any if !LIES => Medium::Any,
            _ => Medium::Thin,
        };
        let riders = Riders { are_free, are_close, swing, radius, elasticity, air, at_rest, kinetic };
        (riders, Paths { x0, v0, x1, v1, time: like.all(time) })
    }

    /// How these fall and are braked.
    #[inline(always)]
    fn airs<F: Lanes>(&self, like: F, packet: &Packet<'_>, first: usize, gravity: Vec3) -> Airs<F> {
        let m = &self.tile.attributes;
        let (columns, last) = ([m.lives.mass, m.lives.drag, m.inverse_mass], self.tile.position.len() - 1 - first);
        let common = m.common.inertia();
        let [mass, drag, inverse_mass] = like.of_parts(
            #[inline(always)]
            |like, nth| match common {
                Some([mass, drag, inverse_mass]) => [like.all(mass), like.all(drag), like.all(inverse_mass)],
                None => {
                    let at = places_from(first, packet.rows[nth]);
                    columns.map(
                        #[inline(always)]
                        |column| {
                            let column = &column[first..][..last];
                            like.of(at.map(|row| column[row]))
                        },
                    )
                }
            },
        );
        Airs { gravity: Vectors::splat(like, gravity), mass, drag, inverse_mass }
    }

    /// Rows side by side as above, but eight: places and velocities at both ends, and properties in the order of [`Riders`].
    #[inline(always)]
    fn read<F: Eight, const LIES: bool, const POINTS: bool>(
        &self,
        like: F,
        rows: &[u32; LANES],
        first: usize,
        starts: Option<&[Start; LANES]>,
        Terms { time, have_leapt, .. }: Terms,
        material: Option<u16>,
    ) -> [F; 17] {
        let Tile { attributes: ref m, ref position, ref velocity, .. } = *self.tile;
        let (at, last) = (&places_from(first, rows), position.len() - 1 - first);
        let column = |column: &[f32], common: Option<f32>| {
            let (mut lanes, column) = ([0.0; LANES], &column[first..][..last]);
            match common {
                Some(number) => lanes = [number; LANES],
                None => lanes.iter_mut().zip(at).for_each(|(lane, &row)| *lane = column[row]),
            }
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
        let mut are_free = like.all(f32::from_bits(u32::MAX));
        if !(LIES && have_leapt) {
            let paths = Paths { x0, v0, x1, v1, time: like.all(time) };
            are_free = paths.are_finite()
                & not(like.of(column(m.inverse_mass, m.common.inverse_mass())).simd_eq(like.all(0.0)));
        }
        let (mut elasticity, mut at_rest, mut kinetic) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        if !LIES || self.has_materials {
            elasticity = column(m.elasticity, m.common.elasticity());
        }
        if self.has_materials {
            [elasticity, at_rest, kinetic] = self.mixed(rows, material, &elasticity);
        }
        let radius = if POINTS { like.all(0.0) } else { like.of(column(m.lives.radius, m.common.radius())) };
        let (Vectors([a, b, c]), Vectors([d, e, f]), Vectors([g, h, i]), Vectors([j, k, l])) = (x0, v0, x1, v1);
        let [elasticity, at_rest, kinetic] = [like.of(elasticity), like.of(at_rest), like.of(kinetic)];
        [a, b, c, d, e, f, g, h, i, j, k, l, are_free, radius, elasticity, at_rest, kinetic]
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
pub(super) fn places_from(first: usize, [a, b, c, d, e, f, g, h]: &[u32; LANES]) -> [usize; LANES] {
    let from = |row: &u32| (*row as usize).wrapping_sub(first);
    [from(a), from(b), from(c), from(d), from(e), from(f), from(g), from(h)]
}

/// Puts a row to a place, with a velocity: three numbers of each.
#[inline(always)]
fn put(position: &mut [Vec3], velocity: &mut [Vec3], row: usize, [[x, y, z, _], [u, v, w, _]]: [&[f32; 4]; 2]) {
    (position[row], velocity[row]) = (Vec3::new(*x, *y, *z), Vec3::new(*u, *v, *w));
}

#[cfg(test)]
mod tests {
    use crate::force::{QuadraticDrag, Uniform, Wind};
    use crate::lanes::NARROW;
    use crate::observe::Observer;
    use crate::rng::Stream;
    use crate::shape::{Cuboid, Mesh, Plane, Scenery, Shape, Sphere, Surface};
    use crate::{Drag, Force, Gravity, Heap, Particle, Rk4, Scene, Symplectic, System, Time};
    use alloc::vec::Vec;
    use glam::Vec3;

    /// Wants to be told of everything, which is done one by one.
    struct Watching;

    impl Observer for Watching {}

    /// Points that are thrown onto the ground, and come to lie on it.
    fn thrown(count: u32) -> Vec<Particle> {
        let thrown = |i| {
            let ([x, y], [z, u], [v, w]) =
                (Stream::new(5, 0, i).units(0), Stream::new(5, 0, i).units(1), Stream::new(5, 0, i).units(2));
            let position = Vec3::new(2.0 * x - 1.0, 0.2 * y, 2.0 * z - 1.0);
            let velocity = Vec3::new(u, v, w) * 4.0 - 2.0;
            Particle { position, velocity, mass: 0.5 + u, drag: 3.0 * v, elasticity: 0.8 * w, ..Particle::REST }
        };
        (0..count).map(thrown).collect()
    }

    /// The fingerprint of some points in a scene after a second.
    fn ends(scene: &Scene<'_>, observer: &mut dyn Observer) -> u64 {
        let mut system = System::with(Heap::new(scene.size_for(scene.start.len())));
        system.start(scene, 1).expect("the memory was made for the scene");
        (0..60).for_each(|_| {
            system.step_observed(scene, Time::frame(1, 60), observer);
        });
        system.hash()
    }

    /// However many there are, and so however many places of the last packet are empty.
    #[test]
    fn eight_and_more_at_once_do_what_each_does_alone() {
        let ground: Shape<Mesh<'_>> = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
        let things = |i: u32| {
            let center = Vec3::new(0.5 * i as f32 - 1.0, 0.0, 0.25 * i as f32 - 0.5);
            let chest = Shape::Box(Cuboid { min: center - 0.1, max: center + 0.1 });
            if i.is_multiple_of(2) { chest } else { Shape::Sphere(Sphere { center, radius: 0.15 }) }
        };
        let all = [ground.clone()].into_iter().chain((0..5).map(things));
        let among = Scenery::new(all.map(|thing| (thing.clone(), thing.bounds())).collect());
        let (g, wind) = (Gravity::EARTH, Wind { field: Uniform { velocity: Vec3::X }, coefficient: None });
        let forces: [&dyn Force; 4] =
            [&g, &(g, Drag {}), &(wind, g), &(g, Drag {}, QuadraticDrag { coefficient: 0.2 })];
        for (i, count) in [1, 7, 8, 9, 12, 15, 16, 17, 23, 25, 40, 200].into_iter().enumerate() {
            let start = thrown(count);
            let parts = Scene { start: &start, forces: forces[i % 4], integrator: &Symplectic, ..Scene::EMPTY };
            let parts = if i / 4 == 1 { Scene { integrator: &Rk4, ..parts } } else { parts };
            for (nth, scene) in
                [Scene { colliders: &ground, ..parts }, Scene { colliders: &among, ..parts }].iter().enumerate()
            {
                let alone = ends(scene, &mut Watching);
                let broad = ends(scene, &mut ());
                NARROW.set(true);
                let narrow = ends(scene, &mut ());
                NARROW.set(false);
                assert_eq!([broad, narrow], [alone; 2], "{count} in scene {nth}");
            }
        }
    }
}
