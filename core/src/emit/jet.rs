//! An emitter for those who have little room for code.

use super::{Births, Emit, Spread, Varied};
use crate::math::{along, plus};
use crate::particles::{Particle, Start};
use crate::shape::Surface;
use crate::time::Time;
use glam::Vec3;

/// What small programs need of an [`Emitter`](super::Emitter): births at a rate, for ever, all of them alike but for their places, velocities and
/// lifetimes. They are those of an `Emitter` of which no more is asked, to the bit; a chip is spared two kilobytes of the rest.
///
/// ```
/// use pointmass::shape::Disc;
/// use pointmass::{Heap, Jet, Particle, Scene, System, Time, Varied, Vec3};
///
/// let nozzle = Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 0.1 };
/// let jet = Jet { speed: Varied::exactly(4.0), angle: 0.3, ..Jet::new(nozzle, 100.0, Particle::REST) };
/// let scene = Scene { emitters: &jet, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size_for(100)));
/// system.start(&scene, 1)?;
/// assert_eq!(system.step(&scene, Time::from_seconds(0.5)).born, 50);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S> {
    /// Where births lie, uniformly by area; they leave along its normal.
    pub shape: S,
    /// Births per second.
    pub rate: f32,
    /// Speed \[m/s\].
    pub speed: Varied,
    /// Directions are uniform in solid angle within this angle of the normal \[rad\], 0 to π.
    pub angle: f32,
    /// Lifetime \[s\]; zero or less: for ever.
    pub lifetime: Varied,
    /// The other attributes of all births.
    pub newborn: Particle,
}

impl<S> Jet<S> {
    /// A jet of `rate` births per second that are like `newborn`, at rest and as long-lived.
    #[must_use]
    pub const fn new(shape: S, rate: f32, newborn: Particle) -> Self {
        let (speed, lifetime) = (Varied::exactly(0.0), Varied::exactly(newborn.lifetime));
        Self { shape, rate, speed, angle: 0.0, lifetime, newborn }
    }
}

impl<S: Surface + Sync> Emit for Jet<S> {
    fn count(&self) -> usize {
        1
    }

    fn extremes(&self, visit: &mut dyn FnMut(&Particle)) -> bool {
        visit(&self.newborn);
        true
    }

    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        births.bring(number, self.rate, true, [from, to], |births, at| {
            births.give_like(number, at, &self.newborn, |(_, pairs)| self.start(pairs, at)).is_ok()
        });
    }
}

impl<S: Surface> Jet<S> {
    /// How a newborn begins: each property draws from the place that it has in an `Emitter`, whose sums of what is nothing here make zeros positive.
    fn start(&self, [[u, v], [w, p], [q, speed], [_, life]]: [[f32; 2]; 4], born: Time) -> Start {
        let spot = self.shape.sample([u, v, w]);
        let direction = Spread::Uniform(self.angle).direction(spot.normal, [p, q]);
        let velocity = along(Vec3::ZERO, direction, self.speed.pick(speed));
        Start { position: plus(spot.point, Vec3::ZERO), velocity, lifetime: self.lifetime.pick(life), born }
    }
}
