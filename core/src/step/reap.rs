//! Delete: the scene's reapers judge all rows, and whom the step has ended goes.

use super::View;
use crate::custom::CustomColumns;
use crate::force::State;
use crate::index::Neighbours;
use crate::memory::Layout;
use crate::observe::{Observer, Passing};
use crate::particles::Id;
use crate::reap::{CHUNK, Cause, Fate, Verdicts};
use crate::report::Report;
use crate::scene::Scene;
use glam::Vec3;

impl View<'_> {
    /// Removes those whom the step has ended by now.
    #[inline(never)]
    pub(super) fn reap(&mut self, scene: &Scene<'_>, report: &mut Report, observer: &mut dyn Observer) {
        if let Some(code) = scene.reapers.code().filter(|_| !scene.reapers.is_empty()) {
            (code.0)(self, scene);
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
    pub(crate) fn judge_all(&mut self, scene: &Scene<'_>) {
        let (rows, reapers, capacity) = (0..self.len(), scene.reapers, self.capacity());
        let layout = Layout::of(scene.plan(), capacity);
        // Reapers see everything but the fates and the memory of the index.
        let (fates, work) = (core::mem::take(&mut self.memory.fate), core::mem::take(&mut self.memory.work));
        let custom = CustomColumns::kept(scene.custom, self.memory.kept, capacity, rows.len());
        let state = State { custom, ..self.state(scene) };
        let living = &mut fates[rows.clone()];
        if reapers.reach() > 0.0 {
            let (position, words) = layout.crowd(work, rows.len());
            for ((place, &x), &fate) in position.iter_mut().zip(state.position).zip(&*living) {
                *place = if fate == Fate::Lives { x } else { Vec3::NAN };
            }
            let mut verdicts = Verdicts::on(living);
            scene.index.arrange(words, position, reapers.reach(), &mut |near| {
                reapers.judge(
                    &State { position, near: Neighbours::by(near, position), ..state },
                    rows.clone(),
                    &mut verdicts,
                );
            });
        } else {
            reapers.judge(&state, rows, &mut Verdicts::on(living));
        }
        (self.memory.fate, self.memory.work) = (fates, work);
    }
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over.
fn last_doomed(fates: &[Fate]) -> Option<(usize, Cause)> {
    let has_doomed = |chunk: &[Fate]| chunk.iter().fold(0, |any, &fate| any | fate as u8) != 0;
    let behind = fates.rchunks(CHUNK).position(has_doomed)?;
    let row = fates[..fates.len() - CHUNK * behind].iter().rposition(|&fate| fate != Fate::Lives)?;
    Some((row, fates[row].cause()?))
}
