//! Straight paths heed what constraints have done to a row.

use super::path::Path;
use crate::constrain::{CARRIED, SHIFTED, TOUCHING};
use crate::math::{along, scaled};
use crate::shape::Collider;

/// The function that heeds what constraints have done to a row: a program without constraints does not carry it about.
#[derive(Clone, Copy)]
pub(crate) struct MarkCode(pub(super) Heed);

type Heed = for<'w> fn(u32, &mut Path, &'w dyn Collider, f32) -> (&'w dyn Collider, f32);

impl MarkCode {
    pub(crate) const ALL: Self = Self(heed);
}

/// The scenery that a row marked so may meet, and the radius of the ball that it is then; what the marks do is to be read at `TileSweep::follow_from`.
fn heed<'w>(mark: u32, path: &mut Path, walls: &'w dyn Collider, radius: f32) -> (&'w dyn Collider, f32) {
    // It comes in the end to the velocity that constraints leave it, and on the mean to where they have put it.
    if mark & SHIFTED != 0 {
        path.v0 = along(scaled(path.straightened().v0, 2.0), path.v1, -1.0);
    }
    (if mark & CARRIED != 0 { &() } else { walls }, if mark & TOUCHING != 0 { 0.5 * radius } else { radius })
}
