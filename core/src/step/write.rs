//! Columns of a user's own, changed once in each step: by forces, then by whoever looks on.

use crate::collide::Tile;
use crate::custom::CustomColumnsMut;
use crate::force::{State, Written};
use crate::memory::{Layout, Workspace};
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Lets forces write, at a step's end.
    #[inline(never)]
    pub(super) fn let_forces_write(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        [now, dt]: [Time; 2],
        report: &mut Report,
    ) {
        let Some(code) = scene.forces.needs().write else { return };
        let (len, kept) = (self.len(), core::mem::take(&mut self.memory.kept));
        let Tile { attributes, position, velocity, work, .. } = self.tile(scene, layout, [now, dt], len);
        let (ends, end, effort, index) = ([&*position, &*velocity], now + dt, &mut report.effort, scene.index);
        let (needs, attributes, kept_of) = (scene.forces.needs(), &attributes, &mut *kept);
        let write = &mut |state: &State<'_>, custom: &mut CustomColumnsMut<'_>| {
            scene.forces.write(state, custom, dt.seconds());
        };
        (code.0)(Written { needs, attributes, index, ends, kept: kept_of, work, layout, end, effort, write });
        self.memory.kept = kept;
    }

    /// Lets whoever looks on write.
    #[inline(never)]
    pub(super) fn let_write(&mut self, scene: &Scene<'_>, layout: &Layout, observer: &mut dyn Observer) {
        let (len, capacity) = (self.len(), self.capacity());
        let kept = core::mem::take(&mut self.memory.kept);
        let values = layout.kept(kept).0;
        observer.write(&self.state(scene), &mut CustomColumnsMut::new(scene.custom, values, capacity, len));
        self.memory.kept = kept;
    }
}
