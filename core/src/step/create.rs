//! Create: emitters emit into the step.

use crate::emit::Births;
use crate::index::{ARE_KEPT, SpatialIndex};
use crate::memory::{Slices, Storage, Workspace};
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Lets the emitters emit, and returns how many particles there were before.
    #[inline(never)]
    pub(super) fn create(
        &mut self,
        scene: &Scene<'_>,
        end: Time,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) -> usize {
        let (old, now) = (self.status.len, self.status.time);
        let reach = scene.emitters.reach();
        if ARE_KEPT {
            self.go_on_with_index(scene);
        }
        if reach > 0.0 {
            let work = core::mem::take(&mut self.memory.work);
            let (mut index, places) = self.layout(scene).crowd(work, scene.index);
            let places = &mut places[..old];
            places.copy_from_slice(&self.memory.position[..old]);
            index.with(places, reach, &mut |near| self.emit(scene, near, [now, end], report, observer));
            self.memory.work = work;
        } else {
            self.emit(scene, None, [now, end], report, observer);
        }
        old
    }

    /// Strikes out of the index of the last step's end, if there is one, those who have died since, and gives the others their rows.
    fn go_on_with_index(&mut self, scene: &Scene<'_>) {
        if !scene.asks_around() {
            // This scene's step works in the memory of the index.
            self.status.is_indexed = false;
            return;
        }
        let (len, layout) = (self.len(), self.layout(scene));
        let Slices { work, position, slot, row_of, .. } = &mut self.memory;
        let (mut index, names) = layout.crowd(work, scene.index);
        let row_of = |name: u32| {
            let row = *row_of.get(name as usize)?;
            (slot[..len].get(row as usize) == Some(&name)).then_some(row)
        };
        index.begin(scene.reach(), &mut self.status.is_indexed);
        index.follow(&position[..len], bytemuck::cast_slice(names), &row_of);
    }

    /// The same with those who were there before in an index, if anybody asks.
    #[cfg_attr(target_os = "none", inline(never))]
    fn emit(
        &mut self,
        scene: &Scene<'_>,
        near: Option<&dyn SpatialIndex>,
        [now, end]: [Time; 2],
        report: &mut Report,
        observer: &mut dyn Observer,
    ) {
        let (old, capacity, layout, backdrop) = (self.len(), self.capacity, &self.layout(scene), &scene.backdrop());
        let workspace = Workspace { memory: self.memory.slices(), capacity, status: &mut *self.status };
        scene.emitters.emit(
            now,
            end,
            &mut Births { workspace, layout, backdrop, report, observer, near, old, end, number: 0 },
        );
    }
}
