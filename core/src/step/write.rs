//! Columns of a user's own, changed once in each step: by forces, then by whoever looks on.

use super::Workspace;
use super::field::Field;
use crate::custom::CustomColumnsMut;
use crate::memory::Layout;
use crate::observe::Observer;
use crate::report::{Effort, Report};
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Lets forces write, at a step's end.
    #[inline(never)]
    pub(super) fn write(&mut self, scene: &Scene<'_>, [now, dt]: [Time; 2], report: &mut Report) {
        let (len, capacity) = (self.len(), self.capacity());
        let layout = Layout::of(scene.plan(), capacity);
        let kept = core::mem::take(&mut self.memory.kept);
        let mut custom = CustomColumnsMut::new(scene.custom, layout.kept(kept).0, capacity, len);
        let tile = self.tile(scene, [now, dt], len, 0..len, capacity);
        let mut scratch = layout.shares(tile.work).scratch;
        let ([tree, near], _) = scratch.moving();
        let (attributes, needs, observer) = (&tile.attributes, scene.forces.needs(), &mut ());
        let seen = attributes.lives.custom;
        let mut field = Field {
            scene,
            attributes,
            custom: seen,
            needs,
            tree,
            near,
            lists: None,
            first: 0,
            effort: Effort::NONE,
            observer,
        };
        field.with_state(now + dt, tile.position, tile.velocity, &mut |state| {
            scene.forces.write(state, &mut custom, dt.seconds());
        });
        report.effort.found(&field.effort);
        self.memory.kept = kept;
    }

    /// Lets whoever looks on write.
    #[inline(never)]
    pub(super) fn let_write(&mut self, scene: &Scene<'_>, observer: &mut dyn Observer) {
        let (len, capacity) = (self.len(), self.capacity());
        let kept = core::mem::take(&mut self.memory.kept);
        let values = Layout::of(scene.plan(), capacity).kept(kept).0;
        observer.write(&self.state(scene), &mut CustomColumnsMut::new(scene.custom, values, capacity, len));
        self.memory.kept = kept;
    }
}
