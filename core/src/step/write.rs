//! Columns of a user's own, changed once in each step: by forces, then by whoever looks on.

use crate::collide::Tile;
use crate::custom::CustomColumnsMut;
use crate::force::{Writing, Written};
use crate::memory::Workspace;
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Lets forces write, at a step's end.
    #[inline(never)]
    pub(super) fn write(&mut self, code: Writing, scene: &Scene<'_>, [now, dt]: [Time; 2], report: &mut Report) {
        let (len, capacity) = (self.len(), self.capacity());
        let kept = core::mem::take(&mut self.memory.kept);
        let Tile { attributes, position, velocity, work, layout, .. } =
            self.tile(scene, [now, dt], len, 0..len, capacity);
        let (ends, end, dt, effort) = ([&*position, &*velocity], now + dt, dt.seconds(), &mut report.effort);
        let (forces, index, attributes) = (scene.forces, scene.index, &attributes);
        (code.0)(Written { forces, attributes, index, ends, kept: &mut *kept, work, layout, end, dt, effort });
        self.memory.kept = kept;
    }

    /// Lets whoever looks on write.
    #[inline(never)]
    pub(super) fn let_write(&mut self, scene: &Scene<'_>, observer: &mut dyn Observer) {
        let (len, capacity) = (self.len(), self.capacity());
        let kept = core::mem::take(&mut self.memory.kept);
        let values = self.layout(scene).kept(kept).0;
        observer.write(&self.state(scene), &mut CustomColumnsMut::new(scene.custom, values, capacity, len));
        self.memory.kept = kept;
    }
}
