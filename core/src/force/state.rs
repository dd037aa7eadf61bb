//! The particles as whatever acts on them sees them.

use super::{Spring, Springs};
use crate::custom::{CustomColumns, CustomList};
use crate::index::{BarnesHut, Neighbours, Room, between};
use crate::material::MaterialList;
use crate::memory::{Columns, Status};
use crate::particles::{Color, Id};
use crate::rng::later;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// The particles as forces and reapers see them: one entry a row.
#[derive(Clone, Copy)]
pub struct State<'a> {
    /// The instant.
    pub time: Time,
    /// The instant at which the sub-step began that a method looks for forces in; outside of one, `time`. What is switched on or off at an instant is so
    /// for sub-steps that begin then or later, at the very instant that is the end of one as well.
    pub since: Time,
    /// Positions \[m\].
    pub position: &'a [Vec3],
    /// Velocities \[m/s\].
    pub velocity: &'a [Vec3],
    /// Radii \[m\].
    pub radius: &'a [f32],
    /// Masses \[kg\].
    pub mass: &'a [f32],
    /// Coefficients of linear drag \[kg/s\].
    pub drag: &'a [f32],
    /// Charges \[C\].
    pub charge: &'a [f32],
    /// When they were born.
    pub born: &'a [Time],
    /// When they die of age; [`Time::NEVER`]: never.
    pub dies: &'a [Time],
    /// The slots they hold; see [`id`](State::id).
    pub slot: &'a [u32],
    /// The keys by which their random numbers are drawn; see [`word`](State::word).
    pub key: &'a [u32],
    /// Their colours, without what materials make of them.
    pub color: &'a [Color],
    /// Numbers of their materials plus one; zero: none.
    pub material: &'a [u16],
    /// The scene's materials.
    pub materials: &'a dyn MaterialList,
    /// Columns of a user's own.
    pub custom: CustomColumns<'a>,
    /// The springs between them.
    pub springs: Springs<'a>,
    /// The neighbours of each: `near.of(rows, radius, &mut |row, others| …)` tells, in a step and outside, who is around whom, which leaves
    /// out who is asked about.
    pub near: Neighbours<'a>,
    /// Their masses in a tree, while a step is made, if a force needs it and there are at least 128 of them.
    pub mass_tree: Option<&'a BarnesHut<'a>>,
    /// Their charges in a tree, likewise.
    pub charge_tree: Option<&'a BarnesHut<'a>>,
}

impl<'a> State<'a> {
    /// Nobody.
    pub(crate) const EMPTY: State<'static> = State {
        time: Time::ZERO,
        since: Time::ZERO,
        position: &[],
        velocity: &[],
        radius: &[],
        mass: &[],
        drag: &[],
        charge: &[],
        born: &[],
        dies: &[],
        slot: &[],
        key: &[],
        color: &[],
        material: &[],
        materials: &(),
        custom: CustomColumns::NONE,
        springs: Springs { springs: &[], start: 0, serial: &[], row_of: &[], last_spring: &[], incident: &[] },
        near: Neighbours::among(&[]),
        mass_tree: None,
        charge_tree: None,
    };

    /// The first of these particles, as many as there are places, at other places with other velocities; what was sorted by
    /// place is left out.
    pub(crate) fn moved<'s>(&self, time: Time, position: &'s [Vec3], velocity: &'s [Vec3]) -> State<'s>
    where
        'a: 's,
    {
        let mut state = self.moved_with(self.custom, time, [position, velocity]);
        state.since = time;
        state
    }

    /// The same with other columns of a user's own.
    #[cfg_attr(one_by_one, inline(never))]
    pub(crate) fn moved_with<'s>(
        &self,
        custom: CustomColumns<'s>,
        time: Time,
        [position, velocity]: [&'s [Vec3]; 2],
    ) -> State<'s>
    where
        'a: 's,
    {
        let len = position.len();
        State {
            time,
            since: self.since,
            position,
            velocity,
            radius: &self.radius[..len],
            mass: &self.mass[..len],
            drag: &self.drag[..len],
            charge: &self.charge[..len],
            born: &self.born[..len],
            dies: &self.dies[..len],
            slot: &self.slot[..len],
            key: &self.key[..len],
            color: &self.color[..len],
            material: &self.material[..len],
            materials: self.materials,
            springs: Springs { serial: &self.springs.serial[..len], ..self.springs },
            custom: custom.rows(0..len),
            near: self.near.at(position),
            mass_tree: None,
            charge_tree: None,
        }
    }

    /// The attributes of some rows, without places and velocities.
    #[cfg_attr(one_by_one, inline(never))]
    #[cfg_attr(not(one_by_one), inline(always))]
    pub(crate) fn attributes_of(&self, rows: Range<usize>) -> Self {
        // Changed in a copy: to write out the whole of it would take a chip more flash.
        let mut some = *self;
        (some.position, some.velocity) = (&[], &[]);
        for column in [&mut some.radius, &mut some.mass, &mut some.drag, &mut some.charge] {
            *column = &column[rows.clone()];
        }
        for column in [&mut some.slot, &mut some.key, &mut some.springs.serial] {
            *column = &column[rows.clone()];
        }
        (some.born, some.dies) = (&some.born[rows.clone()], &some.dies[rows.clone()]);
        (some.color, some.material) = (&some.color[rows.clone()], &some.material[rows.clone()]);
        some.custom = some.custom.rows(rows);
        some
    }

    /// Counts the particles within `radius` \[m\] of a place, whoever lies there included: by the index, or by looking
    /// at all.
    #[must_use]
    pub fn count_within(&self, place: Vec3, radius: f32) -> u64 {
        self.near.count_within(place, radius)
    }

    /// The way from the particle in one row to that in another \[m\]: in a periodic room the shortest through its sides.
    #[must_use]
    #[inline(always)]
    pub fn between(&self, from: usize, to: usize) -> Vec3 {
        between(self.near.room(), self.position[from], self.position[to])
    }

    /// The particle in a row.
    #[must_use]
    pub fn id(&self, row: usize) -> Option<Id> {
        Some(Id { slot: *self.slot.get(row)?, serial: *self.springs.serial.get(row)? })
    }

    /// A random word of the particle in a row, the `place`-th that it has beside those of its birth: the same as long as it
    /// lives, and however time is cut into steps.
    ///
    /// It belongs to the emitter's number and the birth's number there, of what is put in without an emitter to the number
    /// in which it was put in. (Serials and slots will not do for that: in which order the births of several emitters come in
    /// depends on the steps.)
    #[must_use]
    pub fn word(&self, row: usize, place: u32) -> Option<u32> {
        Some(later(*self.key.get(row)?, place))
    }
}

/// The parts of a scene that show in the state of its particles.
#[derive(Clone, Copy)]
pub(crate) struct Backdrop<'a> {
    pub(crate) springs: &'a [Spring],
    pub(crate) materials: &'a dyn MaterialList,
    pub(crate) custom: &'a dyn CustomList,
    pub(crate) room: Option<&'a Room>,
}

impl<'a> Columns<'a> {
    /// The living as forces and reapers see them.
    pub(crate) fn state(self, scene: &Backdrop<'a>, status: &Status) -> State<'a> {
        let Backdrop { springs, materials, custom, room } = *scene;
        let (springs, custom) = (self.springs(springs, status), CustomColumns::of(custom, self, status.len));
        let Columns { position, velocity, radius, mass, drag, charge, born, dies, slot, key, color, material, .. } =
            self;
        let near = Neighbours::among(&[]).in_room(room);
        let lives = State {
            radius,
            mass,
            drag,
            charge,
            born,
            dies,
            slot,
            key,
            color,
            material,
            materials,
            springs,
            custom,
            near,
            ..State::EMPTY
        };
        lives.moved(status.time, &position[..status.len], &velocity[..status.len])
    }
}
