//! The step: create, advance, snap, collide, reap. Each is a file.

mod advance;
mod create;
mod field;
mod population;
mod snap;
mod substeps;
mod view;

pub(crate) use view::{Status, View};

use crate::collide::Passage;
use crate::observe::{Observer, Phase};
use crate::reap::reap;
use crate::report::Report;
use crate::scene::Scene;
use crate::stall;
use crate::time::Time;

impl View<'_> {
    /// The whole of a step: create, update, collide, delete.
    pub(crate) fn step(&mut self, scene: &Scene<'_>, dt: Time, report: &mut Report, observer: &mut dyn Observer) {
        let end = self.status.time + dt;
        observer.after(Phase::Begin, &self.state(scene));
        let old = self.create(scene, end, report, observer);
        observer.after(Phase::Create, &self.state(scene));
        self.advance(scene, old, dt, report, observer);
        self.status.time = end;
        observer.after(Phase::Move, &self.state(scene));
        if scene.springs.iter().any(|spring| spring.breaks_at.is_some()) {
            self.snap(scene, report);
            observer.after(Phase::Snap, &self.state(scene));
        }
        if scene.is_swept() {
            let (report, observer) = (&mut *report, &mut *observer);
            scene.meetings.follow(Passage { view: &mut *self, scene, old, dt, end, report, observer });
        }
        observer.after(Phase::Collide, &self.state(scene));
        // The steps that were made of this one: sub-steps, and those that a method chose.
        let steps = u64::from(scene.pieces()).max(report.effort.accepted);
        let len = self.len();
        let h = dt.seconds() / steps as f32;
        report.caps.stalled += stall::count(&self.memory.position[..len], &self.memory.velocity[..len], h);
        let before = report.died.total();
        reap(self, scene, end, report, observer);
        if report.died.total() > before || report.born + report.hits + report.contacts + report.broken > 0 {
            self.status.hint = Time::ZERO;
        }
        observer.after(Phase::Delete, &self.state(scene));
    }
}
