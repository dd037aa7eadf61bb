//! What hangs together falls on scenery: that takes energy and gives none, however many sub-steps a step has.

use pointmass::constrain::{Rope, ShapeMatching, StrainLimitParams, StrainLimits, StrandParams, Strands};
use pointmass::force::{Coulomb, Friction};
use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Collider, Cuboid, HeightField, MeshBuf, Moving, Plane, Sphere};
use pointmass::{
    Cause, ClothSprings, Constraint, ContactMaterial, Emitter, Force, Gravity, Heap, LifeEvent, Measures, Method,
    Observer, Particle, Report, Scene, Sheet, Spring, SpringParams, System, Time, Vec3,
};
use pointmass_tests::{Random, is_third, methods, often, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.8, 0.0) };

/// Things that fall: their particles, the springs between them, and what else holds them together.
struct Thing {
    name: &'static str,
    start: Vec<Particle>,
    springs: Vec<Spring>,
    bond: Box<dyn Constraint>,
    forces: Box<dyn Force>,
}

/// A net of 0.2 kg, 1 m wide, turned anyhow about its middle 0.9 m above the ground.
fn sheet(random: &mut Random, scale: f32) -> Sheet {
    let (u, across) = (random.direction(), random.direction());
    let v = (across - u * u.dot(across)).normalize();
    let sides = [u * scale, v * scale];
    Sheet { corner: Vec3::Y * (0.9 * scale) - (sides[0] + sides[1]) * 0.5, sides, cells: [7, 7] }
}

fn threads(scale: f32, damping: f32) -> ClothSprings {
    let of = |ks: f32| Some(SpringParams { ks: ks / scale, kd: damping * ks / scale.sqrt() });
    ClothSprings { structural: of(100.0), shear: of(50.0), bend: of(10.0) }
}

/// One of each kind, in any pose.
fn things(random: &mut Random, scale: f32) -> Vec<Thing> {
    // Things of all sizes weigh as much; their stiffness is such that they are alike, in times that go by the root of the size.
    let damping = if random.unit() < 0.5 { 0.0 } else { 1e-3 };
    let knot = Particle { mass: 0.2 / 64.0, drag: 0.0, ..Particle::REST };
    let thing =
        |name, start, springs, bond: Box<dyn Constraint>| Thing { name, start, springs, bond, forces: Box::new(DOWN) };
    let net = |random: &mut Random| {
        let sheet = sheet(random, scale);
        let params = StrainLimitParams { shear: Some(0.3), warp: Some([0.8, 1.1]), ..StrainLimitParams::default() };
        let limits = StrainLimits { triangles: sheet.triangles().collect::<Vec<_>>(), warp: sheet.sides[0], params };
        let start: Vec<_> = sheet.particles(knot).collect();
        (start, sheet.springs(&threads(scale, damping), 0).collect::<Vec<_>>(), limits)
    };
    let (plain, springs, _) = net(random);
    let (limited, soft, limits) = net(random);
    let line = |random: &mut Random, count: u32| -> Vec<Particle> {
        let along = random.direction() * (scale / count as f32);
        let place = |i: u32| Vec3::Y * (0.9 * scale) + along * (i as f32 - 0.5 * count as f32);
        (0..count).map(|i| Particle { position: place(i), ..knot }).collect()
    };
    let numbers: Vec<u32> = (0..12).collect();
    let rope = Rope::string(numbers.clone(), vec![scale / 12.0]);
    let params = StrandParams {
        stretch: Some(20.0),
        bending: [1e-3 * scale * scale; 2],
        twisting: 1e-3 * scale * scale,
        damping: 0.0,
    };
    let strand = Strands::of(numbers.clone(), vec![12], params);
    let cluster =
        ShapeMatching { compliance: 1e-3 * scale, damping: 0.1 / scale.sqrt(), ..ShapeMatching::rigid(numbers) };
    let place = |random: &mut Random| Vec3::Y * (0.9 * scale) + random.vector(0.3 * scale);
    let pile: Vec<_> = (0..12).map(|_| Particle { position: place(random), ..knot }).collect();
    let charges: Vec<_> = (0..12)
        .map(|i| Particle { position: place(random), charge: scale * if i % 3 == 0 { -2e-7 } else { 1e-7 }, ..knot })
        .collect();
    let coulomb = Coulomb { softening: 0.05 * scale, ..Coulomb::default() };
    vec![
        thing("net", plain, springs, Box::new(())),
        thing("limits", limited, soft, Box::new(limits)),
        thing("rope", line(random, 12), vec![], Box::new(rope)),
        thing("strand", line(random, 12), vec![], Box::new(strand)),
        thing("cluster", pile, vec![], Box::new(cluster)),
        Thing { forces: Box::new((DOWN, coulomb)), ..thing("charges", charges, vec![], Box::new(())) },
    ]
}

/// The ground of every kind, no higher than 0.25 m where things fall.
fn grounds(scale: f32, heights: &[f32]) -> Vec<(&'static str, Box<dyn Collider + '_>)> {
    let sphere = Sphere { center: Vec3::Y * (-0.3 * scale), radius: 0.5 * scale };
    let low = Vec3::new(-0.2, -0.5, -0.2) * scale;
    let cuboid = Cuboid { min: low, max: Vec3::new(0.2, 0.2, 0.2) * scale };
    let slope = Plane { point: Vec3::ZERO, normal: Vec3::new(0.3, 1.0, 0.1).normalize() };
    let corners = [[-0.5, 0.0, -0.4], [0.5, 0.0, -0.4], [0.0, 0.0, 0.6], [0.0, 0.25, 0.0]];
    let corners = corners.map(|[x, y, z]| Vec3::new(x, y, z) * scale).to_vec();
    let hill = MeshBuf::new(corners, vec![[0, 3, 1], [1, 3, 2], [2, 3, 0], [0, 1, 2]]).expect("a hill is a mesh");
    let field = HeightField::new(Vec3::new(-1.2, 0.0, -1.2) * scale, 0.3 * scale, 9, heights).expect("nine by nine");
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    vec![
        ("plane", Box::new(floor)),
        ("slope", Box::new(slope)),
        ("box", Box::new((floor, cuboid))),
        ("sphere", Box::new((floor, sphere))),
        ("mesh", Box::new((floor, hill))),
        ("heights", Box::new((floor, field))),
    ]
}

/// Energy as seen from what moves with `drift` \[J\].
fn energy(system: &System<Heap>, scene: &Scene<'_>, drift: Vec3) -> f64 {
    let (particles, t) = (system.particles(), system.time().seconds());
    let all = particles.velocity.iter().zip(particles.mass);
    let seen = |(v, &mass): (&Vec3, &f32)| f64::from(mass) * f64::from(0.5 * drift.dot(drift) - drift.dot(*v));
    let weight: f64 = particles.mass.iter().map(|&mass| f64::from(mass)).sum();
    let lowered = weight * f64::from(DOWN.acceleration.dot(drift) * t);
    Measures::of(system, scene).energy.total() + all.map(seen).sum::<f64>() + lowered
}

/// The most by which energy is above that of the beginning in so many steps of `step` \[J\], as seen from what moves with `drift`.
fn risen(scene: &Scene<'_>, [step, whole]: [Time; 2], drift: Vec3) -> f64 {
    let mut system = started(scene, scene.start.len(), 1);
    let first = energy(&system, scene, drift);
    let mut risen = 0f64;
    while system.time() < whole {
        system.step(scene, step);
        risen = risen.max(energy(&system, scene, drift) - first);
    }
    if system.len() == scene.start.len() { risen } else { f64::INFINITY }
}

/// A thing falls on a ground by a method, in steps and sub-steps, with elasticity, friction, size and drift of all kinds: tells what went wrong.
fn gain(random: &mut Random, thing: &Thing, scale: f32, heights: &[f32]) -> Option<String> {
    // Times go by the root of the size.
    let pace = f64::from(scale).sqrt();
    let grounds = grounds(scale, heights);
    let (at, ground) = &grounds[random.word() as usize % grounds.len()];
    let method = Method::ALL[random.word() as usize % Method::ALL.len()];
    let substeps = [1, 2, 5, 10, 30][random.word() as usize % 5];
    let (elasticity, mu) = (random.unit(), random.unit());
    let material = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: 0.8 * mu }) }];
    let drift = if random.unit() < 0.3 { random.vector(1.0) * pace as f32 } else { Vec3::ZERO };
    let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    let moving = Moving::new(&**ground, &all, Motion { drift, ..Motion::STILL });
    let own = |p: &Particle| Particle { elasticity, velocity: p.velocity + drift, material: Some(0), ..*p };
    let start: Vec<_> = thing.start.iter().map(own).collect();
    let free = Scene {
        start: &start,
        springs: &thing.springs,
        forces: &*thing.forces,
        constraints: &*thing.bond,
        materials: &material,
        integrator: method.integrator(),
        substeps,
        ..Scene::EMPTY
    };
    let scene =
        if drift == Vec3::ZERO { Scene { colliders: &**ground, ..free } } else { Scene { colliders: &moving, ..free } };
    // Sub-steps of 1/600 s at the most, steps of 1/15 s.
    let step = (f64::from(substeps) / 600.0).min(1.0 / 15.0) * pace;
    let span = [step, 1.2 * pace].map(Time::from_seconds_f64);
    let scale_of_all = 0.2 * 9.8 * 0.9 * f64::from(scale) * start.len() as f64 / 64.0;
    let own = risen(&free, span, drift) / scale_of_all;
    let more = risen(&scene, span, drift) / scale_of_all - own;
    // Springs that crumple push harder than a sub-step shows, and a symplectic method's energy swings about its own: what limits of strain are to answer
    // for is what they add to that. Where springs alone peak before any limit acts, both runs peak with the same bits, and they have added nothing.
    let springs = || risen(&Scene { constraints: &(), ..scene }, span, drift) / scale_of_all;
    let is_limits = || thing.name == "limits" && more <= springs();
    // A method may not stand undamped springs at all.
    (!(more < 0.01) && own < 0.1 && !is_limits()).then(|| {
        let what = format!("{} on {at}, {}, {substeps} sub-steps", thing.name, method.name());
        format!("{what}, e {elasticity}, mu {mu}, {drift} m/s, {scale} m: {own} {more}")
    })
}

/// The drops of things that tell of a fault, each thing of every kind whose name is `among` some.
fn gains(seed: u64, rounds: usize, among: impl Fn(&str) -> bool) -> Vec<String> {
    let mut random = Random::new(seed);
    let heights: Vec<f32> = (0..81).map(|_| random.between(0.0, 0.2)).collect();
    let (mut cases, mut failures) = (0, vec![]);
    for round in 0..rounds {
        let scale = [1.0, 0.05, 20.0][round % 3];
        let high: Vec<f32> = heights.iter().map(|height| height * scale).collect();
        let things = things(&mut random, scale);
        for thing in things.iter().filter(|thing| among(thing.name) && is_third(&mut cases)) {
            failures.extend(gain(&mut random, thing, scale, &high));
        }
    }
    failures
}

/// One law in many scenes.
#[test]
fn no_ground_gives_energy() {
    let failures = gains(77, often(100), |_| true);
    assert!(failures.is_empty(), "{failures:#?}");
}

/// The same of nets that are held within limits of strain, which scenery squeezes.
#[test]
#[ignore = "long: minutes"]
fn no_ground_gives_energy_to_limits_of_strain() {
    let failures: Vec<_> = (0..6).flat_map(|seed| gains(1000 + seed, 100, |name| name == "limits")).collect();
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

/// Where all are at last, as seen from what moves with `drift`.
fn course(scene: &Scene<'_>, [step, whole]: [Time; 2], drift: Vec3) -> Vec<Vec3> {
    let mut system = started(scene, scene.start.len(), 1);
    while system.time() < whole {
        system.step(scene, step);
    }
    let t = system.time().seconds();
    system.particles().position.iter().map(|x| *x - drift * t).collect()
}

/// A flat net of undamped springs, which swings, falls flat on a smooth plane that may move, bounces and lies: along that it goes as its method takes it
/// where there is no plane. But for explicit Euler, whose steps would lead through what they begin on.
#[test]
fn a_smooth_ground_leaves_what_springs_do_along_it_to_their_method() {
    let mut random = Random::new(81);
    for round in 0..often(300) {
        let scale: f32 = [1.0, 0.05, 20.0][round % 3];
        let pace = scale.sqrt();
        let method = Method::ALL[1 + round % (Method::ALL.len() - 1)];
        let normal = random.direction();
        let u = normal.any_orthonormal_vector();
        let sides = [u * scale, normal.cross(u) * scale];
        let sheet = Sheet { corner: normal * (0.001 * scale) - (sides[0] + sides[1]) * 0.5, sides, cells: [3, 3] };
        let drift = if random.unit() < 0.3 { random.vector(1.0) * pace } else { Vec3::ZERO };
        let elasticity = [0.0, 0.5, 1.0][random.word() as usize % 3];
        let aside = |v: Vec3| v - normal * normal.dot(v);
        let knot = Particle { mass: 0.2 / 64.0, drag: 0.0, elasticity, ..Particle::REST };
        let push = |p: Particle, v: Vec3| Particle { velocity: aside(v) * (0.5 * pace) + drift, ..p };
        let start: Vec<_> = sheet.particles(knot).map(|p| push(p, random.vector(1.0))).collect();
        let springs: Vec<_> = sheet.springs(&threads(scale, 0.0), 0).collect();
        let floor = Plane { point: Vec3::ZERO, normal };
        let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
        let moving = Moving::new(&floor, &all, Motion { drift, ..Motion::STILL });
        let weight = Gravity { acceleration: normal * -9.8 };
        let substeps = [1, 2, 10][random.word() as usize % 3];
        let free =
            Scene { start: &start, springs: &springs, integrator: method.integrator(), substeps, ..Scene::EMPTY };
        let falls = Scene { forces: &weight, ..free };
        let scene = if drift == Vec3::ZERO {
            Scene { colliders: &floor, ..falls }
        } else {
            Scene { colliders: &moving, ..falls }
        };
        let step = f64::from(substeps) / 2400.0 * f64::from(pace);
        let span = [step, 0.08 * f64::from(pace)].map(Time::from_seconds_f64);
        let (own, on_it) = (course(&free, span, drift), course(&scene, span, drift));
        let apart = |(x, y): (&Vec3, &Vec3)| aside(*x - *y).length() / scale;
        let apart = own.iter().zip(&on_it).map(apart).fold(0.0, f32::max);
        let what = format!("{}, {substeps} sub-steps, e {elasticity}, {drift} m/s, {scale} m", method.name());
        assert!(apart < 2e-4, "{what}: {apart}");
    }
}

/// What a run comes to: where all are and how they move, to the bit, and how often they have been hit and have waited.
fn outcome(scene: &Scene<'_>, step: Time, count: u32) -> (Vec<[u32; 3]>, [u64; 2]) {
    let mut system = started(scene, scene.start.len(), 1);
    let mut sum = Report::default();
    (0..count).for_each(|_| sum += system.step(scene, step));
    let all = system.particles();
    let bits = all.position.iter().chain(all.velocity).map(|v| v.to_array().map(f32::to_bits));
    (bits.collect(), [sum.hits, sum.caps.bounces])
}

/// Forces and scenery alone: to the bit.
#[test]
fn so_many_sub_steps_are_as_many_steps() {
    let mut random = Random::new(78);
    let heights = [0.1; 81];
    for thing in things(&mut random, 1.0).iter().filter(|thing| thing.bond.is_empty()) {
        for (i, (at, ground)) in grounds(1.0, &heights).iter().enumerate() {
            for method in methods(i) {
                let substeps = [2, 4, 8, 32][random.word() as usize % 4];
                let scene = Scene {
                    start: &thing.start,
                    springs: &thing.springs,
                    forces: &*thing.forces,
                    colliders: &**ground,
                    integrator: method.integrator(),
                    ..Scene::EMPTY
                };
                let short = Time::from_ticks(1 << 23);
                let one = outcome(&scene, short, 384);
                let many =
                    outcome(&Scene { substeps, ..scene }, Time::from_ticks(u64::from(substeps) << 23), 384 / substeps);
                assert_eq!(one, many, "{} on {at}, {}, {substeps}", thing.name, method.name());
                assert!(one.1[0] > 0, "it falls that far");
            }
        }
    }
}

/// Bonds, which know of steps when they say what rests: as fast, as high and as hard, within what falls differ by.
#[test]
fn bound_things_fall_alike_in_steps_and_sub_steps() {
    let mut random = Random::new(79);
    let heights = [0.1; 81];
    for thing in things(&mut random, 1.0) {
        for (at, ground) in &grounds(1.0, &heights) {
            let scene = Scene {
                start: &thing.start,
                springs: &thing.springs,
                forces: &*thing.forces,
                constraints: &*thing.bond,
                colliders: &**ground,
                integrator: Method::Verlet.integrator(),
                ..Scene::EMPTY
            };
            let middle = |substeps: u32| {
                let scene = Scene { substeps, ..scene };
                let mut system = started(&scene, scene.start.len(), 1);
                (0..240 / substeps).for_each(|_| {
                    system.step(&scene, Time::from_ticks(u64::from(substeps) << 23));
                });
                let x = system.particles().position;
                x.iter().sum::<Vec3>() / x.len() as f32
            };
            let (one, many) = (middle(1), middle(8));
            assert!(one.distance(many) < 0.02, "{} on {at}: {one} {many}", thing.name);
        }
    }
}

/// The places at which particles have vanished.
#[derive(Default)]
struct Drowned(Vec<Vec3>);

impl Observer for Drowned {
    fn died(&mut self, death: &LifeEvent, _: Cause) {
        self.0.push(death.place);
    }
}

/// Who is born in the middle of a step flies, bounces and vanishes in its sub-steps as in a whole one.
#[test]
fn the_newborn_and_those_who_vanish_are_where_they_would_be_without_sub_steps() {
    let ball = Sphere { center: Vec3::Y, radius: 0.1 };
    let source = Emitter { velocity: Vec3::new(0.8, -6.0, 0.3), ..Emitter::new(ball, 3000.0) };
    // The ground ends; beside it all vanish below.
    let ground = Cuboid { min: Vec3::new(-9.0, -0.2, -9.0), max: Vec3::new(0.1, 0.0, 9.0) };
    let sea = Plane { point: Vec3::Y * -0.5, normal: Vec3::Y };
    let scene = Scene {
        emitters: &source,
        forces: &DOWN,
        colliders: &ground,
        sinks: &sea,
        integrator: Method::Verlet.integrator(),
        ..Scene::EMPTY
    };
    let course = |substeps: u32| {
        let (scene, mut drowned) = (Scene { substeps, ..scene }, Drowned::default());
        let mut system = started(&scene, 2000, 1);
        let mut hits = 0;
        for _ in 0..12 {
            hits += system.step_observed(&scene, Time::frame(1, 30), &mut drowned).hits;
        }
        (system.particles().position.to_vec(), drowned.0, hits)
    };
    let (one, gone, hits) = course(1);
    assert!(one.len() > 200 && gone.len() > 50 && hits > 200, "{} {} {hits}", one.len(), gone.len());
    for substeps in [2, 7, 20] {
        let (many, others, more) = course(substeps);
        assert_eq!((one.len(), gone.len()), (many.len(), others.len()), "{substeps} sub-steps");
        assert!(more >= hits, "what has come to rest is hit in each sub-step: {more} after {hits}");
        let far = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(far(&one, &many) < 1e-3 && far(&gone, &others) < 1e-3, "{} {}", far(&one, &many), far(&gone, &others));
        assert!(others.iter().all(|place| (place.y + 0.5).abs() < 1e-4), "they vanish where they meet the sea");
    }
}

/// What is bound together falls into a sink in the middle of a step of many sub-steps: each vanishes where it meets that.
#[test]
fn what_is_bound_vanishes_where_it_meets_a_sink() {
    let mut random = Random::new(80);
    let sea = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for scale in [1.0, 0.05, 20.0] {
        let pace = f64::from(scale).sqrt();
        for (thing, method) in things(&mut random, scale).iter().zip(Method::ALL.iter().cycle()) {
            for substeps in [2, 5, 20] {
                let fast = |p: &Particle| Particle { velocity: Vec3::new(0.0, -9.0, 1.0) * pace as f32, ..*p };
                let start: Vec<_> = thing.start.iter().map(fast).collect();
                let scene = Scene {
                    start: &start,
                    springs: &thing.springs,
                    forces: &*thing.forces,
                    constraints: &*thing.bond,
                    sinks: &sea,
                    substeps,
                    integrator: method.integrator(),
                    ..Scene::EMPTY
                };
                let (mut system, mut drowned) = (started(&scene, start.len(), 1), Drowned::default());
                (0..8).for_each(|_| {
                    system.step_observed(&scene, Time::from_seconds_f64(0.05 * pace), &mut drowned);
                });
                let off = drowned.0.iter().map(|place| place.y.abs() / scale).fold(0.0, f32::max);
                let what = format!("{} of {scale} m, {}, {substeps} sub-steps", thing.name, method.name());
                assert!(!drowned.0.is_empty() && off < 1e-4, "{what}: {} left, {off}", system.len());
            }
        }
    }
}
