//! Create: emitters emit into the step.

use super::Workspace;
use crate::emit::Births;
use crate::index::SpatialIndex;
use crate::memory::{Layout, Slices, Storage};
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
        let capacity = self.capacity();
        let (layout, reach) = (Layout::of(scene.plan(), capacity), scene.emitters.reach());
        let (mut memory, status) = (self.memory.slices(), &mut *self.status);
        let mut emit = |memory: &mut Slices<'_>, near: Option<&dyn SpatialIndex>| {
            let workspace = Workspace { memory: memory.slices(), capacity, status: &mut *status };
            let (report, observer) = (&mut *report, &mut *observer);
            scene.emitters.emit(
                now,
                end,
                &mut Births { workspace, scene, report, observer, near, old, end, number: 0 },
            );
        };
        if reach > 0.0 {
            let (places, words) = layout.crowd(core::mem::take(&mut memory.work), old);
            places.copy_from_slice(&memory.position[..old]);
            scene.index.with_index(words, places, reach, scene.index.room(), &mut |near| emit(&mut memory, near));
        } else {
            emit(&mut memory, None);
        }
        old
    }
}
