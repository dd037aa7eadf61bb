//! How fast strains change between the solutions of what resists them.

use crate::math::{length, min};
use glam::Vec3;

/// The way by which others may move a point after it has been solved for that to be left out of its rate, as a share of the edges there: directions that
/// others turn by more say nothing of those to come, and damping would drive what is heavy to and fro along them.
const LITTLE: f32 = 1.0 / 8.0;

/// Where a point was from which its way since counts as motion that damping brakes: where its own solution had `left` it. What others have moved it by, to where
/// it was as the sub-step `begun`, a solution takes back: that is no motion. Of ways that are not small against the `edge` \[m\] less is left out, and in
/// the end nothing, nor where nothing had been left.
pub(super) fn braked_from(begun: Vec3, left: Vec3, edge: f32) -> Vec3 {
    let others = begun - left;
    let share = 2.0 - length(others) / (LITTLE * edge);
    if share > 0.0 { begun - others * min(share, 1.0) } else { begun }
}
