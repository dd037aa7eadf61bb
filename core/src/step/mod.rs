//! The step: create, advance, snap, collide, reap. Each is a file.

mod advance;
mod create;
mod field;
mod population;
mod snap;
mod substeps;
mod tile;
mod view;

pub(crate) use tile::Tile;
pub(crate) use view::{Status, View};

use crate::collide::{Passage, each_by_itself};
use crate::observe::{Observer, Phase};
use crate::reap::reap;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;
use tile::{TILE, tiles};

impl View<'_> {
    /// The whole of a step: create, update, collide, delete.
    pub(crate) fn step(&mut self, scene: &Scene<'_>, dt: Time, report: &mut Report, observer: &mut dyn Observer) {
        let span = [self.status.time, dt];
        observer.after(Phase::Begin, &self.state(scene));
        let old = self.create(scene, span[0] + dt, report, observer);
        observer.after(Phase::Create, &self.state(scene));
        if scene.is_local() && !observer.watches_phases() {
            self.tile_by_tile(scene, span, old, report, observer);
        } else {
            self.phase_by_phase(scene, span, old, report, observer);
        }
        let before = report.died.total();
        reap(self, scene, self.status.time, report, observer);
        if report.died.total() > before || report.born + report.hits + report.contacts + report.broken > 0 {
            self.status.hint = Time::ZERO;
        }
        observer.after(Phase::Delete, &self.state(scene));
    }

    /// Takes all rows through one phase after the other.
    fn phase_by_phase(
        &mut self,
        scene: &Scene<'_>,
        span: [Time; 2],
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let [now, dt] = span;
        let (rows, capacity, mut hint) = (0..self.len(), self.capacity(), self.status.hint);
        self.tile(scene, span, old, rows.clone(), capacity).advance(&mut hint, report, observer);
        (self.status.time, self.status.hint) = (now + dt, hint);
        observer.after(Phase::Move, &self.state(scene));
        if scene.springs.iter().any(|spring| spring.breaks_at.is_some()) {
            self.snap(scene, report);
            observer.after(Phase::Snap, &self.state(scene));
        }
        if scene.is_swept() {
            let (report, observer) = (&mut *report, &mut *observer);
            scene.meetings.follow(Passage { view: &mut *self, scene, old, now, dt, report, observer });
        }
        observer.after(Phase::Collide, &self.state(scene));
        // The steps that were made of this one: sub-steps, and those that a method chose.
        let steps = u64::from(scene.pieces()).max(report.effort.accepted);
        report.caps.stalled += self.tile(scene, span, old, rows, capacity).judge(dt.seconds() / steps as f32);
    }

    /// Takes a few rows at a time through all phases: the old, then the newborn.
    fn tile_by_tile(
        &mut self,
        scene: &Scene<'_>,
        span: [Time; 2],
        old: usize,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let (len, is_swept, mut hint) = (self.len(), scene.is_swept(), self.status.hint);
        let h = span[1].seconds() / scene.pieces() as f32;
        let capacity = self.capacity().min(TILE);
        for rows in [0..old, old..len] {
            // Forces that are evaluated for one tile after the other are evaluated once.
            let (before, mut evaluations) = (report.effort.evaluations, 0);
            for rows in tiles(rows) {
                report.effort.evaluations = before;
                let mut tile = self.tile(scene, span, old, rows, capacity);
                tile.advance(&mut hint, report, observer);
                evaluations = report.effort.evaluations - before;
                if is_swept {
                    each_by_itself(&mut tile, report, observer);
                }
                report.caps.stalled += tile.judge(h);
            }
            report.effort.evaluations = before + evaluations;
        }
        self.status.time = span[0] + span[1];
    }
}
