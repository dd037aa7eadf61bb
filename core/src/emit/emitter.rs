//! A surface that gives birth to particles.

use super::vary::Aim;
use super::{Births, Drawn, Emit, PLACES, Spread, Varied};
use crate::math::{along, divide, scaled, unit};
use crate::motion::Script;
use crate::particles::{Color, Particle, WHITE};
use crate::rng::Stream;
use crate::shape::{Aabb, Spot, Surface};
use crate::time::Time;
use glam::Vec3;

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

/// Where particles are few: fewer than `fewest` within `radius` of a place.
///
/// Those that are there are counted where they were when the step began, those of this step where they were born. Each newborn
/// of a step is held against the others, so n of them cost n² looks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WhereSparse {
    /// How far neighbours are looked for \[m\].
    pub radius: f32,
    /// With fewer neighbours a place is sparse.
    pub fewest: u32,
}

/// How often a place inside a shape is sought in a box around it, before one on its surface has to do.
const DRAWS: u32 = 1024;
/// Places that are tried in a step where births come only where others are few, for each particle that there is room for.
const TRIES: u64 = 16;

/// A surface that gives birth to particles.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        deny_unknown_fields,
        bound(
            serialize = "S: serde::Serialize, M: Script + serde::Serialize",
            deserialize = "S: serde::Deserialize<'de>, M: Default + serde::Deserialize<'de>"
        )
    )
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "schema",
    schemars(bound = "S: schemars::JsonSchema, M: Script + Default + serde::Serialize + schemars::JsonSchema")
)]
pub struct Emitter<S, M = ()> {
    /// Where births lie, uniformly by area.
    pub shape: S,
    /// Births lie inside the shape, if it is closed: uniformly by volume. Their directions lead away from its middle. Where a thousand places in a box around it are
    /// none in it, a birth lies on its surface, which [`Caps::outside`](crate::Caps::outside) counts.
    #[cfg_attr(feature = "serde", serde(default))]
    pub inside: bool,
    /// Births come only where others are few: what the rate and the bursts bring are places that are tried, in a step no more than sixteen for each particle that
    /// there is room for. The others are refused.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub where_sparse: Option<WhereSparse>,
    /// The group of a scene file whose transform applies to the shape, the direction and the velocity; a `Model`
    /// has applied it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u32>,
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
    /// How it moves besides, the shape and the direction with it; `()`: not at all.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Script::is_still"))]
    pub motion: M,
    /// The share of the emitter's velocity that births take along, usually 0 to 1.
    #[cfg_attr(feature = "serde", serde(default))]
    pub inherit: f32,
    /// Radius \[m\]; zero: points.
    #[cfg_attr(feature = "serde", serde(default))]
    pub radius: Varied,
    /// Mass \[kg\].
    #[cfg_attr(feature = "serde", serde(default = "one"))]
    pub mass: Varied,
    /// Births never move.
    #[cfg_attr(feature = "serde", serde(default))]
    pub fixed: bool,
    /// Coefficient of linear drag \[kg/s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub drag: Varied,
    /// Electric charge \[C\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub charge: Varied,
    /// Share of the normal speed kept in a hit; below zero counts as zero.
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
    #[cfg_attr(feature = "serde", serde(default, alias = "color_variance"))]
    pub color_half_width: Color,
}

/// One emitter, or two if it has bursts: those of the rate and those of the bursts are numbered separately, so that
/// their random numbers do not depend on which come first in a step.
impl<S: Surface + Sync, M: Script> Emit for Emitter<S, M> {
    fn count(&self) -> usize {
        1 + usize::from(self.burst.is_some())
    }

    fn reach(&self) -> f32 {
        self.where_sparse.map_or(0.0, |sparse| sparse.radius)
    }

    fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
        visit(&self.extreme(0.0));
        visit(&self.extreme(1.0));
        true
    }

    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        let (start, stop) = (Time::from_seconds(self.start), self.stop.map_or(Time::NEVER, Time::from_seconds));
        let (first, last) = (from.max(start), to.min(stop));
        if let Some(burst) = &self.burst {
            let number = births.claim();
            self.emit_bursts(burst, [first, last], births, number);
        }
        if first < last {
            let aim = self.spread.aim();
            let (ahead, mut tries) = (self.where_sparse.is_none(), self.tries(births));
            let bear = |births: &mut Births<'_>, at| self.bear(births, (number, &mut tries), at, aim);
            births.bring(number, self.rate, ahead, [first, last], bear);
        }
    }
}

impl<S> Emitter<S> {
    /// An emitter of `rate` births per second: points at rest, of 1 kg, immortal, of elasticity 0.5.
    #[must_use]
    pub const fn new(shape: S, rate: f32) -> Self {
        Self::moving(shape, rate, ())
    }
}

impl<S, M> Emitter<S, M> {
    /// The same, of a shape that moves.
    #[must_use]
    pub const fn moving(shape: S, rate: f32, motion: M) -> Self {
        Self {
            shape,
            inside: false,
            where_sparse: None,
            group: None,
            rate,
            burst: None,
            start: 0.0,
            stop: None,
            speed: Varied::exactly(0.0),
            direction: None,
            spread: Spread::Uniform(0.0),
            velocity: Vec3::ZERO,
            motion,
            inherit: 0.0,
            radius: Varied::exactly(0.0),
            mass: Varied::exactly(1.0),
            fixed: false,
            drag: Varied::exactly(0.0),
            charge: Varied::exactly(0.0),
            elasticity: Varied::exactly(0.5),
            lifetime: Varied::exactly(0.0),
            material: None,
            color: None,
            color_half_width: [0; 4],
        }
    }

    /// The same emitter with births of exactly this mass, drag, elasticity and lifetime, fixed if this is.
    #[must_use]
    pub const fn giving_birth_to(mut self, newborn: &Particle) -> Self {
        self.mass = Varied::exactly(newborn.mass);
        self.fixed = newborn.fixed;
        self.drag = Varied::exactly(newborn.drag);
        self.elasticity = Varied::exactly(newborn.elasticity);
        self.lifetime = Varied::exactly(newborn.lifetime);
        self
    }
}

impl<S: Surface, M: Script> Emitter<S, M> {
    /// The bursts whose instants lie in [from, to): one at zero belongs to the first step.
    fn emit_bursts(&self, burst: &Burst, [from, to]: [Time; 2], births: &mut Births<'_>, number: usize) {
        let (first, every) = (Time::from_seconds(burst.at).ticks(), Time::from_seconds(burst.every).ticks());
        if burst.count == 0 {
            return;
        }
        // The first burst that is not before `from`, if there is more than one.
        let (_, past) = divide(u128::from(from.ticks().saturating_sub(first)), every.max(1));
        let (mut ticks, aim, mut tries) = (first, self.spread.aim(), self.tries(births));
        if first < from.ticks() && every > 0 {
            ticks = if past == 0 { from.ticks() } else { from.ticks().saturating_add(every - past) };
        }
        loop {
            let at = Time::from_ticks(ticks);
            if at < from || at >= to {
                return;
            }
            let mut fits = true;
            for given in 0..burst.count {
                if births.is_full() || !fits {
                    births.refuse(number, u64::from(burst.count - given));
                    break;
                }
                fits = self.bear(births, (number, &mut tries), at, aim);
            }
            if every == 0 {
                return;
            }
            // Once nothing fits, what is left of this step's bursts is only counted.
            if births.is_full() || !fits {
                let (rest, _) = divide(u128::from(to.ticks() - 1 - ticks), every);
                births.refuse(number, rest.saturating_mul(u64::from(burst.count)));
                return;
            }
            ticks = ticks.saturating_add(every);
        }
    }

    /// The number of places that may be tried in a step.
    fn tries(&self, births: &Births<'_>) -> u64 {
        if self.where_sparse.is_some() { TRIES.saturating_mul(births.capacity() as u64) } else { u64::MAX }
    }

    /// One birth, if it comes to one. False if it was refused: so will those be that are like it.
    fn bear(&self, births: &mut Births<'_>, (number, tries): (usize, &mut u64), at: Time, aim: Aim) -> bool {
        let mut is_outside = false;
        let is_given = match self.where_sparse {
            None => births.give_drawn(number, at, |drawn| self.newborn(drawn, at, aim, &mut is_outside)).is_ok(),
            Some(_) if *tries == 0 => {
                births.refuse(number, 1);
                false
            }
            Some(WhereSparse { radius, fewest }) => {
                *tries -= 1;
                births.offer(number, at, |stream, births| {
                    let newborn = self.newborn((stream, stream.units_of(PLACES)), at, aim, &mut is_outside);
                    let is_sparse = births.count_within(newborn.position, radius) < u64::from(fewest);
                    is_outside &= is_sparse;
                    is_sparse.then_some(newborn)
                });
                true
            }
        };
        births.report.caps.outside += u64::from(is_outside);
        is_given
    }

    /// A particle whose attributes are the least that a birth may have, for zero, or for one the greatest.
    #[cfg_attr(one_by_one, inline(never))]
    fn extreme(&self, u: f32) -> Particle {
        let mut tint = self.color.unwrap_or(WHITE);
        for (channel, half_width) in tint.iter_mut().zip(self.color_half_width) {
            *channel = if u == 0.0 { channel.saturating_sub(half_width) } else { channel.saturating_add(half_width) };
        }
        Particle {
            radius: self.radius.pick(u),
            mass: self.mass.pick(u),
            fixed: self.fixed,
            drag: self.drag.pick(u),
            charge: self.charge.pick(u),
            elasticity: self.elasticity.pick(u),
            material: self.material,
            color: Some(tint),
            ..Particle::REST
        }
    }

    /// A place inside the shape: the first that falls there of several in a box around it.
    fn place_inside(&self, random: Stream) -> Option<Spot> {
        let [corner, x, y, z] = self.shape.around();
        let drawn = (0..DRAWS).map(|draw| {
            let ([u, v], [w, _]) = (random.units(8 + 2 * draw), random.units(9 + 2 * draw));
            corner + x * u + y * v + z * w
        });
        let point = { drawn }.find(|&point| self.shape.is_inside(point))?;
        let Aabb { min, max } = self.shape.bounds();
        Some(Spot { point, normal: unit(point - (min + max) * 0.5) })
    }

    /// A newborn, and whether it lies outside although it should not. Each property draws from a place of its own, so that a change of one leaves the others alone.
    fn newborn(&self, (random, pairs): Drawn, at: Time, aim: Aim, is_outside: &mut bool) -> Particle {
        let [[u, v], [w, p], [q, speed], [bounce, life]] = pairs;
        let inside = if self.inside { self.place_inside(random) } else { None };
        *is_outside = self.inside && inside.is_none();
        let spot = inside.unwrap_or_else(|| self.shape.sample([u, v, w]));
        let axis = self.direction.map_or(spot.normal, unit);
        let (spot, axis, along_with) = self.carried(spot.point, axis, at);
        let direction = aim.direction(axis, [p, q]);
        Particle {
            position: along(spot, self.velocity, at.seconds()),
            velocity: along(scaled(along_with, self.inherit), direction, self.speed.pick(speed)),
            radius: self.radius.draw(random, 7, 1),
            mass: self.mass.draw(random, 3, 0),
            fixed: self.fixed,
            drag: self.drag.draw(random, 3, 1),
            charge: self.charge.draw(random, 7, 0),
            elasticity: self.elasticity.pick(bounce),
            lifetime: self.lifetime.pick(life),
            material: self.material,
            color: Some(self.tint(random)),
        }
    }

    /// Where its motion has brought a place and a direction by an instant, and the velocity of the emitter there.
    fn carried(&self, point: Vec3, axis: Vec3, at: Time) -> (Vec3, Vec3, Vec3) {
        if self.motion.is_still() {
            return (point, axis, self.velocity);
        }
        let frame = self.motion.frame(at);
        let point = frame.world(point);
        (point, frame.turn * axis, self.velocity + frame.velocity_at(point))
    }

    fn tint(&self, random: Stream) -> Color {
        let mean = self.color.unwrap_or(WHITE);
        if self.color_half_width == [0; 4] {
            return mean;
        }
        let ([a, b], [c, d]) = (random.units(5), random.units(6));
        let mut tint = mean;
        for ((channel, half_width), u) in tint.iter_mut().zip(self.color_half_width).zip([a, b, c, d]) {
            // The cast saturates at 0 and 255.
            *channel = (f32::from(*channel) + f32::from(half_width) * (2.0 * u - 1.0) + 0.5) as u8;
        }
        tint
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
