//! When the steps of a run end.

use pointmass::Time;

/// A run cut into steps: whole ones of `dt`, and one shorter last step if the duration leaves a remainder.
///
/// Ends are rounded to the tick one by one, so that a long run does not drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Schedule {
    dt: f64,
    duration: f64,
    steps: u64,
}

/// A remainder of this part of a step is rounding, not time.
const ROUNDING: f64 = 1e-6;

impl Schedule {
    /// `duration` seconds in steps of `dt`.
    pub(crate) fn new(duration: f64, dt: f64) -> Self {
        let ratio = duration / dt;
        let whole = if (ratio - ratio.round()).abs() <= ROUNDING { ratio.round() } else { ratio.floor() };
        let rest = ratio - whole > ROUNDING;
        Self { dt, duration, steps: whole as u64 + u64::from(rest) }
    }

    /// `steps` whole steps of `dt`.
    pub(crate) fn steps_of(steps: u64, dt: f64) -> Self {
        Self { dt, duration: steps as f64 * dt, steps }
    }

    /// How many steps there are.
    pub(crate) fn steps(&self) -> u64 {
        self.steps
    }

    /// How long the last step is \[s\].
    pub(crate) fn last(&self) -> f64 {
        self.duration - self.steps.saturating_sub(1) as f64 * self.dt
    }

    /// When step `n` ends, from 1.
    pub(crate) fn end(&self, n: u64) -> Time {
        let seconds = if n >= self.steps { self.duration } else { n as f64 * self.dt };
        Time::from_seconds_f64(seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remainder_is_one_shorter_last_step() {
        for (duration, dt, steps) in [
            (10.0, 0.001, 10_000),
            (10.0, 1.0 / 60.0, 600),
            (2.93425, 0.001, 2935),
            (1.0, 0.3, 4),
            (0.9, 0.3, 3),
            (0.0, 0.1, 0),
            (0.05, 0.1, 1),
            (0.6 + 1e-9, 0.1, 6),
            (0.6 - 1e-9, 0.1, 6),
            (1e-9, 1.0, 0),
        ] {
            let schedule = Schedule::new(duration, dt);
            assert_eq!(schedule.steps(), steps, "{duration} in {dt}");
            let last = duration - (steps.max(1) - 1) as f64 * dt;
            assert!((schedule.last() - last).abs() < 1e-12 && last < dt + 1e-8, "{duration} in {dt}");
            let ends: Vec<_> = (0..=steps).map(|n| schedule.end(n)).collect();
            assert!(ends.windows(2).all(|e| e[0] < e[1]), "{duration} in {dt}");
            assert_eq!(ends.last(), Some(&Time::from_seconds_f64(duration)), "{duration} in {dt}");
        }
    }
}
