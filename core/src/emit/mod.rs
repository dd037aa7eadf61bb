//! Creation: emitters and the births they bring about.
//!
//! Births are counted in whole numbers, so that a rate means the same at every frame rate: those in (t, t + dt] are
//! floor(R(t + dt)) − floor(R(t)), R being the rate times the time, and each has an instant of its own.

mod emitter;
mod jet;
mod state;
mod vary;

pub use emitter::{Burst, Emitter, WhereSparse};
pub use jet::Jet;
pub use state::EmitterState;
pub use vary::{Spread, Varied};

use crate::composed::stands_for;
use crate::custom::CustomColumnsMut;
use crate::force::{Backdrop, State};
use crate::index::{Neighbours, SpatialIndex};
use crate::math::{divide, max};
use crate::memory::{Layout, Storage, TILED, Workspace};
use crate::observe::{Attention, LifeEvent, Observer};
use crate::particles::{Full, Particle, Start};
use crate::report::Report;
use crate::rng::Stream;
use crate::time::{Time, fixed_32};
use glam::Vec3;

/// Something that brings particles into the world.
///
/// A tuple, slice, option, reference or box of emitters is an emitter. Each has a number, its place in the flattened list, and
/// keeps an `EmitterState` under it.
///
/// ```
/// use pointmass::emit::Births;
/// use pointmass::{Emit, Heap, Particle, Scene, Size, System, Time, Vec3};
///
/// /// Ten particles a second along a line, at places of their own.
/// struct Row;
///
/// impl Emit for Row {
///     fn count(&self) -> usize {
///         1
///     }
///     fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
///         let number = births.claim();
///         let mut due = births.due(number, 10.0, from, to);
///         while let Some(at) = due.next() {
///             let born = births.give(number, at, |random| Particle {
///                 position: Vec3::X * random.units(0)[0],
///                 ..Particle::REST
///             });
///             // Where there is no room, however many are due, the others are counted at once.
///             if born.is_err() {
///                 births.refuse(number, due.left());
///                 break;
///             }
///         }
///     }
/// }
///
/// let scene = Scene { emitters: &Row, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(Size { particles: 100, ..scene.size() }));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::from_seconds(2.0));
/// assert_eq!(system.len(), 20);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Emit: Sync {
    /// The number of emitters that it is.
    fn count(&self) -> usize;

    /// How far it asks who is near, by [`Births::count_within`] \[m\]; zero: it does not.
    fn reach(&self) -> f32 {
        0.0
    }

    /// Visits particles between whose attributes those of all lie that it bears, by which [`start`](crate::System::start) tells whether
    /// memory that holds some of them for all ([`Column::Common`](crate::Column)) will do; says whether these are all extremes. By default it
    /// does not tell: births that are otherwise are refused one by one, and counted, and [`Scene::likeness`](crate::Scene::likeness) takes
    /// nothing for granted.
    fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
        let _ = visit;
        false
    }

    /// Brings about the births between `from` (excluded) and `to` (included).
    ///
    /// Claims as many numbers of `births` as `count` says: births by others may find no memory, and are refused then. To keep the work of a step bounded, give no
    /// more when one has found no room, and [refuse](Births::refuse) the others at once.
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>);
}

/// The place that emitters give birth into.
#[allow(missing_debug_implementations)]
pub struct Births<'a> {
    pub(crate) workspace: &'a mut Workspace<'a>,
    pub(crate) layout: &'a Layout,
    pub(crate) backdrop: &'a Backdrop<'a>,
    pub(crate) report: &'a mut Report,
    pub(crate) observer: &'a mut dyn Observer,
    /// Those who were there when the step began, in an index if anybody asks for it, and how many they were.
    pub(crate) near: Option<&'a dyn SpatialIndex>,
    pub(crate) old: usize,
    /// When the step ends.
    pub(crate) end: Time,
    pub(crate) number: usize,
    pub(crate) ahead: Ahead,
}

/// Places of the pairs of numbers that births of emitters draw in any case.
const PLACES: [u32; 4] = [0, 1, 2, 4];

/// Births that are drawn at once, where there are vectors.
const AT_ONCE: usize = if cfg!(one_by_one) { 0 } else { 8 };

/// The random numbers of a birth, with the pairs at [`PLACES`].
type Drawn = (Stream, [[f32; 2]; 4]);

/// The random numbers of an emitter's next births, from one on.
#[derive(Default)]
pub(crate) struct Ahead {
    number: usize,
    serial: u32,
    drawn: Option<[Drawn; AT_ONCE]>,
}

impl Ahead {
    /// Those of a birth, if they have been drawn.
    fn of(&self, number: usize, serial: u32) -> Option<Drawn> {
        let drawn = self.drawn.as_ref().filter(|_| number == self.number)?;
        drawn.get(serial.wrapping_sub(self.serial) as usize).copied()
    }
}

impl Births<'_> {
    /// The number of the next emitter.
    pub fn claim(&mut self) -> usize {
        self.number += 1;
        self.number - 1
    }

    /// The births that emitter `number` owes at `rate` per second after `from` until `to`, and goes on from them. A number beyond those that
    /// there is memory for owes what it would if it had always been there, all of which is refused. There may be any number of them.
    pub fn due(&mut self, number: usize, rate: f32, from: Time, to: Time) -> Due {
        // Rates are whole numbers of 2⁻³² births per second, which is 2⁻⁶⁴ births per tick.
        let rate = fixed_32(rate);
        let state = self.workspace.memory.emitter_states.get_mut(number);
        let phase = state.as_ref().map_or(rate.wrapping_mul(from.ticks()), |state| state.phase);
        let reached = u128::from(phase) + u128::from(rate) * u128::from((to - from).ticks());
        if let Some(state) = state {
            state.phase = reached as u64;
        }
        Due { phase, rate, from, next: 1, last: (reached >> 64) as u64 }
    }

    /// Tells whether no further birth finds room.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.workspace.is_full()
    }

    /// The number of particles that there is room for.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.workspace.capacity()
    }

    /// The number of particles that lie within `radius` \[m\] of a place: those of before this step where they were then, those born in it
    /// where they were born. Costs one query of the scene's index if the emitter's [`reach`](Emit::reach) is as much, and a look
    /// at each newborn.
    #[must_use]
    pub fn count_within(&self, place: Vec3, radius: f32) -> u64 {
        let all = &self.workspace.memory.position[..self.workspace.len()];
        let (old, newborn) = all.split_at(self.old);
        let near = Neighbours::by(self.near, old).in_room(self.backdrop.room);
        near.count_within(place, radius) + near.at(newborn).count_within(place, radius)
    }

    /// The particles there are, those born in this step among them.
    #[must_use]
    pub fn state(&self) -> State<'_> {
        self.workspace.memory.columns().state(self.backdrop, self.workspace.status)
    }

    /// Columns of a user's own, for writing: the last row is that of the particle just born.
    pub fn custom_mut(&mut self) -> CustomColumnsMut<'_> {
        self.workspace.custom_mut(self.backdrop.custom, self.layout)
    }

    /// A birth of emitter `number` at the instant `at`, made from the random numbers that belong to it.
    ///
    /// # Errors
    /// If there is no room, or no memory for an emitter of that number, which is counted. It has used up its random numbers all the same.
    pub fn give(&mut self, number: usize, at: Time, make: impl FnOnce(Stream) -> Particle) -> Result<(), Full> {
        let serial = self.count_off_with_room(number, at)?;
        let stream = Stream::new(self.workspace.seed(), number as u32, serial);
        let particle = make(stream);
        self.bear(stream, &particle, &Start::of(&particle, at))
    }

    /// The same of one that is like another but for how it begins.
    #[cfg_attr(one_by_one, inline(never))]
    fn give_like(
        &mut self,
        number: usize,
        at: Time,
        like: &Particle,
        make: impl FnOnce(Drawn) -> Start,
    ) -> Result<(), Full> {
        let drawn = self.draw(number, at)?;
        self.bear(drawn.0, like, &make(drawn))
    }

    /// The same of one that draws pairs of numbers in any case.
    fn give_drawn(&mut self, number: usize, at: Time, make: impl FnOnce(Drawn) -> Particle) -> Result<(), Full> {
        let drawn = self.draw(number, at)?;
        let particle = make(drawn);
        self.bear(drawn.0, &particle, &Start::of(&particle, at))
    }

    /// A birth of emitter `number` that may come to nothing: `make` sees who is there. What finds no room is counted.
    pub fn offer(&mut self, number: usize, at: Time, make: impl FnOnce(Stream, &Self) -> Option<Particle>) {
        let Some(stream) = self.next(number) else { return self.miss(at) };
        let Some(particle) = make(stream, self) else { return };
        // What finds no room is counted there.
        let _ = self.bear(stream, &particle, &Start::of(&particle, at));
    }

    /// Lets the births happen that a rate owes in a span, as long as `bear` says that they find room; refuses the others. What they draw in any
    /// case may be drawn `ahead`.
    fn bring(
        &mut self,
        number: usize,
        rate: f32,
        ahead: bool,
        [from, to]: [Time; 2],
        mut bear: impl FnMut(&mut Self, Time) -> bool,
    ) {
        let mut due = self.due(number, rate, from, to);
        while !self.is_full() {
            if ahead && due.left() > 1 {
                self.look_ahead(number);
            }
            let Some(at) = due.next() else { return };
            if !bear(self, at) {
                break;
            }
        }
        self.refuse(number, due.left());
    }

    /// Draws the random numbers of an emitter's next births, unless those of the next have been drawn.
    #[inline]
    fn look_ahead(&mut self, number: usize) {
        let state = self.workspace.memory.emitter_states.get(number);
        let Some(serial) = state.map(|state| state.serial).filter(|_| AT_ONCE > 0) else { return };
        if self.ahead.of(number, serial).is_none() {
            let drawn = Stream::eight(self.workspace.seed(), number as u32, serial, PLACES);
            self.ahead = Ahead { number, serial, drawn: drawn.first_chunk().copied() };
        }
    }

    /// The serial number of an emitter's next birth.
    fn count_off(&mut self, number: usize) -> Option<u32> {
        let state = self.workspace.memory.emitter_states.get_mut(number)?;
        let serial = state.serial;
        state.serial = serial.wrapping_add(1);
        Some(serial)
    }

    /// The random numbers of an emitter's next birth.
    fn next(&mut self, number: usize) -> Option<Stream> {
        let serial = self.count_off(number)?;
        Some(Stream::new(self.workspace.seed(), number as u32, serial))
    }

    /// The serial number of an emitter's next birth, if there is room for it; else that is counted.
    fn count_off_with_room(&mut self, number: usize, at: Time) -> Result<u32, Full> {
        let serial = self.count_off(number).filter(|_| !self.workspace.is_full());
        serial.ok_or_else(|| {
            self.miss(at);
            Full
        })
    }

    /// The same with the random numbers of that birth.
    fn draw(&mut self, number: usize, at: Time) -> Result<Drawn, Full> {
        let serial = self.count_off_with_room(number, at)?;
        Ok(self.ahead.of(number, serial).unwrap_or_else(|| {
            let stream = Stream::new(self.workspace.seed(), number as u32, serial);
            (stream, stream.units_of(PLACES))
        }))
    }

    /// Puts a newborn in, or counts that it finds no room.
    fn bear(&mut self, stream: Stream, like: &Particle, start: &Start) -> Result<(), Full> {
        let Ok(id) = self.workspace.spawn(like, start, stream.name()) else {
            self.miss(start.born);
            return Err(Full);
        };
        self.workspace.give_custom(self.backdrop.custom, self.layout, self.workspace.len() - 1);
        self.report.born += 1;
        // Hosts fill in no event that nobody reads; on chips, asking takes more code than telling.
        if !TILED || self.observer.attention() > Attention::Nothing {
            let Start { position: place, velocity, born: time, .. } = *start;
            self.observer.born(&LifeEvent { id, place, velocity, time });
        }
        Ok(())
    }

    /// Counts a birth that finds no room.
    #[cfg_attr(one_by_one, inline(never))]
    fn miss(&mut self, at: Time) {
        self.report.refused = self.report.refused.saturating_add(1);
        self.observer.refused(1, at);
    }

    /// Counts `count` births of emitter `number` that find no room, at once.
    pub fn refuse(&mut self, number: usize, count: u64) {
        if let Some(state) = self.workspace.memory.emitter_states.get_mut(number) {
            state.serial = state.serial.wrapping_add(count as u32);
        }
        self.report.refused = self.report.refused.saturating_add(count);
        if count > 0 {
            self.observer.refused(count, self.end);
        }
    }
}

/// The instants of births that a rate brings about.
#[derive(Clone, Copy, Debug)]
pub struct Due {
    phase: u64,
    rate: u64,
    from: Time,
    next: u64,
    last: u64,
}

impl Due {
    /// The number of those that are left.
    #[must_use]
    pub const fn left(&self) -> u64 {
        (self.last + 1).saturating_sub(self.next)
    }
}

impl Iterator for Due {
    type Item = Time;

    /// The first tick at which the births so far reach a whole number: the same however time was cut into steps.
    fn next(&mut self) -> Option<Time> {
        if self.left() == 0 {
            return None;
        }
        let missing = (u128::from(self.next) << 64) - u128::from(self.phase);
        self.next += 1;
        let (ticks, rest) = divide(missing, self.rate.max(1));
        Some(self.from + Time::from_ticks(ticks + u64::from(rest > 0)))
    }
}

impl Emit for () {
    fn count(&self) -> usize {
        0
    }
    fn extremes(&self, _: &mut dyn FnMut(&Particle)) -> bool {
        true
    }
    fn emit(&self, _: Time, _: Time, _: &mut Births<'_>) {}
}

stands_for! {
    Emit {
        fn count(&self) -> usize {
            (**self).count()
        }
        fn reach(&self) -> f32 {
            (**self).reach()
        }
        fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
            (**self).extremes(visit)
        }
        fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
            (**self).emit(from, to, births);
        }
    }
}

impl<T: Emit> Emit for [T] {
    fn count(&self) -> usize {
        self.iter().map(Emit::count).sum()
    }
    fn reach(&self) -> f32 {
        self.iter().map(Emit::reach).fold(0.0, max)
    }
    fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
        let mut are_all = true;
        for emitter in self {
            are_all &= emitter.extremes(visit);
        }
        are_all
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        for emitter in self {
            emitter.emit(from, to, births);
        }
    }
}

/// Everything that holds a slice is what the slice is.
macro_rules! lists {
    ($($(#[$when:meta])* [$($generics:tt)*] $list:ty;)+) => {$(
        $(#[$when])*
        impl<$($generics)*> Emit for $list {
            fn count(&self) -> usize {
                self.as_slice().count()
            }
            fn reach(&self) -> f32 {
                self.as_slice().reach()
            }
            fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
                self.as_slice().extremes(visit)
            }
            fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
                self.as_slice().emit(from, to, births);
            }
        }
    )+};
}
lists! {
    [T: Emit, const N: usize] [T; N];
    [T: Emit, const N: usize] heapless::Vec<T, N>;
    [T: Emit] Option<T>;
    #[cfg(feature = "alloc")]
    [T: Emit] alloc::vec::Vec<T>;
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Emit),+> Emit for ($($name,)+) {
            fn count(&self) -> usize {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                0 $(+ $name.count())+
            }
            fn reach(&self) -> f32 {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                [$($name.reach()),+].into_iter().fold(0.0, max)
            }
            fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                [$($name.extremes(visit)),+].iter().all(|&are_all| are_all)
            }
            fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.emit(from, to, births);)+
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);
