//! Contacts held by position: the passes over them in each sub-step.

mod at_rest;
mod bounces;
mod report;

use super::super::Bodies;
use super::super::union::{root, unite};
use super::lists::{Face, Kept, Listed, Pair};
use super::touch::{hold_back, passed};
use crate::index::{Room, between};
use crate::math::{aside, largest, length, max, min, sqrt, unit};
use crate::shape::Collider;
use crate::time::Time;
use glam::Vec3;

/// Sweeps over the velocities at a step's end, so that what rests shows it.
const SETTLING: u32 = 2;
/// How often a face is turned to where a particle struck it.
const TURNS: u32 = 2;
/// How much lighter the lower of two that rest on each other counts for each other, as a share.
const SUPPORT: f32 = 0.6;
/// The number of roundings that each particle's velocity may have gone through. Gravity that adds less than that in a sub-step, in one of a hundredth of a
/// frame where all fall at some 850 m/s, counts for none.
const ROUNDINGS: f32 = 8.0;

/// By how much the changes of velocities may differ that count as one, as a share.
const EVEN: f32 = 0.01;

/// Moves what overlaps apart, and lets velocities follow.
pub(super) fn project(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, compliance: f32) {
    let (len, h) = (bodies.len(), bodies.substep.seconds());
    kept.pushed[..len].copy_from_slice(bodies.velocity);
    kept.thrown[..len].copy_from_slice(bodies.velocity);
    kept.borne[..len].fill(Vec3::ZERO);
    kept.lists.hardest = 0.0;
    let [x, v] = bodies.before;
    for (row, drift) in kept.drift[..len].iter_mut().enumerate() {
        *drift = bodies.position[row] - x[row] - (v[row] + bodies.velocity[row]) * (0.5 * h);
    }
    kept.lists.driven = driven(bodies, kept);
    kept.round[..len].fill(0);
    let (mut pass, pairs, faces) = Pass::of(bodies, kept, compliance);
    for face in faces {
        pass.move_from_face(face);
    }
    for pair in pairs {
        pass.move_apart(pair);
    }
}

/// By how much forces from outside have changed the velocity of all together that what stands still may bear \[m/s\]: the mean by mass, in which what two do to each
/// other is nothing, and so is what may be rounding. Else contacts would take that for weight, and share it out otherwise than momentum asks for. What others
/// go through is nothing to those, and nobody has weight whom nothing bears, unless all fall alike.
fn driven(bodies: &Bodies<'_>, kept: &mut Kept<'_>) -> Vec3 {
    let all = mean_change(bodies, |_| true);
    let most = EVEN * EVEN * all.dot(all);
    let mut changes = changes(bodies);
    if changes.all(|(_, change)| (change - all).length_squared() <= most) {
        return all;
    }
    let is_borne = find_borne(bodies, kept);
    mean_change(bodies, |row| is_borne[row] != 0)
}

/// The rows of those that can be moved, and how their velocities have changed \[m/s\]. A particle that is no longer finite must not reach the others before it is
/// taken out.
fn changes<'b>(bodies: &'b Bodies<'_>) -> impl Iterator<Item = (usize, Vec3)> + 'b {
    let changes = bodies.velocity.iter().zip(bodies.before[1]).map(|(&now, &before)| now - before).enumerate();
    changes.filter(|&(row, change)| bodies.inverse_mass[row] > 0.0 && (change * bodies.mass[row]).is_finite())
}

/// The mean by mass of how the velocities of some have changed \[m/s\], but for what may be rounding.
fn mean_change(bodies: &Bodies<'_>, counts: impl Fn(usize) -> bool) -> Vec3 {
    let (mut sum, mut whole, mut sizes) = (Vec3::ZERO, 0.0, 0.0);
    for (row, change) in changes(bodies).filter(|&(row, _)| counts(row)) {
        let mass = bodies.mass[row];
        (sum, whole) = (sum + change * mass, whole + mass);
        sizes += (largest(bodies.velocity[row]) + largest(bodies.before[1][row])) * mass;
    }
    let (mean, rounding) = (sum / whole, ROUNDINGS * f32::EPSILON * sizes);
    if mean.is_finite() && largest(sum) > rounding { mean } else { Vec3::ZERO }
}

/// 1 for all that may touch what stands still, or somebody who does, and so on; else 0.
fn find_borne<'k>(bodies: &Bodies<'_>, kept: &'k mut Kept<'_>) -> &'k [u32] {
    let (len, Listed { pairs, faces, .. }) = (bodies.len(), *kept.lists);
    let pairs = &kept.pairs[..pairs as usize];
    let moves = |row: &u32| bodies.inverse_mass[*row as usize] > 0.0;
    let bound = &mut kept.round[..len];
    bound.iter_mut().enumerate().for_each(|(row, to)| *to = row as u32);
    // What stands still is no part of what it bears.
    for &[a, b] in pairs.iter().map(|pair| &pair.rows).filter(|rows| rows.iter().all(moves)) {
        unite(bound, a, b);
    }
    let bears = &mut kept.owed[..len];
    bears.fill(Vec3::ZERO);
    let on_still = pairs.iter().filter(|pair| !pair.rows.iter().all(moves)).flat_map(|pair| pair.rows);
    for row in on_still.chain(kept.faces[..faces as usize].iter().map(|face| face.row)) {
        bears[root(bound, row) as usize] = Vec3::ONE;
    }
    for row in 0..len as u32 {
        bears[row as usize] = bears[root(bound, row) as usize];
    }
    bound.iter_mut().zip(&*bears).for_each(|(is_borne, bears)| *is_borne = u32::from(*bears != Vec3::ZERO));
    bound
}

/// Answers the approach of what touches by the elasticity and the slip by friction.
pub(super) fn settle(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, compliance: f32) {
    let (is_last, rough) = (bodies.substep.is_last(), kept.lists.rough != 0);
    let (mut pass, pairs, faces) = Pass::of(bodies, kept, compliance);
    let still_bounce = pass.bounce_on(pairs, faces);
    for face in faces.iter_mut().filter(|face| face.touch.is_on()) {
        let row = face.row as usize;
        // What was at rest may stay; what bounces higher than by what drives it does so along the normal by which its approach is known.
        if face.struck == 0 && face.given <= 2.0 * pass.calm && pass.v0[row] != face.velocity {
            face.turn(pass.colliders, pass.position[row], pass.radius[row], pass.now);
        }
    }
    let sweeps = if is_last { SETTLING } else { 1 };
    for sweep in 0..sweeps {
        pass.borne.fill(Vec3::ZERO);
        pass.owed.fill(Vec3::ZERO);
        faces.iter_mut().filter(|face| face.touch.is_on()).for_each(|face| pass.press_face(face));
        pairs.iter_mut().rev().filter(|pair| pair.touch.is_on()).for_each(|pair| pass.press_pair(pair));
        if is_last && sweep + 1 == sweeps {
            faces.iter_mut().filter(|face| face.touch.is_on()).for_each(|face| pass.rest_on_face(face));
            pairs.iter_mut().filter(|pair| pair.touch.is_on()).for_each(|pair| pass.rest_on_other(pair));
        }
        if rough {
            pairs.iter_mut().rev().filter(|pair| pair.touch.is_on()).for_each(|pair| pass.carry(pair));
        }
        faces.iter_mut().filter(|face| face.touch.rubs()).for_each(|face| pass.rub_face(face, sweep == 0));
        pairs.iter_mut().filter(|pair| pair.touch.rubs()).for_each(|pair| pass.rub_pair(pair, sweep == 0));
    }
    bodies.report.effort.capped += u64::from(still_bounce);
    report::report(bodies, kept);
}

/// One pass over the contacts of a sub-step.
struct Pass<'a> {
    /// Places and velocities before the sub-step.
    x0: &'a [Vec3],
    v0: &'a [Vec3],
    /// Velocities as the integrator left them.
    pushed: &'a [Vec3],
    /// Velocities that bounces alone, one after the other, make of these.
    thrown: &'a mut [Vec3],
    /// The round of bounces in which each was thrown last, and the one that goes on.
    rounds: &'a mut [u32],
    round: u32,
    /// How far positions are from where the mean of the velocities before and now leads \[m\]: by half of what forces do in
    /// the sub-step with methods of first order, hardly with others. Contacts take out what lies in their way.
    drift: &'a mut [Vec3],
    /// By how much the contacts below each have changed its velocity, and by how much more they would have if weights were
    /// not shared out as [`Pass::weights`] does \[m/s\].
    borne: &'a mut [Vec3],
    owed: &'a mut [Vec3],
    position: &'a mut [Vec3],
    velocity: &'a mut [Vec3],
    colliders: &'a dyn Collider,
    /// When the sub-step ends.
    now: Time,
    /// The room through whose sides they touch, if there is one.
    room: Option<&'a Room>,
    radius: &'a [f32],
    inverse_mass: &'a [f32],
    /// Against what drives all of them on average, and the speed that gives them in a step.
    up: Vec3,
    calm: f32,
    /// The sub-step, its inverse, and the whole step.
    h: f32,
    rate: f32,
    /// Compliance over h².
    softness: f32,
    long: f32,
    /// True if somebody is so fast that two could pass each other.
    fast: bool,
    /// The fastest bounce of the sub-step so far \[m/s\].
    hardest: &'a mut f32,
    /// The speed below which what others have thrown does not bounce on \[m/s\].
    least: f32,
}

impl<'a> Pass<'a> {
    /// A pass, and what it goes over.
    fn of<'k: 'a>(
        bodies: &'a mut Bodies<'_>,
        kept: &'k mut Kept<'_>,
        compliance: f32,
    ) -> (Self, &'k mut [Pair], &'k mut [Face]) {
        let (len, substep) = (bodies.len(), bodies.substep);
        let (lists, h) = (&mut *kept.lists, substep.seconds());
        let (pairs, faces) = (&mut kept.pairs[..lists.pairs as usize], &mut kept.faces[..lists.faces as usize]);
        let pass = Self {
            up: -unit(lists.driven),
            calm: substep.count as f32 * length(lists.driven),
            x0: bodies.before[0],
            v0: bodies.before[1],
            pushed: &kept.pushed[..len],
            thrown: &mut kept.thrown[..len],
            rounds: &mut kept.round[..len],
            round: 1,
            drift: &mut kept.drift[..len],
            borne: &mut kept.borne[..len],
            owed: &mut kept.owed[..len],
            position: bodies.position,
            colliders: bodies.colliders,
            now: substep.during[1],
            room: bodies.near.room(),
            velocity: bodies.velocity,
            radius: bodies.radius,
            inverse_mass: bodies.inverse_mass,
            h,
            rate: 1.0 / h,
            softness: compliance / (h * h),
            long: substep.step.seconds(),
            fast: lists.fast != 0,
            hardest: &mut lists.hardest,
            least: 0.0,
        };
        if lists.sorted == 0 {
            lists.sorted = 1;
            pass.sort(pairs);
        }
        (pass, pairs, faces)
    }

    #[inline(always)]
    fn move_apart(&mut self, pair: &mut Pair) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let (d, reach) = (self.apart(a, b), self.radius[a] + self.radius[b]);
        pair.touch.end();
        let slack = self.slack(a, reach);
        let Some((normal, overlap)) = self.overlap([a, b], d, [reach, slack]) else { return };
        let closing = max((self.velocity[b] - self.velocity[a]).dot(normal), 0.0);
        // Two that touch by rounding alone do so only to press.
        if !(overlap > 0.0 || overlap > -slack && closing > 0.0) {
            return;
        }
        let parting = (self.thrown[a] - self.thrown[b]).dot(normal);
        let calm = parting.abs() <= self.calm;
        pair.lean = if calm { SUPPORT * self.hardness(a, b) * normal.dot(self.up) } else { 0.0 };
        let (wa, wb) = self.weights(pair);
        let lag = self.catch_up(a, normal) - self.catch_up(b, normal);
        let moved = max(overlap + lag, 0.0) * ((wa + wb) / (wa + wb + self.softness));
        let felt = min(moved * self.rate, closing + self.calm);
        let drift = (self.drift[a] - self.drift[b]).dot(normal);
        let [from_a, from_b] = if calm { [normal; 2] } else { self.ways(a, b, normal) };
        let way = moved / (from_a.dot(normal) * wa + from_b.dot(normal) * wb);
        self.position[a] += from_a * (way * wa);
        self.position[b] -= from_b * (way * wb);
        pair.touch.begin(0.0);
        pair.given = 0.0;
        if parting < 0.0 {
            let driven = |row: usize| self.v0[row] - self.pushed[row];
            let work = (wa + wb) * way * (driven(a).dot(from_a) - driven(b).dot(from_b));
            self.bounce_pair(pair, normal, work + (driven(a) - driven(b)).dot(normal) * drift);
        }
        let felt = max(felt - pair.given, 0.0);
        pair.touch.give(felt);
        // Who is stopped is so by what bears the other as well, unless that comes up.
        let stands = |row: usize| self.thrown[row].dot(self.borne[row]) <= self.calm;
        if pair.given == 0.0 && !calm && stands(a) && stands(b) {
            pair.lean = (from_a - from_b).dot(normal);
        }
        let (wa, wb) = self.weights(pair);
        let share = normal * (1.0 / (wa + wb));
        self.velocity[a] += share * (felt * wa);
        self.velocity[b] -= share * (felt * wb);
        if self.softness > 0.0 {
            return;
        }
        let drift = share * drift;
        self.drift[a] -= drift * wa;
        self.drift[b] += drift * wb;
    }

    fn move_from_face(&mut self, face: &mut Face) {
        let row = face.row as usize;
        let (w, radius) = (self.inverse_mass[row], self.radius[row]);
        face.touch.end();
        let Some((mut overlap, mut closing)) = self.meets(face) else { return };
        // What comes faster than by what drives it is answered as the surface is where it has touched that: the face is another on the way there.
        for _ in 0..if closing > self.calm { TURNS } else { 0 } {
            let back = (self.velocity[row] - face.velocity) * min(max(overlap, 0.0) / closing, self.h);
            face.turn(self.colliders, self.position[row] - back, radius, self.now);
            let Some(turned) = self.meets(face) else { return };
            (overlap, closing) = turned;
        }
        face.struck = u32::from(closing > self.calm && self.gap(face) > self.slack(row, radius));
        let lag = self.catch_up(row, face.normal);
        let moved = max(overlap + lag, 0.0) * (w / (w + self.softness));
        let felt = min(moved * self.rate, closing + self.calm);
        self.position[row] += face.normal * moved;
        face.touch.begin(0.0);
        face.given = 0.0;
        let driven = (self.v0[row] - self.pushed[row]).dot(face.normal);
        self.bounce_face(face, driven * (moved + self.drift[row].dot(face.normal)));
        if self.borne[row].dot(self.up) <= face.normal.dot(self.up) {
            self.borne[row] = face.normal;
        }
        let felt = max(felt - face.given, 0.0);
        face.touch.give(felt);
        self.velocity[row] += face.normal * felt;
        if self.softness == 0.0 {
            self.drift[row] = aside(self.drift[row], face.normal);
        }
    }

    /// How far a particle and a face overlap, and how fast they come together, if they touch.
    fn meets(&self, face: &Face) -> Option<(f32, f32)> {
        let row = face.row as usize;
        let overlap = self.radius[row] - (self.position[row].dot(face.normal) - face.offset);
        let closing = max((face.velocity - self.velocity[row]).dot(face.normal), 0.0);
        (overlap > 0.0 || overlap > -self.slack(row, self.radius[row]) && closing > 0.0).then_some((overlap, closing))
    }

    /// How far a particle was from a face before the sub-step \[m\].
    fn gap(&self, face: &Face) -> f32 {
        let row = face.row as usize;
        (self.x0[row] + face.velocity * self.h).dot(face.normal) - face.offset - self.radius[row]
    }

    /// Moves a particle along the normal of a soft contact to where its velocity leads, and tells how far behind it was \[m\]. A contact answers forces
    /// by what they do in a whole sub-step to its overlap, as a method of first order shows it: others show half of that or none, and what
    /// rests would sink in by as much too little.
    fn catch_up(&mut self, row: usize, normal: Vec3) -> f32 {
        if !(self.softness > 0.0 && self.inverse_mass[row] > 0.0) {
            return 0.0;
        }
        let ahead = (self.v0[row] - self.pushed[row]) * (0.5 * self.h);
        let lag = (self.drift[row] + ahead).dot(normal);
        self.position[row] -= normal * lag;
        self.drift[row] -= normal * lag;
        lag
    }

    /// How much two that touch count as hard: those that give way by far more than gravity moves them in a sub-step need no support.
    fn hardness(&self, a: usize, b: usize) -> f32 {
        let whole = self.inverse_mass[a] + self.inverse_mass[b];
        let square = (whole / (whole + self.softness)) * (whole / (whole + self.softness));
        square * square
    }

    /// Puts pairs in their order from the ground up, the same whatever order they were found in.
    fn sort(&self, pairs: &mut [Pair]) {
        for pair in &mut *pairs {
            let [a, b] = pair.rows.map(|row| self.position[row as usize].dot(self.up));
            // Until they touch it is their height.
            pair.lean = max(a, b);
        }
        pairs.sort_unstable_by(|one, other| one.lean.total_cmp(&other.lean).then(one.rows.cmp(&other.rows)));
    }

    /// Passes on what weighs on the upper of two beyond what its contacts feel, for friction to count it in.
    #[inline(always)]
    fn carry(&mut self, pair: &mut Pair) {
        let ([a, b], normal) = self.ends(pair);
        let (upper, lower, up) = if pair.lean > 0.0 { (a, b, normal) } else { (b, a, -normal) };
        pair.touch.carry(if pair.lean == 0.0 { 0.0 } else { self.burden(upper) });
        let (wa, wb) = self.weights(pair);
        let missing = pair.touch.load() - pair.touch.pressed() * (1.0 - pair.lean.abs());
        self.owed[lower] -= up * (missing * self.inverse_mass[lower] / (wa + wb));
    }

    /// The weight on a particle beyond what its contacts feel, as a multiple of that.
    fn burden(&self, row: usize) -> f32 {
        let borne = self.borne[row];
        let square = borne.dot(borne);
        if square > 0.0 { max(-self.owed[row].dot(borne) / square, 0.0) } else { 0.0 }
    }

    /// How far apart two may be by rounding that touch \[m\].
    fn slack(&self, row: usize, reach: f32) -> f32 {
        4.0 * f32::EPSILON * (largest(self.position[row]) + reach)
    }

    /// By how much each of two gives way. Of two that rest on each other the lower one counts as heavier: then a heap carries
    /// itself from the ground up, and needs no more sub-steps the higher it is (Macklin et al., "Unified Particle Physics
    /// for Real-Time Applications", SIGGRAPH 2014, section 5.3). Of two that meet faster than they could by their weight in a
    /// step each counts as it is.
    #[inline(always)]
    fn weights(&self, Pair { rows: [a, b], lean, .. }: &Pair) -> (f32, f32) {
        let (wa, wb) = (self.inverse_mass[*a as usize], self.inverse_mass[*b as usize]);
        if *lean > 0.0 { (wa, wb * (1.0 - lean)) } else { (wa * (1.0 + lean), wb) }
    }

    /// Takes from two what they come together with.
    #[inline(always)]
    fn press_pair(&mut self, pair: &mut Pair) {
        let ([a, b], normal) = self.ends(pair);
        let change = pair.touch.part(pair.given, (self.velocity[a] - self.velocity[b]).dot(normal));
        let (wa, wb) = self.weights(pair);
        let share = normal * (1.0 / (wa + wb));
        self.velocity[a] += share * (change * wa);
        self.velocity[b] -= share * (change * wb);
        if pair.lean != 0.0 {
            let (upper, side) = if pair.lean > 0.0 { (a, wa) } else { (b, -wb) };
            self.borne[upper] += share * (pair.touch.pressed() * side);
        }
    }

    fn press_face(&mut self, face: &mut Face) {
        let row = face.row as usize;
        let parting = (self.velocity[row] - face.velocity).dot(face.normal);
        let change = face.touch.part(face.given, parting);
        self.velocity[row] += face.normal * change;
        self.borne[row] += face.normal * face.touch.pressed();
    }

    /// Takes from the slip of two what friction can.
    #[inline(always)]
    fn rub_pair(&mut self, pair: &mut Pair, first: bool) {
        let ([a, b], normal) = self.ends(pair);
        let (fa, fb) = self.weights(pair);
        let whole = fa + fb;
        let (wa, wb) = (self.inverse_mass[a], self.inverse_mass[b]);
        let inverse = 1.0 / (wa + wb);
        let slip = aside(self.velocity[a] - self.velocity[b], normal);
        let taken = pair.touch.hold(slip, (wa + wb) / whole);
        let share = taken * inverse;
        self.velocity[a] += share * wa;
        self.velocity[b] -= share * wb;
        if !first {
            return;
        }
        let drift = aside(self.drift[a] - self.drift[b], normal);
        let back = hold_back(taken, drift, self.h);
        let (share, drift) = (back * inverse, (back - taken * (0.5 * self.h)) * inverse);
        self.position[a] += share * wa;
        self.position[b] -= share * wb;
        self.drift[a] += drift * wa;
        self.drift[b] -= drift * wb;
        if taken == -slip && wa * wb == 0.0 && pair.given == 0.0 {
            let reach = self.radius[a] + self.radius[b];
            let gap = length(between(self.room, self.x0[b], self.x0[a])) - reach;
            let [row, other] = if wa > 0.0 { [a, b] } else { [b, a] };
            let way = self.position[other] - self.x0[other];
            let touched = gap.abs() <= self.slack(a, reach);
            self.keep(row, self.velocity[other], touched && self.v0[row] == self.v0[other], way);
        }
    }

    fn rub_face(&mut self, face: &mut Face, first: bool) {
        let (row, normal) = (face.row as usize, face.normal);
        let slip = aside(self.velocity[row] - face.velocity, normal);
        face.touch.carry(self.burden(row));
        let taken = face.touch.hold(slip, 1.0);
        self.velocity[row] += taken;
        if !first {
            return;
        }
        let back = hold_back(taken, aside(self.drift[row], normal), self.h);
        self.position[row] += back;
        self.drift[row] += back - taken * (0.5 * self.h);
        if taken == -slip && face.given == 0.0 {
            let touched = self.gap(face).abs() <= self.slack(row, self.radius[row]);
            self.keep(row, face.velocity, touched && self.v0[row] == face.velocity, face.velocity * self.h);
        }
    }

    /// The way from the second of two to the first when the sub-step began, and now that it is `d`: to the same image, though another may be nearer
    /// by now.
    fn way(&self, a: usize, b: usize, d: Vec3) -> (Vec3, Vec3) {
        let from = between(self.room, self.x0[b], self.x0[a]);
        let went = |row: usize| self.position[row] - self.x0[row];
        (from, if self.room.is_some() { from + (went(a) - went(b)) } else { d })
    }

    /// The direction from the second of two to the first, and by how far they overlap along it, if they touch or have passed each other.
    #[inline(always)]
    fn overlap(&self, [a, b]: [usize; 2], d: Vec3, [reach, slack]: [f32; 2]) -> Option<(Vec3, f32)> {
        let square = d.dot(d);
        if square < (reach + slack) * (reach + slack) {
            if let Some(side) = self.side(a, b, d) {
                return Some((side, reach - d.dot(side)));
            }
            let distance = sqrt(square);
            // The one with the higher row goes up if two are in one place.
            let upward = if a > b { Vec3::Y } else { Vec3::NEG_Y };
            return Some((if distance > 0.0 { d * (1.0 / distance) } else { upward }, reach - distance));
        }
        if !(self.fast && square > 0.0) {
            return None;
        }
        let (from, to) = self.way(a, b, d);
        passed(from, to, reach).map(|normal| (normal, reach - to.dot(normal)))
    }

    /// The direction from the second of two to the first when the sub-step began, if their centres have passed each other since.
    #[inline(always)]
    fn side(&self, a: usize, b: usize, d: Vec3) -> Option<Vec3> {
        if !self.fast {
            return None;
        }
        let (from, to) = self.way(a, b, d);
        (from.dot(to) < 0.0).then(|| unit(from))
    }

    /// The way from the second of two to the first.
    #[inline(always)]
    fn apart(&self, a: usize, b: usize) -> Vec3 {
        between(self.room, self.position[b], self.position[a])
    }

    fn ends(&self, pair: &Pair) -> ([usize; 2], Vec3) {
        let [a, b] = pair.rows.map(|row| row as usize);
        let d = self.apart(a, b);
        ([a, b], d * (1.0 / max(length(d), f32::MIN_POSITIVE)))
    }

    /// Gives what friction holds the velocity of what holds it. What was at rest on that and stays so has gone its way and no
    /// other: rounding would let it creep.
    #[inline(never)]
    fn keep(&mut self, row: usize, velocity: Vec3, rests: bool, way: Vec3) {
        self.velocity[row] = velocity;
        if rests {
            self.position[row] = self.x0[row] + way;
        }
    }
}
