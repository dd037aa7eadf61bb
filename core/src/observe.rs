//! Looking on while a step is made.

use crate::composed::{composed, each};
use crate::custom::CustomColumnsMut;
use crate::force::State;
use crate::math::max;
use crate::particles::Id;
use crate::reap::Cause;
use crate::time::Time;
use glam::Vec3;

/// Watches the phases of a step: what ledgers and recorders of events are made of. `()` looks away. A tuple, list,
/// option or box of observers is one, by turns, and so is a `&mut` to one.
///
/// ```
/// use pointmass::{Attention, Cause, Heap, LifeEvent, Observer, Particle, Scene, System, Time};
///
/// /// Counts who dies of age.
/// struct Registrar(u32);
///
/// impl Observer for Registrar {
///     // The phases do not matter to it: steps stay as fast as they are unseen.
///     fn attention(&self) -> Attention {
///         Attention::Events
///     }
///
///     fn died(&mut self, _: &LifeEvent, cause: Cause) {
///         self.0 += u32::from(cause == Cause::Lifetime);
///     }
/// }
///
/// let start = [Particle { lifetime: 1.0, ..Particle::REST }, Particle::REST];
/// let scene = Scene { start: &start, ..Scene::EMPTY };
/// let (mut system, mut registrar) = (System::with(Heap::new(scene.size())), Registrar(0));
/// system.start(&scene, 1)?;
/// system.step_observed(&scene, Time::from_seconds(2.0), &mut registrar);
/// assert_eq!(registrar.0, 1);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Observer {
    /// The step has come so far.
    fn after(&mut self, phase: Phase, state: &State<'_>) {
        let _ = (phase, state);
    }

    /// Tells what it wants to know of. A step in which no particle looks at another and nobody watches the phases takes
    /// them through all of these a few at a time; and many at once, if nothing is to be told and the program has
    /// threads. To the same bits. Unless it says otherwise it wants to know everything, which is slowest.
    fn attention(&self) -> Attention {
        Attention::Phases
    }

    /// May change columns of a user's own, at the step's end when the dead are gone. The state's own columns of that kind are
    /// empty, as `custom` has them.
    fn write(&mut self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>) {
        let _ = (state, custom);
    }

    /// A particle met a collider or another particle, and was answered. What rests on a collider meets it in every step: whoever counts
    /// blows passes over those with a small [`closing`](Impact::closing) speed.
    fn hit(&mut self, hit: &Impact) {
        let _ = hit;
    }

    /// A constraint or a force keeps a particle from a collider or from another particle, with which it came together faster than what
    /// rests does in a step: told once, at the sub-step's end. A force has only begun to push then, so the velocity after is that at this end.
    fn touched(&mut self, touch: &Impact) {
        let _ = touch;
    }

    /// A particle that has come to rest on a surface slides along it, or stays and is carried, for the rest of the step. Should it meet something
    /// on the way, the part that it does not go is told of as well, backwards: from the end of the slide to where that stops.
    fn slid(&mut self, slide: &Sliding) {
        let _ = slide;
    }

    /// A particle was born.
    fn born(&mut self, birth: &LifeEvent) {
        let _ = birth;
    }

    /// A particle dies.
    fn died(&mut self, death: &LifeEvent, cause: Cause) {
        let _ = (death, cause);
    }

    /// So many births up to an instant found no room.
    fn refused(&mut self, count: u64, time: Time) {
        let _ = (count, time);
    }
}

impl Observer for () {
    fn attention(&self) -> Attention {
        Attention::Nothing
    }
}

/// The methods of an observer that has parts: all watch, one after the other.
macro_rules! all_watch {
    ($parts:tt) => {
        fn after(&mut self, phase: Phase, state: &State<'_>) {
            each!(self, $parts, part => {
                part.after(phase, state);
            });
        }
        fn attention(&self) -> Attention {
            let mut most = Attention::Nothing;
            each!(self, $parts, part => {
                most = most.max(part.attention());
            });
            most
        }
        fn write(&mut self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>) {
            each!(self, $parts, part => {
                part.write(state, custom);
            });
        }
        fn hit(&mut self, hit: &Impact) {
            each!(self, $parts, part => {
                part.hit(hit);
            });
        }
        fn touched(&mut self, touch: &Impact) {
            each!(self, $parts, part => {
                part.touched(touch);
            });
        }
        fn slid(&mut self, slide: &Sliding) {
            each!(self, $parts, part => {
                part.slid(slide);
            });
        }
        fn born(&mut self, birth: &LifeEvent) {
            each!(self, $parts, part => {
                part.born(birth);
            });
        }
        fn died(&mut self, death: &LifeEvent, cause: Cause) {
            each!(self, $parts, part => {
                part.died(death, cause);
            });
        }
        fn refused(&mut self, count: u64, time: Time) {
            each!(self, $parts, part => {
                part.refused(count, time);
            });
        }
    };
}

composed!(Observer by all_watch);

/// Whoever stands for another watches as that would.
macro_rules! as_it_would {
    ($($(#[$when:meta])* $this:ty;)+) => {$(
        $(#[$when])*
        impl<O: Observer + ?Sized> Observer for $this {
            fn attention(&self) -> Attention {
                (**self).attention()
            }

            fn after(&mut self, phase: Phase, state: &State<'_>) {
                (**self).after(phase, state);
            }

            fn write(&mut self, state: &State<'_>, custom: &mut CustomColumnsMut<'_>) {
                (**self).write(state, custom);
            }

            fn hit(&mut self, hit: &Impact) {
                (**self).hit(hit);
            }

            fn touched(&mut self, touch: &Impact) {
                (**self).touched(touch);
            }

            fn slid(&mut self, slide: &Sliding) {
                (**self).slid(slide);
            }

            fn born(&mut self, birth: &LifeEvent) {
                (**self).born(birth);
            }

            fn died(&mut self, death: &LifeEvent, cause: Cause) {
                (**self).died(death, cause);
            }

            fn refused(&mut self, count: u64, time: Time) {
                (**self).refused(count, time);
            }
        }
    )+};
}
as_it_would! {
    &mut O;
    #[cfg(feature = "alloc")]
    alloc::boxed::Box<O>;
}

/// The parts of a step that an observer wants to know of: each of these is more than the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Attention {
    /// Nothing at all; some of it may be told all the same.
    Nothing,
    /// The events of particles; phases may be told all the same.
    Events,
    /// The state after each phase as well.
    Phases,
}

/// Where in a step one is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing has been done yet.
    Begin,
    /// Emitters have emitted; the newborn are where and when they were born.
    Create,
    /// The integrator has moved the old so far on its way through the step. The newborn have not moved since the sub-step began.
    Advance,
    /// The integrator has moved the old to the end of a sub-step, and constraints are about to.
    Project,
    /// Constraints have moved the old at the end of a sub-step.
    Constrain,
    /// The integrator has moved the old to a sub-step's end, and the newborn have flown there. Those who are born later are still where they
    /// will be.
    Move,
    /// Springs that were stretched too far have broken, at the end of the last sub-step.
    Snap,
    /// All have been held against colliders and sinks, at a sub-step's end.
    Collide,
    /// All have the drags and masses of the step's end, where materials change these over lives.
    Age,
    /// Those whose time has come are gone.
    Delete,
}

/// A particle's meeting with a collider or with another particle; that of two particles is told of both, unless one of
/// them is fixed: nothing happens to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The particle.
    pub id: Id,
    /// Its row, during this step.
    pub row: usize,
    /// The particle it met; none: a collider.
    pub other: Option<Id>,
    /// Its mass \[kg\].
    pub mass: f32,
    /// Where its middle was \[m\].
    pub place: Vec3,
    /// Normal of the other's surface, toward the particle.
    pub normal: Vec3,
    /// The speed at which the two came together along it \[m/s\].
    pub closing: f32,
    /// Its velocity before \[m/s\].
    pub before: Vec3,
    /// Its velocity after \[m/s\].
    pub after: Vec3,
    /// How the collider moves there \[m/s\]; zero for another particle.
    pub surface: Vec3,
    /// The instant.
    pub time: Time,
}

/// How fast two came together that parted at the first speed before forces pressed them, and at the second one then \[m/s\]; none, if that is no more
/// than forces give what rests in a step of so many sub-steps.
pub(crate) fn closing([begun, ended]: [f32; 2], substeps: u32) -> Option<f32> {
    let rests = substeps as f32 * max(begun - ended, 0.0);
    let closing = max(-begun, -ended);
    (closing > rests && closing < f32::INFINITY).then_some(closing)
}

/// How something goes on that rests on a surface: in the world, and as seen from the surface, along which friction acts. Of
/// two particles that rest on each other it tells their motion toward each other, once, with their reduced mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// The mass \[kg\].
    pub mass: f32,
    /// How far it has been set off from where it touched \[m\].
    pub raised: Vec3,
    /// Its acceleration by forces \[m/s²\], the way it goes \[m\], and its velocities at the beginning and the end
    /// \[m/s\].
    pub world: [Vec3; 4],
    /// The same along the surface, as seen from there.
    pub along: [Vec3; 4],
}

/// A particle that has just been born, or is just about to be removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LifeEvent {
    /// The particle.
    pub id: Id,
    /// Where \[m\].
    pub place: Vec3,
    /// Its velocity \[m/s\].
    pub velocity: Vec3,
    /// Its birth, or the end of the step in which it died.
    pub time: Time,
}
