//! The course's thirteen scenes: they run, and they do what is known of them.

use crate::tool::{Folder, number};
use pointmass::scene::{Model, SceneFile};
use pointmass::{Heap, Measures, Method, System, Time};
use pointmass_cli::load::{self, Disk};
use std::fs;
use std::path::{Path, PathBuf};

const SCENES: [&str; 13] = [
    "angle_cutoff",
    "cannonball",
    "dragrace",
    "gravity",
    "oneparticle",
    "opposites",
    "rope",
    "sinks",
    "sources",
    "starburst",
    "swirl",
    "tetra",
    "twoparticles",
];

/// Where they lie, if they are here: they are not ours to ship.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes/course");
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: the course's scenes are not at {}", folder.display());
    None
}

/// Copies them and their mesh; their names.
pub(crate) fn copy_into(target: &Folder, name: &str) -> Option<[&'static str; 13]> {
    let folder = folder()?;
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        let file = path.file_name().expect("a name").to_string_lossy().into_owned();
        target.write(&format!("{name}/{file}"), fs::read(path).expect("a file"));
    }
    Some(SCENES)
}

/// A scene of the course as it is declared, and made ready.
pub(crate) fn load(name: &str) -> Option<(SceneFile, Model)> {
    let path = folder()?.join(format!("{name}.scn"));
    let file = load::scene(&path).unwrap_or_else(|error| panic!("{error}"));
    let model = Model::load(&file, &path.to_string_lossy(), &mut Disk).unwrap_or_else(|error| panic!("{error}"));
    Some((file, model))
}

/// A system that has begun with a scene.
pub(crate) fn begun(model: &Model, capacity: usize) -> System<Heap> {
    let mut system = System::with(Heap::new(model.size(capacity)));
    system.start(&model.scene(), 1).expect("the memory is made for the scene");
    system
}

/// Runs a scene for 10 s and looks at every number that it writes.
fn runs_well(name: &str) {
    let folder = Folder::new();
    let Some(scenes) = copy_into(&folder, ".") else { return };
    assert!(scenes.contains(&name));
    let step = if cfg!(debug_assertions) { "--duration 10 --dt 1/60" } else { "--duration 10 --dt 0.001" };
    let report = folder.report(&format!("{name}.scn {step} --integrator rk4 --every 100000 --out o.csv"));
    assert!(cfg!(debug_assertions) || number(&report, "steps") == 10_000.0, "{report}");
    assert_eq!((number(&report, "time"), number(&report, "died/nonfinite")), (10.0, 0.0), "{report}");
    let caps = report["caps"].as_object().expect("caps");
    assert!(caps.values().all(|count| count == 0), "{report}");
    let text = folder.read("o.csv");
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    assert!(rows.iter().flatten().all(|x| x.is_finite()), "{text}");
    let live = rows.iter().filter(|row| row[0] == number(&report, "steps")).count();
    assert_eq!(live as f64, number(&report, "live"));
    let fastest = rows.iter().flat_map(|row| &row[3..9]).fold(0.0, |a: f64, x| a.max(x.abs()));
    assert!(fastest < 1000.0, "{name} explodes: {fastest}");
}

macro_rules! all_run_well {
    ($($scene:ident)+) => {
        mod runs_well_for_ten_seconds {
            $(#[test] fn $scene() { super::runs_well(stringify!($scene)); })+
        }
        #[test]
        fn none_is_left_out() {
            assert_eq!(SCENES, [$(stringify!($scene)),+]);
        }
    };
}
all_run_well! {
    angle_cutoff cannonball dragrace gravity oneparticle opposites rope sinks sources starburst swirl tetra twoparticles
}

#[test]
fn opposites_come_back_to_their_start() {
    let folder = Folder::new();
    if copy_into(&folder, ".").is_none() {
        return;
    }
    let run = "opposites.scn --duration 2.93425 --dt 0.001 --integrator rk4 --every 100000 --out o.csv";
    assert_eq!(number(&folder.report(run), "steps"), 2935.0);
    let text = folder.read("o.csv");
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    // The period is known to 5e-6 s, at a speed of 1 m/s. The rounding of 2935 steps to singles, 6e-8 of 2 m each,
    // adds at random to 6e-6 m of place and to as much of the period's phase in each of the steps after.
    for (start, end) in [(&rows[0], &rows[2]), (&rows[1], &rows[3])] {
        assert_eq!((end[0], end[2]), (2935.0, start[2]));
        for i in 3..9 {
            assert!((start[i] - end[i]).abs() < 3e-4, "{start:?} {end:?}");
        }
    }
    let report = folder.report("opposites.scn --duration 1.467125 --dt 0.001 --every 100000 --out half.csv");
    let half = folder.read("half.csv");
    let z: Vec<f64> = half.lines().skip(3).map(|line| line.split(',').nth(5).unwrap().parse().unwrap()).collect();
    assert!(z[0].abs() > 0.3 && (z[0] + z[1]).abs() < 1e-3 && z[0] < 0.0, "half way it is on the other side: {half}");
    assert!(number(&report, "energy/kinetic") > 0.0 && number(&report, "energy/potential") < 0.0);
}

/// Energy of the two of `opposites`, from what is written in its file.
fn energy(system: &System<Heap>) -> f64 {
    const M: f64 = 1e11f32 as f64;
    let particles = system.particles();
    let [a, b] = [0, 1].map(|i| particles.position[i].to_array().map(f64::from));
    let distance = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let square = |i: usize| particles.velocity[i].to_array().iter().map(|&v| f64::from(v).powi(2)).sum::<f64>();
    0.5 * M * (square(0) + square(1)) - 6.67428e-11 * M * M / distance
}

#[test]
fn opposites_keep_their_energy() {
    let Some((_, mut model)) = load("opposites") else { return };
    // The known error of the method, and how much more the rounding of states to singles may add: 1195 steps of 6e-8
    // each, at random, at speeds up to 2.3 times the first.
    let rounding = 5e-6;
    for (method, known) in [(Method::Symplectic, 2.9e-2), (Method::Verlet, 1.5e-3), (Method::Rk4, 2.5e-6)] {
        model.integrator = method.into();
        let mut system = begun(&model, 2);
        let start = energy(&system);
        let (mut worst, mut measured) = (0f64, 0f64);
        for frame in 1..=1194 {
            system.step(&model.scene(), Time::frame(frame, 60) - system.time());
            worst = worst.max((energy(&system) / start - 1.0).abs());
            let told = Measures::of(&system, &model.scene()).energy.total();
            measured = measured.max((told / energy(&system) - 1.0).abs());
        }
        assert_eq!((system.len(), system.time()), (2, Time::frame(199, 10)));
        assert!(worst < 1.05 * known + rounding, "{method}: {worst:e}, known {known:e}");
        assert!(worst > 0.9 * known - rounding, "{method}: {worst:e}, known {known:e}: too good to be it");
        assert!(measured < 1e-6, "{method}: the measured energy is off by {measured:e}");
    }
}

#[test]
fn the_free_end_of_the_rope_is_where_it_is_known_to_be() {
    let folder = Folder::new();
    if copy_into(&folder, ".").is_none() {
        return;
    }
    for step in ["--dt 0.001", "--dt 1/60"] {
        folder.report(&format!("rope.scn --duration 10 {step} --integrator rk4 --every 100000 --out o.csv"));
        let text = folder.read("o.csv");
        let last: Vec<f64> = text.lines().last().expect("a row").split(',').map(|x| x.parse().unwrap()).collect();
        assert_eq!((last[1], last[2]), (10.0, 20.0));
        for (x, known) in last[3..6].iter().zip([-7.7962, -11.6455, 0.0]) {
            assert!((x - known).abs() <= 0.02, "{step}: {last:?}");
        }
        let ends = text.lines().skip(22).map(|line| line.split(',').nth(4).unwrap().parse::<f64>().unwrap());
        let lowest = ends.fold(f64::INFINITY, f64::min);
        assert!((lowest + 18.7183).abs() <= 0.02, "{step}: {lowest}");
    }
}

#[test]
fn every_source_gives_birth_ten_times_a_second() {
    let Some((file, model)) = load("sources") else { return };
    assert_eq!(file.emitters.len(), 7);
    for (per_second, seconds) in [(24, 10), (60, 5), (144, 2), (1, 10)] {
        let mut system = begun(&model, 1000);
        for frame in 1..=seconds * per_second {
            system.step(&model.scene(), Time::frame(frame, per_second as u32) - system.time());
            let mut counts = [0u64; 7];
            // Each source has its own material; rows count them from one.
            system.particles().material.iter().for_each(|&number| counts[usize::from(number) - 1] += 1);
            // Ten are born in every second, the tenth at its very end; between, the clock's tick may come short of one.
            let due = 10 * frame / per_second;
            let right = |&count: &u64| count == due || (frame % per_second != 0 && count + 1 == due);
            assert!(counts.iter().all(right), "{counts:?} after {frame} frames of {per_second} a second");
        }
    }
}

#[test]
fn the_cannonball_flies_over_the_wall() {
    let Some((_, model)) = load("cannonball") else { return };
    let mut system = begun(&model, 1);
    let mut over = false;
    while system.time() < Time::from_seconds(1.0) {
        system.step(&model.scene(), Time::frame(1, 1000));
        let position = system.particles().position[0];
        over |= position.x.abs() < 0.05 && position.y > 1.0;
        let t = system.time().seconds();
        let free = -0.5 + t;
        assert!((position.x - free).abs() < 1e-4, "nothing is in its way: {position} at {t}");
    }
    assert!(over);
}
