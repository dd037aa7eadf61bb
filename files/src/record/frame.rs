//! The state of all particles at an instant, column by column.

use super::plan::Plan;
use super::solids::Surfaces;
use crate::instant::nanoseconds;
use pointmass::draw::Looks;
use pointmass::force::Springs;
use pointmass::index::Room;
use pointmass::{Color, Columns, Heap, Scene, System, Time, Vec3, WHITE};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The state after a step, by id.
#[derive(Clone, Debug)]
pub struct Frame {
    /// How many steps have been made.
    pub(super) step: u64,
    /// The instant \[s\].
    pub(super) time: f64,
    /// How many particles live.
    pub(super) len: usize,
    /// Their attributes, in the order of tables.
    pub(super) columns: Vec<Column>,
    /// Their colours at that instant.
    pub(super) colors: Vec<Color>,
    /// Triangles of cloths that hold, by rows.
    pub(super) faces: Vec<[u32; 3]>,
    /// Springs that hold and are in no triangle, by rows.
    pub(super) edges: Vec<[u32; 2]>,
    /// Whether the scene has such triangles and springs, though none of them may be left.
    pub(super) kinds: Kinds,
    /// The surfaces of rigid bodies.
    pub(super) surfaces: Surfaces,
    /// The room whose opposite faces are one, if there is one.
    pub(super) room: Option<Room>,
}

/// What joins the particles of a scene, the same in every record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kinds {
    pub(super) faces: bool,
    pub(super) edges: bool,
}

/// An attribute of all particles.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// Its name.
    pub(super) name: String,
    /// One value a particle.
    pub(super) values: Values,
}

/// The values of a column.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Values {
    /// In single precision.
    Single(Vec<f32>),
    /// In double precision.
    Double(Vec<f64>),
    /// Numbers that count.
    Unsigned(Vec<u32>),
    /// Numbers of things that may not be there, which is −1.
    Signed(Vec<i32>),
    /// Bytes.
    Byte(Vec<u8>),
}

/// One of these values.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Value {
    /// In single precision.
    Single(f32),
    /// In double precision.
    Double(f64),
    /// A number that counts.
    Unsigned(u32),
    /// The number of something that may not be there.
    Signed(i32),
    /// A byte.
    Byte(u8),
}

/// Does the same with values of whatever type.
macro_rules! whatever {
    ($of:ident $this:expr, $x:ident => $done:expr) => {
        match $this {
            $of::Single($x) => $done,
            $of::Double($x) => $done,
            $of::Unsigned($x) => $done,
            $of::Signed($x) => $done,
            $of::Byte($x) => $done,
        }
    };
}
pub(super) use whatever;

impl Values {
    /// The value in a row.
    pub(super) fn at(&self, row: usize) -> Value {
        match self {
            Self::Single(values) => Value::Single(values[row]),
            Self::Double(values) => Value::Double(values[row]),
            Self::Unsigned(values) => Value::Unsigned(values[row]),
            Self::Signed(values) => Value::Signed(values[row]),
            Self::Byte(values) => Value::Byte(values[row]),
        }
    }

    /// All of them as bytes, each number from its lowest byte on.
    pub(super) fn bytes(&self) -> Vec<u8> {
        whatever!(Self self, values => values.iter().flat_map(|value| value.to_le_bytes()).collect())
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        whatever!(Self self, value => value.fmt(f))
    }
}

impl Value {
    /// It in single precision.
    pub(super) fn single(self) -> f32 {
        whatever!(Self self, value => value as f32)
    }

    /// Its bytes, from the lowest on.
    pub(super) fn write(self, out: &mut impl std::io::Write) -> std::io::Result<()> {
        whatever!(Self self, value => out.write_all(&value.to_le_bytes()))
    }
}

impl Frame {
    /// The frame of a system after so many steps.
    pub fn of(step: u64, system: &System<Heap>, scene: &Scene<'_>, plan: &Plan) -> Self {
        let serial = system.particles().serial;
        let mut order: Vec<usize> = (0..serial.len()).collect();
        order.sort_unstable_by_key(|&row| serial[row]);
        let state = system.state(scene);
        let mut looks = Looks::of(&state);
        let color = |&row: &usize| looks.appearance(row).map_or(WHITE, |look| look.color);
        let colors: Vec<Color> = order.iter().map(color).collect();
        let columns = Rows { order: &order, system, scene }.columns(plan, &colors);
        let mut place = vec![0; order.len()];
        (0..).zip(&order).for_each(|(at, &row)| place[row] = at);
        let time = nanoseconds(system.time().seconds_f64());
        let (faces, edges) = (faces(plan, &state.springs, &place), edges(plan, &state.springs, &place));
        let mut surfaces = Surfaces::default();
        let now = [state.position, state.velocity];
        plan.solids.iter().for_each(|solid| solid.add(&state.springs, now, &place, &mut surfaces));
        let room = state.near.room().copied();
        Self { step, time, len: order.len(), columns, colors, faces, edges, kinds: plan.kinds(), surfaces, room }
    }

    /// The columns of these names one after the other, all of them there and in single precision.
    pub(super) fn singles<const N: usize>(&self, names: [&str; N]) -> [&[f32]; N] {
        names.map(|name| match self.columns.iter().find(|column| column.name == name) {
            Some(Column { values: Values::Single(values), .. }) => values.as_slice(),
            _ => &[],
        })
    }

    /// The columns other than those of these names.
    pub(super) fn others(&self, names: &[&str]) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|column| !names.contains(&column.name.as_str()))
    }

    /// The rows that are in no face and no edge, and in no body.
    pub(super) fn singletons(&self) -> impl Iterator<Item = u32> {
        let mut joined = vec![false; self.len];
        let ends = self.faces.as_flattened().iter().chain(self.edges.as_flattened());
        ends.chain(&self.surfaces.members).for_each(|&row| joined[row as usize] = true);
        (0..).zip(joined).filter(|(_, joined)| !joined).map(|(row, _)| row)
    }

    /// The places of all.
    pub(super) fn places(&self) -> impl Iterator<Item = [f32; 3]> {
        let [x, y, z] = self.singles(["x", "y", "z"]);
        (0..self.len).map(move |row| [x[row], y[row], z[row]])
    }
}

/// The time that remains to those who do not die of age \[s\], as scenes say it.
const FOR_EVER: f64 = -1.0;

/// The rows of a system in the order of a frame.
struct Rows<'a> {
    order: &'a [usize],
    system: &'a System<Heap>,
    scene: &'a Scene<'a>,
}

impl Rows<'_> {
    /// The columns that the plan asks for, in the order of tables.
    fn columns(&self, plan: &Plan, colors: &[Color]) -> Vec<Column> {
        let Columns { serial, position, velocity, mass, inverse_mass, radius, drag, charge, elasticity, .. } =
            self.system.particles();
        let Columns { born, dies, material, .. } = self.system.particles();
        let now = self.system.time();
        let axes = |column: &[Vec3], axis: usize| Values::Single(self.pick(|row| column[row][axis]));
        let single = |column: &[f32]| Values::Single(self.pick(|row| column[row]));
        let seconds = |of: &dyn Fn(usize) -> Time| self.pick(|row| nanoseconds(of(row).seconds_f64()));
        let remaining = |row: usize| if dies[row] == Time::NEVER { FOR_EVER } else { left(now, dies[row]) };
        let channel = |channel: usize| Values::Byte(colors.iter().map(|color| color[channel]).collect());
        let own = self.system.custom(self.scene);
        let number = |row: usize| i32::from(material[row]) - 1;

        let mut columns = Vec::new();
        let mut add = |name: &str, values: Values| columns.push(Column { name: name.to_string(), values });
        add("id", Values::Unsigned(self.pick(|row| serial[row])));
        ["x", "y", "z"].iter().zip(0..).for_each(|(name, axis)| add(name, axes(position, axis)));
        ["vx", "vy", "vz"].iter().zip(0..).for_each(|(name, axis)| add(name, axes(velocity, axis)));
        add("mass", single(mass));
        add("age", Values::Double(seconds(&|row| now - born[row])));
        plan.radius.then(|| add("radius", single(radius)));
        for custom in 0..own.count() {
            add(own.name(custom).unwrap_or_default(), single(own.column(custom)));
        }
        plan.remaining.then(|| add("remaining", Values::Double(self.pick(remaining))));
        plan.fixed.then(|| add("fixed", Values::Byte(self.pick(|row| u8::from(inverse_mass[row] == 0.0)))));
        plan.drag.then(|| add("drag", single(drag)));
        plan.charge.then(|| add("charge", single(charge)));
        plan.elasticity.then(|| add("elasticity", single(elasticity)));
        plan.material.then(|| add("material", Values::Signed(self.pick(number))));
        let channels = ["red", "green", "blue", "alpha"].iter().zip(0..).filter(|_| plan.color);
        channels.for_each(|(name, number)| add(name, channel(number)));
        columns
    }

    /// One value for each row.
    fn pick<T>(&self, value: impl Fn(usize) -> T) -> Vec<T> {
        self.order.iter().map(|&row| value(row)).collect()
    }
}

/// The time from one instant to a later one \[s\].
fn left(now: Time, end: Time) -> f64 {
    nanoseconds(if end > now { (end - now).seconds_f64() } else { 0.0 })
}

/// The triangles whose corners live and none of whose sides is a broken spring, by places of rows.
fn faces(plan: &Plan, springs: &Springs<'_>, place: &[u32]) -> Vec<[u32; 3]> {
    let pair = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let breakable = springs.springs.iter().enumerate().filter(|(_, spring)| spring.breaks_at.is_some());
    let broken = breakable.filter(|(number, _)| springs.is_broken(*number)).map(|(_, spring)| pair(spring.ends));
    let broken: BTreeSet<_> = if plan.triangles.is_empty() { BTreeSet::new() } else { broken.collect() };
    let corner = |number: u32| springs.row(number).map(|row| place[row]);
    let face = |&[a, b, c]: &[u32; 3]| {
        let holds = [[a, b], [b, c], [c, a]].iter().all(|&side| !broken.contains(&pair(side)));
        holds.then_some([corner(a)?, corner(b)?, corner(c)?])
    };
    plan.triangles.iter().filter_map(face).collect()
}

/// The springs that are edges and hold, and the links of constraints whose ends live, by places of rows; between two particles one.
fn edges(plan: &Plan, springs: &Springs<'_>, place: &[u32]) -> Vec<[u32; 2]> {
    let held = springs.held().filter(|held| plan.edges.get(held.number) == Some(&true));
    let row = |number: u32| springs.row(number);
    let links = plan.links.iter().filter_map(|&[a, b]| Some([row(a)?, row(b)?]));
    let ends = held.map(|held| held.rows).chain(links).map(|rows| rows.map(|row| place[row]));
    let once: BTreeMap<_, _> = ends.map(|[a, b]| ([a.min(b), a.max(b)], [a, b])).collect();
    once.into_values().collect()
}
