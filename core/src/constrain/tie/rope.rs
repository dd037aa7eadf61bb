//! Ropes whose ends are tied to other bodies: their direct solution feels how heavy these are.

use super::super::bodies::Change;
#[cfg(feature = "alloc")]
use super::super::declared::{Declared, names_twice};
use super::super::rope::Held;
use super::super::{Bodies, Constraint, Demand, Kept, Rope, Share, Words};
use super::Tie;
use super::grip::Grip;
use crate::math::clamp;
use crate::memory::take_vectors;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use glam::Vec3;

/// A rope of which one end or both are tied to a body, however heavy that is.
///
/// A [`Rope`] and a [`Tie`] behind it are met one after the other, and give way under what is heavier than the rope's end. Here an end that is tied rigidly has, while the rope is
/// solved, the mass of itself and of the body at its place, in each direction: m + W⁻¹, where an impulse J moves the place by W J. The body gets its share of what the rope does to that,
/// with equal impulses at the place, half of it as velocities are settled, and then the ties are met. Linear and angular momentum are kept as they are by both alone. Soft ties are met behind the rope.
/// Without ties it is the rope alone.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TiedRope<P, L, T, W = [f32; 0]> {
    /// The rope, an open one.
    pub rope: Rope<P, L>,
    /// The ties of its first and of its last particle.
    pub ends: [Option<Tie<T, W>>; 2],
}

impl<P: AsRef<[u32]>, L: AsRef<[f32]>, T: AsRef<[u32]>, W: AsRef<[f32]>> TiedRope<P, L, T, W> {
    /// The first of its numbers that cannot be used, and what it has to be. That nobody is named twice is asked of all by twos.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        self.fault_by(|list| list.iter().enumerate().any(|(i, one)| list[..i].contains(one)))
    }

    /// The same, if `twice` tells whether a list names somebody twice.
    fn fault_by(&self, twice: impl Fn(&[u32]) -> bool) -> Option<(&'static str, &'static str)> {
        let particles = self.rope.particles.as_ref();
        let ends = [particles.first(), particles.last()];
        let is_end = |(tie, end): (&Option<Tie<T, W>>, Option<&u32>)| {
            tie.as_ref().is_none_or(|tie| {
                Some(&tie.particle) == end && !tie.to.as_ref().iter().any(|to| particles.contains(to))
            })
        };
        let bodies = || self.ends.iter().flatten().any(|tie| twice(tie.to.as_ref()));
        let own = !self.ends.iter().zip(ends).all(is_end);
        let wrong = self.rope.closed && self.ends.iter().any(Option::is_some);
        self.rope
            .fault()
            .or_else(|| self.ends.iter().flatten().find_map(Tie::fault))
            .or_else(|| {
                own.then_some(("ends", "have to tie the rope's first and last particle to particles of others"))
            })
            .or_else(|| wrong.then_some(("ends", "must not be tied where the rope is closed: it has none")))
            .or_else(|| twice(particles).then_some(("particles", "must not name a particle twice")))
            .or_else(|| bodies().then_some(("ends", "must not name a particle of a body twice")))
    }

    /// The words that its ties keep.
    fn places<'k>(&self, kept: &'k [u32]) -> [&'k [u32]; 2] {
        let words = |end: usize| self.ends[end].as_ref().map_or(0, Tie::words).min(kept.len());
        let (first, rest) = kept.split_at(words(0));
        [first, rest.get(..words(1)).unwrap_or_default()]
    }

    /// The ties and the words that each keeps.
    fn ties<'t>(&'t self, kept: &'t [u32]) -> impl Iterator<Item = (usize, &'t Tie<T, W>, &'t [u32])> {
        let ends = self.ends.iter().zip(self.places(kept)).enumerate();
        ends.filter_map(|(end, (tie, place))| Some((end, tie.as_ref()?, place)))
    }

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

    fn is_tied(&self) -> bool {
        self.ends.iter().any(Option::is_some)
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
        let (kept, mut step) = (Kept::default(), &mut *share.step);
        let _ = take_vectors(&mut step, 2);
        then(&self.rope, bodies, &mut Share { kept, step, scratch: share.scratch, capacity: share.capacity }, &held);
    }

    /// Gives the body that an end is tied to what an impulse at the place does.
    fn give(&self, bodies: &mut Bodies<'_>, (end, kept): (usize, &[u32]), (grip, what): (&Grip, Change), pull: Vec3) {
        let tie = self.ties(kept).find(|(number, ..)| *number == end);
        if let Some((_, tie, place)) = tie.filter(|_| pull.is_finite()) {
            tie.push(bodies, place, grip, pull, |bodies, row, by| bodies.change(what, row, by));
        }
    }

    /// Gives bodies what the rope has pulled at ends of which it has been put by.
    fn give_later(&self, bodies: &mut Bodies<'_>, kept: &[u32], later: &[Vec3]) {
        for (end, &pull) in later.iter().enumerate().filter(|&(_, pull)| *pull != Vec3::ZERO) {
            if let Some(Joint { grip, row, .. }) = self.joint(bodies, end, kept, 0.0) {
                let share =
                    if self.is_held(bodies) { self.asked(bodies, (end, kept), (&grip, row), pull) } else { 1.0 };
                self.give(bodies, (end, kept), (&grip, Change::Velocity), pull * share);
            }
        }
    }

    /// Tells whether one of the rope's particles is fixed: no momentum is to be kept.
    fn is_held(&self, bodies: &Bodies<'_>) -> bool {
        let rows = self.rope.particles.as_ref().iter().filter_map(|&number| bodies.row_of_start(number));
        rows.into_iter().any(|row| bodies.inverse_mass[row] == 0.0)
    }

    /// The share of a pull, up to all, after which the place goes along it as fast as the end does: another rope may have pulled the body meanwhile, and both would
    /// drive it to and fro.
    fn asked(&self, bodies: &Bodies<'_>, (end, kept): (usize, &[u32]), (grip, row): (&Grip, usize), pull: Vec3) -> f32 {
        let place = self.ties(kept).find(|(number, ..)| *number == end);
        let parting = place.and_then(|(_, tie, place)| tie.parting_from(bodies, place, row));
        let share = parting.map_or(1.0, |parting| parting.dot(pull) / pull.dot(grip.given_way(pull)));
        clamp(share, 0.0, 1.0)
    }
}

/// Words that last through a sub-step: what the rope has pulled at each end that the bodies are to be given as velocities are settled.
const LATER: usize = 6;

/// What a rope does in a phase.
type Phase<P, L> = fn(&Rope<P, L>, &mut Bodies<'_>, &mut Share<'_>, &[Option<Held>]);

/// What a tie does in a phase.
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

impl<P, L, T, W> Constraint for TiedRope<P, L, T, W>
where
    P: AsRef<[u32]> + Sync,
    L: AsRef<[f32]> + Sync,
    T: AsRef<[u32]> + Sync,
    W: AsRef<[f32]> + Sync,
{
    fn demand(&self) -> Demand {
        if !self.is_tied() {
            return self.rope.demand();
        }
        let rope = self.rope.demand_held();
        let own = Demand { step: rope.step.and(Words { per_row: 0, fixed: LATER }), ..rope };
        self.ends.iter().flatten().fold(own, |sum, tie| sum.and(tie.demand()))
    }

    fn is_empty(&self) -> bool {
        self.rope.is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.prepare(bodies, share);
        }
        let mut parts = share.parts();
        for tie in self.ends.iter().flatten() {
            tie.prepare(bodies, &mut parts.next(tie.demand()));
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.close(bodies, share, &[]);
        }
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        self.tie_up(bodies, share.kept.fixed, true, Tie::close);
        let joints = self.joints(bodies, share.kept.fixed, h);
        self.with(&joints, bodies, share, Rope::close);
        let mut later = [Vec3::ZERO; 2];
        for Joint { end, row, held, grip, was } in joints.into_iter().flatten() {
            let [moved, faster] = [bodies.position[row] - was[0], bodies.velocity[row] - was[1]];
            // What the end has got faster beyond how far it has moved came later: it acts where all are by then, as the forces of links do on particles, and
            // does not move anybody in this sub-step.
            later[end] = held.mass * (faster - moved * (1.0 / h));
            self.give(bodies, (end, share.kept.fixed), (&grip, Change::Place), held.mass * moved);
        }
        take_vectors(&mut &mut *share.step, 2).iter_mut().zip(later).for_each(|(kept, pull)| *kept = pull);
        self.tie_up(bodies, share.kept.fixed, false, Tie::close);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.settle_held(bodies, share, &[]);
        }
        // In no time nobody has pulled.
        if bodies.substep.seconds() > 0.0 {
            self.give_later(bodies, share.kept.fixed, take_vectors(&mut &mut *share.step, 2));
        }
        self.tie_up(bodies, share.kept.fixed, true, Tie::brake);
        let joints = self.joints(bodies, share.kept.fixed, 0.0);
        self.with(&joints, bodies, share, Rope::settle_held);
        for Joint { end, row, held, grip, was } in joints.into_iter().flatten() {
            let faster = held.mass * (bodies.velocity[row] - was[1]);
            self.give(bodies, (end, share.kept.fixed), (&grip, Change::Velocity), faster);
        }
        self.tie_up(bodies, share.kept.fixed, false, Tie::brake);
    }
}

#[cfg(feature = "alloc")]
impl<P, L, T, W> Declared for TiedRope<P, L, T, W>
where
    P: AsRef<[u32]> + Sync,
    L: AsRef<[f32]> + Sync,
    T: AsRef<[u32]> + Sync,
    W: AsRef<[f32]> + Sync,
{
    fn name(&self) -> &'static str {
        self.rope.name()
    }

    fn solved(&self) -> &'static str {
        self.rope.solved()
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        self.fault_by(names_twice)
    }

    fn ends(&self) -> [&[u32]; 3] {
        let to = |end: usize| self.ends[end].as_ref().map_or(&[][..], |tie| tie.to.as_ref());
        [self.rope.particles.as_ref(), to(0), to(1)]
    }

    fn links(&self) -> Box<dyn Iterator<Item = [u32; 2]> + '_> {
        Declared::links(&self.rope)
    }

    fn lengths(&self) -> &[f32] {
        Declared::lengths(&self.rope)
    }

    fn compliance(&self) -> f32 {
        self.rope.compliance
    }

    fn is_tether(&self) -> bool {
        self.rope.tether
    }
}
