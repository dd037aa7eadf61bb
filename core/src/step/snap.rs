//! Springs that are stretched too far break.

use super::View;
use crate::force::spring;
use crate::memory::{Slices, Storage};
use crate::report::Report;
use crate::scene::Scene;

impl View<'_> {
    /// Breaks the springs that are stretched too far, and says whether there is any that can break.
    pub(crate) fn snap(&mut self, scene: &Scene<'_>, report: &mut Report) -> bool {
        let mut can_break = false;
        for (number, spring) in scene.springs.list().iter().enumerate() {
            can_break |= spring.breaks_at.is_some();
            if spring.breaks_at.is_some() && spring.is_overstretched(number, &self.state(scene)) {
                let Slices { last_spring, incident, .. } = self.memory.slices();
                spring::mark_broken(number, spring, last_spring, incident);
                report.broken += 1;
            }
        }
        can_break
    }
}
