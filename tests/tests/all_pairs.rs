//! Whoever has to look at all pairs for want of an index is counted, whatever looks.

use pointmass::emit::Births;
use pointmass::index::{IndexChoice, Room, SpatialIndex, Structure};
use pointmass::reap::Dense;
use pointmass::{Contacts, Emit, Meetings, Particle, Penalty, Scene, Time, Vec3};
use pointmass_tests::{Random, started};

/// A grid in memory that does not do.
struct Starved;

impl IndexChoice for Starved {
    fn columns(&self) -> usize {
        Structure::Grid.columns()
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        Structure::Grid.with_index(&mut memory[..20], points, reach, room, then);
    }
}

/// Looks around, and emits nothing.
struct Shy;

impl Emit for Shy {
    fn count(&self) -> usize {
        1
    }
    fn reach(&self) -> f32 {
        0.2
    }
    fn emit(&self, _: Time, _: Time, births: &mut Births<'_>) {
        let _ = births.state().count_within(Vec3::ZERO, 0.2);
    }
}

fn cloud() -> Vec<Particle> {
    let mut random = Random::new(4);
    let ball = |_| Particle { position: random.vector(1.0), radius: 0.05, ..Particle::REST };
    (0..300).map(ball).collect()
}

/// Searches among all pairs in a step, and the hash after it.
fn searches(scene: &Scene<'_>) -> (u64, u64) {
    let mut system = started(scene, scene.start.len(), 0);
    (system.step(scene, Time::frame(1, 60)).effort.all_pairs, system.hash())
}

#[test]
fn who_looks_at_all_pairs_is_counted() {
    let start = cloud();
    let penalty = Penalty { stiffness: 100.0, reach: 0.1, ..Penalty::NONE };
    let plain = Scene { start: &start, ..Scene::EMPTY };
    let scenes = [
        ("forces", Scene { forces: &penalty, ..plain }),
        ("constraints", Scene { constraints: &Contacts::HARD, ..plain }),
        ("births", Scene { emitters: &Shy, ..plain }),
        ("deaths", Scene { reapers: &Dense { radius: 0.1, most: 3 }, ..plain }),
        ("meetings", Scene { meetings: Meetings::IMPULSE, ..plain }),
    ];
    for (name, scene) in scenes {
        let (with, hash) = searches(&Scene { index: &Structure::Grid, ..scene });
        assert_eq!(with, 0, "{name}");
        for index in [&() as &dyn IndexChoice, &Starved] {
            assert_eq!(searches(&Scene { index, ..scene }), (1, hash), "{name}");
        }
    }
    let [(_, forces), (_, constraints), (_, births), (_, deaths), _] = scenes;
    let Scene { constraints, .. } = constraints;
    let all = Scene { constraints, emitters: births.emitters, reapers: deaths.reapers, index: &Starved, ..forces };
    assert_eq!(searches(&all).0, 4);
}

/// Balls that are struck from both sides fly farther than anybody was seen to go when the index was asked for.
#[test]
fn meetings_that_lead_beyond_the_index_are_counted() {
    let ball = |x: f32, v: f32, mass: f32| Particle {
        position: Vec3::X * x,
        velocity: Vec3::X * v,
        radius: 0.05,
        mass,
        elasticity: 1.0,
        ..Particle::REST
    };
    let mut start = vec![ball(-0.3, 10.0, 1e3), ball(0.0, 0.0, 1.0), ball(0.4, -10.0, 1e3)];
    // Of few there would be no index.
    start.extend((0..100).map(|i| ball(10.0 + i as f32, 0.0, 1.0)));
    let scene = Scene { start: &start, meetings: Meetings::IMPULSE, index: &Structure::Grid, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    let calm = system.step(&scene, Time::from_seconds(0.01));
    assert_eq!((calm.contacts, calm.effort.all_pairs), (0, 0));
    let wild = system.step(&scene, Time::from_seconds(0.09));
    assert!(wild.contacts > 2 && wild.effort.all_pairs == 1, "{wild:?}");
}
