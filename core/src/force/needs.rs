//! The needs of forces: all that they have to find in the state.

use super::{Attributes, State, Watched};
use crate::custom::{CustomColumns, CustomColumnsMut};
use crate::index::{ARE_KEPT, BarnesHut, Found, IndexChoice, ListMemory, Neighbours, Search, StateIndex, find};
use crate::math::{length, max};
use crate::memory::{Layout, Shares};
use crate::observe::Observer;
use crate::report::{Effort, Finding};
use crate::time::Time;
use glam::Vec3;

/// Particles that look at all others for less than it takes to make an index and to look up all in it.
const FEW: usize = 64;

/// Makes trees of masses and charges. A function, so that a program with no force that names it does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct BuildTrees(pub(crate) fn(&mut Finder<'_>, &State<'_>, Then<'_>));

/// Finds neighbours, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Listing(pub(crate) fn(&mut Finder<'_>, &State<'_>, Then<'_>));

/// Lets forces change columns of a user's own, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Writing(pub(crate) fn(Written<'_>));

/// Lets forces tell whoever watches of those who have come to touch in a sub-step, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Telling(pub(crate) fn(Told<'_>));

/// All rows at a step's end, and the memory that is laid out for them.
pub(crate) struct Written<'a> {
    pub(crate) needs: Needs,
    pub(crate) attributes: &'a Attributes<'a>,
    pub(crate) index: &'a dyn IndexChoice,
    pub(crate) ends: [&'a [Vec3]; 2],
    pub(crate) kept: &'a mut [u32],
    pub(crate) work: &'a mut [Vec3],
    pub(crate) layout: &'a Layout,
    pub(crate) end: Time,
    pub(crate) effort: &'a mut Effort,
    /// What changes the columns.
    pub(crate) write: &'a mut dyn FnMut(&State<'_>, &mut CustomColumnsMut<'_>),
}

/// All rows at the end of a sub-step that somebody watches, and the memory that is laid out for them: in it lies where they began.
pub(crate) struct Told<'a> {
    pub(crate) needs: Needs,
    pub(crate) attributes: &'a Attributes<'a>,
    pub(crate) custom: CustomColumns<'a>,
    pub(crate) index: &'a dyn IndexChoice,
    pub(crate) ends: [&'a [Vec3]; 2],
    pub(crate) work: &'a mut [Vec3],
    pub(crate) layout: &'a Layout,
    pub(crate) during: [Time; 2],
    /// The number of sub-steps, and how long all of them are \[s\].
    pub(crate) substeps: u32,
    pub(crate) step: f32,
    pub(crate) observer: &'a mut dyn Observer,
    /// Functions that add up all forces on all rows, and that let them tell.
    pub(crate) add: &'a dyn Fn(&State<'_>, &mut [Vec3]),
    pub(crate) tell: &'a dyn Fn(&mut Watched<'_>),
}

/// The continuation with a state in which all is found.
pub(crate) type Then<'a> = &'a mut dyn FnMut(&State<'_>);

impl BuildTrees {
    /// Those of Barnes and Hut, by [`BarnesHut::over`].
    pub const BARNES_HUT: Self = Self(build);
}

impl Listing {
    /// Lists that last until somebody has gone half their skin, where there is memory for them.
    pub const KEPT: Self = Self(look_up);
}

impl Writing {
    /// That of all columns.
    pub const COLUMNS: Self = Self(write);
}

impl Telling {
    /// By [`Force::tell`](super::Force::tell).
    pub const TOUCHES: Self = Self(tell);
}

/// The particles that forces are asked about, from row `first` on, and the means to find what they need.
pub(crate) struct Finder<'a> {
    pub(crate) attributes: &'a Attributes<'a>,
    /// Columns of a user's own.
    pub(crate) custom: CustomColumns<'a>,
    /// The parts of the state that the forces need to find there, memory for trees, and the index.
    pub(crate) needs: Needs,
    pub(crate) tree: &'a mut [u32],
    pub(crate) index: StateIndex<'a>,
    /// Lists of neighbours, where there is memory for them.
    pub(crate) lists: Option<ListMemory<'a>>,
    pub(crate) first: usize,
    pub(crate) finding: Finding,
}

impl Finder<'_> {
    /// Calls `then` with the state as forces see it, trees and index made.
    pub(crate) fn with_state(&mut self, time: Time, position: &[Vec3], velocity: &[Vec3], then: Then<'_>) {
        self.finding.evaluations += u32::from(!position.is_empty());
        let state = self.attributes.state(self.custom, time, [position, velocity]);
        match self.needs.mass_tree.or(self.needs.charge_tree) {
            Some(trees) if position.len() >= BarnesHut::FEWEST => (trees.0)(self, &state, then),
            _ => self.with_near(&state, then),
        }
    }

    /// Calls `then` with neighbours, where anybody asks for them.
    fn with_near(&mut self, state: &State<'_>, then: Then<'_>) {
        // A few newborn look at all others, unless there is an index of these: one would be made for them alone.
        let looks = self.needs.reach > 0.0 && (self.index.is_there() || !self.are_few(state));
        match self.needs.lists.filter(|_| looks) {
            Some(lists) => (lists.0)(self, state, then),
            None => {
                self.finding.all_pairs += u32::from(looks);
                then(state);
            }
        }
    }

    /// Tells whether they are but a few newborn.
    fn are_few(&self, state: &State<'_>) -> bool {
        self.first > 0 && state.position.len() - self.first <= FEW
    }

    /// Calls `then` with the neighbours of newborn by the index of those who were there before, if there is one; says whether there is. Newborn
    /// are held against each other one by one: of so many that this takes longer than to sort all in, it does not.
    fn with_newborn(&mut self, state: &State<'_>, then: Then<'_>) -> bool {
        let (first, len) = (self.first, state.position.len());
        let newborn = len - first;
        if first == 0 || newborn.saturating_mul(newborn) > FEW * len {
            return false;
        }
        let room = self.index.choice().room();
        self.index.take_up(&state.position[..first], &mut |index| {
            then(&State { near: Neighbours::by_first(index, first, state.position).in_room(room), ..*state });
        })
    }
}

fn write(rows: Written<'_>) {
    let Written { needs, attributes, index, ends: [position, velocity], kept, work, layout, end, effort, write } = rows;
    let (values, seen) = (layout.kept(kept).0, attributes.lives.custom);
    let mut custom = CustomColumnsMut::new(seen.list(), values, layout.capacity(), position.len());
    let mut scratch = layout.shares(work).scratch;
    let ([tree, near], _, lasting) = scratch.moving();
    let (index, finding) = (StateIndex::new(index, near, lasting), Finding::default());
    let mut finder = Finder { attributes, custom: seen, needs, tree, index, lists: None, first: 0, finding };
    finder.with_state(end, position, velocity, &mut |state| write(state, &mut custom));
    effort.found(&finder.finding);
}

fn tell(rows: Told<'_>) {
    let Told { needs, attributes, custom, index, ends: [position, velocity], work, layout, observer, .. } = rows;
    let (len, Shares { start, mut scratch, .. }) = (position.len(), layout.shares(work));
    let [x, v] = start.map(|column| &column[..len]);
    let ([tree, near], memory, lasting) = scratch.moving();
    let (index, finding) = (StateIndex::new(index, near, lasting), Finding::default());
    // What forces fell back on to find neighbours has been counted when they moved everybody.
    let mut finder = Finder { attributes, custom, needs, tree, index, lists: None, first: 0, finding };
    finder.with_state(rows.during[1], position, velocity, &mut |now| {
        let work_out = &mut |now: &State<'_>| {
            let total = &mut memory[..len];
            total.fill(Vec3::ZERO);
            (rows.add)(now, total);
            length(mean_acceleration(total, now.mass)) * rows.step
        };
        let (before, inverse_mass) = (now.moved(rows.during[0], x, v), attributes.inverse_mass);
        let (now, substeps, observer) = (*now, rows.substeps, &mut *observer);
        (rows.tell)(&mut Watched { before, now, inverse_mass, substeps, rests: None, work_out, observer });
    });
}

/// The acceleration of all together by these forces; zero, if there is none to be told.
fn mean_acceleration(forces: &[Vec3], masses: &[f32]) -> Vec3 {
    let (mut sum, mut whole) = (Vec3::ZERO, 0.0);
    for (&force, &mass) in forces.iter().zip(masses) {
        if force.is_finite() && mass < f32::INFINITY {
            (sum, whole) = (sum + force, whole + mass);
        }
    }
    let mean = sum / whole;
    if mean.is_finite() { mean } else { Vec3::ZERO }
}

fn build(finder: &mut Finder<'_>, state: &State<'_>, then: Then<'_>) {
    let (needs, memory) = (finder.needs, core::mem::take(&mut finder.tree));
    // No more memory than these particles call for: more would make other nodes, and so other bits.
    let words = 3 * BarnesHut::COLUMNS * state.position.len();
    let first = if needs.mass_tree.is_some() { words.min(memory.len()) } else { 0 };
    let (of_mass, of_charge) = memory.split_at_mut(first);
    let second = words.min(of_charge.len());
    let mass_tree = needs.mass_tree.and_then(|_| BarnesHut::over(of_mass, state.position, state.mass));
    let of_charge = &mut of_charge[..second];
    let charge_tree = needs.charge_tree.and_then(|_| BarnesHut::over(of_charge, state.position, state.charge));
    finder.with_near(&State { mass_tree: mass_tree.as_ref(), charge_tree: charge_tree.as_ref(), ..*state }, then);
    finder.tree = memory;
}

fn look_up(finder: &mut Finder<'_>, state: &State<'_>, then: Then<'_>) {
    if ARE_KEPT && finder.with_newborn(state, then) {
        finder.finding.streamed += 1;
        return;
    }
    if ARE_KEPT && finder.are_few(state) {
        return then(state);
    }
    let (index, lists, reach) =
        (finder.index.again(), finder.lists.as_mut().map(ListMemory::again), finder.needs.reach);
    let mut found = Found::AllPairs;
    find(Search { index, lists, reach }, [state.position, state.velocity], &mut |near, how| {
        found = how;
        then(&State { near, ..*state });
    });
    finder.finding.lists += u32::from(found == Found::Listed);
    finder.finding.streamed += u32::from(found == Found::Streamed);
    finder.finding.all_pairs += u32::from(found == Found::AllPairs);
}

/// The needs of a force: all that it has to find in the state, beyond the particles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// [`State::mass_tree`](super::State::mass_tree), and what makes it.
    pub mass_tree: Option<BuildTrees>,
    /// [`State::charge_tree`](super::State::charge_tree), and what makes it.
    pub charge_tree: Option<BuildTrees>,
    /// The radius within which [`State::near`](super::State::near) is asked for neighbours \[m\]; zero: it is not.
    pub reach: f32,
    /// The finder: [`Listing::KEPT`]. A function, likewise; without it all pairs are looked at, which is counted.
    pub lists: Option<Listing>,
    /// To change columns of a user's own, by [`Force::write`](super::Force::write): [`Writing::COLUMNS`]. A function, likewise; without it a
    /// force is not asked to.
    pub write: Option<Writing>,
    /// To tell whoever watches of those who have come to touch, by [`Force::tell`](super::Force::tell): [`Telling::TOUCHES`]. A function, likewise; without it
    /// a force is not asked to. A system then keeps where all were as a sub-step began, which takes two vectors for each particle.
    pub tell: Option<Telling>,
}

impl Needs {
    /// Neighbours within a radius \[m\], in lists where there is memory for them.
    #[must_use]
    pub fn within(reach: f32) -> Self {
        Self { reach: max(reach, 0.0), lists: Some(Listing::KEPT), ..Self::default() }
    }

    /// The needs of two forces.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            mass_tree: self.mass_tree.or(other.mass_tree),
            charge_tree: self.charge_tree.or(other.charge_tree),
            reach: max(self.reach, other.reach),
            lists: self.lists.or(other.lists),
            write: self.write.or(other.write),
            tell: self.tell.or(other.tell),
        }
    }

    /// Vectors for each particle that the trees take.
    #[must_use]
    pub const fn tree_columns(self) -> usize {
        BarnesHut::COLUMNS * (self.mass_tree.is_some() as usize + self.charge_tree.is_some() as usize)
    }

    /// Vectors for each particle that it takes to work it all out, neighbours by `index`.
    #[must_use]
    pub fn columns(self, index: &dyn IndexChoice) -> usize {
        self.tree_columns() + if self.reach > 0.0 { index.columns() } else { 0 }
    }
}
