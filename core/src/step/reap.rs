//! Delete: the scene's reapers judge all rows, and whom the step has ended goes.

use super::{TILED, Workspace};
use crate::memory::Layout;
use crate::observe::{LifeEvent, Observer};
use crate::particles::Id;
use crate::reap::{CHUNK, Cause, Judged, PendingDeath, ReaperCode};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Removes those whom the step has ended by now.
    #[inline(never)]
    pub(super) fn reap(&mut self, scene: &Scene<'_>, report: &mut Report, observer: &mut dyn Observer) {
        if let Some(code) = scene.reapers.code().filter(|_| !scene.reapers.is_empty()) {
            self.judge_all(scene, code);
        }
        let before = report.died.lifetime;
        // From the back, so that the row that fills a gap has been looked at already.
        let (time, mut end) = (self.status.time, self.len());
        while let Some((row, cause)) = last_doomed(&self.memory.pending_death[..end]) {
            report.died.count(cause);
            let m = &self.memory;
            let id = Id { slot: m.slot[row], serial: m.serial[row] };
            observer.died(&LifeEvent { id, place: m.position[row], velocity: m.velocity[row], time }, cause);
            self.remove(row, scene.springs, report);
            end = row;
        }
        // Where many are born somebody dies all the time; else it is worth knowing when the next one does.
        if TILED && self.status.next_end() <= time && report.died.lifetime == before {
            self.status.end_at(&self.memory.dies[..self.status.len]);
        }
    }

    /// Lets the scene's reapers choose.
    #[inline(never)]
    fn judge_all(&mut self, scene: &Scene<'_>, code: ReaperCode) {
        let (time, len, capacity) = (self.status.time, self.len(), self.capacity());
        let layout = Layout::of(scene.plan(), capacity);
        let tile = self.tile(scene, [time, Time::ZERO], len, 0..len, capacity);
        let state = tile.attributes.lives.moved(time, tile.position, tile.velocity);
        let (places, words) = layout.crowd(tile.work, len);
        (code.0)(
            scene.reapers,
            Judged { state, pending_deaths: tile.pending_death, index: scene.index, words, places },
        );
    }
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over.
fn last_doomed(pending_deaths: &[PendingDeath]) -> Option<(usize, Cause)> {
    let has_doomed =
        |chunk: &[PendingDeath]| chunk.iter().fold(0, |any, &pending_death| any | pending_death as u8) != 0;
    let behind = if TILED { pending_deaths.rchunks(CHUNK).position(has_doomed)? } else { 0 };
    let row = pending_deaths[..pending_deaths.len() - CHUNK * behind]
        .iter()
        .rposition(|&pending_death| pending_death != PendingDeath::Lives)?;
    Some((row, pending_deaths[row].cause()?))
}
