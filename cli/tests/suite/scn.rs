//! Every command of `.scn`, and what it means.

use crate::random::Memory;
use pointmass::emit::{Emitter, Spread, Varied};
use pointmass::force::{Drag, ForceKind, Gravity, MutualGravity, Sink, Spring};
use pointmass::motion::MotionBuf;
use pointmass::scene::{Camera, Group, Item, Light, Material, Model, SceneError, SceneFile, read_scn};
use pointmass::shape::{Cone, Cuboid, Cylinder, Disc, Line, Shape, Sphere, Triangle};
use pointmass::{Particle, Vec3};

/// Every command and every shape, with comments wherever there can be one.
pub(crate) const EVERYTHING: &str = "\u{feff}# begins with a comment
camera # eye
  1 2 3  0 0 -1 # up:
  0 1 0  .5 1E-2 +1e3 # and
# ends
ambient 0.1 0.2 0.3
background 1 .5 0 # after the last argument
material 0 0 0  1 0 0  0 0 0  0 0 0  0 0 0  10 1 0
#material 9 9 9
material .1 .1 .1  0 0 0  .2 .2 .2  .3 .3 .3  0 1 0  5 1.5 look/wood.png
dir_light 1 1 1  0 -1 -0
point_light 1 1 0  1 2 3  1 0 0.5
spot_light 0 1 1  1 2 3  0 -1 0  1 0 0  0.5 2
area_light 1 0 1  1 2 3  0 -1 0  0.75  1 0 0
particle_gravity 0 -9.8 0
tri 0  0 0 0  1 0 0  0 1 0
box -1  1 1 1  -1 -1 -1
begin 1
  1 0 0 10
  0 1 0 20 # rows
  0 0 1 30
  0 0 0 1
  sphere -1  0 0 0  1
  begin -1  2 0 0 0  0 2 0 0  0 0 2 0  0 0 0 1
    cylinder -1  0 0 0  1 2
    cone 0  0 0 0  1 2
    particle 1 2 3  4 5 6  7 0 8 .5 9 -1
    particle_source 1 0 0 0.5 0 -1  10 2 0.25  box 0 0 0 1 1 1
  end
  particle 0 0 0  0 0 0  0 1 0 0 -1 0
  mesh -1 meshes/a.off
end
line 1  0 0 0  1 1 1
particle 1e-3 0 0  0 0 0  2 0 0 0 0 -1
particle_spring 2 0  1 100 2
particle_spring 0 1  0 1 0
particle_source 1 0 .1 .2 3 1  4 5 6  sphere 1 2 3 4
particle_source 1 0 0 0 0 -1  0 0 0  cylinder 1 2 3 4 5
particle_source 1 0 0 0 0 -1  0 0 0  cone 1 2 3 4 5
particle_source 0 1 0 0 0 -1  0 0 0  mesh meshes/b.obj
particle_source 1 0 0 0 0 -1  0 0 0  line 1 2 3 4 5 6
particle_source 1 0 0 0 0 -1  0 -1 0  circle 1 2 3  0 -5 0  7
particle_sink 1 2 3 4  box 0 0 0 1 1 1
particle_sink -1 2 3 4  sphere 1 2 3 4
particle_sink 1 2 3 4  cylinder 1 2 3 4 5
particle_sink 1 2 3 4  cone 1 2 3 4 5
particle_sink 1 2 3 4  mesh ../c.stl
particle_sink 1 2 3 4  line 1 2 3 4 5 6
particle_sink 1 2 3 4  circle 1 2 3  1 0 0  7
# no line end after this";

const fn v(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

fn source(
    shape: Shape<String>,
    rate: f32,
    newborn: Particle,
    speed: f32,
    cutoff: f32,
) -> Emitter<Shape<String>, Option<MotionBuf>> {
    let (speed, spread) = (Varied::exactly(speed), Spread::Lecture(cutoff));
    Emitter {
        speed,
        spread,
        material: newborn.material,
        ..Emitter::moving(shape, rate, None).giving_birth_to(&newborn)
    }
}

fn everything() -> SceneFile {
    let shapes = |mesh: &str| {
        vec![
            Shape::Sphere(Sphere { center: v(1.0, 2.0, 3.0), radius: 4.0 }),
            Shape::Cylinder(Cylinder { center: v(1.0, 2.0, 3.0), radius: 4.0, height: 5.0 }),
            Shape::Cone(Cone { center: v(1.0, 2.0, 3.0), radius: 4.0, height: 5.0 }),
            Shape::Mesh(mesh.to_string()),
            Shape::Line(Line { from: v(1.0, 2.0, 3.0), to: v(4.0, 5.0, 6.0) }),
        ]
    };
    let cube = Shape::Box(Cuboid { min: Vec3::ZERO, max: Vec3::ONE });
    let disc = |normal| Shape::Circle(Disc { center: v(1.0, 2.0, 3.0), normal, radius: 7.0 });
    let still = Particle { elasticity: 0.0, ..Particle::REST };
    let mut emitters =
        vec![source(cube.clone(), 10.0, Particle { elasticity: 0.5, material: Some(1), ..still }, 2.0, 0.25)];
    emitters.extend(shapes("meshes/b.obj").into_iter().map(|shape| source(shape, 0.0, still, 0.0, 0.0)));
    let first = Particle { drag: 0.1, elasticity: 0.2, lifetime: 3.0, material: Some(1), ..still };
    emitters[1] = source(emitters[1].shape.clone(), 4.0, first, 5.0, 6.0);
    emitters[4] = source(emitters[4].shape.clone(), 0.0, Particle { mass: 0.0, fixed: true, ..still }, 0.0, 0.0);
    emitters.push(source(disc(v(0.0, -5.0, 0.0)), 0.0, still, -1.0, 0.0));
    let mut sinks: Vec<_> = [vec![cube], shapes("../c.stl"), vec![disc(Vec3::X)]].concat();
    let sinks = sinks.drain(..).map(|shape| Sink {
        shape,
        group: None,
        intensity: 1.0,
        ca: 2.0,
        la: 3.0,
        qa: 4.0,
        softening: 0.0,
    });
    let mut sinks: Vec<_> = sinks.collect();
    sinks[1].intensity = -1.0;
    let (unit, two) = (Sphere { center: Vec3::ZERO, radius: 1.0 }, (Vec3::ZERO, 1.0, 2.0));
    let item = |shape, material, group| Item { shape, material, group, motion: None };
    let matrix = |scale: f32, shift: [f32; 3]| {
        let mut rows = [[0.0; 4]; 4];
        (0..3).for_each(|i| (rows[i][i], rows[i][3]) = (scale, shift[i]));
        rows[3][3] = 1.0;
        rows
    };
    let one = [1.0; 3];
    let (place, down) = ([1.0, 2.0, 3.0], [0.0, -1.0, 0.0]);
    SceneFile {
        particles: vec![
            Particle {
                position: v(1.0, 2.0, 3.0),
                velocity: v(4.0, 5.0, 6.0),
                mass: 7.0,
                drag: 8.0,
                elasticity: 0.5,
                lifetime: 9.0,
                material: Some(1),
                ..still
            },
            Particle { mass: 0.0, fixed: true, lifetime: -1.0, material: Some(0), ..still },
            Particle { position: v(1e-3, 0.0, 0.0), mass: 2.0, ..still },
        ],
        springs: vec![Spring::new([2, 0], 1.0, 100.0).damped(2.0), Spring::new([0, 1], 0.0, 1.0)],
        emitters,
        forces: vec![
            ForceKind::Gravity(Gravity { acceleration: v(0.0, -9.8, 0.0) }),
            ForceKind::Drag(Drag {}),
            ForceKind::MutualGravity(MutualGravity { constant: 6.67428e-11, softening: 0.0, ..MutualGravity::NEWTON }),
        ],
        sinks,
        scenery: vec![
            item(Shape::Triangle(Triangle { corners: [Vec3::ZERO, Vec3::X, Vec3::Y] }), Some(0), None),
            item(Shape::Box(Cuboid { min: Vec3::ONE, max: -Vec3::ONE }), None, None),
            item(Shape::Sphere(unit), None, Some(0)),
            item(Shape::Cylinder(Cylinder { center: two.0, radius: two.1, height: two.2 }), None, Some(1)),
            item(Shape::Cone(Cone { center: two.0, radius: two.1, height: two.2 }), Some(0), Some(1)),
            item(Shape::Mesh("meshes/a.off".into()), None, Some(0)),
            item(Shape::Line(Line { from: Vec3::ZERO, to: Vec3::ONE }), Some(1), None),
        ],
        groups: vec![
            Group { matrix: matrix(1.0, [10.0, 20.0, 30.0]), material: Some(1), parent: None },
            Group { matrix: matrix(2.0, [0.0; 3]), material: None, parent: Some(0) },
        ],
        materials: vec![
            Material {
                ambient: [0.0; 3],
                diffuse: [1.0, 0.0, 0.0],
                specular: [0.0; 3],
                shininess: 10.0,
                ..Material::default()
            },
            Material {
                ambient: [0.1; 3],
                diffuse: [0.0; 3],
                specular: [0.2; 3],
                transmission: [0.3; 3],
                emission: [0.0, 1.0, 0.0],
                shininess: 5.0,
                refraction: 1.5,
                texture: Some("look/wood.png".into()),
                ..Material::default()
            },
        ],
        lights: vec![
            Light::Directional { color: one, direction: down },
            Light::Point { color: [1.0, 1.0, 0.0], position: place, attenuation: [1.0, 0.0, 0.5] },
            Light::Spot {
                color: [0.0, 1.0, 1.0],
                position: place,
                direction: down,
                attenuation: [1.0, 0.0, 0.0],
                cutoff: 0.5,
                dropoff: 2.0,
            },
            Light::Area {
                color: [1.0, 0.0, 1.0],
                position: place,
                direction: down,
                radius: 0.75,
                attenuation: [1.0, 0.0, 0.0],
            },
        ],
        camera: Some(Camera {
            eye: place,
            towards: [0.0, 0.0, -1.0],
            up: [0.0, 1.0, 0.0],
            xfov: 0.5,
            near: 0.01,
            far: 1000.0,
            shutter: None,
        }),
        ambient: [0.1, 0.2, 0.3],
        background: [1.0, 0.5, 0.0],
        ..SceneFile::new()
    }
}

fn memory(texts: &[(&str, &str)]) -> Memory {
    let texts = texts.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect();
    Memory { texts, nothing_else: true }
}

#[test]
fn every_command_means_what_it_says() {
    let read = read_scn("scene.scn", EVERYTHING, &mut Memory::default()).expect("a good scene");
    assert_eq!(read, (everything(), vec![]));
    let windows = EVERYTHING.replace('\n', "\r\n");
    assert_eq!(read_scn("scene.scn", &windows, &mut Memory::default()).expect("a good scene").0, everything());
    let words: Vec<&str> = EVERYTHING.lines().flat_map(|line| line.split('#').next()).collect();
    let one_line = words.join(" \t ");
    assert_eq!(read_scn("scene.scn", &one_line, &mut Memory::default()).expect("a good scene").0, everything());
}

#[test]
fn a_group_moves_scenery_alone_and_hands_its_material_down() {
    let model = Model::load(&everything(), "scene.scn", &mut Memory::default()).expect("a good scene");
    let materials: Vec<_> = model.scenery.iter().map(|solid| solid.material).collect();
    assert_eq!(materials, [Some(0), None, Some(1), Some(1), Some(0), Some(1), Some(1)]);
    let origins: Vec<_> = model.scenery.iter().map(|solid| solid.to_world.shift).collect();
    let group = v(10.0, 20.0, 30.0);
    assert_eq!(origins, [Vec3::ZERO, Vec3::ZERO, group, group, group, group, Vec3::ZERO]);
    assert_eq!(model.scenery[3].to_world.linear.x_axis, Vec3::X * 2.0);
    assert_eq!(model.particles[0].position, v(1.0, 2.0, 3.0), "a particle stays where it is");
    assert_eq!(
        model.emitters[0].shape.with_mesh(|_| Err(())),
        Ok(Shape::Box::<()>(Cuboid { min: Vec3::ZERO, max: Vec3::ONE }))
    );
    assert_eq!(model.colliders.len(), 6, "a line is drawn and never hit");
    // Red by its diffuse colour, green by what it emits, white without a material.
    let colors: Vec<_> = model.particles.iter().map(|particle| particle.color).collect();
    assert_eq!(colors, [Some([0, 255, 0, 255]), Some([255, 0, 0, 255]), None]);
}

#[test]
fn a_texture_that_is_missing_is_warned_of_and_a_mesh_refused() {
    let mut files = memory(&[("meshes/a.off", ""), ("meshes/b.obj", "")]);
    let error = read_scn("scene.scn", EVERYTHING, &mut files).expect_err("a mesh is missing");
    let line = 1 + EVERYTHING.lines().position(|line| line.contains("c.stl")).expect("a line");
    assert_eq!((error.file.as_str(), error.place), ("scene.scn", format!("{line}:1")));
    let mut files = memory(&[("meshes/a.off", ""), ("meshes/b.obj", ""), ("../c.stl", "")]);
    let (scene, warnings) = read_scn("scene.scn", EVERYTHING, &mut files).expect("a good scene");
    assert_eq!(scene, everything());
    assert!(warnings.len() == 1 && warnings[0].contains("look/wood.png"), "{warnings:?}");
    assert!(warnings[0].starts_with("scene.scn:10:1: "), "{warnings:?}");
}

#[test]
fn includes_are_flattened_where_they_stand() {
    let material = |red: u8| format!("material {red} 0 0 {} 1 1 0\n", "0 ".repeat(12));
    let particle = |x: u8| format!("particle {x} 0 0  0 0 0  1 0 0 0 0 -1\n");
    let begin = |material: i8| format!("begin {material}  1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1\n");
    let root = [
        &material(1),
        &material(2),
        &particle(1),
        &begin(1),
        "include sub/one.scn end\n",
        "sphere 1 0 0 0 1 particle_spring 0 1 1 1 1\n",
        &particle(2),
        "include sub/../other.scn",
    ];
    // Its own materials from the first on; until then those around. Its own particles, also for springs.
    let one = [
        "sphere 1 0 0 0 2  sphere -1 0 0 0 3\n",
        &particle(11),
        &material(3),
        "sphere 0 0 0 0 4 mesh -1 m.off mesh -1 ../up.off mesh -1 /abs.off\n",
        &particle(12),
        "particle_spring 1 0 7 7 7 include deep/two.scn",
    ];
    let two =
        ["mesh 0 m.off mesh -1 ../../up.off", "\nparticle_source 1 0 0 0 0 0  1 1 1  mesh m.off\n", "ambient 1 1 1"];
    let texts = [root.concat(), one.concat(), two.concat()];
    let names = ["in/root.scn", "in/sub/one.scn", "in/sub/deep/two.scn"];
    let mut all: Vec<(&str, &str)> = names.into_iter().zip(texts.iter().map(String::as_str)).collect();
    let meshes = ["in/sub/m.off", "in/up.off", "/abs.off", "in/sub/deep/m.off"];
    all.extend(meshes.map(|mesh| (mesh, "")));
    all.push(("in/other.scn", "background 0 0 1"));
    let (scene, warnings) = read_scn("in/root.scn", &texts[0], &mut memory(&all)).expect("a good scene");

    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert!(warnings.iter().any(|warning| warning.starts_with("in/sub/one.scn:6:27: include: ")), "{warnings:?}");
    let reds: Vec<f32> = scene.materials.iter().map(|material| material.ambient[0]).collect();
    assert_eq!(reds, [1.0, 2.0, 3.0]);
    let scenery: Vec<_> = scene.scenery.iter().map(|item| (item.material, item.group)).collect();
    let (inside, outside) = (Some(0), None);
    let expected =
        [(Some(1), inside), (None, inside), (Some(2), inside), (None, inside), (None, inside), (None, inside)];
    assert_eq!(scenery[..6], expected);
    assert_eq!(scenery[6..], [(Some(2), inside), (None, inside), (Some(1), outside)]);
    let meshes: Vec<&str> = scene
        .scenery
        .iter()
        .filter_map(|item| if let Shape::Mesh(name) = &item.shape { Some(name.as_str()) } else { None })
        .collect();
    assert_eq!(meshes, ["sub/m.off", "up.off", "/abs.off", "sub/deep/m.off", "up.off"]);
    assert_eq!(scene.emitters[0].shape, Shape::Mesh("sub/deep/m.off".into()));
    assert_eq!(scene.emitters[0].material, Some(2));
    let places: Vec<f32> = scene.particles.iter().map(|particle| particle.position.x).collect();
    assert_eq!(places, [1.0, 11.0, 12.0, 2.0]);
    assert_eq!(scene.particles[1].material, Some(1), "that of the group around the include");
    let ends: Vec<_> = scene.springs.iter().map(|spring| (spring.ends, spring.ks)).collect();
    assert_eq!(ends, [([2, 1], 7.0), ([0, 3], 1.0)]);
    assert_eq!((scene.ambient, scene.background), ([1.0; 3], [0.0, 0.0, 1.0]));
    let model = Model::load(&scene, "in/root.scn", &mut memory(&all)).expect("a good scene");
    assert_eq!(model.scenery[1].material, Some(1));
    assert_eq!(model.scenery[7].to_world.shift.x, 5.0);
}

#[test]
fn a_scene_in_the_root_folder_finds_its_files() {
    let texts = [("/b.scn", "mesh -1 m.off"), ("/m.off", ""), ("m.off", "")];
    for (path, name) in [("/a.scn", "b.scn"), ("/x/a.scn", "../b.scn"), ("/x/a.scn", "/b.scn")] {
        let (scene, _) = read_scn(path, &format!("include {name}"), &mut memory(&texts)).expect("a good scene");
        assert!(Model::load(&scene, path, &mut memory(&texts)).is_ok(), "{path} {name}");
    }
}

#[test]
fn no_word_is_dropped_where_old_macs_wrote_the_file() {
    // Lines that end with a carriage return alone: either these count as lines, or the reader says what is wrong.
    let text = "# balls\rparticle 0 0 0  0 0 0  1 0 0 0 0 -1\r";
    let read: Result<_, SceneError> = read_scn("scene.scn", text, &mut Memory::default());
    assert!(read.is_err() || read.is_ok_and(|(scene, _)| scene.particles.len() == 1));
}
