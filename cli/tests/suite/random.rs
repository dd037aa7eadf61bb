//! Random declared scenes: those that both formats can say, and those that only JSON can.

use pointmass::emit::{Burst, Emitter, Spread, Varied};
use pointmass::force::{Drag, ForceKind, Gravity, MutualGravity, Sink, Spring};
use pointmass::index::Structure;
use pointmass::motion::MotionBuf;
use pointmass::rays;
use pointmass::scene::{Camera, Files, Group, Item, Light, Material, Run, SceneFile};
use pointmass::shape::{Cone, Cuboid, Cylinder, Disc, Line, MeshBuf, Plane, Shape, Sphere, Triangle};
use pointmass::{Chance, CustomBuf, Method, Particle, ReaperKind, Tuning, Vec3};
use proptest::array::{uniform3, uniform4};
use proptest::collection::vec;
use proptest::num::f32 as kinds;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::select;
use std::collections::BTreeMap;

/// Files in memory; what is not there has the content of a small mesh, or of an empty scene.
#[derive(Default)]
pub(crate) struct Memory {
    /// Texts by path.
    pub(crate) texts: BTreeMap<String, String>,
    /// Whether there is nothing else.
    pub(crate) nothing_else: bool,
}

impl Files for Memory {
    fn text(&mut self, path: &str) -> Result<String, String> {
        match self.texts.get(path) {
            Some(text) => Ok(text.clone()),
            None if self.nothing_else => Err(format!("{path}: is not there")),
            None => Ok(String::new()),
        }
    }

    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        assert!(self.exists(path), "{path}");
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].to_vec();
        MeshBuf::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).map_err(|error| error.to_string())
    }

    fn exists(&mut self, path: &str) -> bool {
        !self.nothing_else || self.texts.contains_key(path)
    }
}

/// Any finite number; most are of everyday size.
pub(crate) fn number() -> BoxedStrategy<f32> {
    let odd = [0.0, -0.0, 1.0, -1.0, f32::MAX, f32::MIN, f32::MIN_POSITIVE, 1e-45, 0.1, 16_777_216.0, 1e7, 1e-4];
    prop_oneof![
        8 => -100.0f32..100.0,
        1 => kinds::POSITIVE | kinds::NEGATIVE | kinds::NORMAL | kinds::SUBNORMAL | kinds::ZERO,
        1 => select(odd.to_vec()),
    ]
    .boxed()
}

fn positive() -> impl Strategy<Value = f32> {
    number().prop_map(f32::abs)
}

fn point() -> impl Strategy<Value = Vec3> {
    uniform3(number()).prop_map(Vec3::from)
}

/// A vector that has a direction, and seldom unit length.
fn direction() -> impl Strategy<Value = Vec3> {
    (uniform3(-9.0f32..9.0), 0.5f32..2.0).prop_map(|(v, x)| Vec3::from(v) + Vec3::X * 10.0 * x)
}

fn color() -> impl Strategy<Value = [f32; 3]> {
    prop_oneof![uniform3(0.0f32..=1.0), uniform3(positive()), Just([0.0; 3])]
}

/// A file's name without blanks.
fn name(extension: &'static str) -> impl Strategy<Value = String> {
    let folder = select(vec!["", "../", "meshes/", "./a/../b/", "/abs/"]);
    (folder, "[a-zA-Z0-9äß_.+-]{0,8}").prop_map(move |(folder, stem)| format!("{folder}m{stem}.{extension}"))
}

/// A shape that `.scn` knows for sources, sinks and scenery alike.
fn common_shape() -> BoxedStrategy<Shape<String>> {
    prop_oneof![
        (point(), point()).prop_map(|(from, to)| Shape::Line(Line { from, to })),
        (point(), point()).prop_map(|(min, max)| Shape::Box(Cuboid { min, max })),
        (point(), positive()).prop_map(|(center, radius)| Shape::Sphere(Sphere { center, radius })),
        (point(), positive(), positive()).prop_map(|(center, radius, height)| Shape::Cylinder(Cylinder {
            center,
            radius,
            height
        })),
        (point(), positive(), positive()).prop_map(|(center, radius, height)| Shape::Cone(Cone {
            center,
            radius,
            height
        })),
        name("off").prop_map(Shape::Mesh),
    ]
    .boxed()
}

fn circle() -> impl Strategy<Value = Shape<String>> {
    (point(), direction(), positive())
        .prop_map(|(center, normal, radius)| Shape::Circle(Disc { center, normal, radius }))
}

fn triangle() -> impl Strategy<Value = Shape<String>> {
    uniform3(point()).prop_map(|corners| Shape::Triangle(Triangle { corners }))
}

fn plane() -> impl Strategy<Value = Shape<String>> {
    (point(), direction()).prop_map(|(point, normal)| Shape::Plane(Plane { point, normal }))
}

/// A particle without a material.
fn particle() -> impl Strategy<Value = Particle> {
    let mass = prop_oneof![4 => 1e-3f32..1e3, 1 => kinds::POSITIVE | kinds::NORMAL, 1 => Just(0.0)];
    (point(), point(), mass, any::<bool>(), uniform3(number())).prop_map(|(position, velocity, mass, fixed, rest)| {
        let [drag, elasticity, lifetime] = rest;
        Particle {
            position,
            velocity,
            mass,
            fixed: fixed || mass < 1e-37,
            drag,
            elasticity,
            lifetime,
            ..Particle::REST
        }
    })
}

/// A number of something, to be cut down to how many there are.
fn reference() -> impl Strategy<Value = Option<u16>> {
    option::of(any::<u16>())
}

fn within(reference: Option<u16>, count: usize) -> Option<u16> {
    Some((usize::from(reference?)).checked_rem(count)? as u16)
}

fn material() -> impl Strategy<Value = Material> {
    let colors = (color(), color(), color(), color(), color());
    (colors, number(), number(), option::of(name("png"))).prop_map(|(colors, shininess, refraction, texture)| {
        let (ambient, diffuse, specular, transmission, emission) = colors;
        Material {
            ambient,
            diffuse,
            specular,
            transmission,
            emission,
            shininess,
            refraction,
            texture,
            ..Material::default()
        }
    })
}

fn light() -> impl Strategy<Value = Light> {
    let v = || uniform3(number());
    prop_oneof![
        (color(), v()).prop_map(|(color, direction)| Light::Directional { color, direction }),
        (color(), v(), v()).prop_map(|(color, position, attenuation)| Light::Point { color, position, attenuation }),
        (color(), v(), v(), v(), number(), number()).prop_map(
            |(color, position, direction, attenuation, cutoff, dropoff)| {
                Light::Spot { color, position, direction, attenuation, cutoff, dropoff }
            }
        ),
        (color(), v(), v(), positive(), v()).prop_map(|(color, position, direction, radius, attenuation)| {
            Light::Area { color, position, direction, radius, attenuation }
        }),
    ]
}

fn camera() -> impl Strategy<Value = Camera> {
    let way = || uniform3(-1.0f32..1.0).prop_map(|[x, y, z]| [x, y + 1.5, z]);
    let depths = (0.0f32..100.0, 0.1f32..1e6);
    (uniform3(number()), way(), way(), 0.01f32..1.5, depths).prop_map(|(eye, towards, up, xfov, (near, reach))| {
        Camera { eye, towards, up, xfov, near, far: near + reach, ..Camera::default() }
    })
}

/// A matrix that can be undone.
fn matrix() -> impl Strategy<Value = [[f32; 4]; 4]> {
    (uniform3(uniform3(-1.0f32..1.0)), uniform3(-100.0f32..100.0), 0.01f32..100.0).prop_map(|(skew, shift, scale)| {
        let mut rows = [[0.0; 4]; 4];
        for i in 0..3 {
            for j in 0..3 {
                rows[i][j] = scale * (skew[i][j] + if i == j { 3.0 } else { 0.0 });
            }
            rows[i][3] = shift[i];
        }
        rows[3][3] = 1.0;
        rows
    })
}

/// Scenery as `.scn` nests it.
#[derive(Clone, Debug)]
enum Node {
    Item(Shape<String>, Option<u16>),
    Group([[f32; 4]; 4], Option<u16>, Vec<Node>),
}

fn node() -> impl Strategy<Value = Node> {
    let shape = prop_oneof![6 => common_shape(), 1 => triangle()];
    let item = (shape, reference()).prop_map(|(shape, material)| Node::Item(shape, material));
    item.prop_recursive(5, 20, 4, |inner| {
        (matrix(), reference(), vec(inner, 1..4))
            .prop_map(|(matrix, material, nodes)| Node::Group(matrix, material, nodes))
    })
}

fn place(nodes: Vec<Node>, parent: Option<u32>, scene: &mut SceneFile) {
    let count = scene.materials.len();
    for node in nodes {
        match node {
            Node::Item(shape, material) => {
                scene.scenery.push(Item { shape, material: within(material, count), group: parent, motion: None });
            }
            Node::Group(matrix, material, nodes) => {
                let number = scene.groups.len() as u32;
                scene.groups.push(Group { matrix, material: within(material, count), parent });
                place(nodes, Some(number), scene);
            }
        }
    }
}

type Source = (Shape<String>, f32, Particle, Option<u16>, f32, f32);

fn source() -> impl Strategy<Value = Source> {
    let shape = prop_oneof![6 => common_shape(), 1 => circle()];
    (shape, positive(), particle(), reference(), number(), number())
}

fn emitter(
    (shape, rate, newborn, material, speed, cutoff): Source,
    materials: usize,
) -> Emitter<Shape<String>, Option<MotionBuf>> {
    Emitter {
        speed: Varied::exactly(speed),
        spread: Spread::Lecture(cutoff),
        material: within(material, materials),
        ..Emitter::moving(shape, rate, None).giving_birth_to(&newborn)
    }
}

fn sink() -> impl Strategy<Value = Sink<String>> {
    let shape = prop_oneof![6 => common_shape(), 1 => circle()];
    (shape, uniform4(number())).prop_map(|(shape, [intensity, ca, la, qa])| Sink {
        shape,
        group: None,
        intensity,
        ca,
        la,
        qa,
        softening: 0.0,
    })
}

fn springs() -> impl Strategy<Value = Vec<([u16; 2], [f32; 3])>> {
    vec(([any::<u16>(), any::<u16>()], uniform3(number())), 0..4)
}

/// A scene that both formats can say. (That no gravity and gravity of zero, and groups of nothing, come back alike has
/// tests of its own.)
pub(crate) fn scene() -> impl Strategy<Value = SceneFile> {
    let look = (vec(material(), 0..4), option::of(camera()), color(), color(), vec(light(), 0..3));
    let world = (vec(node(), 0..4), option::of(direction()), vec((particle(), reference()), 0..5), springs());
    (look, world, vec(source(), 0..3), vec(sink(), 0..3)).prop_map(|(look, world, sources, sinks)| {
        let ((materials, camera, ambient, background, lights), (nodes, gravity, particles, springs)) = (look, world);
        let count = materials.len();
        let mut scene = SceneFile { materials, camera, ambient, background, lights, sinks, ..SceneFile::new() };
        place(nodes, None, &mut scene);
        let particle = |(p, material)| Particle { material: within(material, count), ..p };
        scene.particles = particles.into_iter().map(particle).collect();
        let number = |end: u16| u32::from(end).checked_rem(scene.particles.len() as u32);
        let spring = |(ends, [rest_length, ks, kd]): ([u16; 2], [f32; 3])| {
            let ends = [number(ends[0])?, number(ends[1])?];
            Some(Spring::new(ends, rest_length, ks).damped(kd))
        };
        scene.springs = springs.into_iter().filter_map(spring).collect();
        scene.emitters = sources.into_iter().map(|source| emitter(source, count)).collect();
        let gravity = gravity.map(|acceleration| ForceKind::Gravity(Gravity { acceleration }));
        let always = [ForceKind::Drag(Drag {}), ForceKind::MutualGravity(MutualGravity::NEWTON)];
        scene.forces = gravity.into_iter().chain(always).collect();
        scene
    })
}

fn varied(mean: impl Strategy<Value = f32>) -> impl Strategy<Value = Varied> {
    (mean, prop_oneof![Just(0.0f32), 0.0f32..0.5]).prop_map(|(mean, half_width)| Varied { mean, half_width })
}

fn force() -> impl Strategy<Value = ForceKind> {
    let everyday = || -100.0f32..100.0;
    prop_oneof![
        uniform3(everyday()).prop_map(|a| ForceKind::Gravity(Gravity { acceleration: a.into() })),
        Just(ForceKind::Drag(Drag {})),
        Just(ForceKind::MutualGravity(MutualGravity::NEWTON)),
        (number(), number()).prop_map(|(constant, softening)| {
            ForceKind::MutualGravity(MutualGravity { constant, softening, ..MutualGravity::NEWTON })
        }),
    ]
}

fn any_emitter() -> impl Strategy<Value = Emitter<Shape<String>, Option<MotionBuf>>> {
    let shape = prop_oneof![6 => common_shape(), 1 => circle(), 1 => triangle()];
    let spread = prop_oneof![number().prop_map(Spread::Uniform), number().prop_map(Spread::Lecture)];
    let burst = (0..1000u32, number(), prop_oneof![Just(0.0), 1e-9f32..1.0]);
    let burst = burst.prop_map(|(count, at, every)| Burst { count, at, every });
    let when = (option::of(burst), number(), option::of(number()));
    let motion = (varied(number()), option::of(direction()), spread, point(), number());
    let rest = (varied(1.0f32..9.0), any::<bool>(), varied(number()), varied(number()), varied(number()));
    let look = (option::of(any::<[u8; 4]>()), any::<[u8; 4]>());
    (shape, positive(), when, motion, rest, look).prop_map(|(shape, rate, when, motion, rest, look)| {
        let ((burst, start, stop), (speed, direction, spread, velocity, inherit)) = (when, motion);
        let ((mass, fixed, drag, elasticity, lifetime), (color, color_half_width)) = (rest, look);
        Emitter {
            burst,
            start,
            stop,
            speed,
            direction,
            spread,
            velocity,
            inherit,
            mass,
            fixed,
            drag,
            elasticity,
            lifetime,
            color,
            color_half_width,
            ..Emitter::moving(shape, rate, None)
        }
    })
}

fn run() -> impl Strategy<Value = Run> {
    let method = select(Method::ALL.to_vec());
    let indices = (select(Structure::ALL.to_vec()), select(rays::Structure::ALL.to_vec()));
    let tuning = (1e-9f32..1.0, 1u32..9, 1u32..1000).prop_map(|(tolerance, newton, iterations)| Tuning {
        tolerance,
        newton,
        iterations,
        ..Tuning::DEFAULT
    });
    (
        0.0f64..1e6,
        (1e-6f64..10.0, select(vec![1u32, 1, 1, 2, 5])),
        method,
        (tuning, indices, 1u32..=10_000),
        any::<u64>(),
        any::<u32>(),
    )
        .prop_map(
            |(
                duration,
                (dt, substeps),
                integrator,
                (tuning, (index, collision_index), max_bounces),
                seed,
                capacity,
            )| Run {
                duration,
                dt,
                substeps,
                integrator,
                tuning,
                index,
                collision_index,
                max_bounces,
                seed,
                capacity,
            },
        )
}

/// A scene of which `.scn` may not be able to say all. Everything in it can be used.
pub(crate) fn any_scene() -> impl Strategy<Value = SceneFile> {
    let shapes = prop_oneof![6 => common_shape(), 1 => circle(), 1 => triangle(), 1 => plane()];
    let reapers = vec(positive().prop_map(|rate| ReaperKind::Chance(Chance { rate })), 0..3);
    let custom =
        (vec(number(), 0..3), number()).prop_map(|(start, newborn)| CustomBuf { name: "heat".into(), start, newborn });
    let custom = vec(custom, 0..2);
    let more = (vec(any_emitter(), 0..3), vec(force(), 0..4), vec((shapes, any::<u32>()), 0..3), reapers, custom);
    let words = (option::of("(?s).{0,20}"), "(?s).{0,40}", run(), any::<[u8; 4]>(), uniform3(positive()));
    (scene(), more, words).prop_map(|(mut scene, (emitters, forces, items, reapers, custom), words)| {
        let (schema, about, run, color, [size, glow, softness]) = words;
        (scene.schema, scene.about, scene.run) = (schema, about, run);
        scene.emitters.extend(emitters);
        scene.reapers = reapers;
        scene.custom = custom;
        if !forces.is_empty() {
            scene.forces = forces;
        }
        for (shape, group) in items {
            let group = group.checked_rem(scene.groups.len() as u32);
            scene.scenery.insert(0, Item { shape: shape.clone(), material: None, group, motion: None });
            scene.sinks.push(Sink {
                shape,
                group: None,
                intensity: softness,
                ca: 1.0,
                la: glow,
                qa: 0.0,
                softening: glow,
            });
        }
        if let Some(first) = scene.particles.first_mut() {
            first.color = Some(color);
        }
        if let Some(first) = scene.materials.first_mut() {
            (first.size, first.glow) = (size, glow);
        }
        scene
    })
}
