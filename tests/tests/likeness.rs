//! Memory on the heap without the columns of what all particles have in common.

use pointmass::emit::Births;
use pointmass::material::{Curve, Life, Over, Varying};
use pointmass::shape::{Plane, Sphere};
use pointmass::{
    ContactMaterial, Coulomb, Drag, Emit, Emitter, Gravity, Heap, Likeness, Material, Meetings, Method, Own, Particle,
    Penalty, Scene, Spread, Spring, Storage, System, Time, Varied, Vec3,
};
use pointmass_tests::started;
use proptest::prelude::*;

const ROOM: usize = 90;

const PLAIN: Material<'static> = Material::of(ContactMaterial { elasticity: None, friction: None });

/// What particles are like, where they are not otherwise.
const LIKE: Particle = Particle {
    radius: 0.02,
    mass: 0.3,
    drag: 0.1,
    charge: 1e-6,
    elasticity: 0.4,
    color: Some([10, 20, 30, 40]),
    material: Some(0),
    ..Particle::REST
};

/// Particles that each differ in one thing from that, with the columns that this calls for.
fn others() -> [(Particle, Own); 8] {
    let none = Own::NONE;
    [
        (Particle { radius: 0.03, ..LIKE }, Own { radius: true, ..none }),
        (Particle { mass: 0.2, ..LIKE }, Own { mass: true, inverse_mass: true, ..none }),
        (Particle { fixed: true, ..LIKE }, Own { inverse_mass: true, ..none }),
        (Particle { drag: 0.05, ..LIKE }, Own { drag: true, ..none }),
        (Particle { charge: -1e-6, ..LIKE }, Own { charge: true, ..none }),
        (Particle { elasticity: 0.5, ..LIKE }, Own { elasticity: true, ..none }),
        (Particle { color: None, ..LIKE }, Own { color: true, ..none }),
        (Particle { material: None, ..LIKE }, Own { material: true, ..none }),
    ]
}

fn names(own: Own) -> [(bool, &'static str); 9] {
    let Own { radius, mass, inverse_mass, drag, charge, elasticity, color, material, last_spring } = own;
    [
        (radius, "radius"),
        (mass, "mass"),
        (inverse_mass, "inverse_mass"),
        (drag, "drag"),
        (charge, "charge"),
        (elasticity, "elasticity"),
        (color, "color"),
        (material, "material"),
        (last_spring, "last_spring"),
    ]
}

fn emitter(like: &Particle) -> Emitter<Sphere> {
    Emitter {
        speed: Varied { mean: 3.0, half_width: 0.5 },
        spread: Spread::Uniform(0.5),
        radius: Varied::exactly(like.radius),
        charge: Varied::exactly(like.charge),
        lifetime: Varied { mean: 0.8, half_width: 0.3 },
        color: like.color,
        material: like.material,
        ..Emitter::new(Sphere { center: Vec3::Y, radius: 0.1 }, 60.0).giving_birth_to(like)
    }
}

fn lean(scene: &Scene<'_>, capacity: usize) -> System<Heap> {
    let memory = Heap::alike(scene.size_for(capacity), &scene.likeness()).expect("a little memory");
    let mut system = System::with(memory);
    system.start(scene, 1).expect("the memory is made for the scene");
    system
}

/// Steps systems in both kinds of memory side by side, in the middle one from a copy: whatever they are asked, they say the same.
fn agree(scene: &Scene<'_>, frames: u32) {
    let (mut full, mut lean) = (started(scene, ROOM, 1), lean(scene, ROOM));
    for frame in 0..frames * 2 {
        if frame == frames {
            lean = lean.clone();
        }
        let end = Time::frame((frame + 1).into(), frames);
        assert_eq!(lean.step_to(scene, end), full.step_to(scene, end), "frame {frame}");
        assert_eq!(lean.hash(), full.hash(), "frame {frame}");
        let (ours, theirs) = (lean.particles(), full.particles());
        for (ours, theirs) in [
            (ours.radius, theirs.radius),
            (ours.mass, theirs.mass),
            (ours.inverse_mass, theirs.inverse_mass),
            (ours.drag, theirs.drag),
            (ours.charge, theirs.charge),
            (ours.elasticity, theirs.elasticity),
        ] {
            assert_eq!(ours.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), bits(theirs));
        }
        assert_eq!((ours.color, ours.material), (theirs.color, theirs.material));
        assert_eq!(lean.state(scene).charge, full.state(scene).charge);
    }
    assert!(full.totals().born > 80 && full.totals().died.total() > 20, "{:?}", full.totals());
}

fn bits(numbers: &[f32]) -> Vec<u32> {
    numbers.iter().map(|x| x.to_bits()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 8 } else { 48 }))]

    /// Of what a scene begins with and bears, some are otherwise in some things; some vary; springs and materials that change masses come and go.
    #[test]
    fn memory_made_for_a_scene_gives_the_same_bits(
        differ in prop::collection::vec(0..8_usize, 0..3),
        vary in prop::array::uniform4(prop::bool::weighted(0.3)),
        [is_tied, ages, is_swept] in prop::array::uniform3(any::<bool>()),
        (method, frames) in (0..Method::ALL.len(), 24..144_u32),
    ) {
        let mut start: Vec<_> = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|position| Particle { position, ..LIKE }).into();
        let mut own = Own::NONE;
        for &number in &differ {
            let (other, needs) = others()[number];
            start.push(Particle { position: Vec3::splat(start.len() as f32), ..other });
            own = either(own, needs);
        }
        let mut source = emitter(&LIKE);
        for (is_varied, (attribute, needs)) in vary.into_iter().zip([
            (&mut source.radius, Own { radius: true, ..Own::NONE }),
            (&mut source.mass, Own { mass: true, inverse_mass: true, ..Own::NONE }),
            (&mut source.drag, Own { drag: true, ..Own::NONE }),
            (&mut source.elasticity, Own { elasticity: true, ..Own::NONE }),
        ]) {
            if is_varied {
                attribute.half_width = 0.1 * attribute.mean;
                own = either(own, needs);
            }
        }
        let springs = [Spring { ends: [0, 1], rest_length: 1.1, ks: 1.0, kd: 0.1, drive: None, breaks_at: None }];
        let springs = &springs[..usize::from(is_tied)];
        own.last_spring = is_tied;
        let keys = [[0.0, 1.0], [1.0, 0.5]];
        let mass = Some(Varying { from: Curve { keys: &keys, over: Over::Life, smooth: false }, to: None });
        let changing = Material { life: Life { mass, ..Life::default() }, ..PLAIN };
        let materials = [if ages { changing } else { PLAIN }];
        if ages {
            own = either(own, Own { drag: true, mass: true, inverse_mass: true, ..Own::NONE });
        }
        let penalty = Penalty { stiffness: 10.0, damping: 0.1, reach: 0.06, ..Penalty::NONE };
        let forces = (Gravity::EARTH, Drag {}, Coulomb { softening: 0.1, ..Coulomb::VACUUM }, penalty);
        let ground = Plane { point: Vec3::NEG_Y, normal: Vec3::Y };
        let scene = Scene {
            start: &start,
            springs: &springs,
            emitters: &source,
            forces: &forces,
            colliders: &ground,
            materials: &materials,
            meetings: if is_swept { Meetings::IMPULSE } else { Meetings::Through },
            integrator: &Method::ALL[method],
            ..Scene::EMPTY
        };
        prop_assert_eq!(scene.likeness().own, own);
        agree(&scene, frames);
    }
}

fn either(a: Own, b: Own) -> Own {
    Own {
        radius: a.radius || b.radius,
        mass: a.mass || b.mass,
        inverse_mass: a.inverse_mass || b.inverse_mass,
        drag: a.drag || b.drag,
        charge: a.charge || b.charge,
        elasticity: a.elasticity || b.elasticity,
        color: a.color || b.color,
        material: a.material || b.material,
        last_spring: a.last_spring || b.last_spring,
    }
}

#[test]
fn what_a_scene_needs_besides_is_refused_by_name() {
    let tied = [Spring { ends: [0, 1], rest_length: 1.0, ks: 1.0, kd: 0.0, drive: None, breaks_at: None }];
    for (other, needs) in others() {
        let (start, mut likeness) = ([LIKE, other], Likeness::of(LIKE));
        let scene = Scene { start: &start, ..Scene::EMPTY };
        let name = names(needs).iter().find_map(|&(is_own, name)| is_own.then_some(name));
        let refused = System::with(Heap::alike(scene.size(), &likeness).expect("memory")).start(&scene, 1);
        assert_eq!(refused.expect_err("it has no such column").differs, name);
        likeness.add(&other);
        assert_eq!((likeness.own, scene.likeness()), (needs, likeness));
        let mut system = System::with(Heap::alike(scene.size_for(10), &likeness).expect("memory"));
        system.start(&scene, 1).expect("it has what the scene needs");
        // All else is refused and counted.
        for (third, more) in others() {
            let refused = system.totals().refused;
            assert_eq!(system.spawn(&third).is_ok(), either(needs, more) == needs, "{third:?} beside {other:?}");
            assert_eq!(system.totals().refused > refused, either(needs, more) != needs);
        }
        let scene = Scene { springs: &tied, ..scene };
        let refused = System::with(Heap::alike(scene.size(), &likeness).expect("memory")).start(&scene, 1);
        assert_eq!(refused.expect_err("springs are sorted there").differs, Some("last_spring"));
    }
}

#[test]
fn zeros_of_both_signs_are_not_alike_and_what_is_no_number_is_like_nothing() {
    for drag in [-0.0, f32::NAN] {
        let start = [Particle { drag: 0.0, ..LIKE }, Particle { drag, ..LIKE }, Particle { drag, ..LIKE }];
        for start in [&start[..], &start[1..]] {
            let source = emitter(&Particle { drag, ..LIKE });
            let scene = Scene { start, emitters: &source, ..Scene::EMPTY };
            assert_eq!(scene.likeness().own.drag, start.len() == 3 || drag.is_nan());
            let (mut full, mut lean) = (started(&scene, ROOM, 1), lean(&scene, ROOM));
            for frame in 1..30 {
                let end = Time::frame(frame, 60);
                assert_eq!(lean.step_to(&scene, end), full.step_to(&scene, end));
                assert_eq!(lean.hash(), full.hash());
            }
            assert_eq!(full.totals().died.nonfinite > 20, drag.is_nan());
        }
    }
}

/// Bears what it does not tell of.
struct Silent;

impl Emit for Silent {
    fn count(&self) -> usize {
        1
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        let number = births.claim();
        for (i, at) in births.due(number, 24.0, from, to).enumerate() {
            let _ = births.give(number, at, |_| others()[i % 8].0);
        }
    }
}

#[test]
fn of_what_an_emitter_does_not_tell_nothing_is_taken_for_granted() {
    let told = emitter(&LIKE);
    let own = |emitters: &dyn Emit| Scene { emitters, ..Scene::EMPTY }.likeness().own;
    assert_eq!(own(&Silent), Own::ALL);
    assert_eq!([own(&(&told, Silent)), own(&(Silent, &told)), own(&[Silent, Silent])], [Own::ALL; 3]);
    assert_eq!([own(&()), own(&told), own(&vec![told.clone(), told.clone()]), own(&[&told; 2])], [Own::NONE; 4]);
    let scene = Scene { emitters: &(&told, Silent), ..Scene::EMPTY };
    assert_eq!(lean(&scene, ROOM).step(&scene, Time::SECOND).refused, 0);
}

#[test]
fn nobody_needs_no_column_of_its_own() {
    let memory = Heap::alike(Scene::EMPTY.size_for(3), &Scene::EMPTY.likeness()).expect("a little memory");
    assert_eq!(memory.columns().elasticity, [Particle::REST.elasticity; 3]);
    assert_eq!((memory.columns().last_spring, memory.columns().material), (&[0; 3][..], &[0; 3][..]));
    let none = Heap::alike(Scene::EMPTY.size_for(0), &Scene::EMPTY.likeness()).expect("no memory");
    let mut system = System::with(none);
    assert!(system.start(&Scene::EMPTY, 1).is_ok() && system.spawn(&Particle::REST).is_err());
}
