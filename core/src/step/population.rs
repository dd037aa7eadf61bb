//! The system as a step finds it: what a scene begins with is put in, who has died is taken out.

use crate::force::{SpringList, State};
use crate::memory::{Attribute, Layout, Slices, Storage, TILED, Workspace};
use crate::particles::{Full, Particle};
use crate::report::Report;
use crate::scene::Scene;
use crate::time::Time;

/// Rows that are taken out at once, at the most.
pub(crate) const AT_ONCE: usize = if TILED { 64 } else { 1 };

impl Workspace<'_> {
    /// Where the memory that a scene's step asks for lies.
    pub(crate) fn layout(&self, scene: &Scene<'_>) -> Layout {
        Layout::of(scene.plan(), self.capacity)
    }

    #[inline(never)]
    pub(crate) fn start(&mut self, scene: &Scene<'_>, layout: &Layout) {
        self.memory.emitter_states.fill(Default::default());
        self.status.emitters = scene.emitters.count();
        self.status.is_reaped = !scene.reapers.is_empty();
        self.status.kept = layout.kept_words();
        self.memory.kept.fill(0);
        for particle in scene.start {
            let given = self.put(particle, Time::ZERO);
            let totals = &mut self.status.totals;
            match given {
                Ok(_) => totals.initial += 1,
                Err(Full) => totals.refused = totals.refused.saturating_add(1),
            }
        }
        self.status.start = self.status.taken;
        self.give_custom(scene.custom, layout, 0);
        self.age(scene, layout, [Time::ZERO; 2]);
        self.memory.last_spring.own().fill(0);
        // Entries beyond the lists count in the fingerprint: an earlier scene's broken springs must not.
        self.memory.incident.fill(0);
        self.status.totals.caps.springs = self.take_up_springs(scene);
    }

    /// Sorts the scene's springs by their ends unless that has been done with a list of these ends, and counts those that lack one then. None
    /// of them is broken then. A list without springs leaves what there is alone.
    pub(crate) fn take_up_springs(&mut self, scene: &Scene<'_>) -> u64 {
        let Some(code) = scene.springs.code() else { return 0 };
        let list = scene.springs.list();
        let name = (code.name)(list);
        if name == 0 || name == self.status.springs {
            return 0;
        }
        self.status.springs = name;
        let (last, incident) = (self.memory.last_spring.own(), &mut *self.memory.incident);
        last.fill(0);
        incident.fill(0);
        (code.sort)(list, last, incident);
        (code.lacking)(&self.memory.columns().springs(list, self.status))
    }

    /// Tells whether a step can be made in the memory that there is.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn fits(&self, scene: &Scene<'_>, layout: &Layout) -> bool {
        let Slices { emitter_states, incident, work, kept, .. } = &self.memory;
        let [emitters, springs] = [scene.emitters.count(), scene.springs.list().len()];
        emitters <= emitter_states.len() && springs <= incident.len() / 2 && layout.fits(work.len(), kept.len())
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
        let lacks = self.lacks(scene);
        if lacks.is_some() {
            return lacks;
        }
        let mut differs = None;
        let has_room = self.capacity() > 0;
        let mut ask = |particle: &Particle| {
            if has_room && differs.is_none() {
                differs = self.memory.give(0, particle).err();
            }
        };
        scene.start.iter().for_each(&mut ask);
        scene.emitters.extremes(&mut ask);
        differs.map(Attribute::name)
    }

    /// The particles as forces see them.
    pub(crate) fn state<'s>(&'s self, scene: &Scene<'s>) -> State<'s> {
        self.memory.columns().state(&scene.backdrop(), self.status)
    }

    /// Takes the particles in some rows out, no more than [`AT_ONCE`], from back to front; the last row fills each gap. Where there are springs,
    /// there must not be more than one.
    #[cfg_attr(one_by_one, inline(always))]
    #[cfg_attr(not(one_by_one), inline(never))]
    pub(crate) fn remove(&mut self, rows: &[u32], springs: &dyn SpringList, report: &mut Report) {
        let (capacity, mut moves) = (self.capacity(), [[0; 2]; AT_ONCE]);
        for (&row, onto) in rows.iter().zip(&mut moves) {
            if let Some(code) = springs.code() {
                let table = self.memory.columns().springs(springs.list(), self.status);
                report.caps.springs += (code.held_by)(&table, row as usize);
            }
            let (m, status) = (&mut self.memory, &mut *self.status);
            let last = status.len - 1;
            let slot = m.slot[row as usize];
            let moved = m.slot[last];
            m.slot[row as usize] = moved;
            m.row_of[moved as usize] = row;
            m.row_of[slot as usize] = status.free;
            status.free = slot + 1;
            status.len = last;
            status.changes = status.changes.wrapping_add(1);
            // There are fewer than 2³² slots, and so fewer rows.
            *onto = [last as u32, row];
        }
        // Slots, too, once more: to where they are already.
        let moves = &moves[..rows.len()];
        self.memory.move_rows(moves);
        for column in self.memory.kept.chunks_mut(capacity).take(self.status.kept.per_row) {
            moves.iter().for_each(|[from, to]| column[*to as usize] = column[*from as usize]);
        }
    }
}
