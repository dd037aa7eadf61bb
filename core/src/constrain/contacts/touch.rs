//! Two that touch in a sub-step: what presses them, and Coulomb's friction by just that.

use super::super::Substep;
use crate::collide::RESTING;
use crate::force::Friction;
use crate::material::Mixed;
use crate::math::{length, max, min, sqrt};
use glam::Vec3;

/// The effect that two in touch have on each other in a sub-step.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(in crate::constrain) struct Touch {
    /// By how much the contact has changed the speed at which they part \[m/s\]; below zero: they do not touch.
    pressed: f32,
    /// How much slip friction has taken \[m/s\].
    held: f32,
    /// How much more of what weighs on the upper one goes through here than has changed that speed \[m/s\].
    carried: f32,
    pub(in crate::constrain) elasticity: f32,
    static_: f32,
    kinetic: f32,
}

impl Touch {
    pub(in crate::constrain) fn new(Mixed { elasticity, friction: Friction { static_, kinetic } }: Mixed) -> Self {
        Self { pressed: -1.0, held: 0.0, carried: 0.0, elasticity, static_, kinetic }
    }

    /// Tells whether the two touch in this sub-step.
    pub(in crate::constrain) fn is_on(&self) -> bool {
        self.pressed >= 0.0
    }

    /// By how much the contact has changed the speed at which they part \[m/s\].
    pub(in crate::constrain) fn pressed(&self) -> f32 {
        self.pressed
    }

    /// Tells whether friction can hold it in its place.
    pub(in crate::constrain) fn sticks(&self) -> bool {
        self.static_ > 0.0
    }

    /// The coefficients of what rests and of what slides.
    pub(in crate::constrain) fn friction(&self) -> [f32; 2] {
        [self.static_, self.kinetic]
    }

    pub(in crate::constrain) fn has_friction(&self) -> bool {
        self.static_ + self.kinetic > 0.0
    }

    /// Tells whether the two touch in this sub-step, and not smoothly.
    pub(super) fn rubs(&self) -> bool {
        self.is_on() && self.has_friction()
    }

    pub(in crate::constrain) fn end(&mut self) {
        self.pressed = -1.0;
    }

    /// They touch, and have been given this speed apart.
    pub(in crate::constrain) fn begin(&mut self, pressed: f32) {
        (self.pressed, self.held, self.carried) = (pressed, 0.0, 0.0);
    }

    /// Friction counts in this many times what presses, besides that itself.
    pub(super) fn carry(&mut self, times: f32) {
        self.carried = times * self.pressed;
    }

    /// By how much it presses with all that weighs on it \[m/s\].
    pub(super) fn load(&self) -> f32 {
        self.pressed + self.carried
    }

    /// How the speed at which they part has to change to be `wanted`. It takes back no more than the contact has given, so
    /// that it never pulls.
    pub(in crate::constrain) fn press(&mut self, wanted: f32, parting: f32) -> f32 {
        let change = max(wanted - parting, -self.pressed);
        self.pressed += change;
        change
    }

    /// A bounce has changed the speed at which they part by so much more.
    pub(super) fn give(&mut self, more: f32) {
        self.pressed += more;
    }

    /// How fast two have come together that bounces have `given` so much \[m/s\]: that and the elasticity's share of it.
    pub(super) fn thrown(&self, given: f32) -> f32 {
        given / (1.0 + self.elasticity)
    }

    /// How the speed at which they part has to change for them not to come together. What bounces have `given` of it stays.
    pub(super) fn part(&mut self, given: f32, parting: f32) -> f32 {
        let change = max(-parting, given - self.pressed);
        self.pressed += change;
        change
    }

    /// The part of a slip that friction takes \[m/s\]: all that it can by what presses, which counts `weight` times.
    pub(super) fn hold(&mut self, slip: Vec3, weight: f32) -> Vec3 {
        let speed = length(slip);
        let left = |share: f32| max(share * self.load() * weight - self.held, 0.0);
        let taken = if speed <= left(self.static_) { speed } else { min(speed, left(self.kinetic)) };
        if !(taken > 0.0) {
            return Vec3::ZERO;
        }
        self.held += taken;
        if taken < speed { slip * (-taken / speed) } else { -slip }
    }
}

/// The part of a slip that friction has taken, with its direction, of two in touch.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(in crate::constrain) struct TangentImpulse(Vec3);

impl TangentImpulse {
    /// One by which friction has given so much already \[m/s\].
    pub(in crate::constrain) fn of(given: Vec3) -> Self {
        Self(given)
    }

    /// Adds to what friction has given \[m/s\].
    pub(in crate::constrain) fn give(&mut self, more: Vec3) {
        if more.is_finite() {
            self.0 += more;
        }
    }

    /// Tells whether friction has something to take, or to give back.
    pub(in crate::constrain) fn acts(&self, touch: &Touch) -> bool {
        touch.has_friction() && (touch.pressed > 0.0 || self.0 != Vec3::ZERO)
    }

    /// The change of a slip that friction makes by what presses now \[m/s\]. What it has taken before counts, and what of that was too
    /// much for what presses now it gives back.
    pub(in crate::constrain) fn hold(&mut self, touch: &Touch, slip: Vec3, load: f32) -> Vec3 {
        let wanted = self.0 - slip;
        let (far, load) = (length(wanted), max(load, 0.0));
        let given = if far <= touch.static_ * load { wanted } else { wanted * min(touch.kinetic * load / far, 1.0) };
        if !given.is_finite() {
            return Vec3::ZERO;
        }
        let change = given - self.0;
        self.0 = given;
        change
    }
}

/// The speed at which two are to part that came together with the second speed, and had the first before forces pressed them: none where
/// the bounce would be over within a part of the step.
pub(in crate::constrain) fn bounce(substep: &Substep, elasticity: f32, [begun, approach]: [f32; 2]) -> f32 {
    let bounce = max(-approach * elasticity, 0.0);
    let pressing = max(begun - approach, 0.0) / substep.seconds();
    if 2.0 * bounce < RESTING * substep.step.seconds() * pressing { 0.0 } else { bounce }
}

/// How far friction moves two along their surface that has `taken` so much of their slip in a sub-step of `h`: as a steady
/// force does, and back over what the integrator has drifted, so that what was at rest and stays so has not moved, whatever
/// the method.
pub(super) fn hold_back(taken: Vec3, drift: Vec3, h: f32) -> Vec3 {
    let back = taken * (0.5 * h) - drift;
    let (far, most) = (length(back), length(taken) * h);
    if far > most { back * (most / far) } else { back }
}

/// The normal at the first touch of two, one of which was at `from` and is at `to` as seen from the other, if they touched on
/// the way and do no longer.
pub(super) fn passed(from: Vec3, to: Vec3, reach: f32) -> Option<Vec3> {
    let step = to - from;
    let (square, closing) = (step.dot(step), -from.dot(step));
    if !(closing > 0.0 && closing < square) {
        return None;
    }
    let middle = from + step * (closing / square);
    let rest = reach * reach - middle.dot(middle);
    if !(rest > 0.0) || from.dot(from) < reach * reach {
        return None;
    }
    let touch = middle - step * sqrt(rest / square);
    Some(touch / max(length(touch), f32::MIN_POSITIVE))
}
