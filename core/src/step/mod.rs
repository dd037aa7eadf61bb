//! The step: create, age, in each sub-step advance, snap and collide, age, reap. Each is a file, but collisions, which are a folder beside this one.

mod advance;
mod age;
mod create;
mod population;
mod reap;
mod snap;
mod substeps;
mod tell;
mod tile;
mod write;

use crate::collide::Swept;
use crate::constrain::Substep;
use crate::index::Listed;
use crate::memory::{Layout, TILED, Workspace};
use crate::observe::{Attention, Observer, Phase};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// The whole of a step behind create, before which there were `old` particles: update, collide, delete.
    #[inline(never)]
    pub(crate) fn step(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        old: usize,
        dt: Time,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        // No step leads beyond the end of all time, whichever way it goes.
        let dt = dt.min(Time::NEVER - self.status.time);
        let span = [self.status.time, dt];
        self.age(scene, layout, span);
        self.tell(Phase::Create, scene, observer);
        // In tiles those of one go through all sub-steps before those of the next, and who looks on would be told in that order. Forces tell of all at once.
        let told_alike = scene.pieces() == 1 && observer.attention() < Attention::Phases;
        let is_unheard = observer.attention() == Attention::Nothing;
        if dt == Time::ZERO {
            // Nothing moves in no time, and what holds together would be divided by that.
        } else if TILED && scene.is_local() && (is_unheard || told_alike && scene.telling(observer).is_none()) {
            self.tile_by_tile(scene, layout, span, old, report, observer);
        } else {
            self.phase_by_phase(scene, layout, span, old, report, observer);
        }
        self.come_of_age(scene, layout, observer);
        let has_custom = scene.custom.count() > 0;
        if has_custom {
            self.let_forces_write(scene, layout, span, report);
        }
        let len = self.len();
        scene.index.wrap(&mut self.memory.position[..len]);
        let before = report.died.total();
        self.reap(scene, layout, report, observer);
        if report.died.total() > before || report.born + report.hits + report.contacts + report.broken > 0 {
            self.status.hint = Time::ZERO;
        }
        self.tell(Phase::Delete, scene, observer);
        if has_custom {
            self.let_write(scene, layout, observer);
        }
    }

    /// Takes all rows through one phase after the other.
    #[inline(never)]
    fn phase_by_phase(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        span: [Time; 2],
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        for substep in scene.parts(span) {
            self.advance(scene, layout, substep, old, report, observer);
            self.status.time = substep.during[1];
            self.tell(Phase::Move, scene, observer);
            let springs = scene.springs.code().filter(|_| substep.is_last());
            if springs.is_some_and(|code| self.snap(scene, code, report)) {
                self.tell(Phase::Snap, scene, observer);
            }
            if scene.is_swept() {
                self.sweep(scene, layout, substep, old, report, observer);
            }
            if let Some(code) = scene.telling(observer) {
                self.let_forces_tell(scene, layout, substep, code, observer);
            }
            self.tell(Phase::Collide, scene, observer);
        }
        // The steps that were made of this one: sub-steps, and those that a method chose.
        let steps = u64::from(scene.pieces()).max(report.effort.accepted);
        report.caps.stalled += self.judge(scene, layout, span, old, span[1].seconds() / steps as f32);
    }

    /// Holds all rows against scenery, sinks and each other at the end of a sub-step.
    ///
    /// Apart, as all that takes room on the stack, for which chips have little: paths are followed beyond it.
    #[inline(never)]
    fn sweep(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        substep: Substep,
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let ([now, end], met) = (substep.during, report.hits + report.contacts);
        let tile = &mut self.tile(scene, layout, [now, end - now], old);
        scene.meetings.follow(Swept { tile, paths: scene.paths, index: scene.index, report: &mut *report, observer });
        if report.hits + report.contacts > met {
            self.status.hint = Time::ZERO;
        }
    }

    /// Takes a few rows at a time through all phases: the old, then the newborn.
    #[inline(never)]
    fn tile_by_tile(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        span: [Time; 2],
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let h = span[1].seconds() / scene.pieces() as f32;
        let (layout, len) = (&layout.of_tiles(scene.tile_rows()), self.len());
        // Tiles work in the memory of lists and of the index as well.
        (self.status.listed, self.status.is_indexed) = (Listed::NONE, false);
        let mut all = self.tile(scene, layout, span, old);
        let work = core::mem::take(&mut all.work);
        for rows in [0..old, old..len] {
            let mut tile = all.part(rows, work);
            #[cfg(feature = "rayon")]
            if observer.attention() == Attention::Nothing && rayon::current_thread_index().is_some() {
                *report += tile.pass_side_by_side(scene, h);
                continue;
            }
            tile.pass(scene, h, report, observer);
        }
        self.status.time = span[0] + span[1];
    }
}
