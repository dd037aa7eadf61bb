//! The project's own scenes: every one is sound, runs, and counts nothing that it should not.

use pointmass::scene::{Files, Model, SceneFile, read_scn, schema};
use pointmass::{Columns, Heap, Storage, System, Time, Vec3};
use pointmass_cli::load::Disk;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes")
}

fn scenes() -> Vec<PathBuf> {
    let entries =
        folder().read_dir().expect("there is a folder of scenes").map(|entry| entry.expect("readable").path());
    let is_scene = |path: &PathBuf| {
        let name = path.to_string_lossy();
        (name.ends_with(".json") && !name.ends_with("schema.json")) || name.ends_with(".scn")
    };
    let mut scenes: Vec<_> = entries.filter(is_scene).collect();
    scenes.sort();
    assert!(scenes.len() >= 9, "{scenes:?}");
    scenes
}

fn read(path: &Path) -> SceneFile {
    let name = path.to_string_lossy();
    let text = Disk.text(&name).expect("a text");
    if name.ends_with(".json") {
        SceneFile::from_json(&name, &text).unwrap_or_else(|error| panic!("{error}"))
    } else {
        let (scene, warnings) = read_scn(&name, &text, &mut Disk).unwrap_or_else(|error| panic!("{error}"));
        assert!(warnings.is_empty(), "{warnings:?}");
        scene
    }
}

#[test]
fn the_schema_is_that_of_the_types() {
    let kept = std::fs::read_to_string(folder().join("scene.schema.json")).expect("a schema");
    assert!(kept == schema(), "run: cargo run --release -- schema > scenes/scene.schema.json");
}

#[test]
fn the_guide_says_what_can_be_read_and_names_every_scene() {
    let guide = std::fs::read_to_string(folder().join("README.md")).expect("a guide");
    let mut listings = guide.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next());
    let whole = listings.next().expect("a whole scene");
    let scene = SceneFile::from_json("guide", whole).unwrap_or_else(|error| panic!("{error}"));
    let model = Model::load(&scene, "guide", &mut ()).unwrap_or_else(|error| panic!("{error}"));
    let mut system = model.system(1000, 1).expect("a little memory");
    system.step_to(&model.scene(), Time::from_seconds(2.0));
    assert!(system.len() == 400 && system.totals().hits > 0);
    let ball = r#"{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "#;
    let motion = listings.next().expect("a motion").replacen('{', ball, 1);
    let material = listings.next().expect("a material");
    for part in [format!("{{\"scenery\": [{motion}]}}"), format!("{{\"materials\": [{material}]}}")] {
        let scene = SceneFile::from_json("guide", &part);
        scene.and_then(|scene| scene.check()).unwrap_or_else(|error| panic!("{error}"));
    }
    for path in scenes() {
        let name = path.file_name().expect("a name").to_string_lossy();
        assert!(guide.contains(&format!("({name})")), "{name} is missing from scenes/README.md");
    }
}

#[test]
fn every_scene_runs_for_two_seconds_and_loses_nothing() {
    for path in scenes() {
        let file = read(&path);
        let model = Model::load(&file, &path.to_string_lossy(), &mut Disk).unwrap_or_else(|error| panic!("{error}"));
        let mut system = System::with(Heap::new(model.size(file.run.capacity as usize)));
        system.start(&model.scene(), file.run.seed).expect("it fits");
        // In debug builds most of those whose hashes are known go on for longer there; some wait with what they let out.
        let steps = |seconds: f64| (seconds / file.run.dt) as u64;
        let least = steps(if cfg!(debug_assertions) { 0.1 } else { 2.0 });
        for step in 1..=steps(2.0) {
            let end = Time::from_seconds_f64(step as f64 * file.run.dt);
            system.step(&model.scene(), end - system.time());
            if step >= least && !system.is_empty() {
                break;
            }
        }
        let totals = system.totals();
        assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total(), "{path:?}");
        assert!(totals.initial + totals.born > 0, "{path:?}: nothing lives");
        let caps = totals.caps;
        assert_eq!((totals.refused, totals.died.nonfinite), (0, 0), "{path:?}");
        assert_eq!((caps.insufficient_memory, caps.graphs), (0, 0), "{path:?}");
        // A die that is thrown at others in a corner may touch more than there is room for, once in a while.
        assert!(caps.contacts <= 10, "{path:?}: {}", caps.contacts);
        // A page that is drawn twice in a millisecond asks for a step of no time.
        let hash = system.hash();
        system.step(&model.scene(), Time::ZERO);
        assert_eq!(system.hash(), hash, "{path:?}: something has changed in no time");
    }
}

/// A system with what a file begins with.
fn started(file: &SceneFile, model: &Model) -> System<Heap> {
    let particles = (file.run.capacity as usize).max(model.particles.len());
    let mut system = model.system(particles, file.run.seed).expect("the memory is made for the scene");
    system.start(&model.scene(), file.run.seed).expect("it fits");
    system
}

#[test]
fn steps_ask_nothing_of_the_heap_and_give_the_same_bits_on_any_number_of_threads() {
    let frames = if cfg!(debug_assertions) { 4 } else { 60 };
    for path in scenes() {
        let file = read(&path);
        let model = Model::load(&file, &path.to_string_lossy(), &mut Disk).unwrap_or_else(|error| panic!("{error}"));
        let scene = model.scene();
        let run = |system: &mut System<Heap>, frames: std::ops::RangeInclusive<u64>| {
            for frame in frames {
                system.step_to(&scene, Time::frame(frame, 60));
            }
        };
        let (half, mut alone) = (frames / 2, started(&file, &model));
        let mut asked = allocation_counter::measure(|| run(&mut alone, 1..=half));
        let saved = alone.try_clone().expect("there is as much already");
        let mut ends = [0; 2];
        for end in &mut ends {
            // Whoever goes back to halfway comes to the same end, where everything lies already.
            asked += allocation_counter::measure(|| {
                alone.clone_from(&saved);
                run(&mut alone, half + 1..=frames);
            });
            *end = alone.hash();
        }
        assert_eq!(asked.count_total, 0, "{path:?}");
        assert_eq!(ends[0], ends[1], "{path:?}");
        let size = alone.memory().columns().size();
        for threads in [1, 2, 8] {
            // In memory without the columns that the scene does not need.
            let mut system = System::with(Heap::alike(size, &scene.likeness()).expect("there is as much already"));
            system.start(&scene, file.run.seed).expect("it fits");
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| run(&mut system, 1..=frames));
            assert_eq!(system.hash(), alone.hash(), "{path:?} on {threads} threads");
        }
    }
}

/// Every method and, scene by scene, most forces: what WebAssembly has to give as well.
#[test]
fn worlds_have_their_hashes() {
    let list = std::fs::read_to_string(folder().join("../tests/worlds.txt")).expect("a list");
    let list = list.lines().filter(|line| !line.starts_with('#'));
    let (mut seen, mut right) = (Vec::new(), true);
    for line in list {
        let (name, expected) = line.split_once(' ').expect("a name and a hash");
        let mut parts = name.split('/');
        let [scene, method] = std::array::from_fn(|_| parts.next().expect("a scene and a method"));
        let frames = parts.next().map_or(30, |frames| frames.parse().expect("a number of steps"));
        let path = folder().join(scene).with_extension("json");
        let mut file = read(&path);
        file.run.integrator = method.parse().expect("a method");
        let model = Model::load(&file, &path.to_string_lossy(), &mut Disk).unwrap_or_else(|error| panic!("{error}"));
        let mut system =
            System::with(Heap::new(model.size(file.run.capacity.max(model.particles.len() as u32) as usize)));
        system.start(&model.scene(), file.run.seed).expect("it fits");
        for frame in 1..=frames {
            system.step(&model.scene(), Time::from_seconds_f64(f64::from(frame) / 60.0) - system.time());
        }
        let hash = format!("{:016x}", system.hash());
        println!("{name} {hash}");
        right &= expected == hash;
        seen.push(file.run.integrator);
    }
    assert!(right, "not as in tests/worlds.txt");
    assert!(pointmass::Method::ALL.iter().all(|method| seen.contains(method)), "a method is missing");
}

#[test]
fn every_scene_survives_a_round_trip_through_json() {
    for path in scenes() {
        let file = read(&path);
        assert_eq!(SceneFile::from_json("again", &file.to_json()), Ok(file), "{path:?}");
    }
}

/// Runs a scene of the folder for some seconds, and shows `look` the state after each step and the instant \[s\].
fn watch(name: &str, seconds: f64, mut look: impl FnMut(Columns<'_>, f64)) {
    let path = folder().join(name).with_extension("json");
    let file = read(&path);
    let model = Model::load(&file, &path.to_string_lossy(), &mut Disk).unwrap_or_else(|error| panic!("{error}"));
    let mut system = System::with(Heap::new(model.size(file.run.capacity as usize)));
    system.start(&model.scene(), file.run.seed).expect("it fits");
    for step in 1..=(seconds / file.run.dt) as u64 {
        let end = Time::from_seconds_f64(step as f64 * file.run.dt);
        system.step(&model.scene(), end - system.time());
        look(system.particles(), end.seconds_f64());
    }
}

#[test]
fn balls_rise_to_the_square_of_their_elasticity() {
    let mut apexes = [const { Vec::new() }; 6];
    let mut elasticities = [0.0; 6];
    watch("bouncing_balls", 4.0, |balls, _| {
        for (row, apexes) in apexes.iter_mut().enumerate() {
            let speed = f64::from(balls.velocity[row].y);
            let height = f64::from(balls.position[row].y - balls.radius[row]) + speed * speed / (2.0 * 9.80665);
            elasticities[row] = f64::from(balls.elasticity[row]);
            if apexes.last().is_none_or(|last| (last - height) / last > 0.01) {
                apexes.push(height);
            }
        }
    });
    for (apexes, elasticity) in apexes.iter().zip(elasticities) {
        for (n, apex) in apexes.iter().enumerate().take(4) {
            let right = 2.5 * elasticity.powi(2 * n as i32);
            assert!((apex - right).abs() < 3e-4, "{elasticity}: {apex} after {n} bounces, not {right}");
        }
    }
    assert!(apexes[0].len() == 1 && apexes[1..].iter().all(|apexes| apexes.len() >= 3), "{apexes:?}");
}

#[test]
fn two_balls_come_in_and_two_go_out() {
    let mut out = Vec::new();
    watch("cradle", 0.85, |balls, now| {
        if now > 0.8 {
            out = (0..5).map(|i| balls.velocity[3 * i].x).collect();
        }
    });
    assert!(out[..3].iter().all(|speed| speed.abs() < 0.01), "{out:?}");
    assert!(out[3..].iter().all(|&speed| speed > 1.5) && (out[3] - out[4]).abs() < 0.01, "{out:?}");
}

#[test]
fn a_chain_wraps_itself_round_a_peg_and_rests() {
    let peg = pointmass::Vec3::new(-1.05, 0.95, 0.0);
    watch("chain", 6.0, |balls, now| {
        for (i, pair) in balls.position.windows(2).enumerate() {
            let length = if i == 25 { 0.11 } else { 0.075 };
            assert!((pair[0].distance(pair[1]) / length - 1.0).abs() < 0.06, "link {i} at {now} s");
        }
        for (center, &r) in balls.position.iter().zip(balls.radius) {
            let inside = 0.1 + r - (*center - peg).length();
            assert!(inside < 0.01, "{inside} m inside the peg at {now} s");
        }
        if now > 5.5 {
            assert!(balls.position[26].y > peg.y + 0.1, "it lies on the peg");
            let kinetic: f32 = balls.velocity.iter().zip(balls.mass).map(|(v, m)| 0.5 * m * v.length_squared()).sum();
            assert!(kinetic < 0.07, "{kinetic} J of 17 that it fell for");
        }
    });
}

#[test]
fn rings_lie_around_pegs() {
    // Two pegs, then eight rings and six cups, each of eight particles.
    let (mut rings, mut fastest) = (Vec::new(), 0.0f32);
    watch("cups", 5.0, |bodies, _| {
        let middles = bodies.position.chunks(8).map(|body| body.iter().copied().sum::<Vec3>() / 8.0);
        rings = middles.skip(2).take(8).collect();
        fastest = bodies.velocity.iter().fold(0.0, |most, v| v.length().max(most));
    });
    for (ring, middle) in rings.iter().enumerate() {
        let aside = [-0.1, 0.1].map(|x| (middle.x - x).hypot(middle.z)).into_iter().fold(f32::INFINITY, f32::min);
        assert!(aside < 0.034 && (0.005..0.09).contains(&middle.y), "ring {ring}: {middle}");
    }
    assert!(fastest < 0.01, "{fastest} m/s");
}

#[test]
fn no_bullet_leaves_the_room() {
    let (mut fastest, mut moved) = (0.0, 0);
    watch("bullet", 3.0, |balls, now| {
        for (center, &r) in balls.position.iter().zip(balls.radius) {
            let room = center.x.abs() + r < 2.0001 && center.z.abs() + r < 1.0001;
            assert!(room && center.y - r > 0.0009 && center.y + r < 1.5001, "{center} at {now} s");
        }
        fastest = balls.velocity.iter().fold(fastest, |most, v| v.length().max(most));
        moved = balls.velocity[..55].iter().filter(|v| v.length() > 0.01).count();
    });
    assert!(fastest > 200.0 && moved > 10, "{fastest} m/s, {moved} of 55 hit");
}

/// Runs a scene in JSON for a second and gives the hash of its end.
fn hash_after_a_second(text: &str) -> u64 {
    let file = SceneFile::from_json("scene.json", text).unwrap_or_else(|error| panic!("{error}"));
    let model = Model::load(&file, "scene.json", &mut Disk).unwrap_or_else(|error| panic!("{error}"));
    let mut system = System::with(Heap::new(model.size(1000)));
    system.start(&model.scene(), 5).expect("it fits");
    for step in 1..=60 {
        system.step(&model.scene(), Time::frame(step, 60) - system.time());
    }
    assert!(system.totals().born > 50 && system.totals().died.sink > 0, "{:?}", system.totals());
    system.hash()
}

#[test]
fn emitters_and_sinks_stand_where_their_groups_put_them() {
    // A quarter turn about the y axis, x to -z, inside a shift: both are exact.
    let groups = r#""materials": [{}, {"diffuse": [1, 0, 0]}], "groups": [
        {"matrix": [[1, 0, 0, 5], [0, 1, 0, -2], [0, 0, 1, 0.5], [0, 0, 0, 1]], "material": 1},
        {"matrix": [[0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]], "parent": 0}]"#;
    let inside = format!(
        r#"{{{groups}, "emitters": [{{"group": 1, "shape": {{"line": {{"from": [0, 0, 0], "to": [1, 0, 0]}}}}, "rate": 99,
            "direction": [1, 0, 0], "speed": 2, "velocity": [0.5, 0, 0]}}],
            "sinks": [{{"group": 1, "shape": {{"sphere": {{"center": [2, 0, 0], "radius": 0.5}}}}, "intensity": 1, "ca": 1,
            "la": 0, "qa": 0}}]}}"#
    );
    let written_out = format!(
        r#"{{{groups}, "emitters": [{{"shape": {{"line": {{"from": [5, -2, 0.5], "to": [5, -2, -0.5]}}}}, "rate": 99,
            "direction": [0, 0, -1], "speed": 2, "velocity": [0, 0, -0.5], "material": 1}}],
            "sinks": [{{"shape": {{"sphere": {{"center": [5, -2, -1.5], "radius": 0.5}}}}, "intensity": 1, "ca": 1,
            "la": 0, "qa": 0}}]}}"#
    );
    assert_eq!(hash_after_a_second(&inside), hash_after_a_second(&written_out));
}
