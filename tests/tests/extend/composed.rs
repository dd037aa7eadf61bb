//! What stands for a part of a scene is one: references and boxes of any kind, options, lists.

use pointmass::index::{IndexChoice, Periodic, Room, Structure};
use pointmass::shape::{Collider, Plane, Sphere};
use pointmass::{
    Attention, Chance, Constraint, Contacts, Custom, CustomList, Distance, Drag, Emit, Emitter, Force, Gravity,
    Impulse, Integrator, LifeEvent, MaterialList, Meetings, Observer, Particle, Reaper, Rk4, Scene, Spring, SpringList,
    Time, Varied, Vec3,
};
use pointmass_tests::started;

/// How many are born while it watches.
#[derive(Default)]
struct Registrar(u32);

impl Observer for Registrar {
    fn attention(&self) -> Attention {
        Attention::Events
    }
    fn born(&mut self, _: &LifeEvent) {
        self.0 += 1;
    }
}

/// The hash of a scene after some steps.
fn hash(scene: &Scene<'_>) -> u64 {
    let mut system = started(scene, 60, 0);
    for _ in 0..20 {
        system.step(scene, Time::frame(1, 60));
    }
    system.hash()
}

#[test]
fn what_stands_for_a_part_of_a_scene_is_one() {
    let place = |x: f32| Particle { position: Vec3::new(x, 0.2, 0.0), radius: 0.05, drag: 0.1, ..Particle::REST };
    let (start, room) = ([0.0, 0.2, 0.5].map(place), Room::new(Vec3::splat(-2.0), Vec3::splat(4.0)));
    let source =
        Emitter { lifetime: Varied::exactly(0.2), ..Emitter::new(Sphere { center: Vec3::Y, radius: 0.1 }, 60.0) };
    let (ground, chance) = (Plane { point: Vec3::ZERO, normal: Vec3::Y }, Chance { rate: 0.5 });
    let (rod, heat) = (Distance::rod([0, 1], 0.2), [Custom { newborn: 2.0, ..Custom::new("heat") }]);
    let springs = [Spring::new([1, 2], 0.25, 10.0)];
    let plain = Scene {
        start: &start,
        springs: &springs,
        emitters: &source,
        forces: &(Gravity::EARTH, Drag {}),
        colliders: &ground,
        reapers: &chance,
        custom: &heat,
        constraints: &(rod, Contacts::HARD),
        integrator: &Rk4,
        index: &Periodic { room, index: Structure::Grid },
        ..Scene::EMPTY
    };
    let index: &dyn IndexChoice = &Structure::Grid;
    let boxed: Box<dyn IndexChoice> = Box::new(Periodic { room, index });
    let forces: (Vec<Box<dyn Force>>, Option<Drag>) = (vec![Box::new(Gravity::EARTH), Box::new(Drag {})], None);
    let constraints: [Option<Box<dyn Constraint>>; 3] = [Some(Box::new(rod)), None, Some(Box::new(Contacts::HARD))];
    let composed = Scene {
        springs: &(Box::new(springs) as Box<dyn SpringList>),
        emitters: &[None, Some(Box::new(&source) as Box<dyn Emit + '_>)],
        forces: &forces,
        colliders: &(Some(Box::new(ground) as Box<dyn Collider>), None::<Plane>),
        reapers: &(None::<Chance>, Some(Box::new(chance) as Box<dyn Reaper>)),
        custom: &(Box::new(heat.to_vec()) as Box<dyn CustomList>),
        materials: &(Box::new(()) as Box<dyn MaterialList>),
        constraints: &constraints,
        integrator: &(Box::new(Rk4) as Box<dyn Integrator>),
        index: &boxed,
        ..plain
    };
    assert_eq!(hash(&composed), hash(&plain));
}

#[test]
fn any_number_of_observers_watch() {
    let source = Emitter::new(Sphere { center: Vec3::Y, radius: 0.1 }, 60.0);
    let scene = Scene { emitters: &source, ..Scene::EMPTY };
    let mut system = started(&scene, 60, 0);
    let (mut first, mut list) = (Registrar::default(), [Registrar::default(), Registrar::default()]);
    let mut others = (None::<Registrar>, &mut list, Some(Registrar::default()));
    let boxed: Box<dyn Observer + '_> = Box::new(&mut first);
    system.step_observed(&scene, Time::frame(1, 2), &mut (boxed, &mut others, ()));
    assert_eq!(others.2.map(|registrar| registrar.0), Some(30));
    assert_eq!([first.0, list[0].0, list[1].0], [30; 3]);
}

#[test]
fn impulses_by_default_are_those_of_meetings() {
    let ball = |x, v| Particle { position: Vec3::X * x, velocity: Vec3::X * v, radius: 0.05, ..Particle::REST };
    let start = [ball(0.0, 1.0), ball(0.2, -1.0)];
    let hashes = [Meetings::Impulse(Impulse::default()), Meetings::IMPULSE, Meetings::Through]
        .map(|meetings| hash(&Scene { start: &start, meetings, ..Scene::EMPTY }));
    assert!(hashes[0] == hashes[1] && hashes[1] != hashes[2]);
}
