//! Deletion: by age, at sinks, and of what is no longer a number.

use crate::force::Spring;
use crate::memory::Slices;
use crate::observe::{Observer, Passing};
use crate::particles::Id;
use crate::report::Report;
use crate::step::View;
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

/// Why a particle died.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Cause {
    /// Of age.
    Lifetime,
    /// It touched a sink.
    Sink,
    /// A number of its was no longer finite.
    Nonfinite,
}

/// Removes what the step has ended: rows that are not finite, that touched a sink, or whose time has come by `now`.
pub(crate) fn retire(
    view: &mut View<'_>,
    springs: &[Spring],
    now: Time,
    report: &mut Report,
    observer: &mut dyn Observer,
) {
    // From the back, so that the row that fills a gap has been looked at already.
    let mut end = view.len();
    while let Some(row) = last_doomed(&view.memory, end, now) {
        let m = &view.memory;
        let (cause, counter) = if !(m.position[row].is_finite() && m.velocity[row].is_finite()) {
            (Cause::Nonfinite, &mut report.died.nonfinite)
        } else if m.fate[row] == Fate::Sink {
            (Cause::Sink, &mut report.died.sink)
        } else {
            (Cause::Lifetime, &mut report.died.lifetime)
        };
        *counter += 1;
        let id = Id { slot: m.slot[row], serial: m.serial[row] };
        observer.died(&Passing { id, place: m.position[row], velocity: m.velocity[row], time: now }, cause);
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
