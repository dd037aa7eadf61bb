//! The program beside our structures: every library takes part in `compare --peers`, with answers as they have to be.

use serde_json::Value;
use std::process::Command;

/// Returns what `pointmass-peers compare` says with these arguments, and the figures it writes.
#[track_caller]
fn compare(args: &str) -> (String, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pointmass-peers"));
    command.args(["compare", "--peers", "--repeat", "1", "--out", "a.json"]).args(args.split(' '));
    let output = command.current_dir(&folder).output().expect("the program runs");
    assert!(output.status.success(), "{output:?}");
    let figures = std::fs::read(folder.path().join("a.json")).expect("figures");
    (String::from_utf8_lossy(&output.stdout).into(), serde_json::from_slice(&figures).expect("JSON"))
}

#[test]
fn libraries_take_part_in_comparisons_of_points() {
    for points in ["uniform", "plane", "mixed"] {
        let args = format!("--n 500 --distribution {points} --structures grid --neighbours 5 --k 3");
        let (_, study) = compare(&args);
        let contestants = study["cases"][0]["contestants"].as_array().expect("contestants");
        assert!(contestants.len() > 3 && contestants.iter().all(|one| one["left_out"].is_null()), "{study}");
    }
}

#[test]
fn mismatches_of_libraries_on_meshes_are_counted() {
    let (said, study) = compare("--triangles 500 --structures kd --segments 2000");
    assert!(said.contains("of 6 000 first hits differ from ours by more than rounding"), "{said}");
    for case in study["cases"].as_array().expect("cases") {
        let contestants = case["contestants"].as_array().expect("contestants");
        assert!(contestants.len() > 3 && contestants[0]["mismatches"].is_null(), "{case}");
        assert!(contestants[1..].iter().all(|one| one["mismatches"].as_u64().is_some_and(|n| n < 60)), "{case}");
    }
}
