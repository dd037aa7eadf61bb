//! Death where too many are.

use super::{Cause, Reaper, Verdicts};
use crate::force::State;
use crate::rng::threefry;
use core::ops::Range;

/// Death in a crowd: at a step's end a particle with n others within `radius` dies with chance (n − most) / (n + 1), so that of a
/// cluster of n + 1 that are all near each other `most` + 1 are left on average.
///
/// All are judged by who is there at the step's end: who has died of age, at a sink or of numbers that are none does not count
/// any more, and the newborn do. The draws are the particle's own and another one in every step, so the shorter the steps, the
/// sooner a crowd has thinned out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Dense {
    /// How far others are counted \[m\].
    pub radius: f32,
    /// So many may be there.
    pub most: u32,
}

impl Reaper for Dense {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let place = verdicts.claim();
        let ticks = state.time.ticks();
        for (nth, row) in rows.enumerate() {
            let others = state.count_within(state.position[row], self.radius).saturating_sub(1);
            let surplus = others.saturating_sub(u64::from(self.most));
            if surplus == 0 {
                continue;
            }
            let word = threefry([state.key[row], place], [ticks as u32, (ticks >> 32) as u32])[0];
            // In whole numbers: word / 2³² < surplus / (others + 1).
            if u64::from(word).saturating_mul(others + 1) < surplus << 32 {
                verdicts.end(nth, Cause::Density);
            }
        }
    }

    fn reach(&self) -> f32 {
        self.radius
    }

    fn is_empty(&self) -> bool {
        !(self.radius >= 0.0)
    }
}
