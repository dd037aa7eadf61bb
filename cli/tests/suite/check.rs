//! `check`, the warnings of `run`, and sub-steps.

use crate::course;
use crate::scenes::{BUSY, ONE, SOURCE};
use crate::tool::{Folder, number};
use serde_json::{Value, json};
use std::fs;

/// A rope of nine metres between particles of 1 kg, the first fixed, lying flat.
fn rope(kd: f32) -> String {
    let particle = |i: u32| format!("particle {i} 0 0  0 0 0  1 {} 0 0 0 -1\n", u32::from(i == 0));
    let spring = |i: u32| format!("particle_spring {i} {} 1 100 {kd}\n", i + 1);
    let parts = (0..10).map(particle).chain((0..9).map(spring)).collect::<String>();
    format!("particle_gravity 0 -9.80665 0\n{parts}")
}

/// What `check` says of a method, in milliseconds.
fn steps(check: &Value, column: &str, methods: &[&str]) -> Vec<f64> {
    let of = |name: &&str| {
        let all = check["methods"].as_array().expect("methods");
        let one = all.iter().find(|one| one["method"] == **name).expect("the method");
        one[column]["step"].as_f64().unwrap_or_else(|| panic!("{name}: {one}")) * 1e3
    };
    methods.iter().map(of).collect()
}

fn check(folder: &Folder, args: &str) -> Value {
    folder.run(&format!("check {args} --report json")).fine().report()
}

#[test]
fn the_course_s_springs_have_their_known_limits() {
    let folder = Folder::new();
    if course::copy_into(&folder, ".").is_none() {
        return;
    }
    let methods = ["euler", "midpoint", "symplectic", "rk4"];
    for (scene, known) in [
        ("rope", [26.97, 26.97, 23.74, 37.55]),
        ("swirl", [50.4, 50.4, 50.2, 70.2]),
        ("tetra", [26.8, 26.8, 23.6, 37.3]),
    ] {
        let check = check(&folder, &format!("{scene}.scn"));
        for (found, known) in steps(&check, "at_rest", &methods).into_iter().zip(known) {
            assert!((found / known - 1.0).abs() < 2e-3, "{scene}: {found}, not {known}");
        }
        let all = methods.iter().zip(steps(&check, "every_pose", &methods));
        for ((method, pose), rest) in all.zip(steps(&check, "at_rest", &methods)) {
            assert!(pose <= rest, "{scene} {method}: {pose} {rest}");
        }
    }
    let rope = check(&folder, "rope.scn --dt 1/30 --integrator midpoint");
    for (found, known) in steps(&rope, "every_pose", &methods).into_iter().zip([26.79, 26.79, 23.61, 37.32]) {
        assert!((found - known).abs() < 0.005, "{found}, not {known}");
    }
    let text = folder.run("check rope.scn --dt 1/30 --integrator midpoint").fine().stdout;
    for word in ["springs[1]", "between particles 1", "ks 100", "--substeps 2", "--dt 0.0267", "26.97 ms"] {
        assert!(text.contains(word), "no {word}:\n{text}");
    }
    // Where the step is stable, taut springs still grow across by some methods.
    let text = folder.run("check rope.scn --dt 1/60 --integrator midpoint").fine().stdout;
    assert!(text.contains("taut springs grow"), "{text}");
}

#[test]
fn every_scene_of_the_course_is_checked() {
    let folder = Folder::new();
    for scene in course::copy_into(&folder, ".").iter().flatten() {
        let check = check(&folder, &format!("{scene}.scn"));
        assert_eq!(check["methods"].as_array().map(Vec::len), Some(pointmass::Method::ALL.len()), "{check}");
        assert!(check["advice"].as_array().is_some_and(|advice| !advice.is_empty()), "{check}");
    }
}

#[test]
fn what_is_no_spring_is_told_as_well() {
    let folder = Folder::with("busy.scn", BUSY);
    folder.write("source.scn", SOURCE);
    let text = folder.run("check busy.scn").fine().stdout;
    for word in ["drag", "hits", "sink", "springs[0]", "emitters"] {
        assert!(text.contains(word), "no {word}:\n{text}");
    }
    let text = folder.run("check source.scn --dt 0.5").fine().stdout;
    assert!(text.contains("neither springs nor drag") && !text.contains("NaN"), "{text}");
    let braked = "particle_gravity 0 -9.8 0\nparticle 0 0 0 0 0 0 2 0 50 0 0 -1\nbox -1 0 -9 0 1 -8 1\n";
    folder.write("braked.scn", braked);
    let report = check(&folder, "braked.scn --dt 0.1 --integrator symplectic");
    // 2 m/k, and 8 chords of a tenth of a millimetre.
    assert!((steps(&report, "drag", &["symplectic"])[0] - 80.0).abs() < 1e-6, "{report}");
    assert!((number(&report, "followed/step") - 0.0723).abs() < 1e-4, "{report}");
    assert_eq!(folder.run("run braked.scn --dt 0.1 --integrator symplectic").warnings().len(), 1);
    let pair = r#"{"run": {"duration": 10}, "forces": [{"mutual_gravity": {"constant": 1}}],
        "particles": [{"mass": 2}, {"mass": 2, "position": [1, 0, 0]}]}"#;
    folder.write("pair.json", pair);
    let report = check(&folder, "pair.json --dt 0.1");
    assert!((number(&report, "pair/period") - std::f64::consts::PI).abs() < 1e-6, "{report}");
    assert!(report["advice"].to_string().contains("--dt 0.0628"), "{report}");
}

#[test]
fn sinks_are_as_steep_as_their_law_says() {
    let folder = Folder::new();
    let scene = |law: &str| {
        format!(
            r#"{{"particles": [{{"position": [1, 0, 0], "mass": 0.5}}],
            "sinks": [{{"intensity": 10, {law}, "shape": {{"sphere": {{"center": [0, 0, 0], "radius": 0.001}}}}}}]}}"#
        )
    };
    for (law, gradient) in [
        // I / s³ and I / (s (ca + s²)).
        (r#""ca": 0, "la": 0, "qa": 1, "softening": 0.01"#, 1e7),
        (r#""ca": 1, "la": 0, "qa": 1, "softening": 0.01"#, 1e3 / 1.0001),
        // I √27 / 8 where D² is a third.
        (r#""ca": 1, "la": 0, "qa": 1"#, 10.0 * 27f64.sqrt() / 8.0),
        (r#""ca": 2, "la": 3, "qa": 0"#, 7.5),
    ] {
        folder.write("a.json", scene(law));
        let report = check(&folder, "a.json");
        assert!((number(&report, "sinks/0/gradient") / gradient - 1.0).abs() < 1e-6, "{law}: {report}");
        assert!((number(&report, "sinks/0/rate") / (2.0 * gradient).sqrt() - 1.0).abs() < 1e-6, "{law}: {report}");
    }
    for (law, words) in [
        (r#""ca": 0, "la": 0, "qa": 1"#, ["has no bound at its surface", "give it a softening, or a ca above zero"]),
        (r#""ca": 0, "la": 2, "qa": 0"#, ["has no bound at its surface", "give it a softening, or a ca above zero"]),
        (r#""ca": 1, "la": -2, "qa": 0"#, ["has no bound 0.5 m from its surface", "ca + la D + qa D² is zero"]),
    ] {
        folder.write("a.json", scene(law));
        let text = folder.run("check a.json").stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.iter().all(|word| text.contains(word)), "{law}: {text}");
    }
    // What pulls everywhere alike does not change, and what divides by nothing but zeros pulls nobody.
    for law in [r#""ca": 1, "la": 0, "qa": 0"#, r#""ca": 0, "la": 0, "qa": 0"#] {
        folder.write("a.json", scene(law));
        assert!(!folder.run("check a.json").stdout.contains("sink"), "{law}");
    }
}

#[test]
fn what_only_other_poses_do_not_stand_is_told_so() {
    let folder = Folder::new();
    if course::copy_into(&folder, ".").is_none() {
        return;
    }
    let args = "tetra.scn --dt 1/60 --integrator symplectic";
    let report = check(&folder, args);
    let verdict = |name: &str| {
        let one = report["methods"].as_array().into_iter().flatten().find(|one| one["method"] == name);
        one.map(|one| (one["stable"].clone(), one["verdict"].clone())).expect("the method")
    };
    assert_eq!(verdict("symplectic"), (json!(false), json!("not_in_every_pose")));
    assert_eq!(verdict("rk4"), (json!(true), json!("stable")));
    assert_eq!(verdict("adaptive"), (json!(true), json!("chooses_its_own_steps")));
    let text = folder.run(&format!("check {args} --out a.csv")).fine().stdout;
    assert!(text.contains("any  not in every pose\n") && text.contains("are not stable in every pose"), "{text}");
    assert!(folder.read("a.csv").contains(",not_in_every_pose\n"), "{}", folder.read("a.csv"));
    let text = folder.run("check tetra.scn --dt 1/30 --integrator symplectic").fine().stdout;
    assert!(text.contains("any  unstable\n") && text.contains("explode"), "{text}");
}

#[test]
fn many_oscillations_are_bounded_from_above() {
    let particle = |i: u32| format!("particle {} 0 {} 0 0 0 1 {} 0 0 0 -1\n", i % 15, i / 15, u32::from(i == 0));
    let row = (0..224).filter(|i| i % 15 != 14).map(|i| [i, i + 1]).chain((0..210).map(|i| [i, i + 15]));
    let spring =
        |[a, b]: [u32; 2]| format!("particle_spring {a} {b} 1 {} {}\n", 50 + a % 7, f64::from(b % 5) * 0.2 + 0.1);
    let scene: String = (0..225).map(particle).chain(row.map(spring)).collect();
    let folder = Folder::with("a.scn", scene);
    let text = folder.run("check a.scn").fine().stdout;
    for (name, words) in [("euler", "at most"), ("rk4*", "at most"), ("symplectic", ""), ("implicit", "any")] {
        let line = text.lines().find(|line| line.trim_start().starts_with(name)).expect("a row");
        let rest = line.trim_start().strip_prefix(name).unwrap_or_default().trim_start();
        assert!(rest.starts_with(words) && rest.contains("at most") == (words == "at most"), "{text}");
    }
}

#[test]
fn constraints_are_told_and_bound_sub_steps() {
    // Twenty rigid links of a tenth of a metre hang straight down: the first is too long by 19 g h².
    let particle = |i: u32| format!(r#"{{"position": [0, {}, 0], "fixed": {}}}"#, -0.1 * f64::from(i), i == 0);
    let link = |i: u32| format!(r#"{{"distance": {{"ends": [{i}, {}], "length": 0.1}}}}"#, i + 1);
    let [particles, links] = [(0..=20).map(particle).collect(), (0..20).map(link).collect::<Vec<_>>()];
    let particles: Vec<String> = particles;
    let scene = |substeps: u32| {
        format!(
            r#"{{"run": {{"duration": 1, "dt": 0.01, "substeps": {substeps}}}, "forces": [{{"gravity": {{"acceleration": [0, -10, 0]}}}}],
                "particles": [{}], "constraints": [{}]}}"#,
            particles.join(", "),
            links.join(", ")
        )
    };
    let folder = Folder::with("few.json", scene(2));
    folder.write("many.json", scene(10));
    let few = check(&folder, "few.json");
    let enough = (0.01f64 / (190.0 / 0.1)).sqrt();
    assert!((number(&few, "holds/0/owes") / 1900.0 - 1.0).abs() < 2e-3, "{few}");
    assert!(few["advice"].to_string().contains("into 5 (`run.substeps`)"), "{few}");
    for word in ["constraints[0] and 19 more", "distance", "rigid", "each in 2 sub-steps", "4.75 % too long"] {
        let text = folder.run("check few.json").fine().stdout;
        assert!(text.contains(word), "no {word}:\n{text}");
    }
    let page = folder.run("check many.json --out o.html").fine().stdout;
    assert!(!page.contains("% longer") && folder.read("o.html").contains("What holds together"), "{page}");
    let answer = folder.run("run few.json --steps 3");
    let warnings = answer.warnings();
    assert!(warnings.len() == 1 && warnings[0].contains("hang up to 4.75 %"), "{warnings:?}");
    assert!(folder.run("run few.json --steps 3 --substeps 4").warnings().is_empty());
    let auto = folder.run("run few.json --steps 3 --substeps auto --tolerance 1 --report json").fine().report();
    assert!(number(&auto, "substeps/least") >= (0.01 / (2.0 * enough)).ceil(), "{auto}");
}

#[test]
fn piles_of_boxes_sink_by_what_is_told() {
    let folder = Folder::new();
    for (count, side) in [(1, 0.1), (2, 0.3), (3, 0.2), (5, 0.018), (10, 0.2), (14, 0.4), (20, 0.3)] {
        let place = |i: u32| side * (f64::from(i) + 0.5);
        let one = |i: u32| json!({"sides": [side, side, side], "mass": 0.3, "position": [0, place(i), 0]});
        let scene = json!({
            "run": {"duration": 4, "dt": 1.0 / 60.0, "substeps": 3},
            "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}],
            "scenery": [{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}],
            "boxes": (0..count).map(one).collect::<Vec<_>>(),
        });
        folder.write("a.json", scene.to_string());
        let told = number(&check(&folder, "a.json"), "holds/0/owes") * 180f64.powi(-2) * side;
        assert_eq!(folder.run("run a.json --every 1000000 --out o.csv").code, 0);
        let sheet = folder.read("o.csv");
        let heights: Vec<f64> = sheet
            .lines()
            .rev()
            .take(8 * count as usize)
            .map(|line| line.split(',').nth(4).and_then(|y| y.parse().ok()).expect("a height"))
            .collect();
        let mut middles: Vec<f64> = heights.chunks(8).map(|points| points.iter().sum::<f64>() / 8.0).collect();
        middles.push(-0.5 * side);
        let most = middles.windows(2).map(|pair| side - (pair[0] - pair[1])).fold(0.0, f64::max);
        let mut coarse = scene.clone();
        coarse["run"]["substeps"] = json!(1);
        folder.write("coarse.json", coarse.to_string());
        let text = folder.run("check coarse.json").stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(text.contains(&format!("a pile of {count} sinks")), count > 1, "{text}");
        assert_eq!(text.contains("may fall through itself"), count == 5, "{text}");
        match count {
            1 => assert!(told == 0.0 && most < 1e-6, "{told} {most}"),
            _ => assert!(most > 0.9 * told && most < 1.1 * told, "{count} of {side} m: {most} for {told}"),
        }
    }
}

#[test]
fn boxes_that_turn_far_where_they_fall_are_remarked_on() {
    let folder = Folder::new();
    for (side, rate, substeps, is_told) in [
        (0.016, 24.0, 1, true),
        (0.016, 60.0, 1, true),
        (0.1, 24.0, 2, true),
        (0.1, 24.0, 3, false),
        (0.016, 60.0, 6, false),
        (0.5, 60.0, 2, false),
    ] {
        let scene = json!({
            "run": {"duration": 1, "dt": 1.0 / rate, "substeps": substeps},
            "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}],
            "boxes": [{"sides": [side, side, side], "mass": 0.3, "position": [0, 1, 0]}],
        });
        folder.write("a.json", scene.to_string());
        let checked = folder.run("check a.json").stdout.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(checked.contains("sink into what they strike"), is_told, "{side} {rate} {substeps}: {checked}");
        let ran = folder.run("run a.json --steps 1 --out o.csv");
        assert_eq!((ran.code, ran.stderr.contains("sink into what")), (0, is_told), "{}", ran.stderr);
    }
}

#[test]
fn odd_scenes_are_checked_too() {
    let folder = Folder::new();
    let two = "particle 0 0 0 0 0 0 1 0 0 0 0 -1 particle 1 0 0 0 0 0 1 0 0 0 0 -1\n";
    let held = "particle 0 0 0 0 0 0 1 1 0 0 0 -1 particle 1 0 0 0 0 0 1 1 0 0 0 -1\n";
    let same = "particle 0 0 0 0 0 0 1 0 0 0 0 -1 particle 0 0 0 0 0 0 1 0 0 0 0 -1\n";
    for text in [
        String::new(),
        ONE.into(),
        format!("{two}particle_spring 0 1 1 0 0"),
        format!("{two}particle_spring 0 1 1 -5 0"),
        format!("{two}particle_spring 0 1 1 5 -1"),
        format!("{two}particle_spring 0 0 1 5 1"),
        format!("{two}particle_spring 0 1 1 1e38 1e38"),
        format!("{two}particle_spring 0 1 1 1e-38 0"),
        format!("{held}particle_spring 0 1 1 5 1"),
        format!("{same}particle_spring 0 1 1 5 1"),
        "particle 0 0 0 0 0 0 1e-38 0 1e38 0 0 -1".into(),
        "particle 0 0 0 0 0 0 1 0 -1 0 0 -1".into(),
        "particle_sink 1 0 0 0 sphere 0 0 0 1 particle 3 0 0 0 0 0 1 0 0 0 0 -1".into(),
        "particle_sink -1 1 -5 1 sphere 0 0 0 1".into(),
    ] {
        folder.write("a.scn", &text);
        for name in ["euler", "verlet", "rk4"] {
            let args = format!("check a.scn --integrator {name} --dt 0.01 --plot o.html");
            let answer = folder.run(&args);
            assert!(answer.code == 0 && answer.stderr.lines().all(|line| line.starts_with("warning: ")), "{answer:?}");
            assert!(!answer.stdout.contains("NaN") && !folder.read("o.html").contains("NaN"), "{text}: {answer:?}");
            folder.run(&format!("run a.scn --integrator {name} --substeps auto --steps 3")).warnings();
        }
    }
}

#[test]
fn plots_are_whole() {
    let folder = Folder::with("rope.scn", rope(20.0));
    folder.run("check rope.scn --plot o.svg").fine();
    folder.run("check rope.scn --plot o.html --dt 0.1 --integrator verlet").fine();
    let (picture, page) = (folder.read("o.svg"), folder.read("o.html"));
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"), "{picture}");
    for word in ["midpoint", "symplectic", "implicit", "rk4: stable", "<circle"] {
        assert!(picture.contains(word), "no {word}");
    }
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n") && page.contains("verlet: grows"));
    assert!(!page.contains("<script") && !page.contains("href") && !page.contains("src="));
    let before = folder.names();
    folder.run("check rope.scn --plot no/o.svg").error();
    fs::create_dir(folder.path("folder.svg")).expect("a folder");
    folder.run("check rope.scn --plot folder.svg").error();
    folder.run("check no.scn --plot p.svg").error();
    assert_eq!(
        folder.names(),
        [&before[..], &["folder.svg".into()]]
            .concat()
            .into_iter()
            .collect::<std::collections::BTreeSet<_>>()
            .into_iter()
            .collect::<Vec<_>>()
    );
}

#[test]
fn a_check_is_told_in_every_format() {
    let folder = Folder::with("rope.scn", rope(20.0));
    let files = "--out a.csv --out a.json --out a.html --out a.svg";
    let said = folder.run(&format!("check rope.scn --dt 1/30 {files}")).fine().stdout;
    assert!(said.lines().all(|line| line.chars().count() <= 80), "{said}");
    assert!(said.contains("  rk4*  ") && said.contains("The largest steps"), "{said}");
    let sheet = folder.read("a.csv");
    assert!(sheet.starts_with("method,chooses_steps,at_rest_s,") && sheet.contains("\nimplicit,false,any,"), "{sheet}");
    assert_eq!(sheet.lines().count(), 1 + pointmass::Method::ALL.len(), "{sheet}");
    let study: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    assert_eq!(study, check(&folder, "rope.scn --dt 1/30"));
    let page = folder.read("a.html");
    let program = concat!("<dd>pointmass ", env!("CARGO_PKG_VERSION"));
    for part in [program, "<code>pointmass check rope.scn", "<dt>Machine</dt>", "prefers-color-scheme:dark", "rk4</td>"]
    {
        assert!(page.contains(part), "no {part}: {page}");
    }
    assert_eq!((page.matches("<svg").count(), folder.read("a.svg").matches("<svg").count()), (2, 1));
    let answer = folder.run("check rope.scn --out rope.scn");
    assert!(answer.code == 2 && answer.stderr.contains("ends in .html, .svg, .csv or .json"), "{answer:?}");
    folder.write("a.json", "{}");
    assert!(folder.run("check a.json --out a.json").error().contains("a.json: is read, so it cannot be written"));
}

#[test]
fn steps_beyond_the_bound_are_warned_of() {
    let folder = Folder::with("rope.scn", rope(20.0));
    let said = folder.run("run rope.scn --dt 1/30 --integrator symplectic --steps 2");
    let warnings = said.warnings();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    for word in ["33.33 ms", "23.61 ms", "springs[1]", "--substeps auto"] {
        assert!(warnings[0].contains(word), "no {word}: {warnings:?}");
    }
    for fine in [
        "run rope.scn --dt 1/30 --integrator symplectic --steps 2 --substeps 2",
        "run rope.scn --dt 1/30 --integrator symplectic --steps 2 --substeps auto",
        "run rope.scn --dt 1/30 --integrator rk4 --steps 2",
    ] {
        folder.run(fine).fine();
    }
    // Without damping explicit Euler has no step at all; a short run shows nothing of it.
    folder.write("loose.scn", rope(0.0));
    assert!(folder.run("run loose.scn --dt 0.001 --integrator euler --steps 20000").warnings()[0].contains("e-fold"));
    folder.run("run loose.scn --dt 0.001 --integrator euler --steps 20").fine();
    let picture = folder.run("render rope.scn --dt 1/20 --duration 0.1 --integrator rk4 --size 8x8 --out o.png");
    assert_eq!(picture.warnings().len(), 1);
    folder.run("render rope.scn --dt 1/20 --duration 0.1 --substeps auto --size 8x8 --out o.png").fine();
}

#[test]
fn substeps_are_what_shorter_steps_are() {
    let folder = Folder::with("busy.scn", BUSY);
    // Without emitters, whose newborn fly on from the beginning of a step.
    let text: String = BUSY.lines().filter(|line| !line.contains("source")).map(|line| format!("{line}\n")).collect();
    folder.write("quiet.scn", text);
    let [long, short] = ["--dt 1/64 --steps 64 --substeps 4", "--dt 1/256 --steps 256"]
        .map(|args| folder.hash(&format!("quiet.scn {args}")));
    assert_eq!(long, short);
    assert_eq!(folder.hash("busy.scn --steps 60 --substeps 1"), folder.hash("busy.scn --steps 60"));
    let report = folder.report("busy.scn --dt 1/30 --steps 60 --substeps auto");
    assert_eq!(report["substeps"]["auto"], true);
    let [least, most, total] = ["least", "most", "total"].map(|field| number(&report, &format!("substeps/{field}")));
    assert!(
        2.0 <= least && least <= most && most <= 1024.0 && (60.0 * least..=60.0 * most).contains(&total),
        "{report}"
    );
    let same = folder.report("busy.scn --dt 1/30 --steps 60 --substeps auto");
    assert_eq!(report["hash"], same["hash"]);
    let finer = folder.report("busy.scn --dt 1/30 --steps 60 --substeps auto --tolerance 1e-5");
    assert!(number(&finer, "substeps/total") > total, "{finer}");
    let text = folder.run("run busy.scn --dt 1/30 --steps 60 --substeps auto --tolerance 1e-5").fine().stdout;
    assert!(text.contains("sub-steps") && text.contains("on average"), "{text}");
}

/// Where every particle is at the end of a recording.
fn ends(table: &str) -> Vec<[f64; 3]> {
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    let last = rows.last().expect("a row")[0];
    rows.iter().filter(|row| row[0] == last).map(|row| [row[3], row[4], row[5]]).collect()
}

#[test]
fn automatic_substeps_tame_every_spring_of_the_course() {
    let folder = Folder::new();
    if course::copy_into(&folder, ".").is_none() {
        return;
    }
    // Slow builds leave most of it to fast ones.
    let (step, methods) = match cfg!(debug_assertions) {
        true => ("0.0005", &[pointmass::Method::Verlet][..]),
        false => ("0.0001", pointmass::Method::ALL),
    };
    for (scene, length) in [("rope", 20.0), ("swirl", 20.0), ("tetra", 1.6)] {
        let run = |args: &str| {
            let report = folder.report(&format!("{scene}.scn --every 1000000 --out o.csv {args}"));
            assert_eq!(number(&report, "died/nonfinite"), 0.0, "{report}");
            (ends(&folder.read("o.csv")), report)
        };
        let (known, _) = run(&format!("--dt {step} --duration 10 --integrator rk4"));
        for method in methods {
            let (found, report) = run(&format!("--dt 1/30 --duration 10 --integrator {method} --substeps auto"));
            assert_eq!(number(&report, "substeps/beyond"), 0.0, "{report}");
            for (known, found) in known.iter().zip(&found) {
                let error = (0..3).map(|i| (known[i] - found[i]).powi(2)).sum::<f64>().sqrt();
                assert!(error < 0.01 * length, "{scene} {method}: {error}");
            }
            let (found, _) = run(&format!("--dt 1/30 --duration 60 --integrator {method} --substeps auto"));
            assert!(found.iter().flatten().all(|x| x.abs() < 50.0), "{scene} {method} explodes: {found:?}");
        }
    }
}

#[test]
fn wind_brakes_as_drag_does_and_what_is_not_looked_at_is_named() {
    let folder = Folder::new();
    let scene = |forces: &str| format!(r#"{{"particles": [{{"drag": 3}}], "forces": [{forces}]}}"#);
    let (drag, still) = (r#"{"drag": {}}"#, r#"{"wind": {"field": []}}"#);
    let all = r#"{"wind": {"field": [], "coefficient": 2}}"#;
    for (forces, rate) in [(drag, 3.0), (still, 3.0), (all, 2.0), (&format!("{drag}, {all}"), 5.0)] {
        folder.write("a.json", scene(forces));
        let check = check(&folder, "a.json");
        let step = steps(&check, "drag", &["euler"])[0];
        assert!((step / 2e3 * rate - 1.0).abs() < 1e-6, "{forces}: {step}");
        assert_eq!(check["not_judged"], Value::Array(Vec::new()), "{forces}");
    }
    let near = r#"{"lennard_jones": {"epsilon": 1, "sigma": 0.3, "cutoff": 0.75}}"#;
    let undragged = |forces: &str| scene(forces).replace(r#""drag": 3"#, r#""drag": 0, "charge": 1e-9"#);
    folder.write("a.json", undragged(&format!("{near}, {near}, {{\"coulomb\": {{}}}}")));
    let text = folder.run("check a.json").fine().stdout;
    assert!(text.contains("not looked at: Lennard-Jones, charges, ") && text.contains("1 particle (1 free)"), "{text}");
}

#[test]
fn lives_and_goals_bound_the_step() {
    let folder = Folder::with(
        "a.json",
        r#"{"forces": [{"drag": {}}], "particles": [{"drag": 2, "lifetime": 3, "material": 0}],
            "materials": [{"life": {"drag": [[0, 1], [1, 5]], "mass": [[0, 1], [0.5, 0.25], [1, 1]]}}]}"#,
    );
    let report = check(&folder, "a.json --integrator euler");
    // Halfway the drag is 6 kg/s and the mass 0.25 kg.
    assert!((steps(&report, "drag", &["euler"])[0] - 2e3 / 24.0).abs() < 0.01, "{report}");
    let text = folder.run("check a.json --integrator euler").fine().stdout;
    assert!(text.contains("particles[0] of drag 6 kg/s and mass 0.25 kg over its life: 24 /s"), "{text}");
    assert!(!text.contains("goal"), "{text}");

    let goal = |material: u32| {
        format!(
            r#"{{"goals": [{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, "arrive": 1, "material": {material}}}],
            "materials": [{{}}, {{}}], "particles": [{{"material": 0}}]}}"#
        )
    };
    folder.write("b.json", goal(0));
    let report = check(&folder, "b.json --dt 0.1 --integrator symplectic");
    // 4 − 2h 4/T − h² 6/T² = 0.
    let step = 100.0 * (160f64.sqrt() - 8.0) / 12.0;
    assert!((steps(&report, "goal", &["symplectic"])[0] / step - 1.0).abs() < 1e-5, "{report}");
    assert_eq!(report["led"]["place"], "goals[0]", "{report}");
    let text = folder.run("check b.json --dt 0.1 --integrator symplectic").fine().stdout;
    for word in ["goals[0] that settles in 100.0 ms", "too long for goals", "--dt 0.0387", "    goal  at 100.0 ms"] {
        assert!(text.contains(word), "no {word}:\n{text}");
    }
    let run = |args: &str| folder.run(&format!("run b.json --dt 0.1 --integrator symplectic --duration 3 {args}"));
    let warnings = run("").warnings().join(" ");
    assert!(warnings.contains("38.74 ms, because of goals[0]"), "{warnings}");
    assert!(number(&run("--substeps auto --tolerance 10 --report json").fine().report(), "substeps/least") >= 3.0);
    // Nobody is led.
    folder.write("b.json", goal(1));
    assert_eq!(check(&folder, "b.json --dt 0.1")["led"], Value::Null);
    run("").fine();
}

#[test]
fn springs_of_fabrics_are_found_in_the_file() {
    let sheet = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [2, 2]}}"#;
    let cloth = |ks: u32| {
        format!(
            r#"{{"form": {sheet}, "mass": 9, "drag": {ks}, "springs": {{"structural": {{"ks": {ks}, "kd": {ks}}}}}}}"#
        )
    };
    let folder = Folder::with(
        "a.json",
        format!(
            r#"{{"particles": [{{}}, {{}}], "springs": [{{"ends": [0, 1], "rest_length": 1, "ks": 3}}],
            "forces": [{{"drag": {{}}}}], "cloths": [{}, {}]}}"#,
            cloth(2),
            cloth(50)
        ),
    );
    let report = check(&folder, "a.json");
    assert_eq!([&report["stiffest"]["place"], &report["dragged"]["place"]], ["cloths[1]", "cloths[1]"]);
    assert!(report["advice"].to_string().contains("cloths[1] is damped 5 times"), "{report}");
}

#[test]
fn a_tolerance_that_nothing_asks_for_is_told() {
    let folder = Folder::with("a.scn", ONE);
    let warnings = |args: &str| folder.run(&format!("run a.scn --steps 1 --tolerance 1e-3 {args}")).warnings().len();
    assert_eq!(["", "--substeps 4", "--substeps auto", "--integrator embedded"].map(warnings), [1, 1, 0, 0]);
}
