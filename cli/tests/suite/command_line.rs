//! Arguments, exit codes, the report, the hash.

use crate::scenes::{BUSY, ONE, SOURCE};
use crate::tool::{Folder, number};
use serde_json::Value;
use std::collections::BTreeSet;

const WORLD: [&str; 7] = ["--duration", "--dt", "--integrator", "--seed", "--capacity", "--substeps", "--tolerance"];

#[test]
fn help_names_every_flag() {
    let folder = Folder::new();
    let run = ["--steps", "--every", "--out", "--report", "text", "json", ".csv", ".jsonl", ".ply", ".xyz", "rk4"];
    let render = ["--out", "--size", "--fps", "--camera", "--orbit", "--fit", ".gif", ".png", ".mp4"];
    let cases: [(&str, Vec<&str>); 5] = [
        ("", vec!["run", "render", "convert", "check", "--help", "--version"]),
        ("run", [&WORLD[..], &run].concat()),
        ("render", [&WORLD[..], &render].concat()),
        ("convert", vec![".scn", ".json"]),
        ("check", vec!["--dt", "--integrator", "--plot", ".svg", ".html", "--report", "text", "json"]),
    ];
    for (command, words) in cases {
        for args in [format!("{command} --help"), format!("{command} -h"), format!("help {command}")] {
            let help = folder.run(&args).fine().stdout;
            for word in &words {
                assert!(help.contains(word), "{args} does not say {word}:\n{help}");
            }
        }
    }
    assert!(folder.run("--version").fine().stdout.contains(env!("CARGO_PKG_VERSION")));
    assert!(folder.names().is_empty());
}

#[test]
fn usage_errors_exit_with_2() {
    let folder = Folder::with("a.scn", ONE);
    let wrong = [
        "",
        "frobnicate",
        "run",
        "run a.scn b.scn",
        "run a.scn --frobnicate",
        "run a.scn --steps 3 --duration 1",
        "run a.scn --steps -1",
        "run a.scn --steps 1.5",
        "run a.scn --steps",
        "run a.scn --every 0",
        "run a.scn --every x",
        "run a.scn --dt 0",
        "run a.scn --dt -0.1",
        "run a.scn --dt=-0.1",
        "run a.scn --dt nan",
        "run a.scn --dt inf",
        "run a.scn --dt 1/0",
        "run a.scn --duration=-1",
        "run a.scn --duration nan",
        "run a.scn --duration 1e400",
        "run a.scn --integrator leapfrog",
        "run a.scn --seed -1",
        "run a.scn --seed 18446744073709551616",
        "run a.scn --capacity -1",
        "run a.scn --capacity 1e6",
        "run a.scn --report xml",
        "run a.scn --substeps 0",
        "run a.scn --substeps -1",
        "run a.scn --substeps 1.5",
        "run a.scn --substeps many",
        "run a.scn --substeps auto --tolerance 0",
        "run a.scn --substeps auto --tolerance nan",
        "run a.scn --substeps auto --tolerance=-1",
        "check",
        "check a.scn b.scn",
        "check a.scn --dt 0",
        "check a.scn --dt nan",
        "check a.scn --dt=-1",
        "check a.scn --integrator leapfrog",
        "check a.scn --plot o.png",
        "check a.scn --plot o",
        "check a.scn --report xml",
        "run a.scn --out o.txt",
        "run a.scn --out o",
        "run a.scn --out .csv",
        "run a.scn --out",
        "render a.scn",
        "run a.scn --index tree",
        "run a.scn --collision-index hash",
        "render a.scn --out o.jpg",
        "render a.scn --out o.gif --size 0x5",
        "render a.scn --out o.gif --size big",
        "render a.scn --out o.gif --fps 0",
        "render a.scn --out o.gif --steps 5",
        "convert",
        "convert a.scn",
        "convert a.scn b.txt",
        "convert a.scn b.scn c.scn",
    ];
    for args in wrong {
        let answer = folder.run(args);
        assert_eq!(answer.code, 2, "{args}: {answer:?}");
        assert!(answer.stdout.is_empty() && !answer.stderr.is_empty(), "{args}: {answer:?}");
        assert!(!answer.stderr.contains("panicked"), "{args}: {answer:?}");
    }
    assert_eq!(folder.names(), ["a.scn"]);
}

/// A number below zero is a number: what is wrong about it is said by who knows what it should be.
#[test]
fn numbers_below_zero_are_told_what_is_allowed() {
    let folder = Folder::with("a.scn", ONE);
    let world = [
        ("--duration -1", "expected seconds, from 0 to 2147483647"),
        ("--duration -1/2", "expected seconds, from 0 to 2147483647"),
        ("--dt -1", "expected seconds, from 0 to 2147483647"),
        ("--dt -1/60", "expected seconds, from 0 to 2147483647"),
        ("--seed -1", "expected a whole number from 0 to 18446744073709551615"),
        ("--capacity -1", "-1 is not in 0..=500000000"),
        ("--substeps -2", "expected a whole number from 1 to 1000000, or auto"),
        ("--tolerance -1e-3", "expected metres, from 1e-30 to 1e30"),
        ("--threads -1", "-1 is not in 1..=1024"),
    ];
    let run = [
        ("--steps -1", "expected a whole number from 0 to 18446744073709551615"),
        ("--every -1", "expected a whole number from 1 to 18446744073709551615"),
    ];
    let render = [
        ("--size -1x5", "expected WIDTHxHEIGHT"),
        ("--fps -1", "-1 is not in 1..=1000"),
        ("--shutter -5e-1", "expected seconds, zero or more"),
    ];
    let others = [
        ("check a.scn --dt -1", "expected seconds, from 0"),
        ("lab a.scn --dt -1/60", "expected seconds, from 0"),
        ("lab a.scn --duration -1", "expected seconds, from 0"),
        ("compare --n -5", "expected a whole number of points, from 2"),
        ("compare --seed -1", "expected a whole number from 0"),
        ("compare --radius -1e-1", "expected a positive, finite radius"),
        ("compare --neighbours -1", "expected a number from 0.001"),
        ("compare --k -1", "-1 is not in 1..=64"),
        ("compare --repeat -1", "-1 is not in 1..=10000"),
        ("compare --scene a.scn --at -1", "expected seconds, from 0"),
    ];
    for (command, cases) in
        [("run a.scn", [&world[..], &run].concat()), ("render a.scn --out o.gif", [&world[..], &render].concat())]
    {
        folder.misuse(command, &cases);
    }
    for (args, expected) in others {
        folder.misuse(args, &[("", expected)]);
    }
    assert_eq!(folder.names(), ["a.scn"]);
}

/// A step is divided into N as `--help` says: each of these has the scene's own sub-steps.
#[test]
fn substeps_of_the_command_line_come_on_top_of_the_scenes() {
    let scene = |substeps: u32| {
        format!(
            r#"{{"run": {{"substeps": {substeps}, "dt": 0.125, "duration": 1}}, "forces": [{{"gravity": {{"acceleration": [0, -9, 0]}}}}],
            "particles": [{{"fixed": true}}, {{"position": [1, 0, 0]}}], "constraints": [{{"distance": {{"ends": [0, 1], "length": 1}}}}]}}"#
        )
    };
    let folder = Folder::new();
    for substeps in [1, 3] {
        folder.write(&format!("{substeps}.json"), scene(substeps));
    }
    let both = folder.hash("3.json --substeps 4");
    assert_eq!(folder.hash("3.json --dt 0.03125"), both);
    assert_ne!(folder.hash("1.json --substeps 4"), both);
    let help = folder.run("run --help").fine().stdout;
    assert!(help.contains("run.substeps"), "{help}");
}

#[test]
fn the_json_report_has_exactly_its_fields() {
    let folder = Folder::with("busy.scn", BUSY);
    let report = folder.report("busy.scn --steps 60 --seed 9 --dt 0.01 --integrator verlet");
    let fields = |value: &Value| value.as_object().expect("an object").keys().cloned().collect::<BTreeSet<_>>();
    let expected = |names: &str| names.split(' ').map(str::to_string).collect::<BTreeSet<_>>();
    let all = "scene integrator dt seed steps time substeps initial born live died refused hits contacts broken caps effort energy forces \
               momentum angular_momentum hash seconds ns_per_particle_step";
    assert_eq!(fields(&report), expected(all));
    assert_eq!(fields(&report["died"]), expected("lifetime sink density chance other nonfinite"));
    assert_eq!(fields(&report["substeps"]), expected("auto least most total beyond farthest tolerance"));
    assert_eq!(fields(&report["energy"]), expected("kinetic potential"));
    assert!(report["caps"].as_object().is_some_and(|caps| caps.values().all(Value::is_u64)), "{report}");
    for vector in ["momentum", "angular_momentum"] {
        let numbers = report[vector].as_array().expect("a vector");
        assert!(numbers.len() == 3 && numbers.iter().all(Value::is_f64), "{report}");
    }
    for count in ["seed", "steps", "initial", "born", "live", "refused", "hits"] {
        assert!(report[count].is_u64(), "{count}: {report}");
    }
    assert_eq!(report["scene"], "busy.scn");
    assert_eq!(report["integrator"], "verlet");
    assert_eq!((number(&report, "dt"), number(&report, "seed")), (0.01, 9.0));
    assert_eq!((number(&report, "steps"), number(&report, "time")), (60.0, 0.6));
    let hash = report["hash"].as_str().expect("a hash");
    assert!(hash.len() == 16 && hash.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f')), "{hash}");
    assert!(number(&report, "seconds") >= 0.0 && number(&report, "ns_per_particle_step") >= 0.0);
}

#[test]
fn neighbours_are_the_same_in_every_index() {
    let particles: Vec<_> = (0..125)
        .map(|i| serde_json::json!({"position": [f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25)]}))
        .collect();
    let law = serde_json::json!({"lennard_jones": {"epsilon": 1, "sigma": 0.95, "cutoff": 2.3}});
    let folder = Folder::with("atoms.json", serde_json::json!({"forces": [law], "particles": particles}).to_string());
    let energy = |index: &str| {
        let report = folder.report(&format!("atoms.json --dt 0.002 --steps 50 --integrator verlet --index {index}"));
        report["energy"]["kinetic"].as_f64().expect("a number")
    };
    let brute = energy("brute");
    assert!(brute > 0.1, "{brute}");
    for structure in pointmass::index::Structure::ALL {
        let found = energy(structure.name());
        assert!((found / brute - 1.0).abs() < 1e-4, "{structure}: {found}, not {brute}");
    }
}

#[test]
fn collisions_are_the_same_in_every_index() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/rain_on_mesh.json");
    let folder = Folder::with("a.scn", BUSY);
    let told = |index: &str| {
        let report = folder.report(&format!("{scene} --steps 60 --collision-index {index}"));
        assert!(report["hits"].as_u64().is_some_and(|hits| hits > 100), "{report}");
        [report["hash"].clone(), report["hits"].clone()]
    };
    let brute = told("brute");
    for structure in pointmass::rays::Structure::ALL {
        assert_eq!(told(structure.name()), brute, "{structure}");
    }
}

#[test]
fn the_error_of_far_groups_is_told_on_request() {
    let mut random = 1u32;
    let mut unit = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(random >> 8) / 16_777_216.0
    };
    let particles: Vec<_> = (0..300).map(|_| serde_json::json!({"position": [unit(), unit(), unit()]})).collect();
    let scene = |theta: f64| {
        let force = serde_json::json!({"mutual_gravity": {"constant": 1e-3, "softening": 0.05, "theta": theta}});
        serde_json::json!({"forces": [force], "particles": particles}).to_string()
    };
    let folder = Folder::with("far.json", scene(0.7));
    folder.write("all.json", scene(0.0));
    let report = folder.report("far.json --steps 2 --group-error");
    let error = &report["group_errors"][0];
    assert_eq!((&error["force"], &error["particles"]), (&"mutual_gravity".into(), &300.into()), "{report}");
    let [rms, largest] = ["rms", "largest"].map(|field| error[field].as_f64().expect("a number"));
    assert!(rms > 1e-6 && rms < 0.05 && largest > rms, "{report}");
    assert!(folder.report("far.json --steps 2").get("group_errors").is_none());
    let answer = folder.run("run all.json --steps 2 --group-error --report json");
    assert_eq!(answer.warnings(), ["--group-error does nothing: no force takes far groups as one, by a theta above 0"]);
    assert_eq!(answer.report()["group_errors"], serde_json::json!([]));
}

#[test]
fn options_for_recordings_that_nobody_makes_are_warned_of() {
    let folder = Folder::with("a.scn", ONE);
    for (options, idle) in [
        ("--every 2", "--every does nothing: add --out FILE"),
        ("--every 1 --events e.csv", "--every does nothing: add --out FILE"),
        ("--format csv", "--format does nothing: it is that of --out -"),
        ("--format csv --out o.csv", "--format does nothing: it is that of --out -"),
        ("--line particle", "--line does nothing: it is for an --out of .jsonl"),
        ("--line record --out o.csv", "--line does nothing: it is for an --out of .jsonl"),
    ] {
        assert_eq!(folder.run(&format!("run a.scn --steps 2 {options}")).warnings(), [idle], "{options}");
    }
    folder.run("run a.scn --steps 2 --every 2 --line record --out o.jsonl").fine();
    // What happened is told on standard error, beside the recording.
    let answer = folder.run("run a.scn --steps 2 --out - --format jsonl --line record");
    assert!(answer.code == 0 && !answer.stderr.contains("warning"), "{answer:?}");
}

#[test]
fn the_text_report_says_the_same() {
    let folder = Folder::with("busy.scn", BUSY);
    let text = folder.run("run busy.scn --steps 60").fine().stdout;
    let report = folder.report("busy.scn --steps 60");
    for field in ["initial", "born", "live", "hits"] {
        assert!(text.contains(&format!("{} ", report[field])), "{field} {report} {text}");
    }
    assert!(text.contains(report["hash"].as_str().expect("a hash")), "{text}");
}

#[test]
fn every_particle_is_accounted_for() {
    let folder = Folder::with("busy.scn", BUSY);
    folder.write("source.scn", SOURCE);
    let mut seen = [0.0; 3];
    for scene in ["busy.scn", "source.scn"] {
        for capacity in [0, 1, 2, 3, 40, 1000] {
            for steps in [0, 1, 17, 150] {
                let report = folder.report(&format!("{scene} --steps {steps} --capacity {capacity}"));
                let died = report["died"].as_object().expect("causes").values().filter_map(Value::as_f64).sum::<f64>();
                let (initial, born, live) =
                    (number(&report, "initial"), number(&report, "born"), number(&report, "live"));
                assert_eq!(initial + born, live + died, "{report}");
                assert!(live <= f64::from(capacity), "{report}");
                let causes = ["died/lifetime", "died/sink", "refused"].map(|cause| number(&report, cause));
                seen = [0, 1, 2].map(|i| seen[i] + causes[i]);
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 0.0), "the scenes are too quiet to show anything: {seen:?}");
}

#[test]
fn capacity_bounds_what_is_born_and_the_rest_is_counted() {
    let folder = Folder::with("source.scn", SOURCE);
    for (capacity, born, refused) in [(0, 0.0, 600.0), (100, 100.0, 500.0), (1_000_000, 600.0, 0.0)] {
        let report = folder.report(&format!("source.scn --duration 2 --capacity {capacity}"));
        let counts = ["born", "live", "refused"].map(|field| number(&report, field));
        assert_eq!(counts, [born, born, refused], "{report}");
    }
    let many: String = (0..100).map(|i| format!("particle {i} 0 0 0 0 0 1 0 0 0 0 -1\n")).collect();
    folder.write("many.scn", many + "particle_spring 3 97 1 1 1\n");
    let report = folder.report("many.scn --steps 2 --capacity 60");
    assert_eq!(["initial", "live", "refused"].map(|field| number(&report, field)), [60.0, 60.0, 40.0]);
    assert_eq!(number(&report, "caps/springs"), 1.0, "{report}");
    assert_eq!(number(&folder.report("many.scn --steps 2"), "initial"), 100.0);
}

#[test]
fn the_hash_depends_on_the_run_alone() {
    let folder = Folder::with("busy.scn", BUSY);
    let run = "busy.scn --steps 90 --seed 5";
    let hash = folder.hash(run);
    let outs = ["o.csv", "o.jsonl", "o.ply", "o.xyz"].map(|out| format!("--out {out}")).join(" ");
    for more in ["", &outs, &format!("{outs} --every 4"), &format!("{outs} --every 1000"), "--capacity 5000"] {
        assert_eq!(folder.hash(&format!("{run} {more}")), hash, "{more}");
    }
    assert_eq!(folder.hash("busy.scn --duration 1.5 --seed 5"), hash);
    assert_eq!(folder.hash("busy.scn --duration 1.5 --seed 5 --dt 1/60 --integrator rk4"), hash);
    let mut others = BTreeSet::from([hash]);
    let differently = ["--steps 91", "--steps 90 --seed 6", "--steps 90 --dt 0.01", "--steps 90 --capacity 10"];
    let methods = ["euler", "symplectic", "midpoint", "verlet"].map(|name| format!("--steps 90 --integrator {name}"));
    let differently = differently.map(str::to_string);
    for more in differently.iter().chain(&methods) {
        let seed = if more.contains("--seed") { "" } else { "--seed 5" };
        assert!(others.insert(folder.hash(&format!("busy.scn {seed} {more}"))), "{more}");
    }
}

#[test]
fn a_run_has_as_many_steps_as_fit_and_one_shorter() {
    let folder = Folder::with("a.scn", ONE);
    for (duration, dt, steps) in [
        ("10", "1/60", 600),
        ("1", "0.3", 4),
        ("0.9", "0.3", 3),
        ("2.93425", "0.001", 2935),
        ("0.05", "0.1", 1),
        ("0.05", "100", 1),
        ("0", "0.1", 0),
        ("0.6", "0.1", 6),
        ("0.600001", "0.1", 7),
        ("0.60000000001", "0.1", 6),
        ("2147483647", "2147483647", 1),
    ] {
        let report = folder.report(&format!("a.scn --duration {duration} --dt {dt}"));
        assert_eq!(number(&report, "steps"), f64::from(steps), "{duration} in steps of {dt}: {report}");
        let duration: f64 = duration.parse().expect("a number");
        assert!((number(&report, "time") - duration).abs() <= 1e-9, "{duration} in steps of {dt}: {report}");
    }
    // 0.5 m/s: the particle feels the time that the report tells.
    let csv = folder.run("run a.scn --duration 1 --dt 0.3 --out a.csv").fine();
    assert!(csv.stdout.contains("4 steps"), "{csv:?}");
    let table = folder.read("a.csv");
    let rows = table.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    for (row, [step, time, x]) in
        rows.iter().zip([[0.0, 0.0, 1.0], [1.0, 0.3, 1.15], [2.0, 0.6, 1.3], [3.0, 0.9, 1.45], [4.0, 1.0, 1.5]])
    {
        assert_eq!((row[0], row[1]), (step, time), "{table}");
        assert!((row[3] - x).abs() < 1e-6, "{table}");
    }
}

#[test]
fn settings_come_from_the_file_unless_the_command_line_says_otherwise() {
    let text =
        r#"{"run":{"duration":0.5,"dt":0.05,"integrator":"midpoint","seed":7,"capacity":2},"particles":[{},{}]}"#;
    let folder = Folder::with("a.json", text);
    let report = folder.report("a.json");
    assert_eq!(["dt", "seed", "steps", "live"].map(|field| number(&report, field)), [0.05, 7.0, 10.0, 2.0]);
    assert_eq!(report["integrator"], "midpoint");
    let report = folder.report("a.json --dt 0.1 --duration 2 --seed 8 --integrator euler --capacity 1");
    assert_eq!(["dt", "seed", "steps", "live"].map(|field| number(&report, field)), [0.1, 8.0, 20.0, 1.0]);
    assert_eq!(report["integrator"], "euler");
    // A scene that begins with more particles than its capacity has room for them all.
    folder.write("b.json", r#"{"run":{"capacity":0},"particles":[{},{},{}]}"#);
    let answer = folder.run("run b.json --steps 1 --report json");
    assert_eq!((number(&answer.report(), "live"), answer.warnings().len()), (3.0, 1), "{answer:?}");
}

#[test]
fn a_response_where_nothing_has_a_radius_is_remarked_on() {
    let folder = Folder::with("points.json", r#"{"particles": [{}]}"#);
    for name in pointmass::Response::NAMES {
        let answer = folder.run(&format!("run points.json --steps 1 --response {name}"));
        assert_eq!(answer.warnings(), ["--response does nothing: no particle of the scene has a radius"]);
    }
    folder.write("points.json", r#"{"particles": [{}], "contacts": {"impulse": {}}}"#);
    let answer = folder.run("run points.json --steps 1");
    assert_eq!(answer.warnings(), ["contacts does nothing: no particle of the scene has a radius"]);
    folder.write("ball.json", r#"{"particles": [{"radius": 0.1}]}"#);
    assert!(folder.run("run ball.json --steps 1 --response impulse").warnings().is_empty());
}

#[test]
fn the_index_decides_nothing_but_the_time() {
    let mut random = 1u32;
    let mut unit = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(random >> 8) / 16_777_216.0
    };
    let mut ball =
        || serde_json::json!({"position": [unit(), unit(), unit()], "velocity": [unit(), 0, unit()], "radius": 0.05});
    let balls: Vec<_> = (0..200).map(|_| ball()).collect();
    let folder = Folder::new();
    for (what, is_listed) in [
        (r#""contacts": {"impulse": {}}"#, false),
        (r#""contacts": {"position": {}}"#, false),
        (r#""contacts": {"force": {"stiffness": 10}}"#, true),
        (r#""forces": [{"viscosity": {"coefficient": 1, "reach": 0.3}}]"#, true),
        (r#""forces": [{"lennard_jones": {"epsilon": 1e-3, "sigma": 0.1, "cutoff": 0.3}}]"#, true),
        (r#""forces": [{"power_law": {"strength": 1e-3, "exponent": 2, "reach": 0.3}}]"#, true),
    ] {
        folder.write("a.json", format!(r#"{{{what}, "particles": {}}}"#, serde_json::Value::from(balls.clone())));
        let run = |index: &str| folder.run(&format!("run a.json --steps 20 --index {index} --report json")).report();
        let (brute, kd) = (run("brute"), run("kd"));
        assert_eq!(brute["hash"], kd["hash"], "{what}");
        let text = folder.run("run a.json --steps 20").stdout;
        let finds_near = text.contains("listed") || text.contains("looked up");
        assert_eq!(finds_near, is_listed, "{text}");
    }
}

/// The summary tells the steps that were made: a run shorter than a step is one of its own length, and a remainder is told.
#[test]
fn steps_are_told_as_they_were_made() {
    let folder = Folder::with("a.json", r#"{"particles": [{}]}"#);
    for (args, told) in [
        ("--dt 60 --duration 2", "1 step of 2.000000 s by"),
        ("--dt 0.5 --duration 2", "4 steps of 0.500000 s by"),
        ("--dt 0.3 --duration 1", "4 steps of 0.300000 s, the last of 0.100000 s, by"),
        ("--dt 1/60 --duration 10", "600 steps of 0.016667 s by"),
        ("--dt 0.5 --steps 1", "1 step of 0.500000 s by"),
        ("--dt 0.5 --steps 0", "0 steps of 0.500000 s by"),
    ] {
        let answer = folder.run(&format!("run a.json {args}"));
        assert!(answer.stdout.contains(told), "{args}: {}", answer.stdout);
    }
}
