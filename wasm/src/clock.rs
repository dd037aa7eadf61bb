//! Time as a page has it, in frames that last as they may, cut into whole steps.

use pointmass::Time;

/// Cuts time that goes by into whole steps, which end at multiples of their length as those of the command line do: each end is rounded to
/// the tick by itself, so that nothing drifts and no run depends on how long frames last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// The length of a step \[s\].
    pub(crate) dt: f64,
    /// The steps that have been made.
    steps: u64,
    /// The time that no step has been made of yet \[s\].
    left: f64,
}

/// A remainder of this part of a step is rounding, not time: the command line takes it so too.
const ROUNDING: f64 = 1e-6;

/// Time that is caught up with in one frame, where nothing is said \[s\].
const CAUGHT_UP: f64 = 0.1;

impl Clock {
    /// At the beginning, for steps of `dt` \[s\].
    pub(crate) fn new(dt: f64) -> Self {
        Self { dt, steps: 0, left: 0.0 }
    }

    /// The steps that one frame may have where nothing is said: as many as a tenth of a second takes, and no fewer than eight.
    pub(crate) fn usual(&self) -> u32 {
        // The cast saturates.
        ((CAUGHT_UP / self.dt).ceil() as u32).max(8)
    }

    /// Takes in time that has gone by \[s\], finite and not below zero; returns how many steps are due, `most` at the most. What is beyond
    /// them is dropped.
    pub(crate) fn take(&mut self, elapsed: f64, most: u32) -> u32 {
        let due = self.left + elapsed;
        let rest = due % self.dt;
        self.left = if rest >= self.dt * (1.0 - ROUNDING) { rest - self.dt } else { rest };
        // The cast saturates.
        (((due - self.left) / self.dt).round() as u32).min(most)
    }

    /// When the step ends that comes after `now` \[s\].
    pub(crate) fn next(&mut self, now: Time) -> f64 {
        // Somebody may have stepped to elsewhere in the meantime.
        if self.end(self.steps) != now {
            self.steps = (now.seconds_f64() / self.dt) as u64;
            // The division may have been rounded past the next whole number.
            if self.end(self.steps) > now {
                self.steps -= 1;
            } else if self.end(self.steps + 1) <= now {
                self.steps += 1;
            }
        }
        self.steps += 1;
        self.steps as f64 * self.dt
    }

    /// The share of the next step that has gone by, from 0 to 1.
    pub(crate) fn share(&self) -> f64 {
        (self.left / self.dt).clamp(0.0, 1.0)
    }

    /// When a step ends, by its number from 1.
    fn end(&self, step: u64) -> Time {
        Time::from_seconds_f64(step as f64 * self.dt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_any_lengths_that_sum_up_alike_make_the_same_steps() {
        for (frame, frames) in
            [(1.0, 1), (0.1, 10), (1.0 / 60.0, 60), (1.0 / 144.0, 144), (0.001, 1000), (1.0 / 7.0, 7)]
        {
            for dt in [1.0 / 60.0, 0.01, 0.001, 1.0 / 24.0, 0.25] {
                let mut clock = Clock::new(dt);
                let steps: u32 = (0..frames).map(|_| clock.take(frame, u32::MAX)).sum();
                assert_eq!(f64::from(steps), (1.0 / dt).round(), "{frames} times {frame} in {dt}");
                assert!(clock.share() < 1e-5, "{}", clock.share());
            }
        }
    }

    #[test]
    fn what_is_beyond_the_most_is_dropped() {
        let mut clock = Clock::new(0.25);
        assert_eq!((clock.take(100.125, 8), clock.share()), (8, 0.5));
        assert_eq!((clock.take(0.0625, 8), clock.share()), (0, 0.75));
        assert_eq!((clock.take(f64::MAX, 8), clock.take(f64::MAX, 9)), (8, 9));
        assert!((0.0..=1.0).contains(&clock.share()));
        assert_eq!([0.25, 0.01, 0.001].map(|dt| Clock::new(dt).usual()), [8, 10, 100]);
    }

    #[test]
    fn steps_end_at_multiples_wherever_one_is() {
        let mut clock = Clock::new(0.1);
        assert_eq!(clock.next(Time::ZERO), 0.1);
        assert_eq!(clock.next(Time::from_seconds_f64(0.1)), 2.0 * 0.1);
        assert_eq!(clock.next(Time::from_seconds_f64(7.0 * 0.1)), 8.0 * 0.1);
        assert_eq!(clock.next(Time::from_seconds_f64(0.95)), 10.0 * 0.1);
        assert_eq!(clock.next(Time::ZERO), 0.1);
        for step in 0..10_000_u32 {
            assert_eq!(Clock::new(0.1).next(Time::from_seconds_f64(f64::from(step) * 0.1)), f64::from(step + 1) * 0.1);
        }
        Clock::new(1e-9).next(Time::from_ticks(u64::MAX - 7));
    }
}
