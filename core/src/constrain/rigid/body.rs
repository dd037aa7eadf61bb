//! A rigid body as a whole: what its particles tell of it, how it moves, and what it tells them.

use super::super::turn::{Turn, keeping, outer, solve};
use super::super::{Bodies, CARRIED, SHIFTED};
use super::RigidBox;
use super::made::Made;
use crate::math::{dot, length, max, min, sqrt};
use glam::{Mat3, Vec3};

/// It is not there: its particles are dead or nowhere.
const ABSENT: u32 = 0;
/// It is there and stays where it is.
const FIXED: u32 = 1;
/// It moves.
pub(super) const MOVING: u32 = 2;

/// What is reckoned of a body over a blow, and summed up for those that touch each other.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Blow {
    /// Its kinetic energy over its mass when the sub-step began \[m²/s²\].
    pub(super) begun: f32,
    /// What there was more than before the blow, and what the blow gives: in proportion to it, and to its square \[J\].
    pub(super) spare: f32,
    pub(super) linear: f32,
    pub(super) square: f32,
}

/// A body between two calls. All places within it are told in its box's frame.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Body {
    /// 1 if it sleeps. What is asked for of all again and again stands here, in one line of a cache.
    pub(super) asleep: u32,
    pub(super) state: u32,
    /// Marks that others call out to it.
    pub(super) calls: u32,
    /// The least number among those that sleep with it.
    pub(super) island: u32,
    /// One more than how many contacts away from it bodies wake by a blow to it.
    pub(super) rings: u32,
    /// In how many directions the scenery may press on it: in the first of those that there is room for.
    pub(super) met: u32,
    /// 1 if something presses on it in this sub-step.
    pub(super) pressed: u32,
    /// 1 if it takes part in a blow, or has turned far in the sub-step: what it has more than before is looked at.
    pub(super) bounces: u32,
    /// The colours of those that it touches, a bit for each.
    pub(super) colours: u32,
    /// How far it may go before the lists of pairs, and of what it meets of the scenery, have to be made anew \[m\].
    pub(super) max_travel: f32,
    pub(super) spare: f32,
    /// How fast its farthest point goes round its centre, as the lists were looked through last \[m/s\].
    pub(super) whirl: f32,
    /// One over its mass \[1/kg\]; zero: it stays. This and what follows, up to how it moved before, is read in one go when a sub-step begins.
    pub(super) inverse_mass: f32,
    /// Its velocity \[m/s\].
    pub(super) velocity: Vec3,
    /// Its angular momentum about its centre over its mass \[m²/s\].
    pub(super) spin: Vec3,
    /// How it turns \[rad/s\].
    pub(super) omega: Vec3,
    /// The inverse of its inertia over its mass in the world \[1/m²\].
    pub(super) inverse: Mat3,
    /// Its centre of mass \[m\].
    pub(super) center: Vec3,
    /// Its centre of mass in the box's frame \[m\].
    pub(super) rest: Vec3,
    /// Its rotation.
    pub(super) rotation: Mat3,
    /// Its velocity and rate of turning when the sub-step began.
    pub(super) before: [Vec3; 2],
    pub(super) turn: [f32; 4],
    /// Σ m q qᵀ over its mass, in the box's frame \[m²\], and the inverse of its inertia over its mass there \[1/m²\].
    pub(super) spread: Mat3,
    pub(super) inverse_inertia: Mat3,
    /// How much farther the method has moved it than its velocity says \[m\].
    pub(super) drift: Vec3,
    /// The rates at which forces changed its velocity and spin when it was awake last \[m/s², m²/s²\].
    pub(super) drive: [Vec3; 2],
    /// The number of its particles that live, plus one; zero before it is seen for the first time.
    pub(super) known: u32,
    /// The number of places of the scenery that were near when it fell asleep.
    pub(super) faces: u32,
    /// For how long it has been near a place, and how it was turned there \[s, m\].
    pub(super) still: f32,
    /// 1 if that was long enough to sleep.
    pub(super) lull: u32,
    pub(super) home: Vec3,
    pub(super) home_turn: [f32; 4],
    /// Half the sides of its box \[m\].
    pub(super) half: Vec3,
    /// How far its box reaches from its centre of mass \[m\].
    pub(super) radius: f32,
    /// The share of the normal speed it keeps in a hit, and the number of its material plus one.
    pub(super) elasticity: f32,
    pub(super) material: u32,
    pub(super) blow: Blow,
}

impl Body {
    /// The world: what stands still and has no box.
    pub(super) fn world() -> Self {
        Self { rotation: Mat3::IDENTITY, ..bytemuck::Zeroable::zeroed() }
    }

    /// Tells whether it is there to be met.
    pub(super) fn is_there(&self) -> bool {
        self.state != ABSENT
    }

    /// Tells whether it is there and moves.
    pub(super) fn moves(&self) -> bool {
        self.state == MOVING
    }

    /// Tells whether it moves and does not sleep.
    pub(super) fn is_awake(&self) -> bool {
        self.moves() && self.asleep == 0
    }

    /// Tells whether it sleeps.
    pub(super) fn sleeps(&self) -> bool {
        self.asleep != 0
    }

    /// Tells whether it is pushed by one that touches it, and has lain there (1) since before it fell asleep or not.
    #[inline(always)]
    pub(super) fn gives(&self, rested: u8) -> bool {
        self.inverse_mass > 0.0 && (rested == 0 || self.asleep == 0)
    }

    /// The place of a point of it in the world \[m\].
    pub(super) fn point(&self, place: Vec3) -> Vec3 {
        self.center + self.rotation * (place - self.rest)
    }

    /// The place in its box's frame of a point of the world \[m\].
    pub(super) fn place(&self, point: Vec3) -> Vec3 {
        self.rotation.transpose() * (point - self.center) + self.rest
    }

    /// The middle of its box \[m\].
    pub(super) fn middle(&self) -> Vec3 {
        self.center - self.rotation * self.rest
    }

    /// The place in the world of one that lies so far from the middle of its box in its frame \[m\].
    pub(super) fn beside_middle(&self, place: Vec3) -> Vec3 {
        self.center - self.rotation * (self.rest - place)
    }

    /// A bound on the speed of any point of its box \[m/s\].
    pub(super) fn speed(&self) -> f32 {
        length(self.velocity) + length(self.omega) * self.radius
    }

    /// The speed of the point of it that is `arm` \[m\] from its centre \[m/s\].
    pub(super) fn velocity_at(&self, arm: Vec3) -> Vec3 {
        self.velocity + self.omega.cross(arm)
    }

    /// The same when the sub-step began.
    pub(super) fn velocity_before(&self, arm: Vec3) -> Vec3 {
        let [velocity, omega] = self.before;
        velocity + omega.cross(arm)
    }

    /// Takes a ball as it is at the beginning of a sub-step: the particle in a row.
    pub(super) fn follow(&mut self, bodies: &Bodies<'_>, row: usize) {
        let Turn(turn) = Turn::NONE;
        let radius = bodies.radius[row];
        let (half, inverse_mass) = (Vec3::splat(radius), bodies.inverse_mass[row]);
        let state = if inverse_mass > 0.0 { MOVING } else { FIXED };
        let velocity = if inverse_mass > 0.0 { bodies.velocity[row] } else { Vec3::ZERO };
        let (center, elasticity, material) =
            (bodies.position[row], bodies.elasticity[row], u32::from(bodies.material[row]));
        let (known, met, spare, max_travel) = (self.known, self.met, self.spare, self.max_travel);
        let ball = Self {
            known,
            met,
            spare,
            max_travel,
            state,
            turn,
            center,
            velocity,
            inverse_mass,
            half,
            radius,
            elasticity,
            material,
            ..Self::world()
        };
        *self = ball;
        if !(center + velocity).is_finite() {
            (self.state, self.inverse_mass) = (ABSENT, 0.0);
        }
    }

    /// Takes in what has been done to a ball in the sub-step, as [`gather`](Self::gather) does.
    pub(super) fn gather_ball(&mut self, bodies: &Bodies<'_>, row: usize) {
        self.begin();
        let (to, velocity) = (bodies.position[row], bodies.velocity[row]);
        if self.moves() && (to + velocity).is_finite() {
            self.velocity = velocity + Vec3::ZERO;
            self.count_forces();
            self.drift = to - self.center - velocity * bodies.substep.seconds();
        }
    }

    /// Puts a ball where it says, if something has been done to it; `on_scenery`: by scenery as well.
    pub(super) fn tell_ball(&self, bodies: &mut Bodies<'_>, row: usize, on_scenery: bool) {
        if !self.moves() || !(self.center + self.velocity).is_finite() {
            return;
        }
        if self.pressed != 0 {
            bodies.position[row] = self.center;
        }
        if self.pressed != 0 || bodies.velocity[row] != self.velocity {
            bodies.velocity[row] = self.velocity;
            bodies.marks[row] |= SHIFTED;
        }
        if on_scenery {
            bodies.mark_touching(row);
        }
    }

    /// Looks which of its particles live; tells whether that is news.
    pub(super) fn look(&mut self, bodies: &Bodies<'_>, of: &RigidBox, places: &mut [u32]) -> bool {
        if self.known == 0 {
            self.learn(bodies, of, places);
        }
        let made = Made { of, places };
        let (mut living, mut is_sound) = (0, true);
        if let Some(rows) = made.run(bodies) {
            let [at, moving] = [&bodies.position[rows.clone()], &bodies.velocity[rows]].map(bytemuck::cast_slice);
            let (at, moving): (&[f32], &[f32]) = (at, moving);
            let all = at.iter().zip(moving).zip(made.places);
            let is_none = |sum: f32| u32::from(!(sum.abs() < f32::INFINITY));
            is_sound = all.fold(0, |any, ((&x, &v), &place)| any | is_none(x + v + f32::from_bits(place))) == 0;
            living = of.count;
        } else {
            made.each(bodies, &mut |row, place| {
                living += 1;
                is_sound &= (bodies.position[row] + bodies.velocity[row] + place).is_finite();
            });
        }
        if self.known == living + 1 && is_sound == self.is_there() {
            return false;
        }
        self.known = living + 1;
        self.state = ABSENT;
        self.inverse_mass = 0.0;
        if living > 0 && is_sound {
            self.weigh(bodies, made);
        }
        true
    }

    /// Takes the places of its particles as they are.
    fn learn(&mut self, bodies: &Bodies<'_>, of: &RigidBox, places: &mut [u32]) {
        self.turn = Turn(of.turn).on(Vec3::ZERO).0;
        self.half = of.half;
        let back = Turn(self.turn).matrix().transpose();
        for (i, place) in places.chunks_exact_mut(3).enumerate() {
            if let Some(row) = bodies.row_of_start(of.first.saturating_add(i as u32)) {
                place.copy_from_slice(&(back * (bodies.position[row] - of.center)).to_array().map(f32::to_bits));
            }
        }
    }

    /// Finds its mass, inertia and motion by its particles.
    fn weigh(&mut self, bodies: &Bodies<'_>, made: Made<'_>) {
        let (mut mass, mut is_free, mut first) = (0.0, true, None);
        made.each(bodies, &mut |row, place| {
            mass += bodies.mass[row];
            is_free &= bodies.inverse_mass[row] > 0.0;
            first.get_or_insert((row, place));
        });
        let Some((row, place)) = first.filter(|_| mass > 0.0 && mass < f32::INFINITY) else { return };
        (self.center, self.velocity, self.rest) = (bodies.position[row], bodies.velocity[row], place);
        // Means of what is left of the last ones: rounding keeps shares of the mass from adding up to one.
        for _ in 0..2 {
            let (mut center, mut velocity, mut rest) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
            made.each(bodies, &mut |row, place| {
                let share = bodies.mass[row] / mass;
                center += (bodies.position[row] - self.center) * share;
                velocity += (bodies.velocity[row] - self.velocity) * share;
                rest += (place - self.rest) * share;
            });
            self.center += center;
            self.velocity += velocity;
            self.rest += rest;
        }
        self.rotation = Turn(self.turn).matrix();
        let (mut spread, mut spin) = (Mat3::ZERO, Vec3::ZERO);
        made.each(bodies, &mut |row, place| {
            let (share, place) = (bodies.mass[row] / mass, place - self.rest);
            spread += outer(place * share, place);
            spin += (self.rotation * place).cross(bodies.velocity[row] - self.velocity) * share;
        });
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| solve(spread, axis));
        (self.spread, self.spin) = (spread, spin);
        self.inverse_inertia = Mat3::from_cols(axes[0], axes[1], axes[2]);
        let reach = self.half + self.rest.abs();
        self.radius = length(reach);
        self.elasticity = bodies.elasticity[row];
        self.material = u32::from(bodies.material[row]);
        (self.state, self.inverse_mass) = (MOVING, 1.0 / mass);
        if !is_free {
            (self.state, self.inverse_mass) = (FIXED, 0.0);
            (self.velocity, self.spin) = (Vec3::ZERO, Vec3::ZERO);
        }
        self.face();
    }

    /// Follows its turn: rotation, inertia in the world, rate of turning.
    pub(super) fn face(&mut self) {
        self.rotation = Turn(self.turn).matrix();
        self.inverse = self.rotation * self.inverse_inertia * self.rotation.transpose();
        if !self.moves() {
            self.inverse = Mat3::ZERO;
        }
        self.omega = self.inverse * self.spin + Vec3::ZERO;
    }

    /// Takes in what has been done to its particles since they were last told where to be: what the method did by the forces, and others.
    /// Without any of that they are, to the bit, where it says, and its momenta stay as they are.
    pub(super) fn gather(&mut self, bodies: &Bodies<'_>, made: Made<'_>) {
        self.begin();
        if self.moves() {
            self.take(self.sums(bodies, made), bodies.substep.seconds());
        }
    }

    /// Begins a sub-step.
    pub(super) fn begin(&mut self) {
        self.before = [self.velocity, self.omega];
        self.pressed = 0;
        self.blow.begun = self.vigour();
    }

    /// Its kinetic energy over its mass \[m²/s²\].
    pub(super) fn vigour(&self) -> f32 {
        0.5 * (self.velocity.dot(self.velocity) + self.omega.dot(self.spin))
    }

    /// Counts what forces have given a ball, whose drive nobody knows, to what it began with.
    pub(super) fn count_forces(&mut self) {
        self.blow.begun = max(self.blow.begun, self.vigour());
    }

    /// Takes in what has been done to its particles in a sub-step of so many seconds: what [`gather`](Self::gather) sums up.
    pub(super) fn take(&mut self, [way, push, torque]: [Vec3; 3], seconds: f32) {
        if !(way + push + torque).is_finite() {
            self.state = ABSENT;
            self.inverse_mass = 0.0;
            self.asleep = 0;
            return;
        }
        self.drive = [push, torque].map(|change| change * (1.0 / seconds));
        // What is −0 becomes 0, here and where a body has turned: impulses of zero change nothing then.
        self.velocity = self.velocity + push + Vec3::ZERO;
        self.spin = self.spin + torque + Vec3::ZERO;
        self.omega = self.inverse * self.spin + Vec3::ZERO;
        self.drift = way - self.velocity * seconds;
    }

    /// How far its particles have gone from where it says, and how their velocities and angular momenta differ, as shares of its mass.
    fn sums(&self, bodies: &Bodies<'_>, made: Made<'_>) -> [Vec3; 3] {
        let mut sums = [Vec3::ZERO; 3];
        let mut add = |mass: f32, [position, velocity]: [Vec3; 2], place: Vec3| {
            let arm = self.rotation * (place - self.rest);
            let share = mass * self.inverse_mass;
            let change = (velocity - self.velocity_at(arm)) * share;
            sums[0] += (position - (self.center + arm)) * share;
            sums[1] += change;
            sums[2] += arm.cross(change);
        };
        if let Some(rows) = made.run(bodies) {
            let (masses, velocities) = (&bodies.mass[rows.clone()], &bodies.velocity[rows.clone()]);
            let moving = bodies.position[rows].iter().zip(velocities);
            for ((&mass, (&position, &velocity)), &[x, y, z]) in
                masses.iter().zip(moving).zip(made.places.as_chunks().0)
            {
                add(mass, [position, velocity], Vec3::from_array([x, y, z].map(f32::from_bits)));
            }
        } else {
            made.each(bodies, &mut |row, place| {
                add(bodies.mass[row], [bodies.position[row], bodies.velocity[row]], place);
            });
        }
        sums
    }

    /// Tells whether it goes anywhere.
    pub(super) fn goes(&self) -> bool {
        self.moves() && !(self.sleeps() && self.velocity == Vec3::ZERO && self.spin == Vec3::ZERO)
    }

    /// Moves its centre through the sub-step of `h` \[s\].
    pub(super) fn advance(&mut self, h: f32) {
        self.center += self.velocity * h;
        if self.pressed == 0 {
            self.center += self.drift;
        }
    }

    /// Moves it through the sub-step of `h` \[s\] by its velocity, and turns it so that its angular momentum stays (the discrete
    /// Moser-Veselov equation, as in [`ShapeMatching`](crate::ShapeMatching)). What turns too far for that in one, or is so thin that rounding leaves no
    /// answer, turns about its angular momentum.
    pub(super) fn go(&mut self, h: f32) {
        if !self.goes() {
            return;
        }
        self.advance(h);
        let (last, torque) = (Turn(self.turn), self.spin * h);
        if torque != Vec3::ZERO {
            let turn = keeping(last, self.rotation * self.spread, torque, None);
            self.turn = turn.unwrap_or_else(|| last.on(self.about_momentum() * h)).0;
        }
        self.face();
    }

    /// How it turns about its angular momentum \[rad/s\], which keeps its energy however far it turns.
    fn about_momentum(&self) -> Vec3 {
        self.spin * (dot(self.spin, self.omega) / dot(self.spin, self.spin))
    }

    /// Tells whether it can say where its particles are.
    pub(super) fn tells(&self) -> bool {
        self.moves() && (self.center + self.velocity + self.omega).is_finite()
    }

    /// Puts its particles where it says.
    pub(super) fn tell(&self, bodies: &mut Bodies<'_>, made: Made<'_>) {
        if !self.tells() {
            return;
        }
        let run = made.run(bodies);
        for (i, &[x, y, z]) in made.places.as_chunks().0.iter().enumerate() {
            let one = || bodies.row_of_start(made.of.first.saturating_add(i as u32));
            let Some(row) = run.as_ref().map_or_else(one, |rows| Some(rows.start + i)) else { continue };
            let arm = self.rotation * (Vec3::from_array([x, y, z].map(f32::from_bits)) - self.rest);
            bodies.position[row] = self.center + arm;
            bodies.velocity[row] = self.velocity_at(arm);
            bodies.marks[row] |= SHIFTED | CARRIED;
        }
    }

    /// The least of its half sides \[m\].
    pub(super) fn least(&self) -> f32 {
        min(self.half.x, min(self.half.y, self.half.z))
    }

    /// A length that is small beside its box \[m\].
    pub(super) fn small(&self) -> f32 {
        self.small_for(self.half)
    }

    /// The same beside a part of it of these half sides \[m\].
    pub(super) fn small_for(&self, half: Vec3) -> f32 {
        max(min(half.x, min(half.y, half.z)) * 0.02, f32::EPSILON * sqrt(self.center.dot(self.center)))
    }
}
