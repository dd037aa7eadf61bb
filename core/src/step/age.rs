//! Age: materials change drags and masses over the lives of particles.

use crate::memory::{Layout, Workspace};
use crate::observe::{Observer, Phase};
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Gives all what they have in the middle of a step, of which the newborn see a part, or at an instant. Tells whether anybody ages.
    #[inline(never)]
    pub(super) fn age(&mut self, scene: &Scene<'_>, layout: &Layout, [now, dt]: [Time; 2]) -> bool {
        let code = scene.materials.code().filter(|code| (code.kept)(scene.materials) > 0);
        if let Some(code) = code {
            self.status.common.vary_inertias();
            (code.age)(scene.materials, [now, now + dt], self.len(), layout, self.memory);
        }
        code.is_some()
    }

    /// Gives all what they have now, at the end of a step: what is read, recorded and booked is of the instant that it is said to be of.
    pub(super) fn come_of_age(&mut self, scene: &Scene<'_>, layout: &Layout, observer: &mut dyn Observer) {
        if self.age(scene, layout, [self.status.time, Time::ZERO]) {
            self.tell(Phase::Age, scene, observer);
        }
    }
}
