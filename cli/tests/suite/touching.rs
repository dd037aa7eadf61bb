//! Contacts by force and the step: what `check` and `run` say, held against the energy of hits.

use crate::tool::{Folder, number};
use serde_json::{Value, json};

const STEPPERS: [&str; 5] = ["euler", "symplectic", "midpoint", "verlet", "rk4"];

/// Two balls that fly into each other in one line.
fn two(masses: [f64; 2], penalty: &Value) -> Value {
    let ball =
        |x: f64, v: f64, mass: f64| json!({"position": [x, 0, 0], "velocity": [v, 0, 0], "radius": 0.1, "mass": mass});
    json!({
        "run": {"duration": 2},
        "contacts": {"force": penalty},
        "particles": [ball(-0.3, 1.0, masses[0]), ball(0.31, -0.7, masses[1])],
    })
}

/// What `run` warns of, and by how much the kinetic energy grows at the most over several ways for steps to fall.
fn run(folder: &Folder, scene: &Value, args: &str) -> (Vec<String>, f64) {
    let (mut most, mut warnings) = (0.0f64, Vec::new());
    for shift in 0..2 {
        let mut scene = scene.clone();
        scene["particles"][0]["position"][0] = json!(-0.3 - 0.0013 * f64::from(shift));
        folder.write("a.json", scene.to_string());
        let answer = folder.run(&format!("run a.json --report json {args}"));
        let energy = |ball: &Value| {
            0.5 * ball["mass"].as_f64().unwrap_or(1.0) * ball["velocity"][0].as_f64().unwrap_or(0.0).powi(2)
        };
        let before: f64 = scene["particles"].as_array().expect("balls").iter().map(energy).sum();
        most = most.max(number(&answer.report(), "energy/kinetic") / before);
        warnings = answer.warnings().into_iter().map(String::from).collect();
    }
    (warnings, most)
}

fn stable(folder: &Folder, args: &str, method: &str) -> bool {
    let check: Value = folder.run(&format!("check a.json --report json {args}")).fine().report();
    let stands = check["methods"].as_array().expect("methods").iter().find(|stand| stand["method"] == method);
    stands.and_then(|stand| stand["stable"].as_bool()).expect("a verdict")
}

#[test]
fn energy_never_grows_unwarned() {
    let folder = Folder::new();
    let mut seen = [0, 0];
    for (masses, stiffness, damping) in [([1.0, 1.0], 2e4, 0.0), ([0.05, 3.0], 500.0, 0.1), ([2.0, 0.4], 5e3, 0.6)] {
        let scene = two(masses, &json!({"stiffness": stiffness, "damping": damping}));
        let omega = (stiffness * (1.0 / masses[0] + 1.0 / masses[1])).sqrt();
        for method in STEPPERS {
            for part in [0.05, 0.25, 1.0, 1.8, 3.0] {
                let args = format!("--integrator {method} --dt {}", part / omega);
                let (warnings, growth) = run(&folder, &scene, &args);
                let is_stable = stable(&folder, &format!("--dt {}", part / omega), method);
                assert!(growth < 1.1 || !warnings.is_empty(), "{args}: {growth}, unwarned");
                // On average over how steps fall; in single hits a coarse step may gain.
                assert!(growth < 1.2 || !is_stable, "{args}: {growth}, and yet stable");
                assert!(part > 0.31 || method == "euler" || (warnings.is_empty() && is_stable), "{args}: {warnings:?}");
                seen[usize::from(warnings.is_empty())] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&count| count > 15), "{seen:?}");
}

#[test]
fn a_step_that_explodes_is_told_by_every_way_to_ask_for_force() {
    let folder = Folder::new();
    let scene = two([1.0, 1.0], &json!({"stiffness": 2e4}));
    for method in STEPPERS {
        let (warnings, growth) = run(&folder, &scene, &format!("--integrator {method} --dt 1/60"));
        assert!(growth > 2.0 && warnings.len() == 1, "{method}: {growth}");
        for word in ["contacts", "particles[0]", "particles[1]", "stiffness 20000", "--substeps auto"] {
            assert!(warnings[0].contains(word), "no {word}: {warnings:?}");
        }
        assert!(!stable(&folder, "--dt 1/60", method), "{method}");
        let (warnings, growth) = run(&folder, &scene, &format!("--integrator {method} --dt 1/60 --substeps auto"));
        assert!(growth < 1.05 && warnings.is_empty(), "{method}: {growth} {warnings:?}");
        // The scene's own settings, asked for by name; those of a name alone suit the step.
        folder.write("a.json", scene.to_string());
        let own = folder.run(&format!("run a.json --integrator {method} --response force --steps 2 --dt 1/60"));
        assert_eq!(own.warnings().len(), 1, "{method}");
        let mut free = scene.clone();
        free.as_object_mut().expect("an object").remove("contacts");
        folder.write("a.json", free.to_string());
        let named = folder.run(&format!("run a.json --integrator {method} --response force --steps 2 --dt 1/60"));
        assert_eq!(named.warnings().len(), usize::from(method == "euler"), "{named:?}");
    }
    for method in ["adaptive", "embedded"] {
        let (warnings, growth) = run(&folder, &scene, &format!("--integrator {method} --dt 1/60"));
        assert!(growth < 1.02 && warnings.is_empty(), "{method}: {growth} {warnings:?}");
    }
    let mut free = scene;
    free.as_object_mut().expect("an object").remove("contacts");
    folder.write("a.json", free.to_string());
    let text = folder.run("check a.json --dt 1/60").fine().stdout;
    assert!(!text.contains("touching"), "without a response there is none: {text}");
}

#[test]
fn the_lightest_pair_counts_also_of_the_newborn_and_the_fixed() {
    let folder = Folder::new();
    let ball = |mass: f64, fixed: bool| json!({"radius": 0.1, "mass": mass, "fixed": fixed, "position": [mass, 0, 0]});
    let born = json!({"shape": {"sphere": {"center": [0, 9, 0], "radius": 1}}, "rate": 5, "radius": 0.1,
        "mass": {"mean": 0.3, "half_width": 0.1}});
    let limit = |particles: Vec<Value>, emitters: Vec<Value>| {
        let scene = json!({"contacts": {"force": {"stiffness": 1000}}, "particles": particles, "emitters": emitters});
        folder.write("a.json", scene.to_string());
        let check = folder.run("check a.json --report json").fine().report();
        let name = check["touching"]["place"].as_str().unwrap_or_default().to_string();
        (number(&check, "touching/mode/omega2"), name)
    };
    let close = |found: f64, known: f64| (found / known - 1.0).abs() < 1e-5;
    let (omega2, name) = limit(vec![ball(4.0, false), ball(0.5, false), ball(2.0, false)], Vec::new());
    assert!(close(omega2, 2500.0) && name == "particles[1]", "{omega2} {name}");
    let (omega2, name) = limit(vec![ball(4.0, true), ball(0.5, false)], Vec::new());
    assert!(close(omega2, 2000.0) && name == "particles[1]", "{omega2} {name}");
    let (omega2, name) = limit(vec![ball(4.0, false), ball(0.5, false)], vec![born.clone()]);
    assert!(close(omega2, 10_000.0) && name == "emitters[0]", "{omega2} {name}");
    let (omega2, _) = limit(vec![ball(0.1, false)], vec![born]);
    assert!(close(omega2, 15_000.0), "{omega2}");
    // One alone has nothing to touch.
    folder.write(
        "a.json",
        json!({"contacts": {"force": {"stiffness": 1e9}}, "particles": [ball(1.0, false)]}).to_string(),
    );
    folder.run("run a.json --steps 2").fine();
}

#[test]
fn heaps_bounded_by_check_stay_at_rest() {
    // A lattice of touching balls, pressed together: each has twelve neighbours.
    let spacing = 0.2;
    let mut particles = Vec::new();
    for (i, j, k) in (0..64).map(|n| (n % 4, n / 4 % 4, n / 16)) {
        if (i + j + k) % 2 == 0 {
            let at = [i, j, k].map(|n| f64::from(n) * spacing / 2f64.sqrt() * 0.99);
            particles.push(json!({"position": at, "radius": 0.1, "mass": 0.5}));
        }
    }
    let folder = Folder::new();
    let scene = json!({"run": {"duration": 1}, "contacts": {"force": {"stiffness": 1000, "damping": 0.05}}, "particles": particles});
    folder.write("a.json", scene.to_string());
    let check = folder.run("check a.json --report json").fine().report();
    let pressed = 0.5 * 1000.0 * 0.002f64.powi(2) * 6.0 * particles.len() as f64;
    for stand in check["methods"].as_array().expect("methods") {
        let method = stand["method"].as_str().expect("a name");
        let Some(step) = stand["contact"]["step"].as_f64() else { continue };
        let report =
            folder.run(&format!("run a.json --integrator {method} --dt {} --report json", 0.99 * step)).report();
        let kinetic = number(&report, "energy/kinetic");
        assert!(kinetic < pressed, "{method}: {kinetic} J of {pressed} J in steps of {step}");
    }
}
