//! What `check` and the warnings of `run` say of forces by how fast and how near to each other particles start, and of what they do not look at.

use crate::pace::BULLET;
use crate::tool::{Folder, number};
use serde_json::Value;

/// Two of 1 kg that drag each other along by 10 kg/s.
const TREACLE: &str = r#"{"run": {"duration": 1, "dt": 0.05, "integrator": "euler"},
    "particles": [{"velocity": [0, 1e-6, 0]}, {"position": [0.5, 0, 0]}],
    "forces": [{"viscosity": {"coefficient": 20, "reach": 1}}]}"#;

/// The largest steps by explicit Euler that a check tells of drag, and what it advises.
fn judged(folder: &Folder, text: &str) -> (f64, String) {
    folder.write("a.json", text);
    let check = folder.run("check a.json --integrator euler --report json").fine().report();
    let euler = check["methods"].as_array().expect("methods").iter().find(|stand| stand["method"] == "euler");
    (number(euler.expect("the method"), "drag/step"), check["advice"].to_string())
}

#[test]
fn drag_by_the_square_of_the_speed_is_judged_as_fast_as_particles_start_and_fall() {
    let folder = Folder::new();
    // 2 m over 2 k v.
    let (step, advice) = judged(&folder, BULLET);
    assert!((step / (0.01 / (0.01 * 800.0)) - 1.0).abs() < 1e-6, "{step}");
    assert!(advice.contains("may explode") && advice.contains("first 8 s: quadratic drag;"), "{advice}");
    let warnings = folder.run("run a.json --steps 1").warnings().join(" ");
    assert!(warnings.contains("because of particles[0] of drag 16 kg/s as it starts"), "{warnings}");
    assert!(folder.run("run a.json --steps 2 --substeps 100").warnings().is_empty());
    // At last a kilogram falls with 10 m/s.
    let falling = r#"{"particles": [{}],
        "forces": [{"quadratic_drag": {"coefficient": 0.1}}, {"gravity": {"acceleration": [0, -10, 0]}}]}"#;
    assert!((judged(&folder, falling).0 - 1.0).abs() < 1e-6);
    let born = r#"{"emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "rate": 1,
        "speed": {"mean": 6, "half_width": 2}, "velocity": [3, 0, 4], "inherit": 0.4}],
        "forces": [{"quadratic_drag": {"coefficient": 0.1}}]}"#;
    assert!((judged(&folder, born).0 - 1.0).abs() < 1e-6);
}

#[test]
fn viscosity_is_judged_as_near_as_particles_start() {
    let folder = Folder::new();
    let (step, advice) = judged(&folder, TREACLE);
    assert!((step - 0.1).abs() < 1e-6 && advice.contains("first 8 s: viscosity;"), "{step} {advice}");
    // What there is left of their difference grows beyond that.
    for (dt, grows, warnings) in [(0.095, false, 0), (0.105, true, 1)] {
        let answer = folder.run(&format!("run a.json --steps 50 --dt {dt} --report json"));
        assert_eq!(answer.warnings().len(), warnings, "{answer:?}");
        let report: Value = serde_json::from_str(&answer.stdout).expect("JSON");
        assert_eq!(number(&report, "energy/kinetic") > 0.5e-12, grows, "{report}");
    }
    // Nobody knows who will be born among whom.
    let source = r#""emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "rate": 1}], "forces""#;
    folder.write("a.json", TREACLE.replace("\"forces\"", source));
    let text = folder.run("check a.json").fine().stdout;
    assert!(text.contains("not looked at: viscosity") && !text.contains("particles start"), "{text}");
}

#[test]
fn steps_are_not_called_stable_for_forces_that_nobody_looks_at() {
    let folder = Folder::with(
        "a.json",
        r#"{"particles": [{"charge": 1e-9}, {"position": [1, 0, 0]}], "forces": [{"coulomb": {}}]}"#,
    );
    let text = folder.run("check a.json").fine().stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("not known") && text.contains("others do"), "{text}");
    assert!(!text.contains("any stable") && !text.contains("or any other"), "{text}");
}

#[test]
fn drag_below_zero_is_warned_of() {
    let folder = Folder::with("a.json", r#"{"particles": [{}, {"drag": -0.5}], "forces": [{"drag": {}}]}"#);
    let warnings = folder.run("run a.json --steps 1").warnings().join(" ");
    assert!(warnings.contains("a.json:particles[1] has a drag of -0.5 kg/s: below zero it adds energy"), "{warnings}");
    // All of it is said once, and of no springs.
    folder.write("c.json", r#"{"particles": [{"velocity": [1, 0, 0], "drag": -5}], "forces": [{"drag": {}}]}"#);
    let pushed = "c.json:particles[0] has a drag of -5 kg/s: below zero it adds energy, take one of zero or above";
    assert_eq!(folder.run("run c.json").warnings(), [pushed]);
    let text = folder.run("check c.json").fine().stdout;
    assert!(text.contains("drag below zero adds energy, and no step is stable") && !text.contains("a kd"), "{text}");
    // Without the force it does nothing.
    folder.write("b.json", r#"{"particles": [{"drag": -0.5}]}"#);
    let idle = "b.json:particles[0].drag: -0.5 brakes nobody, for no force looks at it; add drag or wind to the forces, or take 0";
    assert_eq!(folder.run("run b.json --steps 1").warnings(), [idle]);
}

#[test]
fn what_sub_steps_take_of_a_soft_body_s_swing_is_told() {
    let scene = |substeps: u32| {
        format!(
            r#"{{"run": {{"duration": 1, "dt": 0.01, "substeps": {substeps}}}, "soft_bodies": [{{"form": {{"box": [0.2, 0.2, 0.2]}},
                "spacing": 0.05, "density": 1000, "frequency": 3, "damping": 0, "position": [0, 0, 0]}}]}}"#
        )
    };
    let folder = Folder::new();
    let told = |substeps: u32| {
        folder.write("a.json", scene(substeps));
        folder.run("check a.json").fine().stdout.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let [long, short] = [1, 100].map(told);
    assert!(long.contains("a second takes") && long.contains("% of its swing"), "{long}");
    assert!(!short.contains("of its swing") || short.contains("a second takes 1."), "{short}");
}

#[test]
fn newborn_that_drag_throws_back_are_warned_of_whatever_the_method() {
    let folder = Folder::new();
    let born = r#"{"run": {"duration": 0.2, "dt": 0.01, "substeps": 2}, "emitters": [{"shape": {"line": {"from": [0, 0, 0], "to": [0, 0, 0]}},
        "rate": 97, "speed": 6, "direction": [0, 1, 0], "drag": 900}], "forces": [{"drag": {}}]}"#;
    folder.write("a.json", born);
    for method in ["implicit", "adaptive", "embedded"] {
        let lowest = |args: &str| {
            folder.run(&format!("run a.json --integrator {method} --out a.csv {args}"));
            let text = folder.read("a.csv");
            let column = text.lines().next().and_then(|head| head.split(',').position(|name| name == "vy"));
            let speeds = text.lines().skip(1).filter_map(|line| line.split(',').nth(column?)?.parse().ok());
            speeds.fold(f64::INFINITY, f64::min)
        };
        let told = |args: &str| folder.run(&format!("run a.json --integrator {method} {args}")).warnings().join(" ");
        assert!(
            told("").contains("a.json:emitters[0] of drag 900 kg/s and mass 1 kg: the newborn fly"),
            "{}",
            told("")
        );
        assert!(told("").contains("take --substeps 9,"), "{}", told(""));
        assert!(told("--substeps 5").is_empty() && lowest("--substeps 5") > -1e-3, "{method}");
        assert!(lowest("") < -1.0, "{method}");
        let check = folder.run(&format!("check a.json --integrator {method}")).fine().stdout;
        assert!(check.contains("the newborn fly"), "{check}");
    }
    folder.write("a.json", born.replace("900", "300"));
    assert!(folder.run("run a.json --integrator implicit").warnings().is_empty());
}
