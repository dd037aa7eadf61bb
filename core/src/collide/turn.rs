//! Surfaces that curve turn what slides along them: from hit to hit that goes straight, along the plane that touches the surface, and is set off again.
//!
//! A smooth surface takes nothing from a velocity that it turns, and bears what slides where it is. What a hit takes from it, and what setting it off from the surface
//! gives it, comes of the straight way: the speed along the surface has both back.

use crate::math::{dot, max, scaled, sqrt};
use glam::Vec3;

/// How much deeper into a surface something comes at the most, on its way from hit to hit, where that is smooth \[slacks\]: twice as much as what lies on it may be off
/// it. Set off by two, it comes back by four, over one less its elasticity, which counts for no less than [`LOSS`].
pub(super) const SMOOTH: f32 = 16.0;
pub(super) const LOSS: f32 = 1.0 / 16.0;

/// How many times as large as what it has back the square of its speed is there at the least: far from the origin, where slacks are large, what comes
/// more steeply may as well fall onto a floor.
pub(super) const STEEP: f32 = 64.0;

/// The square of what a velocity may be turned by from a surface in rounding \[rad²\].
pub(super) const CURVED: f32 = (16.0 * f32::EPSILON) * (16.0 * f32::EPSILON);

/// A hit that may be one of such a chain.
pub(super) struct Turn {
    /// How far it sets something off \[m\].
    pub(super) raised: Vec3,
    /// How fast that came in, and goes out \[m/s\], and for how long it has been under way \[s\].
    pub(super) speeds: [f32; 2],
    pub(super) elapsed: f32,
    pub(super) elasticity: f32,
    /// Whether it stays on the surface.
    pub(super) rests: bool,
}

impl Turn {
    /// What the square of the speed along the surface has back under such an acceleration \[m²/s²\]. What bounces pays by its bounce for being raised.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn gain(&self, acceleration: Vec3) -> f32 {
        let [incoming, outgoing] = self.speeds;
        let raising = if self.rests { 2.0 * dot(acceleration, self.raised) } else { 0.0 };
        incoming * incoming - outgoing * outgoing + raising
    }

    /// Tells whether a surface of such a slack is smooth for it, and not a corner or a floor that it falls onto.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn is_smooth(&self, slack: f32) -> bool {
        (self.elapsed * self.speeds[0] * max(1.0 - self.elasticity, LOSS)).abs() <= SMOOTH * slack
    }
}

/// Tells whether a velocity before a hit leads to or from a surface with this normal by more than rounding, as that of what has slid along it does where it
/// curves; that of what has lain on a flat one does not.
#[cfg_attr(one_by_one, inline(never))]
pub(super) fn curves(velocity: Vec3, normal: Vec3) -> bool {
    let across = dot(velocity, normal);
    across * across > CURVED * dot(velocity, velocity)
}

/// The velocity along a surface with what the square of its speed has back: more where the surface is smooth, less where it rests and has been raised by more than it
/// has fallen.
#[cfg_attr(one_by_one, inline(never))]
pub(super) fn turned(slip: Vec3, gain: f32, rests: bool, is_smooth: bool) -> Vec3 {
    let square = dot(slip, slip);
    let turns = if gain > 0.0 { is_smooth && STEEP * gain <= square } else { rests };
    if !(square > 0.0 && turns) {
        return slip;
    }
    let left = square + gain;
    scaled(slip, if left > 0.0 { sqrt(left / square) } else { 0.0 })
}
