//! Deletion: by age, at sinks, and of what is no longer a number.

use crate::force::Spring;
use crate::report::Report;
use crate::system::View;
use crate::time::Time;

/// Why a particle will be removed at the end of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fate {
    /// It will not.
    #[default]
    Lives,
    /// It touched a sink.
    Sink,
}

/// Removes what the step has ended: rows that are not finite, that touched a sink, or whose time has come by `now`.
pub(crate) fn retire(view: &mut View<'_>, springs: &[Spring], now: Time, report: &mut Report) {
    // From the back, so that the row that fills a gap has been looked at already.
    for row in (0..view.len()).rev() {
        let m = &view.memory;
        let cause = if !(m.position[row].is_finite() && m.velocity[row].is_finite()) {
            &mut report.died.nonfinite
        } else if m.fate[row] == Fate::Sink {
            &mut report.died.sink
        } else if m.dies[row] <= now {
            &mut report.died.lifetime
        } else {
            continue;
        };
        *cause += 1;
        view.remove(row, springs, report);
    }
}
