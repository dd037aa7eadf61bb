//! Surfaces that curve turn what slides along them: from hit to hit that goes straight, along the plane that touches the surface, and is set off again.
//!
//! A smooth surface takes nothing from a velocity that it turns, and bears what slides where it is. What a hit takes from it, and what setting it off from the surface
//! gives it, comes of the straight way: the speed along the surface has both back. A flat surface turns nobody, and where two meet they do take what they turn.

use super::path::Path;
use super::sweep::{LAIN, Meeting, Sweep};
use crate::material::on_surface;
use crate::math::{along, dot, is_zero, length, max, minus, scaled, sqrt};
use crate::shape::{Collider, Contact, Hit};
use crate::time::Time;
use glam::Vec3;

/// How much deeper into a surface something comes at the most, on its way from hit to hit, where that is smooth \[slacks\]: twice as much as what lies on it may be off
/// it. Set off by two, it comes back by four, over one less its elasticity, which counts for no less than [`LOSS`].
pub(super) const SMOOTH: f32 = 16.0;
pub(super) const LOSS: f32 = 1.0 / 16.0;

/// The least ratio there of the square of its speed to that of its speed across the surface.
pub(super) const STEEP: f32 = 64.0;

/// The square of what a velocity may be turned by from a surface in rounding \[rad²\].
const CURVED: f32 = (16.0 * f32::EPSILON) * (16.0 * f32::EPSILON);

/// How a hit answers something: how far it sets it off \[m\], how fast that came in and goes out \[m/s\], and whether it stays on the surface.
pub(super) struct Answer {
    pub(super) raised: Vec3,
    pub(super) speeds: [f32; 2],
    pub(super) rests: bool,
}

impl Answer {
    /// The gain in the square of the speed along the surface under such an acceleration \[m²/s²\] where the hit is one of a chain. What bounces pays by its bounce for
    /// being raised; what slides into another surface pays, too: it would otherwise rise by as much in each step for nothing.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn gain(&self, acceleration: Vec3, is_turned: bool, slid: bool) -> f32 {
        let ([incoming, outgoing], raising) = (self.speeds, 2.0 * dot(acceleration, self.raised));
        let raising = if self.rests { raising } else { 0.0 };
        match () {
            () if is_turned => incoming * incoming - outgoing * outgoing + raising,
            () if slid && raising < 0.0 => raising,
            () => 0.0,
        }
    }
}

impl<C: Collider + ?Sized> Sweep<'_, C> {
    /// Tells whether a hit is one of a chain of them along one surface, which curves toward the path: that has begun on it, and not into it, and meets it where nothing
    /// else is.
    #[inline(never)]
    pub(super) fn is_turned(&self, path: &Path, meeting: &Meeting) -> bool {
        let Hit { normal, velocity, slack, material, .. } = meeting.hit;
        if self.left.is_some() || !leads_into(path.v0, normal) {
            return false;
        }
        let incoming = dot(minus(path.velocity(meeting.time), velocity), normal);
        let mixed = on_surface(self.obstacles.materials, self.elasticity, self.material, material);
        let loss = max(1.0 - mixed.elasticity, LOSS);
        let is_smooth = (path.duration() * meeting.time * incoming * loss).abs() <= SMOOTH * slack;
        if !is_smooth || STEEP * (incoming * incoming) > dot(path.v0, path.v0) {
            return false;
        }
        // A place on the surface may seem to lean on none.
        let (faces, _) = self.faces(meeting.place, slack, path.instant(meeting.time));
        let arc = Arc { velocity: path.v0, way: minus(meeting.place, path.x0), normal, loss };
        faces <= 1 && self.is_along(path, slack, &arc)
    }

    /// The velocity at the end of a way along a surface of such a slack, which leads on along that: next time nobody knows whether it has slid or come down.
    #[inline(never)]
    pub(super) fn turned_at_end(&self, path: &Path, slack: f32) -> Vec3 {
        let velocity = path.v1;
        if path.pull.is_none() || is_zero(velocity) {
            return velocity;
        }
        let Some(there) = self.lone(path.x1, slack, path.during[1]).filter(|there| is_zero(there.velocity)) else {
            return velocity;
        };
        let (across, square) = (dot(velocity, there.normal), dot(velocity, velocity));
        let arc = Arc { velocity, way: minus(path.x1, path.x0), normal: there.normal, loss: 1.0 };
        if STEEP * (across * across) > square || !self.is_along(path, slack, &arc) {
            return velocity;
        }
        let slip = along(velocity, there.normal, -across);
        scaled(slip, sqrt(square) / length(slip))
    }

    /// Tells whether the surface that a path begins on alone is the one that it meets or ends by: it does not begin into that, which turns until it does, by no more than
    /// an arc has room for over such a way.
    fn is_along(&self, path: &Path, slack: f32, arc: &Arc) -> bool {
        let Arc { velocity, way, normal, loss } = *arc;
        let Some(start) = self.lone(path.x0, slack, path.during[0]) else { return false };
        let [came, comes] = [&start.normal, &normal].map(|normal| dot(velocity, *normal));
        let room = 2.0 * (start.distance - self.radius) + LAIN * slack;
        // Within rounding of a surface it may seem to begin on its other side.
        leads_into(velocity, normal)
            && dot(start.normal, normal) > 0.0
            && came >= 0.25 * comes
            && length(way) * (came - comes) * loss <= room * length(velocity)
    }

    /// The surface that something at a place lies on, if that is one.
    fn lone(&self, place: Vec3, slack: f32, instant: Time) -> Option<Contact> {
        let (faces, seat) = self.faces(place, slack, instant);
        seat.filter(|_| faces == 1)
    }

    /// The number of surfaces that something at a place lies on, and one of them.
    pub(super) fn faces(&self, place: Vec3, slack: f32, instant: Time) -> (u32, Option<Contact>) {
        let (mut faces, mut seat) = (0, None);
        self.walls.contacts(place, self.radius + LAIN * slack, instant, &mut |contact| {
            faces += 1;
            seat = Some(*contact);
        });
        (faces, seat)
    }
}

/// A way along a surface: the velocity of who goes it, its normal where he comes, and how much less than that he bounces there.
struct Arc {
    velocity: Vec3,
    way: Vec3,
    normal: Vec3,
    loss: f32,
}

/// Tells whether a velocity leads into a surface with this normal by more than rounding.
#[cfg_attr(one_by_one, inline(never))]
fn leads_into(velocity: Vec3, normal: Vec3) -> bool {
    let across = dot(velocity, normal);
    across < 0.0 && across * across > CURVED * dot(velocity, velocity)
}

/// A velocity along a surface without what it has got along the drive since it was where it is sent back to, by such a way.
pub(super) fn sent_back(slip: Vec3, way: Vec3, drive: Vec3) -> Vec3 {
    let pull = length(drive);
    let (fast, gained) = (dot(slip, drive) / pull, -2.0 * dot(drive, way));
    if fast > 0.0 && gained > 0.0 {
        along(slip, drive, (sqrt(max(fast * fast - gained, 0.0)) - fast) / pull)
    } else {
        slip
    }
}

/// A velocity along a surface, of the square of whose speed so much is gained.
#[cfg_attr(one_by_one, inline(never))]
pub(super) fn gaining(slip: Vec3, gain: f32) -> Vec3 {
    let square = dot(slip, slip);
    let left = square + gain;
    if square > 0.0 { scaled(slip, if left > 0.0 { sqrt(left / square) } else { 0.0 }) } else { slip }
}
