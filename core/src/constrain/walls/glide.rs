//! Walls of what is solved by speeds, link by link: how particles glide along them.

use super::{NEAR, NONE, SLIDES, Wall};
use crate::constrain::contacts::TangentImpulse;
use crate::index::{Room, between};
use crate::math::{aside, length, max, min};
use glam::Vec3;

/// The change of what friction gives that is small enough, as a share.
const SETTLED: f32 = 0.01;
/// The times as heavy as by itself that a particle is which friction holds.
const HELD: f32 = 1e3;

/// A solution by speeds, as a particle begins it.
#[derive(Clone, Copy)]
pub(in crate::constrain) enum Pace {
    /// A part of a sub-step: where the particle is, how long it takes and what is left of the sub-step behind it \[s\], and what share of that it is.
    Way { from: Vec3, time: f32, left: f32, share: f32 },
    /// How fast it goes at a sub-step's end.
    Settled,
}

/// The motion of a particle as it meets a wall.
#[derive(Clone, Copy)]
pub(in crate::constrain) struct Pushed {
    /// Its velocity, and by how much others have made it faster \[m/s\].
    pub(in crate::constrain) fast: Vec3,
    pub(in crate::constrain) faster: Vec3,
    /// The speed along the wall that it gets for each of speed off it, if it is not as heavy in all directions.
    pub(in crate::constrain) lean: Option<Vec3>,
}

impl Pushed {
    /// Its velocity along a wall that makes it so much faster off that, if others drive it so fast.
    fn off(&self, driven: Vec3, load: f32) -> Vec3 {
        self.lean.map_or(driven, |lean| driven + lean * load)
    }
}

impl Wall {
    /// Begins a pace in which its particle goes so fast by itself; tells how fast it goes if it presses that, as it has before.
    pub(in crate::constrain) fn set_out(&mut self, pace: Pace, pushed: Pushed) -> Option<Vec3> {
        if self.state == NONE {
            return None;
        }
        let fast = pushed.fast;
        (self.held, self.brake) = (fast, if matches!(pace, Pace::Way { .. }) { self.last } else { 0.0 });
        // Who has got off it is not drawn back to it.
        let load = self.least(pace) - fast.dot(self.normal);
        let presses = self.presses() && load >= 0.0;
        self.state = if presses { SLIDES } else { NEAR };
        presses.then(|| self.led(pace, pushed.off(fast, load)))
    }

    /// Looks whether it presses its particle, which others have made faster by so much, and what friction does to that; tells how fast it goes where this
    /// is other than before. It may be that none lets go any more, and that friction is taken for known.
    pub(in crate::constrain) fn judge_pace(
        &mut self,
        pace: Pace,
        pushed: Pushed,
        [frees, rubs]: [bool; 2],
    ) -> Option<Vec3> {
        let driven = self.held + pushed.faster;
        let load = self.least(pace) - driven.dot(self.normal);
        let off = pushed.off(driven, load);
        if frees && self.presses() && load < self.spare(pace) {
            (self.state, self.brake, self.last) = (NEAR, 0.0, 0.0);
            return Some(driven);
        }
        let changed = if self.presses() {
            rubs && self.grip(max(load, 0.0), self.slip(pace, off))
        } else {
            self.is_met_in(pace, load)
        };
        if changed {
            self.state = SLIDES;
        }
        changed.then(|| self.led(pace, off))
    }

    /// Counts as pressed what it has given its particle in a pace, and as taken what friction has.
    pub(in crate::constrain) fn note_pace(&mut self, pace: Pace, pushed: Pushed) {
        if self.presses() {
            let driven = self.held + pushed.faster;
            let load = max(self.least(pace) - driven.dot(self.normal), 0.0);
            self.touch.begin(self.touch.pressed() + load);
            self.last = self.brake;
            self.tangent.give(self.slip(pace, pushed.off(driven, load)) * -self.brake);
        }
    }

    /// Forgets what it has pressed in a sub-step that is gone through again.
    pub(in crate::constrain) fn forget_paces(&mut self) {
        self.touch.begin(0.0);
        self.tangent = TangentImpulse::of(Vec3::ZERO);
    }

    /// A place in a room as it is nearest to where its particle touches it.
    pub(in crate::constrain) fn image(&self, room: Option<&Room>, place: Vec3) -> Vec3 {
        if room.is_some() { self.stuck + between(room, self.stuck, place) } else { place }
    }

    /// The part of a direction that it lets pass.
    pub(in crate::constrain) fn pass(&self, along: Vec3) -> Vec3 {
        if self.presses() { aside(along, self.normal) } else { along }
    }

    /// How many times as heavy its particle is along it as by itself.
    pub(in crate::constrain) fn heavier(&self) -> f32 {
        if self.presses() { 1.0 + self.brake } else { 1.0 }
    }

    /// The speed along the normal that its particle has to have in a pace at the least \[m/s\]. Who is behind it gets out of it in the whole of the
    /// sub-step.
    fn least(&self, pace: Pace) -> f32 {
        let Pace::Way { from, time, left, share } = pace else { return self.held.dot(self.normal) };
        let gap = self.offset - from.dot(self.normal) - self.velocity.dot(self.normal) * left;
        gap / time * if gap > 0.0 { share } else { 1.0 }
    }

    /// How hard it may press at the least \[m/s\]: what it has pressed in a sub-step it may take back as that ends.
    fn spare(&self, pace: Pace) -> f32 {
        if matches!(pace, Pace::Settled) { -max(self.touch.pressed(), 0.0) } else { 0.0 }
    }

    /// Tells whether its particle would get so far into it that it has to press that, or touches it and would go into it. A pace takes it in by its share of what a
    /// sub-step may: all that a rope holds on a wall would else be driven out at once, as far as a sub-step may take it in, and throw what hangs there.
    fn is_met_in(&self, pace: Pace, load: f32) -> bool {
        match pace {
            Pace::Way { time, share, .. } => load * time > self.leeway * share,
            Pace::Settled => self.fresh == 1 && load > 0.0,
        }
    }

    /// How fast a particle goes along it that does not slip. In a pace that is the whole of the sub-step it begins off its place by what the method shows
    /// beyond velocities, which that makes good.
    fn along(&self, pace: Pace) -> Vec3 {
        let way = match pace {
            Pace::Way { from, time, share: 1.0, .. } => (self.stuck - from) / time,
            _ => self.velocity,
        };
        aside(way, self.normal)
    }

    /// How fast a particle slips along it that would go so fast without it.
    fn slip(&self, pace: Pace, driven: Vec3) -> Vec3 {
        aside(driven - self.along(pace), self.normal) / (1.0 + self.brake)
    }

    /// How fast a particle goes that it presses, and that would go so fast without it.
    fn led(&self, pace: Pace, driven: Vec3) -> Vec3 {
        self.along(pace) + self.slip(pace, driven) + self.normal * self.least(pace)
    }

    /// Makes its particle so much heavier that what slips is braked by what friction can by what presses: that never drives it, whatever presses. Tells
    /// whether that is other than before.
    fn grip(&mut self, load: f32, slip: Vec3) -> bool {
        let ([resting, sliding], fast) = (self.touch.friction(), length(slip));
        let brake = match resting * load {
            most if most > 0.0 && most >= HELD * fast => HELD,
            _ if fast > 0.0 => min(sliding * load / fast, HELD),
            _ => 0.0,
        };
        let changed = (brake - self.brake).abs() > SETTLED * brake;
        if changed {
            self.brake = brake;
        }
        changed
    }
}
