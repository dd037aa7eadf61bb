//! Walls that press what moves as one: a push at one of its particles moves all of it.

use super::Wall;
use crate::constrain::Bodies;
use crate::constrain::contacts::bounce;
use crate::math::{aside, dot, length, max, min};
use glam::{Mat3, Vec3};

/// Times that all walls are gone over, at the most.
const ROUNDS: u32 = 40;
/// The share of the first change below which the changes of a round are small enough.
const SETTLED: f32 = 1e-4;

/// What moves as one, and how it answers a push at a particle.
pub(in crate::constrain) struct Whole {
    /// The place about which it turns \[m\]: the sum of both, of which the second is small.
    pub(in crate::constrain) origin: Vec3,
    pub(in crate::constrain) center: Vec3,
    /// The inverse of its mass \[1/kg\]; zero: that place is fixed.
    pub(in crate::constrain) inverse_mass: f32,
    /// The inverse of its moment of inertia \[1/(kg m²)\].
    pub(in crate::constrain) inverse_inertia: Mat3,
    /// The share of a push that all of it bears; of the rest a particle gives way by itself.
    pub(in crate::constrain) share: f32,
}

/// How something has moved as a whole: its centre \[m\], and about that \[rad\]; or how fast.
pub(in crate::constrain) struct Motion {
    along: Vec3,
    turning: Vec3,
}

impl Whole {
    /// Where a particle is, from the centre.
    fn arm(&self, bodies: &Bodies<'_>, row: usize) -> Vec3 {
        bodies.position[row] - self.origin - self.center
    }

    /// How a motion of the whole moves a particle.
    pub(in crate::constrain) fn moves(&self, bodies: &Bodies<'_>, row: usize, motion: &Motion) -> Vec3 {
        motion.along + motion.turning.cross(self.arm(bodies, row))
    }

    /// How far a push of one along a direction moves the particle that it acts on, along that.
    fn gives_way(&self, bodies: &Bodies<'_>, row: usize, direction: Vec3) -> f32 {
        let lever = self.arm(bodies, row).cross(direction);
        let all = self.inverse_mass + dot(lever, self.inverse_inertia * lever);
        self.share * all + (1.0 - self.share) * bodies.inverse_mass[row]
    }

    /// Takes a push at a particle in; tells by how much the particle gives way by itself.
    fn take(&self, bodies: &Bodies<'_>, row: usize, push: Vec3, motion: &mut Motion) -> Vec3 {
        motion.along += push * (self.share * self.inverse_mass);
        motion.turning += self.inverse_inertia * self.arm(bodies, row).cross(push) * self.share;
        push * ((1.0 - self.share) * bodies.inverse_mass[row])
    }

    /// Goes over walls until what they change is small against what they have changed to begin with.
    fn go_over(walls: &mut [Wall], counts: fn(&Wall) -> bool, mut change: impl FnMut(&mut Wall) -> f32) {
        let mut enough = 0.0;
        for round in 0..ROUNDS {
            let changes = walls.iter_mut().filter(|wall| counts(wall)).map(&mut change);
            let most = changes.fold(0.0, max);
            enough = if round == 0 { most * SETTLED } else { enough };
            if !(most > enough) {
                break;
            }
        }
    }

    /// Pushes it out of walls by impulses at its particles, with friction, which holds particles where they touch if it can. Particles are moved by
    /// what they give way by themselves; tells how all of it moves besides.
    ///
    /// Walls are gone over one after the other, each with what it has given so far, so that it never pulls (projected Gauss-Seidel).
    pub(in crate::constrain) fn press(&self, walls: &mut [Wall], bodies: &mut Bodies<'_>) -> Motion {
        let mut moved = Motion { along: Vec3::ZERO, turning: Vec3::ZERO };
        for wall in &mut *walls {
            (wall.held, wall.brake) = (Vec3::ZERO, 0.0);
        }
        Self::go_over(walls, Wall::is_near, |wall| wall.push(self, bodies, &mut moved));
        moved
    }

    /// Lets its particles leave walls as fast as elasticity wants, and takes what friction can of their slip by all that has pressed. Particles
    /// are given what they answer by themselves; tells by how much the whole is faster.
    pub(in crate::constrain) fn answer(&self, walls: &mut [Wall], bodies: &mut Bodies<'_>) -> Motion {
        let mut faster = Motion { along: Vec3::ZERO, turning: Vec3::ZERO };
        let rate = 1.0 / bodies.substep.seconds();
        for wall in walls.iter_mut() {
            wall.held *= rate;
            match wall.is_near() && (wall.held != Vec3::ZERO || wall.touches(bodies)) {
                true => wall.touch.begin(0.0),
                false => wall.touch.end(),
            }
        }
        Self::go_over(walls, Wall::is_touched, |wall| wall.bounce(self, bodies, &mut faster));
        for wall in walls.iter_mut().filter(|wall| wall.touch.is_on()) {
            wall.touch.begin(wall.held.dot(wall.normal) * bodies.inverse_mass[wall.row as usize]);
        }
        faster
    }
}

impl Wall {
    fn is_touched(&self) -> bool {
        self.touch.is_on()
    }

    /// Pushes its particle out and back to where it touches; tells how far.
    fn push(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, moved: &mut Motion) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let at = |bodies: &Bodies<'_>, moved: &Motion| bodies.position[row] + whole.moves(bodies, row, moved);
        let missing = self.offset - at(bodies, moved).dot(normal);
        let mut far = self.give(whole, bodies, moved, missing, Self::shift);
        if self.beside != Vec3::ZERO {
            let missing = self.beyond - at(bodies, moved).dot(self.beside);
            let weight = whole.gives_way(bodies, row, self.beside);
            let by = max(missing / weight, -self.brake);
            if by.is_finite() {
                self.brake += by;
                far = max(by.abs() * weight, far);
                let alone = whole.take(bodies, row, self.beside * by, moved);
                Self::shift(bodies, row, alone);
            }
        }
        let slip = aside(at(bodies, moved) - self.stuck, normal);
        max(self.rub(whole, bodies, moved, slip, Self::shift), far)
    }

    /// Brings its particle to leave it as fast as elasticity wants, with what friction holds; tells by how much it is faster.
    fn bounce(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, faster: &mut Motion) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let wanted = bounce(&bodies.substep, self.touch.elasticity, self.ends(bodies));
        let leaves = |bodies: &Bodies<'_>, faster: &Motion, surface: Vec3| {
            bodies.velocity[row] + whole.moves(bodies, row, faster) - surface
        };
        let missing = wanted - leaves(bodies, faster, self.velocity).dot(normal);
        let far = self.give(whole, bodies, faster, missing, Self::hasten);
        let slip = aside(leaves(bodies, faster, self.velocity), normal);
        max(self.rub(whole, bodies, faster, slip, Self::hasten), far)
    }

    /// Gives its particle what is missing along the normal, and takes back no more than it has given.
    fn give(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, motion: &mut Motion, missing: f32, own: Own) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let (given, weight) = (self.held.dot(normal), whole.gives_way(bodies, row, normal));
        let by = max(given + missing / weight, 0.0) - given;
        self.change(whole, bodies, motion, normal * by, own);
        (by * weight).abs()
    }

    /// Takes a slip, as far as friction can by what presses, and gives back what was more than that.
    fn rub(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, motion: &mut Motion, slip: Vec3, own: Own) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let (pressed, [resting, sliding]) = (self.held.dot(normal), self.touch.friction());
        let (held, speed) = (aside(self.held, normal), length(slip));
        if !(resting + sliding > 0.0) || pressed == 0.0 && held == Vec3::ZERO {
            return 0.0;
        }
        let direction = if speed > 0.0 { slip * (1.0 / speed) } else { Vec3::ZERO };
        let weight = max(whole.gives_way(bodies, row, direction), f32::MIN_POSITIVE);
        let wanted = held - direction * (speed / weight);
        let far = length(wanted);
        let given = if far <= resting * pressed { wanted } else { wanted * min(sliding * pressed / far, 1.0) };
        self.change(whole, bodies, motion, given - held, own);
        length(given - held) * weight
    }

    /// Changes what it gives its particle.
    fn change(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, motion: &mut Motion, by: Vec3, own: Own) {
        if by.is_finite() {
            self.held += by;
            let alone = whole.take(bodies, self.row as usize, by, motion);
            own(bodies, self.row as usize, alone);
        }
    }

    fn shift(bodies: &mut Bodies<'_>, row: usize, by: Vec3) {
        if by != Vec3::ZERO {
            bodies.shift(row, by);
        }
    }

    fn hasten(bodies: &mut Bodies<'_>, row: usize, by: Vec3) {
        bodies.velocity[row] += by;
    }
}

/// What a particle does by itself where a push is not borne by all.
type Own = fn(&mut Bodies<'_>, usize, Vec3);
