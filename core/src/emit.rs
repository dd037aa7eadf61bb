//! Creation: emitters and the births they bring about.
//!
//! Births are counted in whole numbers, so that a rate means the same at every frame rate: those in (t, t + dt] are
//! floor(R(t + dt)) − floor(R(t)), R being the rate times the time, and each has an instant of its own.

use crate::math::{frame, max, sin_cos, sin_cos_turns, sqrt, unit};
use crate::particles::{Color, Full, Particle, WHITE};
use crate::report::Report;
use crate::rng::Stream;
use crate::shape::{Shape, Surface};
use crate::system::View;
use crate::time::{Time, fixed_32};
use glam::Vec3;

/// Something that brings particles into the world.
///
/// A tuple, slice or reference of emitters is an emitter. Each has a number, its place in the flattened list, and
/// keeps a `Tally` under it.
pub trait Emit: Sync {
    /// How many emitters it is.
    fn count(&self) -> usize;

    /// Brings about the births between `from` (excluded) and `to` (included).
    ///
    /// Claims as many numbers of `births` as `count` says.
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>);
}

/// A number that varies: its mean, and how far it may be from that, evenly on both sides (Reeves, "Particle Systems",
/// SIGGRAPH 1983).
///
/// In a file a plain number, or `{"mean": 2, "variance": 0.5}` for 1.5 to 2.5.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(from = "Number", into = "Number"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(with = "Number"))]
pub struct Varied {
    /// The middle.
    pub mean: f32,
    /// The largest difference from it.
    pub variance: f32,
}

/// The directions in which births may leave, about the surface's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Spread {
    /// Uniform in solid angle within this angle \[rad\], 0 to π: cos α = 1 − u (1 − cos c).
    Uniform(f32),
    /// The lecture's recipe with this cutoff \[rad\]: sin α uniform in [0, sin c). It favours the middle, and beyond a
    /// right angle it folds back.
    Lecture(f32),
}

/// Many births at once.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Burst {
    /// How many.
    pub count: u32,
    /// When first \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub at: f32,
    /// How long from one to the next \[s\]; zero: there is but one.
    #[cfg_attr(feature = "serde", serde(default))]
    pub every: f32,
}

/// A surface that gives birth to particles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Emitter<M> {
    /// Where births lie, uniformly by area.
    pub shape: Shape<M>,
    /// Births per second.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rate: f32,
    /// Births all at once, beside those of the rate.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub burst: Option<Burst>,
    /// When it begins \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub start: f32,
    /// When it ends \[s\], if it does.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub stop: Option<f32>,
    /// Speed along the direction of birth \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub speed: Varied,
    /// The middle of the directions; without one, the surface's normal at the place of birth.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "schema", schemars(with = "Option<[f32; 3]>"))]
    pub direction: Option<Vec3>,
    /// How far directions stray from the middle.
    #[cfg_attr(feature = "serde", serde(default = "straight"))]
    pub spread: Spread,
    /// The emitter itself moves steadily with this velocity \[m/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// The share of the emitter's velocity that births take along, usually 0 to 1.
    #[cfg_attr(feature = "serde", serde(default))]
    pub inherit: f32,
    /// Mass \[kg\].
    #[cfg_attr(feature = "serde", serde(default = "one"))]
    pub mass: Varied,
    /// Births never move.
    #[cfg_attr(feature = "serde", serde(default))]
    pub fixed: bool,
    /// Coefficient of linear drag \[kg/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: Varied,
    /// Share of the normal speed kept in a hit.
    #[cfg_attr(feature = "serde", serde(default = "half"))]
    pub elasticity: Varied,
    /// Lifetime \[s\]; zero or less: for ever.
    #[cfg_attr(feature = "serde", serde(default))]
    pub lifetime: Varied,
    /// Number of the births' material in the scene.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub material: Option<u16>,
    /// Their colour; without one, that of the material.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<Color>,
    /// How far each of red, green, blue and opacity may be from the colour, evenly on both sides.
    #[cfg_attr(feature = "serde", serde(default))]
    pub color_variance: Color,
}

/// What an emitter has done so far; numbers and instants of births go on from here, even when its rate changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Births so far, those that found no room included.
    pub(crate) serial: u32,
    /// How much of the next birth is done, in units of 2⁻⁶⁴.
    pub(crate) phase: u64,
}

/// What emitters give birth into.
#[derive(Debug)]
pub struct Births<'a> {
    pub(crate) view: View<'a>,
    pub(crate) report: &'a mut Report,
    pub(crate) next: usize,
}

impl Tally {
    pub(crate) const NEW: Self = Self { serial: 0, phase: 0 };
}

impl Varied {
    /// Always `mean`.
    #[must_use]
    pub const fn exactly(mean: f32) -> Self {
        Self { mean, variance: 0.0 }
    }

    /// Uniform from mean − variance to mean + variance; `u` is asked for only if there is a variance.
    fn pick(self, u: impl FnOnce() -> f32) -> f32 {
        if self.variance == 0.0 { self.mean } else { self.mean + self.variance * (2.0 * u() - 1.0) }
    }
}

impl Spread {
    /// The direction about the unit vector `axis` that two numbers uniform in [0, 1) pick.
    #[must_use]
    pub fn direction(self, axis: Vec3, [u, v]: [f32; 2]) -> Vec3 {
        let (sin, cos) = match self {
            Self::Uniform(0.0) | Self::Lecture(0.0) => return axis,
            Self::Uniform(cutoff) => {
                // 1 − cos c = 2 sin²(c/2) keeps the digits of small angles.
                let (half, _) = sin_cos(0.5 * cutoff);
                let drop = u * 2.0 * half * half;
                (sqrt(max(drop * (2.0 - drop), 0.0)), 1.0 - drop)
            }
            Self::Lecture(cutoff) => {
                let sin = u * sin_cos(cutoff).0;
                (sin, sqrt(max(1.0 - sin * sin, 0.0)))
            }
        };
        let (a, b) = frame(axis);
        let (along_b, along_a) = sin_cos_turns(v);
        axis * cos + (a * along_a + b * along_b) * sin
    }
}

impl Births<'_> {
    /// The number of the next emitter.
    pub fn claim(&mut self) -> usize {
        self.next += 1;
        self.next - 1
    }

    /// The births that emitter `number` owes at `rate` per second after `from` until `to`, and goes on from them.
    pub fn due(&mut self, number: usize, rate: f32, from: Time, to: Time) -> Due {
        let Some(tally) = self.view.memory.tallies.get_mut(number) else { return Due::NONE };
        // Rates are whole numbers of 2⁻³² births per second, which is 2⁻⁶⁴ births per tick.
        let rate = fixed_32(rate);
        let phase = tally.phase;
        let reached = u128::from(phase) + u128::from(rate) * u128::from((to - from).ticks());
        tally.phase = reached as u64;
        Due { phase, rate, from, next: 1, last: (reached >> 64) as u64 }
    }

    /// Whether no further birth finds room.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.view.is_full()
    }

    /// A birth of emitter `number` at the instant `at`, made from the random numbers that belong to it.
    ///
    /// # Errors
    /// If there is no room, which is counted. It has used up its random numbers all the same.
    pub fn give(&mut self, number: usize, at: Time, make: impl FnOnce(Stream) -> Particle) -> Result<(), Full> {
        let Some(tally) = self.view.memory.tallies.get_mut(number) else { return Err(Full) };
        let serial = tally.serial;
        tally.serial = serial.wrapping_add(1);
        if self.view.is_full() {
            self.report.refused += 1;
            return Err(Full);
        }
        let particle = make(Stream::new(self.view.seed(), number as u32, serial));
        self.view.spawn(&particle, at)?;
        self.report.born += 1;
        Ok(())
    }

    /// `count` births of emitter `number` that find no room, at once.
    pub fn refuse(&mut self, number: usize, count: u64) {
        if let Some(tally) = self.view.memory.tallies.get_mut(number) {
            tally.serial = tally.serial.wrapping_add(count as u32);
            self.report.refused = self.report.refused.saturating_add(count);
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
    const NONE: Self = Self { phase: 0, rate: 0, from: Time::ZERO, next: 1, last: 0 };

    /// How many are left.
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
        let ticks = missing.div_ceil(u128::from(self.rate.max(1)));
        Some(self.from + Time::from_ticks(ticks as u64))
    }
}

/// One emitter, or two if it has bursts: those of the rate and those of the bursts are numbered separately, so that
/// their random numbers do not depend on which come first in a step.
impl<M: Surface + Sync> Emit for Emitter<M> {
    fn count(&self) -> usize {
        1 + usize::from(self.burst.is_some())
    }

    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        let (start, stop) = (Time::from_seconds(self.start), self.stop.map_or(Time::NEVER, Time::from_seconds));
        if let Some(burst) = &self.burst {
            let number = births.claim();
            self.emit_bursts(burst, [from, to], births, number);
        }
        let (first, last) = (from.max(start), to.min(stop));
        if first < last {
            let mut due = births.due(number, self.rate, first, last);
            while !births.is_full() {
                let Some(at) = due.next() else { return };
                let _counted = births.give(number, at, |stream| self.newborn(stream, at));
            }
            births.refuse(number, due.left());
        }
    }
}

impl<M> Emitter<M> {
    /// An emitter of `rate` births per second that are at rest, of 1 kg, immortal.
    #[must_use]
    pub const fn new(shape: Shape<M>, rate: f32) -> Self {
        Self {
            shape,
            rate,
            burst: None,
            start: 0.0,
            stop: None,
            speed: Varied::exactly(0.0),
            direction: None,
            spread: Spread::Uniform(0.0),
            velocity: Vec3::ZERO,
            inherit: 0.0,
            mass: Varied::exactly(1.0),
            fixed: false,
            drag: Varied::exactly(0.0),
            elasticity: Varied::exactly(0.5),
            lifetime: Varied::exactly(0.0),
            material: None,
            color: None,
            color_variance: [0; 4],
        }
    }

    /// The same emitter with births of exactly this mass, drag, elasticity and lifetime, fixed if this is.
    #[must_use]
    pub fn giving_birth_to(self, newborn: &Particle) -> Self {
        Self {
            mass: Varied::exactly(newborn.mass),
            fixed: newborn.fixed,
            drag: Varied::exactly(newborn.drag),
            elasticity: Varied::exactly(newborn.elasticity),
            lifetime: Varied::exactly(newborn.lifetime),
            ..self
        }
    }
}

impl<M: Surface> Emitter<M> {
    /// The bursts whose instants lie in [from, to): one at zero belongs to the first step.
    fn emit_bursts(&self, burst: &Burst, [from, to]: [Time; 2], births: &mut Births<'_>, number: usize) {
        let (first, every) = (Time::from_seconds(burst.at).ticks(), Time::from_seconds(burst.every).ticks());
        if burst.count == 0 {
            return;
        }
        // The number of the first burst that is not before `from`.
        let mut index = from.ticks().saturating_sub(first).checked_div(every).unwrap_or(0);
        if first.saturating_add(index.saturating_mul(every)) < from.ticks() {
            index += 1;
        }
        loop {
            let ticks = first.saturating_add(index.saturating_mul(every));
            let at = Time::from_ticks(ticks);
            if at < from || at >= to || (every == 0 && index > 0) {
                return;
            }
            for given in 0..burst.count {
                if births.is_full() {
                    births.refuse(number, u64::from(burst.count - given));
                    break;
                }
                let _counted = births.give(number, at, |stream| self.newborn(stream, at));
            }
            // Once nothing fits, what is left of this step's bursts is only counted.
            if births.is_full() && every > 0 {
                let rest = (to.ticks() - 1 - ticks) / every;
                births.refuse(number, rest.saturating_mul(u64::from(burst.count)));
                return;
            }
            index += 1;
        }
    }

    /// A newborn. Each property draws from a place of its own, so that a change of one leaves the others alone.
    fn newborn(&self, random: Stream, at: Time) -> Particle {
        let [u, v] = random.units(0);
        let [w, p] = random.units(1);
        let [q, speed] = random.units(2);
        let spot = self.shape.sample([u, v, w]);
        let axis = self.direction.map_or(spot.normal, unit);
        let direction = self.spread.direction(axis, [p, q]);
        Particle {
            position: spot.point + self.velocity * at.seconds(),
            velocity: self.velocity * self.inherit + direction * self.speed.pick(|| speed),
            mass: self.mass.pick(|| random.units(3)[0]),
            fixed: self.fixed,
            drag: self.drag.pick(|| random.units(3)[1]),
            elasticity: self.elasticity.pick(|| random.units(4)[0]),
            lifetime: self.lifetime.pick(|| random.units(4)[1]),
            material: self.material,
            color: Some(self.tint(random)),
        }
    }

    fn tint(&self, random: Stream) -> Color {
        let mean = self.color.unwrap_or(WHITE);
        if self.color_variance == [0; 4] {
            return mean;
        }
        let ([a, b], [c, d]) = (random.units(5), random.units(6));
        let mut tint = mean;
        for ((channel, variance), u) in tint.iter_mut().zip(self.color_variance).zip([a, b, c, d]) {
            // The cast saturates at 0 and 255.
            *channel = (f32::from(*channel) + f32::from(variance) * (2.0 * u - 1.0) + 0.5) as u8;
        }
        tint
    }
}

impl Emit for () {
    fn count(&self) -> usize {
        0
    }
    fn emit(&self, _: Time, _: Time, _: &mut Births<'_>) {}
}

impl<T: Emit + ?Sized> Emit for &T {
    fn count(&self) -> usize {
        (**self).count()
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        (**self).emit(from, to, births);
    }
}

impl<T: Emit> Emit for [T] {
    fn count(&self) -> usize {
        self.iter().map(Emit::count).sum()
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
            fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
                self.as_slice().emit(from, to, births);
            }
        }
    )+};
}
lists! {
    [T: Emit, const N: usize] [T; N];
    [T: Emit, const N: usize] heapless::Vec<T, N>;
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

/// How a varied number is written.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
enum Number {
    Plain(f32),
    Varied { mean: f32, variance: f32 },
}

#[cfg(feature = "serde")]
impl From<Number> for Varied {
    fn from(number: Number) -> Self {
        match number {
            Number::Plain(mean) => Self::exactly(mean),
            Number::Varied { mean, variance } => Self { mean, variance },
        }
    }
}

#[cfg(feature = "serde")]
impl From<Varied> for Number {
    fn from(Varied { mean, variance }: Varied) -> Self {
        if variance == 0.0 { Self::Plain(mean) } else { Self::Varied { mean, variance } }
    }
}

#[cfg(feature = "serde")]
fn straight() -> Spread {
    Spread::Uniform(0.0)
}

#[cfg(feature = "serde")]
fn one() -> Varied {
    Varied::exactly(1.0)
}

#[cfg(feature = "serde")]
fn half() -> Varied {
    Varied::exactly(0.5)
}
