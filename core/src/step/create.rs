//! Create: emitters emit into the step.

use super::View;
use crate::emit::Births;
use crate::memory::Storage;
use crate::observe::Observer;
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

impl View<'_> {
    /// Lets the emitters emit, and returns how many particles there were before.
    pub(super) fn create(
        &mut self,
        scene: &Scene<'_>,
        end: Time,
        report: &mut Report,
        observer: &mut dyn Observer,
    ) -> usize {
        let (old, now) = (self.status.len, self.status.time);
        let view = View { memory: self.memory.slices(), status: self.status };
        scene.emitters.emit(now, end, &mut Births { view, report, observer, end, next: 0 });
        old
    }
}
