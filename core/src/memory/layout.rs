//! The memory that a scene's step asks for, and where each part of it lies. Nothing else knows.

use crate::index::{ARE_KEPT, IndexChoice, Lasting, StateIndex, index_words};
use crate::math::quotient;
use glam::Vec3;

/// The words that say what a particle bears.
pub(crate) const LOAD_WORDS: usize = 13;
/// Those that say what constraints have done to its velocity.
pub(crate) const LEAD_WORDS: usize = 3;

/// So many words of 32 bits for each particle, and so many besides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Words {
    /// For each particle there is room for.
    pub per_row: usize,
    /// Besides.
    pub fixed: usize,
}

impl Words {
    /// None at all.
    pub const NONE: Self = Self { per_row: 0, fixed: 0 };

    /// For so many particles.
    #[cfg_attr(one_by_one, inline(never))]
    #[must_use]
    pub const fn of(self, capacity: usize) -> usize {
        self.per_row.saturating_mul(capacity).saturating_add(self.fixed)
    }

    /// Both, one behind the other.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self { per_row: self.per_row.saturating_add(other.per_row), fixed: self.fixed.saturating_add(other.fixed) }
    }

    /// Room for either, one after the other.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { per_row: self.per_row.max(other.per_row), fixed: self.fixed.max(other.fixed) }
    }

    /// Vectors for each particle.
    const fn columns(columns: usize) -> Self {
        Self { per_row: columns.saturating_mul(3), fixed: 0 }
    }
}

/// The memory that a part of a scene asks for, to work with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    /// The words that it keeps from step to step: all zeros at the system's start, and what is kept of a particle at its birth. It goes with
    /// the particles, and is in the system's hash. Parts find theirs by their order: where constraints change in number, kind or size between
    /// steps, those of the engine begin anew ([`Kept::claim`], for which it has to ask for one fixed word at least).
    pub kept: Words,
    /// The words that it keeps through a step; at the step's beginning they hold anything.
    pub step: Words,
    /// The words that it works with while it is called.
    pub scratch: Words,
    /// True if it asks who is near.
    pub finds_near: bool,
    /// True if it says which particles it holds in their places to each other ([`Constraint::bind`](crate::Constraint::bind)).
    pub binds: bool,
    /// True if it puts changes of velocities off until all are settled ([`Bodies::postpone`](crate::constrain::Bodies::postpone)).
    pub postpones: bool,
    /// True if it lays anything on particles that others bear ([`Bodies::lay_on`](crate::constrain::Bodies::lay_on)).
    pub loads: bool,
}

impl Demand {
    /// Nothing.
    pub const NONE: Self = Self {
        kept: Words::NONE,
        step: Words::NONE,
        scratch: Words::NONE,
        finds_near: false,
        binds: false,
        postpones: false,
        loads: false,
    };

    /// The demand of two parts together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            kept: self.kept.and(other.kept),
            step: self.step.and(other.step),
            scratch: self.scratch.or(other.scratch),
            finds_near: self.finds_near || other.finds_near,
            binds: self.binds || other.binds,
            postpones: self.postpones || other.postpones,
            loads: self.loads || other.loads,
        }
    }

    /// The same, with words through the step for each particle, before all others: the name by which it is bound, if anybody binds particles, what is
    /// put off of its velocity, and what it bears, if anybody does that.
    pub(crate) fn with_shared(mut self) -> Self {
        let shared = usize::from(self.binds) + 3 * usize::from(self.postpones) + LOAD_WORDS * usize::from(self.loads);
        self.step.per_row = self.step.per_row.saturating_add(shared);
        self
    }
}

/// The memory that a whole scene's step asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Plan {
    /// Columns of a user's own.
    pub(crate) custom: usize,
    /// Words a particle for what materials change.
    pub(crate) ageing: usize,
    /// True if anybody asks for places and velocities at a sub-step's beginning.
    pub(crate) start: bool,
    /// Words a particle for what constraints have done to it, if the method is to know of that.
    pub(crate) lead: usize,
    /// True if there are constraints, and their demand.
    pub(crate) constrained: bool,
    pub(crate) constraints: Demand,
    /// Vectors a particle for trees of masses and charges, for the index of forces, and for the method.
    pub(crate) trees: usize,
    pub(crate) near: usize,
    pub(crate) method: usize,
    /// Vectors a particle for an index, whoever asks who is near.
    pub(crate) index: usize,
    /// Vectors a particle for meetings, when all have been moved.
    pub(crate) meetings: usize,
    /// True if births or deaths depend on who is near.
    pub(crate) crowd: bool,
}

impl Plan {
    /// Vectors for each of so many particles that all of it takes.
    ///
    /// By plain division: it is for who asks, and compilers leave that out where nobody reads the answer.
    pub(crate) fn columns(&self, capacity: usize) -> usize {
        let capacity = capacity.max(1);
        self.words(capacity, self.lasting(capacity).div_ceil(3)).div_ceil(capacity.saturating_mul(3))
    }

    /// Words for so many particles, what lasts through the step lying in so many vectors.
    #[inline(always)]
    fn words(&self, capacity: usize, lasting: usize) -> usize {
        let states = Words::columns(2 * usize::from(self.start));
        let lasting = Words { per_row: 0, fixed: lasting.saturating_mul(3) };
        self.lasting_index().and(states).and(self.passing()).and(lasting).of(capacity)
    }

    /// The words kept from step to step: columns of a user's own, what materials change, and what constraints keep.
    pub(crate) fn kept(&self) -> Words {
        Words { per_row: self.custom.saturating_add(self.ageing + self.lead), fixed: 0 }.and(self.constraints.kept)
    }

    /// Words for each of so many particles that it takes.
    pub(crate) fn kept_columns(&self, capacity: usize) -> usize {
        let Words { per_row, fixed } = self.kept();
        per_row.saturating_add(fixed.div_ceil(capacity.max(1)))
    }

    /// The same, but that nobody asks who is near whom at a step's beginning or its end.
    fn without_crowd(self) -> Self {
        Self { crowd: false, ..self }
    }

    /// The words of an index that lasts from one who asks to the next.
    fn lasting_index(&self) -> Words {
        if ARE_KEPT && self.crowd { self.index_of_all() } else { Words::NONE }
    }

    /// The words of an index of all, and of its record.
    fn index_of_all(&self) -> Words {
        Words { fixed: index_words(), ..Words::columns(self.index) }
    }

    /// Marks, and words that constraints keep through the step, for so many particles.
    fn marks_and_step(&self, capacity: usize) -> [usize; 2] {
        [if self.constrained { capacity } else { 0 }, self.constraints.step.of(capacity)]
    }

    /// Both.
    fn lasting(&self, capacity: usize) -> usize {
        let [marks, step] = self.marks_and_step(capacity);
        marks.saturating_add(step)
    }

    /// The words that its phases need in turn.
    fn passing(&self) -> Words {
        let moving = self.method.saturating_add(self.trees).saturating_add(self.passing_index());
        let index = if self.constraints.finds_near { self.index } else { 0 };
        let constraining = Words::columns(index).and(self.constraints.scratch);
        let places = if ARE_KEPT { 1 } else { self.index.saturating_add(1) };
        let crowd = if self.crowd { places } else { 0 };
        Words::columns(moving.max(self.meetings).max(crowd)).or(constraining)
    }

    /// Vectors a particle for an index of the forces' own.
    fn passing_index(&self) -> usize {
        if ARE_KEPT && self.crowd { 0 } else { self.near }
    }
}

/// Where the parts of a plan lie in memory for so many particles: one behind the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    plan: Plan,
    capacity: usize,
    /// The vectors that what lasts through the step lies in, and those that all of it takes.
    lasting: usize,
    least: usize,
}

/// The parts of the memory that a step works with.
#[derive(Debug)]
pub(crate) struct Shares<'m> {
    /// Where all were at the sub-step's beginning \[m\], and how fast \[m/s\]; empty if nobody asks.
    pub(crate) start: [&'m mut [Vec3]; 2],
    /// A mark for each particle of what constraints have done to it.
    pub(crate) marks: &'m mut [u32],
    /// The words that constraints keep through the step.
    pub(crate) step: &'m mut [u32],
    /// For whatever is at work.
    pub(crate) scratch: Scratch<'m>,
    /// For lists of neighbours, from step to step: all that is lent beyond what the plan takes.
    pub(crate) lists: &'m mut [u32],
}

/// The words that constraints keep from step to step.
#[derive(Debug, Default)]
pub struct Kept<'m> {
    /// The words of each particle: one column of [`Share::capacity`](crate::constrain::Share::capacity) words behind
    /// the other, by row.
    pub rows: &'m mut [u32],
    /// The other words.
    pub fixed: &'m mut [u32],
}

impl Kept<'_> {
    /// Makes the words those of the constraint of a `name`, which the first of the others tells; tells whether they have been somebody else's,
    /// or nobody's: all of them but that one are zeros then. A name above zero that differs by kind and by size keeps a system that goes
    /// on with other constraints than it was started with from reading what these have left. Where there are no other words, there is nothing that could tell:
    /// it says no, always, and leaves those of particles as they are.
    ///
    /// ```
    /// use pointmass::constrain::Kept;
    ///
    /// let (mut rows, mut fixed) = ([7, 7], [7, 7, 7]);
    /// let mut kept = Kept { rows: &mut rows, fixed: &mut fixed };
    /// assert!(kept.claim(0x1234) && !kept.claim(0x1234));
    /// assert_eq!((kept.rows, kept.fixed), (&mut [0, 0][..], &mut [0x1234, 0, 0][..]));
    /// ```
    pub fn claim(&mut self, name: u32) -> bool {
        let is_new = self.fixed.first().is_some_and(|&first| first != name);
        if is_new {
            self.rows.fill(0);
            self.fixed.fill(0);
            self.fixed[0] = name;
        }
        is_new
    }

    /// The same, lent on.
    pub(crate) fn again(&mut self) -> Kept<'_> {
        Kept { rows: self.rows, fixed: self.fixed }
    }
}

/// Memory that is used for one thing after the other.
#[derive(Debug)]
pub(crate) struct Scratch<'m> {
    vectors: &'m mut [Vec3],
    /// For the index of a state; none where nobody asks but forces and constraints.
    index: Lasting<'m>,
    layout: &'m Layout,
}

/// The parts of its beginning that a sub-step remembers, for reading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Past<'m> {
    pub(crate) start: [&'m [Vec3]; 2],
    /// A mark for each particle of what constraints have done to it; empty without any.
    pub(crate) marks: &'m [u32],
}

impl Layout {
    pub(crate) fn of(plan: Plan, capacity: usize) -> Self {
        let lasting = over(plan.lasting(capacity), 3);
        let columns = over(plan.words(capacity, lasting), 3 * capacity.max(1));
        Self { plan, capacity, lasting, least: columns.saturating_mul(capacity) }
    }

    /// The same for tiles of so many rows, if there is room for more: there is no share for the index of a state.
    pub(crate) fn of_tiles(&self, rows: usize) -> Self {
        Self::of(self.plan.without_crowd(), self.capacity.min(rows))
    }

    /// The words kept from step to step.
    pub(crate) fn kept_words(&self) -> Words {
        self.plan.kept()
    }

    /// The words through the step that are names by which particles are bound.
    pub(crate) fn names(&self) -> usize {
        if self.plan.constraints.binds { self.capacity } else { 0 }
    }

    /// The vectors through the step that are changes of velocities put off.
    pub(crate) fn postponed(&self) -> usize {
        if self.plan.constraints.postpones { self.capacity } else { 0 }
    }

    /// The words through the step that say what particles bear.
    pub(crate) fn loads(&self) -> usize {
        if self.plan.constraints.loads { LOAD_WORDS * self.capacity } else { 0 }
    }

    /// The number of particles that there is room for.
    pub(crate) const fn capacity(&self) -> usize {
        self.capacity
    }

    /// Tells whether so many vectors to work with and so many words to keep will do.
    pub(crate) fn fits(&self, work: usize, kept: usize) -> bool {
        self.least <= work && (self.plan.kept().of(self.capacity) <= kept || self.capacity == 0)
    }

    /// All shares.
    pub(crate) fn shares<'m>(&'m self, work: &'m mut [Vec3]) -> Shares<'m> {
        let (mut rest, lists) = work.split_at_mut(self.least.min(work.len()));
        // The first, so that it lies in the same place whatever else is asked for.
        let index = match ARE_KEPT && self.plan.crowd {
            true => Lasting::of(bytemuck::cast_slice_mut(take(&mut rest, self.lasting_index()))),
            false => Lasting::none(),
        };
        let pair = if self.plan.start { self.capacity } else { 0 };
        let start = [take(&mut rest, pair), take(&mut rest, pair)];
        let [marks, step] = self.plan.marks_and_step(self.capacity);
        let mut lasting = bytemuck::cast_slice_mut(take(&mut rest, self.lasting));
        Shares {
            start,
            marks: take(&mut lasting, marks),
            step: take(&mut lasting, step),
            scratch: Scratch { vectors: rest, index, layout: self },
            lists: bytemuck::cast_slice_mut(lists),
        }
    }

    /// Vectors for the index that lasts, which takes a whole number of them.
    fn lasting_index(&self) -> usize {
        self.plan.lasting_index().of(self.capacity) / 3
    }

    /// The index of a state, and at least a vector for each particle, before anything has been moved or when all has been done.
    pub(crate) fn crowd<'m>(
        &self,
        work: &'m mut [Vec3],
        choice: &'m dyn IndexChoice,
    ) -> (StateIndex<'m>, &'m mut [Vec3]) {
        let index = self.plan.index_of_all().of(self.capacity) / 3;
        let (index, places) = work.split_at_mut(index.min(work.len()));
        let words: &mut [u32] = bytemuck::cast_slice_mut(index);
        let (passing, lasting): (&mut [u32], _) =
            if ARE_KEPT { (&mut [], Lasting::of(words)) } else { (words, Lasting::none()) };
        (StateIndex::new(choice, passing, lasting), places)
    }

    /// Columns of a user's own, and what constraints keep.
    pub(crate) fn kept<'m>(&self, words: &'m mut [u32]) -> (&'m mut [f32], Kept<'m>) {
        let Words { per_row, fixed } = self.plan.constraints.kept;
        let mut rest = words;
        // Steps are made where all of it fits. Where it does not, products may be anything: no more is taken than there is.
        let custom = take(&mut rest, self.plan.custom.wrapping_mul(self.capacity));
        take(&mut rest, self.plan.ageing * self.capacity);
        let rows = take(&mut rest, per_row.wrapping_mul(self.capacity));
        take(&mut rest, self.plan.lead * self.capacity);
        (bytemuck::cast_slice_mut(custom), Kept { rows, fixed: take(&mut rest, fixed) })
    }

    /// What constraints have done to velocities, by columns of coordinates.
    pub(crate) fn lead<'m>(&self, words: &'m mut [u32]) -> [&'m mut [f32]; 3] {
        let mut rest = words;
        let before =
            self.plan.custom.saturating_add(self.plan.ageing).saturating_add(self.plan.constraints.kept.per_row);
        take(&mut rest, before.wrapping_mul(self.capacity));
        let column = self.plan.lead / LEAD_WORDS * self.capacity;
        [(); 3].map(|()| bytemuck::cast_slice_mut(take(&mut rest, column)))
    }

    /// Drags and masses of before materials have changed them.
    pub(crate) fn ageing<'m>(&self, words: &'m mut [u32]) -> [&'m mut [u32]; 2] {
        let mut rest = words;
        take(&mut rest, self.plan.custom.wrapping_mul(self.capacity));
        let words = take(&mut rest, self.plan.ageing * self.capacity);
        words.split_at_mut(words.len() / 2).into()
    }

    /// Memory for `rows` of `len`, and for the others, who work at the same time.
    #[cfg(feature = "rayon")]
    pub(crate) fn divided(work: &mut [Vec3], rows: usize, len: usize) -> (&mut [Vec3], &mut [Vec3]) {
        work.split_at_mut(work.len() / len.max(1) * rows)
    }

    /// The memory of a sub-step's beginning.
    pub(crate) fn past<'m>(&self, work: &'m [Vec3]) -> Past<'m> {
        let pair = if self.plan.start { self.capacity } else { 0 };
        // Where there is room for nobody, there is none for the index either.
        let work = if ARE_KEPT { work.get(self.lasting_index()..).unwrap_or_default() } else { work };
        let (start, rest) = work.split_at(2 * pair);
        let marks = if self.plan.constrained { &bytemuck::cast_slice(rest)[..self.capacity] } else { &[] };
        Past { start: start.split_at(pair).into(), marks }
    }
}

impl Scratch<'_> {
    /// For trees of masses and charges, for the index of forces, and for the method; and the index that lasts, if there is one, instead.
    pub(crate) fn moving(&mut self) -> ([&mut [u32]; 2], &mut [Vec3], Lasting<'_>) {
        let Layout { plan, capacity, .. } = self.layout;
        let mut rest = &mut *self.vectors;
        let [trees, near] = [plan.trees, plan.passing_index()].map(|columns| take(&mut rest, columns * capacity));
        ([bytemuck::cast_slice_mut(trees), bytemuck::cast_slice_mut(near)], rest, self.index.again())
    }

    /// For the index of constraints, and for them.
    pub(crate) fn constraining(&mut self) -> [&mut [u32]; 2] {
        let Layout { plan, capacity, .. } = self.layout;
        let mut rest = bytemuck::cast_slice_mut(self.vectors);
        let near = if plan.constraints.finds_near { 3 * plan.index * capacity } else { 0 };
        [take(&mut rest, near), rest]
    }
}

impl<'m> Scratch<'m> {
    /// For meetings of so many, when all have been moved: for their events, for where they were at the sub-step's beginning and for what drives them
    /// along surfaces, and for an index of where they were.
    pub(crate) fn meeting(self, len: usize) -> (&'m mut [u32], [&'m mut [Vec3]; 2], &'m mut [u32]) {
        let mut rest = self.vectors;
        let (events, columns) = (take(&mut rest, 3 * len), [(); 2].map(|()| take(&mut rest, len)));
        let index = take(&mut rest, self.layout.plan.index * len);
        (bytemuck::cast_slice_mut(events), columns, bytemuck::cast_slice_mut(index))
    }
}

/// The parts of a size in which so many have room.
fn over(many: usize, size: usize) -> usize {
    if many == 0 { 0 } else { quotient(many - 1, size) + 1 }
}

/// The first so many, or all that there are.
#[cfg_attr(one_by_one, inline(never))]
pub(crate) fn take<'m, T>(rest: &mut &'m mut [T], len: usize) -> &'m mut [T] {
    let all = core::mem::take(rest);
    let (first, others) = all.split_at_mut(len.min(all.len()));
    *rest = others;
    first
}

/// The first so many vectors, or all that there are.
#[cfg_attr(one_by_one, inline(never))]
pub(crate) fn take_vectors<'m>(rest: &mut &'m mut [u32], len: usize) -> &'m mut [Vec3] {
    vectors(take(rest, 3 * len))
}

/// As many whole vectors as there are in so many words.
#[cfg_attr(one_by_one, inline(never))]
fn vectors(words: &mut [u32]) -> &mut [Vec3] {
    let whole = words.len() - words.len() % 3;
    bytemuck::cast_slice_mut(&mut words[..whole])
}
