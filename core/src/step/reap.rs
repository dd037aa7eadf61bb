//! Delete: the scene's reapers judge all rows, and whom the step has ended goes.

use crate::index::ARE_KEPT;
use crate::memory::{Layout, TILED, Workspace};
use crate::observe::{LifeEvent, Observer};
use crate::particles::Id;
use crate::reap::{CHUNK, Cause, FEW, Judged, PendingDeath, ReaperCode};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Removes those whom the step has ended by now.
    #[inline(never)]
    pub(super) fn reap(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        if let Some(code) = scene.reapers.code().filter(|_| !scene.reapers.is_empty()) {
            self.judge_all(scene, layout, code);
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
    fn judge_all(&mut self, scene: &Scene<'_>, layout: &Layout, code: ReaperCode) {
        let (time, len, mut is_indexed) = (self.status.time, self.len(), self.status.is_indexed);
        let tile = self.tile(scene, layout, [time, Time::ZERO], len);
        let state = tile.attributes.lives.moved(time, tile.position, tile.velocity);
        let (mut index, places) = layout.crowd(tile.work, scene.index);
        let count = len.min(places.len());
        let places = &mut places[..count];
        if ARE_KEPT && scene.asks_around() {
            index.begin(scene.reach(), &mut is_indexed);
        }
        let judged = Judged { state, pending_deaths: tile.pending_death, index: index.again(), places: &mut *places };
        (code.0)(scene.reapers, judged);
        if ARE_KEPT && is_indexed {
            index.name(bytemuck::cast_slice_mut(places), state.slot);
        }
        self.status.is_indexed = is_indexed;
    }
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over, and in one that has such a row a few at a time.
fn last_doomed(pending_deaths: &[PendingDeath]) -> Option<(usize, Cause)> {
    let upto = if TILED { upto_doomed::<FEW>(upto_doomed::<CHUNK>(pending_deaths)?)? } else { pending_deaths };
    let row = upto.iter().rposition(|&pending_death| pending_death != PendingDeath::Lives)?;
    Some((row, upto[row].cause()?))
}

/// The rows up to the last chunk of so many, counted from the end, in which somebody has to go.
#[inline(always)]
fn upto_doomed<const ROWS: usize>(pending_deaths: &[PendingDeath]) -> Option<&[PendingDeath]> {
    let (rest, chunks) = pending_deaths.as_rchunks::<ROWS>();
    let doomed = chunks.iter().rposition(|chunk| chunk.iter().fold(0, |any, &death| any | death as u8) != 0);
    let ahead = doomed.map_or(0, |chunk| ROWS * (chunk + 1));
    if doomed.is_none() && rest.is_empty() { None } else { Some(&pending_deaths[..rest.len() + ahead]) }
}
