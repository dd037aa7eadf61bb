//! `pointmass lab` from outside: orders, energies, its reports, what it refuses.

use crate::tool::Folder;
use serde_json::Value;

/// A rope of two springs.
const ROPE: &str = "\
particle_gravity 0 -9.80665 0
material  0 0 0  1 1 1  0 0 0  0 0 0  0 0 0  10 1 0
particle  0 0 0   0 0 0   1 1 0 0 0  0
particle  1 0 0   0 0 0   1 0 0 0 0  0
particle  2 0 0   0 0 0   1 0 0 0 0  0
particle_spring 0 1  1 100 2
particle_spring 1 2  1 100 2
";

/// The only problem of a study that goes well, as its JSON tells it.
fn case(folder: &Folder, args: &str) -> Value {
    folder.run(&format!("lab {args} --report json")).fine().report()["cases"][0].clone()
}

/// A method's row.
#[track_caller]
fn row<'a>(case: &'a Value, name: &str, steps: &str) -> &'a Value {
    let rows = case["rows"].as_array().expect("rows");
    let found = rows.iter().find(|row| row["integrator"] == name && row["steps"] == steps);
    found.unwrap_or_else(|| panic!("no {name}, {steps}, in {case}"))
}

#[track_caller]
fn has_order(case: &Value, name: &str, steps: &str, expected: f64, margin: f64) {
    let row = row(case, name, steps);
    let order = row["order"].as_f64().unwrap_or(f64::NAN);
    assert!((order - expected).abs() < margin, "{name}: {order}, not {expected}: {row}");
}

fn worst_energy(case: &Value, name: &str) -> f64 {
    row(case, name, "fixed")["energy"]["worst"].as_f64().expect("a number")
}

#[test]
fn methods_have_their_orders_on_a_pendulum() {
    let folder = Folder::new();
    let case = case(&folder, "--problems pendulum");
    for (name, order) in [
        ("euler", 1.0),
        ("symplectic", 1.0),
        ("midpoint", 2.0),
        ("lecture_midpoint", 2.0),
        ("verlet", 2.0),
        ("rk4", 4.0),
        ("adaptive", 4.0),
        ("embedded", 3.0),
        ("implicit", 1.0),
    ] {
        has_order(&case, name, "fixed", order, 0.05);
    }
    has_order(&case, "embedded", "tolerance", 1.0, 0.15);
    assert!(row(&case, "embedded", "own")["order"].is_null());
    // Symplectic methods swing, the others drift.
    let remark = |name: &str| row(&case, name, "fixed")["remark"].as_str().expect("words").to_string();
    assert_eq!(remark("symplectic"), "energy swings, no drift");
    assert_eq!((remark("euler").as_str(), remark("implicit").as_str()), ("energy drifts up", "energy drifts down"));
    assert!(worst_energy(&case, "rk4") < 1e-5 && worst_energy(&case, "verlet") < 1e-3);
    assert!(worst_energy(&case, "euler") > 0.1);
}

#[test]
fn energies_of_an_orbit_are_those_of_double_precision() {
    let orbit = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/orbit.scn");
    let args = format!("{orbit} --integrators symplectic,verlet,rk4 --duration 19.9 --dt 1/60");
    let case = case(&Folder::new(), &args);
    // Of the largest |ΔE/E₀|; RK4's is not far above the rounding of f32.
    for (name, expected, margin) in [("symplectic", 2.9e-2, 0.02), ("verlet", 1.5e-3, 0.04), ("rk4", 2.5e-6, 0.5)] {
        let worst = worst_energy(&case, name);
        assert!((worst / expected - 1.0).abs() < margin, "{name}: {worst}");
    }
}

#[test]
fn the_lecture_s_midpoint_is_of_order_1_where_forces_depend_on_time() {
    let args = "--problems driven --integrators lecture_midpoint,midpoint --dt 1/32,1/64,1/128,1/256";
    let case = case(&Folder::new(), args);
    has_order(&case, "lecture_midpoint", "fixed", 1.0, 0.05);
    has_order(&case, "midpoint", "fixed", 2.0, 0.05);
}

#[test]
fn what_is_stiff_blows_up_but_not_with_implicit_euler() {
    let case = case(&Folder::new(), "--problems stiff --integrators euler,implicit --dt 1/4,1/16,1/64,1/128");
    let blew_up = |name: &str| {
        let points = row(&case, name, "fixed")["points"].as_array().expect("points").clone();
        points.iter().map(|point| point["blew_up_at"].is_number()).collect::<Vec<_>>()
    };
    assert_eq!(blew_up("euler"), [true, true, false, false]);
    assert_eq!(blew_up("implicit"), [false; 4]);
    assert!(row(&case, "euler", "fixed")["remark"].as_str().is_some_and(|text| text.contains("blows up at dt ≥ 1/16")));
    has_order(&case, "implicit", "fixed", 1.0, 0.05);
}

#[test]
fn a_scene_is_told_in_every_format_and_the_same_each_time() {
    let folder = Folder::with("a.scn", ROPE);
    let args = "lab a.scn --duration 0.5 --dt 1/60,1/120,1/240 --integrators verlet,embedded";
    let said = folder.run(&format!("{args} --out a.csv --out a.json --out a.html --out a.svg")).fine().stdout;
    for words in
        ["a.scn", "against RK4 in steps of", "  verlet ", "  embedded fixed ", "by tolerance [m]", "\n  order: "]
    {
        assert!(said.contains(words), "{words} in {said}");
    }
    let study: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    has_order(&study["cases"][0], "verlet", "fixed", 2.0, 0.1);
    let sheet = folder.read("a.csv");
    // Three steps of Verlet, three of the pair by its choice and three without, five tolerances.
    assert_eq!(sheet.lines().count(), 1 + 3 + 3 + 3 + 5, "{sheet}");
    let page = folder.read("a.html");
    assert_eq!((page.matches("<svg").count(), page.matches("<script").count()), (4, 0));
    assert!(page.trim_end().ends_with("</html>") && !page.contains("NaN") && page.contains("<dt>Machine</dt>"));
    assert!(said.lines().all(|line| line.chars().count() <= 80), "{said}");
    assert!(folder.read("a.svg").starts_with("<svg"));
    assert_eq!(folder.run(args).fine().stdout, said);
    assert_eq!(folder.names(), ["a.csv", "a.html", "a.json", "a.scn", "a.svg"]);
}

#[test]
fn collisions_and_scenes_without_particles_are_no_trouble() {
    let folder = Folder::with("empty.json", "{}");
    let empty = case(&folder, "empty.json --duration 0.1 --integrators rk4");
    assert!(row(&empty, "rk4", "fixed")["order"].is_null());
    let floor = r#"{ "particles": [{ "position": [0, 0.2, 0] }], "forces": [{ "gravity": { "acceleration": [0, -10, 0] } }],
        "scenery": [{ "shape": { "plane": { "point": [0, 0, 0], "normal": [0, 1, 0] } } }] }"#;
    folder.write("floor.json", floor);
    let case = case(&folder, "floor.json --duration 0.5 --integrators rk4 --out a.html");
    let note = case["notes"][0].as_str().expect("a note");
    assert!(note.contains("hits on colliders") || note.contains("hit on colliders"), "{note}");
}

#[test]
fn rounding_is_told_from_chaos() {
    let uncertain = |case: &Value| {
        let notes = case["notes"].as_array().into_iter().flatten().filter_map(Value::as_str);
        notes.filter(|note| note.contains("uncertain")).collect::<Vec<_>>().join("; ")
    };
    // RK4 takes a parabola as it is: what errors there are come of rounding.
    let thrown = "particle_gravity 0 -9.80665 0\nparticle 0.3 0 0 1 5 0 1 0 0 0 0 -1\n";
    let folder = Folder::with("thrown.scn", thrown);
    let note = uncertain(&case(&folder, "thrown.scn --duration 1 --integrators rk4"));
    assert!(!note.contains("chaotic") && note.contains("rounded in each of its steps"), "{note}");
    let one = |place: &str, speed: &str| format!(r#"{{"position": {place}, "velocity": {speed}}}"#);
    let three = [
        one("[1, 0, 0]", "[0, 0.4, 0]"),
        one("[-0.5, 0.8, 0]", "[-0.3, -0.2, 0.1]"),
        one("[-0.4, -0.7, 0.1]", "[0.3, -0.1, 0]"),
    ];
    let pull = r#"{"mutual_gravity": {"constant": 1, "softening": 0.02}}"#;
    folder.write("three.json", format!(r#"{{"forces": [{pull}], "particles": [{}]}}"#, three.join(", ")));
    let note = uncertain(&case(&folder, "three.json --duration 60 --dt 0.004,0.002 --integrators rk4"));
    assert!(note.contains("chaotic"), "{note}");
}

#[test]
fn the_command_line_says_what_it_wants() {
    let folder = Folder::with("a.scn", ROPE);
    let cases = [
        ("--integrators rk4,rk5", "unknown integrator; there are euler symplectic"),
        ("--problems pendulums", "oscillator, pendulum, driven, kepler, stiff, rope"),
        ("--dt 0", "expected a step of at least 1e-9 s"),
        ("--dt 0.1,-1", "expected seconds"),
        ("--dt nan", "expected seconds"),
        ("--duration 0", "expected more than 0 s"),
        ("--out a.pdf", "expected a name that ends in .html, .svg, .csv or .json"),
        ("a.scn --problems rope", "cannot be used with"),
    ];
    folder.misuse("lab", &cases);
    assert!(folder.run("lab b.scn").error().starts_with("b.scn: "));
    assert!(folder.run("lab a.scn --out no/a.html").error().contains("there is no folder no"));
    folder.write("a.json", "{}");
    assert!(folder.run("lab a.json --out a.json").error().contains("a.json: is read, so it cannot be written"));
    assert_eq!(folder.names(), ["a.json", "a.scn"]);
}
