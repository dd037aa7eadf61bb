//! The needs of forces: all that they have to find in the state.

use super::{Attributes, State};
use crate::custom::CustomColumnsMut;
use crate::index::{BarnesHut, Found, IndexChoice, ListMemory, Search, find};
use crate::integrate::Field;
use crate::math::max;
use crate::memory::Layout;
use crate::report::Effort;
use crate::scene::Scene;
use crate::time::Time;
use glam::Vec3;

/// Makes trees of masses and charges. A function, so that a program with no force that names it does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct BuildTrees(pub(crate) fn(&mut Field<'_>, &State<'_>, Then<'_>));

/// Finds neighbours, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Listing(pub(crate) fn(&mut Field<'_>, &State<'_>, Then<'_>));

/// Lets forces change columns of a user's own, likewise.
#[derive(Clone, Copy, Debug)]
pub struct Writing(pub(crate) fn(Written<'_>));

/// All rows at a step's end, the memory that is laid out for them, and the step's length.
pub(crate) struct Written<'a> {
    pub(crate) scene: &'a Scene<'a>,
    pub(crate) attributes: &'a Attributes<'a>,
    pub(crate) ends: [&'a [Vec3]; 2],
    pub(crate) kept: &'a mut [u32],
    pub(crate) work: &'a mut [Vec3],
    pub(crate) layout: Layout,
    pub(crate) end: Time,
    pub(crate) dt: f32,
    pub(crate) effort: &'a mut Effort,
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

fn write(rows: Written<'_>) {
    let Written { scene, attributes, ends: [position, velocity], kept, work, layout, end, dt, effort } = rows;
    let values = layout.kept(kept).0;
    let mut custom = CustomColumnsMut::new(scene.custom, values, layout.capacity(), position.len());
    let mut scratch = layout.shares(work).scratch;
    let ([tree, near], _) = scratch.moving();
    let (needs, observer) = (scene.forces.needs(), &mut ());
    let seen = attributes.lives.custom;
    let mut field = Field {
        scene,
        attributes,
        custom: seen,
        needs,
        tree,
        near,
        lists: None,
        first: 0,
        effort: Effort::NONE,
        observer,
    };
    field.with_state(end, position, velocity, &mut |state| scene.forces.write(state, &mut custom, dt));
    effort.found(&field.effort);
}

fn build(field: &mut Field<'_>, state: &State<'_>, then: Then<'_>) {
    let (needs, memory) = (field.needs, core::mem::take(&mut field.tree));
    // No more memory than these particles call for: more would make other nodes, and so other bits.
    let words = 3 * BarnesHut::COLUMNS * state.position.len();
    let first = if needs.mass_tree.is_some() { words.min(memory.len()) } else { 0 };
    let (of_mass, of_charge) = memory.split_at_mut(first);
    let second = words.min(of_charge.len());
    let mass_tree = needs.mass_tree.and_then(|_| BarnesHut::over(of_mass, state.position, state.mass));
    let of_charge = &mut of_charge[..second];
    let charge_tree = needs.charge_tree.and_then(|_| BarnesHut::over(of_charge, state.position, state.charge));
    field.with_near(&State { mass_tree: mass_tree.as_ref(), charge_tree: charge_tree.as_ref(), ..*state }, then);
    field.tree = memory;
}

fn look_up(field: &mut Field<'_>, state: &State<'_>, then: Then<'_>) {
    let (index, reach) = (field.scene.index, field.needs.reach);
    let words = (3 * index.columns() * state.position.len()).min(field.near.len());
    let (memory, lists) = (&mut field.near[..words], field.lists.as_mut().map(ListMemory::again));
    let mut found = Found::AllPairs;
    find(Search { index, memory, lists, reach }, [state.position, state.velocity], &mut |near, how| {
        found = how;
        then(&State { near, ..*state });
    });
    field.effort.lists += u64::from(found == Found::Listed);
    field.effort.streamed += u64::from(found == Found::Streamed);
    field.effort.all_pairs += u64::from(found == Found::AllPairs);
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
