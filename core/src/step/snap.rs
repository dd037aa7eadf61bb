//! Springs that are stretched too far break.

use crate::force::SpringCode;
use crate::memory::Workspace;
use crate::report::Report;
use crate::scene::Scene;

impl Workspace<'_> {
    /// Breaks the springs that are stretched too far, and says whether there is any that can break.
    #[inline(never)]
    pub(super) fn snap(&mut self, scene: &Scene<'_>, code: SpringCode, report: &mut Report) -> bool {
        let incident = core::mem::take(&mut self.memory.incident);
        let broken = (code.snap)(&self.state(scene), incident);
        self.memory.incident = incident;
        report.broken += broken.unwrap_or(0);
        broken.is_some()
    }
}
