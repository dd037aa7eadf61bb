//! The scene as a system steps through it.

use crate::collide::{MarkCode, Meetings, Obstacles, Paths};
use crate::constrain::Constraint;
use crate::custom::CustomList;
use crate::emit::Emit;
use crate::force::{Backdrop, Force, SpringList, Telling};
use crate::index::IndexChoice;
use crate::integrate::{Integrator, Symplectic};
use crate::material::MaterialList;
use crate::math::max;
use crate::memory::{LEAD_WORDS, Likeness, Own, Plan, Size};
use crate::observe::{Attention, Observer};
use crate::particles::Particle;
use crate::reap::Reaper;
use crate::shape::Collider;

/// The rules of a world: immutable while it runs. Lists are closed under composition, so each field is one thing.
///
/// ```
/// use pointmass::{Drag, Gravity, Scene};
/// let scene = Scene { forces: &(Gravity::EARTH, Drag {}), ..Scene::EMPTY };
/// ```
///
/// Arrays, vectors, tuples, options and boxes are lent as they are. A slice is lent twice, since how long it is does not fit into a reference to a trait:
///
/// ```
/// use pointmass::{Distance, Scene};
/// let rods: &[Distance] = &[Distance::rod([0, 1], 0.1), Distance::rod([1, 2], 0.1)];
/// let scene = Scene { constraints: &&rods[1..], ..Scene::EMPTY };
/// ```
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The particles it begins with.
    pub start: &'a [Particle],
    /// Springs between them. A system may go on with others: where ends differ, or how many springs there are, they are taken up anew as the next
    /// step begins, and none of them is broken, so that those that were ([`Springs::is_broken`](crate::force::Springs::is_broken)) have to be left
    /// out; where only stiffness, lengths and the like differ, those that are broken stay so.
    pub springs: &'a dyn SpringList,
    /// Emitters, which bring further particles into the world.
    pub emitters: &'a dyn Emit,
    /// The forces on particles, springs aside.
    pub forces: &'a dyn Force,
    /// The things that they bounce off.
    pub colliders: &'a dyn Collider,
    /// The things that they vanish at.
    pub sinks: &'a dyn Collider,
    /// The other rules by which they die, beside age and sinks.
    pub reapers: &'a dyn Reaper,
    /// The numbers with names that each particle has beside the engine's own attributes.
    pub custom: &'a dyn CustomList,
    /// The materials of particles and surfaces, by numbers; beyond them all nothing rubs or changes.
    pub materials: &'a dyn MaterialList,
    /// The constraints that bind them together and keep them apart.
    pub constraints: &'a dyn Constraint,
    /// Parts that a step is cut into for the method, the constraints and the scenery, 1 to 1000: the finer, the stiffer are constraints. So many
    /// parts of a step do what as many steps of their length do, but for births and deaths, reapers, springs that break, ageing, the sides of a periodic room, columns
    /// that forces write and what constraints do once a step, such as making lists, which are once a step.
    pub substeps: u32,
    /// How their paths are held against all that.
    pub paths: Paths,
    /// The answer of those that have a radius where they meet.
    pub meetings: Meetings,
    /// How often a particle may bounce in one sub-step before it waits at the surface for its end, which is counted in
    /// `caps.bounces`: by default 64 times. What slides within a surface that curves hops along it by chords, about 35 of them where it
    /// goes a fifteenth of the radius in a sub-step. By [`Impulse`](crate::Impulse) it may meet others and colliders half as often.
    pub max_bounces: u32,
    /// How they are moved.
    pub integrator: &'a dyn Integrator,
    /// How forces find the neighbours of a particle: `()` by looking at all others.
    pub index: &'a dyn IndexChoice,
}

impl core::fmt::Debug for Scene<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Scene").field("size", &self.size()).finish_non_exhaustive()
    }
}

/// Vectors a particle for lists of neighbours.
const LISTS: usize = 22;

impl Scene<'_> {
    /// Nothing at all, moved by symplectic Euler.
    pub const EMPTY: Scene<'static> = Scene {
        start: &[],
        springs: &(),
        emitters: &(),
        forces: &(),
        colliders: &(),
        sinks: &(),
        reapers: &(),
        custom: &(),
        materials: &(),
        constraints: &(),
        substeps: 1,
        paths: Paths::CURVED,
        meetings: Meetings::Through,
        max_bounces: 64,
        integrator: &Symplectic,
        index: &(),
    };

    /// Vectors that a step needs to work with for each particle, if there is room for as many as it begins with or more.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.plan().columns(self.start.len())
    }

    /// Vectors for each particle with which neighbours are kept in lists, where forces ask for them: room for some 55 of each.
    /// With less memory they are looked up anew in each evaluation, to the same bits.
    #[must_use]
    pub fn columns_with_lists(&self) -> usize {
        self.columns().saturating_add(self.list_columns())
    }

    /// The part of it for lists alone.
    pub(crate) fn list_columns(&self) -> usize {
        if self.forces.needs().lists.is_some() { LISTS } else { 0 }
    }

    /// Words that are kept of each particle, if there is room for as many as it begins with or more.
    #[must_use]
    pub fn kept(&self) -> usize {
        self.plan().kept_columns(self.start.len())
    }

    /// The memory that a step works with. Of a scene that is known when it is linked hardly more than numbers is left of it.
    #[inline(always)]
    pub(crate) fn plan(&self) -> Plan {
        let needs = self.forces.needs();
        let (constrained, index) = (!self.constraints.is_empty(), self.index.columns());
        Plan {
            custom: self.custom.count(),
            ageing: self.materials.code().map_or(0, |code| (code.kept)(self.materials)),
            start: self.needs_start() || needs.tell.is_some(),
            lead: if constrained && self.integrator.lead() > 0.0 { LEAD_WORDS } else { 0 },
            constrained,
            constraints: self.constraints.demand().with_shared(),
            trees: needs.tree_columns(),
            near: if needs.reach > 0.0 { index } else { 0 },
            // Newborns need one for their acceleration, whatever the method.
            method: self.integrator.columns().max(1),
            index,
            crowd: self.asks_around(),
            meetings: self.meetings.columns().saturating_add(if self.meetings.is_through() { 0 } else { index }),
        }
    }

    /// The function that lets forces tell of those who come to touch, if somebody watches.
    pub(crate) fn telling(&self, observer: &dyn Observer) -> Option<Telling> {
        // Nobody asks the forces where it is known that nobody watches.
        if observer.attention() > Attention::Nothing { self.forces.needs().tell } else { None }
    }

    /// Tells whether births or deaths depend on who is near.
    pub(crate) fn asks_around(&self) -> bool {
        self.emitters.reach() > 0.0 || self.reapers.reach() > 0.0
    }

    /// How far any of births, forces and deaths looks that asks who is near \[m\].
    pub(crate) fn reach(&self) -> f32 {
        max(self.forces.needs().reach, max(self.emitters.reach(), self.reapers.reach()))
    }

    /// Parts that a step is cut into.
    pub(crate) fn pieces(&self) -> u32 {
        self.substeps.clamp(1, 1000)
    }

    /// The least memory it runs in with as many particles as it begins with; where emitters add to them, see [`size_for`](Self::size_for).
    #[must_use]
    pub fn size(&self) -> Size {
        self.size_for(self.start.len())
    }

    /// The least memory it runs in with at most so many particles alive at once.
    ///
    /// ```
    /// use pointmass::shape::Sphere;
    /// use pointmass::{Emitter, Heap, Scene, System, Varied, Vec3};
    ///
    /// let ball = Sphere { center: Vec3::ZERO, radius: 0.1 };
    /// let source = Emitter { lifetime: Varied::exactly(2.0), ..Emitter::new(ball, 100.0) };
    /// let scene = Scene { emitters: &source, ..Scene::EMPTY };
    /// let system = System::with(Heap::new(scene.size_for(200)));
    /// assert_eq!(system.capacity(), 200);
    /// ```
    #[must_use]
    pub fn size_for(&self, particles: usize) -> Size {
        let plan = self.plan();
        Size {
            particles,
            emitters: self.emitters.count(),
            springs: self.springs.list().len(),
            columns: plan.columns(particles),
            kept: plan.kept_columns(particles),
        }
    }

    /// What the particles that it begins with and bears have in common, for memory that holds that once ([`Heap::alike`](crate::Heap::alike));
    /// nothing where an emitter does not tell what it bears ([`Emit::extremes`]). Springs and materials that change drags or
    /// masses call for columns of their own. Who puts in other particles adds them ([`Likeness::add`]).
    #[must_use]
    pub fn likeness(&self) -> Likeness {
        let mut all: Option<Likeness> = None;
        let mut add = |particle: &Particle| all.get_or_insert_with(|| Likeness::of(*particle)).add(particle);
        self.start.iter().for_each(&mut add);
        let are_all = self.emitters.extremes(&mut add);
        let Likeness { particle, mut own } = all.unwrap_or_default();
        own.last_spring |= !self.springs.list().is_empty();
        if self.materials.code().is_some_and(|code| (code.kept)(self.materials) > 0) {
            own = Own { drag: true, mass: true, inverse_mass: true, ..own };
        }
        Likeness { particle, own: if are_all { own } else { Own::ALL } }
    }

    /// Tells whether paths are to be followed through space.
    pub(crate) fn is_swept(&self) -> bool {
        !(self.colliders.is_empty() && self.sinks.is_empty() && self.meetings.is_through())
    }

    pub(crate) fn needs_start(&self) -> bool {
        self.integrator.needs_start() || self.is_swept() || !self.constraints.is_empty()
    }
}

impl<'a> Scene<'a> {
    /// What shows of it in the state of its particles.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn backdrop(&self) -> Backdrop<'a> {
        let Self { springs, materials, custom, index, .. } = *self;
        Backdrop { springs: springs.list(), materials, custom, room: index.room() }
    }

    /// What the paths of its particles are held against.
    pub(crate) fn obstacles(&self) -> Obstacles<'a> {
        let Self { colliders, sinks, materials, forces, max_bounces, .. } = *self;
        let lead = self.springs.code().filter(|_| !self.springs.list().is_empty()).map(|code| code.lead);
        let marks = self.constraints.code().map(|_| MarkCode::ALL);
        let mixing = materials.mixing();
        Obstacles { colliders, sinks, materials, forces, mixing, max_bounces, lead, marks }
    }
}

/// A scene needs more memory than the system has, particles aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsufficientMemory {
    /// The memory that the scene needs.
    pub need: Size,
    /// The memory that there is.
    pub have: Size,
    /// An attribute that the memory holds for all particles alike ([`Column::Common`](crate::Column)), where the scene needs it of each.
    pub differs: Option<&'static str>,
}

impl core::fmt::Display for InsufficientMemory {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { need, have, differs } = self;
        if let Some(attribute) = differs {
            return write!(
                f,
                "the scene needs a column of its own for {attribute}, which the system's memory holds for all particles alike"
            );
        }
        write!(
            f,
            "the scene needs {} emitters, {} springs, {} columns and {} kept words, the system has {}, {}, {} and {}",
            need.emitters, need.springs, need.columns, need.kept, have.emitters, have.springs, have.columns, have.kept
        )
    }
}

impl core::error::Error for InsufficientMemory {}
