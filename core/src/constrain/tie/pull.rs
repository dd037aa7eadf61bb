//! Pulls of a tied rope at the bodies of its ends: solved with these as heavy as they are there, and again where other ropes have pulled them since.

use super::super::bodies::Change;
use super::super::rope::Held;
use super::super::walls::{self, Wall};
use super::super::{Bodies, Kept, Rope, Share};
use super::grip::Grip;
use super::{Tie, TiedRope};
use crate::math::{largest, length, max};
use crate::memory::take_vectors;
use glam::Vec3;

/// How far a body may be from an end when all ropes have been solved, in links, and in roundings of where it is.
const NEAR: f32 = 1e-4;
const ROUNDINGS: f32 = 16.0;

/// A rope's part in a phase.
type Phase<P, L> = fn(&Rope<P, L>, &mut Bodies<'_>, &mut Share<'_>, &[Option<Held>]);

/// A tie's part in a phase.
type TiePhase<T, W> = fn(&Tie<T, W>, &mut Bodies<'_>, &[u32]) -> Option<()>;

/// A tied end of a rope while that is solved.
struct Joint {
    end: usize,
    row: usize,
    held: Held,
    grip: Grip,
    /// Where the end was before, and how fast.
    was: [Vec3; 2],
}

impl<P: AsRef<[u32]>, L: AsRef<[f32]>, T: AsRef<[u32]>, W: AsRef<[f32]>> TiedRope<P, L, T, W> {
    /// How a tied end is joined to its body; none if it is not rigidly.
    fn joint(&self, bodies: &Bodies<'_>, end: usize, kept: &[u32], back: f32) -> Option<Joint> {
        let (_, tie, place) = self.ties(kept).find(|(number, ..)| *number == end)?;
        // What is a body of its own keeps its form; one of three corners or less is drawn out of it.
        let is_one = tie.to.as_ref().len() > 3;
        let grip = |back| {
            let (rows, grip) = tie.grip(bodies, place, back)?;
            Some((rows, if is_one { grip.as_one() } else { grip }))
        };
        // It is as heavy as in the middle of the sub-step: what turns is lighter by then, or heavier, and would be pulled too far.
        let (([row, _], grip), (_, middle)) = (grip(back)?, grip(0.5 * back)?);
        let was = [bodies.position[row], bodies.velocity[row]];
        let is_rigid = tie.compliance == 0.0 && grip.own > 0.0;
        is_rigid.then_some(Joint { end, row, held: middle.held(bodies.mass[row])?, grip, was })
    }

    /// How its tied ends are joined to their bodies.
    fn joints(&self, bodies: &Bodies<'_>, kept: &[u32], back: f32) -> [Option<Joint>; 2] {
        [0, 1].map(|end| self.joint(bodies, end, kept, back))
    }

    /// Lets ties act, or the rigid ones alone: before the rope does, since ends have to be at their places and as fast to go with them. What a soft tie
    /// brakes it brakes once.
    fn tie_up(&self, bodies: &mut Bodies<'_>, kept: &[u32], rigid_alone: bool, act: TiePhase<T, W>) {
        for (_, tie, place) in self.ties(kept).filter(|(_, tie, _)| !rigid_alone || tie.compliance == 0.0) {
            let _ = act(tie, bodies, place);
        }
    }

    /// Lets the rope do something while its ends are as heavy as what they are tied to.
    fn with(&self, joints: &[Option<Joint>; 2], bodies: &mut Bodies<'_>, share: &mut Share<'_>, then: Phase<P, L>) {
        let held = joints.each_ref().map(|joint| joint.as_ref().map(|joint| joint.held));
        // Nothing is kept of the rope.
        let (kept, step) = (Kept::default(), share.step.get_mut(self.words()..).unwrap_or_default());
        then(&self.rope, bodies, &mut Share { kept, step, scratch: share.scratch, capacity: share.capacity }, &held);
    }

    /// Gives the body that an end is tied to what an impulse at the place does.
    fn give(&self, bodies: &mut Bodies<'_>, (end, kept): (usize, &[u32]), (grip, what): (&Grip, Change), pull: Vec3) {
        let tie = self.ties(kept).find(|(number, ..)| *number == end);
        if let Some((_, tie, place)) = tie.filter(|_| pull.is_finite()) {
            tie.push(bodies, place, grip, pull, |bodies, row, by| bodies.change(what, row, by));
        }
    }

    /// Puts off what an impulse at the place of an end does to its body.
    fn postpone(&self, bodies: &mut Bodies<'_>, (end, kept): (usize, &[u32]), grip: &Grip, pull: Vec3) {
        let tie = self.ties(kept).find(|(number, ..)| *number == end);
        if let Some((_, tie, place)) = tie.filter(|_| pull != Vec3::ZERO) {
            tie.push(bodies, place, grip, pull, |bodies, row, by| {
                bodies.postpone(row, by);
            });
        }
    }

    /// Gives bodies what has been put off of what the rope has pulled.
    fn give_later(&self, bodies: &mut Bodies<'_>, kept: &[u32], pulls: &[[Vec3; 2]]) {
        for (end, &[_, pull]) in pulls.iter().enumerate().filter(|(_, pull)| pull[1] != Vec3::ZERO) {
            if let Some(Joint { grip, .. }) = self.joint(bodies, end, kept, 0.0) {
                self.postpone(bodies, (end, kept), &grip, -pull);
                self.give(bodies, (end, kept), (&grip, Change::Velocity), pull);
            }
        }
    }

    /// The memory that lasts through a sub-step: the impulse that the rope has pulled with at each end \[kg m\], and what of it is put off until velocities are settled \[kg m/s\]; and where
    /// each of its particles was before, and how fast.
    fn memory<'m>(&self, step: &'m mut [u32]) -> (&'m mut [[Vec3; 2]], &'m mut [[Vec3; 2]]) {
        let mut step = step;
        let pulls = take_vectors(&mut step, 4);
        let before = take_vectors(&mut step, 2 * self.rope.particles.as_ref().len());
        (pulls.as_chunks_mut().0, before.as_chunks_mut().0)
    }

    /// Words that last through a sub-step.
    pub(super) fn words(&self) -> usize {
        self.rope.particles.as_ref().len().saturating_mul(6).saturating_add(12)
    }

    /// Tells whether a body has been moved away from an end by another rope, by more than may be left.
    pub(super) fn is_drawn(&self, bodies: &Bodies<'_>, kept: &[u32]) -> bool {
        let longest = self.rope.lengths.as_ref().iter().copied().fold(0.0, max);
        self.ties(kept).filter(|(_, tie, _)| tie.compliance == 0.0).any(|(_, tie, place)| {
            let row = |number: Option<&u32>| bodies.row_of_start(*number?);
            let rows = row(Some(&tie.particle)).zip(row(tie.to.as_ref().first()));
            rows.is_some_and(|(tied, first)| {
                let open = tie.open(bodies, place, [tied, first]).map_or(0.0, length);
                let rounding = ROUNDINGS * f32::EPSILON * largest(bodies.position[tied]);
                open > NEAR * longest + rounding && open < f32::INFINITY
            })
        })
    }

    /// How much faster others will yet make the place of an end \[m/s\].
    fn ahead(&self, bodies: &Bodies<'_>, (end, kept): (usize, &[u32])) -> Vec3 {
        let faster = self.ties(kept).find(|(number, ..)| *number == end).and_then(|(_, tie, place)| {
            let first = bodies.row_of_start(*tie.to.as_ref().first()?)?;
            Some(tie.mean(bodies, place, first, |row| bodies.postponed(row)))
        });
        faster.filter(|faster| faster.is_finite()).unwrap_or_default()
    }

    /// Lets an end go ahead as fast as that, against the body, which takes it along when it does.
    fn lead(&self, bodies: &mut Bodies<'_>, kept: &[u32], joint: &mut Joint) -> Vec3 {
        let faster = self.ahead(bodies, (joint.end, kept));
        let tie = self.ties(kept).find(|(number, ..)| *number == joint.end);
        if let Some((_, tie, place)) = tie.filter(|_| faster != Vec3::ZERO) {
            let pull = faster / joint.grip.own;
            tie.act(bodies, place, &joint.grip, pull, |bodies, row, by| bodies.velocity[row] += by);
            joint.was[1] = bodies.velocity[joint.row];
        }
        faster
    }

    /// Brings ends to their places, and solves the rope from there; `again` if others have moved bodies since.
    pub(super) fn pull(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, again: bool) {
        self.tie_up(bodies, share.kept.fixed, true, Tie::close);
        let (_, before) = self.memory(share.step);
        for (&number, before) in self.rope.particles.as_ref().iter().zip(before) {
            *before = bodies.row_of_start(number).map_or([Vec3::ZERO; 2], |row| state(bodies, row));
        }
        self.solve(bodies, share);
        self.tie_again(bodies, (share.kept.fixed, share.step), again);
    }

    /// Gives bodies what has been put off, and takes out of velocities what makes links longer.
    pub(super) fn settle_pulls(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        // In no time nobody has pulled.
        if bodies.substep.seconds() > 0.0 {
            self.give_later(bodies, share.kept.fixed, self.memory(share.step).0);
        }
        self.tie_up(bodies, share.kept.fixed, true, Tie::brake);
        let mut joints = self.joints(bodies, share.kept.fixed, 0.0);
        let mut ahead = [Vec3::ZERO; 2];
        for joint in joints.iter_mut().flatten() {
            ahead[joint.end] = self.lead(bodies, share.kept.fixed, joint);
        }
        self.with(&joints, bodies, share, Rope::settle_held);
        for &Joint { end, row, ref held, ref grip, was } in joints.iter().flatten() {
            let faster = held.mass * (bodies.velocity[row] - was[1]);
            self.give(bodies, (end, share.kept.fixed), (grip, Change::Velocity), faster);
        }
        joints.iter().flatten().for_each(|joint| bodies.velocity[joint.row] -= ahead[joint.end]);
        self.tie_up(bodies, share.kept.fixed, false, Tie::brake);
        joints.iter().flatten().for_each(|joint| bodies.velocity[joint.row] += ahead[joint.end]);
    }

    /// Tells whether the scenery may press the rope: what it has given cannot be taken back.
    pub(super) fn is_by_walls(&self, step: &mut [u32]) -> bool {
        let walls = step.get_mut(self.words()..).unwrap_or_default();
        walls::of(walls, self.rope.particles.as_ref().len()).iter().any(Wall::is_near)
    }

    /// Solves the rope where its ends are at their places, and gives bodies what it pulls.
    fn solve(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let (h, kept) = (bodies.substep.seconds(), &*share.kept.fixed);
        let mut joints = self.joints(bodies, kept, h);
        let mut ahead = [Vec3::ZERO; 2];
        for Joint { end, row, was, .. } in joints.iter_mut().flatten() {
            ahead[*end] = self.ahead(bodies, (*end, kept));
            bodies.velocity[*row] += ahead[*end];
            was[1] = bodies.velocity[*row];
        }
        self.with(&joints, bodies, share, Rope::close);
        let kept = &*share.kept.fixed;
        let (pulls, _) = self.memory(share.step);
        pulls.fill([Vec3::ZERO; 2]);
        for &Joint { end, row, ref held, ref grip, was } in joints.iter().flatten() {
            let [moved, faster] = [bodies.position[row] - was[0], bodies.velocity[row] - was[1]];
            // What the end has got faster beyond how far it has moved came later: it acts where all are by then, as the forces of links do on particles, and
            // does not move anybody in this sub-step.
            let pull = [held.mass * moved, held.mass * (faster - moved * (1.0 / h))];
            if let Some(pulled) = pulls.get_mut(end).filter(|_| pull.iter().all(|part| part.is_finite())) {
                *pulled = pull;
                self.give(bodies, (end, kept), (grip, Change::Place), pull[0]);
                self.postpone(bodies, (end, kept), grip, pull[1]);
            }
            bodies.velocity[row] -= ahead[end];
        }
    }

    /// Lets ties act behind the rope; soft ones do so once. What they give its ends these keep, when what the rope has pulled is taken back.
    fn tie_again(&self, bodies: &mut Bodies<'_>, (kept, step): (&[u32], &mut [u32]), rigid_alone: bool) {
        let (_, before) = self.memory(step);
        let particles = self.rope.particles.as_ref();
        let ends = [0, particles.len().saturating_sub(1)];
        let solved = ends.map(|end| bodies.row_of_start(*particles.get(end)?).map(|row| (row, state(bodies, row))));
        self.tie_up(bodies, kept, rigid_alone, Tie::close);
        for (end, (row, [place, fast])) in ends.into_iter().zip(solved).filter_map(|(end, of)| Some((end, of?))) {
            if let Some([x, v]) = before.get_mut(end) {
                *x += bodies.position[row] - place;
                *v += bodies.velocity[row] - fast;
            }
        }
    }

    /// Takes back what the rope has pulled, and puts its particles to where they were before.
    pub(super) fn take_back(&self, bodies: &mut Bodies<'_>, kept: &[u32], step: &mut [u32]) {
        let joints = self.joints(bodies, kept, bodies.substep.seconds());
        let (pulls, before) = self.memory(step);
        for (joint, [moving, later]) in joints.iter().zip(pulls) {
            if let Some(Joint { end, grip, .. }) = joint {
                self.give(bodies, (*end, kept), (grip, Change::Place), -*moving);
                self.postpone(bodies, (*end, kept), grip, -*later);
            }
        }
        for (&number, [position, velocity]) in self.rope.particles.as_ref().iter().zip(before) {
            if let Some(row) = bodies.row_of_start(number) {
                (bodies.position[row], bodies.velocity[row]) = (*position, *velocity);
            }
        }
    }
}

/// Where a particle is, and how fast.
fn state(bodies: &Bodies<'_>, row: usize) -> [Vec3; 2] {
    [bodies.position[row], bodies.velocity[row]]
}
