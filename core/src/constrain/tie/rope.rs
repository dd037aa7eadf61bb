//! Ropes whose ends are tied to other bodies: their direct solution feels how heavy these are.

use super::super::bodies::Change;
#[cfg(feature = "alloc")]
use super::super::declared::{Declared, names_twice};
use super::super::rope::Held;
use super::super::walls::{self, Wall};
use super::super::{Bodies, Constraint, Demand, Kept, Rope, Share, Words};
use super::Tie;
use super::grip::Grip;
use crate::math::{largest, length, max};
use crate::memory::take_vectors;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;
use glam::Vec3;

/// How far a body may be from an end when all ropes have been solved, in links, and in roundings of where it is.
const NEAR: f32 = 1e-4;
const ROUNDINGS: f32 = 16.0;

/// A rope of which one end or both are tied to a body, however heavy that is.
///
/// A [`Rope`] and a [`Tie`] behind it are met one after the other, and give way under what is heavier than the rope's end. Here an end that is tied rigidly has, while the rope is
/// solved, the mass of itself and of the body at its place, in each direction: m + W⁻¹, where an impulse J moves the place by W J. The body gets its share of what the rope does to that,
/// with equal impulses at the place, half of it as velocities are settled, and then the ties are met. Linear and angular momentum are kept as they are by both alone. Soft ties are met behind the rope.
/// Ropes that share bodies are solved one after the other, again and again, until no body has moved by more than a ten thousandth of a link since its ropes were.
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
            tie.push(bodies, place, grip, pull, |bodies, row, by| bodies.postpone(row, by));
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

    /// What lasts through a sub-step: the impulse that the rope has pulled with at each end \[kg m\], and what of it is put off until velocities are settled \[kg m/s\]; and where
    /// each of its particles was before, and how fast.
    fn memory<'m>(&self, step: &'m mut [u32]) -> (&'m mut [[Vec3; 2]], &'m mut [[Vec3; 2]]) {
        let mut step = step;
        let pulls = take_vectors(&mut step, 4);
        let before = take_vectors(&mut step, 2 * self.rope.particles.as_ref().len());
        (bytemuck::cast_slice_mut(pulls), bytemuck::cast_slice_mut(before))
    }

    /// Words that last through a sub-step.
    fn words(&self) -> usize {
        self.rope.particles.as_ref().len().saturating_mul(6).saturating_add(12)
    }

    /// Tells whether a body has been moved away from an end by another rope, by more than may be left.
    fn is_drawn(&self, bodies: &Bodies<'_>, kept: &[u32]) -> bool {
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
    fn project_from_here(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, again: bool) {
        self.tie_up(bodies, share.kept.fixed, true, Tie::close);
        let (_, before) = self.memory(share.step);
        for (&number, before) in self.rope.particles.as_ref().iter().zip(before) {
            *before =
                bodies.row_of_start(number).map_or([Vec3::ZERO; 2], |row| [bodies.position[row], bodies.velocity[row]]);
        }
        self.solve(bodies, share, again);
    }

    /// Tells whether the scenery may press the rope: what it has given cannot be taken back.
    fn is_by_walls(&self, step: &mut [u32]) -> bool {
        let walls = step.get_mut(self.words()..).unwrap_or_default();
        walls::of(walls, self.rope.particles.as_ref().len()).iter().any(Wall::is_near)
    }

    /// Solves the rope where its ends are at their places, and gives bodies what it pulls.
    fn solve(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>, again: bool) {
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
            if pull.iter().all(|part| part.is_finite()) {
                pulls[end] = pull;
                self.give(bodies, (end, kept), (grip, Change::Place), pull[0]);
                self.postpone(bodies, (end, kept), grip, pull[1]);
            }
            bodies.velocity[row] -= ahead[end];
        }
        let at = |bodies: &Bodies<'_>, row: usize| [bodies.position[row], bodies.velocity[row]];
        let solved = joints.each_ref().map(|joint| joint.as_ref().map(|joint| (joint.row, at(bodies, joint.row))));
        self.tie_up(bodies, kept, again, Tie::close);
        // What ties have given the ends they keep, when what the rope has pulled is taken back.
        let (_, before) = self.memory(share.step);
        let last = before.len().saturating_sub(1);
        for ((row, [place, fast]), end) in
            solved.into_iter().zip([0, last]).filter_map(|(solved, end)| Some((solved?, end)))
        {
            if let Some([x, v]) = before.get_mut(end) {
                *x += bodies.position[row] - place;
                *v += bodies.velocity[row] - fast;
            }
        }
    }

    /// Takes back what the rope has pulled, and puts its particles to where they were before.
    fn take_back(&self, bodies: &mut Bodies<'_>, kept: &[u32], step: &mut [u32]) {
        let joints = self.joints(bodies, kept, bodies.substep.seconds());
        let (pulls, before) = self.memory(step);
        for Joint { end, grip, .. } in joints.iter().flatten() {
            self.give(bodies, (*end, kept), (grip, Change::Place), -pulls[*end][0]);
            self.postpone(bodies, (*end, kept), grip, -pulls[*end][1]);
        }
        for (&number, [position, velocity]) in self.rope.particles.as_ref().iter().zip(before) {
            if let Some(row) = bodies.row_of_start(number) {
                (bodies.position[row], bodies.velocity[row]) = (*position, *velocity);
            }
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
        let rope = self.rope.demand_held();
        let own = Demand { step: rope.step.and(Words { per_row: 0, fixed: self.words() }), postpones: true, ..rope };
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
        self.project_from_here(bodies, share, false);
    }

    fn repeats(&self) -> bool {
        self.is_tied()
    }

    fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
        let is_again = self.is_tied()
            && bodies.substep.seconds() > 0.0
            && self.is_drawn(bodies, share.kept.fixed)
            && !self.is_by_walls(share.step);
        if is_again {
            self.take_back(bodies, share.kept.fixed, share.step);
            self.project_from_here(bodies, share, true);
        }
        is_again
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.settle_held(bodies, share, &[]);
        }
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
