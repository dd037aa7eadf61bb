//! Delete: the scene's reapers judge all rows, and whom the step has ended goes.

use super::population::AT_ONCE;
use crate::index::ARE_KEPT;
use crate::lanes::widest;
use crate::memory::{Layout, TILED, Workspace};
use crate::observe::{Attention, LifeEvent, Observer};
use crate::particles::Id;
use crate::reap::{CHUNK, Cause, Judged, PendingDeath, ReaperCode};
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
            self.judge_all(scene, layout, code, &mut report.effort.all_pairs);
        }
        let before = report.died.lifetime;
        // Hosts fill in no event that nobody reads; on chips, asking takes more code than telling.
        let is_heard = !TILED || observer.attention() > Attention::Nothing;
        // From the back, so that the row that fills a gap has been looked at already.
        let (time, mut end) = (self.status.time, self.len());
        let most = if TILED && !scene.springs.list().is_empty() { 1 } else { AT_ONCE };
        let (mut doomed, mut count) = ([0; AT_ONCE], 0);
        while let Some((row, cause)) = widest(
            #[inline(always)]
            || last_doomed(&self.memory.pending_death[..end]),
        ) {
            report.died.count(cause);
            if is_heard {
                let m = &self.memory;
                let id = Id { slot: m.slot[row], serial: m.serial[row] };
                observer.died(&LifeEvent { id, place: m.position[row], velocity: m.velocity[row], time }, cause);
            }
            (doomed[count], end) = (row as u32, row);
            count += 1;
            if count == most {
                self.remove(&doomed[..most], scene.springs, report);
                count = 0;
            }
        }
        if count > 0 {
            self.remove(&doomed[..count], scene.springs, report);
        }
        // Where many are born somebody dies all the time; else it is worth knowing when the next one does.
        if TILED && self.status.next_end() <= time && report.died.lifetime == before {
            self.status.end_at(&self.memory.dies[..self.status.len]);
        }
    }

    /// Lets the scene's reapers choose.
    #[inline(never)]
    fn judge_all(&mut self, scene: &Scene<'_>, layout: &Layout, code: ReaperCode, all_pairs: &mut u64) {
        let (time, len, mut is_indexed) = (self.status.time, self.len(), self.status.is_indexed);
        let tile = self.tile(scene, layout, [time, Time::ZERO], len);
        let state = tile.attributes.lives.moved(time, tile.position, tile.velocity);
        let (mut index, places) = layout.crowd(tile.work, scene.index);
        let count = len.min(places.len());
        let places = &mut places[..count];
        if ARE_KEPT && scene.asks_around() {
            index.begin(scene.reach(), &mut is_indexed);
        }
        let (pending_deaths, index_of_all) = (tile.pending_death, index.again());
        let judged = Judged { state, pending_deaths, index: index_of_all, all_pairs, places: &mut *places };
        (code.0)(scene.reapers, judged);
        if ARE_KEPT && is_indexed {
            index.name(bytemuck::cast_slice_mut(places), state.slot);
        }
        self.status.is_indexed = is_indexed;
    }
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over, and in one that has such a row words of eight.
#[inline(always)]
fn last_doomed(pending_deaths: &[PendingDeath]) -> Option<(usize, Cause)> {
    let row = match TILED {
        true => last_set(bytemuck::cast_slice(pending_deaths)),
        false => pending_deaths.iter().rposition(|&pending_death| pending_death != PendingDeath::Lives),
    }?;
    Some((row, pending_deaths[row].cause()?))
}

/// The last byte that is not zero.
#[inline(always)]
fn last_set(bytes: &[u8]) -> Option<usize> {
    let (_, chunks) = bytes.as_rchunks::<CHUNK>();
    let mut upto = bytes.len();
    for chunk in chunks.iter().rev() {
        if chunk.iter().fold(0, |any, byte| any | byte) != 0 {
            break;
        }
        upto -= CHUNK;
    }
    let (rest, words) = bytes[..upto].as_rchunks();
    for (nth, word) in words.iter().enumerate().rev() {
        let word = u64::from_le_bytes(*word);
        if word != 0 {
            return Some(rest.len() + size_of::<u64>() * nth + word.ilog2() as usize / 8);
        }
    }
    rest.iter().rposition(|&byte| byte != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_byte_that_is_set_is_found() {
        let mut bytes = [0; 200];
        for len in [0, 1, 7, 8, 9, 63, 64, 65, 72, 127, 128, 200] {
            assert_eq!(last_set(&bytes[..len]), None);
        }
        for last in 0..bytes.len() {
            bytes[last] = 1 << (last % 8);
            // Whatever comes before does not count, and what is set may be anywhere before the end.
            bytes[last / 2] = 1;
            for len in last + 1..=bytes.len() {
                assert_eq!(last_set(&bytes[..len]), Some(last), "of {len}");
            }
            (bytes[last], bytes[last / 2]) = (0, 0);
        }
    }
}
