//! Memory that holds for all particles what they have in common, and not of each.

use pointmass::emit::{Births, Burst};
use pointmass::force::Uniform;
use pointmass::material::{Curve, Life, Over, Varying};
use pointmass::shape::{Plane, Sphere};
use pointmass::{
    Alike, Chance, Color, Column, Columns, Common, ContactMaterial, Coulomb, Drag, Emit, Emitter, Gravity, Heap,
    Material, Method, MutualGravity, Particle, Scene, Size, Slices, Spread, Spring, Storage, System, Time, Varied,
    Vec3, Wind,
};

/// What all particles of these tests are like.
struct Drop;

impl Common for Drop {
    const PARTICLE: Particle = Particle {
        radius: 0.02,
        mass: 0.3,
        drag: 0.1,
        charge: 1e-6,
        elasticity: 0.4,
        color: Some([10, 20, 30, 40]),
        material: Some(0),
        ..Particle::REST
    };
}

const ROOM: usize = 60;

const PLAIN: Material<'static> = Material::of(ContactMaterial { elasticity: None, friction: None });

/// The columns that may be left out.
const NAMES: [&str; 8] = ["radius", "mass", "inverse_mass", "drag", "charge", "elasticity", "color", "material"];

fn emitter() -> Emitter<Sphere> {
    let like = Drop::PARTICLE;
    Emitter {
        speed: Varied { mean: 3.0, half_width: 0.5 },
        spread: Spread::Uniform(0.5),
        radius: Varied::exactly(like.radius),
        charge: Varied::exactly(like.charge),
        lifetime: Varied { mean: 0.8, half_width: 0.3 },
        color: like.color,
        material: like.material,
        ..Emitter::new(Sphere { center: Vec3::Y, radius: 0.1 }, 60.0).giving_birth_to(&like)
    }
}

/// The hashes on the way through two seconds and a half, in which some are born, hit the ground and die.
fn hashes<B: Storage>(memory: B, scene: &Scene<'_>, frames: u32) -> Vec<u64> {
    let mut system = System::with(memory);
    system.start(scene, 5).expect("it fits");
    let hashes = (1..=frames * 5 / 2)
        .map(|frame| {
            system.step_to(scene, Time::frame(frame.into(), frames));
            system.hash()
        })
        .collect();
    let totals = system.totals();
    assert!(totals.born > 50 && totals.hits > 5 && totals.died.total() > 20, "{totals:?}");
    hashes
}

/// Memory from the heap with those columns left out whose names are told.
struct Without<'m, F: Fn(&str) -> bool>(&'m mut Heap, &'m Constants, F);

struct Constants {
    numbers: [Vec<f32>; 6],
    color: Vec<Color>,
    material: Vec<u16>,
}

impl Constants {
    fn of(particle: &Particle) -> Self {
        let Particle { radius, mass, drag, charge, elasticity, .. } = *particle;
        Self {
            numbers: [radius, mass, 1.0 / mass, drag, charge, elasticity].map(|x| vec![x; ROOM]),
            color: vec![particle.color.expect("it has one"); ROOM],
            material: vec![particle.material.map_or(0, |number| number + 1); ROOM],
        }
    }
}

impl<F: Fn(&str) -> bool> Storage for Without<'_, F> {
    fn slices(&mut self) -> Slices<'_> {
        let (mut slices, Constants { numbers, color, material }) = (self.0.slices(), self.1);
        let Slices { radius, mass, inverse_mass, drag, charge, elasticity, .. } = &mut slices;
        let columns = [radius, mass, inverse_mass, drag, charge, elasticity];
        for ((column, common), name) in columns.into_iter().zip(numbers).zip(NAMES) {
            if (self.2)(name) {
                *column = Column::Common(common);
            }
        }
        if (self.2)("color") {
            slices.color = Column::Common(color);
        }
        if (self.2)("material") {
            slices.material = Column::Common(material);
        }
        slices
    }

    fn columns(&self) -> Columns<'_> {
        let (columns, Constants { numbers, color, material }) = (self.0.columns(), self.1);
        let number = |i: usize, own| if (self.2)(NAMES[i]) { &*numbers[i] } else { own };
        Columns {
            radius: number(0, columns.radius),
            mass: number(1, columns.mass),
            inverse_mass: number(2, columns.inverse_mass),
            drag: number(3, columns.drag),
            charge: number(4, columns.charge),
            elasticity: number(5, columns.elasticity),
            color: if (self.2)("color") { color } else { columns.color },
            material: if (self.2)("material") { material } else { columns.material },
            ..columns
        }
    }
}

/// A scene of drops, with everything that reads what they have.
fn drops<T>(method: &Method, seeing: impl FnOnce(&Scene<'_>) -> T) -> T {
    let start = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|position| Particle { position, ..Drop::PARTICLE });
    let forces = (
        Gravity::EARTH,
        Drag {},
        Wind { field: Uniform { velocity: Vec3::X }, coefficient: None },
        MutualGravity { constant: 0.1, softening: 0.1, ..MutualGravity::NEWTON },
        Coulomb { softening: 0.1, ..Coulomb::VACUUM },
    );
    let colliders = (Plane { point: Vec3::NEG_Y, normal: Vec3::Y }, Sphere { center: Vec3::NEG_Y, radius: 0.5 });
    let (emitter, reaper, materials) = (emitter(), Chance { rate: 0.5 }, [PLAIN]);
    seeing(&Scene {
        start: &start,
        emitters: &emitter,
        forces: &forces,
        colliders: &colliders,
        reapers: &reaper,
        materials: &materials,
        integrator: method,
        ..Scene::EMPTY
    })
}

#[test]
fn what_all_have_in_common_need_not_be_kept_of_each() {
    for (trial, method) in Method::ALL.iter().enumerate() {
        drops(method, |scene| {
            let frames = [24, 60, 144][trial % 3];
            let size = Size { particles: ROOM, ..scene.size_for(ROOM) };
            let expected = hashes(Heap::new(size), scene, frames);
            assert!(size.columns <= 16 && size.kept == 0, "{size:?}");
            assert_eq!(hashes(Alike::<Drop, ROOM, 1, 16>::new(), scene, frames), expected, "{method:?}");
            // One column less, each in turn, and all but one.
            let (constants, left_out) = (Constants::of(&Drop::PARTICLE), NAMES[trial % NAMES.len()]);
            let one = Without(&mut Heap::new(size), &constants, |name: &str| name == left_out);
            assert_eq!(hashes(one, scene, frames), expected, "{method:?} without {left_out}");
            let others = Without(&mut Heap::new(size), &constants, |name: &str| name != left_out);
            assert_eq!(hashes(others, scene, frames), expected, "{method:?} without all but {left_out}");
        });
    }
}

/// Particles that each differ in one thing from what all have, with the name of that.
fn others() -> [(Particle, &'static str); 8] {
    let like = Drop::PARTICLE;
    [
        (Particle { radius: 0.03, ..like }, "radius"),
        (Particle { mass: 0.2, ..like }, "mass"),
        (Particle { fixed: true, ..like }, "inverse_mass"),
        (Particle { drag: 0.0, ..like }, "drag"),
        (Particle { charge: f32::NAN, ..like }, "charge"),
        (Particle { elasticity: 0.5, ..like }, "elasticity"),
        (Particle { color: None, ..like }, "color"),
        (Particle { material: None, ..like }, "material"),
    ]
}

#[test]
fn who_begins_otherwise_is_refused_by_name() {
    for (other, name) in others() {
        let mut system = System::with(Alike::<Drop, 4, 0, 1>::new());
        let start = [Drop::PARTICLE, other];
        let error = system.start(&Scene { start: &start, ..Scene::EMPTY }, 1).expect_err("it differs");
        assert_eq!(error.differs, Some(name));
        assert!(error.to_string().contains(name), "{error}");
        assert!(system.is_empty());
        // One that is put in is refused and counted.
        system.start(&Scene { start: &start[..1], ..Scene::EMPTY }, 1).expect("it fits");
        assert!(system.spawn(&other).is_err() && system.spawn(&Drop::PARTICLE).is_ok());
        assert_eq!((system.len(), system.totals().refused, system.totals().born), (2, 1, 1), "{name}");
    }
}

#[test]
fn emitters_of_others_are_refused_by_name() {
    let e = emitter;
    let varied = |mean: f32| Varied { mean, half_width: 0.1 * mean };
    let like = Drop::PARTICLE;
    let emitters = [
        (Emitter { radius: varied(like.radius), ..e() }, "radius"),
        (Emitter { mass: Varied::exactly(1.0), ..e() }, "mass"),
        (Emitter { fixed: true, ..e() }, "inverse_mass"),
        (Emitter { drag: varied(like.drag), ..e() }, "drag"),
        (Emitter { charge: Varied::exactly(0.0), ..e() }, "charge"),
        (Emitter { elasticity: varied(like.elasticity), ..e() }, "elasticity"),
        (Emitter { color_half_width: [0, 0, 1, 0], ..e() }, "color"),
        (Emitter { material: Some(1), ..e() }, "material"),
    ];
    for (emitter, name) in emitters {
        let error = |emitters: &dyn Emit| {
            let mut system = System::with(Alike::<Drop, 4, 3, 1>::new());
            system.start(&Scene { emitters, ..Scene::EMPTY }, 1).expect_err("it differs").differs
        };
        assert_eq!(error(&emitter), Some(name));
        assert_eq!(error(&[e(), emitter.clone()]), Some(name), "in a list");
        assert_eq!(error(&(e(), &emitter)), Some(name), "in a tuple");
        assert_eq!(error(&vec![emitter]), Some(name), "in a vector");
    }
    let scene = Scene { emitters: &e(), ..Scene::EMPTY };
    assert!(System::with(Alike::<Drop, 4, 3, 1>::new()).start(&scene, 1).is_ok());
}

/// Bears drops and others in turn, and does not tell before.
struct Mixed;

impl Emit for Mixed {
    fn count(&self) -> usize {
        1
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        for (i, at) in births.due(number, 24.0, from, to).enumerate() {
            let (others, other) = (others(), i % 2 == 1);
            let _ = births.give(number, at, |_| if other { others[i / 2 % others.len()].0 } else { Drop::PARTICLE });
        }
    }
}

#[test]
fn who_is_born_otherwise_all_the_same_is_refused_and_counted() {
    let scene = Scene { emitters: &Mixed, ..Scene::EMPTY };
    let mut system = System::with(Alike::<Drop, 40, 1, 1>::new());
    system.start(&scene, 1).expect("it does not tell before");
    let report = system.step(&scene, Time::SECOND);
    assert_eq!((report.born, report.refused, system.len()), (12, 12, 12));
}

/// A scene that was not the one of the start: as many births as there would be are counted at once, and not tried one by one.
#[test]
fn emitters_of_others_are_counted_in_no_time() {
    let drops = emitter();
    let others = Emitter {
        radius: Varied::exactly(1.0),
        rate: 4e9,
        burst: Some(Burst { count: u32::MAX, at: 0.0, every: 1e-3 }),
        ..emitter()
    };
    let mut system = System::with(Alike::<Drop, 40, 2, 1>::new());
    system.start(&Scene { emitters: &drops, ..Scene::EMPTY }, 1).expect("it fits");
    let report = system.step(&Scene { emitters: &others, ..Scene::EMPTY }, Time::SECOND);
    assert_eq!((report.born, report.refused), (0, 4_000_000_000 + 1000 * u64::from(u32::MAX)));
}

#[test]
fn what_changes_over_a_life_needs_a_column_of_its_own() {
    let keys = [[0.0, 1.0], [1.0, 0.0]];
    let drag = Some(Varying { from: Curve { keys: &keys, over: Over::Life, smooth: false }, to: None });
    let materials = [Material { life: Life { drag, ..Life::default() }, ..PLAIN }];
    let start = [Drop::PARTICLE; 2];
    let ageing = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
    let mut system = System::with(Alike::<Drop, 4, 0, 1, 4>::new());
    assert!(ageing.size().kept <= 4);
    let error = system.start(&ageing, 1).expect_err("its drag changes");
    assert!(error.differs.is_some_and(|name| name.contains("drag")), "{error}");
    // Nor does a step change what all have.
    system.start(&Scene { start: &start, ..Scene::EMPTY }, 1).expect("it fits");
    assert_eq!(system.step(&ageing, Time::SECOND).caps.insufficient_memory, 1);

    let springs = [Spring { ends: [0, 1], rest_length: 1.0, ks: 1.0, kd: 0.0, drive: None, breaks_at: None }];
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let zeros = [0; 4];
    let mut heap = Heap::new(Size { particles: 4, ..scene.size_for(4) });
    let mut slices = heap.slices();
    slices.last_spring = Column::Common(&zeros);
    let error = System::with(slices).start(&scene, 1).expect_err("springs are sorted there");
    assert_eq!(error.differs, Some("last_spring"));
}
