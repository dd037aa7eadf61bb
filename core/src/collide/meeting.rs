//! When two balls touch, and what that does to them.

use super::borne::Borne;
use super::path::{MAX_CHORDS, Path};
use super::slide::Slide;
use super::sweep::RESTING;
use crate::material::Mixed;
use crate::math::{clamp, high, length, low, max, sqrt, unit};
use crate::observe::Sliding;
use glam::Vec3;

/// The largest number of times that the instant of a touch is looked for on the path, as that of a hit.
const MAX_LOOKS: u32 = 16;

/// How far two that overlap may seem to come closer that do not \[slacks\].
const ROUNDING: f32 = 0.25;

/// The fraction of a path, of one ball as seen from the other, after which they come within `reach`, the sum of their
/// radii; and whether it is so curved that it would take more chords than there are.
///
/// Balls that overlap already meet at once if they come closer still. What stays within `slack` of a touch is none.
pub(super) fn first_touch(path: &Path, reach: f32, slack: f32) -> (Option<f32>, bool) {
    let hull = path.hull(0.0);
    // By the distance, not by a box: what an index has not found near is not near here either.
    let way = high(low(Vec3::ZERO, hull.max), hull.min);
    if !(length(way) <= reach) || !path.is_finite() {
        return (None, false);
    }
    let cubic = path.cubic();
    let chords = cubic.chords();
    let count = chords.min(MAX_CHORDS) as u8;
    let part = |whole: u8, part: f32| (f32::from(whole) + part) / f32::from(count);
    let touch = (0..count).find_map(|i| {
        let begun = part(i, 0.0);
        let piece = path.piece(&cubic, [begun, part(i + 1, 0.0)], 0.0);
        let parts = along_chord(piece.from, piece.step(), reach, [slack, slack / f32::from(count)])?;
        let [found, nearest] = parts.map(|share| part(i, share));
        Some(on_path(path, reach, [begun, found, nearest]))
    });
    (touch, chords > MAX_CHORDS)
}

/// The fractions of a chord at which it comes within reach and is nearest. `part` is what it may be wrong by of the slack, the more chords there are the less.
fn along_chord(offset: Vec3, step: Vec3, reach: f32, [slack, part]: [f32; 2]) -> Option<[f32; 2]> {
    let (square, closing) = (step.dot(step), -offset.dot(step));
    if !(closing > 0.0 && square > 0.0) {
        return None;
    }
    let nearest = clamp(closing / square, 0.0, 1.0);
    let gap = offset + step * nearest;
    if !(length(gap) < reach - slack) {
        return None;
    }
    if offset.dot(offset) <= reach * reach {
        // Those that walls hold in an overlap come no closer, but for rounding in their places.
        return (closing > ROUNDING * part * length(offset)).then_some([0.0, nearest]);
    }
    // From the point of nearest approach of the whole line back: no difference of large squares.
    let middle = closing / square;
    let closest = offset + step * middle;
    let half = sqrt(max(reach * reach - closest.dot(closest), 0.0) / square);
    Some([clamp(middle - half, 0.0, nearest), nearest])
}

/// When balls that a chord has found to touch do so on the path itself, before they are nearest. Balls that overlap and come
/// closer touch at once; those that part first touch when they have come back.
fn on_path(path: &Path, reach: f32, [begun, found, nearest]: [f32; 3]) -> f32 {
    let at = |s: f32| (path.at(s), path.velocity(s));
    let ((offset, velocity), (last, _)) = (at(begun), at(nearest));
    let parts = offset.dot(velocity) >= 0.0;
    let overlaps = offset.dot(offset) <= reach * reach;
    if (overlaps && !parts) || !(last.dot(last) < reach * reach) {
        return found;
    }
    let (mut low, mut high, mut s) = (begun, nearest, if parts { nearest } else { found });
    for _ in 0..MAX_LOOKS {
        let (offset, velocity) = at(s);
        let distance = length(offset);
        let (left, slope) = (distance - reach, offset.dot(velocity) * path.duration() / distance);
        if left > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s - left / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        let moved = (next - s).abs();
        s = next;
        if !(moved > f32::EPSILON * nearest) {
            break;
        }
    }
    s
}

/// Two balls that touch: from the second to the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) normal: Vec3,
    pub(super) velocity: [Vec3; 2],
    pub(super) acceleration: [Vec3; 2],
    /// The same for those who do not stay in touch: what bears one as it slides may be left by then.
    pub(super) free: [Vec3; 2],
    /// Zero for what is fixed; not both.
    pub(super) inverse_mass: [f32; 2],
    pub(super) mixed: Mixed,
    /// The error that rounding may make in their distance \[m\].
    pub(super) slack: f32,
    /// What bears each.
    pub(super) borne: [Borne; 2],
}

impl Touch {
    /// Along the line of centres `offset`; of balls in one place, against their motion.
    pub(super) fn along(offset: Vec3, velocity: [Vec3; 2]) -> Vec3 {
        let normal = unit(offset);
        if normal == Vec3::ZERO { -unit(velocity[0] - velocity[1]) } else { normal }
    }

    /// The answer of both: the impulse turns the approach round and scales it by the elasticity, and brakes the slip by
    /// Coulomb's law, as if the balls could not spin. Balls that would bounce for less than a part of the step stay in
    /// touch for the `rest` of it: they press on as one, and slide along or stay like what rests on a surface.
    ///
    /// Both get the same impulse, so that momentum is what it was, but for the rounding of two sums.
    pub(super) fn answer(&self, dt: f32, rest: f32) -> Answer {
        let on_walls = if self.borne == [Borne::NOT; 2] { None } else { self.answer_on_walls(dt, rest) };
        on_walls.unwrap_or_else(|| self.answer_alone(dt, rest))
    }

    /// The answer of two that nothing bears.
    fn answer_alone(&self, dt: f32, rest: f32) -> Answer {
        let (n, [a, b], [wa, wb]) = (self.normal, self.velocity, self.inverse_mass);
        let relative = a - b;
        let incoming = relative.dot(n);
        let acceleration = self.acceleration[0] - self.acceleration[1];
        let pressing = -acceleration.dot(n);
        let outgoing = if incoming < 0.0 { -incoming * self.mixed.elasticity } else { incoming };
        let rests = pressing > 0.0 && 2.0 * outgoing < RESTING * dt * pressing;
        let outgoing = if rests { 0.0 } else { outgoing };
        let friction = self.mixed.friction;
        let came = relative - n * incoming;
        let braked = friction.answer(came, outgoing - incoming);
        let change = n * (outgoing - incoming) + braked;
        // Each gets its share of what happens between them.
        let share = |between: Vec3| [between * (wa / (wa + wb)), between * (-wb / (wa + wb))];
        let [da, db] = share(change);
        let velocity = [a + da, b + db];
        if !rests {
            let way = [0, 1].map(|i| (velocity[i] + self.free[i] * (0.5 * rest)) * rest);
            let ends = [0, 1].map(|i| velocity[i] + self.free[i] * rest);
            return Answer { velocity, way, ends, slid: None };
        }
        let slip = came + braked;
        let drive = acceleration + n * pressing;
        let (mut way, end) = Slide { velocity: slip, drive, pressing, friction }.after(rest);
        // A ball that falls through the rounding of a touch goes along it meanwhile, which friction would have kept it
        // from.
        let fell = -incoming / pressing;
        let stays = slip == Vec3::ZERO && end == Vec3::ZERO;
        if stays && incoming < 0.0 && -incoming * fell < 16.0 * self.slack {
            way -= came * (0.5 * fell);
        }
        let middle = |of: [Vec3; 2]| of[0] * (wb / (wa + wb)) + of[1] * (wa / (wa + wb));
        let (steady, pull) = (middle(velocity), middle(self.acceleration));
        let common = (steady + pull * (0.5 * rest)) * rest;
        let along = [drive, way, slip, end];
        let slid = Some(Sliding { mass: 1.0 / (wa + wb), raised: Vec3::ZERO, world: along, along });
        let (ways, ends) = (share(way), share(end));
        let way = ways.map(|way| common + way);
        Answer { velocity, way, ends: ends.map(|end| steady + pull * rest + end), slid }
    }
}

/// The motion of two balls once they have touched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer {
    /// Their velocities right after it \[m/s\].
    pub(super) velocity: [Vec3; 2],
    /// How far they go in the rest of the step \[m\], and their velocities at its end.
    pub(super) way: [Vec3; 2],
    pub(super) ends: [Vec3; 2],
    /// How they slide along each other, if they stay in touch.
    pub(super) slid: Option<Sliding>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::Friction;
    use crate::time::Time;

    fn head_on(elasticity: f32, inverse_mass: [f32; 2]) -> Touch {
        let mixed = Mixed { elasticity, friction: Friction::NONE };
        let velocity = [Vec3::new(-3.0, 1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)];
        let still = [Vec3::ZERO; 2];
        Touch {
            normal: Vec3::X,
            velocity,
            acceleration: still,
            free: still,
            inverse_mass,
            mixed,
            slack: 1e-6,
            borne: [Borne::NOT; 2],
        }
    }

    #[test]
    fn equal_balls_swap_what_is_along_the_line_of_centres() {
        let after = head_on(1.0, [0.5, 0.5]).answer(0.1, 0.1).velocity;
        assert_eq!(after, [Vec3::new(1.0, 1.0, 0.0), Vec3::new(-3.0, 0.0, 0.0)]);
        let after = head_on(0.0, [0.5, 0.5]).answer(0.1, 0.1).velocity;
        assert_eq!(after, [Vec3::new(-1.0, 1.0, 0.0), Vec3::new(-1.0, 0.0, 0.0)]);
    }

    #[test]
    fn what_is_fixed_stays() {
        let after = head_on(1.0, [1.0, 0.0]).answer(0.1, 0.1).velocity;
        assert_eq!(after, [Vec3::new(5.0, 1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)]);
    }

    #[test]
    fn what_is_pressed_together_stays_together() {
        let touch = Touch {
            velocity: [Vec3::X * -1e-3, Vec3::ZERO],
            acceleration: [Vec3::X * -10.0, Vec3::ZERO],
            ..head_on(0.5, [1.0, 1.0])
        };
        let Answer { velocity, way, ends, .. } = touch.answer(0.1, 0.1);
        assert_eq!((velocity[0], way[0], ends[0]), (velocity[1], way[1], ends[1]));
        assert!((ends[0] - velocity[0] - Vec3::X * -0.5).length() < 1e-6);
    }

    #[test]
    fn touches_are_found_when_they_happen() {
        let during = [Time::ZERO, Time::from_seconds(1.0)];
        let way = |x0: Vec3, v: Vec3| Path { x0, v0: v, x1: x0 + v, v1: v, during, pull: None };
        let (at, _) = first_touch(&way(Vec3::X * 5.0, Vec3::X * -4.0), 2.0, 1e-6);
        assert!((at.expect("they meet") - 0.75).abs() < 1e-6);
        assert_eq!(first_touch(&way(Vec3::X * 5.0, Vec3::X * -2.0), 2.0, 1e-6).0, None);
        assert_eq!(first_touch(&way(Vec3::X * 5.0, Vec3::X * -1e4), 2.0, 1e-6).0.map(|at| at > 0.0), Some(true));
        assert_eq!(first_touch(&way(Vec3::X * 1.9, Vec3::X), 2.0, 1e-6).0, None);
        assert_eq!(first_touch(&way(Vec3::X * 1.9, -Vec3::X), 2.0, 1e-6).0, Some(0.0));
        assert_eq!(first_touch(&way(Vec3::new(5.0, 2.0, 0.0), Vec3::X * -9.0), 2.0, 1e-6).0, None);
    }
}
