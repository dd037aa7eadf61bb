//! Walls while the material is solved: which press, and how particles slide along them.

use super::{ALIKE, NEAR, NOTICED, SLIDES, STICKS, Wall};
use crate::constrain::Bodies;
use crate::constrain::contacts::TangentImpulse;
use crate::math::{aside, length, max, min};
use glam::Vec3;

/// The change of what brakes a particle that is small enough, as a share.
const SETTLED: f32 = 0.1;
/// The most that a particle is braked by, in its own masses.
const MOST: f32 = 1e3;

/// Lists the walls that press, and tells how many there are.
pub(in crate::constrain) fn list(walls: &[Wall], pressing: &mut [u32]) -> usize {
    let all = walls.iter().enumerate().filter(|(_, wall)| wall.presses());
    pressing.iter_mut().zip(all).map(|(to, (number, _))| *to = number as u32).count()
}

/// Takes of the forces that are left what walls bear, of which those that press are listed, so that what remains is what moves particles.
pub(in crate::constrain) fn hold(walls: &mut [Wall], pressing: &[u32], left: &mut [Vec3]) {
    for &number in pressing {
        let (Some(wall), Some(left)) = (walls.get_mut(number as usize), left.get_mut(number as usize)) else {
            continue;
        };
        let borne = if wall.state == STICKS { *left } else { wall.normal * left.dot(wall.normal) };
        wall.held += borne;
        *left -= borne;
    }
}

/// Leaves of directions what walls let pass.
pub(in crate::constrain) fn filter(walls: &[Wall], pressing: &[u32], directions: &mut [Vec3]) {
    for &number in pressing {
        let (Some(wall), Some(p)) = (walls.get(number as usize), directions.get_mut(number as usize)) else { continue };
        *p = if wall.state == STICKS { Vec3::ZERO } else { aside(*p, wall.normal) };
    }
}

/// Adds how walls brake particles that go `p` along them.
pub(in crate::constrain) fn brake(walls: &[Wall], pressing: &[u32], p: &[Vec3], q: &mut [Vec3]) {
    for &number in pressing {
        let number = number as usize;
        let (Some(wall), Some(&p), Some(q)) = (walls.get(number), p.get(number), q.get_mut(number)) else { continue };
        if wall.state == SLIDES && wall.brake > 0.0 {
            *q += aside(p, wall.normal) * wall.brake;
        }
    }
}

/// Moves particles to where walls that press want them, notes how far, and takes what that is of the forces that are `left` \[kg m\].
pub(in crate::constrain) fn meet(
    walls: &mut [Wall],
    pressing: &[u32],
    bodies: &mut Bodies<'_>,
    weight: &[f32],
    left: &mut [Vec3],
    met: &mut [Vec3],
) {
    for &number in pressing {
        let number = number as usize;
        let (Some(wall), Some(&weight)) = (walls.get_mut(number), weight.get(number)) else { continue };
        let (Some(left), Some(met)) = (left.get_mut(number), met.get_mut(number)) else { continue };
        let by = wall.missing(bodies, Vec3::ZERO);
        if weight > 0.0 && by.is_finite() {
            bodies.shift(wall.row as usize, by);
            *left -= by / weight;
            (*met, wall.fresh) = (by, 0);
        }
    }
}

/// How far particles have to be moved besides to be where walls want them; tells whether anybody has to.
pub(in crate::constrain) fn impose(
    walls: &mut [Wall],
    pressing: &[u32],
    bodies: &Bodies<'_>,
    shift: &[Vec3],
    by: &mut [Vec3],
) -> bool {
    by.fill(Vec3::ZERO);
    let mut some = false;
    for &number in pressing {
        let number = number as usize;
        let (Some(wall), Some(&shift), Some(by)) = (walls.get_mut(number), shift.get(number), by.get_mut(number))
        else {
            continue;
        };
        if wall.fresh == 0 {
            continue;
        }
        wall.fresh = 0;
        some = true;
        *by = wall.missing(bodies, shift);
    }
    some
}

/// Looks which walls press what has been moved so far, and adds to the forces that are `left` \[kg m\] what others give back; tells whether
/// that is other than before.
pub(in crate::constrain) fn judge(walls: &mut [Wall], bodies: &Bodies<'_>, shift: &[Vec3], left: &mut [Vec3]) -> bool {
    let mut changed = false;
    let slips = slips_as_one(walls);
    for ((wall, &shift), left) in walls.iter_mut().zip(shift).zip(left).filter(|((wall, _), _)| wall.state >= NEAR) {
        let load = -wall.held.dot(wall.normal);
        changed |= match wall.state {
            NEAR => {
                let missing = wall.offset - (bodies.position[wall.row as usize] + shift).dot(wall.normal);
                let presses = missing > NOTICED * wall.slack;
                if presses {
                    wall.press(missing, bodies);
                }
                presses
            }
            _ if load < 0.0 => {
                let braked = wall.slid(bodies, shift) * wall.brake;
                *left += wall.held + braked;
                (wall.state, wall.held, wall.brake) = (NEAR, Vec3::ZERO, 0.0);
                true
            }
            STICKS => wall.let_slip(if slips { 0.0 } else { load }, left),
            _ if wall.touch.sticks() => {
                let slid = wall.slid(bodies, shift);
                wall.brake(load, bodies.inverse_mass[wall.row as usize], slid, left)
            }
            _ => false,
        };
    }
    changed
}

/// Tells whether all that stick take more together than their friction can hold: then they slip at once. One by one each would hand on what it lets go of
/// to those that still stick beside it, and a stiff sheet would be held by these.
fn slips_as_one(walls: &[Wall]) -> bool {
    let mut sum = (Vec3::ZERO, 0.0);
    for wall in walls.iter().filter(|wall| wall.state == STICKS) {
        let [resting, _] = wall.touch.friction();
        sum.0 += aside(wall.held, wall.normal);
        sum.1 += resting * max(-wall.held.dot(wall.normal), 0.0);
    }
    length(sum.0) > sum.1
}

impl Wall {
    /// The way from where its particle has been moved to where it wants it.
    fn missing(&self, bodies: &Bodies<'_>, shift: Vec3) -> Vec3 {
        let now = bodies.position[self.row as usize] + shift;
        let to = if self.state == STICKS { self.stuck } else { now };
        to + self.normal * (self.offset - to.dot(self.normal)) - now
    }

    /// The way out of another face that its particle is behind: straight, or along its own where that would lead behind it. Between two that
    /// almost face each other there is no way out.
    fn aside(&self, bodies: &Bodies<'_>, shift: Vec3) -> Vec3 {
        let now = bodies.position[self.row as usize] + shift;
        let missing = self.beyond - now.dot(self.beside);
        if !(missing > 0.0) {
            return Vec3::ZERO;
        }
        let straight = self.beside * missing;
        if (now + straight).dot(self.normal) >= self.offset {
            return straight;
        }
        let along = aside(self.beside, self.normal);
        let share = along.dot(self.beside);
        if share > 1.0 - ALIKE * ALIKE { along * (missing / share) } else { Vec3::ZERO }
    }

    /// Bears nothing yet of what is left; tells what it brakes by, where its particle has been moved \[kg m\].
    pub(in crate::constrain) fn begin_again(&mut self, bodies: &Bodies<'_>) -> Vec3 {
        if !self.presses() {
            return Vec3::ZERO;
        }
        self.held = Vec3::ZERO;
        if self.state == SLIDES { self.slid(bodies, Vec3::ZERO) * self.brake } else { Vec3::ZERO }
    }

    /// How far its particle has gone along it since it touched it.
    fn slid(&self, bodies: &Bodies<'_>, shift: Vec3) -> Vec3 {
        aside(bodies.position[self.row as usize] + shift - self.stuck, self.normal)
    }

    /// Brakes a particle that slides in proportion to how far it does, so that friction never drives it; tells whether that is other than before.
    fn brake(&mut self, load: f32, weight: f32, slid: Vec3, left: &mut Vec3) -> bool {
        let [_, sliding] = self.touch.friction();
        let brake = min(sliding * load / max(length(slid), f32::MIN_POSITIVE), MOST / weight);
        let change = brake - self.brake;
        if !(change.abs() > SETTLED * brake) {
            return false;
        }
        *left -= slid * change;
        self.brake = brake;
        true
    }

    /// Lets a particle slide that friction cannot hold.
    fn let_slip(&mut self, load: f32, left: &mut Vec3) -> bool {
        let pull = aside(self.held, self.normal);
        let [resting, _] = self.touch.friction();
        if length(pull) <= resting * load {
            return false;
        }
        self.state = SLIDES;
        self.held -= pull;
        *left += pull;
        true
    }
}

/// Takes from what walls bear how hard they have pressed, brakes by that who slides, and moves out whoever is still behind one.
pub(in crate::constrain) fn finish(walls: &mut [Wall], bodies: &Bodies<'_>, weight: &[f32], shifts: &mut [Vec3]) {
    let h = bodies.substep.seconds();
    for ((wall, &weight), shift) in walls.iter_mut().zip(weight).zip(&mut *shifts) {
        if wall.state <= NEAR || !shift.is_finite() {
            continue;
        }
        let pressed = max(-wall.held.dot(wall.normal), 0.0) * weight / h;
        wall.touch.begin(pressed);
        if wall.state == SLIDES && wall.touch.sticks() {
            let slid = wall.slid(bodies, *shift);
            let [_, sliding] = wall.touch.friction();
            let (given, most) = (slid * (-wall.brake * weight / h), sliding * pressed);
            let far = length(given);
            wall.tangent = TangentImpulse::of(if far > most { given * (most / far) } else { given });
            *shift += wall.tangent.hold(&wall.touch, slid / h, pressed) * h;
        }
    }
    keep(walls, bodies, shifts, |_| ());
}

/// Moves out whoever is still behind a wall, or again, and tells who that is.
pub(in crate::constrain) fn keep(
    walls: &mut [Wall],
    bodies: &Bodies<'_>,
    shifts: &mut [Vec3],
    mut tell: impl FnMut(usize),
) {
    let h = bodies.substep.seconds();
    for (number, (wall, shift)) in walls.iter_mut().zip(shifts).enumerate().filter(|(_, (wall, _))| wall.state >= NEAR)
    {
        let missing = wall.offset - (bodies.position[wall.row as usize] + *shift).dot(wall.normal);
        if missing > 0.0 {
            *shift += wall.normal * missing;
            wall.touch.begin(wall.touch.pressed() + missing / h);
            tell(number);
        }
        let by = wall.aside(bodies, *shift);
        if by != Vec3::ZERO {
            *shift += by;
            tell(number);
        }
    }
}
