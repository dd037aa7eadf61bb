//! Create: emitters emit into the step.

use crate::emit::{Ahead, Births};
use crate::force::Backdrop;
use crate::index::ARE_KEPT;
use crate::memory::{Layout, Slices, Storage, Workspace};
use crate::observe::{Observer, Phase};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl<'w> Workspace<'w> {
    /// Begins a step: lets the emitters emit, and returns how many particles there were before.
    ///
    /// Births are lent the workspace as it is and for good, which spares a chip a copy of it: the step goes on with another.
    #[inline(never)]
    pub(crate) fn create(
        &'w mut self,
        scene: &Scene<'_>,
        backdrop: &'w Backdrop<'w>,
        layout: &'w Layout,
        dt: Time,
        report: &'w mut Report,
        observer: &'w mut dyn Observer,
    ) -> usize {
        self.tell(Phase::Begin, scene, observer);
        let (old, now) = (self.status.len, self.status.time);
        let (reach, end) = (scene.emitters.reach(), now + dt);
        if ARE_KEPT {
            self.go_on_with_index(scene, layout);
        }
        if reach > 0.0 {
            let work = core::mem::take(&mut self.memory.work);
            let (mut index, places) = layout.crowd(work, scene.index);
            let places = &mut places[..old];
            places.copy_from_slice(&self.memory.position[..old]);
            index.with(places, reach, &mut |near| {
                report.effort.all_pairs += u64::from(near.is_none() && old > 0);
                let mut memory = self.memory.slices();
                let workspace = &mut Workspace { memory: &mut memory, capacity: self.capacity, status: self.status };
                let (report, observer) = (&mut *report, &mut *observer);
                let ahead = Ahead::default();
                let births =
                    &mut Births { workspace, layout, backdrop, report, observer, near, old, end, number: 0, ahead };
                scene.emitters.emit(now, end, births);
            });
            self.memory.work = work;
        } else {
            let (workspace, near) = (self, None);
            let ahead = Ahead::default();
            let births =
                &mut Births { workspace, layout, backdrop, report, observer, near, old, end, number: 0, ahead };
            scene.emitters.emit(now, end, births);
        }
        old
    }

    /// Strikes out of the index of the last step's end, if there is one, those who have died since, and gives the others their rows.
    fn go_on_with_index(&mut self, scene: &Scene<'_>, layout: &Layout) {
        if !scene.asks_around() {
            // This scene's step works in the memory of the index.
            self.status.is_indexed = false;
            return;
        }
        let len = self.len();
        let Slices { work, position, slot, row_of, .. } = &mut *self.memory;
        let (mut index, names) = layout.crowd(work, scene.index);
        let row_of = |name: u32| {
            let row = *row_of.get(name as usize)?;
            (slot[..len].get(row as usize) == Some(&name)).then_some(row)
        };
        index.begin(scene.reach(), &mut self.status.is_indexed);
        index.follow(&position[..len], bytemuck::cast_slice(names), &row_of);
    }
}
