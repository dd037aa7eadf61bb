//! Ropes whose ends are tied to other bodies: their direct solution feels how heavy these are.

#[cfg(feature = "alloc")]
use super::super::declared::{Declared, names_twice};
use super::super::{Bodies, Constraint, Demand, Rope, Share, Words};
use super::Tie;
#[cfg(feature = "alloc")]
use alloc::boxed::Box;

/// A rope of which one end or both are tied to a body, however heavy that is.
///
/// A [`Rope`] and a [`Tie`] behind it are met one after the other, and give way under what is heavier than the rope's end. Here an end that is tied rigidly has, while the rope is
/// solved, the mass of itself and of the body at its place, in each direction: m + W⁻¹, where an impulse J moves the place by W J. The body gets its share of what the rope does to that,
/// with equal impulses at the place, half of it as velocities are settled, and then the ties are met. Linear and angular momentum are kept as they are by both alone. Soft ties are met behind the rope.
/// Ropes that share bodies, and follow each other in a list, are solved by turns until no body has moved by more than a ten thousandth of a link since its ropes were, 64 times at the
/// most (counted as capped in [`Effort`](crate::Effort)): boxes below each other swing as one in a single sub-step. What hangs from a light body turns that to and fro by up to ω² = 6 T / (m d), of a weight T, a mass m
/// and a size d; from about a radian a sub-step on it is thrown about. Near scenery that presses them ropes are solved once.
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
    pub(super) fn ties<'t>(&'t self, kept: &'t [u32]) -> impl Iterator<Item = (usize, &'t Tie<T, W>, &'t [u32])> {
        let ends = self.ends.iter().zip(self.places(kept)).enumerate();
        ends.filter_map(|(end, (tie, place))| Some((end, tie.as_ref()?, place)))
    }

    fn is_tied(&self) -> bool {
        self.ends.iter().any(Option::is_some)
    }
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
        let all = self.ends.iter().flatten().fold(own, |sum, tie| sum.and(tie.demand()));
        Demand { loads: false, ..all }
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
            tie.know(bodies, &mut parts.next(tie.demand()));
        }
        bodies.join_all(self.rope.particles.as_ref());
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.close(bodies, share, &[]);
        }
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        self.pull(bodies, share, false);
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
            self.pull(bodies, share, true);
        }
        is_again
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !self.is_tied() {
            return self.rope.settle_held(bodies, share, &[]);
        }
        self.settle_pulls(bodies, share);
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
