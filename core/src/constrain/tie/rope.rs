//! Ropes whose ends are tied to other bodies: their direct solution feels how heavy these are.

use super::super::bodies::Change;
#[cfg(feature = "alloc")]
use super::super::declared::{Declared, names_twice};
use super::super::rope::Held;
use super::super::{Bodies, Constraint, Demand, Kept, Rope, Share};
use super::Tie;
use super::grip::Grip;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use glam::Vec3;

/// A rope of which one end or both are tied to a body, however heavy that is.
///
/// A [`Rope`] and a [`Tie`] behind it are met one after the other, and give way under what is heavier than the rope's end. Here an end that is tied rigidly has, while the rope is
/// solved, the mass of itself and of the body at its place, in each direction: m + W⁻¹, where an impulse J moves the place by W J. The body gets its share of what the rope does to that,
/// with equal impulses at the place, and then the ties are met. Linear and angular momentum are kept as they are by both alone. Soft ties are met behind the rope.
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
        let ([row, _], grip) = tie.grip(bodies, place, back)?;
        if tie.compliance > 0.0 || !(grip.own > 0.0) {
            return None;
        }
        // What is a body of its own keeps its form; one of three corners or less is drawn out of it.
        let grip = if tie.to.as_ref().len() > 3 { grip.as_one() } else { grip };
        let was = [bodies.position[row], bodies.velocity[row]];
        Some(Joint { end, row, held: grip.held(bodies.mass[row])?, grip, was })
    }

    fn is_tied(&self) -> bool {
        self.ends.iter().any(Option::is_some)
    }

    /// Lets the rope do something, and its ties: rigid ones before as well, since ends have to be at their places and as fast to go with them. What a soft
    /// tie brakes it brakes once.
    fn meet(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, back: f32, rope: Phase<P, L>, tie: TiePhase<T, W>) {
        if !self.is_tied() {
            return rope(&self.rope, bodies, share, &[]);
        }
        for (_, own, place) in self.ties(share.kept.fixed).filter(|(_, own, _)| own.compliance == 0.0) {
            let _ = tie(own, bodies, place);
        }
        self.with_joints(bodies, share, back, rope);
        for (_, own, place) in self.ties(share.kept.fixed) {
            let _ = tie(own, bodies, place);
        }
    }

    /// Lets the rope do something while its ends are as heavy as what they are tied to, of which that gets its share.
    fn with_joints(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, back: f32, then: Phase<P, L>) {
        let joints = [0, 1].map(|end| self.joint(bodies, end, share.kept.fixed, back));
        let held = joints.each_ref().map(|joint| joint.as_ref().map(|joint| joint.held));
        // The rope has kept nothing of its own.
        let mut own =
            Share { kept: Kept::default(), step: share.step, scratch: share.scratch, capacity: share.capacity };
        then(&self.rope, bodies, &mut own, &held);
        let joints = || joints.iter().flatten();
        if back > 0.0 {
            for Joint { end, row, held, grip, was } in joints() {
                let moved = held.mass * (bodies.position[*row] - was[0]);
                self.give(bodies, (*end, share.kept.fixed), (grip, Change::Place), moved);
            }
        }
        // What the end has got faster beyond how far it has moved came later: it acts where all are by now, as the forces of links do on particles. All of it at once
        // where the body was would drive what turns.
        for Joint { end, row, held, was, .. } in joints() {
            let moved = if back > 0.0 { (bodies.position[*row] - was[0]) * (1.0 / back) } else { Vec3::ZERO };
            let faster = held.mass * (bodies.velocity[*row] - was[1] - moved);
            if let Some(Joint { grip, .. }) = self.joint(bodies, *end, share.kept.fixed, 0.0) {
                self.give(bodies, (*end, share.kept.fixed), (&grip, Change::Velocity), faster);
            }
        }
    }

    /// Gives the body that an end is tied to what an impulse at the place does.
    fn give(&self, bodies: &mut Bodies<'_>, (end, kept): (usize, &[u32]), (grip, what): (&Grip, Change), pull: Vec3) {
        let tie = self.ties(kept).find(|(number, ..)| *number == end);
        if let Some((_, tie, place)) = tie.filter(|_| pull.is_finite()) {
            tie.push(bodies, place, grip, pull, |bodies, row, by| bodies.change(what, row, by));
        }
    }
}

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
        self.ends.iter().flatten().fold(self.rope.demand_held(), |sum, tie| sum.and(tie.demand()))
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
        let h = bodies.substep.seconds();
        if h > 0.0 {
            self.meet(bodies, share, h, Rope::close, Tie::close);
        }
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.meet(bodies, share, 0.0, Rope::settle_held, Tie::brake);
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
