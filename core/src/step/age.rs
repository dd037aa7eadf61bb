//! Age: materials change drags and masses over the lives of particles.

use crate::memory::{Layout, Workspace};
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Gives all what they have in the middle of a step, of which the newborn see a part.
    #[inline(never)]
    pub(super) fn age(&mut self, scene: &Scene<'_>, layout: &Layout, [now, dt]: [Time; 2]) {
        let Some(code) = scene.materials.code().filter(|code| (code.kept)(scene.materials) > 0) else { return };
        self.status.common.vary_inertias();
        (code.age)(scene.materials, [now, now + dt], self.len(), layout, self.memory);
    }
}
