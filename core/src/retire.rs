//! Deletion: by age, at sinks, and of what is no longer a number.

use crate::force::Spring;
use crate::report::Report;
use crate::storage::Slices;
use crate::time::Time;
use crate::view::View;

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
    let mut end = view.len();
    while let Some(row) = last_doomed(&view.memory, end, now) {
        let m = &view.memory;
        let cause = if !(m.position[row].is_finite() && m.velocity[row].is_finite()) {
            &mut report.died.nonfinite
        } else if m.fate[row] == Fate::Sink {
            &mut report.died.sink
        } else {
            &mut report.died.lifetime
        };
        *cause += 1;
        view.remove(row, springs, report);
        end = row;
    }
}

/// The last row before `end` that has to go.
fn last_doomed(m: &Slices<'_>, end: usize, now: Time) -> Option<usize> {
    let moving = m.position[..end].iter().zip(&m.velocity[..end]);
    let ending = m.dies[..end].iter().zip(&m.fate[..end]);
    moving.zip(ending).rposition(|((x, v), (&dies, &fate))| {
        // Zero times anything finite is zero, and NaN otherwise.
        let probe = *x * 0.0 + *v * 0.0;
        (dies <= now && dies != Time::NEVER) || fate != Fate::Lives || !(probe.x + probe.y + probe.z == 0.0)
    })
}
