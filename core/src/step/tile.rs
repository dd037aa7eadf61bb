//! Rows that go through a step together: all that there are, or few enough to stay in the cache meanwhile.

use super::substeps::Carried;
use crate::collide::{Tile, leap_by_itself};
use crate::constrain::Substep;
use crate::custom::CustomColumns;
use crate::force::{Attributes, Ends, Springs, State, Steady};
use crate::index::{Listed, Neighbours};
use crate::integrate::Drift;
use crate::memory::{Layout, Status, TILED, Workspace};
use crate::observe::Observer;
use crate::reap::{Verdicts, end_lost, end_old};
use crate::report::Report;
use crate::rows::{BLOCKS, Extents, farthest_of_finite};
use crate::scene::Scene;
use crate::stall;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Rows of a tile: enough to share the cost of the calls, few enough for the innermost cache.
const TILE: usize = 1280;

/// The same where a step goes over them hardly more than once: the second cache will do.
const ONE_PASS: usize = 4 * TILE;

/// The same where they leap and are swept a few at a time: what is left of these in the end is all that more rows would share. No thread
/// has fewer.
const LEAPT: usize = 3 * TILE;

/// Rows that are worth a thread's while.
#[cfg(feature = "rayon")]
const SHARE: usize = 4 * TILE;

impl Scene<'_> {
    /// Rows of a tile.
    pub(super) fn tile_rows(&self) -> usize {
        match (self.leap().is_some(), self.is_swept()) {
            (true, true) if self.colliders.many().is_some() => 2 * LEAPT,
            (true, true) => LEAPT,
            (true, false) => ONE_PASS,
            (false, _) => TILE,
        }
    }

    /// The forces that one pass over the columns can work out, if there are no others.
    pub(crate) fn steady(&self) -> Option<Steady> {
        let floats = || self.materials.code().is_some_and(|code| (code.floats)(self.materials));
        let is_alone = BLOCKS && self.springs.list().is_empty() && !floats();
        if is_alone { self.forces.steady() } else { None }
    }

    /// The share of what constraints have done to velocities with which its method has to begin: none of it where
    /// forces go neither by velocities nor by places.
    pub(super) fn lead(&self) -> f32 {
        let depends = || self.forces.depends_on_motion() || !self.springs.list().is_empty();
        let lead = if self.constraints.is_empty() { 0.0 } else { self.integrator.lead() };
        if lead > 0.0 && depends() { lead } else { 0.0 }
    }

    /// The same, if a whole step is that pass.
    pub(super) fn leap(&self) -> Option<(Steady, Drift)> {
        let is_whole = BLOCKS && self.pieces() == 1 && self.constraints.is_empty();
        let drift = if is_whole { self.integrator.drift()? } else { return None };
        Some((self.steady()?, drift))
    }

    /// The sub-steps of a step that begins at an instant and takes some time: none of them takes none, if the step takes some.
    pub(super) fn parts(&self, [now, dt]: [Time; 2]) -> impl Iterator<Item = Substep> + use<> {
        let most = u32::try_from(dt.ticks()).unwrap_or(u32::MAX).max(1);
        let (mut from, count) = (now, self.pieces().min(most));
        (0..count).map(move |number| {
            let to = now + dt.part(number + 1, count);
            Substep { during: [core::mem::replace(&mut from, to), to], number, count, step: dt }
        })
    }

    /// Tells whether a step takes each row through all its phases without a look at the others, so that rows can go a
    /// few at a time.
    pub(super) fn is_local(&self) -> bool {
        let Self { springs, forces, constraints, meetings, integrator, .. } = self;
        let apart = springs.list().is_empty() && constraints.is_empty() && meetings.is_through();
        apart && forces.is_local() && integrator.is_local()
    }
}

impl Workspace<'_> {
    /// Moves all rows at once through a sub-step.
    ///
    /// Apart, as all that takes room on the stack, for which chips have little: paths are followed beyond it.
    #[inline(never)]
    pub(super) fn advance(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        substep: Substep,
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let Status { mut hint, mut listed, changes, .. } = *self.status;
        let kept = core::mem::take(&mut self.memory.kept);
        let carried = Carried { kept: &mut *kept, hint: &mut hint, listed: &mut listed, changes };
        let span = [substep.during[0], Time::ZERO];
        self.tile(scene, layout, span, old).advance(scene, substep, carried, report, observer);
        self.memory.kept = kept;
        self.status.listed = listed;
        self.status.hint = hint;
    }

    /// Judges all rows at once; parts of a step take `h` \[s\].
    #[inline(never)]
    pub(super) fn judge(&mut self, scene: &Scene<'_>, layout: &Layout, span: [Time; 2], old: usize, h: f32) -> u64 {
        self.tile(scene, layout, span, old).judge(h)
    }

    /// All rows in a step that begins with `old` of them.
    pub(crate) fn tile<'s>(
        &'s mut self,
        scene: &'s Scene<'s>,
        layout: &'s Layout,
        [now, dt]: [Time; 2],
        old: usize,
    ) -> Tile<'s> {
        let (whole, len, m) = (self.capacity, self.status.len, &mut self.memory);
        let springs = Springs {
            springs: scene.springs.list(),
            start: self.status.start,
            serial: &m.serial[..len],
            row_of: m.row_of,
            last_spring: &m.last_spring,
            incident: m.incident,
        };
        let lives = State {
            radius: &m.radius[..len],
            mass: &m.mass[..len],
            drag: &m.drag[..len],
            charge: &m.charge[..len],
            born: &m.born[..len],
            dies: &m.dies[..len],
            slot: &m.slot[..len],
            key: &m.key[..len],
            color: &m.color[..len],
            material: &m.material[..len],
            materials: scene.materials,
            springs,
            custom: CustomColumns::kept(scene.custom, m.kept, whole, len),
            near: Neighbours::among(&[]).in_room(scene.index.room()),
            ..State::EMPTY
        };
        Tile {
            obstacles: scene.obstacles(),
            now,
            dt,
            first: 0,
            old,
            position: &mut m.position[..len],
            velocity: &mut m.velocity[..len],
            pending_death: &mut m.pending_death[..len],
            attributes: Attributes {
                lives,
                inverse_mass: &m.inverse_mass[..len],
                elasticity: &m.elasticity[..len],
                common: &self.status.common,
            },
            work: m.work,
            layout,
            may_end: !TILED || self.status.next_end() <= now + dt,
            reached: None,
        }
    }
}

impl<'a> Tile<'a> {
    /// Some of the rows, with memory to work with.
    pub(super) fn part<'s>(&'s mut self, rows: Range<usize>, work: &'s mut [Vec3]) -> Tile<'s> {
        Tile {
            obstacles: self.obstacles,
            now: self.now,
            dt: self.dt,
            first: self.first + rows.start,
            old: self.old.clamp(rows.start, rows.end) - rows.start,
            position: &mut self.position[rows.clone()],
            velocity: &mut self.velocity[rows.clone()],
            pending_death: &mut self.pending_death[rows.clone()],
            attributes: self.attributes.rows(rows),
            work,
            layout: self.layout,
            may_end: self.may_end,
            reached: None,
        }
    }

    /// Takes the rows through all phases, a few at a time; sub-steps take `h` \[s\]. Forces that are evaluated for one tile
    /// after the other are evaluated once.
    pub(super) fn pass(&mut self, scene: &Scene<'_>, h: f32, report: &mut Report, observer: &mut dyn Observer) {
        let (span, len) = ([self.now, self.dt], self.position.len());
        let most = scene.tile_rows();
        let before = report.effort.evaluations;
        let mut evaluations = 0;
        // Memory that is in the cache goes from tile to tile.
        let work = core::mem::take(&mut self.work);
        for first in (0..len).step_by(most) {
            report.effort.evaluations = before;
            let mut tile = self.part(first..len.min(first + most), work);
            for substep in scene.parts(span) {
                tile.go(scene, substep, report, observer);
            }
            evaluations = report.effort.evaluations - before;
            report.caps.stalled += tile.judge(h);
        }
        self.work = work;
        report.effort.evaluations = before + evaluations;
    }

    /// Takes the rows through a sub-step.
    fn go(&mut self, scene: &Scene<'_>, substep: Substep, report: &mut Report, observer: &mut dyn Observer) {
        let leaps = scene.paths.are_curved() && scene.is_swept() && self.old == self.position.len();
        let leap = if leaps { scene.leap() } else { None };
        if let Some((steady, drift)) = leap {
            let ([now, end], attributes) = (substep.during, self.attributes);
            (self.now, self.dt) = (now, end - now);
            let h = self.dt.seconds();
            report.effort.evaluations += u64::from(self.old > 0);
            let leap = &mut |rows: Range<usize>, ends: Ends<'_>, start: Ends<'_>| {
                steady.leap(attributes.inertia(rows), ends, start, h, drift)
            };
            return leap_by_itself(self, leap, report, observer);
        }
        let (mut hint, mut listed) = (Time::ZERO, Listed::NONE);
        let carried = Carried { kept: &mut [], hint: &mut hint, listed: &mut listed, changes: 0 };
        self.advance(scene, substep, carried, report, observer);
        if scene.is_swept() {
            scene.paths.follow(self, report, observer);
        }
    }

    /// The first so many rows, and the others, each with its memory.
    #[cfg(feature = "rayon")]
    fn split_at(self, rows: usize, work: [&'a mut [Vec3]; 2]) -> [Self; 2] {
        let Self { obstacles, now, dt, first, old, attributes, layout, may_end, .. } = self;
        let len = self.position.len();
        let (position, velocity) = (self.position.split_at_mut(rows), self.velocity.split_at_mut(rows));
        let (pending_death, [front, back]) = (self.pending_death.split_at_mut(rows), work);
        let part = |position, velocity, pending_death, work, rows: Range<usize>| Self {
            obstacles,
            now,
            dt,
            first: first + rows.start,
            old: old.clamp(rows.start, rows.end) - rows.start,
            position,
            velocity,
            pending_death,
            attributes: attributes.rows(rows),
            work,
            layout,
            may_end,
            reached: None,
        };
        [
            part(position.0, velocity.0, pending_death.0, front, 0..rows),
            part(position.1, velocity.1, pending_death.1, back, rows..len),
        ]
    }

    /// The same on all threads of the pool that this one belongs to, each with its share of the rows and of the memory.
    #[cfg(feature = "rayon")]
    pub(super) fn pass_side_by_side(mut self, scene: &Scene<'_>, h: f32) -> Report {
        let len = self.position.len();
        if len < 2 * SHARE {
            // These rows may be fewer than a tile has, and have memory for no more than they are.
            let (layout, mut report) = (self.layout.of_tiles(len), Report::default());
            let mut tile: Tile<'_> = self;
            tile.layout = &layout;
            tile.pass(scene, h, &mut report, &mut ());
            return report;
        }
        let rows = (len / 2).next_multiple_of(TILE);
        let work = Layout::divided(core::mem::take(&mut self.work), rows, len);
        let [front, back] = self.split_at(rows, work.into());
        let (mut report, others) =
            rayon::join(|| front.pass_side_by_side(scene, h), || back.pass_side_by_side(scene, h));
        let evaluations = report.effort.evaluations.max(others.effort.evaluations);
        report += others;
        report.effort.evaluations = evaluations;
        report
    }
}

impl Tile<'_> {
    /// Finds out who has come to the end of its life, and who is nowhere any more. Returns how many stall in parts of a step
    /// of `h` \[s\].
    #[inline(never)]
    pub(super) fn judge(&mut self, h: f32) -> u64 {
        let end = self.end();
        let mut verdicts = Verdicts::on(self.pending_death);
        if self.may_end {
            end_old(&self.attributes.lives.dies[..self.position.len()], end, &mut verdicts);
        }
        let (farthest, are_finite) = match self.reached.filter(|_| BLOCKS) {
            Some(Extents { place, .. }) => (place, true),
            None => farthest_of_finite(self.position, self.velocity),
        };
        if !are_finite {
            end_lost(self.position, self.velocity, &mut verdicts);
        }
        if stall::may_be(farthest, h) { stall::count(self.position, self.velocity, h) } else { 0 }
    }
}
