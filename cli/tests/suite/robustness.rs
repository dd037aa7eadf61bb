//! What the world does to a run: closed pipes, full disks, little memory, files in the way.

use crate::scenes::{BUSY, ONE};
#[cfg(unix)]
use crate::tool::often;
use crate::tool::{Folder, PROGRAM, number};
use serde_json::Value;
use std::process::{Command, Stdio};

/// A cloud of particles born at once, and nothing that would make them interact.
const CLOUD: &str = r#"{
  "run": {"capacity": 10},
  "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}, {"drag": {}}],
  "emitters": [{
    "shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "burst": {"count": 1000000}, "speed": 1
  }]
}"#;

/// So many in memory for no more, among things.
fn among_things(count: u32) -> String {
    format!(
        r#"{{
  "run": {{"capacity": {count}, "integrator": "symplectic", "dt": 0.02, "duration": 0.8}},
  "forces": [{{"gravity": {{"acceleration": [0, -9.8, 0]}}}}],
  "emitters": [{{
    "shape": {{"box": {{"min": [-1, 0.8, -1], "max": [1, 2, 1]}}}}, "burst": {{"count": {count}}}, "speed": 1, "elasticity": 0.5
  }}],
  "scenery": [
    {{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}}},
    {{"shape": {{"sphere": {{"center": [0.5, 0.3, 0], "radius": 0.3}}}}}},
    {{"shape": {{"sphere": {{"center": [0, 0.3, 0.1], "radius": 0.3}}}}}},
    {{"shape": {{"box": {{"min": [-1, 0, -1], "max": [-0.5, 0.4, 0]}}}}}}
  ]
}}"#
    )
}

#[test]
fn many_go_past_things_on_threads() {
    for count in [10_600, 11_000, 13_000] {
        let folder = Folder::with("a.json", among_things(count));
        let alone = folder.hash("a.json --threads 1");
        for threads in [2, 3] {
            assert_eq!(folder.hash(&format!("a.json --threads {threads}")), alone, "{count} on {threads} threads");
        }
    }
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = Folder::with("busy.scn", BUSY);
    for args in [&["run", "busy.scn", "--report", "json"][..], &["run", "busy.scn"], &["--help"]] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut command = Command::new(PROGRAM);
        command.args(args).current_dir(folder.path("")).stdout(writer).stderr(Stdio::piped());
        let output = command.spawn().and_then(std::process::Child::wait_with_output).expect("it runs");
        assert_eq!((output.status.code(), &*output.stderr), (Some(0), &b""[..]), "{args:?}: {output:?}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_under_standard_output_is_one_line() {
    let folder = Folder::with("a.scn", ONE);
    let answer = folder.shell("$POINTMASS run a.scn --steps 1 > /dev/full");
    assert!(answer.error().contains("standard output"), "{answer:?}");
    let answer = folder.shell("$POINTMASS run a.scn --steps 1 --report json > /dev/full");
    assert!(answer.error().contains("standard output"), "{answer:?}");
}

#[test]
#[cfg(unix)]
fn nobody_to_read_errors_does_not_change_the_exit_code() {
    let folder = Folder::with("a.scn", "frobnicate");
    let closed = folder.shell("$POINTMASS run a.scn 2>&-");
    assert_eq!(closed.code, 1, "{closed:?}");
    let mut command = Command::new(PROGRAM);
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let status = command.args(["run", "a.scn"]).current_dir(folder.path("")).stderr(writer).status().expect("it runs");
    assert_eq!(status.code(), Some(1), "standard error is a closed pipe");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_under_standard_error_does_not_change_the_exit_code() {
    let folder = Folder::with("a.scn", "frobnicate");
    let full = folder.shell("$POINTMASS run a.scn 2> /dev/full");
    assert_eq!(full.code, 1, "{full:?}");
}

#[test]
fn files_are_replaced_whole_or_left_alone() {
    let folder = Folder::with("a.scn", ONE);
    folder.write("bad.scn", "particle 0 0 0");
    folder.write("o.csv", "old");
    folder.write("o.json", "old");
    folder.write("folder.csv/keep", "");
    let before = folder.names();
    for args in [
        "run bad.scn --steps 1 --out o.csv",
        "run a.scn --steps 1 --out o.csv --out nowhere/o.csv",
        "run a.scn --steps 1 --out o.csv --out nowhere/o.ply",
        "run a.scn --steps 1 --out o.csv --out folder.csv",
        "convert bad.scn o.json",
        "convert a.scn nowhere/o.json",
        "render a.scn --duration 0 --out nowhere/o.gif",
        "render bad.scn --duration 0 --out o.gif",
    ] {
        folder.run(args).error();
        assert_eq!((folder.read("o.csv"), folder.read("o.json")), ("old".into(), "old".into()), "{args}");
        assert_eq!(folder.names(), before, "{args}");
    }
    folder.run("run a.scn --steps 1 --out o.csv").fine();
    folder.run("convert a.scn o.json").fine();
    assert!(folder.read("o.csv").starts_with("step,") && folder.read("o.json").starts_with('{'));
    assert_eq!(folder.names(), before);
}

#[test]
fn outputs_are_written_all_or_none() {
    let folder = Folder::with("a.scn", ONE);
    folder.write("o.csv", "old");
    // In the way of the second of three clouds.
    folder.write("o_000001.ply/keep", "");
    let before = folder.names();
    let answer = folder.run("run a.scn --steps 2 --out o.csv --out o.ply");
    assert!(answer.error().contains("o_000001.ply"), "{answer:?}");
    assert_eq!((folder.names(), folder.read("o.csv")), (before, "old".into()));
}

#[test]
#[cfg(unix)]
fn a_disk_that_fills_up_leaves_nothing_behind() {
    let folder = Folder::with("busy.scn", BUSY);
    folder.write("o.csv", "old");
    for out in ["o.csv", "o.jsonl", "o.xyz", "o.ply"] {
        // The largest file may have one block, of 512 bytes or 1024; the signal that comes with that is ignored.
        let script = format!("trap '' XFSZ; ulimit -f 1; $POINTMASS run busy.scn --steps 200 --out {out}");
        let answer = folder.shell(&script);
        answer.error();
        assert_eq!(folder.names(), ["busy.scn", "o.csv"], "{out}: {answer:?}");
        assert_eq!(folder.read("o.csv"), "old");
    }
}

#[test]
#[cfg(unix)]
fn a_million_particles_leave_the_stack_alone() {
    let folder = Folder::with("cloud.json", CLOUD);
    let script =
        "ulimit -s 256; $POINTMASS run cloud.json --steps 2 --capacity 1000000 --report json --every 9 --out o.csv";
    let report = folder.shell(script).fine().report();
    assert_eq!(["born", "live", "refused"].map(|field| number(&report, field)), [1e6, 1e6, 0.0], "{report}");
    assert_eq!(folder.read("o.csv").lines().count(), 1_000_001);
    let report = folder.report("cloud.json --steps 2 --capacity 999999");
    assert_eq!(["born", "live", "refused"].map(|field| number(&report, field)), [999_999.0, 999_999.0, 1.0]);
    assert_eq!(number(&folder.report("cloud.json --steps 2"), "refused"), 999_990.0);
}

#[test]
#[cfg(unix)]
fn memory_that_is_not_there_is_one_line() {
    let folder = Folder::with("a.scn", ONE);
    folder.write("a.json", r#"{"run": {"capacity": 4294967295}, "particles": [{}]}"#);
    for args in ["a.scn --capacity 500000000", "a.json"] {
        // 4 GB of memory, should this machine really have more.
        let answer = folder.shell(&format!("ulimit -v 4000000; $POINTMASS run {args} --steps 1 --out o.csv"));
        assert!(answer.error().contains("capacity"), "{answer:?}");
        assert_eq!(folder.names(), ["a.json", "a.scn"]);
    }
}

#[test]
fn a_step_that_time_cannot_tell_is_refused_wherever_it_stands() {
    assert_eq!(Folder::with("a.scn", ONE).run("run a.scn --dt 1e-10").code, 2);
    for dt in ["1e-10", "1e-300"] {
        // With a duration of no step at all, so that it ends even if it is not refused.
        let text = format!(r#"{{"run": {{"dt": {dt}, "duration": 0}}, "particles": [{{}}]}}"#);
        let folder = Folder::with("a.json", text);
        let answer = folder.run("run a.json");
        assert!(answer.error().starts_with("a.json:run.dt: "), "{answer:?}");
    }
}

#[test]
fn counters_do_not_overflow() {
    // Nearly 2⁶² births a second; all but two find no room.
    let burst = r#""burst": {"count": 4294967295, "every": 1e-9}"#;
    let emitter = format!(r#"{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, {burst}}}"#);
    let text = format!(r#"{{"run": {{"capacity": 2, "dt": 1, "duration": 60}}, "emitters": [{emitter}]}}"#);
    let folder = Folder::with("a.json", text);
    let report = folder.report("a.json");
    assert_eq!(number(&report, "born"), 2.0, "{report}");
    assert_eq!(number(&report, "refused"), u64::MAX as f64, "{report}");
}

#[test]
#[cfg(unix)]
fn a_long_run_is_silent_where_there_is_no_terminal() {
    let folder = Folder::with("busy.scn", BUSY);
    // As many steps as it takes to be long enough to show anything, however fast the machine.
    let mut steps = often(100_000);
    let mut seconds = 0.0;
    while seconds < 0.1 {
        let answer = folder.run(&format!("run busy.scn --steps {steps} --dt 0.001 --capacity 60 --report json")).fine();
        seconds = number(&answer.report(), "seconds");
        steps *= 4;
    }
}

#[test]
fn steps_longer_than_everything_are_survived() {
    let folder = Folder::with("busy.scn", BUSY);
    for dt in ["5", "1000", "1e6", "2147483647"] {
        // The spring does not stand them, and the program says so.
        let answer = folder.run(&format!("run busy.scn --steps 3 --dt {dt} --capacity 100 --report json"));
        assert_eq!(answer.warnings().len(), 1);
        let report = answer.report();
        let died: f64 = report["died"].as_object().expect("causes").values().filter_map(Value::as_f64).sum();
        let [initial, born, live] = ["initial", "born", "live"].map(|field| number(&report, field));
        assert_eq!(initial + born, live + died, "{report}");
    }
}
