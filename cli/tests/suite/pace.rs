//! Steps that would explode: divided until they do not, and told of where that does not help.

use crate::tool::{Folder, number};
use serde_json::Value;

/// Air on three corners of a gram.
const SAIL: &str = r#"{"run": {"duration": 1, "dt": 0.05}, "particles": [
    {"mass": 0.001, "velocity": [0, 0, 5]}, {"position": [1, 0, 0], "mass": 0.001, "velocity": [0, 0, 5]},
    {"position": [0, 1, 0], "mass": 0.001, "velocity": [0, 0, 5]}],
    "forces": [{"aerodynamics": {"drag": 1.2, "lift": 0, "triangles": [[0, 1, 2]], "field": []}}]}"#;

/// A bullet in treacle.
pub(crate) const BULLET: &str = r#"{"run": {"duration": 2, "dt": 0.1}, "particles": [{"mass": 0.01, "velocity": [800, 0, 0]}],
    "forces": [{"quadratic_drag": {"coefficient": 0.01}}]}"#;

/// Two that burst apart within a thousandth of a step.
const BURST: &str = r#"{"run": {"duration": 1, "dt": 0.1}, "particles": [{}, {"position": [0.3, 0, 0]}],
    "forces": [{"power_law": {"strength": -500, "exponent": 7, "softening": 0.05, "reach": 5}}]}"#;

/// Place and velocity of the first particle at the end of a run with so many sub-steps as it takes, and its report.
fn end(folder: &Folder, text: &str) -> ([f64; 6], Value) {
    folder.write("a.json", text);
    let report = folder.run("run a.json --substeps auto --out o.csv --every 1000 --report json").fine().report();
    let table = folder.read("o.csv");
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    let last = rows.last().expect("a row")[0];
    let first = rows.iter().find(|row| row[0] == last && row[2] == 0.0).expect("the particle");
    (std::array::from_fn(|i| first[3 + i]), report)
}

#[test]
fn steps_that_explode_are_divided_until_they_do_not() {
    let folder = Folder::new();
    // Each corner bears a third of 0.36 kg/m v².
    let (sail, report) = end(&folder, SAIL);
    let fall = 0.36 / 0.003;
    assert!((sail[2] - (1.0 + fall * 5.0f64).ln() / fall).abs() < 1e-3, "{sail:?}");
    assert!((sail[5] - 5.0 / (1.0 + fall * 5.0)).abs() < 1e-4, "{sail:?}");
    assert_eq!(number(&report, "substeps/beyond"), 0.0, "{report}");

    let (bullet, report) = end(&folder, BULLET);
    assert!((bullet[0] - 1601f64.ln()).abs() < 2e-3 && (bullet[3] - 800.0 / 1601.0).abs() < 1e-3, "{bullet:?}");
    assert_eq!([number(&report, "died/nonfinite"), number(&report, "substeps/beyond")], [0.0; 2], "{report}");

    // All the energy of the start, 500 J / (6 D⁶), is in the two of them at last.
    let (burst, report) = end(&folder, BURST);
    let speed = (500.0 / 6.0 / (0.3f64.powi(2) + 0.05f64.powi(2)).powi(3)).sqrt();
    assert!((burst[3].abs() / speed - 1.0).abs() < 1e-3, "{burst:?} {speed}");
    assert_eq!([number(&report, "substeps/most"), number(&report, "substeps/beyond")], [1024.0, 1.0], "{report}");
    assert!(number(&report, "substeps/farthest") > 0.1, "{report}");
    let text = folder.run("run a.json --substeps auto").fine().stdout;
    assert!(text.contains("but 1 step may be farther off, the worst by about"), "{text}");
}

#[test]
fn sub_steps_become_fewer_again() {
    // The bullet is slow after the first step.
    let folder = Folder::new();
    let (_, report) = end(&folder, BULLET);
    let [least, most, total] = ["least", "most", "total"].map(|field| number(&report, &format!("substeps/{field}")));
    assert!(least <= 4.0 && most >= 512.0 && total < 2.5 * most, "{report}");
}

#[test]
fn the_newborn_of_several_emitters_are_not_taken_for_each_other() {
    // They fly steadily, so that two sub-steps do as well as one.
    let source = |x: u32| {
        format!(r#"{{"shape": {{"sphere": {{"center": [{x}, 0, 0], "radius": 0.1}}}}, "rate": 150, "speed": 1}}"#)
    };
    let text = format!(r#"{{"run": {{"dt": 0.03125, "duration": 1}}, "emitters": [{}, {}]}}"#, source(0), source(5));
    let folder = Folder::with("a.json", text);
    let report = folder.run("run a.json --substeps auto --tolerance 1e-3 --report json").fine().report();
    assert_eq!([number(&report, "substeps/most"), number(&report, "substeps/beyond")], [2.0, 0.0], "{report}");
}

#[test]
fn what_no_sub_steps_save_is_told() {
    let text = BULLET.replace("800", "1e30").replace("\"duration\": 2", "\"duration\": 0.2");
    let folder = Folder::with("a.json", text);
    let report = folder.run("run a.json --substeps auto --report json").fine().report();
    assert_eq!([number(&report, "died/nonfinite"), number(&report, "substeps/beyond")], [1.0; 2], "{report}");
    assert_eq!(report["substeps"]["farthest"], Value::Null, "{report}");
    let text = folder.run("run a.json --substeps auto").fine().stdout;
    assert!(text.contains("1 step may be farther off, and somebody is no longer finite"), "{text}");
}
