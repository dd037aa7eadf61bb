//! The energy of ropes that nothing holds, and their angular momentum.

use super::links::NOBODY;
use crate::constrain::budget::{self, Budget, Free};
use crate::constrain::whole::{self, Group, Owed, Whole};
use crate::constrain::{Bodies, Demand, Words};
use crate::index::{Room, between};
use crate::math::{largest, length, max};
use crate::memory::take;
use glam::Vec3;

/// Words to work with for each particle.
const WORDS: usize = 5;
/// Words kept of a part, by the number of its first particle: how many it has, and the energy that these may have.
const PART: usize = 1 + budget::WORDS;
/// Sums that go on side by side.
const SUMS: usize = 8;

/// The form of a rope at rest, on which its energy depends.
#[derive(Clone, Copy)]
pub(super) struct Form<'m> {
    /// The number of its particles.
    pub(super) particles: usize,
    /// How long the links are at rest, the last of which holds for all further ones \[m\].
    pub(super) lengths: &'m [f32],
    /// How far each link gives way \[m/N\].
    pub(super) compliance: f32,
    /// True if links only pull.
    pub(super) tether: bool,
    /// True if a link joins the last particle to the first.
    pub(super) closed: bool,
}

/// What they ask for, for a rope of so many particles: of whom words are kept is the first of these, and then comes what rounding owes it, and of its parts.
pub(super) fn demand(particles: usize) -> Demand {
    let words = |fixed| Words { per_row: 0, fixed };
    let kept = particles.saturating_mul(PART).saturating_add(1 + whole::WORDS);
    Demand { kept: words(kept), scratch: words(WORDS.saturating_mul(particles)), ..Demand::NONE }
}

/// The bounds that solving a rope keeps to, if nothing holds it, or a part of it that is left where particles have died.
pub(super) struct Bounds<'m> {
    form: Form<'m>,
    /// The rows of all particles, and the number of the first of these: where a closed rope is broken, the one behind the gap.
    rows: &'m [u32],
    first: usize,
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
type Taking<'m> = fn(Form<'m>, Free<'_, '_>, Part<'_>, f32);

/// A part of a rope: the rows of its particles, and the number of the first of these.
#[derive(Clone, Copy)]
struct Part<'m> {
    rows: &'m [u32],
    first: usize,
}

impl<'m> Bounds<'m> {
    /// Those of a rope whose particles are in these rows; none, where nothing is kept of it.
    pub(super) fn of(
        form: Form<'m>,
        bodies: &Bodies<'_>,
        rows: &[u32],
        words: &'m mut [u32],
        work: &'m mut [u32],
    ) -> Option<Self> {
        let (owed, purses) = words.get_mut(1..)?.split_at_mut_checked(whole::WORDS)?;
        let (mut rest, count) = (work, rows.len());
        let own = take(&mut rest, count);
        let gap = rows.iter().position(|&row| row == NOBODY).filter(|_| form.closed);
        let first = gap.map_or(0, |gap| gap + 1);
        let (before, behind) = rows.split_at(first);
        own.iter_mut().zip(behind.iter().chain(before)).for_each(|(to, &row)| *to = row);
        let most = bytemuck::cast_slice_mut(take(&mut rest, count));
        let goal = bytemuck::cast_slice_mut(take(&mut rest, 3 * count));
        let rows: &'m [u32] = own;
        let is_free = rows.iter().all(|&row| bodies.inverse_mass.get(row as usize).is_some_and(|&weight| weight > 0.0));
        let whole = if is_free { Group::of(bodies, rows).whole() } else { None };
        Some(Self { form, rows, first, most, goal, whole, owed: Owed(owed), purses })
    }

    /// The parts in which it is, of two particles or more, by the places of their first.
    fn parts(&self) -> impl Iterator<Item = (usize, Part<'m>)> + use<'m> {
        let (mut next, first, rows) = (0, self.first, self.rows);
        let parts = rows.split(|&row| row == NOBODY).map(move |rows| {
            let place = next;
            next += rows.len() + 1;
            (place, Part { rows, first: first + place })
        });
        parts.filter(|(_, part)| part.rows.len() > 1)
    }

    /// Finds how much its parts may have when they have been solved, from where they were as the sub-step began; and what angular momentum all of it had
    /// then, if nothing has turned it since: what rounding of the way has taken far from the origin is given back as well.
    pub(super) fn limit(&mut self, bodies: &Bodies<'_>) {
        if self.whole.is_some() && Group::of(bodies, self.rows).goes_on(bodies.before[1]) {
            self.whole = Group::begun(bodies, self.rows).whole();
        }
        for (place, part) in self.parts().filter(|(_, part)| part.is_free(bodies)) {
            let strained = self.form.strained(bodies.near.room(), part, bodies.before[0]);
            self.most[place] = self.budget(part).most(Group::begun(bodies, part.rows).moving() + strained);
        }
    }

    /// Gives it back what rounding has taken, and takes out of its parts what they have too much. What rigid links give, settling may take, but for what
    /// their form alone makes too much.
    pub(super) fn keep_within(&mut self, bodies: &mut Bodies<'_>) {
        let take: Taking<'m> =
            if self.form.compliance > 0.0 { Form::hold_back } else { |_, mut free, _, most| free.hold_form(most) };
        if let Some(whole) = &self.whole {
            self.owed.lay_across(bodies, self.rows, whole);
        }
        self.giving_back(bodies, |this, bodies, due| this.keep(bodies, due, take));
    }

    /// Finds how much its parts may have when their velocities have been settled, where links are rigid: soft ones settle nothing but what damping takes.
    pub(super) fn limit_settled(&mut self, bodies: &Bodies<'_>) {
        if self.form.compliance > 0.0 {
            return;
        }
        for (place, part) in self.parts().filter(|(_, part)| part.is_free(bodies)) {
            self.most[place] = self.budget(part).most(Group::of(bodies, part.rows).moving());
        }
    }

    /// The same as before when velocities have been settled: what rigid links have then they keep.
    pub(super) fn keep_settled(&mut self, bodies: &mut Bodies<'_>) {
        self.giving_back(bodies, |this, bodies, due| {
            if this.form.compliance == 0.0 {
                this.keep(bodies, due, |_, mut free, _, most| free.slow_down(most));
            }
        });
    }

    /// Gives a rope the angular momentum back that it has lost, and owes it what is missing when something more has been done.
    fn giving_back(&mut self, bodies: &mut Bodies<'_>, then: impl FnOnce(&mut Self, &mut Bodies<'_>, Option<Whole>)) {
        let due = self.owed.give_back(bodies, self.rows, self.whole);
        then(self, bodies, due);
        self.owed.note(bodies, self.rows, due);
    }

    /// Notes what its parts have, when from those that have too much it has been taken.
    fn keep(&mut self, bodies: &mut Bodies<'_>, due: Option<Whole>, take: Taking<'m>) {
        for (place, part) in self.parts() {
            if !part.is_free(bodies) {
                self.budget(part).forget();
                continue;
            }
            let (most, mut now) = (self.most[place], self.form.energy(bodies, part));
            if now > most {
                take(self.form, Free { bodies, rows: part.rows, due, goal: self.goal }, part, most);
                now = self.form.energy(bodies, part);
            }
            self.budget(part).keep(now, most);
        }
    }

    /// The energy that a part may have, of which nothing is known yet where it was another part as that was noted.
    fn budget(&mut self, part: Part<'_>) -> Budget<'_> {
        let number = part.first % self.form.particles;
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

impl Part<'_> {
    fn is_free(&self, bodies: &Bodies<'_>) -> bool {
        self.rows.iter().all(|&row| bodies.inverse_mass[row as usize] > 0.0)
    }
}

impl Form<'_> {
    /// How long a link is to be.
    pub(super) fn length(&self, link: usize) -> f32 {
        self.lengths.get(link).or(self.lengths.last()).copied().unwrap_or(0.0)
    }

    /// Takes out of how a part of soft links moves beside a rigid motion what is more than `most` \[J\], and of the ways as well. What strain rounding may
    /// show there is no too much: it would be taken of the motion time and again.
    fn hold_back(self, mut free: Free<'_, '_>, part: Part<'_>, most: f32) {
        let (room, rounding) = (free.bodies.near.room().copied(), self.rounding_of(free.bodies, part));
        let _ = free.hold_back(most, |places, _| max(self.strained(room.as_ref(), part, places) - rounding, 0.0));
    }

    /// The energy of motion, beside that of the middle, and of strain \[J\].
    fn energy(&self, bodies: &Bodies<'_>, part: Part<'_>) -> f32 {
        Group::of(bodies, part.rows).moving() + self.strained(bodies.near.room(), part, bodies.position)
    }

    /// The energy of strain where a part is in these places \[J\].
    fn strained(&self, room: Option<&Room>, part: Part<'_>, places: &[Vec3]) -> f32 {
        let mut sums = [0.0; SUMS];
        for (place, [p, q]) in self.links_between(part) {
            let (p, q) = (places[p as usize], places[q as usize]);
            let off = length(between(room, q, p)) - self.length((part.first + place) % self.particles);
            let off = if self.tether { max(off, 0.0) } else { off };
            sums[place % SUMS] += off * off;
        }
        let sum = 0.5 * sums.iter().sum::<f32>() / self.compliance;
        if self.compliance > 0.0 && sum.is_finite() { sum } else { 0.0 }
    }

    /// As much of that as rounding of places may show \[J\].
    fn rounding_of(&self, bodies: &Bodies<'_>, part: Part<'_>) -> f32 {
        let far = part.rows.iter().map(|&row| largest(bodies.position[row as usize])).fold(0.0, max);
        let off = 2.0 * f32::EPSILON * far;
        let sum = 0.5 * (off * off) * self.links_between(part).count() as f32 / self.compliance;
        if sum.is_finite() { sum } else { 0.0 }
    }

    /// The rows of the ends of each link of a part, and which of them it is.
    fn links_between<'p>(&self, part: Part<'p>) -> impl Iterator<Item = (usize, [u32; 2])> + use<'p> {
        let rows = part.rows;
        let closes = self.closed && rows.len() == self.particles && rows.len() > 2;
        let ends = move |place: usize| (place, [rows[place], rows[if place + 1 < rows.len() { place + 1 } else { 0 }]]);
        (0..rows.len() - usize::from(!closes)).map(ends)
    }
}
