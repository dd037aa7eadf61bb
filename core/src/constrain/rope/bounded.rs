//! The energy of ropes that nothing holds, and their angular momentum.

use super::chain::Chain;
use crate::constrain::budget::{self, Budget, Free};
use crate::constrain::whole::{self, Group, Owed, Whole};
use crate::constrain::{Bodies, Demand, Words};
use crate::index::{Room, between};
use crate::math::{largest, length, max};
use glam::Vec3;

/// Words to work with for each particle.
const WORDS: usize = 4;
/// Words kept of a part, by the number of its first particle: how many it has, and the energy that these may have.
const PART: usize = 1 + budget::WORDS;
/// Sums that go on side by side.
const SUMS: usize = 8;

/// What they ask for, for a rope of so many particles: of whom words are kept is the first of these, and then comes what rounding owes it, and of its parts.
pub(super) fn demand(particles: usize) -> Demand {
    let words = |fixed| Words { per_row: 0, fixed };
    let kept = particles.saturating_mul(PART).saturating_add(1 + whole::WORDS);
    Demand { kept: words(kept), scratch: words(WORDS.saturating_mul(particles)), ..Demand::NONE }
}

/// The bounds that solving a rope keeps to, if nothing holds it, or a part of it that is left where particles have died.
pub(super) struct Bounds<'m> {
    chain: Chain<'m>,
    /// The most energy that each part may have, by the place of its first particle \[J\].
    most: &'m mut [f32],
    /// A column to work with.
    goal: &'m mut [Vec3],
    /// How all of it moves before it is solved, if it is in one and nothing holds it.
    whole: Option<Whole>,
    owed: Owed<'m>,
    purses: &'m mut [u32],
}

/// How a part that has more than so much energy \[J\] gets rid of that.
type Taking<'m> = fn(Chain<'m>, Free<'_, '_>, f32);

impl<'m> Bounds<'m> {
    /// Those of a chain; none, where nothing is kept of it.
    pub(super) fn of(chain: Chain<'m>, bodies: &Bodies<'_>, kept: &'m mut [u32], work: &'m mut [u32]) -> Option<Self> {
        let (owed, purses) = kept.get_mut(1..)?.split_at_mut_checked(whole::WORDS)?;
        let (most, goal) = work.get_mut(..WORDS * chain.rows.len())?.split_at_mut(chain.rows.len());
        let (most, goal) = (bytemuck::cast_slice_mut(most), bytemuck::cast_slice_mut(goal));
        let whole = if chain.is_free(bodies) { Group::of(bodies, chain.rows).whole() } else { None };
        Some(Self { chain, most, goal, whole, owed: Owed(owed), purses })
    }

    /// The most energy that each part may have that nothing holds, where that is told.
    fn limits(&mut self, bodies: &Bodies<'_>, energy: impl Fn(Chain<'m>) -> f32) {
        for part in self.chain.parts().filter(|part| part.is_free(bodies)) {
            self.most[part.first - self.chain.first] = self.budget(part).most(energy(part));
        }
    }

    /// Finds how much its parts may have when they have been solved, from where they were as the sub-step began; and what angular momentum all of it had
    /// then, if nothing has turned it since: what rounding of the way has taken far from the origin is given back as well.
    pub(super) fn limit(&mut self, bodies: &Bodies<'_>) {
        if self.whole.is_some() && Group::of(bodies, self.chain.rows).goes_on(bodies.before[1]) {
            self.whole = Group::begun(bodies, self.chain.rows).whole();
        }
        self.limits(bodies, |part| {
            let strained = part.strained(bodies.near.room(), bodies.before[0]);
            Group::begun(bodies, part.rows).moving() + strained
        });
    }

    /// Gives it back what rounding has taken, and takes out of its parts what they have too much. What rigid links give, settling may take, but for what
    /// their form alone makes too much.
    pub(super) fn keep_within(&mut self, bodies: &mut Bodies<'_>) {
        let take: Taking<'m> =
            if self.chain.compliance > 0.0 { Chain::hold_back } else { |_, mut free, most| free.hold_form(most) };
        if let Some(whole) = &self.whole {
            self.owed.lay_across(bodies, self.chain.rows, whole);
        }
        self.giving_back(bodies, |this, bodies, due| this.keep(bodies, due, take));
    }

    /// Finds how much its parts may have when their velocities have been settled, where links are rigid: soft ones settle nothing but what damping takes.
    pub(super) fn limit_settled(&mut self, bodies: &Bodies<'_>) {
        if self.chain.compliance == 0.0 {
            self.limits(bodies, |part| Group::of(bodies, part.rows).moving());
        }
    }

    /// The same as before when velocities have been settled: what rigid links have then they keep.
    pub(super) fn keep_settled(&mut self, bodies: &mut Bodies<'_>) {
        self.giving_back(bodies, |this, bodies, due| {
            if this.chain.compliance == 0.0 {
                this.keep(bodies, due, |_, mut free, most| free.slow_down(most));
            }
        });
    }

    /// Gives a rope the angular momentum back that it has lost, and owes it what is missing when something more has been done.
    fn giving_back(&mut self, bodies: &mut Bodies<'_>, then: impl FnOnce(&mut Self, &mut Bodies<'_>, Option<Whole>)) {
        let due = self.owed.give_back(bodies, self.chain.rows, self.whole);
        then(self, bodies, due);
        self.owed.note(bodies, self.chain.rows, due);
    }

    /// Notes what its parts have, when from those that have too much it has been taken.
    fn keep(&mut self, bodies: &mut Bodies<'_>, due: Option<Whole>, take: Taking<'m>) {
        for part in self.chain.parts() {
            if !part.is_free(bodies) {
                self.budget(part).forget();
                continue;
            }
            let (most, mut now) = (self.most[part.first - self.chain.first], part.energy(bodies));
            if now > most {
                take(part, Free { bodies, rows: part.rows, due, goal: self.goal }, most);
                now = part.energy(bodies);
            }
            self.budget(part).keep(now, most);
        }
    }

    /// The energy that a part may have, of which nothing is known yet where it was another part as that was noted.
    fn budget(&mut self, part: Chain<'_>) -> Budget<'_> {
        let number = part.first % self.chain.particles;
        let Some([count, budget @ ..]) = self.purses.as_chunks_mut::<PART>().0.get_mut(number) else {
            return Budget(&mut []);
        };
        let (before, now) = (*count as usize, part.rows.len());
        *count = now as u32;
        let mut budget = Budget(budget);
        if before != now {
            budget.forget();
        }
        budget
    }
}

impl Chain<'_> {
    /// Takes out of how a part of soft links moves beside a rigid motion what is more than `most` \[J\], and of the ways as well. What strain rounding may
    /// show there is no too much: it would be taken of the motion time and again.
    fn hold_back(self, mut free: Free<'_, '_>, most: f32) {
        let (room, rounding) = (free.bodies.near.room().copied(), self.rounding_of(free.bodies));
        let _ = free.hold_back(most, |places, _| max(self.strained(room.as_ref(), places) - rounding, 0.0));
    }

    /// The energy of motion, beside that of the middle, and of strain \[J\].
    fn energy(&self, bodies: &Bodies<'_>) -> f32 {
        Group::of(bodies, self.rows).moving() + self.strained(bodies.near.room(), bodies.position)
    }

    /// The energy of strain where all are in these places \[J\].
    fn strained(&self, room: Option<&Room>, places: &[Vec3]) -> f32 {
        let mut sums = [0.0; SUMS];
        for link in 0..self.links() {
            let [p, q] = self.ends(link).map(|end| places[self.rows[end] as usize]);
            let off = length(between(room, q, p)) - self.length(link);
            let off = if self.tether { max(off, 0.0) } else { off };
            sums[link % SUMS] += off * off;
        }
        let sum = 0.5 * sums.iter().sum::<f32>() / self.compliance;
        if self.compliance > 0.0 && sum.is_finite() { sum } else { 0.0 }
    }

    /// As much of that as rounding of places may show \[J\].
    fn rounding_of(&self, bodies: &Bodies<'_>) -> f32 {
        let far = self.rows.iter().map(|&row| largest(bodies.position[row as usize])).fold(0.0, max);
        let off = 2.0 * f32::EPSILON * far;
        let sum = 0.5 * (off * off) * self.links() as f32 / self.compliance;
        if sum.is_finite() { sum } else { 0.0 }
    }
}
