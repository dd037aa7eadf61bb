//! Rigid bodies on the edges and seams of scenery, and at speeds that take them past it or themselves round within a sub-step.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::scene::{Model, SceneFile};
use pointmass::{Heap, Measures, Method, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, started};
use serde_json::{Value, json};

/// A scene, of which each step is one of 1/60 s.
fn model(parts: &Value, substeps: u32) -> Model {
    let mut scene = json!({
        "run": {"duration": 10, "dt": 1.0 / 60.0, "substeps": substeps, "integrator": "verlet"},
        "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}],
        "materials": [{"contact": {"friction": {"static": 0.5, "kinetic": 0.4}}}, {}],
    });
    scene.as_object_mut().expect("an object").extend(parts.as_object().expect("an object").clone());
    let text = scene.to_string();
    let file = SceneFile::from_json("it.json", &text).unwrap_or_else(|error| panic!("{error}"));
    Model::load(&file, "it.json", &mut ()).unwrap_or_else(|error| panic!("{error}"))
}

/// A system after so many seconds.
fn after(model: &Model, seconds: u64) -> System<Heap> {
    let scene = model.scene();
    let mut system = started(&scene, model.particles.len(), 1);
    for frame in 1..=60 * seconds {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    system
}

/// The middle of a body of eight particles, and the mean of their velocities.
fn body(system: &System<Heap>, number: usize) -> [Vec3; 2] {
    let particles = system.particles();
    [particles.position, particles.velocity].map(|all| all[8 * number..][..8].iter().copied().sum::<Vec3>() / 8.0)
}

fn block(center: [f64; 3], sides: [f64; 3]) -> Value {
    let corner = |sign: f64| [0, 1, 2].map(|k| center[k] + 0.5 * sign * sides[k]);
    json!({"shape": {"box": {"min": corner(-1.0), "max": corner(1.0)}}, "material": 0})
}

/// Level ground of many parts is level: of cells, and of blocks side by side. A kerb of a twentieth of the cube is none, and stops it.
#[test]
fn nothing_catches_on_seams_but_on_kerbs() {
    for (i, side) in [0.2, 0.02, 2.0].into_iter().enumerate() {
        let field = json!({"shape": {"heightfield": {"origin": [-3.0 * side, 0, -3.0 * side], "spacing": 1.5 * side, "columns": 20, "heights": vec![0.0; 120]}}, "material": 1});
        let tile = |x: f64, top: f64| {
            let mut tile = block([x * side, (top - 0.5) * side, 0.1 * side], [3.0 * side, side, 5.0 * side]);
            tile["material"] = json!(1);
            tile
        };
        let tiles: Vec<_> = (0..6).map(|k| tile(3.0 * f64::from(k), 0.0)).collect();
        let kerb = [tile(0.0, 0.0), tile(3.0, 0.05)];
        for (scenery, stops) in [(json!([field]), false), (json!(tiles), false), (json!(kerb), true)] {
            let substeps = [1, 4, 20][i];
            let speed = 10.0 * side;
            let cube = json!({"sides": [side, side, side], "mass": 1, "position": [0, 0.5 * side, 0.15 * side], "velocity": [speed, 0, 0], "material": 1});
            let gravity = json!([{"gravity": {"acceleration": [0, -50.0 * side, 0]}}]);
            let model = model(&json!({"scenery": scenery, "boxes": [cube], "forces": gravity}), substeps);
            let system = after(&model, 1);
            let [place, velocity] = body(&system, 0).map(|x| x / side as f32);
            if stops {
                let stood = place.x < 1.6 || place.y > 0.54;
                assert!(stood && velocity.x < 5.0, "{side}: {place} {velocity}");
            } else {
                assert!(
                    (velocity.x - 10.0).abs() < 0.01 && (place.x - 10.0).abs() < 0.01,
                    "{side}: {place} {velocity}"
                );
                assert!((place.y - 0.5).abs() < 0.01 && velocity.z.abs() < 0.01, "{side}: {place} {velocity}");
            }
        }
    }
}

/// A body that hangs over an edge stays as long as its middle does not, and falls beyond.
#[test]
fn bodies_lie_on_edges_as_far_as_their_middles_are_borne() {
    for substeps in [1, 4, 20] {
        for (sides, over, stays) in [
            ([0.2, 0.2, 0.2], -0.01, true),
            ([0.2, 0.2, 0.2], 0.01, false),
            ([0.4, 0.1, 0.2], -0.08, true),
            ([0.4, 0.1, 0.2], -0.02, true),
            ([0.4, 0.1, 0.2], 0.02, false),
            ([0.02, 0.02, 0.3], -0.002, true),
        ] {
            let [_, height, _] = sides;
            let plank = json!({"sides": sides, "mass": 2, "position": [over, 0.5 * height, 0.03], "material": 0});
            let table = block([-0.5, -0.05, 0.0], [1.0, 0.1, 1.0]);
            let system = after(&model(&json!({"scenery": [table], "boxes": [plank]}), substeps), 3);
            let [place, velocity] = body(&system, 0);
            if stays {
                let off = place - Vec3::new(over as f32, 0.5 * height as f32, 0.03);
                assert!(off.length() < 2e-3 && velocity.length() < 5e-3, "{sides:?} {over} {substeps}: {off}");
            } else {
                assert!(place.y < -0.3, "{sides:?} {over} {substeps}: {place}");
            }
        }
        // A plank on two trestles as wide as it is, and a plate on three and four posts.
        let post = |[x, z]: [f64; 2], [along, across]: [f64; 2]| block([x, -0.25, z], [along, 0.5, across]);
        let trestles = json!([post([-0.4, 0.0], [0.1, 0.3]), post([0.4, 0.0], [0.1, 0.3])]);
        let posts = json!([[-0.3, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2]].map(|at| post(at, [0.1, 0.1])));
        let three = json!([[-0.3, -0.2], [0.3, -0.2], [0.0, 0.2]].map(|at| post(at, [0.1, 0.1])));
        for (scenery, sides) in [(trestles, [1.0, 0.05, 0.3]), (posts, [1.0, 0.05, 0.8]), (three, [1.0, 0.05, 0.8])] {
            let plank = json!({"sides": sides, "mass": 2, "position": [0.0, 0.025, 0.0], "material": 0});
            let system = after(&model(&json!({"scenery": scenery, "boxes": [plank]}), substeps), 3);
            let [place, velocity] = body(&system, 0);
            let off = place - Vec3::Y * 0.025;
            assert!(off.length() < 2e-3 && velocity.length() < 5e-3, "{sides:?} {substeps}: {off} {velocity}");
        }
    }
}

/// Walls on both sides of what hangs over an edge bear nothing.
#[test]
fn walls_beside_an_overhang_bear_nothing() {
    for substeps in [1, 4, 20] {
        let wall = |z: f64| block([0.0, 0.0, z], [2.0, 4.0, 0.1]);
        let table = block([-0.5, -0.05, 0.0], [1.0, 0.1, 1.0]);
        let plank = json!({"sides": [0.4, 0.1, 0.2], "mass": 1, "position": [0.03, 0.05, 0], "material": 1});
        let scenery = json!([table, wall(-0.1501), wall(0.1501)]);
        let system = after(&model(&json!({"scenery": scenery, "boxes": [plank]}), substeps), 2);
        assert!(body(&system, 0)[0].y < -0.3, "{}", body(&system, 0)[0]);
    }
}

/// A box goes through no ground in one sub-step, though it goes up to five of its sides in that.
#[test]
fn no_box_falls_through_ground_in_one_substep() {
    let mut random = Random::new(3);
    for i in 0..60 {
        let (side, frames) = ([0.05, 0.1, 0.2, 0.5][i % 4], [24u32, 60, 144][i / 4 % 3]);
        let ground = match i % 3 {
            0 => json!({"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}),
            1 => block([0.0, -0.05, 0.0], [400.0, 0.1, 400.0]),
            _ => block([0.0, -5.0, 0.0], [400.0, 10.0, 400.0]),
        };
        let turn = random.vector(3.0).to_array();
        let way = f64::from(random.between(0.5, 5.0)) * side;
        let (height, speed) = (2.0 * side + way * f64::from(random.unit()), way * f64::from(frames));
        let cube = json!({"sides": [side, side, side], "mass": 1, "position": [0, height, 0], "turn": turn, "velocity": [0, -speed, 0], "elasticity": 0});
        let model = model(&json!({"scenery": [ground], "boxes": [cube]}), 1);
        let (scene, mut lowest) = (model.scene(), f32::INFINITY);
        let mut system = started(&scene, 8, 1);
        for frame in 1..=u64::from(frames) {
            system.step_to(&scene, Time::frame(frame, frames));
            lowest = lowest.min(body(&system, 0)[0].y);
        }
        assert!(lowest > 0.0, "{i}: {lowest} of {side}");
    }
}

/// A free box of some sides that spins somehow.
fn spinning(sides: Vec3, spin: Vec3, velocity: Vec3, center: Vec3, first: u32) -> (RigidBox, [Particle; 8]) {
    let of = RigidBox::new(0.5 * sides, center, first);
    let whole = Particle { mass: 1.0, velocity, elasticity: 1.0, ..Particle::REST };
    let start = of.solid(whole).map(|p| Particle { velocity: p.velocity + spin.cross(p.position - center), ..p });
    (of, start)
}

/// Whatever spins alone keeps its energy: needles and sheets, of which rounding leaves nothing about an axis, and what goes round in a sub-step.
#[test]
fn whatever_spins_alone_keeps_its_energy() {
    let mut random = Random::new(8);
    for (i, &method) in Method::ALL.iter().cycle().take(60).enumerate() {
        let thin = [1.0, 0.1, 0.02, 0.014, 0.01, 0.005][i % 6];
        let sides = Vec3::new(1.0, thin, [thin, 0.7, 2.0 * thin][i / 6 % 3]) * [1.0, 0.1, 10.0][i % 3];
        let spin = random.direction() * [3.0, 10.0, 40.0, 200.0][i % 4];
        let (of, start) = spinning(sides, spin, Vec3::ZERO, Vec3::ZERO, 0);
        let bodies = RigidBodies::boxes([of]);
        let parts = Scene { start: &start, constraints: &bodies, ..Scene::EMPTY };
        let scene = Scene { substeps: [1, 4, 20][i / 3 % 3], integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 1);
        let energy = |system: &System<Heap>| Measures::of(system, &scene).energy.kinetic;
        let first = energy(&system);
        for frame in 1..=300 {
            system.step_to(&scene, Time::frame(frame, 60));
            let share = energy(&system) / first;
            assert!((share - 1.0).abs() < 0.02, "{sides} {spin} {method} after {frame}: {share}");
        }
    }
}

/// Two that meet in the air keep their momentum to rounding and gain no energy, however fast they are.
#[test]
fn pairs_that_bounce_keep_their_momentum() {
    let mut random = Random::new(5);
    for i in 0..150 {
        let (speed, substeps) = ([5.0, 15.0, 40.0][i % 3], [1, 2, 4][i / 3 % 3]);
        let sides = Vec3::new(random.between(0.1, 0.4), random.between(0.1, 0.4), random.between(0.1, 0.4));
        let aside = random.vector(0.1);
        let (one, first) = spinning(sides, random.vector(5.0), Vec3::X * speed, aside - Vec3::X, 0);
        let (other, second) =
            spinning(Vec3::new(sides.z, sides.y, sides.x), random.vector(5.0), Vec3::ZERO, Vec3::ZERO, 8);
        let start = [first, second].concat();
        let bodies = RigidBodies::boxes([one, other]);
        let parts = Scene { start: &start, constraints: &bodies, ..Scene::EMPTY };
        let scene = Scene { substeps, integrator: Method::Verlet.integrator(), ..parts };
        let mut system = started(&scene, 16, 1);
        let measures = |system: &System<Heap>| {
            let all = Measures::of(system, &scene);
            (all.momentum, all.energy.kinetic)
        };
        let (momentum, kinetic) = measures(&system);
        for frame in 1..=60 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let (now, energy) = measures(&system);
        let off = [0, 1, 2].map(|k| now[k] - momentum[k]).into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(off < 2e-5 * f64::from(speed), "{i}: {off} of {speed}");
        assert!(energy < kinetic * 1.002, "{i}: {energy} of {kinetic}");
    }
}
