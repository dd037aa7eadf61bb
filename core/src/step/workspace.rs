//! A system with its memory at hand: every phase of a step works on it.

use crate::custom::{CustomColumnsMut, Newcomers};
use crate::force::State;
use crate::index::Listed;
use crate::memory::{Layout, Slices, Storage, Words};
use crate::particles::{Full, Particle};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

/// A system with its memory at hand: every algorithm works on it, and it is generic over nothing.
#[derive(Debug)]
pub(crate) struct Workspace<'a> {
    pub(crate) memory: Slices<'a>,
    /// The number of particles that fit.
    pub(crate) capacity: usize,
    pub(crate) status: &'a mut Status,
}

/// All of a system's state that is not a column.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Status {
    /// Rows in use.
    pub(crate) len: usize,
    /// Slots ever used.
    pub(crate) slots: usize,
    /// The first free slot plus one; zero: none.
    pub(crate) free: u32,
    /// Particles taken in so far.
    pub(crate) taken: u32,
    /// Particles of the scene's start that found room.
    pub(crate) start: u32,
    /// Particles put in without an emitter so far, those that found no room included.
    pub(crate) given: u32,
    /// True if a scene has had reapers, so that keys decide what becomes of particles.
    pub(crate) is_reaped: bool,
    /// Emitters that the scene had then.
    pub(crate) emitters: usize,
    /// Lists of neighbours, and how many particles have come and gone, which ends them.
    pub(crate) listed: Listed,
    pub(crate) changes: u32,
    /// The words that the scene keeps of particles.
    pub(crate) kept: Words,
    pub(crate) time: Time,
    /// What is known of the masses and drags of all.
    pub(crate) inertias: Inertias,
    /// How long before the end of all time the first of them dies of age, or sooner: an empty system is nothing but zeros.
    pub(crate) ends_before_never: Time,
    /// The step that an integrator which chooses its own goes on with.
    pub(crate) hint: Time,
    pub(crate) seed: u64,
    pub(crate) totals: Report,
}

/// The mass and the drag of the first that has come since a start, whether it is fixed, and who is like it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Inertias {
    likeness: Likeness,
    mass: f32,
    drag: f32,
    fixed: bool,
}

/// Who is like the first. Nobody has come is the first of these, so that an empty system is nothing but zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Likeness {
    #[default]
    Nobody,
    All,
    Some,
}

impl Inertias {
    const UNKNOWN: Self = Self { likeness: Likeness::Nobody, mass: 0.0, drag: 0.0, fixed: false };

    /// They change, each by itself.
    pub(crate) const VARIOUS: Self = Self { likeness: Likeness::Some, ..Self::UNKNOWN };

    /// Tells whether all are known to have the same.
    pub(crate) fn are_alike(&self) -> bool {
        self.likeness == Likeness::All
    }

    /// Another one comes.
    pub(crate) fn add(&mut self, &Particle { mass, drag, fixed, .. }: &Particle) {
        let is_like =
            self.mass.to_bits() == mass.to_bits() && self.drag.to_bits() == drag.to_bits() && self.fixed == fixed;
        match self.likeness {
            Likeness::Nobody => *self = Self { likeness: Likeness::All, mass, drag, fixed },
            Likeness::All if !is_like => self.likeness = Likeness::Some,
            _ => {}
        }
    }
}

impl Status {
    pub(crate) const NEW: Self = Self {
        len: 0,
        slots: 0,
        free: 0,
        taken: 0,
        start: 0,
        given: 0,
        is_reaped: false,
        emitters: 0,
        listed: Listed::NONE,
        changes: 0,
        kept: Words::NONE,
        time: Time::ZERO,
        inertias: Inertias::UNKNOWN,
        ends_before_never: Time::ZERO,
        hint: Time::ZERO,
        seed: 0,
        totals: Report::NOTHING,
    };

    /// An instant before which nobody dies of age.
    pub(crate) fn next_end(&self) -> Time {
        Time::NEVER - self.ends_before_never
    }

    /// Somebody dies of age at an instant.
    pub(crate) fn ends_at(&mut self, dies: Time) {
        self.ends_before_never = self.ends_before_never.max(Time::NEVER - dies);
    }

    /// Forgets who has died, and knows when these do.
    pub(crate) fn end_at(&mut self, dies: &[Time]) {
        self.ends_before_never = Time::NEVER - dies.iter().fold(Time::NEVER, |first, &dies| first.min(dies));
    }
}

impl Workspace<'_> {
    pub(crate) fn len(&self) -> usize {
        self.status.len
    }

    pub(crate) fn seed(&self) -> u64 {
        self.status.seed
    }

    pub(crate) fn is_full(&self) -> bool {
        self.status.len >= self.capacity()
    }

    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// Where the memory that a scene's step asks for lies.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(crate) fn layout(&self, scene: &Scene<'_>) -> Layout {
        Layout::of(scene.plan(), self.capacity)
    }

    #[inline(never)]
    pub(crate) fn start(&mut self, scene: &Scene<'_>) {
        self.memory.emitter_states.fill(Default::default());
        self.status.emitters = scene.emitters.count();
        self.status.is_reaped = !scene.reapers.is_empty();
        self.status.kept = scene.plan().kept();
        self.memory.kept.fill(0);
        let mut report = Report::default();
        for particle in scene.start {
            match self.put(particle, Time::ZERO) {
                Ok(_) => report.initial += 1,
                Err(Full) => report.refused = report.refused.saturating_add(1),
            }
        }
        self.status.start = self.status.taken;
        self.give_custom(scene, 0);
        self.memory.last_spring.own().fill(0);
        // Entries beyond the lists count in the fingerprint: an earlier scene's broken springs must not.
        self.memory.incident.fill(0);
        if let Some(code) = scene.springs.code() {
            let (last, incident) = (self.memory.last_spring.own(), &mut *self.memory.incident);
            report.caps.springs = (code.sort)(scene.springs.list(), last, incident, self.status.start);
        }
        self.status.totals = report;
    }

    /// An attribute that the memory holds for all alike, where the scene changes it or sorts by it.
    pub(crate) fn lacks(&self, scene: &Scene<'_>) -> Option<&'static str> {
        let Slices { drag, mass, inverse_mass, last_spring, .. } = &self.memory;
        let changes = scene.materials.code().is_some_and(|code| (code.kept)(scene.materials) > 0);
        if changes && !(drag.is_own() && mass.is_own() && inverse_mass.is_own()) {
            return Some("drag, mass and inverse_mass");
        }
        (!scene.springs.list().is_empty() && !last_spring.is_own()).then_some("last_spring")
    }

    /// The same, or one in which a particle that the scene begins with or bears differs from what all have. It is put in the first row to
    /// find out, where nobody lives yet.
    pub(crate) fn differs(&mut self, scene: &Scene<'_>) -> Option<&'static str> {
        let mut differs = self.lacks(scene);
        let has_room = self.capacity() > 0;
        let mut ask = |particle: &Particle| {
            if has_room && differs.is_none() {
                differs = self.memory.give(0, particle).err();
            }
        };
        scene.start.iter().for_each(&mut ask);
        scene.emitters.extremes(&mut ask);
        differs
    }

    /// The particles as forces see them.
    pub(crate) fn state<'s>(&'s self, scene: &Scene<'s>) -> State<'s> {
        self.memory.columns().state(scene, self.status)
    }

    /// Columns of a user's own, for writing.
    pub(crate) fn custom_mut<'s>(&'s mut self, scene: &Scene<'s>) -> CustomColumnsMut<'s> {
        let (capacity, len) = (self.capacity(), self.len());
        let (values, _) = self.layout(scene).kept(self.memory.kept);
        CustomColumnsMut::new(scene.custom, values, capacity, len)
    }

    /// Gives rows from `first` on what they begin with in columns of a user's own.
    pub(crate) fn give_custom(&mut self, scene: &Scene<'_>, first: usize) {
        let Some(code) = scene.custom.code() else { return };
        let layout = self.layout(scene);
        let rows = Newcomers { first, len: self.len(), start: self.status.start, layout };
        (code.give)(scene.custom, &mut self.memory, rows);
    }
}
