//! Counts of what a step did: nothing that is bounded is bounded silently.

use crate::math::max;
use crate::reap::Cause;

/// Counts of what happened in a step, or in all of them so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Report {
    /// Particles put in by the scene's start.
    pub initial: u64,
    /// Particles that emitters brought into the world.
    pub born: u64,
    /// Particles removed, by cause.
    pub died: Died,
    /// Particles that found no room, and places of births where particles are few that were not tried any more in their step.
    pub refused: u64,
    /// Times that a particle met a collider; of contacts held by position one in each sub-step. What rests on one meets it in
    /// every step.
    pub hits: u64,
    /// Times that two particles met; of contacts held by position one in each sub-step, of those by force none.
    pub contacts: u64,
    /// Springs that broke.
    pub broken: u64,
    /// Times that a bound cut work short.
    pub caps: Caps,
    /// The work of the integrator.
    pub effort: Effort,
}

/// The work of an integrator. It is no part of the system's hash.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Effort {
    /// Evaluations of all forces.
    pub evaluations: u64,
    /// Times that neighbours were listed, to last for a while: how often hangs on the memory and on the target, what comes of it does not.
    pub lists: u64,
    /// Evaluations for which neighbours were looked up in an index, without a list.
    pub streamed: u64,
    /// Evaluations for which all pairs were looked at, as there was no index; and likewise searches of constraints, births, deaths and meetings by impulse.
    pub all_pairs: u64,
    /// Steps that a method which chooses its own accepted.
    pub accepted: u64,
    /// Steps that it tried and took back.
    pub rejected: u64,
    /// Linear systems solved.
    pub solves: u64,
    /// Iterations that took.
    pub iterations: u64,
    /// The largest residual left, as a share of what the solution began with.
    pub residual: f32,
    /// Steps that were taken although they err too much, solutions cut off before they were good enough, and sub-steps in which something would have bounced on.
    pub capped: u64,
}

impl Effort {
    pub(crate) const NONE: Self = Self {
        evaluations: 0,
        lists: 0,
        streamed: 0,
        all_pairs: 0,
        accepted: 0,
        rejected: 0,
        solves: 0,
        iterations: 0,
        residual: 0.0,
        capped: 0,
    };

    /// Counts what it took to find forces.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn found(&mut self, more: &Finding) {
        self.evaluations += u64::from(more.evaluations);
        self.lists += u64::from(more.lists);
        self.streamed += u64::from(more.streamed);
        self.all_pairs += u64::from(more.all_pairs);
    }

    /// Counts a solution.
    pub(crate) fn solved(&mut self, iterations: u32, residual: f32, capped: bool) {
        self.solves += 1;
        self.iterations += u64::from(iterations);
        self.residual = max(residual, self.residual);
        self.capped += u64::from(capped);
    }
}

/// The work of finding forces, in a part of a step: those counts of an [`Effort`] that it takes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Finding {
    pub(crate) evaluations: u32,
    pub(crate) lists: u32,
    pub(crate) streamed: u32,
    pub(crate) all_pairs: u32,
}

/// Particles removed, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct Died {
    /// By age.
    pub lifetime: u64,
    /// By touching a sink.
    pub sink: u64,
    /// Where too many were.
    pub density: u64,
    /// By chance.
    pub chance: u64,
    /// By a rule of the program's own, or by its hand.
    pub other: u64,
    /// Because a number of theirs was no longer finite.
    pub nonfinite: u64,
}

/// Times that a bound cut work short.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct Caps {
    /// A particle hit as often in one sub-step as it may, and waited at the surface for its end.
    pub bounces: u64,
    /// A path was so curved that its collisions were sought along fewer chords than its accuracy asks. Only paths that are followed count:
    /// at coordinates from about 1e17 m on rounding decides which are, and not in the same way for one thing and for a list of it.
    pub chords: u64,
    /// A spring lost an end, or lacked one when its list was taken up.
    pub springs: u64,
    /// Two that were near each other, or a particle and a face, found no room in the list of contacts.
    pub contacts: u64,
    /// Times that a particle's step was lost to rounding: along some axis it moves, but the step's way is less than half the
    /// distance to the next number there. No part of the system's hash.
    pub stalled: u64,
    /// Solutions of shells in whose memory there was no room for graphs, as they have hinges that are not edges of two of their triangles, or have them
    /// twice: such take many times the iterations. No part of the system's hash.
    pub graphs: u64,
    /// Solutions of shells after which edges were still shortened in the last of 64 passes: some may be left longer than their material lets them.
    /// No part of the system's hash.
    pub edges: u64,
    /// Pieces of shells which walls press that stayed where they were in a sub-step, but for what walls let them do along these: wherever else they went,
    /// they had more energy than there was. No part of the system's hash.
    pub crushed: u64,
    /// Triangles and folds of shells, triangles of limits of strain and edges of strands that have no extent where they begin, or no place, so that they
    /// do nothing: each once, as they begin. No part of the system's hash.
    pub degenerate: u64,
    /// Births that should lie inside a shape, for which no place was found there, so that they lie on its surface: it is too thin, or open. No part of the
    /// system's hash.
    pub outside: u64,
    /// A step could not be made, and time has not gone on: the scene needs more emitters, springs, columns to work with or kept words than the system
    /// has ([`Scene::size_for`](crate::Scene::size_for)), or columns of their own of drags, masses and inverse masses (materials that change them) or of the ends of lists of springs, where
    /// memory holds these for all particles alike.
    pub insufficient_memory: u64,
}

/// Adds to a counter, which stops at the largest number. Apart, like those of whole structs: there are so many of them.
#[inline(never)]
fn add(sum: &mut u64, more: &u64) {
    *sum = sum.saturating_add(*more);
}

/// Adds to as many counters.
#[inline(never)]
fn add_all(sums: &mut [u64], more: &[u64]) {
    for (sum, more) in sums.iter_mut().zip(more) {
        add(sum, more);
    }
}

impl Died {
    fn take_in(&mut self, more: &Self) {
        add_all(
            bytemuck::cast_slice_mut(core::slice::from_mut(self)),
            bytemuck::cast_slice(core::slice::from_ref(more)),
        );
    }
}

impl Caps {
    fn take_in(&mut self, more: &Self) {
        add_all(
            bytemuck::cast_slice_mut(core::slice::from_mut(self)),
            bytemuck::cast_slice(core::slice::from_ref(more)),
        );
    }
}

impl Effort {
    /// Adds up every counter, and takes the larger residual.
    #[inline(never)]
    fn take_in(&mut self, more: &Self) {
        let Self { evaluations, lists, streamed, all_pairs, accepted, rejected, solves, iterations, residual, capped } =
            self;
        add(evaluations, &more.evaluations);
        add(lists, &more.lists);
        add(streamed, &more.streamed);
        add(all_pairs, &more.all_pairs);
        add(accepted, &more.accepted);
        add(rejected, &more.rejected);
        add(solves, &more.solves);
        add(iterations, &more.iterations);
        add(capped, &more.capped);
        *residual = max(*residual, more.residual);
    }
}

/// The sum of plain counters saturates.
macro_rules! add_assign {
    ($($counter:ident)+) => {$(
        impl core::ops::AddAssign for $counter {
            fn add_assign(&mut self, other: Self) {
                self.take_in(&other);
            }
        }
    )+};
}
add_assign!(Died Caps Effort Report);

impl Report {
    /// Adds another one, which a chip is spared a copy of.
    pub(crate) fn take_in(&mut self, more: &Self) {
        add(&mut self.initial, &more.initial);
        add(&mut self.born, &more.born);
        add(&mut self.refused, &more.refused);
        add(&mut self.hits, &more.hits);
        add(&mut self.contacts, &more.contacts);
        add(&mut self.broken, &more.broken);
        self.died.take_in(&more.died);
        self.caps.take_in(&more.caps);
        self.effort.take_in(&more.effort);
    }
}

impl Died {
    /// Counts a death.
    pub(crate) fn count(&mut self, cause: Cause) {
        let counter = match cause {
            Cause::Lifetime => &mut self.lifetime,
            Cause::Sink => &mut self.sink,
            Cause::Density => &mut self.density,
            Cause::Chance => &mut self.chance,
            Cause::Other => &mut self.other,
            Cause::Nonfinite => &mut self.nonfinite,
        };
        *counter += 1;
    }

    /// From whatever cause.
    #[cfg_attr(one_by_one, inline(never))]
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.lifetime + self.sink + self.density + self.chance + self.other + self.nonfinite
    }
}

impl Report {
    /// Nothing happened.
    pub const NOTHING: Self = Self {
        initial: 0,
        born: 0,
        died: Died { lifetime: 0, sink: 0, density: 0, chance: 0, other: 0, nonfinite: 0 },
        refused: 0,
        hits: 0,
        contacts: 0,
        broken: 0,
        effort: Effort::NONE,
        caps: Caps {
            bounces: 0,
            chords: 0,
            springs: 0,
            contacts: 0,
            stalled: 0,
            graphs: 0,
            edges: 0,
            crushed: 0,
            degenerate: 0,
            outside: 0,
            insufficient_memory: 0,
        },
    };

    /// Every counter of what happened that the state does not tell, in a fixed order.
    pub(crate) fn counters(&self) -> [u64; 16] {
        let Self { initial, born, died, refused, hits, contacts, broken, caps, effort: _ } = *self;
        // The hash takes in `other` where there are any.
        let Died { lifetime, sink, density, chance, other: _, nonfinite } = died;
        let Caps { bounces, chords, springs, contacts: near, insufficient_memory, .. } = caps;
        let Caps { stalled: _, graphs: _, edges: _, crushed: _, degenerate: _, outside: _, .. } = caps;
        [
            initial,
            born,
            lifetime,
            sink,
            density,
            chance,
            nonfinite,
            refused,
            hits,
            contacts,
            broken,
            bounces,
            chords,
            springs,
            near,
            insufficient_memory,
        ]
    }
}
