//! What is written: through links and into pipes, with the mode of what was there, all or none, and nothing left behind.

use crate::scenes::ONE;
use crate::tool::{Folder, PROGRAM};
use std::fs;
use std::io::Read;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What every kind of output is written by; each file's name is that of an option's.
const OUTPUTS: [(&str, &str); 10] = [
    ("run a.scn --steps 2 --out F", "o.csv"),
    ("run a.scn --steps 2 --out F", "o.jsonl"),
    ("run a.scn --steps 2 --out F", "o.xyz"),
    ("render a.scn --duration 0.1 --size 8x8 --out F", "o.gif"),
    ("render a.scn --duration 0.1 --size 8x8 --out F", "o.apng"),
    ("render a.scn --duration 0.1 --size 8x8 --out F", "o.y4m"),
    ("render a.scn --duration 0.1 --size 8x8 --out F", "o.png"),
    ("convert a.scn F", "o.json"),
    ("check a.scn --plot F", "o.svg"),
    ("lab --problems oscillator --integrators verlet --dt 1/8,1/16 --out F", "o.csv"),
];

fn mode(folder: &Folder, name: &str) -> u32 {
    fs::metadata(folder.path(name)).expect("it is there").permissions().mode() & 0o7777
}

#[test]
fn what_is_replaced_keeps_its_mode() {
    for (command, name) in OUTPUTS {
        let folder = Folder::with("a.scn", ONE);
        for wanted in [0o600, 0o640, 0o755] {
            folder.write(name, "old");
            fs::set_permissions(folder.path(name), fs::Permissions::from_mode(wanted)).expect("it is ours");
            folder.run(&command.replace('F', name)).fine();
            assert_eq!(mode(&folder, name), wanted, "{command}");
        }
        assert!(fs::read(folder.path(name)).is_ok_and(|bytes| bytes != b"old"), "{command}");
    }
    let folder = Folder::with("a.scn", ONE);
    for (command, name) in [
        ("run a.scn --steps 1 --out o.ply", "o_000001.ply"),
        ("render a.scn --duration 0.1 --size 8x8 --out %03d.png", "001.png"),
    ] {
        folder.write(name, "old");
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(0o604)).expect("it is ours");
        folder.run(command).fine();
        assert_eq!(mode(&folder, name), 0o604, "{command}");
    }
}

#[test]
fn links_stay_and_what_they_lead_to_is_written() {
    for (command, name) in OUTPUTS {
        let folder = Folder::with("a.scn", ONE);
        folder.write("far/old", "old");
        symlink("far/old", folder.path("middle")).expect("a link");
        symlink("middle", folder.path(name)).expect("a link");
        folder.run(&command.replace('F', name)).fine();
        assert!(fs::read(folder.path("far/old")).is_ok_and(|bytes| bytes != b"old"), "{command}");
        assert!(folder.path(name).is_symlink() && folder.path("middle").is_symlink(), "{command}");
        assert_eq!(folder.names().len(), 5, "{command}: {:?}", folder.names());
    }
    let folder = Folder::with("a.scn", ONE);
    symlink("new.csv", folder.path("o.csv")).expect("a link to what is not there yet");
    symlink("circle.csv", folder.path("circle.csv")).expect("a link to itself");
    symlink("no/o.csv", folder.path("nowhere.csv")).expect("a link into no folder");
    folder.run("run a.scn --steps 1 --out o.csv").fine();
    assert!(folder.read("new.csv").starts_with("step,") && folder.path("o.csv").is_symlink());
    let before = folder.names();
    for name in ["circle.csv", "nowhere.csv"] {
        folder.run(&format!("run a.scn --steps 1 --out {name}")).error();
        assert_eq!(folder.names(), before);
    }
}

#[test]
fn pipes_are_written_into() {
    for (command, name) in OUTPUTS {
        let folder = Folder::with("a.scn", ONE);
        let made = Command::new("mkfifo").arg(folder.path(name)).status().expect("mkfifo runs");
        assert!(made.success());
        folder.run(&command.replace('F', &format!("plain-{name}"))).fine();
        let mut reader = Command::new("cat");
        let mut reader = reader.arg(folder.path(name)).stdout(Stdio::piped()).spawn().expect("cat runs");
        let mut read = Vec::new();
        let mut out = reader.stdout.take().expect("a pipe");
        let drain = std::thread::spawn(move || out.read_to_end(&mut read).map(|_| read));
        folder.run(&command.replace('F', name)).fine();
        let read = drain.join().expect("it ends").expect("it can be read");
        reader.wait().expect("it ends");
        // Pages and sheets of a lab have times in them.
        let same = fs::read(folder.path(&format!("plain-{name}"))).expect("it is there");
        assert!(read == same || (command.starts_with("lab") && !read.is_empty()), "{command}");
        assert_eq!(folder.names().len(), 3, "{command}: {:?}", folder.names());
    }
    let folder = Folder::with("a.scn", ONE);
    symlink("/dev/null", folder.path("null.csv")).expect("a link");
    folder.run("run a.scn --steps 1 --out null.csv").fine();
    assert!(folder.path("null.csv").is_symlink());
}

/// Two outputs are never one file, however their names are written: nothing is run, and what is there stays.
#[test]
fn outputs_are_kept_apart() {
    let folder = Folder::with("a.scn", ONE);
    for name in ["o.csv", "o_000000.ply", "sub/keep"] {
        folder.write(name, "old");
    }
    symlink("o.csv", folder.path("link.csv")).expect("a link");
    symlink("new.csv", folder.path("nowhere.csv")).expect("a link to what is not there yet");
    symlink("sub", folder.path("under")).expect("a link to a folder");
    let absolute = folder.path("o.csv").display().to_string();
    let before = folder.names();
    for (outs, said) in [
        ("--out o.csv --events o.csv", "--out and --events would write o.csv"),
        ("--events p.csv --out p.csv", "--out and --events would write p.csv"),
        ("--out o.csv --out o.csv", "two --out would write o.csv"),
        ("--out p.xyz --out q.xyz --out ./p.xyz", "two --out would write ./p.xyz"),
        ("--out sub/../o.csv --events o.csv", "--out and --events would write o.csv"),
        ("--out sub/p.csv --events under/p.csv", "--out and --events would write under/p.csv"),
        ("--out o.csv --events link.csv", "--out and --events would write link.csv"),
        ("--out nowhere.csv --events new.csv", "--out and --events would write new.csv"),
        (&format!("--out {absolute} --events o.csv"), "--out and --events would write o.csv"),
        ("--out o.ply --out o.ply", "two --out would write o_000000.ply"),
        ("--out o.ply --out o_%06d.ply", "two --out would write o_000000.ply"),
        ("--out p_%d.csv --events p_0.csv", "--out and --events would write p_0.csv"),
        ("--out - --out -", "two --out would write standard output"),
    ] {
        // So many steps that it would be seen if they were made.
        let answer = folder.run(&format!("run a.scn --duration 1e9 {outs}"));
        assert!(answer.error().starts_with(said), "{outs}: {answer:?}");
        assert_eq!((folder.names(), folder.read("o.csv")), (before.clone(), "old".into()), "{outs}");
    }
    for command in ["check a.scn --out p.svg --plot ./p.svg", "lab a.scn --out p.csv --out p.csv"] {
        assert!(folder.run(command).error().starts_with("two --out would write"), "{command}");
    }
    // Which number they come to is known at the end.
    let answer = folder.run("run a.scn --steps 20 --out q_%d.csv --events q_7.csv");
    assert!(answer.error().starts_with("q_7.csv: two outputs would be this file, so none is written"), "{answer:?}");
    assert_eq!(folder.names(), before);
    // Files of one name in other folders, and of other formats, are others.
    folder.run("run a.scn --steps 1 --out p.csv --events sub/p.csv --out p.xyz --out p.jsonl").fine();
    assert!(folder.read("p.csv").starts_with("step,") && folder.read("sub/p.csv") != folder.read("p.csv"));
}

#[test]
fn numbered_pictures_appear_all_or_none() {
    let folder = Folder::with("a.scn", ONE);
    for taken in ["p/0002.png", "p/0000.png"] {
        folder.write(&format!("{taken}/keep"), "");
        folder.write("p/0001.png", "old");
        let before = folder.names();
        let answer = folder.run("render a.scn --duration 0.2 --size 8x8 --out p/%04d.png");
        assert!(answer.error().contains(taken), "{answer:?}");
        assert_eq!((folder.names(), folder.read("p/0001.png")), (before, "old".into()));
        fs::remove_dir_all(folder.path(taken)).expect("it is ours");
    }
    folder.run("render a.scn --duration 0.2 --size 8x8 --out p/%04d.png").fine();
    assert_eq!(folder.names().len(), 2 + 6);
}

#[test]
fn interrupts_leave_nothing_behind() {
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        for (command, least) in [
            ("run a.scn --duration 1e6 --out o.csv --out o.ply --out o.xyz", 4),
            ("render a.scn --duration 1e6 --size 64x64 --out new/%d.png", 2),
            ("render a.scn --duration 1e6 --size 64x64 --out o.gif", 2),
        ] {
            let folder = Folder::with("a.scn", ONE);
            // Where somebody has started all of this with nohup, hang-ups would be ignored, as they should.
            let mut program = Command::new("env");
            program.args(["--default-signal=HUP", PROGRAM]).args(command.split(' ')).current_dir(folder.path(""));
            let child = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
            let begun = Instant::now();
            // Once there are files it can be interrupted.
            while folder.path("").read_dir().map_or(0, Iterator::count) < least {
                assert!(begun.elapsed() < Duration::from_secs(60), "{command}: {:?}", folder.names());
                std::thread::sleep(Duration::from_millis(2));
            }
            std::thread::sleep(Duration::from_millis(20));
            let kill = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
            assert!(kill.is_ok_and(|status| status.success()));
            let ended = child.wait_with_output().expect("it ends");
            assert_eq!((ended.status.code(), folder.names()), (Some(code), vec!["a.scn".to_string()]), "{command}");
            let said = String::from_utf8_lossy(&ended.stderr);
            let dropped = "warning: interrupted: recordings and pictures are dropped, since they are not complete";
            assert_eq!(said.lines().filter(|line| *line == dropped).count(), 1, "{command}: {said}");
        }
    }
}

#[test]
fn nohup_outlives_its_terminal() {
    let folder = Folder::with("a.scn", ONE);
    let script = "trap '' HUP; $POINTMASS run a.scn --steps 30000 --every 100000 --out o.csv > o.txt & sleep 0.1; \
                  kill -HUP $!; wait $!; echo $?";
    assert_eq!(folder.shell(script).stdout, "0\n");
}
