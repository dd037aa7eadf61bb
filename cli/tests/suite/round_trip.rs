//! What is written is read back: `.scn` and JSON, whatever the scene says.

use crate::random::{Memory, any_scene, scene};
use crate::tool::tries;
use pointmass::force::{Drag, ForceKind, Gravity, MutualGravity};
use pointmass::scene::{Group, Item, Light, Material, Model, SceneFile, read_scn, write_scn};
use pointmass::shape::{Shape, Sphere};
use pointmass::{Heap, Particle, System, Time, Vec3};
use proptest::prelude::*;

/// The hash after a few steps with room for a few particles.
pub(crate) fn hash(scene: &SceneFile) -> u64 {
    let model = Model::load(scene, "scene", &mut Memory::default()).expect("the scene can be used");
    let mut system = System::with(Heap::new(model.size(12)));
    system.start(&model.scene(), 1).expect("the memory is made for the scene");
    for _ in 0..4 {
        system.step(&model.scene(), Time::frame(1, 60));
    }
    system.hash()
}

fn read(text: &str) -> (SceneFile, Vec<String>) {
    read_scn("scene.scn", text, &mut Memory::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The scene with forces as every `.scn` has them.
fn with_forces(scene: SceneFile) -> SceneFile {
    let forces = vec![ForceKind::Drag(Drag {}), ForceKind::MutualGravity(MutualGravity::NEWTON)];
    SceneFile { forces, ..scene }
}

proptest! {
    #![proptest_config(tries(1000))]

    #[test]
    fn json_says_everything(scene in any_scene()) {
        let text = scene.to_json();
        prop_assert_eq!(SceneFile::from_json("scene.json", &text), Ok(scene));
    }

    #[test]
    fn both_formats_say_the_same(scene in scene()) {
        let (text, warnings) = write_scn(&scene);
        prop_assert_eq!(warnings, Vec::<String>::new(), "{}", text);
        let (back, warnings) = read(&text);
        prop_assert_eq!(warnings, Vec::<String>::new());
        prop_assert_eq!(&back, &scene, "{}", text);
        let json = back.to_json();
        let again = SceneFile::from_json("scene.json", &json);
        prop_assert_eq!(again, Ok(scene.clone()));
        prop_assert_eq!(&write_scn(&back).0, &text);
        if scene.check().is_ok() && Model::load(&scene, "", &mut Memory::default()).is_ok() {
            prop_assert_eq!(hash(&back), hash(&scene), "{}", text);
        }
    }

    #[test]
    fn what_is_written_can_be_read_and_is_the_same_unless_warned_of(scene in any_scene()) {
        prop_assume!(scene.check().is_ok() && Model::load(&scene, "", &mut Memory::default()).is_ok());
        let (text, warnings) = write_scn(&scene);
        let (back, others) = read(&text);
        prop_assert_eq!(others, Vec::<String>::new());
        prop_assert!(warnings.iter().all(|warning| !warning.contains('\n')), "{:?}", warnings);
        let telling = |warning: &&String| !warning.starts_with("about") && !warning.starts_with("run");
        if warnings.iter().filter(telling).count() == 0 {
            let rerun = SceneFile { run: scene.run.clone(), ..back };
            prop_assert_eq!(hash(&rerun), hash(&scene), "{}", text);
        }
    }
}

#[test]
fn gravity_of_zero_is_not_lost() {
    let (scene, _) = read("particle_gravity 0 0 0");
    assert_eq!(scene.forces.len(), 3);
    assert_eq!(read(&write_scn(&scene).0).0, scene);
}

#[test]
fn groups_of_nothing_are_not_lost() {
    let group = "begin -1  1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
    let (scene, _) = read(&format!("{group} {group} end end  {group} sphere -1 0 0 0 1 end"));
    assert_eq!(scene.groups.len(), 3);
    assert_eq!(read(&write_scn(&scene).0).0, scene);
}

#[test]
fn a_group_entered_twice_keeps_its_meaning() {
    let shape = |x| Shape::Sphere(Sphere { center: Vec3::X * x, radius: 1.0 });
    let item = |x, group| Item { shape: shape(x), material: None, group, motion: None };
    let mut matrix = [[0.0; 4]; 4];
    (0..4).for_each(|i| matrix[i][i] = 1.0);
    matrix[0][3] = 0.25;
    let group = Group { matrix, material: None, parent: None };
    let scenery = vec![item(1.0, Some(0)), item(2.0, None), item(3.0, Some(0)), item(4.0, Some(1))];
    let falling = Particle { position: Vec3::new(1.3, 1.05, 0.0), velocity: -Vec3::Y * 9.0, ..Particle::REST };
    let scene = with_forces(SceneFile {
        scenery,
        groups: vec![group.clone(), Group { parent: Some(0), ..group }],
        particles: vec![falling],
        ..SceneFile::new()
    });
    let (text, warnings) = write_scn(&scene);
    assert_eq!((hash(&read(&text).0), warnings.len()), (hash(&scene), 0));
}

#[test]
fn forces_that_scn_adds_up_in_another_way_are_warned_of() {
    let pull = |x| ForceKind::Gravity(Gravity { acceleration: Vec3::new(x, -9.8, 0.1) });
    let [drag, newton] = [ForceKind::Drag(Drag {}), ForceKind::MutualGravity(MutualGravity::NEWTON)];
    let one = Particle { mass: 1e10, drag: 1e9, velocity: Vec3::new(0.3, 0.7, 0.1), ..Particle::REST };
    let other = Particle { mass: 1.7e9, drag: 3e8, position: Vec3::new(1.0, 0.3, 0.2), ..one };
    for forces in [
        vec![newton.clone(), drag.clone(), pull(0.3)],
        vec![drag.clone(), pull(0.3), newton.clone()],
        vec![pull(0.3), pull(0.1), drag.clone(), newton.clone()],
    ] {
        let scene = SceneFile { forces, particles: vec![one, other], ..SceneFile::new() };
        let (text, warnings) = write_scn(&scene);
        // Sums round differently in another order: the same digits, or a word about it.
        assert!(!warnings.is_empty() || hash(&read(&text).0) == hash(&scene), "{:?}", scene.forces);
    }
}

/// What JSON can say and `.scn` cannot has to be left out with a warning; it must not spoil the file.
#[track_caller]
fn is_readable_and_warned_of(scene: SceneFile) {
    let scene = with_forces(scene);
    assert_eq!(scene.check(), Ok(()));
    let (text, warnings) = write_scn(&scene);
    let read = read_scn("scene.scn", &text, &mut Memory::default());
    let begin: String = text.chars().take(300).collect();
    assert!(read.is_ok(), "{read:?}\n{begin}");
    assert!(!warnings.is_empty(), "no warning for\n{begin}");
}

#[test]
fn names_of_meshes_that_scn_cannot_say() {
    for name in ["", "#1.off", "a b.off", "a\nb.off", "a\u{2003}b.off"] {
        let scenery = vec![Item { shape: Shape::Mesh(name.into()), material: None, group: None, motion: None }];
        is_readable_and_warned_of(SceneFile { scenery, ..SceneFile::new() });
    }
}

#[test]
fn names_of_textures_that_scn_cannot_say() {
    for name in ["", "0", "#1.png", "a b.png"] {
        let material = Material { texture: Some(name.into()), ..Material::default() };
        is_readable_and_warned_of(SceneFile { materials: vec![material], ..SceneFile::new() });
    }
}

#[test]
fn lights_that_scn_cannot_say() {
    let one = [1.0; 3];
    let light = Light::Area { color: one, position: one, direction: one, radius: -1.0, attenuation: one };
    let scene = with_forces(SceneFile { lights: vec![light], ..SceneFile::new() });
    // Either JSON refuses it too, or there is a warning.
    if scene.check().is_ok() {
        is_readable_and_warned_of(scene);
    }
}

#[test]
fn groups_deeper_than_scn_has_them() {
    let mut matrix = [[0.0; 4]; 4];
    (0..4).for_each(|i| matrix[i][i] = 1.0);
    let group = |i: u32| Group { matrix, material: None, parent: i.checked_sub(1) };
    let shape = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
    let scenery = vec![Item { shape, material: None, group: Some(1024), motion: None }];
    let scene = SceneFile { groups: (0..=1024).map(group).collect(), scenery, ..SceneFile::new() };
    if scene.check().is_ok() {
        is_readable_and_warned_of(scene);
    }
}

#[test]
fn gravities_whose_sum_is_no_number() {
    let gravity = ForceKind::Gravity(Gravity { acceleration: Vec3::Y * 3e38 });
    let others = with_forces(SceneFile::new()).forces;
    let scene = SceneFile { forces: [vec![gravity.clone(), gravity], others].concat(), ..SceneFile::new() };
    if scene.check().is_ok() {
        let (text, warnings) = write_scn(&scene);
        assert!(read_scn("scene.scn", &text, &mut Memory::default()).is_ok(), "{text}");
        assert!(!warnings.is_empty());
    }
}
