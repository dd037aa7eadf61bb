//! Records of what happened: all of it, once.

use pointmass::shape::Cuboid;
use pointmass::{
    Cause, Emitter, Event, EventKind, Events, Gravity, Id, Impact, LifeEvent, Meetings, Observer, Particle, Report,
    Scene, System, Time, Varied, Vec3,
};
use pointmass_tests::{Random, point, started};

/// All that is told, in a list without a bound.
#[derive(Default)]
struct All(Vec<Event>);

impl Observer for All {
    fn hit(&mut self, hit: &Impact) {
        let kind = hit.other.map_or(EventKind::Hit, EventKind::Contact);
        let Impact { id, place, normal, closing, time, .. } = *hit;
        self.0.push(Event { kind, id: Some(id), place, normal, speed: closing, time });
    }
    fn born(&mut self, birth: &LifeEvent) {
        let LifeEvent { id, place, velocity, time } = *birth;
        let speed = velocity.length();
        self.0.push(Event { kind: EventKind::Birth, id: Some(id), place, normal: Vec3::ZERO, speed, time });
    }
    fn died(&mut self, death: &LifeEvent, cause: Cause) {
        let LifeEvent { id, place, velocity, time } = *death;
        let speed = velocity.length();
        self.0.push(Event { kind: EventKind::Death(cause), id: Some(id), place, normal: Vec3::ZERO, speed, time });
    }
    fn refused(&mut self, count: u64, time: Time) {
        self.0.push(Event { kind: EventKind::Overflow(count), time, ..Event::NOTHING });
    }
}

const ROOM: Cuboid = Cuboid { min: Vec3::splat(-1.0), max: Vec3::ONE };
const SINK: Cuboid = Cuboid { min: Vec3::splat(-1.0), max: Vec3::new(-0.4, -0.7, -0.4) };

/// Calls `then` with a system in which all of it happens, before each of its steps.
fn play(mut then: impl FnMut(&mut System<pointmass::Heap>, &Scene<'_>)) {
    let mut random = Random::new(71);
    let start: Vec<Particle> = (0..27)
        .map(|i| Particle {
            position: Vec3::new((i % 3) as f32, (i / 9) as f32, (i / 3 % 3) as f32) * 0.5 - 0.4,
            velocity: random.vector(3.0),
            radius: 0.1,
            lifetime: if i % 4 == 0 { random.between(0.1, 1.0) } else { 0.0 },
            elasticity: 0.9,
            fixed: i == 13,
            ..Particle::REST
        })
        .collect();
    let emitter = Emitter {
        speed: Varied::exactly(2.0),
        radius: Varied::exactly(0.05),
        direction: Some(Vec3::new(1.0, 2.0, 0.5)),
        ..Emitter::new(point(Vec3::splat(-0.25)), 60.0)
    };
    let scene = Scene {
        start: &start,
        emitters: &emitter,
        forces: &Gravity::EARTH,
        colliders: &ROOM,
        sinks: &SINK,
        meetings: Meetings::IMPULSE,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, 33, 3);
    for _ in 0..90 {
        then(&mut system, &scene);
    }
    let Report { born, refused, hits, contacts, died, .. } = *system.totals();
    assert!(born > 9 && refused > 9 && hits > 50 && contacts > 50 && died.sink > 3 && died.lifetime > 3);
}

#[test]
fn everything_is_told_once() {
    let mut room = vec![Event::NOTHING; 10_000];
    let dt = Time::frame(1, 60);
    play(|system, scene| {
        let began = system.time();
        let alive: Vec<Id> = (0..system.len()).filter_map(|row| system.id(row)).collect();
        let pinned = alive.iter().copied().find(|id| id.serial() == 13);
        let mut events = Events::new(&mut room);
        let report = system.step_observed(scene, dt, &mut events);
        let (mut hits, mut born, mut refused, mut pairs) = (0, 0, 0, [0; 2]);
        let mut died = [0; 3];
        let (list, mut known) = (events.as_slice(), alive);
        for event in list {
            let id = event.id;
            assert!(event.time >= began && event.time <= system.time(), "{event:?}");
            match event.kind {
                EventKind::Overflow(count) => {
                    refused += count;
                    assert_eq!(id, None);
                    continue;
                }
                EventKind::Birth => {
                    born += 1;
                    known.push(id.expect("who"));
                    assert_eq!(event.place, Vec3::splat(-0.25));
                    assert!((event.speed - 2.0).abs() < 1e-6);
                }
                EventKind::Death(cause) => {
                    died[match cause {
                        Cause::Lifetime => 0,
                        Cause::Sink => 1,
                        Cause::Nonfinite => 2,
                        Cause::Chance | Cause::Density | Cause::Other => panic!("there is no such rule"),
                    }] += 1;
                    assert_eq!((event.time, system.row(id.expect("who"))), (system.time(), None));
                }
                EventKind::Hit | EventKind::Contact(_) => {
                    assert!((event.normal.length() - 1.0).abs() < 1e-5 && event.speed >= 0.0);
                    assert!(event.place.abs().max_element() <= 1.0);
                    let EventKind::Contact(other) = event.kind else {
                        hits += 1;
                        assert!(event.place.abs().max_element() > 0.85, "{event:?}");
                        continue;
                    };
                    assert!(known.contains(&other) && id != pinned);
                    if Some(other) == pinned {
                        pairs[1] += 1;
                        continue;
                    }
                    pairs[0] += 1;
                    let twins = list.iter().filter(|twin| {
                        let exchanged = twin.id == Some(other) && Some(twin.kind) == id.map(EventKind::Contact);
                        exchanged
                            && twin.time == event.time
                            && twin.speed == event.speed
                            && twin.normal == -event.normal
                    });
                    assert_eq!(twins.count(), 1);
                }
            }
            assert!(known.contains(&id.expect("who")), "{event:?}");
        }
        assert_eq!((hits, born, refused), (report.hits, report.born, report.refused));
        assert_eq!(pairs[0] + 2 * pairs[1], 2 * report.contacts);
        assert_eq!(died, [report.died.lifetime, report.died.sink, report.died.nonfinite]);
        assert_eq!(events.lost(), 0);
    });
}

#[test]
fn what_finds_no_room_is_counted() {
    let dt = Time::frame(1, 60);
    let mut all = All::default();
    play(|system, scene| {
        system.step_observed(scene, dt, &mut all);
    });
    for size in [0, 1, 100, all.0.len(), all.0.len() + 1] {
        let mut room = vec![Event::NOTHING; size];
        let mut events = Events::new(&mut room);
        play(|system, scene| {
            system.step_observed(scene, dt, &mut events);
        });
        // Twice the same, and those that came first are kept.
        let kept = size.min(all.0.len());
        assert_eq!(events.as_slice(), &all.0[..kept]);
        assert_eq!(events.lost(), (all.0.len() - kept) as u64);
        events.clear();
        assert_eq!((events.as_slice().len(), events.lost()), (0, 0));
    }
}
