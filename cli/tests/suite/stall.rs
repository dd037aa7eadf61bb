//! Steps too short for where a scene is: `check` foresees them, `run` warns of them and counts them.

use crate::tool::{Folder, number};

fn scene(position: [f32; 3], velocity: [f32; 3], gravity: f32, dt: f64) -> String {
    format!(
        r#"{{"run": {{"dt": {dt}, "duration": 1}}, "forces": [{{"gravity": {{"acceleration": [0, {gravity}, 0]}}}}],
            "particles": [{{"position": {position:?}, "velocity": {velocity:?}}}]}}"#
    )
}

#[test]
fn steps_that_rounding_swallows_are_foreseen_warned_of_and_counted() {
    for (at, scene, args, least) in [
        ("x = 1000", scene([1000.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0, 2e-5), "", 50_000.0),
        ("z = 200000", scene([1.0, 0.0, -2e5], [0.0, 0.0, 2.0], 0.0, 1e-3), "", 1000.0),
        ("y = 1000", scene([0.0, 1000.0, 0.0], [0.0; 3], -9.80665, 1.0 / 60.0), " --substeps 1024", 10_000.0),
    ] {
        let folder = Folder::with("far.json", scene);
        let answer = folder.run(&format!("run far.json --report json{args}"));
        let warnings = answer.warnings();
        assert!(warnings.len() == 2 && warnings[0].contains(&format!("too short at {at}:")), "{warnings:?}");
        assert!(warnings[1].starts_with("rounding swallowed motion in "), "{warnings:?}");
        assert!(number(&answer.report(), "caps/stalled") >= least, "{}", answer.stdout);
        let check = folder.run("check far.json").fine().stdout;
        assert_eq!(check.contains("are too short at"), args.is_empty(), "{check}");
    }
}

#[test]
fn steps_that_lead_on_are_not() {
    for scene in [
        scene([1000.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0, 1e-2),
        scene([1.0, 10.0, 1.0], [0.0; 3], -9.80665, 1e-4),
        scene([1000.0; 3], [0.0; 3], 0.0, 1e-3),
        scene([1000.0; 3], [1e-4; 3], -9.80665, 1.0 / 60.0),
    ] {
        let folder = Folder::with("near.json", &scene);
        let report = folder.run("run near.json --report json").fine().report();
        assert!(number(&report, "caps/stalled") <= 0.01 * number(&report, "steps"), "{report}");
        assert!(!folder.run("check near.json").fine().stdout.contains("too short"), "{scene}");
    }
}
