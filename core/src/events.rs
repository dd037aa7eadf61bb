//! Records of what happened in a step, one each, for whoever wants to hear, count or draw it.

use crate::observe::{Attention, Impact, LifeEvent, Observer};
use crate::particles::Id;
use crate::reap::Cause;
use crate::time::Time;
use glam::Vec3;

/// Something that happened to a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// What.
    pub kind: EventKind,
    /// The particle; of births that found no room, none.
    pub id: Option<Id>,
    /// Where its middle was \[m\].
    pub place: Vec3,
    /// The normal of what was hit, toward the particle; zero for events other than hits.
    pub normal: Vec3,
    /// The speed at which the two came together in a hit; else its own \[m/s\].
    pub speed: f32,
    /// When; of a death the end of its last step.
    pub time: Time,
}

/// The kind of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EventKind {
    /// A particle hit a collider.
    #[default]
    Hit,
    /// A particle hit another; there is a second record in which the two are exchanged, unless the other is fixed.
    Contact(Id),
    /// A particle was born.
    Birth,
    /// A particle died.
    Death(Cause),
    /// So many births found no room.
    Overflow(u64),
}

/// Records of a step in memory that its owner lends: watch with it by [`System::step_observed`](crate::System), read, clear.
///
/// Events that find no room are counted; nothing is overwritten. What rests on a collider hits it in every step. Contacts held by position
/// and those by force are recorded where they begin, faster than what rests meets in a step.
///
/// ```
/// use pointmass::shape::Plane;
/// use pointmass::{Event, EventKind, Events, Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// let start = [Particle { position: Vec3::Y, ..Particle::REST }];
/// let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &ground, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// let mut room = [Event::NOTHING; 16];
/// let mut events = Events::new(&mut room);
/// for _ in 0..30 {
///     system.step_observed(&scene, Time::frame(1, 60), &mut events);
/// }
/// let [hit] = events.as_slice() else { panic!("one hit in the first half second") };
/// assert_eq!((hit.kind, hit.normal, events.lost()), (EventKind::Hit, Vec3::Y, 0));
/// assert!((hit.time.seconds() - 0.4516).abs() < 0.01);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Debug)]
pub struct Events<'a> {
    room: &'a mut [Event],
    len: usize,
    lost: u64,
}

impl Event {
    /// The event that empty memory is filled with.
    pub const NOTHING: Self =
        Self { kind: EventKind::Hit, id: None, place: Vec3::ZERO, normal: Vec3::ZERO, speed: 0.0, time: Time::ZERO };
}

impl<'a> Events<'a> {
    /// No events yet, and room for as many as there are in the slice.
    pub fn new(room: &'a mut [Event]) -> Self {
        Self { room, len: 0, lost: 0 }
    }

    /// The events, in the order in which they were found: by phase of the step, not by time.
    #[must_use]
    pub fn as_slice(&self) -> &[Event] {
        &self.room[..self.len]
    }

    /// The number of events that found no room.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Forgets them all.
    pub fn clear(&mut self) {
        (self.len, self.lost) = (0, 0);
    }

    fn push(&mut self, event: Event) {
        match self.room.get_mut(self.len) {
            Some(place) => {
                *place = event;
                self.len += 1;
            }
            None => self.lost = self.lost.saturating_add(1),
        }
    }

    fn pass(&mut self, kind: EventKind, passing: &LifeEvent) {
        let LifeEvent { id, place, velocity, time } = *passing;
        self.push(Event { kind, id: Some(id), place, normal: Vec3::ZERO, speed: crate::math::length(velocity), time });
    }
}

impl Observer for Events<'_> {
    fn attention(&self) -> Attention {
        Attention::Events
    }

    fn hit(&mut self, hit: &Impact) {
        let kind = hit.other.map_or(EventKind::Hit, EventKind::Contact);
        let Impact { id, place, normal, closing, time, .. } = *hit;
        self.push(Event { kind, id: Some(id), place, normal, speed: closing, time });
    }

    fn touched(&mut self, touch: &Impact) {
        self.hit(touch);
    }

    fn born(&mut self, birth: &LifeEvent) {
        self.pass(EventKind::Birth, birth);
    }

    fn died(&mut self, death: &LifeEvent, cause: Cause) {
        self.pass(EventKind::Death(cause), death);
    }

    fn refused(&mut self, count: u64, time: Time) {
        self.push(Event { kind: EventKind::Overflow(count), time, ..Event::NOTHING });
    }
}
