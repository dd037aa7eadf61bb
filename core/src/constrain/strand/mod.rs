//! Strands that stretch, bend and twist by the numbers of their material: hair, wires, cables, stalks.

mod asks;
mod band;
mod bounded;
mod frame;
mod hung;
mod joint;
mod params;
mod piece;
#[cfg(all(test, feature = "std"))]
mod tests;

pub use params::StrandParams;

#[cfg(feature = "alloc")]
use super::declared::{Declared, stiffness, twice};
use super::turn::Turn;
use super::{Bodies, Constraint, Demand, Share, Words};
#[cfg(feature = "alloc")]
use crate::math::min;
use crate::math::{length, sin_cos};
use crate::memory::take;
#[cfg(feature = "alloc")]
use crate::particles::Particle;
use crate::rows::BLOCKS;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use band::Band;
use bounded::{Bounded, Course, PURSE, Purse};
use bytemuck::Pod;
use frame::{bring, frame, strain};
use glam::Vec3;
use joint::{Begun, Joint, KEPT};
use piece::{EQUATIONS, Piece, Step, TURN, Writer, act};

/// Elastic strands, in the shape in which they begin at rest: straight ones, and curls.
///
/// A strand is a chain of points. Each edge between two of them has a material frame, kept from sub-step to sub-step: it is taken along on the
/// shortest way as the edge turns (parallel transport in time: Bergou, Audoly, Vouga, Wardetzky and Grinspun, "Discrete Viscous
/// Threads", SIGGRAPH 2010), and turned about the edge so that twist is in balance at each instant. Where two edges meet, the
/// rotation from one frame to the next is what it is bent and twisted by (Bergou, Wardetzky, Robinson, Audoly and Grinspun, "Discrete
/// Elastic Rods", SIGGRAPH 2008): ½ Σ (g − g₀)ᵀ B (g − g₀) / l, with g = 2 tan(φ/2) along the axis, and l half of each edge beside.
///
/// Stretching, bending and twisting of a strand are solved as one, for its places at the sub-step's end: forces are those of
/// the material whatever the sub-steps, but where it is damped and a tie moves its points by more than an eighth of an edge in one: the damping of what takes
/// them back adds to the load. Single precision sets a limit: where points of mass m are l apart, bending is off by up to a
/// share of 1e-6 E I h²/(m l³) in a sub-step h, less than 0.01 % for hair of 1 cm; longer edges and shorter sub-steps lessen it. The
/// system has a narrow band and is solved directly, so that the time that it takes grows with the number of points alone; several
/// strands are solved eight at once: in one step of Newton's method and, where that turns no edge far, a second one. Forces act along the directions of
/// the sub-step's beginning, and both momenta of a strand that
/// nothing holds are kept to rounding. It gains no energy either, however long its sub-steps, nor does one that hangs from what stands still: what would be too much is taken from how it
/// deforms, where the strain of what is stiffer than it takes to be brought to its shape in a sub-step counts for no more than that. What swings
/// so fast that a sub-step does not resolve it fades: a motion of angular frequency ω by (ω h)²/2 in a sub-step h. Where something holds
/// it and nothing turns its ends, what rounding leaves of the way of each point is kept, so that it bends far from the origin as near it; any other loses of how it deforms
/// what goes slower than half a rounding of its coordinates in a sub-step, ε |x| / 2 h. It does not act through the sides of a periodic room.
///
/// Whoever is fixed stays. Two neighbours that are both fixed clamp the strand: it leaves the second of them in their direction, and
/// cannot turn about itself there, unless it is turned ([`turning`](Self::turning)); a single one is a hinge. What turns an end of a strand that nobody
/// else holds gives it energy and angular momentum. Where a particle has died the strand is in two. Edges whose ends are in one place
/// do nothing, and are counted in [`Caps`](crate::Caps).
///
/// ```
/// use pointmass::constrain::{StrandParams, Strands};
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // A steel wire of 1 m and 2 mm across, clamped behind its second point.
/// let wire = StrandParams { damping: 0.05, ..StrandParams::round(1e-3, 2e11, 0.3) };
/// let mass = 7850.0 * 3.1416e-6 * 0.05;
/// let point = |i: u32| Particle { position: Vec3::X * (0.05 * i as f32 - 0.05), mass, fixed: i < 2, ..Particle::REST };
/// let start: Vec<Particle> = (0..22).map(point).collect();
/// let strands = Strands::of((0..22).collect::<Vec<u32>>(), [22], wire);
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &strands, substeps: 10, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=240 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// // It sags by w L⁴ / (8 E I), and a little more as half an edge's mass is beyond its end.
/// let sag = -system.particles().position[21].y;
/// assert!((0.17..0.21).contains(&sag), "{sag}");
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Strands<P, L> {
    /// The particles of all strands, by their place in the scene's start: one strand after the other, each from its root to its tip.
    pub particles: P,
    /// The number of points of each strand; the last of these holds for all further strands.
    pub points: L,
    /// What they are made of.
    pub params: StrandParams,
    /// The direction of the first principal axis of the section where a strand begins, as far as that is upright on it; it
    /// counts where bending differs.
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub across: Vec3,
    /// How much the material at rest is twisted against the shape in which it begins \[rad/m\], right-handed above zero.
    #[cfg_attr(feature = "serde", serde(default))]
    pub twist: f32,
    /// True if the first and the last edge do not turn about themselves, though their ends are free to move.
    #[cfg_attr(feature = "serde", serde(default))]
    pub held: [bool; 2],
    /// How fast the first and the last edge are turned about themselves \[rad/s\], right-handed about the direction from the root to the tip: by a drill, a
    /// winch, the hands that wind a rope. It counts at an end that is `held`, or clamped by two fixed neighbours, where all edges between fixed points are turned.
    /// A strand that is turned at both ends with the same rate is not twisted. More than half a turn between two edges is less the other way round, so
    /// for many turns it takes many edges, and less than half a turn in a sub-step.
    #[cfg_attr(feature = "serde", serde(default))]
    pub turning: [f32; 2],
}

/// How much shorter a second step of Newton's method has to be than the first to be taken: one that is longer leads nowhere (Deuflhard, "Newton Methods
/// for Nonlinear Problems", 2004, section 2.1).
const CLOSER: f32 = 0.5;
/// How far the first step may move a point against the next one, as a share of how far these are apart, and turn an edge about itself \[rad\]: the second
/// one has the first one's directions.
const LITTLE: f32 = 0.5;

/// Strands that are solved at once, where there are several.
const WIDE: usize = if BLOCKS { 8 } else { 1 };

impl<P, L> Strands<P, L> {
    /// Strands of round sections whose ends are free to turn.
    #[must_use]
    pub const fn of(particles: P, points: L, params: StrandParams) -> Self {
        Self { particles, points, params, across: Vec3::ZERO, twist: 0.0, held: [false; 2], turning: [0.0; 2] }
    }
}

impl<P: AsRef<[u32]>, L: AsRef<[u32]>> Strands<P, L> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let faults = [
            (self.points.as_ref().is_empty(), "points", "has to hold the number of points of a strand at least"),
            (self.points.as_ref().iter().any(|&points| points < 2), "points", "have to be two or more"),
            (!self.across.is_finite(), "across", "has to be finite"),
            (!self.twist.is_finite(), "twist", "has to be finite, in rad/m"),
            (!self.turning.iter().all(|rate| rate.is_finite()), "turning", "has to be finite, in rad/s"),
        ];
        let wrong = faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message));
        wrong.or_else(|| self.params.fault())
    }

    /// The particles of each strand, from its root to its tip: where they begin in the list, and where they end.
    pub fn strands(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let (all, points) = (self.particles.as_ref().len(), self.points.as_ref());
        let mut next = (0usize, 0usize);
        core::iter::from_fn(move || {
            let (number, first) = next;
            let count = points.get(number).or(points.last()).map_or(all, |&count| (count as usize).max(1));
            let last = first.saturating_add(count).min(all);
            next = (number + 1, last);
            (first < last).then_some([first, last])
        })
    }

    /// The points of the longest strand, and how many are solved at once.
    fn widest(&self) -> [usize; 2] {
        let longest = self.strands().map(|[first, last]| last - first).max().unwrap_or(0);
        [longest, if self.strands().nth(1).is_some() { WIDE } else { 1 }]
    }

    /// What is kept of all joints, behind the word that tells whose it is, and the purses of all strands.
    fn kept<'m>(&self, kept: &'m mut [u32]) -> (&'m mut [Joint], &'m mut [u32]) {
        let mut rest = kept;
        let _name = take(&mut rest, 1);
        let joints = take(&mut rest, KEPT.saturating_mul(self.particles.as_ref().len()));
        let whole = joints.len() - joints.len() % KEPT;
        (bytemuck::cast_slice_mut(&mut joints[..whole]), rest)
    }

    /// Takes the shape at rest from where all are, at the first of all.
    fn learn(&self, bodies: &mut Bodies<'_>, kept: &mut [u32]) {
        let ((joints, _), mut degenerate) = (self.kept(kept), 0);
        for [first, last] in self.strands() {
            let Some(joints) = joints.get_mut(first..last) else { break };
            let row = |number: usize| bodies.row_of_start(self.particles.as_ref()[last - 1 - number]);
            let place = |number: usize| row(number).map_or(Vec3::ZERO, |row| bodies.position[row]);
            let way = |number: usize| place(number + 1) - place(number);
            let edges = last - first - 1;
            let mut turn = None;
            for (number, joint) in joints[..edges].iter_mut().enumerate().rev() {
                joint.was = way(number);
                joint.length = length(joint.was);
                let is_there = [number, number + 1].into_iter().all(|end| row(end).is_some());
                degenerate += u64::from(is_there && !(joint.length > 0.0 && joint.length < f32::INFINITY));
                let direction = way(number) / joint.length;
                if direction.is_finite() {
                    turn = Some(turn.map_or_else(|| frame(direction, self.across), |turn| bring(turn, direction)));
                }
                joint.turn = turn.unwrap_or(Turn::NONE).0;
            }
            for number in 1..edges {
                let [before, own] = [joints[number - 1], joints[number]];
                let (sin, cos) = sin_cos(0.25 * self.twist * (before.length + own.length));
                let rest = strain(Turn(before.turn), Turn(own.turn)) + Vec3::Z * (2.0 * sin / cos);
                joints[number].rest = if rest.is_finite() { rest } else { Vec3::ZERO };
            }
        }
        bodies.report.caps.degenerate += degenerate;
    }

    /// The row of a particle by its place in the list, if it lives and is somewhere.
    fn row(&self, bodies: &Bodies<'_>, number: usize) -> Option<u32> {
        let row = bodies.row_of_start(*self.particles.as_ref().get(number)?)?;
        (bodies.position[row].is_finite() && bodies.velocity[row].is_finite()).then_some(row as u32)
    }

    /// The next part of a strand that lives, from a joint of it on.
    fn piece(&self, bodies: &Bodies<'_>, [first, last]: [usize; 2], from: usize, rows: &mut [u32]) -> Piece {
        let mut piece = Piece { first: from, ..Piece::default() };
        for joint in from..last {
            match (self.row(bodies, first + last - 1 - joint), rows.get_mut(piece.count)) {
                (Some(row), Some(to)) => {
                    *to = row;
                    piece.count += 1;
                }
                _ if piece.count > 0 => break,
                _ => piece.first = joint + 1,
            }
        }
        let ends = [piece.first == first, piece.first + piece.count == last];
        piece.held = [self.held[1] && ends[0], self.held[0] && ends[1]];
        // From the tip to the root.
        let [root, tip] = self.turning.map(|rate| -rate);
        piece.turning = [if ends[0] { tip } else { 0.0 }, if ends[1] { root } else { 0.0 }];
        piece
    }

    /// Solves all strands, so many at once.
    fn solve<const LANES: usize>(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, longest: usize)
    where
        [f32; LANES]: Pod,
    {
        let (joints, purses) = self.kept(share.kept.fixed);
        let mut rest = &mut *share.scratch;
        let rows = take(&mut rest, longest * LANES);
        let (mut pieces, mut count) = ([Piece::default(); LANES], 0);
        for (number, strand) in self.strands().enumerate() {
            let mut from = strand[0];
            while from < strand[1] {
                let Some(rows_of) = rows.get_mut(count * longest..(count + 1) * longest) else { return };
                let mut piece = self.piece(bodies, strand, from, rows_of);
                from = piece.first + piece.count;
                let rows_of = &rows_of[..piece.count];
                piece.is_held = rows_of.iter().any(|&row| !(bodies.inverse_mass[row as usize] > 0.0));
                piece.is_free = !piece.is_turned() && !piece.is_held;
                piece.is_hung = !piece.is_free && piece.turning == [0.0; 2] && hangs(bodies, rows_of);
                piece.whole = (piece.count == strand[1] - strand[0]).then_some(number);
                let is_kept = piece.is_left_alone() && piece.whole.is_some();
                if let Some(mut purse) = Purse::of(purses, number).filter(|_| !is_kept) {
                    purse.forget();
                }
                if piece.count > 1 {
                    pieces[count] = piece;
                    count += 1;
                }
                if count == LANES {
                    self.solve_some::<LANES>(bodies, (joints, purses), &pieces, [rows, rest], longest);
                    count = 0;
                }
            }
        }
        self.solve_some::<LANES>(bodies, (joints, purses), &pieces[..count], [rows, rest], longest);
    }

    /// Solves some of them at once.
    fn solve_some<const LANES: usize>(
        &self,
        bodies: &mut Bodies<'_>,
        (all, purses): (&mut [Joint], &mut [u32]),
        pieces: &[Piece],
        [rows, memory]: [&mut [u32]; 2],
        longest: usize,
    ) where
        [f32; LANES]: Pod,
    {
        let Some(most) = pieces.iter().map(|piece| piece.count).max() else { return };
        let step = Step { params: &self.params, h: bodies.substep.seconds() };
        let mut memory = memory;
        let work = take(&mut memory, bounded::WORDS * longest);
        let all_begun: &mut [Begun] = bytemuck::cast_slice_mut(take(&mut memory, bounded::BEGUN * longest * LANES));
        let mut band = Band::<LANES>::new(memory, most * EQUATIONS);
        let (mut limits, mut masses, mut most_squared) = ([None; LANES], [0.0; LANES], [0.0; LANES]);
        let points = |lane: usize| lane * longest..lane * longest + pieces[lane].count;
        let joints = |lane: usize| pieces[lane].first..pieces[lane].first + pieces[lane].count;
        let inverse_mass = bodies.inverse_mass;
        let bounded = |lane: usize, mass| {
            let (rows, is_free) = (&rows[points(lane)], pieces[lane].is_free);
            Bounded { params: &self.params, rows, inverse_mass, h: step.h, mass, is_free }
        };
        for (lane, piece) in pieces.iter().enumerate() {
            let (rows, joints, begun) = (&rows[points(lane)], &mut all[joints(lane)], &mut all_begun[points(lane)]);
            begun.iter_mut().zip(&*joints).for_each(|(to, joint)| *to = joint.begun());
            masses[lane] = mean_mass(bodies, rows);
            limits[lane] = piece
                .purse(purses, &mut [0; PURSE])
                .map(|purse| bounded(lane, masses[lane]).limits(bodies, joints, &purse));
            follow_velocities(bodies, piece, rows, joints);
            let mut writer = Writer { step: &step, band: &mut band, lane, bodies, rows, mass: masses[lane] };
            writer.write(piece, joints, begun);
            writer.ask(piece, joints, begun);
        }
        band.factor();
        band.solve();
        for (lane, piece) in pieces.iter().enumerate() {
            let (rows, joints, begun) = (&rows[points(lane)], &mut all[joints(lane)], &all_begun[points(lane)]);
            joints.iter_mut().for_each(|joint| joint.tension = 0.0);
            let most = most_again(&band, lane, bodies, rows);
            let is_solved = act((&band, lane), piece, bodies, rows, joints, masses[lane]);
            most_squared[lane] = if is_solved { most } else { 0.0 };
            bodies.report.effort.solved(1, 0.0, !is_solved);
            Writer { step: &step, band: &mut band, lane, bodies, rows, mass: masses[lane] }.ask(piece, joints, begun);
        }
        band.solve();
        for (lane, piece) in pieces.iter().enumerate() {
            let (rows, joints, begun) = (&rows[points(lane)], &mut all[joints(lane)], &all_begun[points(lane)]);
            if way_squared(&band, lane, piece.count) < most_squared[lane] {
                act((&band, lane), piece, bodies, rows, joints, masses[lane]);
            }
            if let (Some(limits), Some(mut purse)) = (limits[lane], piece.purse(purses, &mut [0; PURSE])) {
                let course = Course { joints, before: begun, work };
                bounded(lane, masses[lane]).keep_within(limits, bodies, course, &mut purse);
            }
            leave(bodies, rows, joints);
        }
    }
}

/// Lets a piece of which something is held begin where velocities lead, and tells its joints what rounding leaves of the way to there: far from the origin
/// that is more than a wire moves in a sub-step, and it would not move at all.
fn follow_velocities(bodies: &mut Bodies<'_>, piece: &Piece, rows: &[u32], joints: &mut [Joint]) {
    let h = bodies.substep.seconds();
    for (&row, joint) in rows.iter().zip(joints) {
        if piece.is_held {
            bodies.catch_up(row as usize);
        }
        let left = joint.left - bodies.lead(row as usize, h);
        joint.left = if piece.keeps_rounding() && left.is_finite() { left } else { Vec3::ZERO };
    }
}

/// Keeps the ways from point to point as they are left.
fn leave(bodies: &Bodies<'_>, rows: &[u32], joints: &mut [Joint]) {
    for (number, ends) in rows.windows(2).enumerate() {
        let [from, to] = [ends[0], ends[1]].map(|row| bodies.position[row as usize]);
        joints[number].was = to - from + (joints[number + 1].left - joints[number].left);
    }
}

/// The square of how far a solution takes the points of a piece together \[m²\].
fn way_squared<const LANES: usize>(band: &Band<'_, LANES>, lane: usize, points: usize) -> f32
where
    [f32; LANES]: Pod,
{
    (0..points).map(|number| band.vector(lane, number * EQUATIONS).length_squared()).sum()
}

/// The square of how far a second step may take the points of a piece together after this first one \[m²\]; nothing, where that has turned some edge far.
fn most_again<const LANES: usize>(band: &Band<'_, LANES>, lane: usize, bodies: &Bodies<'_>, rows: &[u32]) -> f32
where
    [f32; LANES]: Pod,
{
    let is_little = rows.windows(2).enumerate().all(|(number, ends)| {
        let [from, to] = [ends[0], ends[1]].map(|row| bodies.position[row as usize]);
        let [near, far] = [number, number + 1].map(|number| band.vector(lane, number * EQUATIONS));
        let turn = band.answer(lane, (number + 1) * EQUATIONS + TURN);
        length(far - near) < LITTLE * length(to - from) && turn.abs() < LITTLE
    });
    if is_little { CLOSER * CLOSER * way_squared(band, lane, rows.len()) } else { 0.0 }
}

/// Tells whether all that are fixed of a piece stand still.
fn hangs(bodies: &Bodies<'_>, rows: &[u32]) -> bool {
    let (x, x0) = (&*bodies.position, bodies.before[0]);
    let mut fixed = rows.iter().map(|&row| row as usize).filter(|&row| !(bodies.inverse_mass[row] > 0.0));
    fixed.all(|row| bodies.velocity[row] == Vec3::ZERO && x[row] == x0[row])
}

/// The mean mass of those that move \[kg\]; one, if none does.
fn mean_mass(bodies: &Bodies<'_>, rows: &[u32]) -> f32 {
    let moving = || rows.iter().map(|&row| row as usize).filter(|&row| bodies.inverse_mass[row] > 0.0);
    let count = moving().count();
    if count > 0 { moving().map(|row| bodies.mass[row]).sum::<f32>() / count as f32 } else { 1.0 }
}

impl<P: AsRef<[u32]> + Sync, L: AsRef<[u32]> + Sync> Constraint for Strands<P, L> {
    fn demand(&self) -> Demand {
        let [longest, lanes] = self.widest();
        let band = band::words(longest.saturating_mul(EQUATIONS), lanes);
        let joints = self.particles.as_ref().len().saturating_mul(KEPT);
        let words = |fixed| Words { per_row: 0, fixed };
        Demand {
            kept: words(joints.saturating_add(1).saturating_add(PURSE * self.strands().count())),
            scratch: words(
                longest.saturating_mul(lanes + bounded::WORDS + bounded::BEGUN * lanes).saturating_add(band),
            ),
            ..Demand::NONE
        }
    }

    fn is_empty(&self) -> bool {
        self.particles.as_ref().len() < 2
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"stra", &[self.particles.as_ref().len(), self.points.as_ref().len()]) {
            self.learn(bodies, share.kept.fixed);
        }
        bodies.join_all(self.particles.as_ref());
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !(bodies.substep.seconds() > 0.0) {
            return;
        }
        match self.widest() {
            [longest, 1] => self.solve::<1>(bodies, share, longest),
            [longest, _] => self.solve::<WIDE>(bodies, share, longest),
        }
    }
}

#[cfg(feature = "alloc")]
impl<P: AsRef<[u32]> + Sync, L: AsRef<[u32]> + Sync> Declared for Strands<P, L> {
    fn name(&self) -> &'static str {
        "strands"
    }

    fn solved(&self) -> &'static str {
        "each as one, directly"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| twice(self.particles.as_ref()))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.particles.as_ref(), &[], &[]]
    }

    fn count(&self) -> usize {
        self.strands().count()
    }

    fn links(&self) -> Box<dyn Iterator<Item = [u32; 2]> + '_> {
        let each = self.strands().map(|[first, last]| &self.particles.as_ref()[first..last]);
        Box::new(each.flat_map(|strand| strand.windows(2).map(|ends| [ends[0], ends[1]])))
    }

    fn straight(&self) -> Option<&'static str> {
        Some("strands")
    }

    // The stiffness of the shortest edge.
    fn stiffness(&self, start: &[Particle]) -> Option<f64> {
        let place = |end: u32| start.get(end as usize).map_or(Vec3::NAN, |particle| particle.position);
        let edges = Declared::links(self).map(|[a, b]| length(place(b) - place(a)));
        let shortest = edges.filter(|length| *length > 0.0).fold(f32::INFINITY, min);
        self.params.stretch.and_then(|stretch| stiffness(shortest / stretch))
    }

    // That at the root of the heaviest, hung from there: weight / stretch.
    fn hung(&self, start: &[Particle], gravity: f32) -> Option<f64> {
        let mass = |[first, last]: [usize; 2]| {
            let particles = self.particles.as_ref()[first..last].iter().filter_map(|&i| start.get(i as usize));
            particles.filter(|particle| !particle.fixed).map(|particle| f64::from(particle.mass)).sum::<f64>()
        };
        let heaviest = self.strands().map(mass).fold(0.0, f64::max);
        let strain = |stretch: f32| heaviest * f64::from(gravity) / f64::from(stretch);
        Some(self.params.stretch.map_or(0.0, strain)).filter(|strain| strain.is_finite()).or(Some(0.0))
    }
}
