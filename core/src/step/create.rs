//! Create: emitters emit into the step.

use crate::emit::Births;
use crate::index::SpatialIndex;
use crate::memory::{Storage, Workspace};
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
        if reach > 0.0 {
            let work = core::mem::take(&mut self.memory.work);
            let (places, words) = self.layout(scene).crowd(work, old);
            places.copy_from_slice(&self.memory.position[..old]);
            scene.index.with_index(words, places, reach, scene.index.room(), &mut |near| {
                self.emit(scene, near, [now, end], report, observer);
            });
            self.memory.work = work;
        } else {
            self.emit(scene, None, [now, end], report, observer);
        }
        old
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
