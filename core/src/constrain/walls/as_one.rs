//! Walls that press what moves as one: a push at one of its particles moves all of it.

use super::{NOBODY, Wall};
use crate::constrain::Bodies;
use crate::constrain::bisect::bisect;
use crate::constrain::bodies::Change;
use crate::constrain::contacts::bounce;
use crate::math::{aside, dot, length, max};
use glam::{Mat3, Vec3};

/// Times that all walls are gone over, at the most.
const ROUNDS: u32 = 64;
/// The share of the first change below which the changes of a round are small enough.
const SETTLED: f32 = 1e-3;
/// The square of the sine of the least angle between a push and the arm at which it turns what is fixed at a place: others are borne by that.
const LEAST: f32 = 1e-3;
/// So many times the friction of what rests a particle asks for that is no longer held. What rounds leave over is less and does not add up over
/// sub-steps, as what slides does.
const SLIPS: f32 = 1.25;

/// A body whose particles move as one, and how it answers a push at one of them.
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
    pub(in crate::constrain) along: Vec3,
    pub(in crate::constrain) turning: Vec3,
}

/// The friction that particles have at walls: of what slides, or of what rests; and whether a round has found that it holds some, and does not hold
/// others.
#[derive(Clone, Copy)]
struct Rubs {
    slides: bool,
    holds: bool,
    slips: bool,
}

impl Motion {
    pub(in crate::constrain) const NONE: Self = Self { along: Vec3::ZERO, turning: Vec3::ZERO };
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

    /// How far a push of one along a direction moves the particle that it acts on, along that; zero: it does not.
    fn gives_way(&self, bodies: &Bodies<'_>, row: usize, direction: Vec3) -> f32 {
        let arm = self.arm(bodies, row);
        let lever = arm.cross(direction);
        if !(self.inverse_mass > 0.0) && dot(lever, lever) < LEAST * dot(arm, arm) {
            return (1.0 - self.share) * bodies.inverse_mass[row];
        }
        let all = self.inverse_mass + dot(lever, self.inverse_inertia * lever);
        self.share * all + (1.0 - self.share) * bodies.inverse_mass[row]
    }

    /// Takes a push at a particle in; tells by how much the particle gives way by itself.
    fn take(&self, bodies: &Bodies<'_>, row: usize, push: Vec3, motion: &mut Motion) -> Vec3 {
        motion.along += push * (self.share * self.inverse_mass);
        motion.turning += self.inverse_inertia * self.arm(bodies, row).cross(push) * self.share;
        push * ((1.0 - self.share) * bodies.inverse_mass[row])
    }

    /// The push along a direction that moves a particle by what is missing, where so much has been given and no more is taken back, and how far that
    /// moves it.
    fn push_for(&self, bodies: &Bodies<'_>, row: usize, direction: Vec3, [given, missing]: [f32; 2]) -> [f32; 2] {
        let weight = self.gives_way(bodies, row, direction);
        let by = max(given + missing / weight, 0.0) - given;
        if weight > 0.0 && by.is_finite() { [by, (by * weight).abs()] } else { [0.0; 2] }
    }

    /// Takes a push at a particle in, and lets that do by itself what all of it does not.
    fn take_in(&self, bodies: &mut Bodies<'_>, row: usize, push: Vec3, motion: &mut Motion, what: Change) {
        let alone = self.take(bodies, row, push, motion);
        if alone != Vec3::ZERO {
            bodies.change(what, row, alone);
        }
    }

    /// Goes over walls until what they change is small against what they have changed to begin with; tells whether it has become so.
    fn go_over(
        walls: &mut [Wall],
        counts: fn(&Wall) -> bool,
        rubs: &mut Rubs,
        mut change: impl FnMut(&mut Wall, &mut Rubs) -> f32,
    ) -> bool {
        let mut enough = 0.0;
        for round in 0..ROUNDS {
            (rubs.holds, rubs.slips) = (false, false);
            let changes = walls.iter_mut().filter(|wall| counts(wall)).map(|wall| change(wall, rubs));
            let most = changes.fold(0.0, max);
            enough = if round == 0 { most * SETTLED } else { enough };
            if !(most > enough) {
                return true;
            }
        }
        false
    }

    /// The same by the friction of what rests, and if that holds nobody, of what slides: one wall of several takes the slip of all, more than its
    /// share, until the others have had their turn, so that which it is shows in the end.
    fn go_over_all(
        walls: &mut [Wall],
        counts: fn(&Wall) -> bool,
        mut change: impl FnMut(&mut Wall, &mut Rubs) -> f32,
    ) -> bool {
        let mut rubs = Rubs { slides: false, holds: false, slips: false };
        let is_settled = Self::go_over(walls, counts, &mut rubs, &mut change);
        rubs.slides = rubs.slips && !rubs.holds;
        if rubs.slides { Self::go_over(walls, counts, &mut rubs, change) } else { is_settled }
    }

    /// Pushes it out of walls by impulses at its particles, with friction, which holds particles where they touch if it can. Particles are moved by
    /// what they give way by themselves; tells how all of it moves besides.
    ///
    /// Walls are gone over one after the other, each with what it has given so far, so that it never pulls (projected Gauss-Seidel).
    pub(in crate::constrain) fn press(&self, walls: &mut [Wall], bodies: &mut Bodies<'_>) -> Motion {
        let mut moved = Motion::NONE;
        for wall in &mut *walls {
            (wall.held, wall.brake) = (Vec3::ZERO, 0.0);
        }
        let is_settled =
            Self::go_over_all(walls, Wall::is_near, |wall, rubs| wall.push(self, bodies, &mut moved, rubs));
        bodies.report.effort.capped += u64::from(!is_settled);
        for wall in walls.iter_mut().filter(|wall| wall.row != NOBODY) {
            // It is that much nearer to what has been searched.
            wall.clear = max(wall.clear - length(self.moves(bodies, wall.row as usize, &moved)), 0.0);
        }
        moved
    }

    /// Lets its particles leave walls as fast as elasticity wants, and takes what friction can of their slip by all that has pressed. Particles
    /// are given what they answer by themselves; tells by how much the whole is faster.
    ///
    /// Newton's restitution at several places at once, or with friction, can give energy (Kane and Levinson, "Dynamics: Theory and Applications",
    /// 1985): where what `gains` says would, and all walls stand still, they are so much less elastic.
    pub(in crate::constrain) fn answer(
        &self,
        walls: &mut [Wall],
        bodies: &mut Bodies<'_>,
        gains: &dyn Fn(&Motion) -> bool,
    ) -> Motion {
        let mut faster = Motion::NONE;
        let rate = 1.0 / bodies.substep.seconds();
        for wall in &mut *walls {
            (wall.held, wall.brake) = (wall.held * rate, wall.brake * rate);
            match wall.is_near() && (wall.held != Vec3::ZERO || wall.brake > 0.0 || wall.touches(bodies)) {
                true => wall.touch.begin(0.0),
                false => wall.touch.end(),
            }
        }
        let all = self.all(walls, bodies);
        for wall in walls.iter_mut().filter(|wall| wall.touch.is_on()) {
            // What was pushed came at this speed, where it has turned to by now.
            wall.pushed = bodies.velocity[wall.row as usize] - self.changes(wall, bodies, &all);
        }
        let mut bounces = |walls: &mut [Wall], bodies: &mut Bodies<'_>, share: f32| {
            let is_settled = Self::go_over_all(walls, Wall::is_touched, |wall, rubs| {
                wall.bounce(self, bodies, &mut faster, (share, rubs))
            });
            (is_settled, gains(&faster) && walls.iter().filter(|wall| wall.touch.is_on()).all(Wall::stands))
        };
        let (mut is_settled, is_too_much) = bounces(walls, bodies, 1.0);
        if is_too_much {
            bisect(|share| {
                let (is_done, is_too_much) = bounces(walls, bodies, share);
                is_settled = is_done;
                !is_too_much
            });
        }
        bodies.report.effort.capped += u64::from(!is_settled);
        for wall in walls.iter_mut().filter(|wall| wall.touch.is_on()) {
            let pressed = wall.held.dot(wall.normal) + wall.brake;
            wall.touch.begin(pressed * bodies.inverse_mass[wall.row as usize]);
        }
        faster
    }

    /// The motion that all walls which it touches have given it.
    fn all(&self, walls: &[Wall], bodies: &Bodies<'_>) -> Motion {
        let mut all = Motion::NONE;
        for wall in walls.iter().filter(|wall| wall.touch.is_on()) {
            self.take(bodies, wall.row as usize, wall.given(), &mut all);
        }
        all
    }

    /// By how much all that has been given has changed the velocity of a wall's particle.
    fn changes(&self, wall: &Wall, bodies: &Bodies<'_>, all: &Motion) -> Vec3 {
        let row = wall.row as usize;
        self.moves(bodies, row, all) + wall.given() * ((1.0 - self.share) * bodies.inverse_mass[row])
    }
}

impl Wall {
    fn is_touched(&self) -> bool {
        self.touch.is_on()
    }

    /// All that it has given its particle.
    fn given(&self) -> Vec3 {
        self.held + self.beside * self.brake
    }

    /// Pushes its particle out and back to where it touches; tells how far.
    fn push(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, moved: &mut Motion, rubs: &mut Rubs) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let at = |bodies: &Bodies<'_>, moved: &Motion| bodies.position[row] + whole.moves(bodies, row, moved);
        let missing = self.offset - at(bodies, moved).dot(normal);
        let mut far = self.give(whole, bodies, moved, missing, Change::Place);
        if self.beside != Vec3::ZERO {
            let missing = self.beyond - at(bodies, moved).dot(self.beside);
            far = max(self.give_beside(whole, bodies, moved, missing, Change::Place), far);
        }
        let slip = aside(at(bodies, moved) - self.stuck, normal);
        max(self.rub(whole, bodies, moved, slip, (Change::Place, rubs)), far)
    }

    /// Brings its particle to leave it as fast as a share of its elasticity wants, with what friction holds; tells by how much it is faster.
    fn bounce(
        &mut self,
        whole: &Whole,
        bodies: &mut Bodies<'_>,
        faster: &mut Motion,
        (share, rubs): (f32, &mut Rubs),
    ) -> f32 {
        let (row, normal, beside) = (self.row as usize, self.normal, self.beside);
        let elasticity = share * self.touch.elasticity;
        let leaves = |bodies: &Bodies<'_>, faster: &Motion, surface: Vec3| {
            bodies.velocity[row] + whole.moves(bodies, row, faster) - surface
        };
        let wanted = bounce(&bodies.substep, elasticity, self.ends(bodies));
        let missing = wanted - leaves(bodies, faster, self.velocity).dot(normal);
        let mut far = self.give(whole, bodies, faster, missing, Change::Velocity);
        // How the other face moves is not known.
        if self.brake > 0.0 && self.stands() {
            let ends = [bodies.before[1][row], self.pushed].map(|v: Vec3| v.dot(beside));
            let wanted = bounce(&bodies.substep, elasticity, ends);
            let missing = wanted - leaves(bodies, faster, Vec3::ZERO).dot(beside);
            far = max(self.give_beside(whole, bodies, faster, missing, Change::Velocity), far);
        }
        let slip = aside(leaves(bodies, faster, self.velocity), normal);
        max(self.rub(whole, bodies, faster, slip, (Change::Velocity, rubs)), far)
    }

    /// Gives its particle what is missing along the normal, and takes back no more than it has given; tells how far that moves it.
    fn give(&mut self, whole: &Whole, bodies: &mut Bodies<'_>, motion: &mut Motion, missing: f32, what: Change) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let [by, far] = whole.push_for(bodies, row, normal, [self.held.dot(normal), missing]);
        self.held += normal * by;
        whole.take_in(bodies, row, normal * by, motion, what);
        far
    }

    /// The same along the normal of the other face.
    fn give_beside(
        &mut self,
        whole: &Whole,
        bodies: &mut Bodies<'_>,
        motion: &mut Motion,
        missing: f32,
        what: Change,
    ) -> f32 {
        let (row, beside) = (self.row as usize, self.beside);
        let [by, far] = whole.push_for(bodies, row, beside, [self.brake, missing]);
        self.brake += by;
        whole.take_in(bodies, row, beside * by, motion, what);
        far
    }

    /// Takes a slip, as far as friction can by what presses, and gives back what was more than that.
    fn rub(
        &mut self,
        whole: &Whole,
        bodies: &mut Bodies<'_>,
        motion: &mut Motion,
        slip: Vec3,
        (what, rubs): (Change, &mut Rubs),
    ) -> f32 {
        let (row, normal) = (self.row as usize, self.normal);
        let (pressed, [resting, sliding]) = (self.held.dot(normal), self.touch.friction());
        let (held, speed) = (aside(self.held, normal), length(slip));
        if !(resting + sliding > 0.0) || pressed == 0.0 && held == Vec3::ZERO {
            return 0.0;
        }
        let direction = if speed > 0.0 { slip * (1.0 / speed) } else { Vec3::ZERO };
        let weight = whole.gives_way(bodies, row, direction);
        let wanted = if weight > 0.0 { held - direction * (speed / weight) } else { held };
        let far = length(wanted);
        let most = if rubs.slides { sliding } else { max(resting, sliding) } * pressed;
        let slips = resting > sliding && far > SLIPS * most;
        (rubs.holds, rubs.slips) = (rubs.holds || !slips && most > 0.0, rubs.slips || slips);
        let given = if far <= most { wanted } else { wanted * (most / far) };
        let by = given - held;
        if !by.is_finite() {
            return 0.0;
        }
        self.held += by;
        whole.take_in(bodies, row, by, motion, what);
        length(by) * weight
    }
}
