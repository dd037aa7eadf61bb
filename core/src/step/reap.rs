//! Delete: the scene's reapers judge all rows, and whom the step has ended goes.

use super::View;
use crate::memory::Layout;
use crate::observe::{Observer, Passing};
use crate::particles::Id;
use crate::reap::{CHUNK, Cause, Fate, Judged, ReaperCode};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl View<'_> {
    /// Removes those whom the step has ended by now.
    #[inline(never)]
    pub(super) fn reap(&mut self, scene: &Scene<'_>, report: &mut Report, observer: &mut dyn Observer) {
        if let Some(code) = scene.reapers.code().filter(|_| !scene.reapers.is_empty()) {
            self.judge_all(scene, code);
        }
        // From the back, so that the row that fills a gap has been looked at already.
        let (time, mut end) = (self.status.time, self.len());
        while let Some((row, cause)) = last_doomed(&self.memory.fate[..end]) {
            report.died.count(cause);
            let m = &self.memory;
            let id = Id { slot: m.slot[row], serial: m.serial[row] };
            observer.died(&Passing { id, place: m.position[row], velocity: m.velocity[row], time }, cause);
            self.remove(row, scene.springs, report);
            end = row;
        }
    }

    /// Lets the scene's reapers choose.
    fn judge_all(&mut self, scene: &Scene<'_>, code: ReaperCode) {
        let (time, len, capacity) = (self.status.time, self.len(), self.capacity());
        let layout = Layout::of(scene.plan(), capacity);
        let tile = self.tile(scene, [time, Time::ZERO], len, 0..len, capacity);
        let state = tile.attributes.lives.moved(time, tile.position, tile.velocity);
        let (places, words) = layout.crowd(tile.work, len);
        (code.0)(scene.reapers, Judged { state, fates: tile.fate, index: scene.index, words, places });
    }
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over.
fn last_doomed(fates: &[Fate]) -> Option<(usize, Cause)> {
    let has_doomed = |chunk: &[Fate]| chunk.iter().fold(0, |any, &fate| any | fate as u8) != 0;
    let behind = fates.rchunks(CHUNK).position(has_doomed)?;
    let row = fates[..fates.len() - CHUNK * behind].iter().rposition(|&fate| fate != Fate::Lives)?;
    Some((row, fates[row].cause()?))
}
